"""A paraboloid whose tip is worn to a flatter one."""

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.abel.roots import leg, one_sided
from mdr_core.errors import InputError
from mdr_core.profiles.power_kernels import root_step
from mdr_core.profiles.profile import Profile, energy_integral, require_positive
from mdr_core.profiles.stretched import Stretched
from mdr_core.typing import Array, Parameter

_OUT_OF_REACH: Final = 1e150
_EPS: Final = float(np.finfo(float).eps)
# Newton's steps in log(s) from a bound at most three times too large: five settle it.
_STEPS: Final = 8


@dataclass(frozen=True)
class CappedParaboloid(Profile):
    """r^2/(2 R1) up to b, then k (r^2 - b^2)/2 more, k = 1/R2 - 1/R1 >= 0.

    b = `cap_radius`, R1 = `tip_radius`, R2 = `radius` <= R1 [length]: with R2 > R1 the slope
    would drop at b and the pressure there fall to minus infinity. The contact coordinate is
    a up to b and b (1 + m s/b)^(1/C) beyond, s = sqrt(a^2 - b^2): the load doubles over
    s = b/K, K = R1/R2 - 1. Source: notes, §2, §3 and §4.
    """

    cap_radius: Parameter
    tip_radius: Parameter
    radius: Parameter

    kind: ClassVar[str] = "capped_paraboloid"
    formula: ClassVar[str] = (
        "r²/(2·tip_radius) for r ≤ cap_radius, then "
        "+ (1/radius − 1/tip_radius)·(r² − cap_radius²)/2"
    )
    closed_forms: ClassVar[tuple[str, ...]] = ("normal_force", "mean_pressure", "normal_stiffness")

    def __post_init__(self) -> None:
        require_positive("cap_radius", self.cap_radius)
        require_positive("tip_radius", self.tip_radius)
        require_positive("radius", self.radius)
        if np.any(np.asarray(self.radius) > np.asarray(self.tip_radius)):
            raise InputError(
                ("profile", "radius"),
                "must not exceed tip_radius: the slope would drop at radius "
                f"{self.cap_radius}, where the pressure falls below zero",
            )

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.cap_radius,)

    @property
    def _kink(self) -> Parameter:
        """k = 1/R2 - 1/R1 [1/length]."""
        return (self.tip_radius - self.radius) / (self.tip_radius * self.radius)

    @property
    def _jump(self) -> Parameter:
        """K = R1/R2 - 1 = k R1 [1]."""
        return (self.tip_radius - self.radius) / self.radius

    @property
    def _break(self) -> Parameter:
        """b, out of reach where the radii are equal and nothing changes there."""
        return np.where(np.asarray(self._kink) > 0, self.cap_radius, _OUT_OF_REACH)[()]

    @property
    def _stretched(self) -> Stretched:
        """The coordinate beyond b, of the excess m s/b: at s = b it is a few b."""
        return Stretched(self._break, np.maximum(np.log1p(self._jump) / 2, 1.0))

    @property
    def _ratio(self) -> Parameter:
        """m [1]: C K/2, where the depth's slope is the same on both sides of b, but at least 1."""
        return np.maximum(self._stretched.power * self._jump / 2, 1.0)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self._break,)

    @property
    def rounding(self) -> float:  # type: ignore[override]
        # The force grows like the power 3 C of the coordinate.
        return float(3e-14 + 3 * _EPS * np.max(self._stretched.power))

    @property
    def steepness(self) -> float:
        """The depth grows like the power 2 C of the coordinate."""
        return max(3.5, 2 * float(np.max(self._stretched.power)))

    def f(self, radius: Array) -> Array:
        outer = leg(radius, self._break)
        return radius * radius / (2 * self.tip_radius) + self._kink * outer * outer / 2

    def df(self, radius: Array) -> Array:
        return np.where(radius < self._break, radius / self.tip_radius, radius / self.radius)

    def g(self, x: Array) -> Array:
        return x * x / self.tip_radius + self._kink * x * leg(x, self._break)

    def dg(self, x: Array) -> Array:
        s = leg(x, self._break)
        with np.errstate(divide="ignore", invalid="ignore"):
            outer = np.where(x < self._break, 0.0, self._kink * (s + x * x / s))
        return 2 * x / self.tip_radius + np.where(np.asarray(self._kink) > 0, outer, 0.0)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        return self._coordinate(contact_radius, leg(contact_radius, self._break))

    def _coordinate(self, inside: Array, s: Array) -> Array:
        """The coordinate of s beyond the break, `inside` up to it."""
        beyond = self._stretched.coordinate(self._ratio * (s / self._break))
        return np.where(s > 0, beyond, np.minimum(inside, self._break))

    @property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self._break, dtype=float))

    def _outer(self, coordinate: Array) -> Array:
        """s = sqrt(a^2 - b^2), zero inside the cap."""
        return np.asarray(self._break * (self._stretched.excess(coordinate) / self._ratio))

    def _outer_slope(self, coordinate: Array) -> Array:
        """ds/dw beyond the break."""
        return self._break / self._ratio * self._stretched.slope(coordinate)

    def contact_radius(self, coordinate: Array) -> Array:
        return np.asarray(np.hypot(np.minimum(coordinate, self._break), self._outer(coordinate)))

    def radius_slope(self, coordinate: Array) -> Array:
        safe = np.maximum(coordinate, self._break)
        a, s = self.contact_radius(safe), self._outer(safe)
        return np.where(coordinate <= self._break, 1.0, s / a * self._outer_slope(safe))

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        b = self._break
        legs = self._outer(s_a) + self._outer(s_c)
        outer = (a - c) * (a + c) / np.where(legs > 0, legs, 1.0)
        high, low = np.maximum(s_a, b), np.maximum(s_c, b)
        beyond = self._stretched.width(high, low, self._ratio * (outer / b))
        across = (s_a - b) + (b - np.minimum(s_c, b))
        # A contact that is wider than the cap may have its radius rounded to b.
        return np.where(s_a <= b, a - c, np.where(s_c >= b, beyond, across))

    def radius_width(self, s_a: Array, width: Array) -> Array:
        low = s_a - width
        return self._annulus(s_a, width, self.contact_radius(s_a), self.contact_radius(low))

    def _annulus(self, high: Array, width: Array, a: Array, c: Array) -> Array:
        """a - c with its digits, from the coordinate and its width."""
        b, s, low = self._break, self._outer(high), high - width
        total = np.where(a + c > 0, a + c, 1.0)
        beyond = self._outer_width(high, width) * (s + self._outer(low)) / total
        across = s * s / (a + b) + (width - (high - b))
        return np.where(high <= b, width, np.where(low >= b, beyond, across))

    def _outer_width(self, high: Array, width: Array) -> Array:
        """s(a) - s(c) with its digits, for c beyond the break."""
        top = np.maximum(high, self._break)
        step = self._stretched.step(top, width, np.maximum(high - width, self._break))
        return np.asarray(self._break * (step / self._ratio))

    def depth(self, coordinate: Array) -> Array:
        """a^2/R1 + k a s."""
        a = self.contact_radius(coordinate)
        return a * a / self.tip_radius + self._kink * a * self._outer(coordinate)

    def depth_slope(self, coordinate: Array) -> Array:
        safe = np.maximum(coordinate, self._break)
        beyond = self._leg_slope(self._outer(safe)) * self._outer_slope(safe)
        return np.where(coordinate <= self._break, 2 * coordinate / self.tip_radius, beyond)

    def _leg_slope(self, s: Array) -> Array:
        """dd/ds beyond the break."""
        a = np.hypot(self._break, s)
        return np.asarray(2 * s / self.tip_radius + self._kink * (s * s / a + a))

    def reduced_force(self, coordinate: Array) -> Array:
        return self._force(self.contact_radius(coordinate), self._outer(coordinate))

    def _force(self, a: Array, s: Array) -> Array:
        """4a^3/(3 R1) + (2/3) k s (2a^2 + b^2)."""
        cap = 4 * a * a * a / (3 * self.tip_radius)
        b = self._break
        return np.asarray(cap + (2 / 3) * self._kink * s * (2 * a * a + b * b))

    def coordinate_from_depth(self, depth: Array) -> Array:
        """With u = s^2/b^2 and D = R1 d/b^2 - 1 it is (D - u)^2 = K^2 u (1 + u), ."""
        b, root = self._break, np.sqrt(self.tip_radius * depth)
        rest = np.maximum(root / b - 1, 0.0) * (root / b + 1)
        jump = self._jump
        outer = np.hypot(jump, 2 * np.sqrt(rest) * np.sqrt(1 + rest))
        scale = np.hypot(np.sqrt(jump) * np.sqrt(jump + outer), np.sqrt(2 * rest))
        s = np.sqrt(2) * b * rest / np.where(scale > 0, scale, 1.0)
        return self._coordinate(root, np.asarray(s))

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        b, root = self._break, np.cbrt(0.75 * self.tip_radius * reduced_force)
        part = root / b
        rest = np.maximum(part - 1, 0.0) * (part * part + part + 1)
        return self._coordinate(root, b * self._leg_from_force(rest))

    def _leg_from_force(self, rest: Array) -> Array:
        """s/b = z where z^2 (q^2 + q + 1)/(q + 1) + K z (3/2 + z^2) = rest, q = sqrt(1 + z^2).

        That is the force over the one at b, less one. Every term alone bounds z from above, and
        from a bound Newton's method comes down to the root, in logarithms by equal factors.
        """
        jump = self._jump
        goal = np.where(rest > 0, rest, 1.0)
        with np.errstate(divide="ignore", over="ignore"):
            bounds = np.sqrt(goal / 1.5), np.cbrt(goal / (1 + jump)), goal / (1.5 * jump)
        z = np.minimum(np.minimum(bounds[0], bounds[1]), bounds[2])
        for _ in range(_STEPS):
            q = np.hypot(1.0, z)
            cap, kink = z * z * (q * q + q + 1) / (q + 1), jump * z * (1.5 + z * z)
            slope = 3 * z * z * q + jump * z * (1.5 + 3 * z * z)
            z = z * np.exp(np.log(goal / (cap + kink)) * (cap + kink) / slope)
        return np.where(rest > 0, z, 0.0)

    def reduced_energy(self, coordinate: Array) -> Array:
        b = self._break

        def density(s: Array) -> Array:
            return self._force(np.hypot(b, s), s) * self._leg_slope(s)

        inner = np.minimum(coordinate, b)
        cap = 8 / 15 * (np.square(inner * inner) * inner) / np.square(self.tip_radius)
        outer = self._outer(coordinate)
        return np.asarray(cap + energy_integral(density, outer, b) if outer.any() else cap)

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
        b = self._break
        coordinate = np.broadcast_to(coordinate, radius.shape)
        a, s = self.contact_radius(coordinate), self._outer(coordinate)
        a = a if edge is None else edge
        annulus = None
        step = s
        if width is not None:
            low = coordinate - width
            c = self.contact_radius(low) if inner is None else inner
            annulus = self._annulus(coordinate, width, a, c)
            step = np.where(low > b, self._outer_width(coordinate, width), s)
        total = np.asarray(2 / (np.pi * self.tip_radius) * root_step(a, radius, annulus, inner))
        outer = s > 0
        if outer.any() and self._kink > 0:
            total[outer] += (
                self._kink
                / np.pi
                * one_sided(
                    lambda x, leg, _: (x * x + leg * leg) / x,
                    b,
                    radius[outer],
                    s[outer],
                    width=step[outer],
                    edge=None if edge is None else np.broadcast_to(edge, s.shape)[outer],
                    inner=None if inner is None else np.broadcast_to(inner, s.shape)[outer],
                    odd=True,
                    rtol=rtol,
                )
            )
        total *= modulus
        return total

    @property
    def branches(self) -> tuple[Branch, ...]:
        b, tip, kink = float(np.asarray(self._break)), self.tip_radius, self._kink
        return (
            Branch(0.0, lambda x, _s, _index: 2 * x / tip, b, tip=2.0),
            Branch(b, lambda x, s, _index: 2 * s / tip + kink * (x * x + s * s) / x),
        )
