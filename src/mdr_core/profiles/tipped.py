"""Profiles with a tip of another kind; the rounded cone, whose tip is a paraboloid."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.elementwise import piecewise, where
from mdr_core.profiles.flanked import Flanked
from mdr_core.profiles.powers import Paraboloid
from mdr_core.profiles.spheroids import Sphere
from mdr_core.typing import Array, Flags, Parameter


class Tipped(Flanked):
    """Profile whose tip is another profile up to the radius b."""

    tip_radius: Parameter
    steepens = True

    @property
    @abstractmethod
    def _tip(self) -> Paraboloid | Sphere:
        """Profile up to b."""

    @cached_property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self.flank_start, dtype=float))

    @property
    def branches(self) -> tuple[Branch, ...]:
        b = float(np.asarray(self.flank_start))
        singularity = float(np.asarray(self.opposite_singularity))
        return (
            Branch(0.0, lambda x, _: self._tip.dg(x), b, pole=float(np.asarray(self.pole))),
            Branch(b, self.weight, opposite_singularity=singularity),
        )

    def weight(self, x: Array, s: Array) -> Array:
        return self._flank_slope(x, s) * s / x

    def _with_flank(
        self, x: Array, of_tip: Callable[[Array], Array], of_flank: Callable[[Array, Array], Array]
    ) -> Array:
        """Value at x, on the tip or on the flank."""
        b = self.flank_start
        return piecewise(x, b, of_tip, lambda x: of_flank(*self.flank(x - b)))

    def g(self, x: Array) -> Array:
        return self._with_flank(x, self._tip.g, self._flank_depth)

    def dg(self, x: Array) -> Array:
        return self._with_flank(x, self._tip.dg, self._flank_slope)

    def depth_slope_beyond(self, coordinate: Array, start: Array, past: Array) -> Array:
        """Parameters: see `Profile`."""
        b = self.flank_start
        past = where(start == b, past, np.maximum(coordinate - b, 0.0))
        flank = self._flank_slope(*self.flank(past))
        return where(coordinate <= b, self._tip.dg(np.minimum(coordinate, b)), flank)

    def reduced_force(self, coordinate: Array) -> Array:
        return self._with_flank(coordinate, self._tip.reduced_force, self._flank_force)

    def reduced_energy(self, coordinate: Array) -> Array:
        b = self.flank_start
        inner = self._tip.reduced_energy(np.minimum(coordinate, b))
        return inner + self._over_flank(self._flank_force, np.maximum(coordinate - b, 0.0))

    def axis_stress(self, coordinate: Array) -> Array:
        b = self.flank_start
        inner = self._tip.axis_stress(np.minimum(coordinate, b))
        past = np.maximum(coordinate - b, 0.0)
        return inner + self._over_flank(lambda x, _: 1 / x, past) / np.pi


class TippedCone(Tipped):
    """Cone of slope t whose tip is another profile up to the tangent radius b."""

    slope: Parameter

    def f(self, radius: Array) -> Array:
        b = self.flank_start
        return self._tip.f(np.minimum(radius, b)) + self.slope * np.maximum(radius - b, 0.0)

    def df(self, radius: Array) -> Array:
        return piecewise(radius, self.flank_start, self._tip.df, lambda _: self.slope)


@dataclass(frozen=True)
class RoundedCone(TippedCone):
    """Paraboloid f = r^2/(2R) up to b = R t, then its tangent cone.

    Beyond b, with s = sqrt(x^2 - b^2) and phi = arctan(s/b), g(x) = t x [b/(x + s) + phi] and
    F_N(a)/E* = t [a^2 phi + (4/3) a^2 b/(a + s) + b s/3]. Source: notes, §2.

    Parameters
    ----------
    slope : slope t of the cone [1].
    tip_radius : radius of curvature R of the tip [length].
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "rounded_cone"
    formula: ClassVar[str] = "r²/(2·tip_radius) for r ≤ b = tip_radius·slope, then slope·(r − b/2)"

    @cached_property
    def flank_start(self) -> Parameter:
        return self.tip_radius * self.slope

    @cached_property
    def _tip(self) -> Paraboloid:
        return Paraboloid(self.tip_radius)

    def _flank_depth(self, x: Array, s: Array) -> Array:
        b = self.flank_start
        return self.slope * x * (b / (x + s) + np.arctan(s / b))

    def _flank_slope(self, x: Array, s: Array) -> Array:
        b = self.flank_start
        return self.slope * (np.arctan(s / b) + 2 * b / (x + s))

    def _flank_force(self, x: Array, s: Array) -> Array:
        b = self.flank_start
        force = x * x * (np.arctan(s / b) + (4 / 3) * b / (x + s)) + b * s / 3
        return self.slope * force

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate >= 0
