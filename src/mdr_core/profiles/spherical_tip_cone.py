"""A cone whose tip is an exact sphere."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mdr_core.abel.roots import leg
from mdr_core.profiles.profile import require_positive
from mdr_core.profiles.rounded import Sphere, sphere_kernel
from mdr_core.profiles.rounded_cone import TippedCone
from mdr_core.profiles.stable import tanh_gap
from mdr_core.profiles.stretched import Stretched
from mdr_core.quadrature import DEFAULT, Analytic
from mdr_core.typing import Array, Parameter


@dataclass(frozen=True)
class SphericalTipCone(TippedCone):
    """A sphere R = `tip_radius` up to b = R t/sqrt(1 + t^2), then its tangent cone, t = `slope`.

    With h = sqrt(R^2 - b^2) and L = ln((R + x)/(h + s)) every term below is positive. The
    contact coordinate is the sphere's, v = artanh(a/R), and v_b (1 + (s/l)^2)^(1/C) beyond b:
    a steep cone touches its sphere near the equator, where a has no digits. l makes the
    coordinate's slope the same on both sides. Source: notes, §2 and §4.
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "spherical_tip_cone"
    formula: ClassVar[str] = (
        "sphere of tip_radius for r ≤ b = tip_radius·slope/√(1 + slope²), then its tangent cone"
    )

    def __post_init__(self) -> None:
        require_positive("slope", self.slope)
        require_positive("tip_radius", self.tip_radius)

    @property
    def tangent_radius(self) -> Parameter:
        return self.tip_radius * self.slope / np.hypot(1.0, self.slope)

    @property
    def _height(self) -> Parameter:
        """h = sqrt(R^2 - b^2), the tangent point's distance below the sphere's centre."""
        return self.tip_radius / np.hypot(1.0, self.slope)

    @property
    def _tip(self) -> Sphere:
        return Sphere(self.tip_radius)

    @property
    def scale(self) -> Parameter:
        """v_b = artanh(b/R) = arcsinh(t)."""
        return np.arcsinh(self.slope)

    @property
    def _stretched(self) -> Stretched:
        """The coordinate beyond b, of the excess (s/l)^2: at s = b it is a few v_b."""
        return Stretched(self.scale, np.maximum(self.scale, 2.0))

    @property
    def _length(self) -> Parameter:
        """l [length], where dv/da is the same on both sides: C l^2/(2 v_b) = b h^2/R."""
        part = np.minimum(self.scale, 2.0) * self.tangent_radius / np.hypot(1.0, self.slope)
        return np.sqrt(part) * np.sqrt(self._height)

    @property
    def steepness(self) -> float:
        """The radius leaves the break like the power C of the coordinate."""
        return max(3.5, float(np.max(self._stretched.power)))

    def f(self, radius: Array) -> Array:
        b, big = self.tangent_radius, self.tip_radius
        inner = np.minimum(radius, b)
        tip = inner * inner / (big + np.sqrt((big - inner) * (big + inner)))
        return tip + self.slope * np.maximum(radius - b, 0.0)

    def df(self, radius: Array) -> Array:
        big = self.tip_radius
        inner = np.minimum(radius, self.tangent_radius)
        tip = inner / np.sqrt((big - inner) * (big + inner))
        return np.asarray(np.where(radius < self.tangent_radius, tip, self.slope))

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        b = self.tangent_radius
        tip = np.minimum(self._rapidity(contact_radius), self.scale)
        beyond = self._stretched.coordinate(np.square(leg(contact_radius, b) / self._length))
        return np.where(contact_radius > b, beyond, tip)

    def _rapidity(self, x: Array) -> Array:
        """The sphere's coordinate, up to the tangent radius."""
        return self._tip.coordinate_from_radius(np.minimum(x, self.tangent_radius))

    def _outer(self, coordinate: Array) -> Array:
        return np.asarray(self._length * np.sqrt(self._stretched.excess(coordinate)))

    def _flank_ends(self, coordinate: Array) -> tuple[Array, Array]:
        """a and s on the flank, b and zero inside the tip."""
        s = self._outer(coordinate)
        return np.asarray(np.hypot(self.tangent_radius, s)), s

    def contact_radius(self, coordinate: Array) -> Array:
        tip = self._tip.contact_radius(np.minimum(coordinate, self.scale))
        return np.where(coordinate > self.scale, self._flank_ends(coordinate)[0], tip)

    def _radius_slope_beyond(self, coordinate: Array, a: Array) -> Array:
        """da/dw = (l^2/2a) de/dw: without the root that s has at the break."""
        return np.square(self._length) / (2 * a) * self._stretched.slope(coordinate)

    def radius_slope(self, coordinate: Array) -> Array:
        start = self.scale
        tip = self._tip.radius_slope(np.minimum(coordinate, start))
        safe = np.maximum(coordinate, start)
        beyond = self._radius_slope_beyond(safe, self._flank_ends(safe)[0])
        return np.where(coordinate > start, beyond, tip)

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        b, start = self.tangent_radius, self.scale
        tip_a, tip_c = np.minimum(s_a, start), np.minimum(s_c, start)
        tip = self._tip.coordinate_width(np.minimum(a, b), np.minimum(c, b), tip_a, tip_c)
        # Each side of the tangent radius from the radii, whose digits the coordinate may not have.
        low, high = np.maximum(c, b), np.maximum(a, b)
        step = (high - low) * (high + low) / np.square(self._length)
        beyond = self._stretched.width(np.maximum(s_a, start), np.maximum(s_c, start), step)
        return np.where(s_a <= start, tip, np.where(s_c >= start, beyond, beyond + tip))

    def radius_width(self, s_a: Array, width: Array) -> Array:
        start, low = self.scale, s_a - width
        inside = np.minimum(width, np.maximum(width - (s_a - start), 0.0))
        tip = self._tip.radius_width(np.minimum(s_a, start), inside)
        a, c = self.contact_radius(s_a), self.contact_radius(low)
        total = np.where(a + c > 0, a + c, 1.0)
        step = self._stretched.step(np.maximum(s_a, start), width, np.maximum(low, start))
        beyond = np.square(self._length) * step / total
        across = np.square(self._outer(s_a)) / (a + self.tangent_radius) + tip
        return np.where(s_a <= start, tip, np.where(low >= start, beyond, across))

    def _past(self, coordinate: Array, s: Array) -> Array:
        return self._stretched.past(np.square(s / self._length))

    def _outer_step(self, high: Array, width: Array) -> Array:
        step = self._stretched.step(high, width, high - width)
        return np.asarray(np.square(self._length) * step)

    @property
    def _flank_analytic(self) -> Analytic:
        """The sphere goes on behind the tangent point: a singularity at s = -h, y < 0."""
        behind = float(np.min(np.arcsinh(1 / np.asarray(self.slope))))
        return Analytic(strip=min(DEFAULT.strip, 0.9 * behind))

    @property
    def _pole(self) -> float:
        return float(np.asarray(self.tip_radius))

    @property
    def _behind(self) -> float:
        return float(np.asarray(self._height))

    @property
    def _energy_scale(self) -> Parameter:
        return np.minimum(self.tangent_radius, self._height)

    def _turn(self, x: Array, s: Array) -> Array:
        """L, by 1 + b^2 [1/(R + h) + 1/(x + s)]/(h + s) = (R + x)/(h + s)."""
        b, big, h = self.tangent_radius, self.tip_radius, self._height
        return np.asarray(np.log1p(b / (h + s) * (b / (big + h) + b / (x + s))))

    def g(self, x: Array) -> Array:
        """x artanh(x/R), then x (L + t phi)."""
        b = self.tangent_radius
        outer = np.maximum(x, b)
        flank = self._flank_depth(outer, leg(outer, b))
        return np.where(x < b, x * self._rapidity(x), flank)

    def _flank_depth(self, x: Array, s: Array) -> Array:
        phi = np.arctan(s / self.tangent_radius)
        return np.asarray(x * (self._turn(x, s) + self.slope * phi))

    def dg(self, x: Array) -> Array:
        """artanh(x/R) + x R/(R^2 - x^2), then L + t phi + t b R/(x h + s R)."""
        b, big = self.tangent_radius, self.tip_radius
        inner, outer = np.minimum(x, b), np.maximum(x, b)
        tip = self._rapidity(inner) + inner * big / ((big - inner) * (big + inner))
        return np.where(x < b, tip, self._flank_slope(outer, leg(outer, b)))

    def _flank_slope(self, x: Array, s: Array) -> Array:
        b, big, h = self.tangent_radius, self.tip_radius, self._height
        t = self.slope
        turn = self._turn(x, s) + t * np.arctan(s / b)
        return np.asarray(turn + t * b * big / (x * h + s * big))

    def depth(self, coordinate: Array) -> Array:
        tip = self._tip.depth(np.minimum(coordinate, self.scale))
        flank = self._flank_depth(*self._flank_ends(coordinate))
        return np.where(coordinate > self.scale, flank, tip)

    def depth_slope(self, coordinate: Array) -> Array:
        start = self.scale
        tip = self._tip.depth_slope(np.minimum(coordinate, start))
        safe = np.maximum(coordinate, start)
        a, s = self._flank_ends(safe)
        beyond = self._flank_slope(a, s) * self._radius_slope_beyond(safe, a)
        return np.where(coordinate > start, beyond, tip)

    def reduced_force(self, coordinate: Array) -> Array:
        tip = self._tip.reduced_force(np.minimum(coordinate, self.scale))
        flank = self._flank_force(*self._flank_ends(coordinate))
        return np.where(coordinate > self.scale, flank, tip)

    def _flank_force(self, x: Array, s: Array) -> Array:
        """b^4/(R a + h s) + (R^2 + a^2)(L - tanh L) + t (a^2 phi + b s)."""
        b, big, h = self.tangent_radius, self.tip_radius, self._height
        sphere = np.square(b * b) / (big * x + h * s)
        sphere = sphere + (big * big + x * x) * tanh_gap(self._turn(x, s))
        return np.asarray(sphere + self.slope * (x * x * np.arctan(s / b) + b * s))

    def _tip_energy(self, coordinate: Array) -> Array:
        return self._tip.reduced_energy(coordinate)

    def _tip_kernel(
        self, high: Array, r: Array, rtol: float, width: Array, edge: Array, inner: Array
    ) -> Array:
        return sphere_kernel(self.tip_radius, high, r, rtol, width, edge, inner)

    def _flank_weight(self, x: Array, s: Array) -> Array:
        return self._flank_slope(x, s) * s / x
