"""Spherical-tip cone: a cone whose tip is a sphere."""

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.annulus import Annulus, InnerEnd
from mdr_core.cached import cached_property
from mdr_core.elementwise import piecewise, where
from mdr_core.profiles.base import Profile
from mdr_core.profiles.cancellation_free import tanh_gap
from mdr_core.profiles.spheroids import Sphere, artanh_ratio, artanh_ratio_difference, sphere_kernel
from mdr_core.profiles.tipped import RoundedCone, TippedCone
from mdr_core.typing import Array, Flags, Parameter

# Slope up to which the curvature of the tip rises too little to move the largest pressure.
_SHALLOW: Final = 0.5


@dataclass(frozen=True)
class SphericalTipCone(TippedCone):
    """Sphere of radius R up to b = R t/sqrt(1 + t^2), then its tangent cone.

    Beyond b, with s = sqrt(x^2 - b^2), phi = arctan(s/b), h = sqrt(R^2 - b^2) and
    L = ln((R + x)/(h + s)), g(x) = x (L + t phi) and
    F_N(a)/E* = b^4/(R a + h s) + (R^2 + a^2)(L - tanh L) + t (a^2 phi + b s).

    The contact coordinate is v = artanh(a/R) up to v_b = arcsinh(t), because a steep cone touches
    its sphere near the equator, and v_b + (a - b) R/h^2 beyond it. Source: notes, §2 and §4.

    Parameters
    ----------
    slope : t of the cone [1].
    tip_radius : R [length].
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "spherical_tip_cone"
    formula: ClassVar[str] = (
        "sphere of tip_radius for r ≤ b = tip_radius·slope/√(1 + slope²), then its tangent cone"
    )

    @cached_property
    def tangent_radius(self) -> Parameter:
        return self.tip_radius * self.slope / np.hypot(1.0, self.slope)

    @cached_property
    def scale(self) -> Parameter:
        """v_b = artanh(b/R) [1]."""
        return np.arcsinh(self.slope)

    @cached_property
    def curves(self) -> tuple[tuple[type[Profile], Parameter], ...]:
        """The tip of a flat cone is a paraboloid up to the square of the slope. See `Profile`."""
        square = np.minimum(self.slope * self.slope, 1.0)
        return (RoundedCone, 1.0 - square), (SphericalTipCone, square)

    @cached_property
    def _tip(self) -> Sphere:
        return Sphere(self.tip_radius)

    @cached_property
    def _flank_rate(self) -> Parameter:
        """h^2/R, the derivative of R tanh(v) at b [length]."""
        return self._opposite_singularity / np.hypot(1.0, self.slope)

    def contact_radius(self, coordinate: Array) -> Array:
        b, start = self.tangent_radius, self.scale
        return piecewise(
            coordinate,
            start,
            lambda within: np.minimum(self._tip.contact_radius(within), b),
            lambda beyond: b + (beyond - start) * self._flank_rate,
        )

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        b, start = self.tangent_radius, self.scale
        return piecewise(
            contact_radius,
            b,
            lambda within: np.minimum(artanh_ratio(within, self.tip_radius), start),
            lambda beyond: start + (beyond - b) / self._flank_rate,
        )

    def radius_slope(self, coordinate: Array) -> Array:
        rate = self._flank_rate
        return piecewise(coordinate, self.scale, self._tip.radius_slope, lambda _: rate)

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        """Sum of the tip's part and the flank's. Parameters: see `Profile`."""
        b, start = self.tangent_radius, self.scale
        tip = self._tip.coordinate_width(
            np.minimum(a, b), np.minimum(c, b), np.minimum(s_a, start), np.minimum(s_c, start)
        )
        beyond = (np.maximum(a, b) - np.maximum(c, b)) / self._flank_rate
        return where(s_a <= start, tip, where(s_c >= start, beyond, beyond + tip))

    def radius_width(self, s_a: Array, width: Array) -> Array:
        past = np.maximum(s_a - self.scale, 0.0)
        within = np.maximum(width - past, 0.0)
        tip = self._tip.radius_width(np.minimum(s_a, self.scale), within)
        return tip + np.minimum(width, past) * self._flank_rate

    @property
    def _pole(self) -> float:
        return float(np.asarray(self.tip_radius))

    @cached_property
    def _opposite_singularity(self) -> Parameter:
        """Distance h of the tangent point below the centre: the sphere continues to s = -h."""
        return self.tip_radius / np.hypot(1.0, self.slope)

    def _log_term(self, x: Array, s: Array) -> Array:
        """L, by 1 + b^2 [1/(R + h) + 1/(x + s)]/(h + s) = (R + x)/(h + s)."""
        b, big, h = self.tangent_radius, self.tip_radius, self._opposite_singularity
        return np.log1p(b / (h + s) * (b / (big + h) + b / (x + s)))

    def _flank_depth(self, x: Array, s: Array) -> Array:
        phi = np.arctan(s / self.tangent_radius)
        return x * (self._log_term(x, s) + self.slope * phi)

    def _flank_slope(self, x: Array, s: Array) -> Array:
        return self._slope(x, s, self._log_term(x, s), np.arctan(s / self.tangent_radius))

    def _slope(self, x: Array, s: Array, log_term: Array, phi: Array) -> Array:
        """L + t phi + t b R/(x h + s R)."""
        b, big, h, t = self.tangent_radius, self.tip_radius, self._opposite_singularity, self.slope
        return log_term + t * phi + t * b * big / (x * h + s * big)

    def _flank_force_and_slope(self, x: Array, s: Array) -> tuple[Array, Array]:
        b, big, h = self.tangent_radius, self.tip_radius, self._opposite_singularity
        log_term, phi, square = self._log_term(x, s), np.arctan(s / b), x * x
        sphere = np.square(b * b) / (big * x + h * s)
        sphere = sphere + (big * big + square) * tanh_gap(log_term)
        force = sphere + self.slope * (square * phi + b * s)
        return force, self._slope(x, s, log_term, phi)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        if self.slope <= _SHALLOW:
            return coordinate >= 0
        return (coordinate <= self.scale) & self._tip.falls_from_axis(coordinate)

    def _tip_kernel(self, annulus: Annulus, r: Array, rtol: float) -> Array:
        a, inner, _ = annulus
        v = artanh_ratio(a, self.tip_radius)
        if inner is not None:
            wide = v - artanh_ratio(inner.radius, self.tip_radius)
            width = artanh_ratio_difference(inner.width, a, inner.radius, self.tip_radius, wide)
            inner = InnerEnd(width, inner.radius)
        return sphere_kernel(self.tip_radius, Annulus(v, inner, a), r, rtol)
