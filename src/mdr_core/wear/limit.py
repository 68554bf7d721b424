"""Limiting state of fretting wear in partial slip: shape, pressure, radii and forces."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields, tangential, validity
from mdr_core.doubles import ADJACENT, EPS
from mdr_core.elementwise import broadcast, in_blocks, some, where
from mdr_core.errors import AccuracyError, InputError, Notice, Remedy
from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.tangential import CONTROLS, TangentialContact
from mdr_core.typing import Array, Parameter
from mdr_core.validation import (
    UNRESOLVED,
    checked_radii,
    extremes,
    first_index,
    require_single_profile,
    require_type,
)
from mdr_core.wear import limiting_stick, worn_annulus
from mdr_core.wear.arguments import grid, one_amplitude

# Upper bound of the exponent of the slip width in the worn volume.
_OF_VOLUME: Final = 3.0
# Lower bound of the largest worn depth over (2/pi) (d - g(c)) arccos(c/r) at the outer edge; the
# ratio is 0.38 for a narrow annulus.
_HIGHEST: Final = 0.2
_WARNINGS: Final = {
    "path_dependent": "with a constant normal force and displacement amplitude the depth grows, "
    "the stick zone grows over worn material, and the limit depends on the load path: this is "
    "Eq. (5.90) of Popov and Heß; use the evolution over the cycles instead",
    "singular": "the pressure in the limit is infinite at the stick radius, as under the edge of "
    "a flat punch",
    "no_wear": "nothing slips, so nothing wears: the limit is the profile itself",
    "contact_lost": "the whole contact slips and wears until nothing touches at the constant depth",
    "endless_wear": "the whole contact slips under the constant force, and wear is unbounded: "
    "depth, wear radius and worn volume are infinite",
}
_INSTEAD: Final[dict[str, Remedy]] = dict.fromkeys(
    ("path_dependent", "endless_wear"), "wear_evolution"
)


@dataclass(frozen=True, repr=False)
class LimitingWear(validity.ContactResults):
    """Limiting state, in which the slip annulus carries no pressure; arrays over the loads.

    In full slip under a constant force the wear is unbounded: depth, wear radius and worn volume
    are infinite. In full slip at a constant depth it ends where nothing touches.
    """

    tangential_contact: TangentialContact
    """The contact before any wear, with the amplitude applied once."""
    stick_zone: limiting_stick.LimitingStick
    quantities: ClassVar[tuple[str, ...]] = (
        "stick_radius",
        "wear_radius",
        "indentation_depth",
        "normal_force",
        "worn_volume",
        "regime",
    )

    @property
    def solved(self) -> TangentialContact:
        """Contact on which the validity depends."""
        return self.tangential_contact

    @property
    def normal(self) -> NormalContact:
        """Normal contact before any wear."""
        return self.tangential_contact.normal

    @property
    def stick_radius(self) -> Array:
        """Stick radius c [length]: inside it nothing wears. Source: mdr-5, Eq. (5.80)."""
        return self.stick_zone.radius

    @cached_property
    def wear_width(self) -> Array:
        """Width of the worn annulus [length], free of cancellation however narrow it is."""
        rests = self.stick_zone.step <= 0
        if self.normal.profile.is_flat_punch:
            worn = where(rests, 0.0, self.normal.contact_radius)
        else:
            target = where(self.stick_zone.unbounded, 0.0, self.stick_zone.step)
            start = where(target > 0, self.stick_zone.slip_width, 1.0)
            flat = (np.ravel(part) for part in (self.stick_zone.radius, target, start))
            worn = worn_annulus.width_where_worn(self.normal.profile, *flat).reshape(target.shape)
        return where(self.stick_zone.unbounded, inf, worn)

    @cached_property
    def wear_radius(self) -> Array:
        """Outer radius of the worn annulus, where the worn depth vanishes [length].

        Source: mdr-5, Eq. (5.88), for any profile; notes, §9.
        """
        return self.stick_zone.radius + self.wear_width

    @cached_property
    def indentation_depth(self) -> Array:
        """Depth d [length]: constant, or g(c) and the step at the stick edge."""
        zone = self.stick_zone
        if self.normal.control == "indentation_depth":
            return broadcast(self.normal.indentation_depth, zone.step.shape)
        return self.normal.profile.depth(zone.coordinate) + zone.step

    @cached_property
    def normal_force(self) -> Array:
        """Normal force [force]: constant, or F_N(c) + 2 E* c (d - g(c)).

        Source: mdr-5, Eq. (5.90), for any profile.
        """
        contact, zone = self.normal, self.stick_zone
        if contact.control == "normal_force":
            return broadcast(contact.normal_force, zone.step.shape)
        inside = contact.profile.reduced_force(zone.coordinate)
        return contact.e_star * (inside + 2 * zone.radius * zone.step)

    @cached_property
    def tangential_displacement(self) -> Array:
        """Amplitude u_x [length]: constant, or mu (E*/G*) (d - g(c))."""
        contact, stick_zone = self.tangential_contact, self.stick_zone
        displacement = contact.tangential_displacement
        if contact.control == "tangential_displacement":
            return broadcast(displacement, stick_zone.step.shape)
        if not self.normal.profile.is_flat_punch:
            displacement = contact.displacement_ratio * stick_zone.step
        return where(stick_zone.unbounded | stick_zone.separated, inf, displacement)

    @cached_property
    def tangential_force(self) -> Array:
        """Amplitude F_x [force]: constant, or 2 mu E* c (d - g(c))."""
        contact = self.tangential_contact
        if contact.control == "tangential_force" or self.normal.profile.is_flat_punch:
            return where(self.stick_zone.separated, 0.0, contact.tangential_force)
        unbounded, modulus = self.stick_zone.unbounded, 2 * self.normal.e_star
        carried = modulus * self.stick_zone.radius * where(unbounded, 0.0, self.stick_zone.step)
        return where(unbounded, contact.limiting_force, contact.friction_coefficient * carried)

    @cached_property
    def worn_volume(self) -> Array:
        """4 int_c^r (d - g(x)) sqrt(r^2 - x^2) dx over the worn annulus [length^3].

        Source: notes, §9.
        """
        flat, zone = np.ravel(self.wear_width), self.stick_zone
        # Without slip there is no annulus, and in full slip under a constant force no end of it.
        volume, worn = np.where(flat > 0, inf, 0.0), np.flatnonzero((flat > 0) & (flat < inf))
        c, step = (np.ravel(part)[worn] for part in (zone.radius, zone.step))
        volume[worn] = worn_annulus.worn_volume(self.normal.profile, c, flat[worn], step)
        return volume.reshape(self.wear_width.shape)[()]

    @cached_property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Slip regime: "stick" (nothing wears), "partial_slip" or "full_slip"."""
        wearing = where(self.stick_zone.step > 0, np.str_("partial_slip"), np.str_("stick"))
        slides = self.stick_zone.unbounded | self.stick_zone.separated
        return where(slides, np.str_("full_slip"), wearing)

    def initial_profile(self, radius: ArrayLike) -> Array:
        """Return the profile before wear, f(r) [length], (m,).

        Raises
        ------
        InputError : a radius that is negative, not finite or beyond the profile's end.
        """
        return self.normal.profile.f(self._radii(radius))

    def limiting_profile(self, radius: ArrayLike) -> Array:
        """Return the limiting profile [length], (loads, m), or (m,) for a single load.

        f in the stick zone and outside the worn annulus; in the annulus
        (2/pi) int_0^c g(x)/sqrt(r^2 - x^2) dx + (2/pi) d arccos(c/r).

        Source: mdr-5, Eqs. (5.83), (5.85). Errors as for `initial_profile`.
        """
        return self.initial_profile(radius) + self.worn_depth(radius)

    def worn_depth(self, radius: ArrayLike) -> Array:
        """Return (2/pi) int_c^r (d - g(x))/sqrt(r^2 - x^2) dx in the worn annulus [length].

        Never negative, zero in the stick zone and outside the annulus. Source: mdr-5, Eqs. (5.75),
        (5.82); notes, §9. Shape and errors as for `limiting_profile`.
        """
        r, profile = self._radii(radius), self.normal.profile
        parts = self.stick_zone.radius, self.wear_radius, self.stick_zone.step
        c, end, step = (np.ravel(part)[:, None] for part in parts)
        # In full slip the axis wears as well, and a flat punch wears up to its edge.
        worn = (r <= end if profile.is_flat_punch else r < end) & ((r > c) | (c == 0)) & (step > 0)
        result, (load, place) = np.zeros(worn.shape), np.nonzero(worn)
        for block in in_blocks(load.size):
            which, at, inner = load[block], r[place[block]], c[load[block], 0]
            lag = profile.slip_integral(inner, at)
            share = np.where(at > 0, 2 / np.pi * worn_annulus.angle(inner, at - inner), 1.0)
            # At the outer edge of the annulus the terms cancel except for rounding error.
            result[which, place[block]] = np.maximum(share * step[which, 0] - lag, 0.0)
        return result.reshape(self.wear_radius.shape + r.shape)

    def pressure(self, radius: ArrayLike) -> Array:
        """Return the pressure in the limit, (loads, m), or (m,) for a single load [pressure].

        (E*/pi) [int_r^c g'(x)/sqrt(x^2 - r^2) dx + (d - g(c))/sqrt(c^2 - r^2)] inside the stick
        zone, infinite at its edge, zero in the worn annulus.

        Source: mdr-5, Eqs. (5.34), (5.79), (5.82); notes, §9.

        Raises
        ------
        InputError : a radius that is negative or not finite.
        """
        zone, normal, r = self.stick_zone, self.normal, checked_radii(radius)
        c, step = (np.asarray(part)[..., None] for part in (zone.radius, zone.step))
        inside = (r <= c) & (c > 0) & (step > 0)
        root = np.sqrt(np.where(inside, (c - r) * (c + r), 1.0))
        unworn = NormalContact(normal.profile, 1.0, zone.coordinate, normal.control)
        with np.errstate(divide="ignore"):
            whole = fields.pressure(unworn, r) + np.where(inside, step / (np.pi * root), 0.0)
        return np.asarray(np.asarray(normal.e_star)[..., None] * whole)

    def grid(self, points: int) -> Array:
        """Return radii from 0 to a quarter beyond the largest worn annulus [length], (points,).

        They cluster at the axis, the breaks, and every load's c, a and wear radius.

        Raises
        ------
        InputError : fewer points than there are such radii.
        """
        edges = self.stick_radius, self.normal.contact_radius, self.wear_radius
        return grid(self.normal.profile, np.concatenate([np.ravel(part) for part in edges]), points)

    def _radii(self, radius: ArrayLike) -> Array:
        return checked_radii(radius, float(self.normal.profile.domain))

    @property
    def method(self) -> str:
        """Most expensive method: the outer edge of the annulus is a root of a quadrature."""
        method = self.normal.profile.tangential_method
        return "quadrature" if method == "closed_form" else method

    @property
    def error_estimate(self) -> float:
        """Bound on the relative error of every quantity without a radius."""
        contact, width_error = self.tangential_contact, self.stick_zone.width_error
        lost = float(self.edge_rounding.max(initial=0.0))
        if CONTROLS[contact.control] == contact.normal.control:
            return contact.error_estimate + lost
        # The stick radius before wear has no effect, not even at the onset of full slip.
        return extremes(contact.step_error + _OF_VOLUME * width_error)[1] + lost

    @property
    def edge_rounding(self) -> Array:
        """Relative error of the worn volumes for c next to a flat or a slope jump, (loads,).

        The slope of g has a root or a pole there, and the distance is a difference of radii.
        """
        c, width = (np.ravel(x)[:, None] for x in (self.stick_radius, self.wear_width))
        profile = self.normal.profile
        edges = np.array([profile.first_radius, *profile.infinite_pressure_radii], dtype=float)
        beyond = c - edges
        worn = (edges > 0) & (beyond >= 0) & (np.ravel(self.stick_zone.step)[:, None] > 0)
        gap = np.where(worn, np.maximum(beyond, EPS * edges), 1.0)
        # No width at all is found where the distance is dominated by rounding error.
        size = np.sqrt(gap * (gap + np.where(width < inf, width, 0.0)))
        rounding = np.where(worn, EPS * edges / size, 0.0).max(axis=1, initial=0.0)
        return np.asarray(_OF_VOLUME * rounding)

    def field_error_estimate(self, radius: ArrayLike, quantities: Iterable[str]) -> float:
        """Return the error of fields due to the error of the stick radius [1].

        It is relative to the largest worn depth, and to each value of the pressure, which is
        infinite at the stick radius. Radii within four units in the last place of it are excluded.

        Parameters
        ----------
        radius : radii of the fields [length], (m,).
        quantities : names of the fields.
        """
        names, zone = set(quantities), self.stick_zone
        c, error, step = (np.ravel(part)[:, None] for part in (zone.radius, zone.error, zone.step))
        r, end = checked_radii(radius), np.ravel(self.wear_radius)[:, None]
        away = np.abs(r - c)
        product = np.where((away <= ADJACENT * c) | (step <= 0), inf, away * (r + c))
        found, error = [0.0], error + EPS * c
        if "pressure" in names:
            # Bound of the relative change of 1/sqrt(c - r); infinite where c may pass r.
            changes = error / np.where(product < inf, away, inf)
            found.append(np.max(np.where(r < c + error, changes, 0.0)))
        if names & {"worn_depth", "limiting_profile"}:
            highest = _HIGHEST * worn_annulus.angle(c, np.ravel(self.wear_width)[:, None])
            worn = (c > 0) & (c - error < r) & (r < end + error)
            with np.errstate(divide="ignore", invalid="ignore"):
                found.append(np.max(np.where(worn, error / (highest * np.sqrt(product)), 0.0)))
        return float(max(found))

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies.

        Codes: `path_dependent`, `singular`, `no_wear`, `contact_lost`, `endless_wear`.
        """
        wears = self.stick_zone.step > 0
        controls = self.normal.control, self.tangential_contact.control
        path_dependent = controls == ("normal_force", "tangential_displacement")
        raised = {
            "path_dependent": path_dependent & wears & ~self.stick_zone.unbounded,
            "singular": wears & (self.stick_radius > 0),
            "no_wear": self.regime == "stick",
            "contact_lost": self.stick_zone.separated,
            "endless_wear": self.stick_zone.unbounded,
        }
        codes = [code for code, flags in raised.items() if some(flags)]
        own = [Notice(code, _WARNINGS[code], instead=_INSTEAD.get(code)) for code in codes]
        return (*super().warnings_without_bodies, *own)


def solve(
    contact: NormalContact,
    g_star: Parameter | Material | None,
    friction_coefficient: Parameter,
    *,
    tangential_displacement: ArrayLike | None = None,
    tangential_force: ArrayLike | None = None,
) -> LimitingWear:
    """Solve for the limiting state of fretting wear under a small tangential oscillation.

    The annulus c < r outside the stick zone wears until it carries no load: there g rises to d, and
    f = (2/pi) int g/sqrt(r^2 - x^2) dx follows, up to where it meets the unworn profile. Exact for
    a constant depth and for constant amplitudes of both forces. For a constant normal force and
    displacement amplitude it is Eq. (5.90), with the warning `path_dependent`.

    Source: mdr-5, Eqs. (5.80)-(5.90); notes, §9.

    Parameters
    ----------
    contact : from `mdr_core.normal.solve`, of one profile under a depth or a normal force.
    g_star : effective shear modulus [pressure], > 0, or the material that has it.
    friction_coefficient : mu > 0 [1].
    tangential_displacement, tangential_force : exactly one, the amplitude, >= 0
        [length], [force]. Arrays broadcast with the normal loads.

    Raises
    ------
    InputError : a prescribed contact radius; an amplitude that is negative or not finite; a force
        amplitude above mu F_N; an annulus that would reach beyond the end of the profile.
    AccuracyError : a contact next to the edge of a flat in whose rounding error its annulus lies.

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
    require_type("contact", contact, NormalContact, "a contact from normal.solve")
    if contact.control not in {"indentation_depth", "normal_force"}:
        detail = "changes during wear: prescribe the depth or the normal force"
        raise InputError(("load", contact.control), detail)
    require_single_profile(contact.profile.swept)
    name, size = one_amplitude(tangential_displacement, tangential_force)
    unworn = tangential.solve(contact, g_star, friction_coefficient, **{name: size})
    result = LimitingWear(unworn, limiting_stick.find(unworn, size))
    lost = result.edge_rounding > UNRESOLVED
    if lost.any():
        raise AccuracyError(
            "the worn annulus lies within the rounding error of its distance from the edge of a "
            "flat, or from a jump of the slope: increase the load",
            ("load", contact.control, *first_index(lost.reshape(np.shape(result.wear_width)))),
        )
    beyond = ~result.stick_zone.unbounded & ~np.isfinite(result.wear_width)
    if beyond.any():
        detail = "the worn annulus under this load leaves the range of double precision"
        if np.isfinite(contact.profile.domain):
            detail = (
                f"the worn annulus would reach beyond radius {float(contact.profile.domain):.12g}, "
                "where the profile ends: reduce the load, or extend the profile"
            )
        raise InputError(("load", contact.control, *first_index(beyond)), detail)
    return result
