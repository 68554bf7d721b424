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

from mdr_core.history import slots
from mdr_core.history import walk as walking
from mdr_core.lazy import cached_property
from mdr_core.typing import Array, Flags, Indices

# A step adds at most a touching point, a corner and the load point.
_VERTICES = 3
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
    """-1 on the axis, where both steps are the same: there is no piece below."""
    level: Array
    """Level of each vertex, >= 0."""
    growth: Array
    """Growth of `forward` and of `backward` from the parent, >= 0, with its own digits; zero if
    all slips back. In turn: shape (2 n,)."""
    top: Indices
    """Load point at the end of each step; -1 in a gap."""
    end: Chain

    @property
    def forward_step(self) -> Array:
        """Growth of `forward` from the parent."""
        return self.growth[::2]

    @property
    def backward_step(self) -> Array:
        """Growth of `backward` from the parent."""
        return self.growth[1::2]

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


def walk(chain: Chain, level: Array, shift: Array, goes_on: Flags) -> Tree:
    """Return the vertices of the polyline after each of many straight steps.

    `level` and `shift` are the load points, one a step; steps that go on continue the straight
    line of the one before. Levels <= 0 are gaps, in which nothing is remembered.
    """
    return _walk(chain, level, shift, goes_on, record=False)[0]


def slips(chain: Chain, level: Array, shift: Array, goes_on: Flags) -> tuple[Tree, Pieces]:
    """Return the same, and what slipped on the way, in the order of the steps."""
    return _walk(chain, level, shift, goes_on, record=True)


def total(tree: Tree, rise: Array) -> Array:
    """Return for each vertex the sum of slope x rise from the axis up to it."""
    summed = np.empty(rise.shape)
    walking.accumulate(tree.parent, tree.growth, rise, summed)
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
    sums = chain.forward + chain.backward
    return Tree(
        np.arange(count, dtype=np.intp) - 1,
        np.maximum(sums[:, 0] + sums[:, 1], 0.0) / 2,
        _growth(chain).ravel(),
        np.array([count - 1], dtype=np.intp),
        chain,
    )


def _growth(chain: Chain) -> Array:
    """What both sums of each vertex exceed those of the one below by; one on the axis."""
    growth = np.ones((len(chain.forward), 2))
    for row, part in enumerate(chain):
        growth[1:, row] = np.diff(part, axis=0).sum(axis=1)
    return growth


def _walk(
    chain: Chain, level: Array, shift: Array, goes_on: Flags, *, record: bool
) -> tuple[Tree, Pieces]:
    held = len(chain.forward) if chain.point[0] > 0 else 0
    room = held + _VERTICES * level.size
    vertices, growth, parent = np.empty(room), np.empty(2 * room), np.empty(room, dtype=np.intp)
    pieces = np.empty((5, 2 * held + _PIECES * level.size if record else 0))
    piece_step = np.empty(pieces.shape[1], dtype=np.intp)
    # Each vertex on its place as `slots` names them.
    stack, marks = np.empty((slots.AXIS + room, 8)), np.empty((slots.AXIS + room, 2), dtype=np.intp)
    marks[slots.MIRROR, slots.NUMBER] = -1
    marks[slots.AXIS, slots.STILL] = slots.FORWARD
    stack[slots.MIRROR] = 0.0
    if held:
        own = slice(slots.AXIS, slots.AXIS + held)
        made = as_tree(chain)
        steps = made.growth.reshape(held, 2)
        stack[own, 0:4:2], stack[own, 1:4:2] = chain.forward, chain.backward
        stack[own, slots.GROWTH : slots.GROWTH + 2] = steps
        marks[own, slots.NUMBER] = np.arange(held)
        marks[own, slots.STILL] = np.where(
            steps[:, 1] == 0,
            slots.BACKWARD,
            np.where(steps[:, 0] == 0, slots.FORWARD, slots.NEITHER),
        )
        marks[slots.AXIS, slots.STILL] = slots.FORWARD
        vertices[:held], growth[: 2 * held], parent[:held] = made.level, made.growth, made.parent
    walker = walking.Walk(
        stack.ravel(),
        marks.ravel(),
        slots.MIRROR + held,
        held,
        vertices,
        growth,
        parent,
        pieces,
        piece_step,
    )
    top = np.empty(level.size, dtype=np.intp)
    walker.run(
        np.ascontiguousarray(level),
        np.ascontiguousarray(shift),
        goes_on.view(np.uint8),
        top,
        *chain.point,
        record,
    )
    used, made_pieces = walker.made, walker.noted
    end = gap(float(level[-1]), float(shift[-1]))
    if top[-1] >= 0:
        own = slice(slots.AXIS, walker.top + 1)
        end = Chain(stack[own, 0:4:2].copy(), stack[own, 1:4:2].copy())
    tree = Tree(parent[:used], vertices[:used], growth[: 2 * used], top, end)
    rows = pieces[:, :made_pieces]
    return tree, Pieces(
        piece_step[:made_pieces], rows[0], rows[1], rows[2], rows[3], rows[4], rows[0] < 0
    )
