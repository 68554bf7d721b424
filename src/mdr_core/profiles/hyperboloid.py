"""Hyperboloid, which is smooth at the axis and approaches a cone."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mdr_core.profiles.base import Profile
from mdr_core.profiles.cancellation_free import atan_gap
from mdr_core.typing import Array, Flags, Parameter


@dataclass(frozen=True)
class Hyperboloid(Profile):
    """Hyperboloid f = R t^2 (sqrt(1 + r^2/h^2) - 1), h = R t, with g(x) = t x arctan(x/h).

    F_N(a)/E* = t [a^2 arctan(a/h) + h (a - h arctan(a/h))]. Source: notes, §2.

    Parameters
    ----------
    slope : slope t of the asymptotic cone [1].
    tip_radius : radius of curvature R at the tip [length].
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "hyperboloid"
    formula: ClassVar[str] = "tip_radius·slope²·(√(1 + r²/(tip_radius·slope)²) − 1)"

    @property
    def scale(self) -> Parameter:
        """Radius h = R t at which the tip turns into the cone."""
        return self.tip_radius * self.slope

    def f(self, radius: Array) -> Array:
        q = radius / self.scale
        return self.slope * radius * q / (1 + np.hypot(1.0, q))

    def df(self, radius: Array) -> Array:
        return self.slope * radius / np.hypot(self.scale, radius)

    def g(self, x: Array) -> Array:
        return self.slope * x * np.arctan(x / self.scale)

    def dg(self, x: Array) -> Array:
        q = x / self.scale
        return self.slope * (np.arctan(q) + q / (1 + q * q))

    def reduced_force(self, coordinate: Array) -> Array:
        a, h = coordinate, self.scale
        return self.slope * (a * a * np.arctan(a / h) + h * atan_gap(a, h))

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate >= 0
