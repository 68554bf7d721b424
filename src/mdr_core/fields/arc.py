"""Stress, slip and foundation load of an arc that a nonlinear load step leaves in the traction.

On an arc the slope k of the anchors is proportional to the radius or to its inverse. It acts like
a straight segment under a profile with k g' in place of g': its integrals are those of the
profile, with an analytic factor. Source: notes, §10.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from mdr_core.abel.annulus import Annulus, InnerEnd
from mdr_core.abel.displacement import Branch, arccosine, slope_integral
from mdr_core.abel.two_root import inverse_hypot, two_root_integral
from mdr_core.profiles import Profile
from mdr_core.quadrature import Analytic
from mdr_core.typing import Array, Chosen

# Closer to the axis than this part of the radius at which an arc starts the stress is that on the
# axis.
_NEAR_AXIS: Final = 1e-8
# The same for an arc that starts on the axis, as a part of the radius at which it ends.
_NEXT_TO_AXIS: Final = 1e-120
# Least power to integrate: the quintic of a table's piece, times x of the factor and of dx.
_DEGREE: Final = 7.0
# Tolerance of the foundation's load, for which no tolerance is requested.
_RTOL: Final = 1e-13


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

    def stress(self, r: Array, rtol: float) -> Array:
        """int k g'(x)/sqrt(x^2 - r^2) dx over the arc, from r on [1]; shape (m,)."""
        result = np.zeros(r.shape)
        inside = r < self.high
        if inside.any():
            result[inside] = sum(self._on(each, r[inside], rtol) for each in self.branches)
        return result

    def slip(self, r: Array, rtol: float) -> Array:
        """(2/pi) int k g'(x) arccos(x/r) dx over the arc, up to r [length]; shape (m,)."""
        result = np.zeros(r.shape)
        at = r[r > self.low]
        if at.size:
            low, high = np.full(at.shape, self.low), np.minimum(at, self.high)
            value = slope_integral(self.branches, low, high, at, arccosine, rtol)
            result[r > self.low] = 2 / np.pi * value
        return result

    def anchor_step(self, x: Array) -> Array:
        """int k g'(x) dx from each radius on the arc to its end [length]; shape (m,)."""
        end = np.full(x.shape, self.high)
        branches = self.branches
        return slope_integral(branches, x, end, end, lambda at, _root: np.ones_like(at), _RTOL)

    @property
    def branches(self) -> list[Branch]:
        """Intervals on which k g' is smooth, as those of the profile."""
        return [
            self._weighted(each)
            for each in self.profile.branches
            if each.stop > self.low and max(each.base, each.start) < self.high
        ]

    def _weighted(self, branch: Branch) -> Branch:
        def weight(x: Array, s: Array, index: Chosen) -> Array:
            slope = self.rate / (2 * x) if self.inverse else 2 * self.rate * x
            return np.asarray(slope * branch.weight(x, s, index))

        tip = branch.tip - 1 if self.inverse else branch.tip + 1
        return replace(branch, weight=weight, tip=tip, steepness=branch.steepness + 1)

    def _on(self, branch: Branch, r: Array, rtol: float) -> Array:
        """Part of the stress on one smooth interval of g'."""
        base = branch.base
        low, high = max(self.low, base, branch.start), min(self.high, branch.stop)
        if base == 0:
            r = np.maximum(r, _NEAR_AXIS * low if low > 0 else _NEXT_TO_AXIS * high)
        growth = max(branch.steepness + 1, _DEGREE)
        analytic = Analytic(growth=growth)
        total = np.zeros(r.shape)
        for start, stop in pairwise([*branch.cuts(low, high, branch.opposite_singularity), high]):
            seen = np.flatnonzero(r < stop)
            if not seen.size:
                continue
            roots = inverse_hypot(np.array([start, stop]), base)
            whole = start == self.low and stop == self.high
            gap = self.width if whole else stop - start
            width = np.array([gap * (start + stop) / roots.sum()])
            inner = InnerEnd(width, np.array([start])) if start > base else None
            total[seen] += two_root_integral(
                branch.weight,
                base,
                r[seen],
                Annulus(roots[1:], inner, np.array([stop])),
                rtol=rtol,
                analytic=analytic,
            )
        return total
