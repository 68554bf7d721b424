"""Profiles with a tip of another kind, and the rounded cone as the one with a parabolic tip."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, pi
from typing import ClassVar

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.elementwise import piecewise, where
from mdr_core.profiles.base import Profile
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.profiles.powers import Paraboloid
from mdr_core.profiles.spheroids import Sphere
from mdr_core.typing import Array, Flags, Parameter


class Tipped(Profile):
    """Profile whose tip is another profile up to the radius b.

    Beyond it, on the flank, g is given in x and s = sqrt(x^2 - b^2).
    """

    tip_radius: Parameter

    @property
    @abstractmethod
    def tangent_radius(self) -> Parameter:
        """Radius b at which the tip ends [length]."""

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
    def _flank_force(self, x: Array, s: Array) -> Array:
        """F_N(x)/E* beyond b [length^2]."""

    @property
    def _opposite_singularity(self) -> Parameter:
        """Distance of the flank's singularity at s = -`_opposite_singularity` [length]."""
        return inf

    @property
    def steepens(self) -> bool:
        return True

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.tangent_radius,)

    @property
    def scale(self) -> Parameter:
        return self.tangent_radius

    @cached_property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self.tangent_radius, dtype=float))

    @property
    def branches(self) -> tuple[Branch, ...]:
        b = float(np.asarray(self.tangent_radius))
        singularity = float(np.asarray(self._opposite_singularity))
        return (
            Branch(0.0, lambda x, _: self._tip.dg(x), b, pole=float(np.asarray(self.pole))),
            Branch(b, self._flank_weight, opposite_singularity=singularity),
        )

    def _flank_weight(self, x: Array, s: Array) -> Array:
        """dg/ds = g'(x) s/x beyond b [1]."""
        return self._flank_slope(x, s) * s / x

    def _outer(self, x: Array) -> tuple[Array, Array]:
        """x and s on the flank."""
        past = x - self.tangent_radius
        return x, np.sqrt(past * (x + self.tangent_radius))

    def g(self, x: Array) -> Array:
        return piecewise(
            x, self.tangent_radius, self._tip.g, lambda x: self._flank_depth(*self._outer(x))
        )

    def dg(self, x: Array) -> Array:
        return piecewise(
            x, self.tangent_radius, self._tip.dg, lambda x: self._flank_slope(*self._outer(x))
        )

    def depth_slope_beyond(self, coordinate: Array, start: Array, past: Array) -> Array:
        """Parameters: see `Profile`."""
        b = self.tangent_radius
        past = where(start == b, past, np.maximum(coordinate - b, 0.0))
        flank = self._flank_slope(b + past, np.sqrt(past * (2 * b + past)))
        return where(coordinate <= b, self._tip.dg(np.minimum(coordinate, b)), flank)

    def reduced_force(self, coordinate: Array) -> Array:
        return piecewise(
            coordinate,
            self.tangent_radius,
            self._tip.reduced_force,
            lambda x: self._flank_force(*self._outer(x)),
        )

    def reduced_energy(self, coordinate: Array) -> Array:
        b, tip = self.tangent_radius, self._tip

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            return self._flank_force(x, s) * self._flank_weight(x, s)

        inner = tip.reduced_energy(np.minimum(coordinate, b))
        return inner + self._over_flank(density, coordinate)

    def _over_flank(self, density: Callable[[Array], Array], coordinate: Array) -> Array:
        """Integral of a density over s from b to the contact edge."""
        _, s = self._outer(np.maximum(coordinate, self.tangent_radius))
        nearest = np.minimum(self.tangent_radius, self._opposite_singularity)
        return power_law_integral(density, s, nearest)

    def axis_stress(self, coordinate: Array) -> Array:
        """Sum of the tip's part and (1/pi) int dg/x on the flank. Parameters: see `Profile`."""
        b, tip = self.tangent_radius, self._tip

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            return self._flank_weight(x, s) / x

        inner = tip.axis_stress(np.minimum(coordinate, b))
        return inner + self._over_flank(density, coordinate) / pi


class TippedCone(Tipped):
    """Cone of slope t whose tip is another profile up to the tangent radius b."""

    slope: Parameter

    def f(self, radius: Array) -> Array:
        b = self.tangent_radius
        return self._tip.f(np.minimum(radius, b)) + self.slope * np.maximum(radius - b, 0.0)

    def df(self, radius: Array) -> Array:
        return piecewise(radius, self.tangent_radius, self._tip.df, lambda _: self.slope)


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

    def _flank_force(self, x: Array, s: Array) -> Array:
        b = self.tangent_radius
        force = x * x * (np.arctan(s / b) + (4 / 3) * b / (x + s)) + b * s / 3
        return self.slope * force

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate >= 0
