"""Integrals over an arc that a loading history left, where the anchors' slope k is no constant.

On a leg of mixed control k is proportional to the radius, or to its inverse. So an arc acts like a
straight piece under a body with k g' in place of g': the integrals of the stress and of the slip
over it are those of the profile, with a factor that is smooth. Source: notes, §10.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, sqrt
from typing import Final

import numpy as np

from mdr_core import annulus
from mdr_core.abel import StressPanels, one_sided
from mdr_core.abel.displacement import Branch, slope_integral
from mdr_core.abel.roots import leg
from mdr_core.abel.weighted import over_radius, times_radius
from mdr_core.history.adaptive import integrate
from mdr_core.history.branches import last_break
from mdr_core.profiles import Profile
from mdr_core.quadrature import Analytic
from mdr_core.typing import Array, Chosen, Indices

# Nearer to the axis than these parts of where an arc begins, or of where it ends, a stress does
# not change any more.
_NEAR: Final = 1e-8
_NEXT_TO_NOTHING: Final = 1e-120
# Pieces end half way to a pole, and each takes so many nodes that it is not felt.
_HALF: Final = 0.5
_NODES: Final = 24
# Of a table's polynomials and the factor.
_DEGREE: Final = 14.0
_FINEST: Final = 1e-12


@dataclass(frozen=True)
class Arc:
    """A stretch low < x < high of the foundation on which k = rate 2 x, or rate/(2 x)."""

    profile: Profile
    rate: float
    inverse: bool
    """k falls with the radius: the depth was given, not the normal force."""
    low: float
    high: float
    width: float
    """high - low, with its digits [length]."""

    def slope(self, x: Array) -> Array:
        """k(x) [1]."""
        return np.asarray(self.rate / (2 * x) if self.inverse else 2 * self.rate * x)

    def stress(self, r: Array, rtol: float) -> Array:
        """int k g'(x)/sqrt(x^2 - r^2) dx over the arc, from r on [1]; shape (m,)."""
        result = np.zeros(r.shape)
        inside = r < self.high
        if inside.any():
            result[inside] = self._stress(r[inside], rtol)
        return result

    def slip(self, r: Array, rtol: float) -> Array:
        """(2/pi) int k g'(x) arccos(x/r) dx over the arc, up to r [length]; shape (m,)."""
        result = np.zeros(r.shape)
        beyond = r > self.low
        if beyond.any():
            at = r[beyond]
            panels = self.profile.panels(rtol)
            given = self.profile.branches if panels is None else panels.branches
            branches = [self._stretched(each) for each in given]
            low, high = np.full(at.shape, self.low), np.minimum(at, self.high)
            value = slope_integral(branches, low, high, at, rtol, outside=False)
            result[beyond] = 2 / np.pi * value
        return result

    def _stress(self, r: Array, rtol: float) -> Array:
        panels = self.profile.panels(rtol)
        if panels is None:
            parts = [self._on_branch(each, self.low, r, rtol) for each in self.profile.branches]
            return np.asarray(sum(parts))
        total, begin, first = np.zeros(r.shape), self.low, float(panels.edges[1])
        if self.inverse and panels.edges[0] == 0 and begin < first:
            # On the axis the factor is no polynomial.
            begin = min(first, self.high)
            for each in panels.branches:
                if each.base == 0:
                    total += self._on_branch(each, self.low, r, rtol, degree=_DEGREE)
        if begin < self.high:
            seen = slice(None) if begin == self.low else r < self.high
            total[seen] += self._on_panels(panels, begin, r[seen], rtol)
        return total

    def _on_panels(self, panels: StressPanels, begin: float, r: Array, rtol: float) -> Array:
        width = self.width if begin == self.low else self.high - begin
        high, span, low = (np.array([value]) for value in (self.high, width, begin))
        if self.inverse:
            return self.rate / 2 * over_radius(panels).kernel(high, r, rtol, span, low)
        return 2 * self.rate * times_radius(panels).kernel(high, r, rtol, span, low)

    def _stretched(self, branch: Branch) -> Branch:
        def weight(x: Array, s: Array, index: Chosen) -> Array:
            return self.slope(x) * branch.weight(x, s, index)

        tip = branch.tip - 1 if self.inverse else branch.tip + 1
        return replace(branch, weight=weight, tip=tip, steepness=branch.steepness + 1)

    def _on_branch(
        self, branch: Branch, begin: float, r: Array, rtol: float, degree: float = 0.0
    ) -> Array:
        """The part of the arc on one smooth stretch of g'."""
        base = branch.base
        low, high = max(begin, base, branch.start), min(self.high, branch.stop)
        total = np.zeros(r.shape)
        if not high > low:
            return total
        at = r
        if base == 0:
            at = np.maximum(r, _NEAR * low if low > 0 else _NEXT_TO_NOTHING * high)
        weight = self._stretched(branch).weight
        growth = max(branch.steepness + 2, degree)
        cut = branch.pole < inf or branch.behind < inf or degree > 0
        analytic = Analytic(growth=growth, zeros=2, fewest=_NODES if cut else 0)
        for start, stop in pairwise([low, *_cuts(branch, low, high), high]):
            seen = np.flatnonzero(at < stop)
            if not seen.size:
                continue
            legs = leg(np.array([start, stop]), base)
            whole = start == self.low and stop == self.high
            gap = self.width if whole else stop - start
            width = gap * (start + stop) / legs.sum()
            total[seen] += one_sided(
                weight,
                base,
                at[seen],
                legs[1:],
                width=np.array([width]) if start > base else None,
                edge=np.array([stop]),
                inner=np.array([start]) if start > base else None,
                odd=False,
                rtol=rtol,
                analytic=analytic,
            )
        return total


def _cuts(branch: Branch, low: float, high: float) -> list[float]:
    """Radii at which a stretch is cut, so that no piece is longer than its way to a pole."""
    cuts, at = [], low
    while branch.pole < inf:
        at = branch.pole - _HALF * (branch.pole - at)
        if at >= high:
            break
        cuts.append(at)
    if branch.behind < inf:
        s, base = sqrt((low - branch.base) * (low + branch.base)), branch.base
        while True:
            s = 2 * s + branch.behind
            at = sqrt(base * base + s * s)
            if at >= high:
                break
            if at > low:
                cuts.append(at)
    return sorted(cuts)


def anchor_step(profile: Profile, rate: float, end: float, at: Array, *, inverse: bool) -> Array:
    """int k dw from each contact coordinate of an arc to its end [length]; shape (m,)."""
    if not inverse:
        top = np.full(at.shape, end)
        return np.asarray(rate * annulus.force_step(profile, top, top - at, at))
    breaks = profile.coordinate_breaks
    lowest = float(at.min(initial=end))
    edges = np.unique(np.concatenate([at, [end], breaks[(breaks > lowest) & (breaks < end)]]))
    edges = edges[edges <= end]
    base = last_break(breaks, edges)

    def density(index: Indices, root: Array) -> Array:
        s = base[index] + root * root
        return np.asarray(root * profile.depth_slope(s) / profile.contact_radius(s))

    pieces = np.arange(edges.size - 1)
    ends = np.sqrt(edges[:-1] - base[:-1]), np.sqrt(edges[1:] - base[:-1])
    found = integrate(density, (pieces, *ends), _FINEST, rough=False).value
    above = np.append(np.cumsum(found[::-1])[::-1], 0.0)
    return np.asarray(rate * above[np.minimum(np.searchsorted(edges, at), edges.size - 1)])
