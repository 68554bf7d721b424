"""Results of the tangential foundation at every load point of a sequence of straight steps."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from mdr_core.history import slip_memory
from mdr_core.history.slip_memory import LoadPoints, Polyline
from mdr_core.history.traction_vertices import TractionVertices
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array, Indices

# Steps evaluated at once, so that their arrays stay in the processor's cache.
_BLOCK: Final = 16_384
# Rounding error of two loads that grow in proportion, over the larger one.
_ROUNDING: Final = 16 * float(np.finfo(float).eps)
# Steps whose vertices are kept for later results, which take 40 MB. Those of more steps take longer
# to be stored and fetched than to be computed again, and their memory has to have a bound.
_KEPT: Final = 262_144
# Slip regimes, in the order of their codes.
REGIMES: Final = ("no_contact", "stick", "partial_slip", "full_slip")


class _Block(NamedTuple):
    """Some of the steps, with the results at their vertices, and the polyline after them."""

    vertices: TractionVertices
    line: Polyline


@dataclass(frozen=True)
class StepResults:
    """Results after each of a sequence of straight load steps, in reduced units.

    Each is computed on first use; the slip memory is followed once for all, up to `_KEPT` steps.
    """

    moments: IntervalMoments
    points: LoadPoints
    start: Polyline
    """Polyline before the first step."""
    regime_before: str
    """Slip regime before the first step."""

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) [length^2]."""
        return self._per_step(lambda block: block.tree.at_load_points(block.shear))

    @cached_property
    def displacement(self) -> Array:
        """G* u_x/(mu E*) [length], from zero on the axis."""
        return self._per_step(lambda block: block.tree.at_load_points(block.anchor))

    @cached_property
    def energy(self) -> Array:
        """Stored tangential energy over (mu E*)^2/G* [length^3], >= 0."""
        return self._per_step(lambda block: block.tree.at_load_points(block.square))

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated on each step over (mu E*)^2/G* [length^3], >= 0."""
        return self._per_step(lambda block: block.dissipation)

    @cached_property
    def regime(self) -> Indices:
        """Index in `REGIMES` of the slip regime.

        Determined by the springs at their friction limit: none, the outermost, or all. Springs that
        reach it without slip, as where both forces grow in the ratio mu, leave the regime as it is.
        """
        slips = 1 if self.moments.profile.has_no_partial_slip else 2

        def code(block: TractionVertices) -> Array:
            tree, top = block.tree, block.tree.top
            limited = tree.on_face[top]
            full = limited & (tree.parent[tree.parent[top]] < 0)
            return np.where(top >= 0, np.where(full, 3, np.where(limited, slips, 1)), 0)

        codes, before = self._per_step(code).astype(np.intp), REGIMES.index(self.regime_before)
        deeper = np.diff(self.points.normal, prepend=self.start.normal)
        further = np.abs(np.diff(self.points.tangential, prepend=self.start.tangential))
        rounding = np.where(deeper > 0, _ROUNDING * self.points.normal, 0.0)
        known = (codes < 2) | (further - deeper > rounding)
        last = np.maximum.accumulate(np.where(known, np.arange(codes.size), -1))
        return np.maximum(np.where(last < 0, before, codes[last]), codes > 0)

    @property
    def last(self) -> Polyline:
        """Polyline after the last step, over normal coordinates."""
        return self._end.line

    @property
    def last_vertices(self) -> tuple[TractionVertices, Indices]:
        """Results at the vertices of the last block, and the indices of the last polyline."""
        vertices = self._end.vertices
        return vertices, vertices.tree.last

    @cached_property
    def _end(self) -> _Block:
        return deque(self._blocks, maxlen=1)[0]

    @property
    def _blocks(self) -> Iterable[_Block]:
        return self._kept if self.points.normal.size <= _KEPT else self._follow()

    @cached_property
    def _kept(self) -> list[_Block]:
        return list(self._follow())

    def _follow(self) -> Iterator[_Block]:
        line = self.start
        for begin in range(0, self.points.normal.size, _BLOCK):
            points = LoadPoints._make(row[begin : begin + _BLOCK] for row in self.points)
            tree, line = slip_memory.follow(line, points)
            yield _Block(TractionVertices(self.moments, tree), line)

    def _per_step(self, result: Callable[[TractionVertices], Array]) -> Array:
        """Return a result of every step, zero in blocks without contact."""
        found = [
            result(vertices) if vertices.tree.parent.size else np.zeros(vertices.tree.top.shape)
            for vertices, _ in self._blocks
        ]
        return found[0] if len(found) == 1 else np.concatenate(found)
