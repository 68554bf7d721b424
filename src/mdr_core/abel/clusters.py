"""Sums of a root's kernel over neighbouring panels, at a cost that hardly grows with their number.

Wanted are int mu(dx) / sqrt(|x^2 - t^2|) over panels that all lie on one side of the points t.
Seen from afar, a block of panels is no more than a few masses: the kernel, a function of x^2 alone,
is interpolated there. Blocks are doubled as long as the point is far from them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
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
# Pairs of a block and a point handled at once: their roots stay in cache.
_PAIRS: Final = 2048


@lru_cache(maxsize=8)
def _interpolation(count: int) -> tuple[Array, Array]:
    """Nodes of a block of length one, and values at them to Chebyshev coefficients in w."""
    points = np.asarray(chebyshev.chebpts1(count), dtype=float)
    inverse: Array = np.linalg.inv(chebyshev.chebvander(points, count - 1))
    nodes = _SHIFT * (1 + points) / (_BEYOND - points)
    return nodes, inverse


def masses_at_nodes(v: Array, masses: Array, count: int) -> Array:
    """Replace masses at v (blocks, k) of blocks of length one by masses at their nodes."""
    w = (_BEYOND * v - _SHIFT) / (v + _SHIFT)
    before, now = np.ones_like(w), w
    moments = np.empty((v.shape[0], count))
    moments[:, 0] = masses.sum(axis=1)
    for degree in range(1, count):
        moments[:, degree] = np.einsum("bk,bk->b", masses, now)
        before, now = now, 2 * w * now - before
    return np.asarray(moments @ _interpolation(count)[1])


@dataclass(frozen=True, eq=False)
class Clusters:
    """Blocks of 1, 2, 4, ... panels, those of one size after those of the size before.

    `edge` is the end of a block that points are nearer to, `length` its length in x^2, `masses`
    (blocks, nodes) what stands for it; `first` and `last` are its panels, `parent` the block of
    twice the size that holds it, or -1.
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
        nodes, _ = _interpolation(count)
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
            root = room[: block.size]
            np.multiply(self.length[block, None], nodes, out=root)
            root += np.abs(gap)[:, None]
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


def clusters(edges: Array, masses: Array, *, above: bool) -> Clusters:
    """Gather panels between `edges` (k + 1), given their masses at their nodes (k, n), in blocks.

    `above`: the points lie above the panels, and the nodes count from each right end.
    """
    count = edges.size - 1
    size, level = 1, masses
    starts, all_masses, parents, done = [np.arange(count)], [masses], [], 0
    sizes = [np.ones(count, int)]
    while level.shape[0] > 1:
        whole = level.shape[0] // 2
        parent = done + level.shape[0] + np.arange(level.shape[0]) // 2
        parent[2 * whole :] = -1
        parents.append(parent)
        done += level.shape[0]
        level = _joined(edges, level[: 2 * whole], size, above=above)
        size *= 2
        starts.append(np.arange(whole) * size)
        sizes.append(np.full(whole, size))
        all_masses.append(level)
    parents.append(np.array([-1]))
    first = np.concatenate(starts)
    last = first + np.concatenate(sizes)
    low, high = edges[first], edges[last]
    return Clusters(
        high if above else low,
        (high - low) * (high + low),
        np.concatenate(all_masses),
        first,
        last,
        np.concatenate(parents),
        above,
    )


def _joined(edges: Array, masses: Array, size: int, *, above: bool) -> Array:
    """Masses of the blocks of 2 `size` panels from those of `size`."""
    blocks = masses.shape[0] // 2
    ends = edges[: 2 * blocks * size + 1 : size]
    low, middle, high = ends[:-1:2], ends[1::2], ends[2::2]
    lower, upper = (middle - low) * (middle + low), (high - middle) * (high + middle)
    near, far = (upper, lower) if above else (lower, upper)
    length = lower + upper
    part = masses.reshape(blocks, 2, -1)
    if above:
        part = part[:, ::-1]
    count = masses.shape[1]
    nodes, _ = _interpolation(count)
    v_near = np.multiply.outer(near / length, nodes)
    v_far = (near / length)[:, None] + np.multiply.outer(far / length, nodes)
    v = np.concatenate([v_near, v_far], axis=1)
    return masses_at_nodes(v, part.reshape(blocks, -1), count)
