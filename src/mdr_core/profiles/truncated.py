"""Flat-ended profiles: rounded punch, truncated cone, truncated paraboloid."""

from abc import abstractmethod
from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.abel.displacement import Branch
from mdr_core.abel.two_root import two_root_integral
from mdr_core.elementwise import some, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import NORMAL_QUANTITIES, Profile
from mdr_core.profiles.cancellation_free import atan_gap
from mdr_core.typing import Array, Parameter
from mdr_core.validation import first_index


class Truncated(Profile):
    """Profile with f = 0 up to b = `flat_radius` and a closed dg/ds = g'(x) s/x beyond it.

    The contact coordinate is s = sqrt(a^2 - b^2), because a alone is not accurate as a -> b.
    Source: notes, §4.
    """

    flat_radius: Parameter

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    @property
    def scale(self) -> Parameter:
        return self.flat_radius

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (Branch(float(np.asarray(self.flat_radius)), self.weight),)

    @abstractmethod
    def weight(self, x: Array, s: Array) -> Array:
        """Slope dg/ds = g'(x) s/x beyond the flat [1], analytic and even in s."""

    def g(self, x: Array) -> Array:
        return self.depth(inverse_hypot(x, self.flat_radius))

    def dg(self, x: Array) -> Array:
        s = inverse_hypot(x, self.flat_radius)
        with np.errstate(divide="ignore", invalid="ignore"):
            return where(x < self.flat_radius, 0.0, self.weight(x, s) * x / s)

    def depth_slope(self, coordinate: Array) -> Array:
        return self.weight(self.contact_radius(coordinate), coordinate)

    def contact_radius(self, coordinate: Array) -> Array:
        return np.sqrt(self.flat_radius * self.flat_radius + coordinate * coordinate)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        inside = contact_radius < self.flat_radius
        if some(inside):
            raise InputError(
                ("load", "contact_radius", *first_index(inside)),
                f"the contact cannot be smaller than the flat, flat_radius = {self.flat_radius}",
                inside,
            )
        return inverse_hypot(contact_radius, self.flat_radius)

    def radius_slope(self, coordinate: Array) -> Array:
        return coordinate / self.contact_radius(coordinate)

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        """(a^2 - c^2)/(s_a + s_c). Parameters: see `Profile`."""
        return (a - c) * (a + c) / where(s_a > 0, s_a + s_c, 1.0)

    def radius_width(self, s_a: Array, width: Array) -> Array:
        total = self.contact_radius(s_a) + self.contact_radius(s_a - width)
        return width * (2 * s_a - width) / where(total > 0, total, 1.0)

    def pressure_kernel(
        self, annulus: Annulus, radius: Array, rtol: float, beyond: Array | None = None
    ) -> Array:
        """In the contact coordinate, of the radii as well if it is given as `beyond`.

        Source: notes, §5. Parameters: see `Profile`.
        """
        b = float(self.flat_radius)
        return two_root_integral(self.weight, b, radius, annulus, rtol=rtol, beyond=beyond) / pi

    def pressure_kernel_at(self, annulus: Annulus, coordinate: Array, rtol: float) -> Array:
        """Parameters: see `Profile`."""
        inside, values = coordinate < annulus.outer, np.zeros(coordinate.shape)
        s = coordinate[inside]
        values[inside] = self.pressure_kernel(annulus.at(inside), self.contact_radius(s), rtol, s)
        return values


@dataclass(frozen=True)
class RoundedPunch(Truncated):
    """Flat punch with a parabolic edge, f = (r - b)^2/(2R) beyond the flat.

    g(x) = (x/R)(s - b arctan(s/b)), s = sqrt(x^2 - b^2), and F_N(a)/E* = a d + s^3/(3R).
    Source: mdr-5, Eqs. (5.55)-(5.70), the force in a form free of cancellation.

    Parameters
    ----------
    flat_radius : b [length].
    rounding_radius : radius of curvature R of the edge [length].
    """

    flat_radius: Parameter
    rounding_radius: Parameter

    kind: ClassVar[str] = "rounded_punch"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then (r − flat_radius)²/(2·rounding_radius)"

    def f(self, radius: Array) -> Array:
        return np.square(np.maximum(radius - self.flat_radius, 0.0)) / (2 * self.rounding_radius)

    def df(self, radius: Array) -> Array:
        return np.maximum(radius - self.flat_radius, 0.0) / self.rounding_radius

    def dg(self, x: Array) -> Array:
        s, b = inverse_hypot(x, self.flat_radius), self.flat_radius
        return (s + atan_gap(s, b)) / self.rounding_radius

    def depth(self, coordinate: Array) -> Array:
        gap = atan_gap(coordinate, self.flat_radius)
        return self.contact_radius(coordinate) * gap / self.rounding_radius

    def reduced_force(self, coordinate: Array) -> Array:
        cube = coordinate * coordinate * coordinate
        edge = self.contact_radius(coordinate)
        return edge * self.depth(coordinate) + cube / (3 * self.rounding_radius)

    def weight(self, x: Array, s: Array) -> Array:
        """(b/R) (2 s/b - arctan(s/b)) s/x."""
        z = s / self.flat_radius
        return (2 * z - np.arctan(z)) * s / x * (self.flat_radius / self.rounding_radius)


@dataclass(frozen=True)
class TruncatedCone(Truncated):
    """Cone without its tip, f = t (r - b) beyond the flat.

    g(x) = t x arctan(s/b), s = sqrt(x^2 - b^2), and F_N(a)/E* = t (a^2 arctan(s/b) + b s).
    Source: notes, §2.

    Parameters
    ----------
    flat_radius : b [length].
    slope : t [1].
    """

    flat_radius: Parameter
    slope: Parameter

    kind: ClassVar[str] = "truncated_cone"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then slope·(r − flat_radius)"

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    def f(self, radius: Array) -> Array:
        return self.slope * np.maximum(radius - self.flat_radius, 0.0)

    def df(self, radius: Array) -> Array:
        return where(radius < self.flat_radius, 0.0, self.slope)

    def depth(self, coordinate: Array) -> Array:
        phi = np.arctan(coordinate / self.flat_radius)
        return self.slope * self.contact_radius(coordinate) * phi

    def reduced_force(self, coordinate: Array) -> Array:
        b, edge = self.flat_radius, self.contact_radius(coordinate)
        return self.slope * (edge * edge * np.arctan(coordinate / b) + b * coordinate)

    def weight(self, x: Array, s: Array) -> Array:
        """t (s arctan(s/b) + b)/x."""
        b = self.flat_radius
        return self.slope * (np.arctan(s / b) * s + b) / x


@dataclass(frozen=True)
class TruncatedParaboloid(Truncated):
    """Worn paraboloid, f = (r^2 - b^2)/(2R) beyond the flat.

    g(x) = x s/R, s = sqrt(x^2 - b^2), and F_N(a)/E* = 2 s (2a^2 + b^2)/(3R). Source: notes, §2.

    Parameters
    ----------
    flat_radius : b [length].
    radius : radius of curvature R [length].
    """

    flat_radius: Parameter
    radius: Parameter

    kind: ClassVar[str] = "truncated_paraboloid"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then (r² − flat_radius²)/(2·radius)"
    closed_forms: ClassVar[tuple[str, ...]] = NORMAL_QUANTITIES

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    def f(self, radius: Array) -> Array:
        return np.square(inverse_hypot(radius, self.flat_radius)) / (2 * self.radius)

    def df(self, radius: Array) -> Array:
        return where(radius < self.flat_radius, 0.0, radius / self.radius)

    def depth(self, coordinate: Array) -> Array:
        return self.contact_radius(coordinate) * coordinate / self.radius

    def reduced_force(self, coordinate: Array) -> Array:
        b, s = self.flat_radius, coordinate
        return 2 * s * (3 * (b * b) + 2 * s * s) / (3 * self.radius)

    def coordinate_from_depth(self, depth: Array) -> Array:
        """s^2 = 2 h^2/(b^2 + sqrt(b^4 + 4 h^2)), h = R d: the root of s^4 + b^2 s^2 = h^2."""
        b2, h = np.square(self.flat_radius), self.radius * depth
        return np.sqrt(2 / (b2 + np.hypot(b2, 2 * h))) * h

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        """s^3 + (3/2) b^2 s = (3/4) R F/E*, by the hyperbolic form of the cubic's root.

        A step of Newton's method removes the rounding error of its logarithm far from the flat.
        """
        b = self.flat_radius
        goal = 0.75 * (reduced_force * self.radius / (b * np.square(b)))
        z = np.sqrt(2) * np.sinh(np.arcsinh(np.sqrt(2) * goal) / 3)
        z2 = z * z
        return b * (z - (z * (z2 + 1.5) - goal) / (3 * z2 + 1.5))

    def reduced_energy(self, coordinate: Array) -> Array:
        """(1/R^2) [a s^2 (b^2 + s^2/3) + s^4 (3a^3 + 6a^2 b + 4a b^2 + 2b^3)/(15 (a + b)^2)]."""
        b, s2 = self.flat_radius, coordinate * coordinate
        a = self.contact_radius(coordinate)
        cubic = ((3 * a + 6 * b) * a + 4 * (b * b)) * a + 2 * (b * b * b)
        outer = s2 * s2 * cubic / (15 * np.square(a + b))
        return (a * s2 * (b * b + s2 / 3) + outer) / np.square(self.radius)

    def weight(self, x: Array, s: Array) -> Array:
        """(x^2 + s^2)/(x R)."""
        return (s * s / x + x) / self.radius
