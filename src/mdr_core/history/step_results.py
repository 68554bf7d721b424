"""Results of the tangential foundation at every load point of a sequence of straight steps."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mdr_core.cached import cached_property
from mdr_core.history import slip_memory
from mdr_core.history.dissipation import Dissipation
from mdr_core.history.slip_memory import FrontPath, LoadPoints, Polyline, VertexTree
from mdr_core.history.traction_vertices import TractionVertices
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array, Indices

# Steps evaluated at once: bounds the memory, and keeps their arrays in the processor's cache.
_BLOCK: Final = 16_384
# Slip regimes, in the order of their codes.
REGIMES: Final = ("no_contact", "stick", "partial_slip", "full_slip")


@dataclass(frozen=True)
class _Block:
    """Some of the steps, and the polyline after them."""

    moments: IntervalMoments
    steps: slice
    tree: VertexTree
    path: FrontPath
    line: Polyline

    @cached_property
    def vertices(self) -> TractionVertices:
        """Vertices of the polylines."""
        coordinate = self._coordinates[: self.tree.normal.size]
        return TractionVertices(self.moments, self.tree, coordinate)

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated on each step over (mu E*)^2/G* [length^3], >= 0."""
        coordinate = self._coordinates[self.tree.normal.size :]
        return self._slip.per_step(coordinate.reshape(4, -1))

    @cached_property
    def _slip(self) -> Dissipation:
        return Dissipation(self.moments, self.path)

    @cached_property
    def _coordinates(self) -> Array:
        """Contact coordinates of the vertices and of the ends of the slip intervals.

        An inversion of both takes hardly longer than one of a part.
        """
        return self.moments.contact_coordinate(np.append(self.tree.normal, self._slip.ends))


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
        return self._per_step(lambda block: block.tree.at_load_points(block.vertices.shear))

    @cached_property
    def displacement(self) -> Array:
        """G* u_x/(mu E*) [length], from zero on the axis."""
        return self._per_step(lambda block: block.tree.at_load_points(block.vertices.anchor))

    @cached_property
    def energy(self) -> Array:
        """Stored tangential energy over (mu E*)^2/G* [length^3], >= 0."""
        return self._per_step(lambda block: block.tree.at_load_points(block.vertices.square))

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated on each step over (mu E*)^2/G* [length^3], >= 0."""
        return self._per_step(lambda block: block.dissipation)

    @cached_property
    def regime(self) -> Indices:
        """Index in `REGIMES` of the slip regime.

        Determined by the springs at their friction limit: none, the outermost, or all.
        """
        slips = 1 if self.moments.profile.has_no_partial_slip else 2

        def code(block: _Block) -> Indices:
            tree, top = block.tree, block.tree.top
            slipping = (tree.growth[top] == 0).any(axis=1)
            full = slipping & (tree.parent[tree.parent[top]] < 0)
            return np.where(top >= 0, np.where(full, 3, np.where(slipping, slips, 1)), 0)

        return self._per_step(code).astype(np.intp)

    @property
    def last(self) -> Polyline:
        """Polyline after the last step, over normal coordinates."""
        return self._end.line

    @property
    def last_vertices(self) -> tuple[TractionVertices, Indices]:
        """Vertices of the last block, and the indices of those of the last polyline."""
        tree = self._end.tree
        indices, vertex = [], int(tree.top[-1])
        while vertex >= 0:
            indices.append(vertex)
            vertex = int(tree.parent[vertex])
        return self._end.vertices, np.array(indices[::-1], dtype=np.intp)

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
            yield _Block(self.moments, chosen, tree, path, line)

    def _per_step(self, result: Callable[[_Block], Any]) -> Array:
        """Return a result of every step, zero in blocks without contact."""
        values = np.zeros(self.points.normal.shape)
        for block in self._blocks:
            if block.tree.normal.size:
                values[block.steps] = result(block)
        return values
