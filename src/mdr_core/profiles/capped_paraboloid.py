"""Paraboloid with a flatter parabolic cap, as worn at the tip."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.annulus import Annulus, InnerEnd
from mdr_core.abel.displacement import Branch
from mdr_core.abel.power_moments import root_step
from mdr_core.abel.two_root import inverse_hypot
from mdr_core.cached import cached_property
from mdr_core.elementwise import every, some, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import Profile
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.profiles.truncated import TruncatedParaboloid
from mdr_core.typing import Array, Parameter

# Larger than any radius of 1e-50 to 1e50.
_UNREACHABLE: Final = 1e60


@dataclass(frozen=True)
class CappedParaboloid(Profile):
    """Paraboloid r^2/(2 R1) up to b, beyond it with k (r^2 - b^2)/2 added, k = 1/R2 - 1/R1 >= 0.

    With s = sqrt(x^2 - b^2), zero up to b, g(x) = x^2/R1 + k x s and
    F_N(a)/E* = 4a^3/(3 R1) + (2/3) k s (2a^2 + b^2).

    The contact coordinate is a up to b and b + m s beyond it, m = max(K/2, 1), K = R1/R2 - 1:
    there the load doubles over s = b/K, which a does not resolve. Source: notes, §2, §3 and §4.

    Parameters
    ----------
    cap_radius : b [length].
    tip_radius : radius of curvature R1 of the cap [length].
    radius : radius of curvature R2 <= R1 beyond it [length]. With R2 > R1 the slope would drop at
        b, and the pressure there would fall below zero.
    """

    cap_radius: Parameter
    tip_radius: Parameter
    radius: Parameter

    kind: ClassVar[str] = "capped_paraboloid"
    formula: ClassVar[str] = (
        "r²/(2·tip_radius) for r ≤ cap_radius, then "
        "+ (1/radius − 1/tip_radius)·(r² − cap_radius²)/2"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if np.any(self.radius > self.tip_radius):
            raise InputError(
                ("profile", "radius"),
                "must not exceed tip_radius: the slope would drop at radius "
                f"{self.cap_radius}, where the pressure would be negative",
            )

    @cached_property
    def _relative_step(self) -> Parameter:
        """K = k R1 [1]."""
        return (self.tip_radius - self.radius) / self.radius

    @cached_property
    def _break(self) -> Parameter:
        """b, or an unreachable radius if K = 0 and there is no break [length]."""
        return where(self._relative_step > 0, self.cap_radius, _UNREACHABLE)

    @cached_property
    def _flank(self) -> TruncatedParaboloid:
        """Part beyond b that is added to the cap; any, where there is no break."""
        step = where(self._relative_step > 0, self._relative_step, 1.0)
        return TruncatedParaboloid(self._break, self.tip_radius / step)

    @cached_property
    def _ratio(self) -> Parameter:
        """m [1], for which the slope of the depth is equal on both sides of b where K > 2."""
        return np.maximum(self._relative_step / 2, 1.0)

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.cap_radius,)

    @cached_property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self._break, dtype=float))

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self._break,)

    @property
    def scale(self) -> Parameter:
        return self.cap_radius

    @property
    def branches(self) -> tuple[Branch, ...]:
        b, tip = float(np.asarray(self._break)), self.tip_radius
        return (
            Branch(0.0, lambda x, _s, _index: 2 * x / tip, b),
            Branch(b, lambda x, s, _index: self._weight(x, s)),
        )

    def f(self, radius: Array) -> Array:
        return radius * radius / (2 * self.tip_radius) + self._flank.f(radius)

    def df(self, radius: Array) -> Array:
        return radius / self.tip_radius + self._flank.df(radius)

    def g(self, x: Array) -> Array:
        return x * x / self.tip_radius + self._flank.g(x)

    def dg(self, x: Array) -> Array:
        return 2 * x / self.tip_radius + self._flank.dg(x)

    def _weight(self, x: Array, s: Array) -> Array:
        """dg/ds = g'(x) s/x beyond b [1]."""
        return 2 * s / self.tip_radius + self._flank.weight(x, s)

    # The contact coordinate.

    def _place(self, coordinate: Array) -> tuple[Array, Array]:
        """a and s = sqrt(a^2 - b^2), zero within the cap [length]."""
        inner = where(coordinate > self._break, self._break, coordinate)
        s = (coordinate - inner) / self._ratio
        return np.sqrt(inner * inner + s * s), s

    def contact_radius(self, coordinate: Array) -> Array:
        return self._place(coordinate)[0]

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        return self._coordinate(contact_radius, inverse_hypot(contact_radius, self._break))

    def _coordinate(self, a: Array, s: Array) -> Array:
        return np.minimum(a, self._break) + self._ratio * s

    def radius_slope(self, coordinate: Array) -> Array:
        a, s = self._place(coordinate)
        return where(coordinate <= self._break, 1.0, s / (a * self._ratio))

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        """Parameters: see `Profile`."""
        b, roots = self._break, (self._place(s_a)[1], self._place(s_c)[1])
        beyond = self._ratio * self._flank.coordinate_width(a, c, *roots)
        across = (s_a - b) + (b - np.minimum(s_c, b))
        return where(s_a <= b, a - c, where(s_c >= b, beyond, across))

    def radius_width(self, s_a: Array, width: Array) -> Array:
        b, s_c = self._break, s_a - width
        a, s = self._place(s_a)
        beyond = self._flank.radius_width(s, width / self._ratio)
        across = s * s / (a + b) + (width - (s_a - b))
        return where(s_a <= b, width, where(s_c >= b, beyond, across))

    # The normal contact.

    def depth(self, coordinate: Array) -> Array:
        a, s = self._place(coordinate)
        return a * (a / self.tip_radius + s / self._flank.radius)

    def depth_slope(self, coordinate: Array) -> Array:
        return self._slope(coordinate, *self._place(coordinate))

    def _slope(self, coordinate: Array, a: Array, s: Array) -> Array:
        within = 2 * coordinate / self.tip_radius
        return where(coordinate <= self._break, within, self._weight(a, s) / self._ratio)

    def reduced_force(self, coordinate: Array) -> Array:
        return self._force(*self._place(coordinate))

    def force_and_slope(self, coordinate: Array) -> tuple[Array, Array]:
        a, s = self._place(coordinate)
        return self._force(a, s), 2 * a * self._slope(coordinate, a, s)

    def _force(self, a: Array, s: Array) -> Array:
        return 4 * a * a * a / (3 * self.tip_radius) + self._flank.reduced_force(s)

    def coordinate_from_depth(self, depth: Array) -> Array:
        """With u = s^2/b^2 and D = R1 d/b^2 - 1 it is (D - u)^2 = K^2 u (1 + u)."""
        b, root = self._break, np.sqrt(self.tip_radius * depth)
        rest = np.maximum(root / b - 1, 0.0) * (root / b + 1)
        step = self._relative_step
        outer = np.hypot(step, 2 * np.sqrt(rest) * np.sqrt(1 + rest))
        scale = np.hypot(np.sqrt(step) * np.sqrt(step + outer), np.sqrt(2 * rest))
        s = np.sqrt(2) * b * rest / where(scale > 0, scale, 1.0)
        return self._coordinate(root, s)

    def reduced_energy(self, coordinate: Array) -> Array:
        b = self._break

        def density(s: Array) -> Array:
            a = np.hypot(b, s)
            return self._force(a, s) * self._weight(a, s)

        inner = np.minimum(coordinate, b)
        cap = 8 / 15 * (np.square(inner * inner) * inner) / np.square(self.tip_radius)
        return cap + power_law_integral(density, self._place(coordinate)[1], b)

    def pressure_kernel(self, annulus: Annulus, radius: Array, rtol: float) -> Array:
        """Stress integral of the cap plus k times that of a truncated paraboloid.

        Source: notes, §2. Parameters: see `Profile`.
        """
        outer, inner, edge = annulus
        s, beyond = self._place(outer)[1], None
        if inner is not None:
            past = outer - inner.width > self._break
            beyond = InnerEnd(where(past, inner.width / self._ratio, s), inner.radius)
        total = root_step(self.radial(annulus), radius)
        total *= 2 / (pi * self.tip_radius)
        annulus, flank = Annulus(s, beyond, edge), s > 0
        if every(flank):
            total += self._flank.pressure_kernel(annulus, radius, rtol)
        elif some(flank):
            at = annulus.at(flank), radius[flank]
            total[flank] += self._flank.pressure_kernel(*at, rtol)
        return total
