"""Hyperboloid, which is smooth at the axis and approaches a cone."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.power_moments import root_step
from mdr_core.abel.two_root import arcsinh_difference
from mdr_core.profiles.base import Profile
from mdr_core.profiles.cancellation_free import atan_gap
from mdr_core.quadrature import integrate
from mdr_core.typing import Array, Chosen, Flags, Parameter


@dataclass(frozen=True)
class Hyperboloid(Profile):
    """Hyperboloid f = R t^2 (sqrt(1 + r^2/h^2) - 1), h = R t, with g(x) = t x arctan(x/h).

    F_N(a)/E* = t [a^2 arctan(a/h) + h (a - h arctan(a/h))]. Source: notes, §2.

    Parameters
    ----------
    slope : t of the asymptotic cone [1].
    tip_radius : radius of curvature R at the tip [length].
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "hyperboloid"
    formula: ClassVar[str] = "tip_radius·slope²·(√(1 + r²/(tip_radius·slope)²) − 1)"
    similar: ClassVar[bool] = True

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

    def pressure_kernel(self, annulus: Annulus, radius: Array, rtol: float) -> Array:
        """x^2 + h^2 = (r^2 + h^2) cosh^2 y removes the root at r and the branch points +-ih.

        Source: notes, §2. Parameters: see `Profile`.
        """
        (a, inner, _), r, h = annulus, radius, self.scale
        r2 = r * r
        rho2 = r2 + h * h
        rho = np.sqrt(rho2)
        top = root_step(Annulus(a), r) / rho

        def integrand(y: Array, index: Chosen) -> Array:
            x = np.sqrt(np.square(rho[index] * np.sinh(y)) + r2[index])
            return np.cosh(y) / x * np.arctan(x / h)

        if inner is None:
            smooth = integrate(integrand, np.arcsinh(top), rtol)
            pole = np.arctan(top)
        else:
            width, c = inner.width, np.maximum(inner.radius, r)
            bottom = np.sqrt((c - r) * (c + r)) / rho
            gap2 = np.minimum(width * (2 * a - width) / rho2, top * top)
            cosh_top, cosh_bottom = np.hypot(h, a) / rho, np.sqrt(1 + bottom * bottom)
            length = arcsinh_difference(top, cosh_top, bottom, cosh_bottom, gap2)
            smooth = integrate(integrand, length, rtol, np.arcsinh(bottom))
            # arctan(top) - arctan(bottom), of which gap2 is the difference of the squares.
            pole = np.arctan(gap2 / ((top + bottom) * (1 + top * bottom)))
        return self.slope / pi * (rho * smooth + h / rho * pole)
