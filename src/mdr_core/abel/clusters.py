"""Sums of a root's kernel over neighbouring panels, at a cost that hardly grows with their number.

Wanted are int mu(dx) / sqrt(|x^2 - t^2|) over panels that all lie on one side of the points t.
Seen from afar, a block of panels is no more than a few masses: the kernel, a function of x^2 alone,
is interpolated there. Blocks are doubled as long as the point is far from them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, log
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.typing import Array, Flags, Indices

# A block is far from a point that is this many of its lengths away, measured in x^2.
FAR: Final = 0.5
# Mobius' map takes the block, 0 <= v <= 1, to |w| <= 1, and all places where points may be,
# v <= -FAR or infinite, to |w| >= 1/k = 2 + sqrt(3): interpolation in w errs by 7.3^-nodes.
_BEYOND: Final = 1 + 2 * FAR + 2 * np.sqrt(FAR + FAR * FAR)
_SHIFT: Final = (_BEYOND - 1) / 2
_ERROR: Final = 7.3
# Pairs of a block and a point handled at once: their roots stay in cache.
_PAIRS: Final = 4096
# Blocks whose interpolation is at hand at once.
_BLOCKS: Final = 512
# Added to a distance from a node, which may be none at all.
_TOUCHING: Final = 1e-290


def nodes_for(accuracy: float) -> int:
    """How many nodes of a block keep what it gives to a tenth of this accuracy, and better."""
    return ceil(log(1 / accuracy) / log(_ERROR))


@lru_cache(maxsize=16)
def _interpolation(count: int) -> tuple[Array, Array, Array]:
    """Nodes of a block of length one, the same in w, and their barycentric weights."""
    points = np.asarray(chebyshev.chebpts1(count), dtype=float)
    weights = np.sqrt((1 - points) * (1 + points)) * (-1.0) ** np.arange(count)
    nodes = _SHIFT * (1 + points) / (_BEYOND - points)
    return nodes, points, weights


def _shares(v: Array, count: int) -> tuple[Array, Array]:
    """How masses at v of blocks of length one are shared among the nodes.

    Barycentric: shares of shape (nodes, *v), to be divided by their sum, shape of v.
    """
    _, points, weights = _interpolation(count)
    w = (_BEYOND * v - _SHIFT) / (v + _SHIFT)
    share = np.subtract(w, points[:, None, None])
    share += _TOUCHING
    np.divide(weights[:, None, None], share, out=share)
    return share, share.sum(axis=0)


def masses_at_nodes(v: Array, masses: Array, count: int) -> Array:
    """Replace masses at v (blocks, k) of blocks of length one by masses at their nodes."""
    result = np.empty((v.shape[0], count))
    for start in range(0, v.shape[0], _BLOCKS):
        part = slice(start, start + _BLOCKS)
        # Of all the arrays the blocks are the last axis, which is the longest.
        shares = _shares(np.ascontiguousarray(v[part].T), count)
        result[part] = _shared(masses[part].T, *shares).T
    return result


def _shared(masses: Array, shares: Array, total: Array) -> Array:
    """Masses (k, blocks) at the nodes (nodes, blocks)."""
    return np.asarray((shares * (masses / total)).sum(axis=1))


@dataclass(frozen=True, eq=False)
class Clusters:
    """Blocks of 1, 2, 4, ... panels, those of one size after those of the size before.

    `edge` is the end of a block that points are nearer to, `length` its length in x^2, `masses`
    (blocks, nodes) what stands for it, over the root of the length; `first` and `last` are its
    panels, `parent` the block of twice the size that holds it, or -1.
    """

    edge: Array
    length: Array
    masses: Array
    first: Indices
    last: Indices
    parent: Indices
    above: bool
    """Whether the points lie above the panels."""

    def usable(self, first: int, last: int) -> Flags:
        """Blocks of panels first <= i < last."""
        return np.asarray((self.first >= first) & (self.last <= last))

    def far_from(self, place: Array, usable: Flags) -> tuple[Indices, Indices]:
        """Ranges of the points, in ascending order, that see each block, but not its parent."""
        bound = self.edge * self.edge
        if self.above:
            index = np.searchsorted(place, np.sqrt(bound + FAR * self.length))
            index[~usable] = place.size
            index = np.append(index, place.size)
            return index[:-1], np.maximum(index[self.parent], index[:-1])
        bound -= FAR * self.length
        index = np.searchsorted(place, np.sqrt(np.maximum(bound, 0.0)), side="right")
        index[~usable | (bound < 0)] = 0
        index = np.append(index, 0)
        return np.minimum(index[self.parent], index[:-1]), index[:-1]

    def sums(self, base: Array, offset: Array | None, low: Indices, high: Indices) -> Array:
        """Sum of int mu(dx)/sqrt(|x^2 - t^2|) over each block and its range of points."""
        total = np.zeros_like(base)
        count = self.masses.shape[1]
        nodes = _interpolation(count)[0]
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
            np.add(gap[:, None], nodes, out=root)
            np.sqrt(root, out=root)
            # Without a mode the rows would be copied once more.
            masses = self.masses.take(block, axis=0, out=taken[: block.size], mode="clip")
            np.divide(masses, root, out=root)
            add(total, point, root @ ones)
        return total


def pairs(low: Indices, high: Indices) -> Iterator[tuple[Indices, Indices]]:
    """All pairs of a block and a point of its range, in portions: block and point of each."""
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
    if total.size <= _PAIRS:
        total += np.bincount(point, weights=values, minlength=total.size)
        return
    # The pairs of a portion are mostly of neighbouring points.
    low, high = int(point.min()), int(point.max()) + 1
    total[low:high] += np.bincount(point - low, weights=values)


@lru_cache(maxsize=4)
def _blocks(panels: int) -> tuple[list[int], Indices, Indices, Indices]:
    """How many blocks there are of each size, the panels of each, and the block that holds it."""
    counts = [panels]
    while counts[-1] > 1:
        counts.append(counts[-1] // 2)
    begin = np.concatenate([[0], np.cumsum(counts)])
    level = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(level.size) - begin[level]
    first = number << level
    last = (number + 1) << level
    # Of an odd number of blocks the last one has no parent, nor has the largest.
    parent = begin[level + 1] + number // 2
    alone = np.append(begin[2:], 0)[level] <= parent
    parent[alone] = -1
    return counts, first, last, parent


def clusters(edges: Array, masses: Array, *, above: bool) -> Clusters:
    """Gather panels between `edges` (k + 1), given their masses at their nodes (k, n), in blocks.

    `above`: the points lie above the panels, and the nodes count from each right end.
    """
    counts, first, last, parent = _blocks(edges.size - 1)
    low, high = edges[first], edges[last]
    length = (high - low) * (high + low)
    joined = slice(counts[0], None)
    middle = edges[(first + last)[joined] // 2]
    v = _places_in_pairs(low[joined], middle, high[joined], masses.shape[1], above=above)
    total = np.empty((masses.shape[1], first.size))
    total[:, : counts[0]] = masses.T
    _gather(total, v, counts, above=above)
    total /= np.sqrt(length)
    rows = np.ascontiguousarray(total.T)
    return Clusters(high if above else low, length, rows, first, last, parent, above)


def _places_in_pairs(low: Array, middle: Array, high: Array, count: int, *, above: bool) -> Array:
    """Where the nodes of two neighbouring blocks lie in the block of both, the near one first."""
    lower, upper = (middle - low) * (middle + low), (high - middle) * (high + middle)
    length = lower + upper
    near = (upper if above else lower) / length
    nodes = _interpolation(count)[0]
    v = np.empty((2 * count, near.size))
    np.multiply.outer(nodes, near, out=v[:count])
    np.multiply.outer(nodes, (lower if above else upper) / length, out=v[count:])
    v[count:] += near
    return v


def _gather(total: Array, v: Array, counts: list[int], *, above: bool) -> None:
    """Fill in the masses of joined blocks, size after size, from those of the panels."""
    count, done, before = total.shape[0], 0, 0
    known: tuple[Array, Array] | None = None
    start = 0
    for size, whole in pairwise(counts):
        two = total[:, before : before + 2 * whole]
        lower, upper = two[:, ::2], two[:, 1::2]
        rows = np.concatenate([upper, lower] if above else [lower, upper])
        before += size
        here = slice(before, before + whole)
        if whole > _BLOCKS:
            places = v[:, done : done + whole]
            total[:, here] = masses_at_nodes(places.T, rows.T, count).T
        else:
            # All smaller numbers of blocks together are no more than twice this one.
            if known is None:
                known, start = _shares(v[:, done:], count), done
            part = slice(done - start, done - start + whole)
            total[:, here] = _shared(rows, known[0][..., part], known[1][:, part])
        done += whole
