"""Partial slip under one monotonic tangential load."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import conditioning, equivalent_1d, materials
from mdr_core.doubles import EPS, ROUNDING
from mdr_core.elementwise import broadcast, number, quotient, some, where
from mdr_core.extrema import largest_stress
from mdr_core.interval_moments import interval_moments
from mdr_core.materials import Material
from mdr_core.normal import NormalContact, SlippingContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import (
    as_positive,
    common_shape,
    only_one,
    reject,
    require_finite,
    require_type,
)

CONTROLS: Final = {
    "tangential_force": "normal_force",
    "tangential_displacement": "indentation_depth",
    "stick_radius": "contact_radius",
}
"""Tangential loads, and the quantities of the normal contact that limit them."""

# Relative rounding error of the full-slip displacement mu (E*/G*) d, which has three products.
_LIMIT_ERROR: Final = 1.5 * EPS

# Above this relative error of a stick radius, its effect is computed instead of linearised.
_LINEAR: Final = 0.1

# Step of depth or force between two contact coordinates.
_Step = Callable[[Profile, Array, Array, Array], Array]


@dataclass(frozen=True, repr=False)
class TangentialContact(SlippingContact):
    """Normal contact under a tangential load, at any number of pairs of loads.

    Results are arrays over the broadcast loads. Each is computed on first use.
    """

    normal: NormalContact
    g_star: Parameter
    friction_coefficient: Parameter
    stick_coordinate: Array
    """Stick radius in the contact coordinate of the profile; undefined in full slip."""
    width: Array
    """Distance of the stick edge from the contact edge in that coordinate, free of cancellation."""
    sign: Array
    """Direction of the load, 1 or -1."""
    full_slip: Flags
    """True in full slip."""
    excess: Array
    """Displacement beyond the onset of full slip [length]."""
    control: str = "tangential_displacement"
    """Name of the prescribed tangential load."""
    quantities: ClassVar[tuple[str, ...]] = (
        "tangential_force",
        "tangential_displacement",
        "stick_radius",
        "slip_width",
        "tangential_stiffness",
        "dissipated_energy",
        "regime",
    )

    @cached_property
    def _coordinate(self) -> Array:
        return broadcast(self.normal.coordinate, self.width.shape)

    @cached_property
    def limiting_force(self) -> Array:
        """mu F_N [force]."""
        return self.friction_coefficient * self.normal.normal_force

    @cached_property
    def displacement_ratio(self) -> Parameter:
        """mu E*/G* [1], ratio of the tangential displacement to the difference of depths.

        Source: mdr-5, Eq. (5.20).
        """
        return self.friction_coefficient * self.normal.e_star / self.g_star

    @cached_property
    def tangential_force(self) -> Array:
        """F_x = mu [F_N(a) - F_N(c)] [force]. Source: mdr-5, Eq. (5.19)."""
        partial = self._over_annulus(equivalent_1d.force_step, 1.0)
        return self.sign * where(self.full_slip, self.limiting_force, partial)

    @cached_property
    def tangential_displacement(self) -> Array:
        """u_x = mu (E*/G*) [d(a) - d(c)] [length]. Source: mdr-5, Eqs. (5.20), (5.33)."""
        size = self._over_annulus(equivalent_1d.depth_step, self.g_star)
        if some(self.full_slip):
            size = where(self.full_slip, self._full_slip_displacement + self.excess, size)
        return self.sign * size

    def _over_annulus(self, step: _Step, divisor: Parameter) -> Array:
        """Step of depth or force over the annulus, times mu E*/divisor."""
        ends = self._coordinate, self.width, self.stick_coordinate
        rise = step(self.normal.profile, *ends)
        # mu and G* are often single numbers while E* is an array.
        return self.friction_coefficient / divisor * self.normal.e_star * rise

    @cached_property
    def _full_slip_displacement(self) -> Array:
        """mu (E*/G*) d [length], at the onset of full slip. Source: mdr-5, Eq. (5.17)."""
        return self.displacement_ratio * self.normal.indentation_depth

    @cached_property
    def slip_width(self) -> Array:
        """a - c [length]."""
        width = 0 * self.width if self.normal.profile.is_flat_punch else self.width
        return where(self.full_slip, self.normal.contact_radius, width)

    @cached_property
    def stick_radius(self) -> Array:
        """c [length]: zero in full slip. Source: mdr-5, Eqs. (5.11), (5.16), (5.31), (5.49)."""
        profile = self.normal.profile
        c = profile.contact_radius(self.stick_coordinate)
        if c is not self.stick_coordinate:
            # Rounding errors may lead to c > a. Without slip c and a are bit-identical.
            a = self.normal.contact_radius
            c = where(self.width > 0, np.minimum(c, a), a)
        return where(self.full_slip, 0.0, c)

    @cached_property
    def tangential_stiffness(self) -> Array:
        """dF_x/du_x = 2 G* c on further loading [force/length]. Source: mdr-5, Eq. (5.1)."""
        return 2 * self.g_star * self.stick_radius

    @cached_property
    def maximum_shear_stress(self) -> Array:
        """Largest |tau(r)| [pressure], zero without a tangential load.

        It is infinite if the slip annulus, including both ends, contains a radius of infinite
        pressure.
        """
        loaded = self.tangential_force != 0
        stress = largest_stress(self.normal.profile, self._coordinate, loaded, self._slipping)
        return self.friction_coefficient * self.normal.e_star * stress

    @property
    def _slipping(self) -> tuple[Array, Array]:
        """Width of the slip annulus and stick radius in the contact coordinate."""
        width = where(self.full_slip, self._coordinate, self.width)
        return width, where(self.full_slip, 0.0, self.stick_coordinate)

    @cached_property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Regime: "stick", "partial_slip" or "full_slip"."""
        slipping = where(self.slip_width > 0, np.str_("partial_slip"), np.str_("stick"))
        return where(self.full_slip, np.str_("full_slip"), slipping)

    @cached_property
    def dissipated_energy(self) -> Array:
        """Energy dissipated by friction since the load was zero [force length].

        (2 mu^2 E*^2/G*) int_c^a (g(a) - g)(g - g(c)) dx, a quarter of the energy of a full cycle of
        this amplitude, plus mu F_N times the displacement beyond the onset of full slip. Source:
        notes, §6.
        """
        profile, e_star = self.normal.profile, self.normal.e_star
        moment = slip_moment(profile, self._coordinate, *self._slipping)
        slipping = 2 * self.friction_coefficient * self.displacement_ratio * e_star * moment
        return slipping + self.limiting_force * self.excess

    @property
    def method(self) -> str:
        """Most expensive method among the results."""
        return self.normal.profile.tangential_method

    @cached_property
    def _width_rounding(self) -> Array:
        """Relative error of a - c due to the rounding of the edges [1]."""
        normal, profile = self.normal, self.normal.profile
        error = conditioning.of_edge_slope(normal)
        if self.control == "stick_radius":
            narrow = conditioning.narrow_annulus(self._coordinate, self.width)
            error = error + normal.edge_errors * narrow
        elif profile.steepens:
            scale = self.friction_coefficient * normal.e_star
            displacement, force = abs(self.tangential_displacement), abs(self.tangential_force)
            steps = displacement * self.g_star / scale, force / scale
            lost = conditioning.of_steep_edge(profile, self.stick_coordinate, steps)
            error = error + where(self.full_slip, 0.0, lost)
        return error

    @cached_property
    def _limit_rounding(self) -> Parameter:
        """Relative error of results due to the rounding of the load at full slip [1].

        It is `limit_error` times the largest condition number of the results. A load that equals
        the full-slip load in double precision is in full slip.
        """
        if self.control == "stick_radius":
            return 0.0
        of_force, (size, limit) = self.control == "tangential_force", self._load_and_limit
        partial = (limit > 0) & ~self.full_slip
        ratio = where(partial, quotient(size, limit), 0.0)
        ends = self._coordinate, self.stick_coordinate
        condition = conditioning.near_full_slip(
            self.normal.profile, ends, ratio, partial, force_prescribed=of_force
        )
        if some(self.excess > 0):
            # The displacement beyond full slip adds to the condition of the dissipated energy.
            share = quotient(self.limiting_force * size, self.dissipated_energy)
            condition = condition + where(self.excess > 0, share, 0.0)
        return self.limit_error * condition

    @property
    def step_error(self) -> Array:
        """Relative error of each case, apart from the rounding of the load at full slip [1]."""
        return conditioning.OF_SUMS * self.normal.error_estimates + self._width_rounding

    @property
    def stick_error(self) -> Array:
        """Rounding error of a stick radius that follows from a load [length]."""
        c = self.stick_radius
        if self.control == "stick_radius":
            return 0 * c
        error = c * (ROUNDING + self._limit_rounding)
        if some(late := self._limit_rounding > _LINEAR):
            size, limit = self._load_and_limit
            profile, of_force = self.normal.profile, self.control == "tangential_force"
            moved = ROUNDING * c
            for side in (-1, 1):
                rest = np.maximum((limit - size) / limit + side * self.limit_error, 0.0)
                ends = self._coordinate, 1 - rest, rest
                edge, _ = equivalent_1d.stick_edge(profile, *ends, of_force=of_force)
                moved = np.maximum(moved, np.abs(profile.contact_radius(edge) - c))
            error = where(late, moved, error)
        return error + self.slip_width * self._width_rounding

    @property
    def limit_error(self) -> Parameter:
        """Errors of the full-slip load and of the distance from it, relative to that load [1]."""
        if self.normal.control != CONTROLS[self.control]:
            return self.normal.error_estimates
        if self.control == "tangential_displacement":
            return _LIMIT_ERROR
        # The product mu F_N is rounded by half a unit in its last place.
        limit = self.limiting_force
        return quotient(np.spacing(limit), 2 * limit)

    @cached_property
    def error_estimates(self) -> Array:
        """Upper bound of the relative error of each case, rounding of its loads included [1]."""
        return self.step_error + self._limit_rounding

    @property
    def _load_and_limit(self) -> tuple[Array, Array]:
        """Magnitude of the prescribed load and of the full-slip load."""
        if self.control == "tangential_force":
            return np.abs(self.tangential_force), self.limiting_force
        return np.abs(self.tangential_displacement), self._full_slip_displacement


def solve(
    contact: NormalContact,
    g_star: Parameter | Material | None,
    friction_coefficient: Parameter,
    *,
    tangential_force: ArrayLike | None = None,
    tangential_displacement: ArrayLike | None = None,
    stick_radius: ArrayLike | None = None,
) -> TangentialContact:
    """Return the partial slip of a normal contact under one monotonic tangential load.

    F_x = mu [F_N(a) - F_N(c)] and u_x = mu (E*/G*) [d(a) - d(c)] for every profile. Slip spreads
    inwards from the edge as the load grows. A flat punch sticks completely up to full slip, and
    slip does not spread into the flat of a flat-ended profile.

    Source: mdr-5, Eqs. (5.18)-(5.23), (5.33), Problem 3.

    Parameters
    ----------
    contact : the normal contact, from `mdr_core.normal.solve`.
    g_star : effective shear modulus [pressure], > 0, or the material that has it.
    friction_coefficient : mu > 0 [1].
    tangential_force, tangential_displacement, stick_radius : exactly one; the first two of
        either sign [force], [length], [length]. Arrays broadcast with the normal loads.

    Raises
    ------
    InputError : |F_x| > mu F_N, where there is no equilibrium; a stick radius outside the contact
        or inside the flat; not exactly one load; parameters that are not positive.

    Examples
    --------
    Eq. (5.16): c/a = (1 - F_x/(mu F_N))^(1/3).

    >>> from mdr_core import normal
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = normal.solve(Paraboloid(0.01), 1.1e11, normal_force=10.0)
    >>> partial = solve(contact, 0.9e11, 0.3, tangential_force=[0.0, 2.625])
    >>> [float(f"{c:.6g}") for c in partial.stick_radius / contact.contact_radius]
    [1.0, 0.5]
    """
    require_type("contact", contact, NormalContact, "a contact from normal.solve")
    modulus: Parameter = materials.modulus("g_star", g_star)
    friction_coefficient = as_positive(("friction_coefficient",), friction_coefficient)
    loads = (tangential_force, tangential_displacement, stick_radius)
    name, given = only_one(("tangential",), dict(zip(CONTROLS, loads, strict=True)))
    require_finite(("tangential", name), given)
    parameters = (modulus, friction_coefficient)
    others = "the normal loads", contact.coordinate
    shape = common_shape(("tangential", name), given, *others, *parameters)
    if name == "stick_radius":
        zone = _by_radius(contact, given)
    else:
        zone = _by_load(contact, *parameters, name, given)
    edge, width, sign, full_slip, excess = zone
    ends = broadcast(edge, shape), broadcast(width, shape)
    result = TangentialContact(contact, *parameters, *ends, sign, full_slip, excess, control=name)
    if given.shape == shape:
        # The prescribed load is returned bit-identical.
        vars(result)[name] = given
    return result


# Stick edge, width, sign, full slip and excess: see `TangentialContact`.
_StickZone = tuple[Array, Array, Array, Flags, Array]


def _by_load(
    contact: NormalContact, g_star: Parameter, friction: Parameter, name: str, given: Array
) -> _StickZone:
    """Return the stick zones under forces or displacements.

    Raises InputError for a force without equilibrium. Source: mdr-5, Eqs. (5.18)-(5.23).
    """
    of_force = name == "tangential_force"
    # The load at the onset of full slip.
    ratio = friction if of_force else friction * contact.e_star / g_star
    limit = ratio * getattr(contact, CONTROLS[name])
    sign, size = where(given < 0, -1.0, 1.0), np.abs(given)
    left = limit - size
    if of_force:
        detail = (
            "no equilibrium: the force exceeds friction_coefficient x normal_force; reduce it, "
            "or prescribe tangential_displacement"
        )
        reject(("tangential", name), size, left < 0, detail)
    loaded = limit > 0
    # Without loads there is no slip; without a normal load any displacement is full slip.
    full_slip = where(loaded, left <= 0, size > 0)
    excess = np.maximum(-left, 0.0)
    size, left = np.minimum(size, limit), where(loaded, np.maximum(left, 0.0), 1.0)
    limit = where(loaded, limit, 1.0)
    ratios = size / limit, left / limit
    ends = equivalent_1d.stick_edge(contact.profile, contact.coordinate, *ratios, of_force=of_force)
    return *ends, sign, full_slip, excess


def _by_radius(contact: NormalContact, radius: Array) -> _StickZone:
    """Return the stick zones of prescribed radii.

    Raises InputError for a radius that the contact does not have.
    """
    profile, a = contact.profile, contact.contact_radius
    innermost = profile.first_radius
    slip = number(1.0), (radius == 0) & (a > 0), number(0.0)
    bad = (radius > a) | (radius < 0) | ((radius > 0) & (radius < innermost))
    detail = "must lie between the flat's radius, or 0, and the contact radius"
    if profile.is_flat_punch:
        bad = bad | (radius > 0)
        detail = "a flat punch has no slip annulus: prescribe tangential_force or another load"
    reject(("tangential", "stick_radius"), radius, bad, detail)
    if profile.is_flat_punch:
        return 0 * radius, contact.coordinate + 0 * radius, *slip
    c = np.maximum(radius, innermost)
    return profile.coordinate_from_radius(c), contact.width_outside(c), *slip


def slip_moment(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return int_c^a (g(a) - g(x)) (g(x) - g(c)) dx [length^3].

    With D = g(a) - g(c) and t = (g(x) - g(c))/D it is (D^2/4) int 2t(1-t) 2 dx, a Bernstein moment
    of the springs.

    Source: notes, §6. Parameters: see `depth_step`.
    """
    shape = np.broadcast_shapes(coordinate.shape, width.shape, stick.shape)
    high, width, low = (np.broadcast_to(end, shape).ravel() for end in (coordinate, width, stick))
    swept = {name: np.broadcast_to(profile.parameters[name], shape) for name in profile.swept}
    profile = profile.with_parameters({name: column.ravel() for name, column in swept.items()})
    span = equivalent_1d.depth_step(profile, high, width, low)
    moments = interval_moments(profile, over_forces=False)
    found = moments.over(profile.depth(low), span, np.array([low, high]))
    return np.asarray(np.square(span) * found.weights[1] / 4).reshape(shape)[()]
