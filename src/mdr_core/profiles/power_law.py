"""Cone and paraboloid: the powers of the radius of which everything is closed."""

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from mdr_core.profiles.power_kernels import log_ratio, root_step
from mdr_core.profiles.profile import NORMAL_ANSWERS, Profile, require_positive
from mdr_core.profiles.stable import atan_gap
from mdr_core.typing import Array, Parameter

_EVERYTHING: Final = (*NORMAL_ANSWERS, "pressure", "shear_stress", "slip", "normal_displacement")


@dataclass(frozen=True)
class Cone(Profile):
    """f = t r with t = `slope` = tan(theta) [1]. Source: mdr-5, Eqs. (5.46)-(5.53)."""

    slope: Parameter

    kind: ClassVar[str] = "cone"
    formula: ClassVar[str] = "slope·r"
    closed_forms: ClassVar[tuple[str, ...]] = _EVERYTHING

    def __post_init__(self) -> None:
        require_positive("slope", self.slope)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (0.0,)

    def f(self, radius: Array) -> Array:
        return self.slope * radius

    def df(self, radius: Array) -> Array:
        return self.slope * np.ones_like(radius)

    def g(self, x: Array) -> Array:
        return (np.pi / 2) * self.slope * x

    def dg(self, x: Array) -> Array:
        return (np.pi / 2) * self.slope * np.ones_like(x)

    def reduced_force(self, coordinate: Array) -> Array:
        return (np.pi / 2) * self.slope * coordinate * coordinate

    def coordinate_from_depth(self, depth: Array) -> Array:
        return depth / ((np.pi / 2) * self.slope)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        return np.asarray(np.sqrt(reduced_force / ((np.pi / 2) * self.slope)))

    def reduced_energy(self, coordinate: Array) -> Array:
        return np.square(self.g(coordinate)) * coordinate / 3

    def stick_from_force_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array]:
        """c/a = sqrt(1 - rho). Source: mdr-5, Eq. (5.49)."""
        k = np.sqrt(rest)
        return coordinate * k, coordinate * (ratio / (1 + k))

    def stick_from_depth_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array]:
        """Source: mdr-5, Eq. (5.47)."""
        return coordinate * rest, coordinate * ratio

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Source: mdr-5, Eq. (5.48)."""
        return (np.pi / 2) * self.slope * width * (2 * coordinate - width)

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        return self.g(width + np.zeros_like(coordinate))

    def slip_moment(self, coordinate: Array, width: Array, stick: Array) -> Array:
        return np.square((np.pi / 2) * self.slope) * np.square(width) * width / 6 + np.zeros_like(
            coordinate
        )

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        """t [sqrt(r^2 - c^2) - c arccos(c/r)]. Source: notes, §4."""
        leg = np.sqrt((r - c) * (r + c))
        return np.asarray(self.slope * np.where(c > 0, atan_gap(leg, np.where(c > 0, c, 1.0)), r))

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        """t [a arcsin(a/r) - (r - sqrt(r^2 - a^2))]. Source: notes, §7."""
        half = a / (r + np.sqrt((r - a) * (r + a)))
        return np.asarray(self.slope * a * (2 * np.arctan(half) - half))

    @property
    def tip_pressure(self) -> Parameter:
        return self.slope / 2

    def pressure_kernel(
        self,
        coordinate: Array,
        radius: Array,
        rtol: float,
        width: Array | None = None,
        edge: Array | None = None,
        modulus: float = 1.0,
        inner: Array | None = None,
    ) -> Array:
        """(t/2) [arccosh(a/r) - arccosh(c/r)]. Source: mdr-5, Eq. (5.53)."""
        return (modulus * self.slope / 2) * log_ratio(coordinate, radius, width, inner)


@dataclass(frozen=True)
class Paraboloid(Profile):
    """f = r^2/(2R), R = `radius` of curvature [length]. Source: mdr-5, Eqs. (5.5)-(5.17)."""

    radius: Parameter

    kind: ClassVar[str] = "paraboloid"
    formula: ClassVar[str] = "r²/(2·radius)"
    closed_forms: ClassVar[tuple[str, ...]] = _EVERYTHING

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)

    def f(self, radius: Array) -> Array:
        return radius * radius / (2 * self.radius)

    def df(self, radius: Array) -> Array:
        return radius / self.radius

    def g(self, x: Array) -> Array:
        square = np.asarray(x * x)
        square /= self.radius
        return square

    def dg(self, x: Array) -> Array:
        return 2 * x / self.radius

    def reduced_force(self, coordinate: Array) -> Array:
        return coordinate * coordinate * coordinate * (4 / (3 * self.radius))

    def coordinate_from_depth(self, depth: Array) -> Array:
        return np.sqrt(self.radius * depth)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        cube = np.asarray(reduced_force * self.radius)
        cube *= 0.75
        return np.cbrt(cube, out=cube)

    def reduced_energy(self, coordinate: Array) -> Array:
        return np.square(self.g(coordinate)) * coordinate * (8 / 15)

    def pressure_kernel(
        self,
        coordinate: Array,
        radius: Array,
        rtol: float,
        width: Array | None = None,
        edge: Array | None = None,
        modulus: float = 1.0,
        inner: Array | None = None,
    ) -> Array:
        """(2/(pi R)) [sqrt(a^2 - r^2) - sqrt(c^2 - r^2)]. Source: mdr-5, Eq. (5.38)."""
        root = root_step(coordinate, radius, width, inner)
        root *= 2 * modulus / (np.pi * self.radius)
        return root

    def stick_from_force_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array]:
        """c/a = (1 - rho)^(1/3). Source: mdr-5, Eq. (5.16)."""
        k = np.asarray(np.cbrt(rest))
        # 1 - k = (1 - k^3)/(1 + k + k^2), in as few arrays as the millions of a sweep allow.
        width = np.asarray(k + 1)
        width *= k
        width += 1
        np.divide(ratio, width, out=width)
        if coordinate.shape != width.shape:
            return coordinate * k, coordinate * width
        width *= coordinate
        k *= coordinate
        return k, width

    def stick_from_depth_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array]:
        """c^2 = R (d - G* u/(E* mu)). Source: mdr-5, Eqs. (5.11), (5.12)."""
        k = np.sqrt(rest)
        return coordinate * k, coordinate * (ratio / (1 + k))

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Source: mdr-5, Eq. (5.15)."""
        cubes = 3 * coordinate * (coordinate - width) + width * width
        return width * cubes * (4 / (3 * self.radius))

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        step = np.asarray(2 * coordinate - width)
        step *= width
        step /= self.radius
        return step

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        """(1/(pi R)) [c (s - c phi) + s^2 phi], s = sqrt(r^2 - c^2). Source: mdr-5, Eq. (5.45)."""
        leg2 = (r - c) * (r + c)
        leg = np.sqrt(leg2)
        gap = atan_gap(leg, np.where(c > 0, c, 1.0))
        return np.asarray((c * gap + leg2 * np.arctan2(leg, c)) / (np.pi * self.radius))

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        """(1/(pi R)) [a^2 phi + s (a - s phi)], s = sqrt(r^2 - a^2), phi = arcsin(a/r).

        Source: johnson, Eq. (3.42a); notes, §7.
        """
        leg = np.sqrt((r - a) * (r + a))
        gap = atan_gap(a, np.where(leg > 0, leg, 1.0))
        return np.asarray((a * a * np.arctan2(a, leg) + leg * gap) / (np.pi * self.radius))

    def slip_moment(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """(2/(15 R^2)) (a - c)^3 (a^2 + 3 a c + c^2). Source: mdr-5, section 5.2; notes, §6."""
        a, c = coordinate, coordinate - width
        return (
            2 / 15 * np.square(width) * width * (a * a + 3 * a * c + c * c) / np.square(self.radius)
        )
