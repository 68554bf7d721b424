"""Results of the tangential foundation at every load point of a sequence of straight steps."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from mdr_core.history import dissipation, slip_memory
from mdr_core.history.slip_memory import FrontPath, LoadPoints, Polyline
from mdr_core.history.traction_vertices import TractionVertices
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array, Indices

# Steps evaluated at once: bounds the memory, and keeps their arrays in the processor's cache.
_BLOCK: Final = 16_384
# Slip regimes, in the order of their codes.
REGIMES: Final = ("no_contact", "stick", "partial_slip", "full_slip")

# Some of the steps, their vertices, the path of the slip front, and the polyline after them.
_Block = tuple[slice, TractionVertices, FrontPath, Polyline]


@dataclass(frozen=True)
class StepResults:
    """Results after each straight load step, in reduced units; each is computed on first use."""

    moments: IntervalMoments
    points: LoadPoints
    start: Polyline
    """Polyline before the first step."""

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) [length^2]."""
        return self._per_step(lambda part, _: part.tree.at_load_points(part.shear))

    @cached_property
    def displacement(self) -> Array:
        """G* u_x/(mu E*) [length], from zero on the axis."""
        return self._per_step(lambda part, _: part.tree.at_load_points(part.anchor))

    @cached_property
    def energy(self) -> Array:
        """Stored tangential energy over (mu E*)^2/G* [length^3], >= 0."""
        return self._per_step(lambda part, _: part.tree.at_load_points(part.square))

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated on each step over (mu E*)^2/G* [length^3], >= 0."""

        def dissipated(_part: TractionVertices, path: FrontPath) -> Array:
            segments = slip_memory.slip_segments(path)
            each = dissipation.per_segment(self.moments, segments)
            return np.asarray(np.bincount(segments.step, each, path.load.size), dtype=float)

        return self._per_step(dissipated)

    @cached_property
    def regime(self) -> Indices:
        """Index in `REGIMES` of the slip regime.

        Determined by the springs at their friction limit: none, the outermost, or all.
        """
        slips = 1 if self.moments.profile.has_no_partial_slip else 2

        def code(part: TractionVertices, _path: FrontPath) -> Indices:
            tree, top = part.tree, part.tree.top
            slipping = (tree.growth[top] == 0).any(axis=1)
            full = slipping & (tree.parent[tree.parent[top]] < 0)
            return np.where(top >= 0, np.where(full, 3, np.where(slipping, slips, 1)), 0)

        return self._per_step(code).astype(np.intp)

    @property
    def last(self) -> Polyline:
        """Polyline after the last step, over normal coordinates."""
        return self._end[-1]

    @property
    def last_vertices(self) -> tuple[TractionVertices, Indices]:
        """Vertices of the last block, and the indices of those of the last polyline."""
        part = self._end[1]
        indices, vertex = [], int(part.tree.top[-1])
        while vertex >= 0:
            indices.append(vertex)
            vertex = int(part.tree.parent[vertex])
        return part, np.array(indices[::-1], dtype=np.intp)

    @property
    def _blocks(self) -> Iterable[_Block]:
        """Blocks of steps: a single one is kept, many are computed again, to bound the memory."""
        return [self._end] if self.points.normal.size <= _BLOCK else self._solve_blocks()

    @cached_property
    def _end(self) -> _Block:
        return deque(self._solve_blocks(), maxlen=1)[0]

    def _solve_blocks(self) -> Iterator[_Block]:
        count, line = self.points.normal.size, self.start
        for begin in range(0, count, _BLOCK):
            chosen = slice(begin, begin + _BLOCK)
            points = LoadPoints._make(row[chosen] for row in self.points)
            tree, path, line = slip_memory.apply_steps(line, points)
            yield chosen, TractionVertices(self.moments, tree), path, line

    def _per_step(self, result: Callable[[TractionVertices, FrontPath], Any]) -> Array:
        """Return a result of every step, zero in blocks without contact."""
        values = np.zeros(self.points.normal.shape)
        for chosen, part, path, _ in self._blocks:
            if part.tree.normal.size:
                values[chosen] = result(part, path)
        return values
