"""Spheroids: sphere and ellipsoid."""

from dataclasses import dataclass
from math import log, pi
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.abel.displacement import Branch
from mdr_core.elementwise import some, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import Profile
from mdr_core.profiles.cancellation_free import tanh_gap
from mdr_core.profiles.spheroid_displacement import slope_integral_outside
from mdr_core.quadrature import integrate
from mdr_core.typing import Array, Flags, Indices, Parameter
from mdr_core.validation import first_index

# artanh(1 - 4 eps): closer to the equator R - a is dominated by rounding error.
_EQUATOR: Final = -log(2 * float(np.finfo(float).eps)) / 2
# a/R up to which h = g'(x)/x rises no faster than x: at 0.6412, the root of the sum of
# (2k + 2)(2k - 1)/(2k + 1) t^2k from k = 1 on less 2, a h'(a) is h(a).
_SHALLOW: Final = 0.64
_TINY: Final = float(np.finfo(float).tiny)


class Spheroid(Profile):
    """Spheroid f = h (1 - sqrt(1 - r^2/R^2)) of semi-axes R = `radius` and h = `height`.

    g(x) = (h/R) x artanh(x/R), F_N(a)/E* = h R [t^3 + (1 + t^2)(v - t)] with t = a/R. The contact
    coordinate is v = artanh(a/R), because a alone is not accurate near the equator.

    Source: notes, §2 and §4.
    """

    radius: Parameter
    height: Parameter

    similar: ClassVar[bool] = True

    @property
    def domain(self) -> Parameter:
        return self.radius

    @property
    def last_coordinate(self) -> float:
        return _EQUATOR

    @property
    def scale(self) -> Parameter:
        return 1.0

    @property
    def branches(self) -> tuple[Branch, ...]:
        equator = float(np.asarray(self.radius))
        return (Branch(0.0, lambda x, _: self.dg(x), pole=equator),)

    def f(self, radius: Array) -> Array:
        q = np.square(radius / self.radius)
        return self.height * q / (1 + np.sqrt(1 - q))

    def df(self, radius: Array) -> Array:
        root = np.sqrt((self.radius - radius) * (self.radius + radius))
        return self.height / self.radius * radius / root

    def g(self, x: Array) -> Array:
        return self.depth(artanh_ratio(x, self.radius))

    def dg(self, x: Array) -> Array:
        pole = x * self.radius / ((self.radius - x) * (self.radius + x))
        return self.height / self.radius * (artanh_ratio(x, self.radius) + pole)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        outside = contact_radius >= self.radius
        if some(outside):
            raise InputError(
                ("load", "contact_radius", *first_index(outside)),
                f"must be below the radius of the body, {self.radius}",
                outside,
            )
        return artanh_ratio(contact_radius, self.radius)

    def contact_radius(self, coordinate: Array) -> Array:
        return self.radius * np.tanh(coordinate)

    def radius_slope(self, coordinate: Array) -> Array:
        return self.radius / np.square(np.cosh(coordinate))

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        """Parameters: see `Profile`."""
        big, gap = self.radius, self.radius - a
        narrow = big * (a - c) / (big * gap + a * (self.radius - c))
        return where(narrow < 0.5, np.arctanh(np.minimum(narrow, 0.5)), s_a - s_c)

    def radius_width(self, s_a: Array, width: Array) -> Array:
        cosh = np.cosh(s_a) * np.cosh(s_a - width)
        return self.radius * np.sinh(width) / cosh

    def depth(self, coordinate: Array) -> Array:
        return self.height * coordinate * np.tanh(coordinate)

    def depth_slope(self, coordinate: Array) -> Array:
        sech = 1 / np.cosh(coordinate)
        return self.height * (np.tanh(coordinate) + coordinate * sech * sech)

    def reduced_force(self, coordinate: Array) -> Array:
        t = np.tanh(coordinate)
        bracket = t * t * t + (1 + t * t) * tanh_gap(coordinate)
        return self.height * self.radius * bracket

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        """Integrated in v. Parameters: see `Profile`."""
        integral = slope_integral_outside(self.radius, coordinate, r, rtol)
        return 2 / pi * self.height * integral

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return np.tanh(coordinate) <= _SHALLOW

    def pressure_kernel(self, annulus: Annulus, radius: Array, rtol: float) -> Array:
        """(h/(pi R)) [sqrt(1 + z_r^2) y + int arcsinh(z)/(z cosh y) dy] from y(c) to y(a).

        With z = x/sqrt(R^2 - x^2) and z^2 + 1 = (z_r^2 + 1) cosh^2 y both the root at r and the
        pole at R vanish, and the pole's part is elementary.

        Source: notes, §2. Parameters: see `Profile`.
        """
        (v, inner, edge), r, big = annulus, radius, self.radius
        square = (big - r) * (big + r)
        tilt2 = r * r / square
        stretch = big / np.sqrt(square)

        def h(y: Array, index: Indices) -> Array:
            # arcsinh(z)/q for q = z sqrt(1 + z^2), with one root and a logarithm.
            z2 = np.sinh(y, out=y)
            z2 *= stretch[index]
            z2 *= z2
            z2 += tilt2[index]
            q = np.sqrt(z2 * (1 + z2))
            return np.log1p(2 * (z2 + q)) / (2 * q)

        def root(v: Array, edge: Array | None) -> Array:
            """sqrt((a^2 - r^2)/(R^2 - a^2)) with a = R tanh(v), zero for a < r."""
            a = big * np.tanh(v) if edge is None else edge
            return inverse_hypot(a, r) * (np.cosh(v) / big)

        top = root(v, edge)
        if inner is None:
            start, length = None, np.arcsinh(top)
        else:
            inmost = v - inner.width
            bottom = root(inmost, inner.radius)
            cosh_bottom = np.maximum(np.cosh(inmost) / stretch, 1.0)
            gap2 = np.sinh(inner.width) * np.sinh(2 * v - inner.width) / (stretch * stretch)
            # arcsinh(top) - arcsinh(bottom), free of cancellation; both ends vanish only together.
            sum_ = np.maximum(top * cosh_bottom + bottom * np.cosh(v) / stretch, _TINY)
            start, length = np.arcsinh(bottom), np.arcsinh(np.minimum(gap2, top * top) / sum_)
        smooth = integrate(h, length, rtol, start)
        return self.height / (pi * self.radius) * stretch * (length + smooth)


def artanh_ratio(x: Array, equator: Parameter) -> Array:
    """Return artanh(x/R) [1], as accurate as R - x."""
    return 0.5 * np.log1p(2 * x / (equator - x))


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


@dataclass(frozen=True)
class Ellipsoid(Spheroid):
    """Spheroid f = h (1 - sqrt(1 - r^2/R^2)) with g(x) = (h/R) x artanh(x/R).

    F_N(a)/E* is h/R times that of the sphere. Source: notes, §2.

    Parameters
    ----------
    radius : semi-axis R across the axis of symmetry [length].
    height : semi-axis h along it [length].
    """

    radius: Parameter
    height: Parameter

    kind: ClassVar[str] = "ellipsoid"
    formula: ClassVar[str] = "height·(1 − √(1 − r²/radius²)), contact radius < radius"
