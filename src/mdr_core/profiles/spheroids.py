"""Spheroids: sphere and ellipsoid."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.doubles import EPS, TINY
from mdr_core.profiles.base import Profile
from mdr_core.profiles.cancellation_free import tanh_gap
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.quadrature import integrate
from mdr_core.typing import Array, Flags, Indices, Parameter

# Up to this a/R, h = g'(x)/x rises no faster than x. At 0.6412 a h'(a) = h(a): there the sum of (2k
# + 2)(2k - 1)/(2k + 1) t^2k over k >= 1 equals 2.
_SHALLOW: Final = 0.64
# Largest a/R. At the equator the load is infinite, and next to the equator a does not resolve the
# load.
_END: Final = 1 - 1e-8


class Spheroid(Profile):
    """Spheroid f = h (1 - sqrt(1 - r^2/R^2)) of semi-axes R = `radius` and h = `height`.

    g(x) = (h/R) x artanh(x/R), F_N(a)/E* = h R [t^3 + (1 + t^2)(v - t)] with t = a/R and
    v = artanh(t).

    Source: notes, §2 and §4.
    """

    radius: Parameter
    height: Parameter
    steepens = True

    @property
    def domain(self) -> Parameter:
        return self.radius * _END

    @property
    def scale(self) -> Parameter:
        return self.radius

    @property
    def pole(self) -> Parameter:
        return self.radius

    def rounding_at(self, coordinate: Array) -> Parameter:
        """Next to the equator the rounding error of R - a dominates. See `Profile`."""
        return super().rounding_at(coordinate) + EPS / 2 * self.radius / (self.radius - coordinate)

    def f(self, radius: Array) -> Array:
        root = np.sqrt((self.radius - radius) * (self.radius + radius))
        return self.height * (radius / self.radius) * radius / (self.radius + root)

    def df(self, radius: Array) -> Array:
        root = np.sqrt((self.radius - radius) * (self.radius + radius))
        return self.height / self.radius * radius / root

    def g(self, x: Array) -> Array:
        return self.height / self.radius * x * self._artanh(x)

    def dg(self, x: Array) -> Array:
        pole = x * self.radius / ((self.radius - x) * (self.radius + x))
        return self.height / self.radius * (self._artanh(x) + pole)

    def _artanh(self, x: Array) -> Array:
        """artanh(x/R) [1], with the relative accuracy of R - x."""
        return 0.5 * np.log1p(2 * x / (self.radius - x))

    def reduced_force(self, coordinate: Array) -> Array:
        t = coordinate / self.radius
        bracket = t * t * t + (1 + t * t) * tanh_gap(self._artanh(coordinate))
        return self.height * self.radius * bracket

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        """(h/(pi R)) [sqrt(1 + z_r^2) y + int arcsinh(z)/(z cosh y) dy] from y(c) to y(a).

        With z = x/sqrt(R^2 - x^2) and z^2 + 1 = (z_r^2 + 1) cosh^2 y both the root at r and the
        pole at R vanish, and the pole's part is elementary.

        Source: notes, §2. Parameters: see `Profile`.
        """
        a, width, c, *_ = annulus
        r, big, low = radius, self.radius, np.maximum(c, radius)
        square, rest_a, rest_low = ((big - x) * (big + x) for x in (r, a, low))
        stretch, tilt2 = big / np.sqrt(square), r * r / square

        def h(y: Array, index: Indices) -> Array:
            # arcsinh(z)/q for q = z sqrt(1 + z^2), evaluated with one root and one logarithm.
            z2 = np.sinh(y, out=y)
            z2 *= stretch[index]
            z2 *= z2
            z2 += tilt2[index]
            q = np.sqrt(z2 * (1 + z2))
            return np.log1p(2 * (z2 + q)) / (2 * q)

        top = inverse_hypot(a, r) / np.sqrt(rest_a)
        bottom = inverse_hypot(low, r) / np.sqrt(rest_low)
        # arcsinh(top) - arcsinh(bottom), free of cancellation.
        covered = np.where(c > r, width * (a + c), (a - r) * (a + r)) / rest_a / rest_low
        sums = np.maximum(top / np.sqrt(rest_low) + bottom / np.sqrt(rest_a), TINY)
        start, length = np.arcsinh(bottom), np.arcsinh(covered * np.sqrt(square) / sums)
        smooth = integrate(h, length, start)
        return self.height / (pi * big) * stretch * (length + smooth)

    def _integral(self, density: Callable[[Array], Array], coordinate: Array) -> Array:
        """Over v = artanh(x/R), which resolves the pole at the equator. See `Profile`."""

        def over_v(v: Array) -> Array:
            return density(self.radius * np.tanh(v)) * (self.radius / np.square(np.cosh(v)))

        return power_law_integral(over_v, self._artanh(coordinate), 1.0)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate <= _SHALLOW * self.radius


@dataclass(frozen=True)
class Sphere(Spheroid):
    """Sphere f = R - sqrt(R^2 - r^2), not approximated, with g(x) = x artanh(x/R).

    F_N(a)/E* = (R^2 + a^2) artanh(a/R) - a R. Source: notes, §2.

    Parameters
    ----------
    radius : R [length].
    """

    radius: Parameter

    kind: ClassVar[str] = "sphere"
    formula: ClassVar[str] = "radius − √(radius² − r²), contact radius < radius"

    @property
    def height(self) -> Parameter:  # type: ignore[override]  # a field of the ellipsoid
        return self.radius

    @property
    def body_radii(self) -> tuple[Parameter, Parameter]:
        return self.radius, inf


@dataclass(frozen=True)
class Ellipsoid(Spheroid):
    """Spheroid f = h (1 - sqrt(1 - r^2/R^2)) with g(x) = (h/R) x artanh(x/R).

    F_N(a)/E* is h/R times the value of the sphere. Source: notes, §2.

    Parameters
    ----------
    radius : semi-axis R across the axis of symmetry [length].
    height : semi-axis h along it [length].
    """

    radius: Parameter
    height: Parameter

    kind: ClassVar[str] = "ellipsoid"
    formula: ClassVar[str] = "height·(1 − √(1 − r²/radius²)), contact radius < radius"
