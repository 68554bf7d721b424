"""Flat-ended profiles: rounded punch, truncated cone, truncated paraboloid."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.abel.displacement import Branch
from mdr_core.abel.two_root import two_root_integral
from mdr_core.elementwise import some, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import NORMAL_QUANTITIES
from mdr_core.profiles.cancellation_free import atan_gap
from mdr_core.profiles.flanked import Flanked
from mdr_core.typing import Array, Parameter
from mdr_core.validation import first_index


class Truncated(Flanked):
    """Profile with f = 0 up to b = `flat_radius`.

    The contact coordinate is a - b, because a alone is not accurate as a -> b. Source: notes, §4.
    """

    flat_radius: Parameter

    @property
    def flank_start(self) -> Parameter:
        return self.flat_radius

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (Branch(float(np.asarray(self.flat_radius)), self.weight),)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.flat_radius,)

    def _flank_slope(self, x: Array, s: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.weight(x, s) * x / s

    def g(self, x: Array) -> Array:
        return self.depth(np.maximum(x - self.flat_radius, 0.0))

    def dg(self, x: Array) -> Array:
        past = x - self.flat_radius
        return where(past < 0, 0.0, self.depth_slope(np.maximum(past, 0.0)))

    def contact_radius(self, coordinate: Array) -> Array:
        return self.flat_radius + coordinate

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        inside = contact_radius < self.flat_radius
        if some(inside):
            raise InputError(
                ("load", "contact_radius", *first_index(inside)),
                f"the contact cannot be smaller than the flat, flat_radius = {self.flat_radius}",
                inside,
            )
        return contact_radius - self.flat_radius

    def depth(self, coordinate: Array) -> Array:
        return self._flank_depth(*self.flank(coordinate))

    def depth_slope(self, coordinate: Array) -> Array:
        return self._flank_slope(*self.flank(coordinate))

    def reduced_force(self, coordinate: Array) -> Array:
        return self._flank_force(*self.flank(coordinate))

    def reduced_energy(self, coordinate: Array) -> Array:
        return self._over_flank(self._flank_force, coordinate)

    def pressure_kernel(
        self, annulus: Annulus, radius: Array, beyond: Array | None = None
    ) -> Array:
        """Integral over s; the radii are given by s as well if `beyond` has their coordinates.

        Source: notes, §5. Parameters: see `Profile`.
        """
        outer, width, inner, edge, stick = annulus
        b = float(self.flat_radius)
        past = np.maximum(inner - b, 0.0) if stick is None else stick
        (a, top), (c, low) = self.flank(outer), self.flank(past)
        gap = width * (a + c) / where(top > 0, top + low, 1.0)
        ends = Annulus(top, gap, inner, edge, low)
        s = None if beyond is None else self.flank(beyond)[1]
        return two_root_integral(self.weight, b, radius, ends, beyond=s) / pi

    def pressure_kernel_at(self, annulus: Annulus, coordinate: Array) -> Array:
        """Parameters: see `Profile`."""
        inside, values = coordinate < annulus.outer, np.zeros(coordinate.shape)
        past = coordinate[inside]
        x, annuli = self.contact_radius(past), annulus.at(inside)
        values[inside] = self.pressure_kernel(annuli, x, past)
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

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return ()

    def f(self, radius: Array) -> Array:
        return np.square(np.maximum(radius - self.flat_radius, 0.0)) / (2 * self.rounding_radius)

    def df(self, radius: Array) -> Array:
        return np.maximum(radius - self.flat_radius, 0.0) / self.rounding_radius

    def _flank_slope(self, x: Array, s: Array) -> Array:
        return (s + atan_gap(s, self.flat_radius)) / self.rounding_radius

    def _flank_depth(self, x: Array, s: Array) -> Array:
        return x * atan_gap(s, self.flat_radius) / self.rounding_radius

    def _flank_force(self, x: Array, s: Array) -> Array:
        return x * self._flank_depth(x, s) + s * s * s / (3 * self.rounding_radius)

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
    slope : slope t of the flank [1].
    """

    flat_radius: Parameter
    slope: Parameter

    kind: ClassVar[str] = "truncated_cone"
    formula: ClassVar[str] = "0 for r ≤ flat_radius, then slope·(r − flat_radius)"

    def f(self, radius: Array) -> Array:
        return self.slope * np.maximum(radius - self.flat_radius, 0.0)

    def df(self, radius: Array) -> Array:
        return where(radius < self.flat_radius, 0.0, self.slope)

    def _flank_depth(self, x: Array, s: Array) -> Array:
        return self.slope * x * np.arctan(s / self.flat_radius)

    def _flank_force(self, x: Array, s: Array) -> Array:
        b = self.flat_radius
        return self.slope * (x * x * np.arctan(s / b) + b * s)

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

    def f(self, radius: Array) -> Array:
        return np.square(inverse_hypot(radius, self.flat_radius)) / (2 * self.radius)

    def df(self, radius: Array) -> Array:
        return where(radius < self.flat_radius, 0.0, radius / self.radius)

    def _flank_depth(self, x: Array, s: Array) -> Array:
        return x * s / self.radius

    def _flank_force(self, x: Array, s: Array) -> Array:
        b = self.flat_radius
        return 2 * s * (3 * (b * b) + 2 * s * s) / (3 * self.radius)

    def coordinate_from_depth(self, depth: Array) -> Array:
        """s^2 = 2 h^2/(b^2 + sqrt(b^4 + 4 h^2)), h = R d: the root of s^4 + b^2 s^2 = h^2."""
        b2, h = np.square(self.flat_radius), self.radius * depth
        return self._beyond(np.sqrt(2 / (b2 + np.hypot(b2, 2 * h))) * h)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        """s^3 + (3/2) b^2 s = (3/4) R F/E*, by the hyperbolic form of the cubic's root.

        Far from the flat a step of Newton's method removes the rounding error of the logarithm.
        """
        b = self.flat_radius
        goal = 0.75 * (reduced_force * self.radius / (b * np.square(b)))
        z = np.sqrt(2) * np.sinh(np.arcsinh(np.sqrt(2) * goal) / 3)
        z2 = z * z
        return self._beyond(b * (z - (z * (z2 + 1.5) - goal) / (3 * z2 + 1.5)))

    def _beyond(self, s: Array) -> Array:
        """x - b = s^2/(x + b)."""
        return s * (abs(s) / (self.flat_radius + np.hypot(self.flat_radius, s)))

    def reduced_energy(self, coordinate: Array) -> Array:
        """(1/R^2) [a s^2 (b^2 + s^2/3) + s^4 (3a^3 + 6a^2 b + 4a b^2 + 2b^3)/(15 (a + b)^2)]."""
        b, (a, s) = self.flat_radius, self.flank(coordinate)
        s2, height = s * s, s * (s / self.radius)
        cubic = ((3 * a + 6 * b) * a + 4 * (b * b)) * a + 2 * (b * b * b)
        inner = a * ((b * b + s2 / 3) / self.radius)
        return height * (inner + height * (cubic / (15 * np.square(a + b))))

    def weight(self, x: Array, s: Array) -> Array:
        """(x^2 + s^2)/(x R)."""
        return (s * s / x + x) / self.radius
