"""The memory of a friction foundation: a polyline that every step of the load cuts and extends.

Springs are labelled by a level that grows from the axis to the contact's edge, and each remembers
an anchor, the shift at which it would be free. The pairs (level, anchor) form a polyline from the
axis to the present load point, and friction bounds its slopes by one. In the sums and differences

    forward = level + anchor,    backward = level - anchor

both numbers grow along the polyline and nowhere exceed those of the load point: whatever does
after a step slips back to them. So a step pops what exceeds, and pushes one straight piece.

Numbers are kept as unevaluated sums (high, low) of two doubles: load points and most corners are
exact copies of what was given, and differences keep their digits however small the swings are.
No name of mechanics is needed here: levels are depths where displacements are controlled, and
normal forces where forces are. Source: notes, §10.
"""

from dataclasses import dataclass
from math import fsum
from typing import NamedTuple

import numpy as np

from mdr_core.history import walk as walking
from mdr_core.lazy import cached_property
from mdr_core.typing import Array, Flags, Indices

# A step adds at most a touching point, a new bottom, a corner and the load point.
_VERTICES = 4
# What a step takes away it takes in pieces: two for each vertex popped, and the slide of all.
_PIECES = 10


class Chain(NamedTuple):
    """The polyline from the axis (first) to the load point (last); alone, a point in a gap."""

    forward: Array
    """level + anchor of each vertex, as rows of (high, low); shape (n, 2)."""
    backward: Array
    """level - anchor, likewise."""

    @property
    def point(self) -> tuple[float, float]:
        """Level and shift of the load point."""
        forward, backward = self.forward[-1].tolist(), self.backward[-1].tolist()
        # Summed exactly: the very numbers that were given.
        return fsum(forward + backward) / 2, fsum(forward + [-part for part in backward]) / 2


@dataclass(frozen=True)
class Tree:
    """All vertices that a walk has made; each knows the one below it."""

    parent: Indices
    """-1 on the axis, where both steps are one: there is no piece below, and its slope is zero."""
    forward: Array
    """level + anchor, as rows of (high, low)."""
    backward: Array
    forward_step: Array
    """Growth of `forward` from the parent, >= 0, with its own digits; zero if all slips back."""
    backward_step: Array
    top: Indices
    """Load point at the end of each step; -1 in a gap."""
    end: Chain

    @cached_property
    def level(self) -> Array:
        """Level of each vertex, >= 0."""
        return np.maximum(self.forward[:, 0] + self.backward[:, 0], 0.0) / 2

    @cached_property
    def length(self) -> Array:
        """Twice the level of each vertex above its parent's, with its own digits."""
        return self.forward_step + self.backward_step

    @cached_property
    def span(self) -> Array:
        """Level of each vertex above its parent's, with its own digits."""
        return self.length / 2

    @cached_property
    def slope(self) -> Array:
        """Slope of the anchor in the level below each vertex, from -1 to 1."""
        return (self.forward_step - self.backward_step) / self.length


class Pieces(NamedTuple):
    """What slipped, as pieces of the polyline that the slip front ran over."""

    step: Indices
    level: Array
    """Level at the piece's lower end."""
    span: Array
    """Length of the piece in the level."""
    slip: Array
    """Anchors' shift of all that slips while the front runs over the piece, > 0."""
    upper_gap: Array
    """From the front to the load point's level, as the front enters the piece from above."""
    lower_gap: Array
    """The same as it leaves."""
    everything: Flags
    """Where nothing sticks any more, the axis included."""


def walk(chain: Chain, level: Array, shift: Array, leg: Indices) -> Tree:
    """Return the vertices of the polyline after each of many straight steps.

    `level` and `shift` are the load points, one a step; steps with the same `leg` continue one
    straight line. Levels <= 0 are gaps, in which nothing is remembered.
    """
    return _walk(chain, level, shift, leg, record=False)[0]


def slips(chain: Chain, level: Array, shift: Array, leg: Indices) -> tuple[Tree, Pieces]:
    """Return the same, and what slipped on the way, in the order of the steps."""
    return _walk(chain, level, shift, leg, record=True)


def total(tree: Tree, increment: Array) -> Array:
    """Return for each vertex the sum of the increments from the axis up to it."""
    summed = np.empty_like(increment)
    walking.accumulate(tree.parent, increment, summed)
    return summed


def gap(level: float, shift: float) -> Chain:
    """Return the polyline where nothing touches: the load point alone, at a level <= 0."""
    ends = np.array([[level + shift], [level - shift]])
    lost = np.array([[shift - (ends[0, 0] - level)], [-shift - (ends[1, 0] - level)]])
    return Chain(*np.stack([ends, lost], axis=2))


def stacked(forward_step: Array, backward_step: Array) -> Chain:
    """Return the polyline from the axis whose pieces have the given steps, to their last digit."""
    return Chain(_sums(forward_step), _sums(backward_step))


def _sums(steps: Array) -> Array:
    """Running sums as rows of (high, low), by Knuth's two-sum."""
    rows = np.zeros((steps.size + 1, 2))
    high = low = 0.0
    for i, step in enumerate(steps.tolist(), start=1):
        total = high + step
        part = total - high
        low += (high - (total - part)) + (step - part)
        high = total
        rows[i] = high, low
    return rows


def as_tree(chain: Chain) -> Tree:
    """Return the polyline as a tree that never branched."""
    count = len(chain.forward)
    steps = [np.diff(part, axis=0).sum(axis=1) for part in chain]
    first = np.ones(1)
    return Tree(
        np.arange(count, dtype=np.intp) - 1,
        chain.forward,
        chain.backward,
        np.append(first, steps[0]),
        np.append(first, steps[1]),
        np.array([count - 1], dtype=np.intp),
        chain,
    )


def _walk(
    chain: Chain, level: Array, shift: Array, leg: Indices, *, record: bool
) -> tuple[Tree, Pieces]:
    held = len(chain.forward)
    room = held + _VERTICES * level.size
    # Rows as `walk` names them; what it makes it fills.
    vertices = np.empty((6, room))
    vertices[0:2, :held], vertices[2:4, :held] = chain.forward.T, chain.backward.T
    vertices[4:6, 0] = 1.0
    vertices[4, 1:held] = np.diff(chain.forward, axis=0).sum(axis=1)
    vertices[5, 1:held] = np.diff(chain.backward, axis=0).sum(axis=1)
    links = np.empty((2, room), dtype=np.intp)
    links[0, :held] = np.arange(held) - 1
    links[1, :held] = -1
    top = np.empty(level.size, dtype=np.intp)
    pieces = np.empty((5, 2 * held + _PIECES * level.size if record else 0))
    piece_step = np.empty(pieces.shape[1], dtype=np.intp)
    counts = np.array([held, 0], dtype=np.intp)
    walking.run(
        np.ascontiguousarray(level),
        np.ascontiguousarray(shift),
        np.ascontiguousarray(leg),
        vertices,
        links,
        top,
        pieces,
        piece_step,
        counts,
        *chain.point,
        record,
    )
    used, made = int(counts[0]), int(counts[1])
    last, parent = int(top[-1]), links[0, :used]
    end = gap(float(level[-1]), float(shift[-1])) if last < 0 else _live(vertices, parent, last)
    tree = Tree(
        parent,
        vertices[:2, :used].T,
        vertices[2:4, :used].T,
        vertices[4, :used],
        vertices[5, :used],
        top,
        end,
    )
    rows = pieces[:, :made]
    return tree, Pieces(piece_step[:made], rows[0], rows[1], rows[2], rows[3], rows[4], rows[0] < 0)


def _live(vertices: Array, parent: Indices, top: int) -> Chain:
    """The vertices from the axis to the load point."""
    rows = [top]
    while parent[rows[-1]] >= 0:
        rows.append(int(parent[rows[-1]]))
    rows.reverse()
    return Chain(vertices[:2, rows].T.copy(), vertices[2:4, rows].T.copy())
