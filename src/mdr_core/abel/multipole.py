"""Fast multipole sums of the kernel 1/sqrt(|x^2 - t^2|) over panels on one side of the points.

In the far field of a block of 1, 2, 4, ... panels their sum depends on x^2 alone: it is a
polynomial over a root. Each point uses the largest blocks that are far from it, so that the cost
grows like the logarithm of the number of panels.

Source: notes, §5.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Final

import numpy as np

from mdr_core.abel.interpolation import fit_points
from mdr_core.cached import cached_property
from mdr_core.typing import Array, Indices

# Least distance of a block from the points in its far field, over its length, both in x^2.
FAR: Final = 0.5
# The gap of a point, in x^2 over the length of a block, is FAR <= g <= inf in the far field, and
# -1 <= g <= 0 in the block. Mobius' map u(g) = (g - FAR)/(g + _POLE) takes the former to [0, 1] and
# the latter to |2 u - 1| >= 2 + sqrt(3), as far from it as possible.
_POLE: Final = float(np.sqrt(FAR + FAR * FAR)) - FAR
# Pairs of a block and a point that are processed at once: their arrays stay in cache.
_PAIRS: Final = 8192


@lru_cache(maxsize=4)
def _gaps(count: int) -> Array:
    """Gaps at which the sum of a block is fitted."""
    u = fit_points(count)[0]
    return np.asarray((FAR + _POLE * u) / (1 - u))


def _powers(sums: Array) -> Array:
    """Coefficients of the powers of u, from the highest on, for sums at the gaps (count, blocks).

    The sums times sqrt(g + _POLE) are analytic in u up to the block. With Y = 2 + sqrt(3), `count`
    powers leave rho^-count of the part of a block, rho = Y + sqrt(Y^2 - 1) = 7.3. As rho exceeds
    3 + sqrt(8), their coefficients fall, and the sum of the powers is stable.
    """
    root = np.sqrt(_gaps(len(sums)) + _POLE)
    _, to_chebyshev, powers = fit_points(len(sums))
    return np.asarray((powers.T @ (to_chebyshev @ (sums * root[:, None])))[::-1])


def _sum_at(rows: Iterable[Array], gap: Array) -> Array:
    """Sum of a block at its far points, by the coefficients of the powers of u."""
    above = gap + _POLE
    u = (gap - FAR) / above
    total = np.zeros_like(u)
    for row in rows:
        total *= u
        total += row
    total /= np.sqrt(above, out=above)
    return total


def panel_sums(v: Array, masses: Array, count: int) -> Array:
    """Return the sums of masses (k, m) in panels of unit length at `count` far points (count, m).

    v is the distance of the masses from the end of the panel that the points are nearer to, in x^2
    over the panel's length, shape (k, 1 or m).
    """
    root = np.sqrt(_gaps(count)[:, None, None] + v)
    if v.shape[1] == 1:
        return np.asarray((1 / root[:, :, 0]) @ masses)
    return np.asarray((masses / root).sum(axis=1))


@dataclass(frozen=True, eq=False)
class Multipoles:
    """Blocks of 1, 2, 4, ... panels, ordered by size and place."""

    edge: Array
    """End that the points are nearer to [length]."""
    length: Array
    """Length in x^2 [length^2]."""
    powers: Array
    """Coefficients of the powers of u, from the highest on (count, blocks)."""
    first: Indices
    last: Indices
    """Panels first <= i < last."""
    parent: Indices
    """Block of twice the size that contains this one, -1 where there is none."""
    above: bool
    """True if the points lie above the panels."""

    def far_from(self, place: Array, first: int, last: int) -> tuple[Indices, Indices]:
        """Return the ranges low <= i < high of the points that use each block.

        They are far from the block but not from its parent.

        Parameters
        ----------
        place : points, ascending [length], shape (m,).
        first, last : of blocks that are not of the panels first <= i < last the range is empty.
        """
        index = place.searchsorted(self._reach, side="left" if self.above else "right")
        own = index[:-1]
        own[(self.first < first) | (self.last > last)] = place.size if self.above else 0
        of_parent = index[self.parent]
        if self.above:
            return own, np.maximum(of_parent, own)
        return np.minimum(of_parent, own), own

    @cached_property
    def _reach(self) -> Array:
        """Place from which, or up to which, points are far from each block [length].

        No point is far from a block next to the axis, nor from a parent that does not exist, the
        last one.
        """
        if self.above:
            return np.append(np.sqrt(self.edge * self.edge + FAR * self.length), np.inf)
        square = np.append(self.edge * self.edge - FAR * self.length, -1.0)
        return np.where(square < 0, -1.0, np.sqrt(np.maximum(square, 0.0)))

    def sums(self, base: Array, offset: Array | None, low: Indices, high: Indices) -> Array:
        """Return the sums over all blocks at the points of each block's range, shape (m,).

        Parameters
        ----------
        base, offset : points as a sum, ascending; the offset may be None [length], shape (m,).
        low, high : range of the points of each block, low <= i < high, shape (blocks,).
        """
        total = np.zeros_like(base)
        for blocks, counts, point in pairs(low, high):
            at, edge = base[point], self.edge[blocks].repeat(counts)
            gap = at - edge
            if offset is not None:
                shift = offset[point]
                gap += shift
                at = at + shift
            gap *= at + edge
            np.abs(gap, out=gap)
            gap /= self.length[blocks].repeat(counts)
            powers = (row.repeat(counts) for row in self.powers[:, blocks])
            add(total, point, _sum_at(powers, gap))
        return total


def pairs(low: Indices, high: Indices) -> Iterator[tuple[slice, Indices, Indices]]:
    """Yield all pairs of a block and a point of its range in portions.

    Each portion is a slice of blocks, the number of points of each, and the points (pairs,).
    """
    ends = (high - low).cumsum()
    shift = high - ends
    total = int(ends[-1]) if ends.size else 0
    starts = np.arange(0, total, _PAIRS)
    firsts = np.searchsorted(ends, starts, side="right")
    lasts = np.searchsorted(ends, starts + (_PAIRS - 1), side="right")
    for start, first, last in zip(starts.tolist(), firsts.tolist(), lasts.tolist(), strict=True):
        counts = np.minimum(ends[first : last + 1] - start, _PAIRS)
        counts[1:] -= counts[:-1].copy()
        blocks = slice(first, first + counts.size)
        point = shift[blocks].repeat(counts)
        yield blocks, counts, point + np.arange(start, start + point.size)


def add(total: Array, point: Indices, values: Array) -> None:
    """Add the values of pairs, some of them at the same point, to the totals of their points."""
    # The pairs of a portion are mostly of neighbouring points.
    low, high = (
        (0, total.size) if total.size <= _PAIRS else (int(point.min()), int(point.max()) + 1)
    )
    total[low:high] += np.bincount(point - low, weights=values, minlength=high - low)


def multipoles(edges: Array, sums: Array, *, above: bool) -> Multipoles:
    """Return the blocks of panels between `edges` (k + 1) with `panel_sums` (count, k).

    If `above`, the points lie above the panels, which count from their right ends.
    """
    counts, first, last, parent = _tree(edges.size - 1)
    low, high = edges[first], edges[last]
    length = (high - low) * (high + low)
    gaps = _gaps(len(sums))
    powers = np.empty((len(sums), first.size))
    powers[:, : counts[0]] = _powers(sums / np.sqrt(length[: counts[0]]))
    near, far = int(above), 1 - int(above)
    children = 0
    for size, joined in pairwise(counts):
        pair = slice(children, children + 2 * joined)
        block = slice(children + size, children + size + joined)
        gap = np.multiply.outer(gaps, np.repeat(length[block], 2))
        gap[:, far::2] += length[pair][near::2]
        sums = _sum_at(powers[:, pair], gap / length[pair])
        powers[:, block] = _powers(sums[:, ::2] + sums[:, 1::2])
        children += size
    return Multipoles(high if above else low, length, powers, first, last, parent, above)


@lru_cache(maxsize=4)
def _tree(panels: int) -> tuple[list[int], Indices, Indices, Indices]:
    """Number of blocks of each size; the panels and the parent of each block."""
    counts = [panels]
    while counts[-1] > 1:
        counts.append(counts[-1] // 2)
    begin = np.concatenate([[0], np.cumsum(counts)])
    level = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(level.size) - begin[level]
    # The last of an odd number of blocks has no parent, nor has the largest.
    parent = begin[level + 1] + number // 2
    parent[parent >= np.append(begin[2:], 0)[level]] = -1
    return counts, number << level, (number + 1) << level, parent
