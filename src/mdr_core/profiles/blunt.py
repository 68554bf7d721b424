"""Profiles with a flat of radius b: the contact coordinate is s = sqrt(a^2 - b^2)."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.abel.polynomial import COARSE, StressPolynomial, economised, end, interval, single
from mdr_core.abel.roots import leg, one_sided
from mdr_core.profiles.behind_flat import BehindFlat
from mdr_core.profiles.profile import NORMAL_ANSWERS, require_positive
from mdr_core.profiles.stable import atan_gap
from mdr_core.quadrature import DEFAULT, Analytic
from mdr_core.typing import Array, Parameter

# Of s/b: of narrower rims the arc and the legs cancel, on wider ones no polynomial is short.
_NARROWEST: Final = 1e-3
# A weight that begins like s^2 has a double zero at the break.
_DOUBLE_ZERO: Final = Analytic(zeros=2)
# Fewer radii have their nodes in the time in which the polynomials are set up.
_MANY: Final = 100
_WIDEST: Final = 3.0


class Blunt(BehindFlat):
    """Common to the flats of radius b that end in a slope: f = 0 for r <= b, h(r) beyond."""

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    @property
    def scale(self) -> Parameter:
        return self.flat_radius

    @property
    def branches(self) -> tuple[Branch, ...]:
        base = float(np.asarray(self.flat_radius))
        return (Branch(base, lambda x, s, _index: self._weight(x, s)),)

    def g(self, x: Array) -> Array:
        return self.depth(leg(x, self.flat_radius))

    def dg(self, x: Array) -> Array:
        s = leg(x, self.flat_radius)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(x < self.flat_radius, 0.0, self._weight(x, s) * x / s)

    def depth_slope(self, coordinate: Array) -> Array:
        return self._weight(self.contact_radius(coordinate), coordinate)

    def _weight(self, x: Array, s: Array) -> Array:
        """g'(x) s/x = dg/ds [1], analytic and even in s."""
        return self.bare_weight(x, s) * self._factor

    @property
    @abstractmethod
    def _factor(self) -> Parameter:
        """What of the weight depends on nothing."""

    @abstractmethod
    def bare_weight(self, x: Array, s: Array) -> Array:
        """The weight without its factor: a function of s/b alone, that begins like (s/b)^2k."""

    begins: ClassVar[int] = 0

    def _polynomial(self, coordinate: Array, rtol: float) -> tuple[StressPolynomial, float] | None:
        """What stands for the bare weight up to the edge, and its unit of s^2; None if nothing."""
        span = (coordinate / self.flat_radius).item()
        if not _NARROWEST < span < _WIDEST:
            return None
        number = interval(span * span)
        found = _economised(type(self), number, rtol)
        unit = (np.square(self.flat_radius) * end(number)).item()
        return None if found is None else (found, unit)

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
        worthwhile = rtol >= COARSE and radius.size >= _MANY and single(coordinate, width, inner)
        value = one_sided(
            lambda x, s, _: self.bare_weight(x, s),
            self.flat_radius,
            radius,
            coordinate,
            width=width,
            edge=edge,
            inner=inner,
            odd=True,
            rtol=rtol,
            analytic=_DOUBLE_ZERO if self.begins else DEFAULT,
            polynomial=self._polynomial(coordinate, rtol) if worthwhile else None,
        )
        value *= modulus * self._factor / np.pi
        return value


@lru_cache(maxsize=256)
def _economised(
    kind: Callable[[float, float], Blunt], number: int, rtol: float
) -> StressPolynomial | None:
    """The bare weight of a kind, in q = (s/b)^2 up to the end of that interval."""
    body = kind(1.0, 1.0)

    def weight(q: Array) -> Array:
        return np.asarray(body.bare_weight(np.sqrt(1 + q), np.sqrt(q)) / q**body.begins)

    return economised(weight, (0.0, end(number)), rtol, odd=False, starts=body.begins)


@dataclass(frozen=True)
class RoundedPunch(Blunt):
    """f = (r - b)^2/(2R) beyond the flat b = `flat_radius`, R = `rounding_radius` [length].

    Source: mdr-5, Eqs. (5.55)-(5.70).
    """

    flat_radius: Parameter
    rounding_radius: Parameter

    kind: ClassVar[str] = "rounded_punch"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then (r − flat_radius)²/(2·rounding_radius)"
    closed_forms: ClassVar[tuple[str, ...]] = ("normal_force", "mean_pressure", "normal_stiffness")

    def __post_init__(self) -> None:
        require_positive("flat_radius", self.flat_radius)
        require_positive("rounding_radius", self.rounding_radius)

    def f(self, radius: Array) -> Array:
        return np.square(np.maximum(radius - self.flat_radius, 0.0)) / (2 * self.rounding_radius)

    def df(self, radius: Array) -> Array:
        return np.maximum(radius - self.flat_radius, 0.0) / self.rounding_radius

    def dg(self, x: Array) -> Array:
        s, b = leg(x, self.flat_radius), self.flat_radius
        return (s + atan_gap(s, b)) / self.rounding_radius

    def depth(self, coordinate: Array) -> Array:
        """(a/R) (s - b phi). Source: mdr-5, Eq. (5.59)."""
        gap = atan_gap(coordinate, self.flat_radius)
        return self.contact_radius(coordinate) * gap / self.rounding_radius

    def reduced_force(self, coordinate: Array) -> Array:
        """a d + s^3/(3R). Source: mdr-5, Eq. (5.61), in its stable form."""
        cube = coordinate * coordinate * coordinate
        edge = self.contact_radius(coordinate)
        return edge * self.depth(coordinate) + cube / (3 * self.rounding_radius)

    begins: ClassVar[int] = 1

    @property
    def _factor(self) -> Parameter:
        return self.flat_radius / self.rounding_radius

    def bare_weight(self, x: Array, s: Array) -> Array:
        """(2 s/b - arctan(s/b)) s/x."""
        value = np.asarray(s / self.flat_radius)
        angle = np.arctan(value)
        value += value
        value -= angle
        value *= s
        value /= x
        return value


@dataclass(frozen=True)
class TruncatedCone(Blunt):
    """f = t (r - b) beyond the flat b = `flat_radius`, t = `slope` [1].

    Source: notes, §2.
    """

    flat_radius: Parameter
    slope: Parameter

    kind: ClassVar[str] = "truncated_cone"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then slope·(r − flat_radius)"
    closed_forms: ClassVar[tuple[str, ...]] = ("normal_force", "mean_pressure", "normal_stiffness")

    def __post_init__(self) -> None:
        require_positive("flat_radius", self.flat_radius)
        require_positive("slope", self.slope)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    def f(self, radius: Array) -> Array:
        return self.slope * np.maximum(radius - self.flat_radius, 0.0)

    def df(self, radius: Array) -> Array:
        return np.asarray(np.where(radius < self.flat_radius, 0.0, self.slope))

    def depth(self, coordinate: Array) -> Array:
        """t a phi."""
        phi = np.arctan(coordinate / self.flat_radius)
        return self.slope * self.contact_radius(coordinate) * phi

    def reduced_force(self, coordinate: Array) -> Array:
        """t (a^2 phi + b s)."""
        b, edge = self.flat_radius, self.contact_radius(coordinate)
        return self.slope * (edge * edge * np.arctan(coordinate / b) + b * coordinate)

    @property
    def _factor(self) -> Parameter:
        return self.slope

    def bare_weight(self, x: Array, s: Array) -> Array:
        b = self.flat_radius
        return (np.arctan(s / b) * s + b) / x


@dataclass(frozen=True)
class TruncatedParaboloid(Blunt):
    """f = (r^2 - b^2)/(2R) beyond the flat b = `flat_radius`, R = `radius` [length].

    Source: notes, §2.
    """

    flat_radius: Parameter
    radius: Parameter

    kind: ClassVar[str] = "truncated_paraboloid"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then (r² − flat_radius²)/(2·radius)"
    closed_forms: ClassVar[tuple[str, ...]] = NORMAL_ANSWERS

    def __post_init__(self) -> None:
        require_positive("flat_radius", self.flat_radius)
        require_positive("radius", self.radius)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    def f(self, radius: Array) -> Array:
        return np.square(leg(radius, self.flat_radius)) / (2 * self.radius)

    def df(self, radius: Array) -> Array:
        return np.where(radius < self.flat_radius, 0.0, radius / self.radius)

    def depth(self, coordinate: Array) -> Array:
        """a s/R."""
        return self.contact_radius(coordinate) * coordinate / self.radius

    def reduced_force(self, coordinate: Array) -> Array:
        """2 s (2 a^2 + b^2)/(3R)."""
        b, s = self.flat_radius, coordinate
        return 2 * s * (3 * (b * b) + 2 * s * s) / (3 * self.radius)

    def coordinate_from_depth(self, depth: Array) -> Array:
        """s^2 = 2 h^2/(b^2 + sqrt(b^4 + 4 h^2)), h = R d: the root of s^4 + b^2 s^2 = h^2."""
        b2, h = np.square(self.flat_radius), self.radius * depth
        return np.sqrt(2 / (b2 + np.hypot(b2, 2 * h))) * h

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        """s^3 + (3/2) b^2 s = (3/4) R F/E*, by the hyperbolic form of the cubic's root.

        The rounding of its logarithm is felt far from the flat; a step of Newton's takes it out.
        """
        b = self.flat_radius
        goal = 0.75 * (reduced_force * self.radius / (b * np.square(b)))
        z = np.sqrt(2) * np.sinh(np.arcsinh(np.sqrt(2) * goal) / 3)
        z2 = z * z
        return np.asarray(b * (z - (z * (z2 + 1.5) - goal) / (3 * z2 + 1.5)))

    def reduced_energy(self, coordinate: Array) -> Array:
        """(1/R^2) [a s^2 (b^2 + s^2/3) + s^4 (3a^3 + 6a^2 b + 4a b^2 + 2b^3)/(15 (a + b)^2)]."""
        b, s2 = self.flat_radius, coordinate * coordinate
        a = self.contact_radius(coordinate)
        cubic = ((3 * a + 6 * b) * a + 4 * (b * b)) * a + 2 * (b * b * b)
        outer = s2 * s2 * cubic / (15 * np.square(a + b))
        return np.asarray((a * s2 * (b * b + s2 / 3) + outer) / np.square(self.radius))

    @property
    def _factor(self) -> Parameter:
        return self.flat_radius / np.asarray(self.radius)[()]

    def bare_weight(self, x: Array, s: Array) -> Array:
        return (s * s / x + x) / self.flat_radius
