"""Stress, slip and foundation load of an arc that a nonlinear load step leaves in the traction.

On an arc the slope k of the anchors is proportional to the radius or to its inverse. It acts like
a straight segment under a profile with k g' in place of g': its integrals are those of the
profile, with an analytic factor. Source: notes, §10.
"""

from dataclasses import dataclass, replace

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.displacement import Branch, arccosine, slope_integral
from mdr_core.abel.stress import stress_integral
from mdr_core.profiles import Profile
from mdr_core.typing import Array


@dataclass(frozen=True)
class Arc:
    """Interval low < x < high of the foundation on which k = rate 2x, or rate/(2x)."""

    profile: Profile
    rate: float
    inverse: bool
    """k is proportional to 1/x: the depth was prescribed, not the normal force."""
    low: float
    high: float
    width: float
    """high - low, without cancellation [length]."""

    def stress(self, r: Array) -> Array:
        """int k g'(x)/sqrt(x^2 - r^2) dx over the arc, from r on [1]; shape (m,)."""
        result, inside = np.zeros(r.shape), r < self.high
        if inside.any():
            annulus = Annulus(*(np.array([part]) for part in (self.high, self.width, self.low)))
            result[inside] = stress_integral(self.branches, annulus, r[inside])
        return result

    def slip(self, r: Array) -> Array:
        """(2/pi) int k g'(x) arccos(x/r) dx over the arc, up to r [length]; shape (m,)."""
        result = np.zeros(r.shape)
        at = r[r > self.low]
        if at.size:
            low, high = np.full(at.shape, self.low), np.minimum(at, self.high)
            value = slope_integral(self.branches, low, high, at, arccosine)[0]
            result[r > self.low] = 2 / np.pi * value
        return result

    def anchor_step(self, x: Array) -> Array:
        """int k g'(x) dx from each radius on the arc to its end [length]; shape (m,)."""
        end = np.full(x.shape, self.high)
        branches = self.branches
        return slope_integral(branches, x, end, end, lambda at, _root: np.ones_like(at))[0]

    @property
    def branches(self) -> list[Branch]:
        """Intervals on which k g' is smooth, as those of the profile."""
        return [
            self._weighted(each)
            for each in self.profile.branches
            if each.stop > self.low and max(each.base, each.start) < self.high
        ]

    def _weighted(self, branch: Branch) -> Branch:
        def weight(x: Array, s: Array) -> Array:
            slope = self.rate / (2 * x) if self.inverse else 2 * self.rate * x
            return np.asarray(slope * branch.weight(x, s))

        tip = branch.tip - 1 if self.inverse else branch.tip + 1
        return replace(branch, weight=weight, tip=tip, steepness=branch.steepness + 1)
