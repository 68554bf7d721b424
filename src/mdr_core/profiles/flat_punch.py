"""The flat cylindrical punch: its radius is given, its depth is free."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mdr_core.errors import InputError
from mdr_core.profiles.profile import NORMAL_ANSWERS, Profile, require_positive
from mdr_core.typing import Array, Parameter


@dataclass(frozen=True)
class FlatPunch(Profile):
    """A flat of `radius` with a vertical edge; the coordinate is the depth, the radius given.

    Source: mdr-5, Eqs. (5.31), (5.33); notes, §2.
    """

    radius: Parameter

    kind: ClassVar[str] = "flat_punch"
    formula: ClassVar[str] = "0 for r ≤ radius, then ∞"
    closed_forms: ClassVar[tuple[str, ...]] = (*NORMAL_ANSWERS, "pressure")

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.radius,)

    def f(self, radius: Array) -> Array:
        return np.asarray(np.where(radius <= self.radius, 0.0, np.inf))

    def df(self, radius: Array) -> Array:
        return self.f(radius)

    def g(self, x: Array) -> Array:
        return self.f(x)

    def dg(self, x: Array) -> Array:
        return self.f(x)

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.radius,)

    @property
    def slips_at_once(self) -> bool:
        return True

    def contact_radius(self, coordinate: Array) -> Array:
        return self.radius + np.zeros_like(coordinate)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        raise InputError(
            ("load", "contact_radius"),
            "the contact radius of a flat punch is its own at every load: "
            "give the depth or the force",
        )

    def depth(self, coordinate: Array) -> Array:
        return np.asarray(coordinate + np.zeros_like(self.radius))

    def depth_slope(self, coordinate: Array) -> Array:
        return np.ones_like(coordinate)

    def reduced_force(self, coordinate: Array) -> Array:
        return 2 * self.radius * coordinate

    def coordinate_from_depth(self, depth: Array) -> Array:
        return depth

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        return reduced_force / (2 * self.radius)

    def reduced_energy(self, coordinate: Array) -> Array:
        return self.radius * coordinate * coordinate

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
        """d / (pi sqrt(a^2 - r^2)): the edge term of Eq. (5.34); no slip annulus exists."""
        depth = coordinate if width is None else width
        return modulus * depth / (np.pi * np.sqrt((self.radius - radius) * (self.radius + radius)))

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        """(2/pi) d arcsin(a/r): the coordinate of a flat punch is its depth."""
        return np.asarray(2 / np.pi * coordinate * np.arctan2(a, np.sqrt((r - a) * (r + a))))
