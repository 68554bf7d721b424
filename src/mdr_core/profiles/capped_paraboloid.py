"""Paraboloid with a flatter parabolic cap, as wear leaves it."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from mdr_core.elementwise import where
from mdr_core.errors import InputError
from mdr_core.profiles.powers import Paraboloid
from mdr_core.profiles.tipped import Tipped
from mdr_core.typing import Array, Flags, Parameter


@dataclass(frozen=True)
class CappedParaboloid(Tipped):
    """Paraboloid r^2/(2 R1), plus k (r^2 - b^2)/2 beyond r = b, with k = 1/R2 - 1/R1 >= 0.

    With s = sqrt(x^2 - b^2), zero up to b, g(x) = x^2/R1 + k x s and
    F_N(a)/E* = 4a^3/(3 R1) + (2/3) k s (2a^2 + b^2).
    Source: notes, §2 and §3.

    Parameters
    ----------
    cap_radius : b [length].
    tip_radius : radius of curvature R1 of the cap [length].
    radius : radius of curvature R2 <= R1 beyond the cap [length]. R2 > R1 means a downward jump of
        the slope at b, and thus a negative pressure.
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

    @property
    def flank_start(self) -> Parameter:
        return self.cap_radius

    @cached_property
    def _tip(self) -> Paraboloid:
        return Paraboloid(self.tip_radius)

    @cached_property
    def _relative_step(self) -> Parameter:
        """K = k R1 [1]."""
        return (self.tip_radius - self.radius) / self.radius

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (where(self._relative_step > 0, self.cap_radius, np.inf),)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        """True on the cap, which is a paraboloid. See `Profile`."""
        return coordinate < self.flank_start

    def f(self, radius: Array) -> Array:
        square, b2 = radius * radius, np.square(self.cap_radius)
        beyond = np.maximum(square - b2, 0.0) * self._relative_step
        return (square + beyond) / (2 * self.tip_radius)

    def df(self, radius: Array) -> Array:
        step = where(radius < self.cap_radius, 0.0, self._relative_step)
        return radius * (1 + step) / self.tip_radius

    def _flank_depth(self, x: Array, s: Array) -> Array:
        return x * (x + self._relative_step * s) / self.tip_radius

    def weight(self, x: Array, s: Array) -> Array:
        return (2 * s + self._relative_step * (x + s * s / x)) / self.tip_radius

    def _flank_slope(self, x: Array, s: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            step = where(self._relative_step > 0, self._relative_step * (x * x / s + s), 0.0)
        return (2 * x + step) / self.tip_radius

    def _flank_force(self, x: Array, s: Array) -> Array:
        step = self._relative_step * s * (2 * x * x + np.square(self.cap_radius))
        return (2 / 3) * (2 * (x * x * x) + step) / self.tip_radius

    def coordinate_from_depth(self, depth: Array) -> Array:
        """With u = s^2/b^2 and D = R1 d/b^2 - 1 it is (D - u)^2 = K^2 u (1 + u)."""
        b, root = self.cap_radius, np.sqrt(self.tip_radius * depth)
        rest = np.maximum(root / b - 1, 0.0) * (root / b + 1)
        step = self._relative_step
        outer = np.hypot(step, 2 * np.sqrt(rest) * np.sqrt(1 + rest))
        scale = np.hypot(np.sqrt(step) * np.sqrt(step + outer), np.sqrt(2 * rest))
        s = np.sqrt(2) * b * rest / where(scale > 0, scale, 1.0)
        return np.hypot(np.minimum(root, b), s)
