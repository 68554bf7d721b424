"""State of a contact after a load history, and one straight step from it."""

from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from mdr_core.cached import cached_property
from mdr_core.equivalent_1d import coordinate_from_load
from mdr_core.errors import InputError
from mdr_core.history import slip_memory
from mdr_core.history.dissipation import Dissipation
from mdr_core.history.slip_memory import FrontPath, LoadPoints, Polyline, VertexTree
from mdr_core.history.traction_vertices import TractionVertices, widths
from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.materials import Material, normal_modulus, shear_modulus
from mdr_core.profiles import Profile
from mdr_core.results import Results
from mdr_core.typing import Array
from mdr_core.validation import require_positive, require_single_profile, require_type


class TractionSegments(NamedTuple):
    """Intervals of the contact on which the slope of the anchor has one formula, from the axis."""

    coordinate: Array
    """Contact coordinates of their ends, shape (n + 1,)."""
    width: Array
    """Widths in the contact coordinate, without cancellation, shape (n,)."""
    slope: Array
    """Slope of the anchor over depth, from -1 to 1; zero on an arc, see `rate`."""
    rate: Array
    """On an arc the slope is rate 2x, or rate/(2x) where `inverse`; zero on straight segments."""
    inverse: bool = False


@dataclass(frozen=True, repr=False)
class ContactState(Results):
    """A contact after any load history, as the polyline of its springs' anchors.

    A spring is identified by the depth w of its first contact. Its anchor U - q_x/(mu E*), with
    U = G* u_x/(mu E*), is constant while it sticks. The polyline of (w, anchor) determines the
    traction and every later step, for every profile. Source: notes, §10.
    """

    profile: Profile
    e_star: float
    g_star: float
    friction_coefficient: float
    polyline: Polyline
    """Polyline over depths; chords stand for the arcs of nonlinear load steps."""
    curved_segments: TractionSegments | None = None
    """All segments, if nonlinear load steps have laid some, which are arcs; else None."""
    last_step: FrontPath | None = None
    """Path of the slip front on the step of `advance` that led here; None for other states."""
    quantities: ClassVar[tuple[str, ...]] = (
        "indentation_depth",
        "normal_force",
        "contact_radius",
        "tangential_displacement",
        "tangential_force",
        "elastic_energy",
        "tangential_energy",
        "dissipation",
        "slip_fronts",
    )
    about: ClassVar[tuple[str, ...]] = ()

    @property
    def displacement_ratio(self) -> float:
        """mu E*/G* [1], the ratio of a tangential displacement to its reduced value U."""
        return self.friction_coefficient * self.e_star / self.g_star

    @property
    def indentation_depth(self) -> float:
        """d [length]; negative in separation."""
        return self.polyline.load_point[0]

    @property
    def tangential_displacement(self) -> float:
        """u_x [length]."""
        return self.displacement_ratio * self.polyline.load_point[1]

    @property
    def in_contact(self) -> bool:
        """True unless the bodies are separated."""
        return self.polyline.in_contact

    @property
    def _moments(self) -> IntervalMoments:
        return interval_moments(self.profile, over_forces=False)

    @cached_property
    def _vertices(self) -> TractionVertices:
        return TractionVertices(self._moments, self._tree, self.coordinate)

    @cached_property
    def _tree(self) -> VertexTree:
        return slip_memory.as_tree(self.polyline)

    @property
    def depth(self) -> Array:
        """Depths w of the vertices, from 0 to d [length]; empty in separation."""
        vertices = np.append(self._vertices.depth[:-1], self.indentation_depth)
        return vertices if self.in_contact else vertices[:0]

    @property
    def load(self) -> Array:
        """q_x of the springs at the vertices [force/length]; linear in w between them."""
        tree = self._tree
        above = np.cumsum((tree.slope * tree.span)[:0:-1])
        loads = self.friction_coefficient * self.e_star * np.append(above[::-1], 0.0)
        return loads if self.in_contact else loads[:0]

    @cached_property
    def coordinate(self) -> Array:
        """Contact coordinates of the vertices; in separation that of the axis."""
        return read_only(self._moments.contact_coordinate(self._tree.normal))

    @cached_property
    def slope(self) -> Array:
        """Slope of the anchor over depth below each vertex but the first, from -1 to 1."""
        return read_only(self._tree.slope[1:])

    @cached_property
    def segments(self) -> TractionSegments:
        """Segments of the traction, with the arcs of nonlinear load steps; none in separation."""
        if self.curved_segments is not None:
            return self.curved_segments
        tree = self._tree
        width = widths(self._moments, tree, self.coordinate)
        straight = np.zeros(self.slope.shape)
        return TractionSegments(self.coordinate, width, self.slope, straight)

    @property
    def contact_radius(self) -> float:
        """a [length]."""
        return float(self.profile.contact_radius(self.coordinate[-1])) if self.in_contact else 0.0

    @property
    def normal_force(self) -> float:
        """F_N [force]."""
        return float(self.e_star * self.profile.reduced_force(self.coordinate[-1]))

    @property
    def elastic_energy(self) -> float:
        """Energy stored by the normal load, int F_N dd [force length]."""
        return float(self.e_star * self.profile.reduced_energy(self.coordinate[-1]))

    @property
    def tangential_energy(self) -> float:
        """Energy stored by the tangential load, int q_x^2/(2 G*) dx [force length]."""
        return self.energy_unit * float(self._vertices.square[-1])

    @cached_property
    def dissipation(self) -> float:
        """Energy dissipated by friction on the step of `advance` that led here [force length]."""
        if self.last_step is None:
            return 0.0
        moments = self._moments
        slip = Dissipation(moments, self.last_step)
        each = slip.per_step(moments.contact_coordinate(slip.ends))
        return self.energy_unit * float(each.sum())

    @property
    def energy_unit(self) -> float:
        """(mu E*)^2/G* [pressure]."""
        return self.friction_coefficient * self.e_star * self.displacement_ratio

    @property
    def slip_fronts(self) -> Array:
        """Radii inside the contact between two segments of q_x, ascending [length]."""
        if self.profile.has_no_partial_slip:
            return np.zeros(0)
        edges = self.coordinate if self.curved_segments is None else self.curved_segments.coordinate
        return self.profile.contact_radius(edges[1:-1])

    @property
    def tangential_force(self) -> float:
        """F_x = mu E* sum k_i (I_i - I_i-1) [force]. Source: notes, §10."""
        return self.friction_coefficient * self.e_star * float(self._vertices.shear[-1])


def read_only(values: Array) -> Array:
    """Return the array, marked read-only."""
    values.flags.writeable = False
    return values


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
    e_star, g_star = normal_modulus(e_star), shear_modulus(g_star)
    require_positive(("material", "e_star"), e_star)
    require_positive(("material", "g_star"), g_star)
    require_positive(("friction_coefficient",), friction_coefficient)
    polyline = slip_memory.separated(0.0, 0.0)
    return ContactState(profile, e_star, g_star, friction_coefficient, polyline)


def advance(
    state: ContactState, indentation_depth: float, tangential_displacement: float
) -> ContactState:
    """Return the state after one straight step in depth and displacement, exactly.

    Springs that stick keep their anchors, springs that come into contact take the displacement
    of that moment, springs that would carry more than mu q slip. A depth <= 0 separates the bodies
    and erases the slip memory. Use it in time-stepping codes that determine the next load from
    the forces; use `solve` for load histories known a priori.

    Source: mdr-5, Eqs. (5.4)-(5.9); notes, §10.

    Parameters
    ----------
    state : state from `unloaded`, from an earlier step, or at the end of a history. After
        nonlinear load steps chords stand for the arcs, with a relative error of up to about 1e-5.
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
    >>> round(state.tangential_force / (0.5 * normal_force), 12)
    0.75
    """
    require_type("state", state, ContactState, "a state, as from history.unloaded")
    depth, displacement = np.array([indentation_depth]), np.array([tangential_displacement])
    if not (np.isfinite(depth[0]) and np.isfinite(displacement[0])):
        raise InputError(("history",), "must be finite")
    coordinate_from_load(state.profile, np.maximum(depth, 0.0), of_force=False)
    once = np.zeros(1, dtype=bool), np.zeros(1, dtype=np.intp)
    points = LoadPoints(depth, displacement / state.displacement_ratio, *once)
    _, path, polyline = slip_memory.apply_steps(state.polyline, points)
    return replace(state, polyline=polyline, curved_segments=None, last_step=path)
