"""A way that was followed: the vertices of the polyline, what slipped, and what is left of it.

Straight ways are walked in blocks by `memory`, those of mixed control leg by leg by `bent`.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil
from typing import Final

import numpy as np

from mdr_core.history import bent, dissipation, memory
from mdr_core.history.adaptive import Integral
from mdr_core.history.arc_branches import ArcBranches
from mdr_core.history.arc_loss import per_step
from mdr_core.history.arcs import Plane
from mdr_core.history.branches import Branches, last_break, mean
from mdr_core.history.memory import Chain, Tree
from mdr_core.history.path import Steps
from mdr_core.history.state import Pieces
from mdr_core.history.vertices import Points, Vertex, sum_of
from mdr_core.lazy import cached_property
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices

# Steps walked at once: bounds the memory, and keeps what is computed of them in cache.
_BLOCK: Final = 16_384
# Chords that stand for the arcs that are left at the end, for steps on from there; they miss an
# arc by an eighth of the square of their part of it.
_FEWEST: Final = 64
_MOST: Final = 1024
# The stress feels the slope of chords, which they miss by more.
_SLOPE: Final = 4.0
_EPS: Final = float(np.finfo(float).eps)
_TINY: Final = float(np.finfo(float).tiny)
# Roundings of a level that a point on an arc feels.
_ROUNDINGS: Final = 8.0


class Followed(ABC):
    """A way that was followed."""

    curved = False

    @abstractmethod
    def tops(self) -> Iterator[tuple[slice, Branches, Indices]]:
        """For each block in which something touches: samples, vertices, their load points."""

    @abstractmethod
    def lost(self) -> Array:
        """D/(mu E*) on the way to each sample [length^3]."""

    @abstractmethod
    def end(self) -> Chain:
        """The polyline over depths at the end; of a gap, the one of `tops`' levels."""

    def arcs(self) -> Pieces | None:
        """The polyline at the end with its arcs, if there are any."""
        return None

    @property
    def deviation(self) -> float:
        """How much the answers may miss for the curves, relative."""
        return 0.0

    @property
    def chord(self) -> float:
        """How much `end` misses, relative to the largest load of a spring."""
        return 0.0


@dataclass(frozen=True)
class Straight(Followed):
    """Straight steps, one to each sample."""

    profile: Profile
    by_force: bool
    chain: Chain
    """The polyline before the first."""
    steps: Steps

    def tops(self) -> Iterator[tuple[slice, Branches, Indices]]:
        """For each block in which something touches: samples, vertices, their load points."""
        chain = self.chain
        for part, walked in self._blocks():
            tree = memory.walk(chain, *walked)
            chain = tree.end
            if tree.level.size:
                yield part, Branches(self.profile, tree, self.by_force), tree.top

    def lost(self) -> Array:
        """D/(mu E*) on the way to each sample [length^3]."""
        lost, chain = np.zeros(self.steps.level.shape), self.chain
        for part, walked in self._blocks():
            tree, found = memory.slips(chain, *walked)
            chain = tree.end
            each = dissipation.per_piece(self.profile, found, by_force=self.by_force)
            np.add.at(lost, found.step + part.start, each)
        return lost

    def end(self) -> Chain:
        """The polyline over depths at the end; of a gap, over levels."""
        chain = self.chain
        for _, walked in self._blocks():
            chain = memory.walk(chain, *walked).end
        if self.by_force and len(chain.forward) > 1:
            part = Branches(self.profile, memory.as_tree(chain), by_force=True)
            # As a polyline over depths, with the digits of its pieces.
            span, slope = part.depth_step[1:], part.tree.slope[1:]
            return memory.stacked(span * (1 + slope), span * (1 - slope))
        return chain

    def _blocks(self) -> Iterator[tuple[slice, tuple[Array, Array, Flags]]]:
        """Blocks of steps: their place, levels, shifts and which go on."""
        steps = self.steps
        for begin in range(0, steps.level.size, _BLOCK):
            part = slice(begin, begin + _BLOCK)
            yield part, (steps.level[part], steps.shift[part], steps.goes_on[part])


@dataclass(frozen=True)
class Arcs(Followed):
    """Legs of mixed control, from bodies that just touch."""

    profile: Profile
    by_force: bool
    points: Points
    last: Indices
    """Which of the points are samples."""
    rtol: float
    curved = True

    @property
    def _plane(self) -> Plane:
        return Plane(self.profile, self.by_force)

    @cached_property
    def _walked(self) -> tuple[bent.Walk, Indices]:
        walk = bent.Walk(self._plane, self.points)
        return walk, walk.run()

    @cached_property
    def _branches(self) -> ArcBranches:
        walk, tops = self._walked
        tree = Tree(
            np.array(walk.parent, dtype=np.intp),
            np.array(walk.level),
            np.array(walk.growth).ravel(),
            tops[self.last],
            self._levels,
        )
        columns = np.array(walk.coordinate), np.array(walk.rate)
        return ArcBranches(self.profile, tree, self.by_force, self.rtol, *columns)

    @property
    def _levels(self) -> Chain:
        """The vertices of the polyline at the end, over levels."""
        stack = self._walked[0].stack
        if not stack:
            return memory.gap(float(self.points.level[-1]), float(self.points.shift[-1]))
        rows = [np.array([vertex.sums[own] for vertex in stack]) for own in (0, 1)]
        return Chain(rows[0], rows[1])

    def tops(self) -> Iterator[tuple[slice, Branches, Indices]]:
        """The samples in one block, if something ever touches."""
        if self._walked[0].level:
            yield slice(0, self.last.size), self._branches, self._branches.tree.top

    @cached_property
    def _loss(self) -> Integral:
        found = per_step(self._plane, self.points, self._walked[0].slips, self.rtol)
        begin = np.append(-1, self.last[:-1]) + 1
        return Integral(*(np.add.reduceat(part, begin) for part in found))

    def lost(self) -> Array:
        """D/(mu E*) on the way to each sample [length^3]."""
        return self._loss.value

    @property
    def deviation(self) -> float:
        """How much the integrals may miss, and what a point on an arc feels of roundings."""
        walk, _ = self._walked
        if not walk.level:
            return 0.0
        lost = self._loss
        missing = max(
            float(most(lost.missing) / max(most(lost.value), _TINY)) for most in (np.sum, np.max)
        )
        moved = float(np.max(np.abs(self.points.shift), initial=0.0))
        highest = float(np.max(self.points.level))
        felt = _ROUNDINGS * _EPS * highest / moved if moved > 0 else 0.0
        return max(missing, self._branches.missing) + felt

    def arcs(self) -> Pieces | None:
        """The polyline at the end with its arcs, if there are any."""
        numbers = np.array([vertex.number for vertex in self._walked[0].stack], dtype=np.intp)
        if numbers.size < 2:
            return None
        part, own = self._branches, numbers[1:]
        rate = np.zeros(part.tree.level.shape)
        rate[part.arcs] = part.rate
        if not rate[own].any():
            return None
        above = np.append(np.cumsum(part.anchor_step[own][::-1])[::-1], 0.0)
        columns = part.coordinate[numbers], part.width[own], part.tree.slope[own]
        return Pieces(*columns, above, rate[own], by_force=self.by_force)

    def end(self) -> Chain:
        """The polyline over depths at the end, with chords for arcs; of a gap, over levels."""
        return self._end[0]

    @property
    def chord(self) -> float:
        """How much the chords of `end` miss, relative to the largest load of a spring."""
        return self._end[1]

    @cached_property
    def _end(self) -> tuple[Chain, float]:
        stack = self._walked[0].stack
        if len(stack) < 2:
            return self._levels, 0.0
        steps, missed = self._steps([vertex.number for vertex in stack[1:]])
        span, anchor = np.concatenate(steps, axis=1)
        rise = np.cumsum(anchor)
        largest = float(np.max(np.abs(rise[-1] - np.append(0.0, rise))))
        # Over depths the vertices are known to more digits than their steps add up to.
        chain = memory.stacked(*_growths(span, anchor)) if self.by_force else _joined(stack, steps)
        return chain, _SLOPE * missed / largest if largest > 0 else 0.0

    def _steps(self, numbers: list[int]) -> tuple[list[Array], float]:
        """Depth and anchor from each vertex to the next, in chords on arcs; what they miss."""
        part = self._branches
        arcs = {int(number): at for at, number in enumerate(part.arcs)}
        wide = sum(self._width(number) for number in numbers if number in arcs)
        steps, missed = [], 0.0
        for number in numbers:
            span, slope = float(part.depth_step[number]), float(part.tree.slope[number])
            if number not in arcs:
                steps.append(np.array([[span], [span * slope]]))
                continue
            count = max(_FEWEST, ceil(self._chords * self._width(number) / wide))
            found, miss = self._in_chords(number, float(part.rate[arcs[number]]), count)
            steps.append(found)
            missed = max(missed, miss)
        return steps, missed

    @property
    def _chords(self) -> int:
        """How many chords miss the arcs by the tolerance; no more than can be paid for."""
        return int(min(max((8 * self.rtol) ** -0.5, _FEWEST), _MOST))

    def _width(self, number: int) -> float:
        part = self._branches
        return float(part.coordinate[number] - part.coordinate[part.tree.parent[number]])

    def _in_chords(self, number: int, rate: float, count: int) -> tuple[Array, float]:
        """Steps of depth and anchor of the chords of an arc, and how far they miss it at most."""
        part, profile = self._branches, self.profile
        end, start = part.coordinate[number], part.coordinate[part.tree.parent[number]]
        s = start + (end - start) * np.arange(2 * count + 1) / (2 * count)
        s[-1] = end
        depth = np.diff(profile.depth(s))
        if self.by_force:
            span = np.diff(s)
            base = last_break(profile.coordinate_breaks, s[:-1])
            steep = mean(lambda _, at: part.steep(at), s[:-1], span, base)
            anchor = rate * span * steep
        else:
            anchor = rate * np.diff(profile.reduced_force(s))
        halves = np.stack([depth, anchor]).reshape(2, count, 2)
        whole = halves.sum(axis=2)
        chosen = whole[0] > 0
        slope = whole[1][chosen] / whole[0][chosen]
        miss = np.abs(halves[1, chosen, 0] - slope * halves[0, chosen, 0])
        return whole[:, chosen], float(miss.max(initial=0.0))


def _growths(span: Array, anchor: Array) -> tuple[Array, Array]:
    """What steps of depth and anchor add to both sums."""
    return np.maximum(span + anchor, 0.0), np.maximum(span - anchor, 0.0)


def _joined(stack: list[Vertex], steps: list[Array]) -> Chain:
    """The polyline through the vertices, of which each is reached in some steps."""
    rows = [np.array([stack[0].sums])]
    for vertex, step in zip(stack[1:], steps, strict=True):
        if step.shape[1] > 1:
            between = memory.stacked(*_growths(*step[:, :-1]))
            rows.append(_above(rows[-1][-1], between))
        rows.append(np.array([vertex.sums]))
    forward, backward = np.concatenate(rows).swapaxes(0, 1)
    return Chain(forward, backward)


def _above(low: Array, chords: Chain) -> Array:
    """Both sums of the ends of chords above a vertex with the sums `low`, (chords, 2, 2)."""
    found = np.stack([part[1:] for part in chords], axis=1)
    for row in found:
        for own in (0, 1):
            total, lost = sum_of(low[own, 0], row[own, 0])
            row[own] = total, lost + low[own, 1] + row[own, 1]
    return found
