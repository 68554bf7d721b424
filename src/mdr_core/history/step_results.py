"""Results of the tangential foundation at every load point of a sequence of straight steps."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from mdr_core.history import dissipation, slip_memory
from mdr_core.history.slip_memory import FrontPath, LoadPoints, Polyline
from mdr_core.history.traction_branches import TractionBranches
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices

# Steps evaluated at once: bounds the memory, and keeps their arrays in the processor's cache.
_BLOCK: Final = 16_384
# Slip regimes, in the order of their codes.
REGIMES: Final = ("no_contact", "stick", "partial_slip", "full_slip")


@dataclass(frozen=True)
class StepResults:
    """Results after each straight load step, in reduced units; each is computed on first use."""

    profile: Profile
    by_force: bool
    """Normal coordinates are reduced forces."""
    points: LoadPoints
    start: Polyline
    """Polyline before the first step."""

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) [length^2]."""
        return self._at_load_points(lambda part: part.shear)

    @cached_property
    def displacement(self) -> Array:
        """G* u_x/(mu E*) [length], from zero on the axis."""
        return self._at_load_points(lambda part: part.anchor)

    @cached_property
    def energy(self) -> Array:
        """Stored tangential energy over (mu E*)^2/G* [length^3], >= 0."""
        return self._at_load_points(lambda part: part.square)

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated on each step over (mu E*)^2/G* [length^3], >= 0."""
        dissipated = np.zeros(self.points.normal.shape)
        for block, _, path, _ in self._blocks():
            segments = slip_memory.slip_segments(path)
            each = dissipation.per_segment(self.profile, segments, by_force=self.by_force)
            np.add.at(dissipated[block], segments.step, each)
        return dissipated

    @cached_property
    def regime(self) -> Indices:
        """Index in `REGIMES` of the slip regime.

        Determined by the springs at their friction limit: none, the outermost, or all.
        """
        codes = np.zeros(self.points.normal.shape, dtype=np.intp)
        for block, part, _, top in self._blocks():
            tree = part.tree
            slipping = (tree.growth[top] == 0).any(axis=1)
            full = slipping & (tree.parent[tree.parent[top]] < 0)
            partial = 1 if self.profile.slips_at_once else 2
            code = np.where(full, 3, np.where(slipping, partial, 1))
            codes[block] = np.where(top >= 0, code, 0)
        return codes

    @cached_property
    def last(self) -> Polyline:
        """Polyline after the last step, over normal coordinates."""
        line = self.start
        for chosen in self._parts():
            *_, line = slip_memory.apply_steps(line, self.points.part(chosen))
        return line

    def _blocks(self) -> Iterator[tuple[slice, TractionBranches, FrontPath, Indices]]:
        """Yield the steps, vertices, path of the front and load points of every block."""
        line = self.start
        for chosen in self._parts():
            tree, path, line = slip_memory.apply_steps(line, self.points.part(chosen))
            if tree.normal.size:
                yield chosen, TractionBranches(self.profile, tree, self.by_force), path, tree.top

    def _parts(self) -> Iterator[slice]:
        count = self.points.normal.size
        return (slice(begin, begin + _BLOCK) for begin in range(0, count, _BLOCK))

    def _at_load_points(self, result: Callable[[TractionBranches], Array]) -> Array:
        """Return a result of the load points, zero in separation."""
        values = np.zeros(self.points.normal.shape)
        for block, part, _, top in self._blocks():
            values[block] = np.where(top >= 0, result(part)[top], 0.0)
        return values
