"""Flat cylindrical punch, whose contact radius does not depend on the load."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.elementwise import full, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import FIELDS, NORMAL_QUANTITIES, Profile
from mdr_core.typing import Array, Parameter


@dataclass(frozen=True)
class FlatPunch(Profile):
    """Flat punch with a vertical edge.

    The contact coordinate is the depth, because all springs of the punch are at one radius. Under a
    tangential load the part of the depth up to c sticks.

    Source: mdr-5, Eqs. (5.31), (5.33); notes, §2.

    Parameters
    ----------
    radius : radius of the punch and of every contact [length].
    """

    radius: Parameter

    kind: ClassVar[str] = "flat_punch"
    formula: ClassVar[str] = "0 for r ≤ radius, then ∞"
    closed_forms: ClassVar[tuple[str, ...]] = (*NORMAL_QUANTITIES, *FIELDS)
    is_flat_punch: ClassVar[bool] = True

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.radius,)

    def f(self, radius: Array) -> Array:
        return where(radius <= self.radius, 0.0, np.inf)

    df = f

    def g(self, x: Array) -> Array:
        return self.f(x)

    dg = g

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (self.radius,)

    def contact_radius(self, coordinate: Array) -> Array:
        return self.radius + 0 * coordinate

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        raise InputError(
            ("load", "contact_radius"),
            "the contact radius of a flat punch is its radius at every load: "
            "prescribe indentation_depth or normal_force",
        )

    def depth(self, coordinate: Array) -> Array:
        return coordinate + 0 * self.radius

    def depth_slope(self, coordinate: Array) -> Array:
        return full(1.0, coordinate)

    def reduced_force(self, coordinate: Array) -> Array:
        return 2 * self.radius * coordinate

    def coordinate_from_depth(self, depth: Array) -> Array:
        return depth

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        return reduced_force / (2 * self.radius)

    def reduced_energy(self, coordinate: Array) -> Array:
        return self.radius * coordinate * coordinate

    def stick_parts(self, ratio: Array, rest: Array, *, of_force: bool) -> tuple[Array, Array]:
        """Source: mdr-5, Eqs. (5.31), (5.33). Parameters: see `Profile`."""
        return rest, ratio

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Parameters: see `Profile`."""
        return 2 * self.radius * width

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array:
        """Parameters: see `Profile`."""
        return self.depth(width)

    def interval_moments(self, span: Array, ends: Array, *, over_forces: bool) -> Array:
        """Zero, because the contact radius is constant. Parameters: see `Profile`."""
        return np.zeros((3, span.size))

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        """d/(pi sqrt(a^2 - r^2)); no slip annulus exists.

        Source: mdr-5, Eq. (5.34). Parameters: see `Profile`.
        """
        return annulus.width / (np.pi * np.sqrt((self.radius - radius) * (self.radius + radius)))

    def slip_integral(self, c: Array, r: Array) -> Array:
        """Zero, because all springs slip at once. Parameters: see `Profile`."""
        return np.zeros(r.shape)

    def outer_displacement(self, a: Array, r: Array, coordinate: float) -> Array:
        """(2/pi) d arcsin(a/r), with the depth as the contact coordinate.

        Parameters: see `Profile`.
        """
        return 2 / np.pi * coordinate * np.arctan2(a, np.sqrt((r - a) * (r + a)))
