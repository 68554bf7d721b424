"""Powers of the radius: cone, paraboloid and C r^n."""

from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar

import numpy as np

from mdr_core.abel.annulus import Annulus, log_ratio, root_step
from mdr_core.elementwise import where
from mdr_core.profiles.base import FIELDS, NORMAL_QUANTITIES, Profile
from mdr_core.profiles.cancellation_free import atan_gap
from mdr_core.profiles.power_functions import (
    kappa,
    power,
    power_root,
    power_slope,
    power_stick,
)
from mdr_core.typing import Array, Flags, Parameter


class PowerLaw(Profile):
    """Power of the radius; `Power` gives the formulas."""

    coefficient: Parameter
    exponent: Parameter

    @property
    def scale(self) -> Parameter:
        # Contacts of all radii are similar: any one serves.
        return 1.0

    def f(self, radius: Array) -> Array:
        with np.errstate(over="ignore", under="ignore"):
            return power(self.coefficient, radius, self.exponent)

    def df(self, radius: Array) -> Array:
        with np.errstate(divide="ignore", over="ignore", under="ignore"):
            return power_slope(self.coefficient, radius, self.exponent)

    def g(self, x: Array) -> Array:
        return kappa(self.exponent) * self.f(x)

    def dg(self, x: Array) -> Array:
        return kappa(self.exponent) * self.df(x)

    def reduced_force(self, coordinate: Array) -> Array:
        n = self.exponent
        with np.errstate(over="ignore", invalid="ignore"):
            return (2 * n / (n + 1)) * self.g(coordinate) * coordinate

    def coordinate_from_depth(self, depth: Array) -> Array:
        n = self.exponent
        return power_root(depth / kappa(n), self.coefficient, n)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        n = self.exponent
        part = reduced_force * ((n + 1) / (2 * n * kappa(self.exponent)))
        return power_root(part, self.coefficient, n + 1)

    def reduced_energy(self, coordinate: Array) -> Array:
        n = self.exponent
        factor = 2 * n * n / ((n + 1) * (2 * n + 1))
        with np.errstate(over="ignore"):
            return np.square(self.g(coordinate)) * coordinate * factor

    def stick_parts(self, ratio: Array, rest: Array, *, of_force: bool) -> tuple[Array, Array]:
        """Source: mdr-5, Eqs. (5.12), (5.16), (5.29), (5.31). Parameters: see `Profile`."""
        return power_stick(self.exponent + of_force, ratio, rest)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return (coordinate >= 0) & (self.exponent <= 2)

    def axis_stress(self, coordinate: Array) -> Array:
        n = self.exponent
        finite = self.dg(coordinate) / (pi * where(n > 1, n - 1, 1.0))
        return where(n > 1, finite, np.inf)


@dataclass(frozen=True)
class Cone(PowerLaw):
    """Cone f = t r with g(x) = (pi/2) t x and F_N(a)/E* = (pi/2) t a^2.

    Source: mdr-5, Eqs. (5.46)-(5.53).

    Parameters
    ----------
    slope : slope t = tan(theta) of the flank against the plane [1].
    """

    slope: Parameter

    kind: ClassVar[str] = "cone"
    exponent: ClassVar[float] = 1.0  # type: ignore[misc]  # a field of other powers
    formula: ClassVar[str] = "slope·r"
    closed_forms: ClassVar[tuple[str, ...]] = (*NORMAL_QUANTITIES, *FIELDS)

    @property
    def coefficient(self) -> Parameter:  # type: ignore[override]  # a field of other powers
        return self.slope

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Source: mdr-5, Eq. (5.48). Parameters: see `Profile`."""
        return (pi / 2) * self.slope * width * (2 * coordinate - width)

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Source: mdr-5, Eq. (5.47). Parameters: see `Profile`."""
        return self.g(width + 0 * coordinate)

    def interval_moments(self, span: Array, ends: Array, *, over_forces: bool) -> Array:
        """Moments from a to b, with h = b - a and c = a/b.

        (2h/3) (1, 1, 1) over depths, (h/(6 b^2 (1 + c)^2)) (3/c + 1, 4, 1 + 3c) over forces.

        Source: notes, §6. Parameters: see `Profile`.
        """
        stiffness = (pi / 2) * self.slope
        if not over_forces:
            return np.broadcast_to(2 / 3 * (span / stiffness), (3, span.size))
        b, c = ends[1], ends[0] / ends[1]
        # span = stiffness h b (1 + c).
        factor = span / (stiffness * b * b * b * 6) / (1 + c) ** 3
        return factor * np.array([3 / c + 1, np.full_like(c, 4.0), 1 + 3 * c])

    def slip_integral(self, c: Array, r: Array) -> Array:
        """t [s - c arccos(c/r)], s = sqrt(r^2 - c^2).

        Source: notes, §4. Parameters: see `Profile`.
        """
        root = np.sqrt((r - c) * (r + c))
        return self.slope * np.where(c > 0, atan_gap(root, np.where(c > 0, c, 1.0)), root)

    def outer_displacement(self, a: Array, r: Array, coordinate: float) -> Array:
        """t [a arcsin(a/r) - (r - sqrt(r^2 - a^2))].

        Source: notes, §7. Parameters: see `Profile`.
        """
        half = a / (r + np.sqrt((r - a) * (r + a)))
        return self.slope * a * (2 * np.arctan(half) - half)

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        """(t/2) [arccosh(a/r) - arccosh(c/r)].

        Source: mdr-5, Eq. (5.53). Parameters: see `Profile`.
        """
        return (self.slope / 2) * log_ratio(annulus, radius)


@dataclass(frozen=True)
class Paraboloid(PowerLaw):
    """Paraboloid f = r^2/(2R) with g(x) = x^2/R and F_N(a)/E* = 4a^3/(3R).

    Source: mdr-5, Eqs. (5.5)-(5.17).

    Parameters
    ----------
    radius : radius of curvature R [length].
    """

    radius: Parameter

    kind: ClassVar[str] = "paraboloid"
    exponent: ClassVar[float] = 2.0  # type: ignore[misc]  # a field of other powers
    formula: ClassVar[str] = "r²/(2·radius)"
    closed_forms: ClassVar[tuple[str, ...]] = (*NORMAL_QUANTITIES, *FIELDS)

    @property
    def body_radii(self) -> tuple[Parameter, Parameter]:
        return self.radius, inf

    @property
    def coefficient(self) -> Parameter:  # type: ignore[override]  # a field of other powers
        return 1 / (2 * self.radius)

    # Millions of contacts are of this kind, so their formulas avoid the slower powers.

    def g(self, x: Array) -> Array:
        return x * x / self.radius

    def dg(self, x: Array) -> Array:
        return 2 * x / self.radius

    def reduced_force(self, coordinate: Array) -> Array:
        return coordinate * coordinate * coordinate * (4 / (3 * self.radius))

    def coordinate_from_depth(self, depth: Array) -> Array:
        return np.sqrt(self.radius * depth)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        return np.cbrt(0.75 * reduced_force * self.radius)

    def stick_parts(self, ratio: Array, rest: Array, *, of_force: bool) -> tuple[Array, Array]:
        """Parameters: see `Profile`."""
        if not of_force:
            return super().stick_parts(ratio, rest, of_force=False)
        part = np.cbrt(rest)
        return part, ratio / (1 + part + part * part)

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Source: mdr-5, Eq. (5.15). Parameters: see `Profile`."""
        cubes = 3 * coordinate * (coordinate - width) + width * width
        return width * cubes * (4 / (3 * self.radius))

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Source: mdr-5, Eq. (5.12). Parameters: see `Profile`."""
        return width * (2 * coordinate - width) / self.radius

    def interval_moments(self, span: Array, ends: Array, *, over_forces: bool) -> Array:
        """Moments from a to b, with h = b - a and c = a/b.

        (2h/(15 (1 + c)^2)) (8 + 9c + 3c^2, 4 + 12c + 4c^2, 3 + 9c + 8c^2) over depths and
        (h/(10 b^2 (1 + c + c^2)^2)) (5/c + 6 + 3c + c^2, 3 + 9c + 3c^2, 1 + 3c + 6c^2 + 5c^3)
        over forces.

        Source: notes, §6. Parameters: see `Profile`.
        """
        b, c = ends[1], ends[0] / ends[1]
        squares = c * c
        if not over_forces:
            # span = h b (1 + c)/R.
            factor = span * self.radius / b * (2 / 15) / (1 + c) ** 3
            parts = 8 + 9 * c + 3 * squares, 4 + 12 * c + 4 * squares, 3 + 9 * c + 8 * squares
            return factor * np.array(parts)
        # span = 4 h b^2 (1 + c + c^2)/(3R).
        factor = span * self.radius / (b * b * b * b) * (3 / 40) / (1 + c + squares) ** 3
        upper = 1 + 3 * c + 6 * squares + 5 * squares * c
        parts = 5 / c + 6 + 3 * c + squares, 3 + 9 * c + 3 * squares, upper
        return factor * np.array(parts)

    def slip_integral(self, c: Array, r: Array) -> Array:
        """(1/(pi R)) [c (s - c phi) + s^2 phi], s = sqrt(r^2 - c^2), phi = arccos(c/r).

        Source: mdr-5, Eq. (5.45). Parameters: see `Profile`.
        """
        root = np.sqrt((r - c) * (r + c))
        gap = atan_gap(root, np.where(c > 0, c, 1.0))
        return (c * gap + root * root * np.arctan2(root, c)) / (pi * self.radius)

    def outer_displacement(self, a: Array, r: Array, coordinate: float) -> Array:
        """(1/(pi R)) [a^2 phi + s (a - s phi)], s = sqrt(r^2 - a^2), phi = arcsin(a/r).

        Source: johnson, Eq. (3.42a); notes, §7. Parameters: see `Profile`.
        """
        root = np.sqrt((r - a) * (r + a))
        gap = atan_gap(a, np.where(root > 0, root, 1.0))
        return (a * a * np.arctan2(a, root) + root * gap) / (pi * self.radius)

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        """(2/(pi R)) [sqrt(a^2 - r^2) - sqrt(c^2 - r^2)].

        Source: mdr-5, Eq. (5.38). Parameters: see `Profile`.
        """
        return 2 / (pi * self.radius) * root_step(annulus, radius)


@dataclass(frozen=True)
class Power(PowerLaw):
    """Power f = C r^n with g(x) = kappa_n C x^n and F_N(a)/E* = (2n/(n + 1)) kappa_n C a^(n+1).

    Source: mdr-5, Eqs. (5.24)-(5.33).

    Parameters
    ----------
    coefficient : C > 0 [length^(1-n)].
    exponent : n > 0, any real number [1].
    """

    coefficient: Parameter
    exponent: Parameter

    kind: ClassVar[str] = "power"
    formula: ClassVar[str] = "coefficient·r^exponent"
    closed_forms: ClassVar[tuple[str, ...]] = tuple(
        name for name in NORMAL_QUANTITIES if name != "maximum_pressure"
    )

    def rounding_at(self, coordinate: Array) -> Parameter:
        # r^n has n times the relative rounding error of the scaled radius.
        return 2e-14 + 8e-15 * self.exponent

    @property
    def exponents(self) -> tuple[float, ...]:
        return float(np.min(self.exponent)), float(np.max(self.exponent))
