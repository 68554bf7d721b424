"""State of a contact after a load history, and one straight step from it."""

from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdr_core.doubles import ROUNDING
from mdr_core.elementwise import number, where
from mdr_core.history import slip_memory
from mdr_core.history.friction_work import dissipation
from mdr_core.history.slip_layout import NORMAL
from mdr_core.history.slip_memory import Polylines, read_only
from mdr_core.history.tractions import SHORT, TractionVertices
from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.materials import Material, modulus
from mdr_core.profiles import Profile
from mdr_core.results import Results
from mdr_core.typing import Array
from mdr_core.validation import (
    require_finite,
    require_inside,
    require_single_positive,
    require_single_profile,
    require_type,
    single,
)


class Edge(NamedTuple):
    """Contact whose edge is a vertex of the polyline, with its traction."""

    coordinate: Array
    """Contact coordinate."""
    force: Array
    """F_N/E* [length^2]."""
    shear: Array
    """F_x/(mu E*) [length^2]."""


@dataclass(frozen=True, repr=False, eq=False)
class LoadPointResults(Results):
    """Results of one contact or of many at their load points."""

    profile: Profile
    """Profile of all contacts; its parameters are numbers, or arrays over the contacts."""
    e_star: Any
    """E*, of all contacts or of each [pressure]."""
    g_star: Any
    """G*, of all contacts or of each [pressure]."""
    friction_coefficient: Any
    """mu, of all contacts or of each [1]."""
    polyline: Polylines
    """Slip memory of each contact, over depths."""
    before: Polylines
    """Slip memory before the step that led here; without such a step the same as `polyline`."""
    quantities: ClassVar[tuple[str, ...]] = (
        "indentation_depth",
        "normal_force",
        "contact_radius",
        "tangential_displacement",
        "tangential_force",
        "elastic_energy",
        "tangential_energy",
        "dissipation",
    )

    def _of_contacts(self, values: NDArray[Any]) -> Any:
        """Return the values of all contacts; a single state returns its number."""
        return values

    @cached_property
    def _moments(self) -> IntervalMoments:
        """Moments over intervals of depth."""
        return interval_moments(self.profile, over_forces=False)

    @cached_property
    def vertices(self) -> TractionVertices:
        """Vertices of all polylines."""
        tree = self.polyline.tree(self.polyline.load_points)
        return TractionVertices(self._moments.part(self.polyline.owners), tree)

    @cached_property
    def load_points(self) -> Edge:
        """Contact with its edge at the load point, for each contact."""
        edges, at = self.vertices, self.vertices.tree.at_load_points
        return Edge(*map(at, (edges.coordinate, edges.conjugate, edges.shear)))

    @property
    def in_contact(self) -> Any:
        """True unless the bodies are separated."""
        return self._of_contacts(self.polyline.sizes > 0)

    @property
    def indentation_depth(self) -> Any:
        """d [length]; negative in separation."""
        return self._of_contacts(self.polyline.load_points[0].copy())

    @property
    def tangential_displacement(self) -> Any:
        """u_x [length]."""
        return self.displacement_ratio * self._of_contacts(self.polyline.load_points[1])

    @property
    def displacement_ratio(self) -> Any:
        """mu E*/G* [1], the ratio of a tangential displacement to its reduced value U."""
        return self.friction_coefficient * self.e_star / self.g_star

    @property
    def energy_unit(self) -> Any:
        """(mu E*)^2/G* [pressure]."""
        return self.friction_coefficient * self.e_star * self.displacement_ratio

    @property
    def contact_radius(self) -> Array:
        """a [length]; zero in separation."""
        radius = self.profile.contact_radius(self.load_points.coordinate)
        return where(self.in_contact, radius, 0.0)

    @property
    def normal_force(self) -> Array:
        """F_N [force]."""
        return self.e_star * self.load_points.force

    @property
    def tangential_force(self) -> Array:
        """F_x = mu E* sum k_i (I_i - I_i-1) [force]. Source: notes, §10."""
        return self.friction_coefficient * self.e_star * self.load_points.shear

    @property
    def elastic_energy(self) -> Array:
        """Energy stored by the normal load, int F_N dd [force length]."""
        return self.e_star * self.profile.reduced_energy(self.load_points.coordinate)

    @property
    def tangential_energy(self) -> Any:
        """Energy stored by the tangential load, int q_x^2/(2 G*) dx [force length]."""
        square = self.vertices.tree.at_load_points(self.vertices.square)
        return self.energy_unit * self._of_contacts(square)

    @cached_property
    def dissipation(self) -> Any:
        """Energy dissipated by friction on the step that led here [force length]."""
        step = self.before.tree(self.polyline.load_points)
        return self.energy_unit * self._of_contacts(dissipation(self._moments, step))


@dataclass(frozen=True, repr=False, eq=False)
class ContactState(LoadPointResults):
    """A contact after any load history, as the polyline of its springs' anchors.

    A spring is identified by the depth w of its first contact. Its anchor U - q_x/(mu E*), with
    U = G* u_x/(mu E*), is constant while it sticks. The polyline of (w, anchor) determines the
    traction and every later step, for every profile. Source: notes, §10.
    """

    known_edges: list[Edge] = field(init=False, default_factory=list)
    """Edges of the first vertices; a step passes the edges that it keeps to the next state."""
    quantities: ClassVar[tuple[str, ...]] = (*LoadPointResults.quantities, "slip_fronts")

    def _of_contacts(self, values: NDArray[Any]) -> Any:
        """Return the number of this contact."""
        return values[0]

    @property
    def _edges(self) -> list[Edge]:
        """Edges of all vertices; a single edge on the axis in separation."""
        known = self.known_edges
        if not known:
            known.append(Edge(*(number(0.0),) * 3))
        vertices, start = self.polyline.vertices[:, NORMAL:].tolist(), len(known)
        for lower, upper in pairwise(vertices[start - 1 :]):
            known.append(self._edge(known[-1], number(upper[0] - lower[0]), *map(number, upper)))
        return known

    def _edge(self, below: Edge, span: Any, depth: Any, slope: Any) -> Edge:
        """Edge of the vertex at a depth, `span` above another one."""
        profile = self.profile
        # A rounding error may place a corner deeper than the load point.
        depth = min(depth, profile.largest_loads[0])
        coordinate = profile.coordinate_from_depth(depth)
        force = self._moments.conjugate(depth, coordinate)
        grown = force - below.force
        if span < SHORT * depth:
            grown = span * self._moments.mean_slope(below.coordinate, coordinate)
        return Edge(coordinate, force, below.shear + slope * grown)

    @property
    def depth(self) -> Array:
        """Depths w of the vertices, from 0 to d [length]; empty in separation."""
        return self.vertices.tree.normal.copy()

    @property
    def load(self) -> Array:
        """q_x of the springs at the vertices [force/length]; linear in w between them."""
        forward, backward = self.polyline.vertices[:, :NORMAL].T
        anchors = self.polyline.load_points[1] - (forward - backward) / 2
        return self.friction_coefficient * self.e_star * anchors

    @cached_property
    def coordinate(self) -> Array:
        """Contact coordinates of the vertices; a single one on the axis in separation."""
        return read_only(np.array([edge.coordinate for edge in self._edges]))

    @cached_property
    def slope(self) -> Array:
        """Slope of the anchor over depth below each vertex but the first, from -1 to 1."""
        return read_only(self.vertices.tree.slope[1:])

    @cached_property
    def load_points(self) -> Edge:
        """Contact with its edge at the load point."""
        return self._edges[-1]

    @property
    def slip_fronts(self) -> Array:
        """Radii inside the contact between two segments of q_x, ascending [length]."""
        if self.profile.is_flat_punch:
            return np.zeros(0)
        return self.profile.contact_radius(self.coordinate[1:-1])

    @property
    def front_errors(self) -> Array:
        """Errors of `slip_fronts` due to rounding of the prescribed forces [length]."""
        forces, fronts = (np.array([edge[i] for edge in self._edges]) for i in (1, 0))
        if self.profile.is_flat_punch or fronts.size < 3:
            return np.zeros(0)
        moved = np.minimum(forces[1:-1] + ROUNDING * forces[-1], forces[-1])
        ends = np.array([fronts[1:-1], self.profile.coordinate_from_reduced_force(moved)])
        inner, outer = self.profile.contact_radius(ends)
        return np.maximum(outer - inner, 0.0)


def unloaded(
    profile: Profile,
    e_star: float | Material,
    g_star: float | Material | None,
    friction_coefficient: float,
) -> ContactState:
    """Return the state of bodies before first contact, at zero depth and displacement.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    e_star, g_star : effective moduli [pressure], > 0, or the material that has them, for each.
    friction_coefficient : mu [1], > 0.

    Returns
    -------
    The state from which `advance` takes the first step.

    Raises
    ------
    InputError : a modulus or a friction coefficient that is not positive and finite, or an array as
        a parameter of the profile.
    """
    require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    require_single_profile(profile.swept)
    normal, shear = modulus("e_star", e_star), modulus("g_star", g_star)
    require_single_positive(("material", "e_star"), normal)
    require_single_positive(("material", "g_star"), shear)
    require_single_positive(("friction_coefficient",), friction_coefficient)
    polyline = slip_memory.separated(np.zeros((2, 1)))
    return ContactState(profile, normal, shear, friction_coefficient, polyline, polyline)


def advance(
    state: ContactState, indentation_depth: float, tangential_displacement: float
) -> ContactState:
    """Return the exact state after one straight step in depth and displacement.

    Springs that stick keep their anchors, springs that come into contact take the displacement at
    that moment as their anchor, springs that would carry more than mu q slip. A depth <= 0
    separates the bodies and erases the slip memory. Use it in time-stepping codes that determine
    the next load from the forces; use `solve` for load histories known a priori.

    Source: mdr-5, Eqs. (5.4)-(5.9); notes, §10.

    Parameters
    ----------
    state : state from `unloaded`, from an earlier step, or at the end of a history.
    indentation_depth : d after the step [length].
    tangential_displacement : u_x after the step [length].

    Returns
    -------
    The new state; the given one is not changed.

    Raises
    ------
    InputError : numbers that are not finite, or a depth beyond the end of the profile.

    Examples
    --------
    At half of the displacement at full slip a cone has F_x = 3/4 mu F_N: Eqs. (5.47), (5.49).

    >>> from mdr_core.profiles import Cone
    >>> state = advance(unloaded(Cone(0.1), 1.0, 1.0, 0.5), 2.0, 0.0)
    >>> state = advance(state, 2.0, 0.5)
    >>> normal_force = (2.0 / 0.1) ** 2 * 0.1 * 2 / np.pi
    >>> print(round(state.tangential_force / (0.5 * normal_force), 12))
    0.75
    """
    require_type("state", state, ContactState, "a state, as from history.unloaded")
    depth = single(("indentation_depth",), indentation_depth)
    displacement = single(("tangential_displacement",), tangential_displacement)
    require_finite(("indentation_depth",), number(depth))
    require_finite(("tangential_displacement",), number(displacement))
    profile = state.profile
    beyond = number(depth) > profile.largest_loads[0]
    require_inside(("indentation_depth",), beyond, profile)
    load_point = depth, displacement / state.displacement_ratio
    line, kept = slip_memory.moved(state.polyline, load_point)
    moduli = state.e_star, state.g_star, state.friction_coefficient
    following = ContactState(profile, *moduli, line, state.polyline)
    following.known_edges.extend(state.known_edges[:kept])
    return following
