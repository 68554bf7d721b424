"""Cones with a rounded tip, and the rounded cone as the one with a parabolic tip."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.annulus import Annulus, InnerEnd
from mdr_core.abel.displacement import Branch
from mdr_core.abel.two_root import inverse_hypot, root_difference, two_root_integral
from mdr_core.cached import cached_property
from mdr_core.elementwise import every, number, piecewise, piecewise_pair, some, where
from mdr_core.profiles.base import Profile
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.profiles.powers import Paraboloid
from mdr_core.profiles.spheroids import Sphere
from mdr_core.quadrature import DEFAULT, Analytic
from mdr_core.typing import Array, Flags, Parameter

_OnTip = Callable[[Array], Array]
# Of x and s on the flank.
_OnFlank = Callable[[Array, Array], Array]

# Distance below which pieces that halve towards it take fewer nodes, by measurement.
_NEAR: Final = 0.3


class TippedCone(Profile):
    """Cone of slope t whose tip is another profile up to the tangent radius b.

    The flank is given in x and s = sqrt(x^2 - b^2). Up to b the contact coordinate is that of the
    tip, and beyond it a linear function of the radius.
    """

    slope: Parameter
    tip_radius: Parameter

    @property
    @abstractmethod
    def tangent_radius(self) -> Parameter:
        """Radius b at which the tip ends in the cone [length]."""

    @property
    @abstractmethod
    def _tip(self) -> Paraboloid | Sphere:
        """Profile up to b."""

    @abstractmethod
    def _flank_depth(self, x: Array, s: Array) -> Array:
        """g(x) beyond b [length]."""

    @abstractmethod
    def _flank_slope(self, x: Array, s: Array) -> Array:
        """g'(x) beyond b [1]."""

    @abstractmethod
    def _flank_force_and_slope(self, x: Array, s: Array) -> tuple[Array, Array]:
        """F_N(x)/E* [length^2] and g'(x) [1] beyond b."""

    @abstractmethod
    def _tip_kernel(self, annulus: Annulus, r: Array, rtol: float) -> Array:
        """Stress integral of the tip over radii up to a <= b [1]."""

    @property
    def _flank_rate(self) -> Parameter:
        """Derivative of the radius with respect to the contact coordinate beyond b."""
        return 1.0

    @property
    def _pole(self) -> float:
        """Radius beyond b at which g' of the tip is infinite [length]."""
        return inf

    @property
    def _opposite_singularity(self) -> Parameter:
        """Distance of the flank's singularity at s = -`_opposite_singularity` [length]."""
        return inf

    @property
    def _nearest(self) -> Parameter:
        """Distance of the flank's nearest singularity from s = 0 [length]."""
        return np.minimum(self.tangent_radius, self._opposite_singularity)

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.tangent_radius,)

    @property
    def scale(self) -> Parameter:
        return self.tangent_radius

    @cached_property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self.scale, dtype=float))

    @property
    def branches(self) -> tuple[Branch, ...]:
        b = float(np.asarray(self.tangent_radius))
        singularity = float(np.asarray(self._opposite_singularity))
        return (
            Branch(0.0, lambda x, _s, _index: self._tip.dg(x), b, pole=self._pole),
            Branch(
                b, lambda x, s, _index: self._flank_weight(x, s), opposite_singularity=singularity
            ),
        )

    def _flank_weight(self, x: Array, s: Array) -> Array:
        """dg/ds = g'(x) s/x beyond b [1]."""
        return self._flank_slope(x, s) * s / x

    def _outer(self, past: Array) -> tuple[Array, Array]:
        """x and s on the flank from past = x - b >= 0."""
        b = self.tangent_radius
        return b + past, np.sqrt(past * (2 * b + past))

    def _split(self, coordinate: Array, tip: _OnTip, flank: _OnFlank) -> Array:
        """Return tip(coordinate) of contacts that end on the tip, and flank(x, s) of others."""
        start, rate = self.scale, self._flank_rate
        return piecewise(
            coordinate, start, tip, lambda beyond: flank(*self._outer((beyond - start) * rate))
        )

    def f(self, radius: Array) -> Array:
        b = self.tangent_radius
        return self._tip.f(np.minimum(radius, b)) + self.slope * np.maximum(radius - b, 0.0)

    def df(self, radius: Array) -> Array:
        return piecewise(radius, self.tangent_radius, self._tip.df, lambda _: self.slope)

    def g(self, x: Array) -> Array:
        b = self.tangent_radius
        return piecewise(x, b, self._tip.g, lambda x: self._flank_depth(*self._outer(x - b)))

    def dg(self, x: Array) -> Array:
        b = self.tangent_radius
        return piecewise(x, b, self._tip.dg, lambda x: self._flank_slope(*self._outer(x - b)))

    def depth(self, coordinate: Array) -> Array:
        return self._split(coordinate, self._tip.depth, self._flank_depth)

    def depth_slope(self, coordinate: Array) -> Array:
        rate = self._flank_rate
        return self._split(
            coordinate, self._tip.depth_slope, lambda x, s: self._flank_slope(x, s) * rate
        )

    def reduced_force(self, coordinate: Array) -> Array:
        return self.force_and_slope(coordinate)[0]

    def force_and_slope(self, coordinate: Array) -> tuple[Array, Array]:
        start, rate = self.scale, self._flank_rate

        def beyond(place: Array) -> tuple[Array, Array]:
            x, s = self._outer((place - start) * rate)
            force, slope = self._flank_force_and_slope(x, s)
            return force, 2 * x * slope * rate

        return piecewise_pair(coordinate, start, self._tip.force_and_slope, beyond)

    def reduced_energy(self, coordinate: Array) -> Array:
        b, start, rate = self.tangent_radius, self.scale, self._flank_rate

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            force, slope = self._flank_force_and_slope(x, s)
            return force * slope * s / x

        def beyond(place: Array) -> Array:
            _, s = self._outer((place - start) * rate)
            return self._tip_energy + power_law_integral(density, s, self._nearest)

        return piecewise(coordinate, start, self._tip.reduced_energy, beyond)

    @cached_property
    def _tip_energy(self) -> Array:
        """Reduced energy of the whole tip [length^3]."""
        return self._tip.reduced_energy(number(1.0) * self.scale)

    def axis_stress(self, coordinate: Array, rtol: float) -> Array:
        """Sum of the tip's part and (1/pi) int dg/x on the flank. Parameters: see `Profile`."""
        b, start = self.tangent_radius, self.scale
        tip = self._tip.axis_stress(np.minimum(coordinate, start), rtol)

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            return self._flank_weight(x, s) / x

        _, s = self._outer(np.maximum(coordinate - start, 0.0) * self._flank_rate)
        return tip + power_law_integral(density, s, self._nearest) / pi

    def pressure_kernel(self, annulus: Annulus, radius: Array, rtol: float) -> Array:
        """Parts of the tip, from max(r, c) to b, and of the flank. Parameters: see `Profile`."""
        annulus, b = self.radial(annulus), float(self.tangent_radius)
        a, inner, _ = annulus
        total, tip, ends, flank = np.zeros(radius.shape), radius < b, None, a > b
        if inner is not None:
            # A narrow annulus that ends on b lies in the tip, even if rounding moves c onto b.
            tip &= (inner.radius < b) | ~flank
        if some(tip):
            top = np.minimum(a, b)
            if inner is not None:
                width, c, _ = inner
                part = where(width < b / 2, width - (a - top), top - c)
                ends = InnerEnd(np.maximum(part, 0.0), np.minimum(c, b))
            total[tip] = self._tip_kernel(Annulus(top, ends).at(tip), radius[tip], rtol)
        if every(flank):
            total += self._flank_kernel(annulus, b, radius, rtol)
        elif some(flank):
            total[flank] += self._flank_kernel(annulus.at(flank), b, radius[flank], rtol)
        return total

    def _flank_kernel(self, annulus: Annulus, b: float, r: Array, rtol: float) -> Array:
        """Stress integral of the flank over radii up to a > b [1]."""
        a, inner, _ = annulus
        s = inverse_hypot(a, b)
        if inner is not None:
            width, c, _ = inner
            square = where(c > b, width * (2 * a - width), 0.0)
            span = where(c > b, root_difference(s, square, inverse_hypot(c, b)), s)
            inner = InnerEnd(span, c)
        distance = float(np.arcsinh(self._opposite_singularity / b))
        # dg/ds ~ s next to the tip, and it is bounded far from it.
        if distance < _NEAR:
            analytic = Analytic(growth=1.0, before=distance)
        else:
            analytic = Analytic(growth=1.0, strip=min(DEFAULT.strip, distance))
        value = two_root_integral(
            lambda x, s, _: self._flank_weight(x, s),
            b,
            r,
            Annulus(s, inner, a),
            rtol=rtol,
            analytic=analytic,
        )
        return value / pi


@dataclass(frozen=True)
class RoundedCone(TippedCone):
    """Paraboloid f = r^2/(2R) up to b = R t, then its tangent cone.

    Beyond b, with s = sqrt(x^2 - b^2) and phi = arctan(s/b), g(x) = t x [b/(x + s) + phi] and
    F_N(a)/E* = t [a^2 phi + (4/3) a^2 b/(a + s) + b s/3]. Source: notes, §2.

    Parameters
    ----------
    slope : t of the cone [1].
    tip_radius : radius of curvature R of the tip [length].
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "rounded_cone"
    formula: ClassVar[str] = "r²/(2·tip_radius) for r ≤ b = tip_radius·slope, then slope·(r − b/2)"

    similar: ClassVar[bool] = True

    @cached_property
    def tangent_radius(self) -> Parameter:
        return self.tip_radius * self.slope

    @cached_property
    def _tip(self) -> Paraboloid:
        return Paraboloid(self.tip_radius)

    def _flank_depth(self, x: Array, s: Array) -> Array:
        b = self.tangent_radius
        return self.slope * x * (b / (x + s) + np.arctan(s / b))

    def _flank_slope(self, x: Array, s: Array) -> Array:
        b = self.tangent_radius
        return self.slope * (np.arctan(s / b) + 2 * b / (x + s))

    def _flank_force_and_slope(self, x: Array, s: Array) -> tuple[Array, Array]:
        b = self.tangent_radius
        angle, rest = np.arctan(s / b), 2 * b / (x + s)
        force = x * x * (angle + (2 / 3) * rest) + b * s / 3
        return self.slope * force, self.slope * (angle + rest)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate >= 0

    def _tip_kernel(self, annulus: Annulus, r: Array, rtol: float) -> Array:
        return self._tip.pressure_kernel(annulus, r, rtol)
