"""The limiting profile of fretting wear: the shape on which a partial slip wears itself out."""

from dataclasses import dataclass
from math import inf
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields
from mdr_core.checks import extremes, first_index
from mdr_core.errors import InputError, Notice
from mdr_core.lazy import cached_property
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Parameter
from mdr_core.wear import shape, stick
from mdr_core.wear.rim import Rim

_NAMES: Final = ("tangential_displacement", "tangential_force")
_RANGE: Final = 1e90
# The grid goes on outside the worn rim up to so many times its radius.
_BEYOND: Final = 1.25
_SAID: Final = {
    "path_dependent": "with a held normal force and a held displacement amplitude the depth grows, "
    "the stick zone grows into what was worn before, and the limit depends on the path: this is "
    "the book's Eq. (5.90); follow the wear with the evolution instead",
    "singular": "the pressure in the limit is infinite at the stick radius, as under the edge of "
    "a flat punch",
    "no_wear": "nothing slips, so nothing wears: the limit is the profile itself",
    "contact_lost": "everything slips and wears until nothing touches at the held depth",
    "endless_wear": "everything slips under the held force and wears without end: depth, wear "
    "radius and worn volume are infinite",
}


@dataclass(frozen=True)
class LimitingWear:
    """The state in which all slip has worn off, at every pair of loads at once.

    Each answer is computed when it is first asked for; all are arrays over the broadcast loads.
    Under a held force that lets everything slip there is no end to the wear: depth, wear radius
    and volume are infinite. Under a held depth it ends where nothing touches.
    """

    first: TangentialContact
    """The contact before any wear, with the amplitude applied once."""
    amplitude: str
    """Which amplitude was given: "tangential_displacement" or "tangential_force"."""
    stuck: stick.LimitingStick

    @property
    def _normal(self) -> NormalContact:
        return self.first.normal

    @property
    def _holds_depth(self) -> bool:
        return self._normal.control == "indentation_depth"

    @property
    def stick_radius(self) -> Array:
        """c [length]: inside it nothing ever wears. Source: mdr-5, Eq. (5.80)."""
        return np.where(self.stuck.endless, 0.0, self.stuck.radius)

    @cached_property
    def wear_width(self) -> Array:
        """Width of the worn rim [length], with its digits however narrow it is."""
        rests = self.stuck.step <= 0
        if self._normal.profile.slips_at_once:
            worn = np.where(rests, 0.0, self._normal.contact_radius)
        else:
            target = np.where(self.stuck.endless, 0.0, self.stuck.step)
            start = np.where(target > 0, 1.25 * self.stuck.slip_width, 1.0)
            room = self.rim.room.reshape(target.shape)
            flat = (np.ravel(part) for part in (target, np.minimum(start, 0.9 * room)))
            worn = self.rim.width_where_worn(*flat).reshape(target.shape)
        return np.where(self.stuck.endless, inf, worn)

    @cached_property
    def wear_radius(self) -> Array:
        """Outer radius of the worn rim, where the worn depth vanishes [length].

        Source: mdr-5, Eq. (5.88), for any profile; notes, §9.
        """
        return self.stuck.radius + self.wear_width

    @cached_property
    def indentation_depth(self) -> Array:
        """d in the limit [length]: what is held, or g(c) and the step at the stick edge."""
        contact = self._normal
        held = np.broadcast_to(contact.indentation_depth, self.stuck.step.shape)
        if self._holds_depth:
            return held
        grown = held if contact.profile.slips_at_once else self._edge_depth + self.stuck.step
        return np.where(self.stuck.endless, inf, grown)

    @property
    def _edge_depth(self) -> Array:
        """g(c); of full slip, nothing."""
        profile = self._normal.profile
        sticks = self.stuck.radius > 0
        edge = np.where(sticks, self.stuck.coordinate, profile.first_coordinate)
        return np.where(sticks, profile.depth(edge), 0.0)

    @cached_property
    def normal_force(self) -> Array:
        """F_N in the limit [force]: what is held, or F_N(c) + 2 E* c (d - g(c)).

        Source: mdr-5, Eq. (5.90), for any profile.
        """
        contact, profile = self._normal, self._normal.profile
        if not self._holds_depth or profile.slips_at_once:
            held = np.broadcast_to(contact.normal_force, self.stuck.step.shape)
            return np.where(self.stuck.lost, 0.0, held)
        edge = np.where(self.stuck.lost, profile.first_coordinate, self.stuck.coordinate)
        inside = np.where(self.stuck.lost, 0.0, profile.reduced_force(edge))
        return contact.e_star * (inside + 2 * self.stuck.radius * self.stuck.step)

    @cached_property
    def tangential_displacement(self) -> Array:
        """Amplitude u_x in the limit [length]: what is held, or mu (E*/G*) (d - g(c))."""
        given = self.first.tangential_displacement
        if self.amplitude == "tangential_displacement" or self._normal.profile.slips_at_once:
            return np.where(self.stuck.endless & (self.amplitude == _NAMES[1]), inf, given)
        return np.where(self.stuck.endless, inf, self.first.compliance * self.stuck.step)

    @cached_property
    def tangential_force(self) -> Array:
        """Amplitude F_x in the limit [force]: what is held, or 2 mu E* c (d - g(c))."""
        first = self.first
        if self.amplitude == "tangential_force" or self._normal.profile.slips_at_once:
            return np.where(self.stuck.lost, 0.0, first.tangential_force)
        modulus = first.friction_coefficient * self._normal.e_star
        carried = 2 * modulus * self.stuck.radius * self.stuck.step
        return np.where(self.stuck.endless, first.limiting_force, carried)

    @cached_property
    def worn_volume(self) -> Array:
        """4 int_c^r (d - g(x)) sqrt(r^2 - x^2) dx over the worn rim [length^3].

        Source: notes, §9.
        """
        endless, width = self.stuck.endless, self.wear_width
        flat = (np.ravel(part) for part in (np.where(endless, 0.0, width), self.stuck.step))
        volume = self.rim.worn_volume(*flat).reshape(width.shape)
        return np.where(endless, inf, volume)

    @cached_property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Regime: "stick" (nothing wears), "partial_slip" or "full_slip" (nothing is spared)."""
        wearing = np.where(self.stuck.step > 0, "partial_slip", "stick").astype("U12")
        return np.where(self.stuck.endless | self.stuck.lost, "full_slip", wearing)

    @cached_property
    def rim(self) -> Rim:
        """The worn rims of all loads, in one row."""
        c, coordinate = np.ravel(self.stuck.radius), np.ravel(self.stuck.coordinate)
        return Rim(self._normal.profile, c, coordinate)

    def initial_profile(self, radius: ArrayLike) -> Array:
        """Return the shape before any wear, f(r) [length], the same for all loads.

        Raises
        ------
        InputError : a radius that is negative, not finite or beyond the profile's end.
        """
        return self._normal.profile.f(self._radii(radius))

    def limiting_profile(self, radius: ArrayLike) -> Array:
        """Return the shape in the limit [length], (loads, m), or (m,) for a single load.

        f in the stick zone and outside the worn rim; in the rim
        (2/pi) int_0^c g(x)/sqrt(r^2 - x^2) dx + (2/pi) d arccos(c/r), as f and the worn depth.

        Source: mdr-5, Eqs. (5.83), (5.85). Errors as of `initial_profile`.
        """
        return self.initial_profile(radius) + self.worn_depth(radius)

    def worn_depth(self, radius: ArrayLike) -> Array:
        """Return (2/pi) int_c^r (d - g(x))/sqrt(r^2 - x^2) dx in the worn rim [length].

        Never negative, zero in the stick zone and outside the rim. Source: mdr-5, Eqs. (5.75),
        (5.82); notes, §9. Shape and errors as of `limiting_profile`.
        """
        r, rtol = self._radii(radius), self._normal.rtol
        return shape.worn_depth(self.stuck, self.rim, self.wear_radius, r, rtol)

    def pressure(self, radius: ArrayLike) -> Array:
        """Return the pressure in the limit, (loads, m), or (m,) for a single load [pressure].

        (E*/pi) [int_r^c g'(x)/sqrt(x^2 - r^2) dx + (d - g(c))/sqrt(c^2 - r^2)] inside the stick
        zone, infinite at its edge, zero in the worn rim.

        Source: mdr-5, Eqs. (5.34), (5.79), (5.82); notes, §9.

        Raises
        ------
        InputError : a radius that is negative or not finite.
        """
        contact, r = self._normal, shape.checked_radii(radius)
        e_star = np.asarray(contact.e_star)
        return shape.pressure(contact.profile, self.stuck, e_star, r, contact.rtol)

    def grid(self, points: int) -> Array:
        """Return radii from 0 to a quarter beyond the largest worn rim [length], (points,).

        They crowd towards the axis, the breaks, and every load's c, a and wear radius.

        Raises
        ------
        InputError : fewer points than there are such radii.
        """
        profile = self._normal.profile
        edges = (self.stick_radius, self._normal.contact_radius, self.wear_radius)
        special = [np.zeros(1), *(np.ravel(edge) for edge in edges)]
        special += [np.ravel(np.asarray(b, dtype=float)) for b in profile.breaks]
        stops = np.unique(np.concatenate(special))
        stops = stops[np.isfinite(stops)]
        largest = max(float(e[np.isfinite(e)].max(initial=0.0)) for e in map(np.ravel, edges))
        last = min(_BEYOND * largest or 1.0, float(profile.domain))
        return fields.graded(np.append(stops[stops < last], last), points)

    def _radii(self, radius: ArrayLike) -> Array:
        return shape.checked_radii(radius, float(self._normal.profile.domain))

    @property
    def method(self) -> str:
        """The dearest route among the answers: the rim's edge is a root of a quadrature."""
        route = self._normal.profile.tangential_method
        return "quadrature" if route == "closed_form" else route

    @property
    def error_estimate(self) -> float:
        """Bound on the relative error of each answer: the rim costs no more than the annulus."""
        return self.first.error_estimate

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """Those of the first contact, and what the limit itself has to say.

        `path_dependent`, `singular`, `no_wear`, `contact_lost`, `endless_wear`.
        """
        wears = self.stuck.step > 0
        where = {
            "path_dependent": self._depends_on_path & wears,
            "singular": wears & (self.stick_radius > 0),
            "no_wear": self.regime == "stick",
            "contact_lost": self.stuck.lost,
            "endless_wear": self.stuck.endless,
        }
        own = [Notice(code, _SAID[code]) for code, flags in where.items() if np.any(flags)]
        return (*self.first.warnings, *own)

    @property
    def _depends_on_path(self) -> bool:
        return not self._holds_depth and self.amplitude == "tangential_displacement"


def solve(
    contact: NormalContact,
    g_star: Parameter,
    friction_coefficient: Parameter,
    *,
    tangential_displacement: ArrayLike | None = None,
    tangential_force: ArrayLike | None = None,
) -> LimitingWear:
    """Return the limit that fretting under a small tangential oscillation wears down to.

    The rim c < r outside the stick zone wears until it carries nothing: there g rises to d, and
    f = (2/pi) int g/sqrt(r^2 - x^2) dx follows, up to where it meets the first shape again.
    Exact for a held depth with a displacement amplitude and for a held normal force with a force
    amplitude; a held normal force with a displacement amplitude is answered by Eq. (5.90) and the
    notice `path_dependent`.

    Source: mdr-5, Eqs. (5.80)-(5.90); notes, §9.

    Parameters
    ----------
    contact : from `mdr_core.normal.solve`, of one profile under a depth or a normal force.
    g_star : effective shear modulus [pressure], > 0.
    friction_coefficient : mu > 0 [1].
    tangential_displacement, tangential_force : exactly one, the amplitude, >= 0
        [length], [force]. Arrays broadcast with the normal loads.

    Raises
    ------
    InputError : a contact whose radius was given; an amplitude that is negative or not finite;
        a force amplitude above mu F_N; a rim that would reach past the profile's end.

    Examples
    --------
    Eq. (5.89): for c -> 0 the wear radius of a paraboloid tends to sqrt(2) times the contact's.

    >>> from mdr_core import normal
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = normal.solve(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    >>> worn = solve(contact, 1.0, 0.5, tangential_displacement=[0.375, 0.5])
    >>> [float(f"{c:.6g}") for c in worn.stick_radius]
    [0.5, 0.0]
    >>> [float(f"{r:.5g}") for r in worn.wear_radius]
    [1.2298, 1.4142]
    """
    if contact.control == "contact_radius":
        raise InputError(
            ("load", "contact_radius"),
            "a contact radius cannot be held while it wears: give the depth or the normal force",
        )
    if any(isinstance(part, np.ndarray) for part in contact.profile.parameters.values()):
        raise InputError(("profile",), "the rim of one profile at a time: no arrays of parameters")
    amplitudes = (tangential_displacement, tangential_force)
    named = [(n, value) for n, value in zip(_NAMES, amplitudes, strict=True) if value is not None]
    if len(named) != 1:
        raise InputError(("oscillation",), f"exactly one of {', '.join(_NAMES)} is needed")
    name, size = named[0][0], np.asarray(named[0][1], dtype=float)
    _require_amplitude(name, size)
    _require_range(contact)
    first = stick.first_slip(contact, g_star, friction_coefficient, name, size)
    result = LimitingWear(first, name, stick.find(first, name, size))
    _require_room(result)
    return result


def _require_range(contact: NormalContact) -> None:
    """Refuse contacts whose square or cube, and with it the rim's integrals, is no double."""
    radius = np.asarray(contact.contact_radius)
    beyond = (radius > 0) & ~((radius > 1 / _RANGE) & (radius < _RANGE))
    if beyond.any():
        raise InputError(
            ("load", contact.control, *first_index(beyond)),
            "the rim that wears under this load leaves the range of double precision",
        )


def _require_amplitude(name: str, size: Array) -> None:
    low, high = extremes(size)
    if not (low >= 0 and high < inf):
        index = first_index(~((size >= 0) & (size < inf))) if size.size else ()
        raise InputError(("oscillation", name, *index), "must be finite and not negative")


def _require_room(wear: LimitingWear) -> None:
    """Refuse a worn rim that would reach past the profile's end."""
    profile = wear.first.normal.profile
    if profile.slips_at_once or not float(profile.domain) < inf:
        return
    rim, wearing = wear.rim, (wear.stuck.step > 0) & ~wear.stuck.endless
    step = np.ravel(np.where(wearing, wear.stuck.step, 0.0))
    beyond = (rim.mean_rise(rim.room) < step).reshape(wear.stuck.step.shape)
    if beyond.any():
        raise InputError(
            ("load", wear.first.normal.control, *first_index(beyond)),
            f"the worn rim would reach past radius {float(profile.domain):.12g}, where the "
            "profile ends: the limit of a larger body, or of a smaller load, exists",
        )
