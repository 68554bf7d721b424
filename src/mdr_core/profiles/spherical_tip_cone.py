"""Spherical-tip cone: a cone whose tip is a sphere."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final

import numpy as np

from mdr_core.doubles import EPS
from mdr_core.profiles.cancellation_free import tanh_gap
from mdr_core.profiles.spheroids import Sphere
from mdr_core.profiles.tipped import TippedCone
from mdr_core.typing import Array, Flags, Parameter

# Up to this slope the curvature of the tip rises too little to move the largest pressure from the
# axis.
_SHALLOW: Final = 0.5


@dataclass(frozen=True)
class SphericalTipCone(TippedCone):
    """Sphere of radius R up to b = R t/sqrt(1 + t^2), then its tangent cone.

    Beyond b, with s = sqrt(x^2 - b^2), phi = arctan(s/b), h = sqrt(R^2 - b^2) and
    L = ln((R + x)/(h + s)), g(x) = x (L + t phi) and
    F_N(a)/E* = b^4/(R a + h s) + (R^2 + a^2)(L - tanh L) + t (a^2 phi + b s).
    Source: notes, §2.

    Parameters
    ----------
    slope : slope t of the cone [1].
    tip_radius : R [length].
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "spherical_tip_cone"
    formula: ClassVar[str] = (
        "sphere of tip_radius for r ≤ b = tip_radius·slope/√(1 + slope²), then its tangent cone"
    )

    def rounding_at(self, coordinate: Array) -> Parameter:
        # R - b is about R/(2 t^2).
        return 3e-14 + EPS * self.slope * self.slope

    @cached_property
    def flank_start(self) -> Parameter:
        below = np.nextafter(self.tip_radius, 0.0)
        return np.minimum(self.tip_radius * (self.slope / np.hypot(1.0, self.slope)), below)

    @cached_property
    def _tip(self) -> Sphere:
        return Sphere(self.tip_radius)

    @property
    def pole(self) -> Parameter:
        return self.tip_radius

    @cached_property
    def opposite_singularity(self) -> Parameter:
        """Distance h of the tangent point below the centre; the continued sphere ends at s = -h."""
        return self.tip_radius / np.hypot(1.0, self.slope)

    def _log_term(self, x: Array, s: Array) -> Array:
        """L, from (R + x)/(h + s) = 1 + b^2 [1/(R + h) + 1/(x + s)]/(h + s)."""
        b, big, h = self.flank_start, self.tip_radius, self.opposite_singularity
        return np.log1p(b / (h + s) * (b / (big + h) + b / (x + s)))

    def _flank_depth(self, x: Array, s: Array) -> Array:
        phi = np.arctan(s / self.flank_start)
        return x * (self._log_term(x, s) + self.slope * phi)

    def _flank_slope(self, x: Array, s: Array) -> Array:
        """L + t phi + t b R/(x h + s R)."""
        b, big, h, t = self.flank_start, self.tip_radius, self.opposite_singularity, self.slope
        return self._log_term(x, s) + t * np.arctan(s / b) + t * b * big / (x * h + s * big)

    def _flank_force(self, x: Array, s: Array) -> Array:
        b, big, h = self.flank_start, self.tip_radius, self.opposite_singularity
        sphere = np.square(b * b) / (big * x + h * s)
        sphere = sphere + (big * big + x * x) * tanh_gap(self._log_term(x, s))
        return sphere + self.slope * (x * x * np.arctan(s / b) + b * s)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        on_tip = (coordinate <= self.flank_start) & self._tip.falls_from_axis(coordinate)
        return on_tip | (np.less_equal(self.slope, _SHALLOW) & (coordinate >= 0))
