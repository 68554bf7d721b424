"""Fast multipole sums of the kernel 1/sqrt(|x^2 - t^2|) over panels on one side of the points.

In the far field a block of 1, 2, 4, ... panels acts like a few masses: the kernel depends on x^2
alone and is interpolated there between nodes of the block. Each point uses the largest blocks that
are far from it, so that the cost grows like the logarithm of the number of panels.

Source: notes, §5.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.typing import Array, Indices

# Least distance of a block from the points in its far field, over its length, both in x^2.
FAR: Final = 0.5
# Mobius' map w(v) takes the block, 0 <= v <= 1, to |w| <= 1 and the places of such points,
# v <= -FAR or infinite, to |w| >= _BEYOND = 2 + sqrt(3).
_BEYOND: Final = 1 + 2 * FAR + 2 * np.sqrt(FAR + FAR * FAR)
_SHIFT: Final = (_BEYOND - 1) / 2
# Pairs of a block and a point that are processed at once: their arrays stay in cache.
_PAIRS: Final = 4096
# Replaces a distance of zero from a node.
_TINY: Final = 1e-290


@lru_cache(maxsize=4)
def _nodes(count: int) -> tuple[Array, Array, Array]:
    """Chebyshev points w, their barycentric weights, and their places v in a block.

    Interpolation errs by rho^-count of the part of a block, rho = _BEYOND + sqrt(_BEYOND^2 - 1) =
    7.3.
    """
    w = np.asarray(chebyshev.chebpts1(count), dtype=float)
    weights = np.sqrt((1 - w) * (1 + w)) * (-1.0) ** np.arange(count)
    return w, weights, _SHIFT * (1 + w) / (_BEYOND - w)


def at_nodes(v: Array, masses: Array, count: int) -> Array:
    """Return masses at the nodes of blocks (count, m) for masses (k, m) at positions v (k, 1 or m).

    v is the distance in x^2 from the end of the block that the points are nearer to, over the
    block's length.
    """
    points, weights, _ = _nodes(count)
    w = (_BEYOND * v - _SHIFT) / (v + _SHIFT)
    share = np.subtract(w, points[:, None, None])
    share += _TINY
    np.divide(weights[:, None, None], share, out=share)
    masses = masses / share.sum(axis=0)
    if v.shape[1] == 1:
        return np.asarray(share[:, :, 0] @ masses)
    return np.asarray(np.einsum("nkm,km->nm", share, masses))


@dataclass(frozen=True, eq=False)
class Multipoles:
    """Blocks of 1, 2, 4, ... panels, ordered by size and place."""

    edge: Array
    """End that the points are nearer to [length]."""
    length: Array
    """Length in x^2 [length^2]."""
    masses: Array
    """At the nodes, over the root of the length (blocks, nodes)."""
    first: Indices
    last: Indices
    """Panels first <= i < last."""
    parent: Indices
    """Block of twice the size that contains this one, -1 where there is none."""
    above: bool
    """True if the points lie above the panels."""

    def far_from(self, place: Array, first: int, last: int) -> tuple[Indices, Indices]:
        """Return the ranges low <= i < high of ascending points for which each block is masses.

        These points are far from the block but not from its parent.

        Parameters
        ----------
        place : points, ascending [length], shape (m,).
        first, last : of blocks that are not of the panels first <= i < last the range is empty.
        """
        other = (self.first < first) | (self.last > last)
        bound = self.edge * self.edge
        if self.above:
            index = np.searchsorted(place, np.sqrt(bound + FAR * self.length))
            index[other] = place.size
            index = np.append(index, place.size)
            return index[:-1], np.maximum(index[self.parent], index[:-1])
        bound -= FAR * self.length
        index = np.searchsorted(place, np.sqrt(np.maximum(bound, 0.0)), side="right")
        index[other | (bound < 0)] = 0
        index = np.append(index, 0)
        return np.minimum(index[self.parent], index[:-1]), index[:-1]

    def sums(self, base: Array, offset: Array | None, low: Indices, high: Indices) -> Array:
        """Return the sums over all blocks at the points of each block's range, shape (m,).

        Parameters
        ----------
        base, offset : points as a sum, ascending; the offset may be None [length], shape (m,).
        low, high : range of the points of each block, low <= i < high, shape (blocks,).
        """
        total = np.zeros_like(base)
        count = self.masses.shape[1]
        places = _nodes(count)[2]
        room, taken = np.empty((2, _PAIRS, count))
        ones = np.ones(count)
        for block, point in pairs(low, high):
            at, edge = base[point], self.edge[block]
            gap = at - edge
            if offset is not None:
                shift = offset[point]
                gap += shift
                at = at + shift
            gap *= at + edge
            np.abs(gap, out=gap)
            gap /= self.length[block]
            root = room[: block.size]
            np.add(gap[:, None], places, out=root)
            np.sqrt(root, out=root)
            # Without a mode, `take` would copy the rows once more.
            masses = self.masses.take(block, axis=0, out=taken[: block.size], mode="clip")
            np.divide(masses, root, out=root)
            add(total, point, root @ ones)
        return total


def pairs(low: Indices, high: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield all pairs of a block and a point of its range, block and point of each, in portions."""
    ends = np.cumsum(high - low)
    shift = high - ends
    total = int(ends[-1]) if ends.size else 0
    starts = np.arange(0, total, _PAIRS)
    firsts = np.searchsorted(ends, starts, side="right")
    lasts = np.searchsorted(ends, starts + (_PAIRS - 1), side="right")
    for start, first, last in zip(starts.tolist(), firsts.tolist(), lasts.tolist(), strict=True):
        counts = np.minimum(ends[first : last + 1] - start, _PAIRS)
        counts[1:] -= counts[:-1].copy()
        block = np.repeat(np.arange(first, first + counts.size), counts)
        yield block, np.arange(start, start + block.size) + shift[block]


def add(total: Array, point: Indices, values: Array) -> None:
    """Add the values of pairs, some of them at the same point, to the totals of their points."""
    # The pairs of a portion are mostly of neighbouring points.
    low, high = (
        (0, total.size) if total.size <= _PAIRS else (int(point.min()), int(point.max()) + 1)
    )
    total[low:high] += np.bincount(point - low, weights=values, minlength=high - low)


def multipoles(edges: Array, masses: Array, *, above: bool) -> Multipoles:
    """Return the blocks of panels between `edges` (k + 1) with masses at their nodes (nodes, k).

    If `above`, the points lie above the panels and the nodes count from the right ends.
    """
    counts, first, last, parent = _tree(edges.size - 1)
    low, high = edges[first], edges[last]
    length = (high - low) * (high + low)
    count = len(masses)
    places = _nodes(count)[2]
    total = np.empty((count, first.size))
    total[:, : counts[0]] = masses
    children = 0
    for size, joined in pairwise(counts):
        block = slice(children + size, children + size + joined)
        lower = total[:, children : children + 2 * joined : 2]
        upper = total[:, children + 1 : children + 2 * joined : 2]
        part = length[children : children + 2 * joined].reshape(joined, 2).T / length[block]
        near, far = (part[1], part[0]) if above else part
        v = np.concatenate([np.multiply.outer(places, near), near + np.multiply.outer(places, far)])
        both = np.concatenate([upper, lower] if above else [lower, upper])
        total[:, block] = at_nodes(v, both, count)
        children += size
    total /= np.sqrt(length)
    rows = np.ascontiguousarray(total.T)
    return Multipoles(high if above else low, length, rows, first, last, parent, above)


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
