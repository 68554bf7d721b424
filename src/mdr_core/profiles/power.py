"""The power law C r^n of any real exponent."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.abel.displacement import Branch, slope_integral
from mdr_core.checks import extremes
from mdr_core.profiles.power_kernels import (
    felt_from,
    ordinary_radii,
    power,
    power_moment,
    power_root,
    power_slope,
    power_step,
    power_stick,
    raised,
)
from mdr_core.profiles.profile import (
    LARGEST_HELD,
    NORMAL_ANSWERS,
    ORDINARY,
    SMALLEST_HELD,
    Profile,
    refuse_load,
    require_positive,
)
from mdr_core.profiles.stable import kappa
from mdr_core.typing import Array, Flags, Parameter

# From this part of a characteristic annulus on, a/n, the closed energy loses few digits.
_WIDE: Final = 0.5
# Of a radius, so small a part that an angle seen from there differs from a right one by rounding.
_AXIS: Final = 1e-20


@dataclass(frozen=True)
class Power(Profile):
    """f = C r^n, C = `coefficient` [length^(1-n)], n = `exponent` > 0 [1].

    Source: mdr-5, Eqs. (5.24)-(5.33).
    """

    coefficient: Parameter
    exponent: Parameter

    kind: ClassVar[str] = "power"
    formula: ClassVar[str] = "coefficient·r^exponent"
    closed_forms: ClassVar[tuple[str, ...]] = NORMAL_ANSWERS

    def __post_init__(self) -> None:
        require_positive("coefficient", self.coefficient)
        require_positive("exponent", self.exponent)

    @property
    def rounding(self) -> float:  # type: ignore[override]
        # r^n carries n times the rounding of the scaled radius.
        return float(2e-14 + 8e-15 * np.max(self.exponent))

    @property
    def ordinary_coordinates(self) -> tuple[float, float]:
        c, n = self.coefficient, self.exponent
        if isinstance(c, np.ndarray) or isinstance(n, np.ndarray):
            return ORDINARY
        return ordinary_radii([(c, n)])

    def f(self, radius: Array) -> Array:
        return power(self.coefficient, radius, self.exponent)

    def df(self, radius: Array) -> Array:
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
        root = power_root(depth / kappa(n), self.coefficient, n)
        return self._held("indentation_depth", root)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        n = np.asarray(self.exponent)
        part = reduced_force * ((n + 1) / (2 * n * kappa(n)))
        return self._held("normal_force", power_root(part, self.coefficient, n + 1))

    def _held(self, name: str, radius: Array) -> Array:
        """The radius, refused where depth or force have no digits. Both grow with it."""
        one_body = np.ndim(self.coefficient) == 0 and np.ndim(self.exponent) == 0
        if one_body and radius.ndim and radius.size and self._has_digits(extremes(radius)).all():
            return radius
        refuse_load(name, (radius > 0) & ~self._has_digits(radius))
        return radius

    def _has_digits(self, radius: ArrayLike) -> Flags:
        a = np.asarray(radius, dtype=float)
        depth, force = self.g(a), self.reduced_force(a)
        low, high = np.minimum(depth, force), np.maximum(depth, force)
        return np.asarray((low > SMALLEST_HELD) & (high < LARGEST_HELD))

    def reduced_energy(self, coordinate: Array) -> Array:
        n = self.exponent
        factor = 2 * n * n / ((n + 1) * (2 * n + 1))
        with np.errstate(over="ignore"):
            return np.square(self.g(coordinate)) * coordinate * factor

    def stick_from_force_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array]:
        return power_stick(coordinate, ratio, rest, np.asarray(self.exponent) + 1)

    def stick_from_depth_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array]:
        return power_stick(coordinate, ratio, rest, np.asarray(self.exponent))

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        step = power_step(coordinate, width, stick, np.asarray(self.exponent) + 1)
        return self.reduced_force(coordinate) * step

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        return self.g(coordinate) * power_step(coordinate, width, stick, np.asarray(self.exponent))

    def slip_moment(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Closed where the annulus is wide enough for its terms not to cancel, else NaN.

        Source: notes, §6.
        """
        n = np.asarray(self.exponent, dtype=float)
        y = np.maximum(stick, 0.0) / np.where(coordinate > 0, coordinate, 1.0)
        yn = raised(y, n)
        bracket = (1 + yn) * (1 - yn * y) / (n + 1) - (1 - yn * yn * y) / (2 * n + 1)
        moment = np.square(self.g(coordinate)) * coordinate * (bracket - yn * (1 - y))
        narrow = np.maximum(n, 1.0) * (1 - y) < _WIDE
        return np.where(narrow & (width > 0), np.nan, moment)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        sharp = np.asarray(self.exponent) <= 1
        return (np.where(sharp, 0.0, np.inf)[()],) if sharp.any() else ()

    @property
    def steepness(self) -> float:
        return max(3.5, float(np.max(self.exponent)))

    @property
    def tip_exponent(self) -> float:
        return min(1.0, float(np.min(self.exponent)))

    @property
    def branches(self) -> tuple[Branch, ...]:
        tip = float(np.asarray(self.exponent))
        return (
            Branch(
                0.0,
                lambda x, _s, _index: self.dg(x),
                tip=tip,
                of_powers=True,
                steepness=self.steepness,
            ),
        )

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        n = self.tip_exponent
        if n == 1:
            return super().slip_kernel(np.maximum(c, felt_from(r, self.steepness)), r, rtol)
        # A sharp tip is felt however near the axis; arccos(x/r) is pi/2 there.
        low = np.maximum(c, _AXIS * r)
        tip = self.g(low) * power_step(low, low - c, c, np.asarray(n))
        return super().slip_kernel(low, r, rtol) + tip

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        low = felt_from(a, self.steepness)
        return 2 / np.pi * slope_integral(self.branches, low, a, r, rtol, outside=True)

    @property
    def tip_pressure(self) -> Parameter:
        n = np.asarray(self.exponent)
        cone = np.asarray(self.coefficient) / 2
        return np.where(n < 1, np.inf, np.where(n == 1, cone, 0.0))

    def pressure_kernel(
        self,
        coordinate: Array,
        radius: Array,
        rtol: float,
        width: Array | None = None,
        edge: Array | None = None,
        modulus: float = 1.0,
        inner: Array | None = None,
    ) -> Array:
        n = float(self.exponent)
        scale = self.df(coordinate) * (modulus * float(kappa(n)) / pi)
        moment = power_moment(n - 1, coordinate, radius, rtol, width, inner)
        if n > 1:
            moment *= scale
            return moment
        # However small its factor, what is infinite on the axis is infinite there.
        with np.errstate(invalid="ignore"):
            return np.where(np.isinf(moment), np.copysign(moment, modulus), scale * moment)
