"""Partial slip under one monotonic tangential load: which part sticks, and how far it moves."""

from collections.abc import Callable
from dataclasses import dataclass
from math import prod
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import annulus, sensitivity
from mdr_core.checks import require_positive
from mdr_core.errors import InputError, Notice
from mdr_core.lazy import cached_property
from mdr_core.normal import Load, NormalContact
from mdr_core.partial_slip import CONTROLS, state, state_of_sweep
from mdr_core.profiles import Profile
from mdr_core.sweeps import BLOCK, scene_by_scene
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validity import friction_notices

# Rounding of the steps over the annulus, in units of the profile's own.
_STEPS: Final = 40.0
# What a load is known to.
_ROUNDINGS: Final = 8 * 2.0**-52
# What an edge that follows from a load is known to.
_EDGES: Final = 2 * _ROUNDINGS


class Slip(NamedTuple):
    """One load's partial slip, as plain numbers."""

    normal: Load
    friction: float
    compliance: float
    g_star: float
    width: float
    c: float
    sign: float
    full: bool
    excess: float


@dataclass(frozen=True)
class TangentialContact:
    """A normal contact pushed sideways, at every pair of loads at once.

    Each answer is computed when it is first asked for; all are arrays over the broadcast loads.
    """

    normal: NormalContact
    g_star: Parameter
    friction_coefficient: Parameter
    stick_coordinate: Array
    """The stick zone's edge in the profile's contact coordinate; meaningless in full slip."""
    width: Array
    """Distance of the stick edge from the contact's edge in that coordinate, with its digits."""
    sign: Array
    """Direction of the load; a single 1 where all are positive."""
    full_slip: Flags
    """A single false where nowhere everything slips."""
    excess: Array
    """What the displacement exceeds the one at full slip by [length]; a single 0 for none."""
    control: str = "tangential_displacement"
    """Which of the three was given."""

    @cached_property
    def _coordinate(self) -> Array:
        return np.broadcast_to(self.normal.coordinate, self.width.shape)

    @cached_property
    def _stick(self) -> Array:
        return np.broadcast_to(self.stick_coordinate, self.width.shape)

    @cached_property
    def limiting_force(self) -> Array:
        """mu F_N [force]."""
        return np.asarray(self.friction_coefficient * self.normal.normal_force)

    @cached_property
    def compliance(self) -> Array:
        """mu E*/G* [1]: depth steps to tangential displacements, Eq. (5.20)."""
        return np.asarray(self.friction_coefficient * self.normal.e_star / self.g_star)

    @cached_property
    def tangential_force(self) -> Array:
        """F_x = mu [F_N(a) - F_N(c)] [force]. Source: mdr-5, Eq. (5.19)."""
        profile = self.normal.profile
        if profile.slips_at_once:
            partial = self.limiting_force * self.width
        else:
            partial = self._over_annulus(_partial_force)
        if self.full_slip.any():
            partial = np.where(self.full_slip, self.limiting_force, partial)
        return self._signed(partial)

    @cached_property
    def tangential_displacement(self) -> Array:
        """u_x = mu (E*/G*) [d(a) - d(c)] [length]. Source: mdr-5, Eqs. (5.20), (5.33)."""
        profile = self.normal.profile
        if profile.slips_at_once:
            # F_x/(2 G* a), which is mu (E*/G*) d at the limit.
            partial = self._largest_stick * self.width
        else:
            partial = self._over_annulus(_partial_displacement)
        if self.full_slip.any():
            partial = np.where(self.full_slip, self._largest_stick, partial) + self.excess
        return self._signed(partial)

    def _over_annulus(self, answer: Callable[..., Array]) -> Array:
        """What comes from the annulus, of the friction, the moduli and its ends."""
        values = (
            self.friction_coefficient,
            self.normal.e_star,
            self.g_star,
            self._coordinate,
            self.width,
            self._stick,
        )
        return scene_by_scene(self.width.size, answer, self.normal.profile, values)

    def _signed(self, size: Array) -> Array:
        return size if self.sign.ndim == 0 and self.sign > 0 else self.sign * size

    @cached_property
    def _largest_stick(self) -> Array:
        """mu (E*/G*) d [length], at which the last point lets go. Source: mdr-5, Eq. (5.17)."""
        return np.asarray(self.compliance * self.normal.indentation_depth)

    @cached_property
    def slip_width(self) -> Array:
        """a - c [length]."""
        a = self.normal.contact_radius
        if self.normal.profile.slips_at_once:
            return np.where(self.full_slip, a, np.zeros_like(self.width))
        width = self.normal.profile.radius_width(self._coordinate, self.width)
        return np.where(self.full_slip, a, width) if self.full_slip.any() else width

    @cached_property
    def stick_radius(self) -> Array:
        """c [length]: zero in full slip. Source: mdr-5, Eqs. (5.11), (5.16), (5.31), (5.49)."""
        profile = self.normal.profile
        if profile.slips_at_once:
            a = np.broadcast_to(self.normal.contact_radius, self.width.shape)
            return np.where(self.full_slip, 0.0, a)
        c = profile.contact_radius(self._stick)
        if c is not self._stick:
            # The radius of a rounded coordinate may lie beyond the edge by its rounding; where
            # nothing slips the edges are the same, to the last digit.
            a = self.normal.contact_radius
            c = np.where(self.width > 0, np.minimum(c, a), a)
        return np.where(self.full_slip, 0.0, c) if self.full_slip.any() else c

    @cached_property
    def tangential_stiffness(self) -> Array:
        """dF_x/du_x = 2 G* c on further loading [force/length]. Source: mdr-5, Eq. (5.1)."""
        return 2 * self.g_star * self.stick_radius

    @cached_property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Regime: "stick", "partial_slip" or "full_slip"."""
        at_once = self.normal.profile.slips_at_once
        partial = "stick" if at_once else "partial_slip"
        slipping = np.where(self.width > 0, partial, "stick").astype("U12")
        return np.where(self.full_slip, "full_slip", slipping)

    @cached_property
    def dissipated_energy(self) -> Array:
        """Energy lost to friction on the way from zero [force length].

        (2 mu^2 E*^2/G*) int_c^a (g(a) - g)(g - g(c)) dx, a quarter of a cycle's, and mu F_N for
        every length beyond full slip. Source: notes, §6.
        """
        profile, e_star = self.normal.profile, self.normal.e_star
        if profile.slips_at_once:
            slipping = np.zeros_like(self.width)
        else:
            reach = self._coordinate - profile.first_coordinate
            width = np.where(self.full_slip, reach, self.width)
            stick = np.where(self.full_slip, profile.first_coordinate, self._stick)
            moment = annulus.slip_moment(profile, self._coordinate, width, stick)
            slipping = 2 * self.friction_coefficient * self.compliance * e_star * moment
        return slipping + self.limiting_force * self.excess

    @cached_property
    def slips(self) -> list[Slip]:
        """The loads one by one, for what is answered over the radius."""
        shape = self.width.shape
        parts = (
            self.friction_coefficient,
            self.compliance,
            self.g_star,
            self.width,
            self.stick_radius,
            self.sign,
            self.full_slip,
            self.excess,
        )
        # A single load has no need of what makes columns of numbers and arrays.
        columns = [
            np.broadcast_to(part, shape).tolist() if shape else [np.asarray(part).item()]
            for part in parts
        ]
        rows: list[Any] = list(zip(*columns, strict=True))
        pressed = self.normal.loads
        spread = pressed if len(pressed) == len(rows) else pressed * len(rows)
        at_once = self.normal.profile.slips_at_once
        return [
            # Where nothing slips before all does, the kernel takes the load itself as its width.
            part._replace(width=part.width * part.normal.coordinate) if at_once else part
            for part in (Slip(load, *row) for load, row in zip(spread, rows, strict=True))
        ]

    @property
    def method(self) -> str:
        """The dearest route among the answers."""
        return self.normal.profile.tangential_method

    @cached_property
    def error_estimate(self) -> float:
        """Bound on the relative error of each answer, what the loads' rounding does included."""
        known = self.normal.error_estimate
        felt = _ROUNDINGS * sensitivity.behind_break(self.normal)
        if self.control != "stick_radius":
            # What is left to full slip is as exact as the normal contact's force or depth.
            felt += known * self._felt_of_load
        elif self.normal.control != "contact_radius":
            felt += _EDGES * sensitivity.narrow_annulus(self._coordinate, self.width)
        return _STEPS * known + felt

    @property
    def _felt_of_load(self) -> float:
        """The most by which an answer changes relatively for a relative change of the load."""
        by_force = self.control == "tangential_force"
        size = np.abs(self.tangential_force if by_force else self.tangential_displacement)
        limit = self.limiting_force if by_force else self._largest_stick
        profile, partial = self.normal.profile, (limit > 0) & ~self.full_slip
        if profile.slips_at_once:
            return 1.0 if by_force else sensitivity.excess_of_travel(size, self.excess)
        ratio = np.where(partial, size / np.where(limit > 0, limit, 1.0), 0.0)
        ends = self._coordinate, self._stick
        return sensitivity.near_full_slip(profile, ends, ratio, partial, by_force=by_force)

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """Those of the normal contact, `friction`, and `accuracy` where rtol is missed."""
        found = [notice for notice in self.normal.warnings if notice.code != "accuracy"]
        found += friction_notices(self.friction_coefficient, self.normal.e_star, self.g_star)
        if self.error_estimate > self.normal.rtol:
            found.append(
                Notice(
                    "accuracy",
                    f"rtol = {self.normal.rtol:.1e} is below what double precision reaches here: "
                    "see error_estimate",
                )
            )
        return tuple(found)


def _partial_force(
    profile: Profile, friction: Parameter, e_star: Parameter, _g_star: Parameter, *ends: Array
) -> Array:
    return np.asarray(friction * e_star * annulus.force_step(profile, *ends))


def _partial_displacement(
    profile: Profile, friction: Parameter, e_star: Parameter, g_star: Parameter, *ends: Array
) -> Array:
    return np.asarray(friction * e_star / g_star * annulus.depth_step(profile, *ends))


def solve(
    contact: NormalContact,
    g_star: Parameter,
    friction_coefficient: Parameter,
    *,
    tangential_force: ArrayLike | None = None,
    tangential_displacement: ArrayLike | None = None,
    stick_radius: ArrayLike | None = None,
) -> TangentialContact:
    """Return the partial slip of a normal contact under one tangential load, applied once.

    F_x = mu [F_N(a) - F_N(c)] and u_x = mu (E*/G*) [d(a) - d(c)] for every profile; slip starts
    at the edge and the stick radius c falls as the load grows. A flat punch sticks wholly and
    slides at once, and slip cannot enter the flat of a blunt profile.

    Source: mdr-5, Eqs. (5.18)-(5.23), (5.33), Problem 3.

    Parameters
    ----------
    contact : the normal contact, from `mdr_core.normal.solve`.
    g_star : effective shear modulus [pressure], > 0.
    friction_coefficient : mu > 0 [1].
    tangential_force, tangential_displacement, stick_radius : exactly one; the first two of
        either sign [force], [length], [length]. Arrays broadcast with the normal loads.

    Raises
    ------
    InputError : |F_x| > mu F_N, which no equilibrium carries; a stick radius outside the
        contact or inside the flat; not exactly one load; parameters that are not positive.

    Examples
    --------
    Eq. (5.16): c/a = (1 - F_x/(mu F_N))^(1/3).

    >>> from mdr_core import normal
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = normal.solve(Paraboloid(0.01), 1.1e11, normal_force=10.0)
    >>> sideways = solve(contact, 0.9e11, 0.3, tangential_force=[0.0, 2.625])
    >>> [float(f"{c:.6g}") for c in sideways.stick_radius / contact.contact_radius]
    [1.0, 0.5]
    """
    for path, value in (
        (("material", "g_star"), g_star),
        (("friction_coefficient",), friction_coefficient),
    ):
        require_positive(path, value)
    loads = (tangential_force, tangential_displacement, stick_radius)
    named = [(name, load) for name, load in zip(CONTROLS, loads, strict=True) if load is not None]
    if len(named) != 1:
        raise InputError(("tangential",), f"exactly one of {', '.join(CONTROLS)} is needed")
    name, given = named[0][0], np.asarray(named[0][1], dtype=float)
    parameters = (g_star, friction_coefficient)
    shape = np.broadcast_shapes(
        given.shape, contact.coordinate.shape, *(np.shape(one) for one in parameters)
    )
    sweeps = prod(shape) > BLOCK
    found = state_of_sweep(contact, *parameters, name, given) if sweeps else None
    if found is None:
        found = state(contact, *parameters, name, given)
    result = TangentialContact(
        contact,
        *parameters,
        found.edge,
        np.broadcast_to(found.width, shape),
        found.sign,
        found.full,
        found.excess,
        name,
    )
    if given.shape == shape:
        # What was given is answered as given, to the last digit.
        vars(result)[name] = given
    return result
