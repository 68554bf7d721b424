"""Normal contact under a prescribed depth, force or contact radius."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final, Self

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import half_space, materials, validity
from mdr_core.doubles import ADJACENT, LARGEST, ROUNDING
from mdr_core.elementwise import broadcast, quotient, where
from mdr_core.equivalent_1d import coordinate_from_radius
from mdr_core.extrema import coordinate_from_pressure, largest_stress, pressure_and_slope
from mdr_core.materials import UNKNOWN, Material
from mdr_core.profiles import Profile, Tabulated
from mdr_core.profiles.base import NORMAL_QUANTITIES
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import (
    common_shape,
    extremes,
    only_one,
    require_not_negative,
    require_representable,
    require_type,
)

CONTROLS: Final = ("indentation_depth", "normal_force", "contact_radius")
# Relative error of a searched maximum. Source: notes, §7.
_OF_MAXIMUM: Final = 3e-13

# Gauss's rule for the error of pressures, an estimate: nodes on each of equal intervals.
_OF_PRESSURE: Final = (8, 8)
# Radius over the second knot of a table at which the pressure on the axis is judged.
_TIP: Final = 0.03
# Radii over the contact radius at which the error of pressures is computed, beside the axis.
_PLACES: Final = (0.3, 0.6, 0.9)


@dataclass(frozen=True, repr=False)
class NormalContact(validity.ResultsOverLoads):
    """Profile pressed into a half-space, under any number of loads.

    Results are arrays over the loads and the cases of a sweep, without dimension if the load is a
    single number. Each is computed on first use.
    """

    profile: Profile
    e_star: Parameter
    coordinate: Array
    """Contact edge in the contact coordinate of the profile."""
    control: str = "contact_radius"
    """Name of the prescribed load, which is exact."""
    material: Material = UNKNOWN
    """Material on which the warnings depend; `UNKNOWN` where only E* is known."""
    quantities: ClassVar[tuple[str, ...]] = NORMAL_QUANTITIES
    g_star: ClassVar[None] = None
    """A contact without friction has no shear modulus."""

    @property
    def normal(self) -> Self:
        """The contact itself; in a contact with friction this attribute is its normal contact."""
        return self

    @cached_property
    def contact_radius(self) -> Array:
        """a [length]."""
        return self.profile.contact_radius(self.coordinate)

    @cached_property
    def indentation_depth(self) -> Array:
        """d = g(a) [length]."""
        return self.profile.depth(self.coordinate)

    @cached_property
    def normal_force(self) -> Array:
        """F_N = 2 E* int_0^a x g'(x) dx [force]. Source: notes, §1."""
        return self.e_star * self.profile.reduced_force(self.coordinate)

    @cached_property
    def mean_pressure(self) -> Array:
        """F_N / (pi a^2) [pressure]; at zero load its limit, which may be infinite."""
        area = np.pi * (self.contact_radius * self.contact_radius)
        if extremes(area)[0] > 0:
            return self.normal_force / area
        limit = np.multiply(self.e_star, self.profile.tip_pressure)
        return quotient(self.normal_force, area, limit)

    @cached_property
    def maximum_pressure(self) -> Array:
        """Largest pressure p(r) [pressure], zero without a load.

        It is infinite at a sharp tip, at a slope discontinuity and at the edge of a flat punch.
        """
        return self.e_star * largest_stress(self.profile, self.coordinate, self.loaded)

    @cached_property
    def half_space_errors(self) -> half_space.Errors:
        """Estimated errors of the half-space approximation; see `mdr_core.half_space`."""
        return half_space.errors(self)

    @property
    def loaded(self) -> Flags:
        """True where the load is not zero."""
        return self.coordinate > 0

    @cached_property
    def normal_stiffness(self) -> Array:
        """dF_N/dd = 2 E* a [force/length]. Source: mdr-5, text after Eq. (5.1)."""
        return 2 * self.e_star * self.contact_radius

    @cached_property
    def elastic_energy(self) -> Array:
        """E* int_0^a (d - g)^2 dx = int_0^d F_N dd [force length]."""
        return self.e_star * self.profile.reduced_energy(self.coordinate)

    @cached_property
    def data_error(self) -> Array | None:
        """Relative error of depth and force that the points of a table leave open [1].

        It estimates the larger of the two errors; None for profiles that are not tables. A
        prescribed depth or force is exact, and F_N/(2E*) = a d - int_0^a g dx is stationary in a.
        Source: notes, §5.
        """
        if not isinstance(self.profile, Tabulated):
            return None
        of_depth, of_moment, of_integral = self.profile.fit.spread_at(self.contact_radius)
        depth, half_force = self.indentation_depth, self.normal_force / (2 * self.e_star)
        if self.control == "contact_radius":
            parts = (of_depth, depth), (of_moment, half_force)
        else:
            parts = (of_integral, half_force), (of_integral, self.contact_radius * depth)
        return np.maximum(*(quotient(part, whole) for part, whole in parts))

    @cached_property
    def pressure_data_error(self) -> Array | None:
        """Error of pressures that the points of a table leave open, over the largest pressure [1].

        An estimate of dp(r)/E* = (1/pi) int_r^a dg'(x)/sqrt(x^2 - r^2) dx and of the error of a, at
        a few radii; None for profiles that are known, infinite next to a sharp tip.
        """
        if not isinstance(self.profile, Tabulated):
            return None
        fit, loaded = self.profile.fit, self.loaded
        a = np.ravel(np.where(loaded, self.contact_radius, self.profile.domain))
        # Not the axis itself: the pressure is infinite there if the points allow a sharp tip.
        r = np.stack([np.minimum(_TIP * fit.pieces.edges[1], a / 2), *np.outer(_PLACES, a)])
        root = np.sqrt((a - r) * (a + r))[..., None]
        # s = sqrt(x^2 - r^2) has nodes near the axis too.
        shares, weights = composite_rule(*_OF_PRESSURE)
        x = np.hypot(r[..., None], root * shares**3).reshape(-1, shares.size)
        kernel = (3 * root * shares**2 * weights).reshape(x.shape) / x
        of_edge = fit.spread_at(a)[0] * (self.control != "contact_radius") / root[..., 0]
        size = np.hypot(fit.spread_of(x, kernel).reshape(r.shape), of_edge).max(axis=0) / np.pi
        # The largest pressure of an adhesive contact may be a tension.
        largest = np.abs(np.ravel(self.maximum_pressure / self.e_star))
        known = np.isfinite(largest) & (largest > 0)
        part = np.where(known, size / np.where(known, largest, 1.0), np.inf)
        return np.where(loaded, part.reshape(np.shape(loaded)), 0.0)[()]

    @property
    def method(self) -> str:
        """Most expensive method among the results for this profile."""
        return self.profile.normal_method

    @cached_property
    def error_estimates(self) -> Parameter:
        """Upper bound of the relative error of each case, a single number if all have the same."""
        profile = self.profile
        rounding = profile.rounding_at(self.coordinate)
        if self.control == "maximum_pressure":
            # Force and depth change by up to (steepness + 1) times as much as the radius.
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = pressure_and_slope(profile, self.coordinate)[1]
            known = where(self.loaded, slope, 1.0)
            return rounding + _OF_MAXIMUM * (profile.steepness + 1) / known
        if self.control == "contact_radius" or not (profile.flattens or profile.steepens):
            return rounding
        of_force, error = self.control == "normal_force", rounding
        with np.errstate(divide="ignore", invalid="ignore"):
            if profile.flattens:
                # Where g' falls to zero, the relative change of the contact radius exceeds that of
                # the load. It is at most the root of the rounding error of the load.
                inside = self.coordinate * (1 - np.sqrt(rounding))
                load, slope = profile.load_and_slope(inside, of_force=of_force)
                condition = load / (inside * slope)
                error = error * where(condition > 1, condition, 1.0)
            if profile.steepens:
                # Just beyond a break the load may change by more than the contact radius, in
                # relative terms.
                beyond = np.minimum(self.coordinate * (1 + ADJACENT), profile.domain)
                function = profile.reduced_force if of_force else profile.depth
                load = function(self.coordinate)
                rise = function(beyond) / load - 1
                error = np.maximum(error, where(load > 0, rise, 0.0))
        return error

    @property
    def edge_errors(self) -> Parameter:
        """Relative error of the contact radius of each case."""
        if self.control == "contact_radius":
            return 0.0
        is_exact = not self.profile.flattens and self.control != "maximum_pressure"
        return ROUNDING if is_exact else self.error_estimates

    def width_outside(self, radius: Array) -> Array:
        """a - r of radii r up to a [length], also where the rounding of a exceeds it."""
        a = self.contact_radius
        if self.control == "contact_radius" or self.profile.is_flat_punch:
            return a - radius
        # The contact coordinate of a computed edge is accurate; its radius may not be.
        beyond = self.coordinate - (radius - self.profile.first_radius)
        return where(radius < a, np.maximum(beyond, 0.0), 0.0)

    @property
    def findings(self) -> list[validity.Finding]:
        """Findings that depend only on the profile and the loads."""
        sharp = "mean_pressure is infinite at zero load: the tip is sharper than a cone"
        infinite = "maximum_pressure is infinite, at radius {}"
        found = [
            validity.Finding("singular", np.isinf(self.mean_pressure), sharp.format),
            validity.infinite_pressure(self, "singular", infinite),
        ]
        if self.material.layer is not None:
            found.append(validity.layer_strain(self.indentation_depth, self.material.layer))
        if isinstance(self.profile, Tabulated):
            of_table = [validity.tip(self, self.profile), validity.smoothed(self, self.profile)]
            return [validity.table_end(self), *of_table, *found]
        return found


class SlippingContact(validity.ResultsOverLoads):
    """Results of a normal contact under a further load, from whose edge slip spreads inwards."""

    normal: NormalContact

    def computed(self) -> dict[str, Any]:
        """Return the quantities by name, with the quantities of the normal contact."""
        return self.normal.computed() | super().computed()

    @property
    def slips_from(self: Any) -> Array:
        """Smallest radius with slip [length]; infinite without slip."""
        return where(self.slip_width > 0, self.stick_radius, np.inf)


def solve(
    profile: Profile,
    e_star: Parameter | Material,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    contact_radius: ArrayLike | None = None,
    maximum_pressure: ArrayLike | None = None,
) -> NormalContact:
    """Return the normal contact under a depth, a force, a contact radius or a largest pressure.

    a(d) inverts d = g(a); F_N = 2 E* int_0^a x g'(x) dx. Inverses without a closed form are
    iterated to rounding error in the contact coordinate.

    Source: mdr-5, Eqs. (5.7), (5.14), (5.25)-(5.27), (5.59), (5.61); notes, §1.

    Parameters
    ----------
    profile : any kind; array parameters broadcast with the load.
    e_star : effective modulus [pressure], > 0, or the material that has it.
    indentation_depth, normal_force, contact_radius, maximum_pressure : exactly one, >= 0
        [length], [force], [length], [pressure]; a number or an array.

    Raises
    ------
    InputError : not exactly one load, a load that is negative or not finite, shapes that do not
        agree, a contact beyond the end of the profile, a contact radius of a flat punch, or a
        pressure that is infinite under any load.

    Examples
    --------
    Eq. (5.14): a = (3 F R / (4 E*))^(1/3).

    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(0.01), 1e11, normal_force=[10.0, 80.0])
    >>> [float(f"{a:.6g}") for a in contact.contact_radius]
    [9.0856e-05, 0.000181712]
    """
    require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    material = e_star if isinstance(e_star, Material) else UNKNOWN
    modulus: Parameter = materials.modulus("e_star", e_star)
    loads = (indentation_depth, normal_force, contact_radius, maximum_pressure)
    names = (*CONTROLS, "maximum_pressure")
    name, load = only_one(("load",), dict(zip(names, loads, strict=True)))
    cases = modulus, *profile.parameters.values()
    spread = broadcast(load, common_shape(("load", name), load, "the parameters", *cases))
    coordinate = _coordinate(name, profile, modulus, spread)
    contact = NormalContact(profile, modulus, coordinate, name, material)
    # The prescribed load is returned bit-identical.
    vars(contact)[name] = spread
    return contact


def _coordinate(name: str, profile: Profile, e_star: Parameter, load: Array) -> Array:
    """Contact coordinate of the edge under a load, after a check of input and results."""
    with np.errstate(all="ignore"):
        if name == "contact_radius":
            coordinate = coordinate_from_radius(profile, load)
        elif name == "maximum_pressure":
            coordinate = coordinate_from_pressure(profile, load / e_star)
        else:
            of_force = name == "normal_force"
            amount = load / e_star if of_force else load
            coordinate = profile.coordinate_from_load(amount, of_force=of_force)
    low, high = extremes(coordinate)
    # Energies scale with coordinate^(2 n + 1); the other factors are bounded by the accepted
    # magnitudes.
    reach = LARGEST ** (0.5 / (2 * profile.steepness + 1))
    if not 1 / reach < low <= high < reach:
        # A load that is negative or not finite always has a coordinate outside these bounds.
        require_not_negative(("load", name), load)
        contact = NormalContact(profile, e_star, coordinate)
        with np.errstate(all="ignore"):
            depth, force, a = (getattr(contact, result) for result in CONTROLS)
            # An energy may underflow, but not overflow.
            results = coordinate, a, a * a, depth, force, np.maximum(depth * force, 1.0)
        # A prescribed radius may equal the radius of a flat, which is in contact at zero load.
        loaded = coordinate > 0 if name == "contact_radius" else load > 0
        require_representable(("load", name), loaded, *results)
    return coordinate
