"""Adhesive contact of any profile after Johnson, Kendall and Roberts (JKR).

The reference of an adhesive contact of radius a is the contact of that radius without adhesion. The
adhesive contact is the reference less a flat punch that is retracted by

    Delta_l(a) = sqrt(2 pi a w/E*),    d = g(a) - Delta_l,    F_N = F_0(a) - 2 E* a Delta_l,

so that the energy release rate at its edge is the work of adhesion w. With phi = g'(a) sqrt(a) and
c = sqrt(2 pi w/E*) a state is stable under a prescribed force for phi > (3/2) c, under a prescribed
depth for phi > c/2. The crossings of these levels are found between nodes that resolve phi; the
state under a load is the outermost stable one, which unloading from a large contact reaches, and
the pull-off is the lowest load of all stable branches.

Source: notes, §13.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf, pi, sqrt
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize.elementwise import find_root

from mdr_core import materials, validation
from mdr_core.doubles import EPS, ROUNDING
from mdr_core.elementwise import full, number, quotient, some, where
from mdr_core.equivalent_1d import coordinate_from_radius
from mdr_core.errors import InputError, Notice
from mdr_core.extrema import LEAST_GAP, largest_with
from mdr_core.materials import UNKNOWN, Material
from mdr_core.normal import CONTROLS, NormalContact
from mdr_core.profiles import FlatPunch, Profile, Tabulated
from mdr_core.profiles.base import NORMAL_QUANTITIES
from mdr_core.typing import Array, Indices

# Parts of c at which a state loses its stability.
_SHARES: Final = {"indentation_depth": 0.5, "normal_force": 1.5}
# Distances of nodes from the axis and from breaks. Twelve in a decade resolve phi, which bends over
# a factor of e or more.
_DISTANCES: Final = np.logspace(-75, 75, 1801)
# Nodes between the breaks of a table, where g' is a polynomial.
_IN_PIECE: Final = 9
# Delta_l of a paraboloid at pull-off over the range of adhesion, for Tabor's number 1.
_TABOR: Final = sqrt(2 * pi) * (9 * pi / 8) ** (1 / 6)
# Tabor's number above which JKR theory is valid. Source: johnson-greenwood.
_JKR: Final = 5.0


class Curve:
    """Equilibrium states of one profile over the contact coordinate, with c = sqrt(2 pi w/E*).

    A load is a depth [length] or, under the name `normal_force`, the reduced force F_N/E*
    [length^2].
    """

    def __init__(self, profile: Profile, c: float) -> None:
        self.profile, self.c = profile, c
        # The edge of a flat punch stays until the energy release rate reaches w.
        fixed = (np.zeros(1), np.full(1, inf)) if profile.is_flat_punch else None
        self.stable = {name: fixed or self._branches(name) for name in _SHARES}
        """Coordinates between which states are stable, under a prescribed depth or force."""
        lows = {name: self.load(name, low) for name, (low, _) in self.stable.items()}
        self.least = {name: float(low.min()) for name, low in lows.items()}
        self.at_pull_off = self.stable["normal_force"][0][np.argmin(lows["normal_force"])]

    @cached_property
    def _nodes(self) -> Array:
        """Coordinates that resolve phi, ascending."""
        profile, top = self.profile, min(_DISTANCES[-1], self.end)
        edges = np.array([0.0, *np.ravel(profile.coordinate_breaks), top])
        breaks = coordinate_from_radius(profile, np.array(profile.breaks, dtype=float))
        near = np.add.outer(np.append(0.0, breaks), [*-_DISTANCES, *_DISTANCES])
        between = np.linspace(edges[:-1], edges[1:], _IN_PIECE)
        nodes = np.unique(np.append(near, between))
        return nodes[(nodes >= max(_DISTANCES[0], self.start)) & (nodes <= top)]

    @property
    def start(self) -> float:
        """Contact coordinate below which no state is stable."""
        return 0.0

    @property
    def end(self) -> float:
        """Largest contact coordinate, with which the profile ends."""
        return float(self.profile.domain)

    @property
    def allowed(self) -> Any:
        """Largest contact radius, as `domain`, with the words for its `end`."""
        return self.profile

    def correction(self, contact: "AdhesiveContact", load: Indices, r: Array) -> Array | float:
        """Pressure over E* beyond the half-space's at radii, each under the load of an index.

        Parameters: the contact; indices of loads and radii [length], both of shape (k,).
        """
        return 0.0

    def pressed(self, *known: Any) -> NormalContact:
        """Return a contact without adhesion; `known` are the arguments of `NormalContact`."""
        return NormalContact(*known)

    def stiffness(self, coordinate: Array) -> Array:
        """dF_N/dd over E* at constant contact radius [length]."""
        return 2 * self.profile.contact_radius(coordinate)

    def retraction(self, coordinate: Array) -> Array:
        """Delta_l [length]."""
        return self.c * np.sqrt(self.profile.contact_radius(coordinate))

    def load(self, name: str, coordinate: Array) -> Array:
        """Depth or F_N/E*."""
        with np.errstate(all="ignore"):
            retraction = self.retraction(coordinate)
            if name == "indentation_depth":
                return self.profile.depth(coordinate) - retraction
            return self.profile.reduced_force(coordinate) - self.stiffness(coordinate) * retraction

    def excess(self, share: float, coordinate: Array) -> Array:
        """phi/c less a share: the excess of a g'/Delta_l over its value at pull-off [1]."""
        with np.errstate(all="ignore"):
            punch = self.profile.is_flat_punch
            slope = inf if punch else self.profile.depth_slope(coordinate)
            return slope * np.sqrt(self.profile.contact_radius(coordinate)) / self.c - share

    def _branches(self, name: str) -> tuple[Array, Array]:
        share = _SHARES[name]

        def height(coordinate: Array) -> Array:
            """The form (phi - level)/(phi + level) is finite, as root finding requires."""
            return 1 - 2 * share / (2 * share + self.excess(share, coordinate))

        nodes, values = self._nodes, height(self._nodes)
        stable = values > 0
        end = self.end
        if not stable[-1] or (stable[0] and values[0] < values[1]):
            words, remedy = self.allowed.end
            reason = (
                f"to radius {self.allowed.domain:.6g}, {words}: reduce the work, or {remedy}"
                if end < np.inf
                else "without bound, or its radius at pull-off is not representable"
            )
            detail = f"adhesion spreads the contact {reason}"
            raise InputError(("material", "work_of_adhesion"), detail)
        at = np.flatnonzero(stable[1:] != stable[:-1])
        ends = _roots(height, nodes[at], nodes[at + 1])
        first = [0.0] if stable[0] else []
        return np.append(first, ends[~stable[at]]), np.append(ends[stable[at]], nodes[-1])

    def outermost(self, name: str, load: Array) -> tuple[Array, int]:
        """Return the outermost stable coordinate of each load (n,), and the maximum of states."""
        low, high = self.stable[name]
        least = self.load(name, low)
        holds = load[:, None] >= least - ROUNDING * np.abs(least)
        holds &= load[:, None] <= self.load(name, high)
        branch = low.size - 1 - np.argmax(holds[:, ::-1], axis=1)
        found = low[branch]
        for k in np.unique(branch):
            own = (branch == k) & (load - least[k] > ROUNDING * abs(least[k]))
            inside = self._nodes[(self._nodes > low[k]) & (self._nodes < high[k])]
            stops = np.concatenate([low[k : k + 1], inside, high[k : k + 1]])
            values = np.maximum.accumulate(self.load(name, stops))
            place = np.clip(np.searchsorted(values, load[own]), 1, stops.size - 1)
            found[own] = _roots(
                lambda s, goal: self.load(name, s) - goal,
                *(stops[place - 1], stops[place], load[own]),
            )
        return found, int(holds.sum(axis=1).max())


def _roots(function: Callable[..., Array], low: Array, high: Array, *given: Array) -> Array:
    """Return the root in each bracket, or its nearer end if rounding leaves no sign change."""
    if not low.size:
        return low
    found = find_root(function, (low, high), args=given)
    nearer = np.abs(function(low, *given)) <= np.abs(function(high, *given))
    return np.asarray(np.where(found.success, found.x, np.where(nearer, low, high)))


@dataclass(frozen=True, repr=False, kw_only=True)
class AdhesiveContact(NormalContact):
    """Profile in adhesive contact with a half-space, under any number of loads.

    It has the results of a `NormalContact`, and the pull-off.
    """

    curve: Curve
    retraction: Array
    """Retraction from the reference [length]: Delta_l, or less than Delta_l on a flat punch."""
    tabor_number: float = inf
    """Tabor's number from Delta_l at pull-off; infinite without a range of adhesion [1]."""
    states: int = 1
    """Largest number of stable states under one of the loads."""
    quantities: ClassVar[tuple[str, ...]] = (
        *(*NORMAL_QUANTITIES, "pull_off_force", "pull_off_depth", "retraction"),
    )
    unusable: ClassVar[str] = (
        "adhesion with friction, yield or wear is not exact: the tension at the edge is infinite; "
        "leave adhesion out"
    )

    @cached_property
    def reference(self) -> NormalContact:
        """Contact without adhesion of the same radius."""
        known = self.profile, self.e_star, self.coordinate, self.control, self.material
        vars(reference := self.curve.pressed(*known))["contact_radius"] = self.contact_radius
        return reference

    @property
    def pull_off_force(self) -> Array:
        """Lowest force of a contact, negative in tension [force]."""
        return np.multiply(self.e_star, self.curve.least["normal_force"])

    @property
    def pull_off_depth(self) -> Array:
        """Lowest depth of a contact [length]."""
        return number(self.curve.least["indentation_depth"])

    @cached_property
    def indentation_depth(self) -> Array:
        """d = g(a) - Delta_l [length]."""
        return self.reference.indentation_depth - self.retraction

    @cached_property
    def normal_force(self) -> Array:
        """F_N = F_0(a) - 2 E* a Delta_l [force], negative in tension."""
        return self.reference.normal_force - self.reference.normal_stiffness * self.retraction

    @cached_property
    def maximum_pressure(self) -> Array:
        """Largest pressure in the contact [pressure]; the tension at its edge is infinite."""
        a, retraction = map(np.ravel, (self.contact_radius, self.retraction))

        def tension(load: Indices, r: Array) -> Array:
            square = np.maximum((a[load] - r) * (a[load] + r), LEAST_GAP * a[load] ** 2)
            return self.curve.correction(self, load, r) - retraction[load] / (pi * np.sqrt(square))

        largest = largest_with(self.profile, self.coordinate, self.loaded, tension)
        return self.e_star * largest

    @cached_property
    def normal_stiffness(self) -> Array:
        """dF_N/dd = 2 E* [a - Delta_l/(g' - Delta_l/(2a))] [force/length].

        -inf at pull-off under a prescribed depth; 2 E* a on a flat punch, whose edge is fixed, and
        at the edge of a flat at which g' is infinite.
        """
        punch, stable = self.reference.normal_stiffness, self._excess("indentation_depth")
        excess = self.curve.excess(_SHARES["normal_force"], self.coordinate)
        with np.errstate(divide="ignore", invalid="ignore"):
            return where(stable < inf, punch * excess / stable, punch)

    def _excess(self, name: str) -> Array:
        """Excess of a g'/Delta_l over its value at pull-off; infinite under a flat punch [1]."""
        excess = self.curve.excess(_SHARES[name], self.coordinate)
        return where(excess > self.profile.steepness * ROUNDING, excess, 0.0)

    @cached_property
    def elastic_energy(self) -> Array:
        """E* int_0^a (d - g)^2 dx = U_0 - (F_0 + F_N) Delta_l/2 [force length]."""
        total = self.reference.normal_force + self.normal_force
        return self.reference.elastic_energy - total * self.retraction / 2

    @property
    def data_error(self) -> Array | None:
        """Condition number of the reference contact."""
        return self.reference.data_error

    @property
    def pull_off_data_error(self) -> Array | None:
        """Relative error of the pull-off force that the points of a table leave open [1].

        An estimate, of F_0 at the radius at pull-off, where the force is stationary.
        """
        if not isinstance(self.profile, Tabulated):
            return None
        moment = self.profile.fit.spread_at(np.array(self.curve.at_pull_off))[1]
        return 2 * moment / abs(self.curve.least["normal_force"])

    @property
    def method(self) -> str:
        """Method: closed forms only under a flat punch."""
        return self.reference.method if self.profile.is_flat_punch else "quadrature"

    @cached_property
    def edge_errors(self) -> Array:
        """Relative error of the contact radius, of the order of a root next to pull-off [1]."""
        rounding, name = self.profile.rounding_at(self.coordinate), self.control
        if name not in _SHARES:
            return full(EPS, self.coordinate)
        punch = self.reference.normal_stiffness if name == "normal_force" else 1.0
        size = 1 + getattr(self.reference, name) / (punch * self.curve.retraction(self.coordinate))
        return rounding * size / np.maximum(self._excess(name), np.sqrt(rounding))

    @cached_property
    def error_estimates(self) -> Array:
        """Bound of the error of each load's results [1].

        The error of a result that may vanish is relative to the sum of the absolute values of its
        two parts: the reference and the retraction. The stiffness is infinite at pull-off.
        """
        change = 3 * self.profile.steepness * self.edge_errors
        stable = self._excess("indentation_depth")
        near = quotient(1.0, stable)
        own = (self.reference.error_estimates + change) * (2 + near)
        return own + near * self._slope_error

    @property
    def _slope_error(self) -> Array:
        """Relative error of g'(a) due to that of the contact radius, large next to a flat [1]."""
        profile, edge = self.profile, self.coordinate
        if profile.is_flat_punch:
            return full(0.0, edge)
        size = edge if self.control == "contact_radius" else self.contact_radius
        moved = np.minimum(self.edge_errors * size, edge / 2)
        with np.errstate(all="ignore"):
            slope = profile.depth_slope(edge)
            ends = edge - moved, np.minimum(edge + moved, self.curve.end)
            changes = [np.abs(profile.depth_slope(end) / slope - 1) for end in ends]
        return where(slope < inf, np.maximum(*changes), 0.0)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        stiff = "normal_stiffness is infinite at pull-off under a prescribed depth"
        short = (
            f"Tabor's number is {self.tabor_number:.2g}: below {_JKR:g} the range of adhesion "
            "changes the pull-off; use boundary elements with a law of its tractions"
        )
        several = (
            f"{self.states} stable states exist under one load: the result is the one with the "
            "largest contact, which unloading reaches"
        )
        size = self.tabor_number, _JKR
        own = (
            (some(self._excess("indentation_depth") == 0), Notice("singular", stiff)),
            (self.tabor_number < _JKR, Notice("jkr_range", short, *size, "boundary_elements")),
            (self.states > 1, Notice("several_states", several, self.states, 1.0)),
        )
        found = (notice for holds, notice in own if holds)
        return (*super().warnings_without_bodies, *found)

    def superposed(self, field: Callable[[NormalContact], Any]) -> Array:
        """Return the difference of a field, by load, between reference and retracted flat punch."""
        whole = np.asarray(field(self.reference))
        ends = zip(*map(np.ravel, (self.contact_radius, self.retraction)), strict=True)
        punches = (self.curve.pressed(FlatPunch(a), self.e_star, step) for a, step in ends)
        taken = np.reshape([field(punch) for punch in punches], whole.shape)
        # At the edge the tension outweighs a logarithmic pressure.
        infinite = np.isinf(taken)
        return np.where(infinite, -taken, whole - np.where(infinite, 0.0, taken))


def solve(
    profile: Profile,
    e_star: float | Material,
    work_of_adhesion: float,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    contact_radius: ArrayLike | None = None,
    range_of_adhesion: float = 0.0,
) -> AdhesiveContact:
    """Return the adhesive contact under a prescribed depth, force or contact radius.

    The state is the outermost stable one, which the contact reaches by unloading.

    Source: jkr; popov-adhesion; notes, §13.

    Parameters
    ----------
    profile : any kind, with single numbers as parameters.
    e_star : effective modulus [pressure], > 0, or the material that has it.
    work_of_adhesion : w, energy per area [force/length], > 0.
    indentation_depth, normal_force, contact_radius : exactly one [length], [force], [length]; a
        number or an array. The first two may be negative down to the pull-off; the contact radius
        must be stable under a prescribed depth.
    range_of_adhesion : distance over which surfaces attract [length], for the warning `jkr_range`.

    Raises
    ------
    InputError : a load below the pull-off, which the message contains; a contact that adhesion
        spreads beyond the profile; or input that `normal.solve` rejects.

    Examples
    --------
    The pull-off force of a sphere is -(3/2) pi w R.

    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2e-6), 1e6, 0.05, normal_force=0.0)
    >>> round(float(contact.pull_off_force) / (np.pi * 0.05 * 2e-6), 12)
    -1.5
    """
    validation.require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    validation.require_single_profile(profile.swept)
    material = e_star if isinstance(e_star, Material) else UNKNOWN
    modulus = materials.modulus("e_star", e_star)
    for field, value in {"e_star": modulus, "work_of_adhesion": work_of_adhesion}.items():
        validation.require_single_positive(("material", field), value)
    loads = (indentation_depth, normal_force, contact_radius)
    curve = Curve(profile, sqrt(2 * pi) * sqrt(work_of_adhesion) / sqrt(modulus))
    given = dict(zip(CONTROLS, loads, strict=True))
    return on_curve(curve, modulus, material, given, range_of_adhesion)


def on_curve(
    curve: Curve,
    modulus: float,
    material: Material,
    loads: Mapping[str, ArrayLike | None],
    range_of_adhesion: float,
) -> AdhesiveContact:
    """Return the adhesive contact of a curve of states under one of the loads; see `solve`.

    Parameters
    ----------
    curve : the states of a profile with a work of adhesion, on a half-space or a layer.
    modulus : E* [pressure].
    material : effective moduli, `UNKNOWN` where only E* is given.
    loads : the controls by name, of which exactly one is given.
    range_of_adhesion : distance over which the surfaces attract [length], 0 where it is not given.
    """
    profile = curve.profile
    name, load = validation.only_one(("load",), loads)
    validation.require_finite(("load", name), load)
    coordinate, retraction, states = _state(curve, name, load, modulus)
    at_pull_off = float(curve.retraction(curve.at_pull_off))
    contact = AdhesiveContact(
        *(profile, modulus, coordinate, name, material),
        curve=curve,
        retraction=retraction,
        tabor_number=at_pull_off / (_TABOR * range_of_adhesion) if range_of_adhesion else inf,
        states=states,
    )
    # The prescribed load is returned bit-identical.
    vars(contact)[name] = load
    return contact


def _state(curve: Curve, name: str, load: Array, e_star: float) -> tuple[Array, Array, int]:
    """Coordinate and retraction under each load, and the largest number of stable states."""
    profile, states = curve.profile, 1
    if name == "contact_radius":
        validation.as_positive(("load", name), load)
        at = coordinate_from_radius(profile, load)
        bad = np.asarray(~(curve.excess(_SHARES["indentation_depth"], at) >= -sqrt(ROUNDING)))
        if some(bad):
            low, _ = curve.stable["indentation_depth"]
            radius = profile.contact_radius(low[np.argmin(curve.load("indentation_depth", low))])
            detail = f"is not stable: at pull-off under a prescribed depth it is {radius:.9g}"
            raise InputError(("load", name, *validation.first_index(bad)), detail)
        return at, curve.retraction(at), states
    of_force = name == "normal_force"
    unit = e_star if of_force else 1.0
    amount, least = load / unit, curve.least[name]
    # Under a tip as sharp as sqrt(r) the contact vanishes at zero load.
    below = np.asarray(amount < least * (1 + ROUNDING) if least else amount <= 0)
    if some(below):
        pull_off = "pull-off force" if of_force else "pull-off depth"
        side = f"{'below' if least else 'not above'} the {pull_off}, {least * unit:.9g}"
        detail = f"is {side}: there is no contact"
        raise InputError(("load", name, *validation.first_index(below)), detail, below)
    if profile.is_flat_punch:
        depth = amount / curve.stiffness(amount) if of_force else amount
        return np.maximum(depth, 0.0), np.maximum(-depth, 0.0), states
    beyond = amount > curve.load(name, curve.stable[name][1][-1])
    validation.require_inside(("load", name), beyond, curve.allowed)
    at, states = curve.outermost(name, np.ravel(amount))
    return (at := at.reshape(np.shape(load))[()]), curve.retraction(at), states
