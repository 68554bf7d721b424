"""Nonlinear load steps, on which one quantity of each pair is prescribed and both change.

On such a step the tangential coordinate is linear in the conjugate y of the normal coordinate n,
so the load point moves along an arc of the curve y(n), I over d or d over I. The arc is replaced
by chords between points in the contact coordinate, where n and y need no inverse, clustered at
both ends. Results at the samples are extrapolated from three sets of chords; their error falls
with the third to fourth power of the number of chords. Source: notes, §10.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from mdr_core.doubles import TINY
from mdr_core.equivalent_1d import has_many_breaks
from mdr_core.history import slip_memory
from mdr_core.history.contact_state import TractionSegments
from mdr_core.history.load_path import SETS, SampledPath
from mdr_core.history.slip_memory import LoadPoints, Polyline
from mdr_core.history.step_results import REGIMES, StepResults
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices

# Chords of the coarsest set from the axis to the larger end of an arc: those of all sets take 1 to
# 8 ms per step, or 20 to 50 ms on tables of 200 points.
_CHORDS: Final = 256
# The fewest on a nonlinear load step, however short: with 4 the dissipation on one of 1 % of the
# load is off by 2e-5.
_FEWEST: Final = 8
# The most of the coarsest set on all nonlinear load steps, which bounds time and memory.
_MOST: Final = 100_000
# The error of the extrapolated results, in units of the change by the last halving.
_SAFETY: Final = 2.0
# The same on tables, where chords converge less regularly: the largest factor for 100 rough tables
# is 9.
_SAFETY_ON_TABLES: Final = 10.0
# A corner of chords is off its arc by less than this part of its normal coordinate.
_NEAREST: Final = 1e-3


@dataclass(frozen=True)
class NonlinearSteps:
    """Arcs of a load path, one for each sample; those of straight steps have no rate."""

    path: SampledPath

    @property
    def profile(self) -> Profile:
        """Profile of the contact."""
        return self.path.start.profile

    @cached_property
    def rate(self) -> Array:
        """Derivative of the tangential coordinate by the conjugate on each arc, shape (n,)."""
        rise, moved = np.diff(self.path.prescribed), np.diff(self.path.coordinates[1])
        nonlinear = self.path.nonlinear
        return np.where(nonlinear, moved / np.where(rise == 0, 1.0, rise), 0.0)

    @property
    def arcs(self) -> Array:
        """Rate of the arc of each load step, and conjugate and tangential coordinate of its end.

        Those at the start come last: their load steps are negative. Shape (3, m).
        """
        path = self.path
        ends = np.arange(path.per_step, path.prescribed.size, path.per_step)
        own = [self.rate[ends - 1], path.prescribed[ends], path.coordinates[1, ends]]
        return np.hstack([own, path.at_start[1]])

    @cached_property
    def larger(self) -> Array:
        """Contact coordinate of the larger end of each arc, > 0."""
        s = self.path.contact_coordinate
        return np.maximum(np.maximum(s[1:], s[:-1]), TINY)

    @cached_property
    def _parts(self) -> tuple[Indices, Array, Array]:
        """Arc, start and end of the parts on which both coordinate sums are monotonic.

        An arc is as steep as a face of the cone at one radius: |d(tangential)/dn| = 1.
        """
        start, stop = self.path.contact_coordinate[:-1], self.path.contact_coordinate[1:]
        with np.errstate(divide="ignore"):
            turn = np.abs(self.rate) / 2 if self.path.over_forces else 1 / (2 * np.abs(self.rate))
        low, high = np.sort(self.profile.contact_radius(np.stack([start, stop])), axis=0)
        turned = np.flatnonzero((low < turn) & (turn < high))
        at = self.profile.coordinate_from_radius(turn[turned])
        breaks = np.zeros(0) if has_many_breaks(self.profile) else self.profile.coordinate_breaks
        low, high = np.minimum(start, stop), np.maximum(start, stop)
        which, crossing = np.nonzero((low < breaks[:, None]) & (breaks[:, None] < high))
        owner = np.concatenate([np.arange(start.size), turned, crossing])
        starts = np.concatenate([start, at, breaks[which]])
        order = np.lexsort((np.sign(stop - start)[owner] * starts, owner))
        owner, starts = owner[order], starts[order]
        last = np.append(np.diff(owner) > 0, True)
        return owner, starts, np.where(last, stop[owner], np.roll(starts, -1))

    def chords(self, halvings: int) -> tuple[LoadPoints, Indices]:
        """Return the ends of the chords, and which of them are the samples.

        Up to `_MOST` they do not depend on other load steps: a path has those of its pieces.
        """
        owner, start, stop = self._parts
        straight = self.rate[owner] == 0
        needed = np.maximum(_CHORDS * np.abs(stop - start) / self.larger[owner], _FEWEST)
        needed[straight] = 0.0
        count = np.ceil(needed / max(needed.sum() / _MOST, 1.0)).astype(int) << halvings
        count[straight] = 1
        part, last = np.repeat(np.arange(count.size), count), np.cumsum(count) - 1
        share = (np.arange(part.size) - np.append(-1, last[:-1])[part]) / count[part]
        # Chords that are even in the angle cluster at both ends of a part: the axis, and load
        # points from which slip starts.
        s = start[part] + (stop - start)[part] * np.square(np.sin(np.pi / 2 * share))
        s[last] = stop
        arc = owner[part]
        samples = np.flatnonzero(np.append(np.diff(arc) > 0, True))
        moments, (_, tangential) = self.path.moments, self.path.coordinates
        climbed = moments.conjugate(s) - self.path.prescribed[arc]
        tangential = tangential[arc] + self.rate[arc] * climbed
        normal = moments.normal(s)
        normal[samples], tangential[samples], *_ = self.path.load_points
        step = self.path.step[arc]
        if self.path.over_forces:
            tangential = self.path.within_friction(normal, tangential, step)
        continues = np.zeros(part.size, dtype=bool)
        continues[samples] = self.path.continues & (self.rate == 0)
        return LoadPoints(normal, tangential, continues, step), samples

    def curved_segments(self, line: Polyline) -> TractionSegments | None:
        """Return the segments of the last polyline, with one arc for the chords of each step.

        Corners that chords have cut are moved to the arcs. None if no arc is left.
        """
        tree = slip_memory.as_tree(line)
        # Of each segment, below the vertex of its index.
        arcs, on_face = self.arcs[:, line.load_step], tree.on_face
        rate = np.where(on_face, 0.0, arcs[0])
        # None in separation.
        rate[:1] = 0.0
        if not rate.any():
            return None
        coordinate = self.path.moments.contact_coordinate(tree.normal)
        chord = rate[1:] != 0
        corners = np.flatnonzero(chord[:-1] & on_face[2:]) + 1
        if corners.size:
            # The sum that is constant above the corner, along the face.
            own = np.where(tree.slope[corners + 1] < 0, 0, 1)
            sums = line.vertices[corners, own]
            sign = np.where(own == 0, 1.0, -1.0)
            coordinate[corners] = self._on_arcs(coordinate[corners], arcs[:, corners], sign, sums)
        joined = chord[:-1] & chord[1:] & (line.load_step[1:-1] == line.load_step[2:])
        first = np.append(0, np.flatnonzero(~joined) + 1)
        last = np.append(first[1:], chord.size)
        return TractionSegments(
            np.append(coordinate[first], coordinate[-1]),
            np.where(chord[first], 0.0, tree.slope[1:][first]),
            rate[last],
            inverse=self.path.over_forces,
        )

    def _on_arcs(self, s: Array, arcs: Array, sign: Array, sums: Array) -> Array:
        """Return the contact coordinates at which n +- tangential on arcs is equal to `sums`.

        One step of Newton's method from the chords, whose error of 1e-6 it squares.
        """
        profile, moments = self.profile, self.path.moments
        normal, rate = moments.normal(s), sign * arcs[0]
        slope = profile.depth_slope(s)
        force = slope * 2 * profile.contact_radius(s)
        rise = force + rate * slope if moments.over_forces else slope + rate * force
        miss = normal + sign * arcs[2] + rate * (moments.conjugate(s) - arcs[1]) - sums
        moved = s - miss / np.where(rise > 0, rise, np.nan)
        # Where the arc is all but parallel to the face, the corner of the chords is as good.
        near = np.abs(moments.normal(moved) - normal) < _NEAREST * normal
        return np.where(near, moved, s)


@dataclass(frozen=True)
class ExtrapolatedResults:
    """Results at the samples of a nonlinear load path, in reduced units; see `StepResults`."""

    nonlinear: NonlinearSteps
    sets: tuple[tuple[StepResults, Indices], ...]
    """Results on the chords, coarsest first, and which of them are the samples."""

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) [length^2]."""
        return self._extrapolated("shear")[-1]

    @cached_property
    def displacement(self) -> Array:
        """G* u_x/(mu E*) [length], from zero on the axis."""
        return self._extrapolated("displacement")[-1]

    @cached_property
    def energy(self) -> Array:
        """Stored tangential energy over (mu E*)^2/G* [length^3], >= 0."""
        return self._extrapolated("energy")[-1]

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated on each step over (mu E*)^2/G* [length^3], >= 0."""
        return self._extrapolated("dissipation")[-1]

    @property
    def regime(self) -> Indices:
        """Index in `REGIMES` of the slip regime."""
        results, samples = self.sets[-1]
        return results.regime[samples]

    @property
    def finest(self) -> StepResults:
        """Results on the finest chords."""
        return self.sets[-1][0]

    @cached_property
    def error(self) -> float:
        """Bound on the error of the results by the chords, relative to the largest of each."""
        safety = _SAFETY_ON_TABLES if has_many_breaks(self.nonlinear.profile) else _SAFETY
        worst = 0.0
        for name in ("shear", "displacement", "energy", "dissipation"):
            coarse, fine = self._extrapolated(name)
            largest = float(np.max(np.abs(fine)))
            if largest > 0:
                change = float(np.max(np.abs(fine - coarse)))
                if name == "dissipation":
                    change = max(change, self._change_at_full_slip)
                worst = max(worst, safety * change / largest)
        return worst

    @property
    def _change_at_full_slip(self) -> float:
        """Error of the dissipation on load steps along which full slip begins or ends.

        It does so anywhere on a chord. This error is irregular, and one order below the error that
        the extrapolation removes; the change by the last halving may vanish by chance.
        """
        results, samples = self.sets[-1]
        full = results.regime == REGIMES.index("full_slip")
        sample = np.searchsorted(samples, np.flatnonzero(full[1:] != full[:-1]) + 1)
        chords = np.diff(np.append(-1, samples))
        _, coarse, fine = self._at_samples("dissipation")
        change = np.where(chords > 1, np.abs(fine - coarse) / (3 * chords), 0.0)
        return float(change[sample].max(initial=0.0))

    def _at_samples(self, name: str) -> list[Array]:
        """Results of each set at the samples, those of `dissipation` since the sample before."""
        values = []
        for results, samples in self.sets:
            row = getattr(results, name)
            begin = np.append(0, samples[:-1] + 1)
            values.append(np.add.reduceat(row, begin) if name == "dissipation" else row[samples])
        return values

    def _extrapolated(self, name: str) -> tuple[Array, Array]:
        """Richardson's extrapolation of the coarser and of the finer two sets of chords."""
        found = []
        for coarse, fine in pairwise(self._at_samples(name)):
            change = (fine - coarse) / 3
            if name in {"energy", "dissipation"}:
                # Below their own error these may not become negative.
                change = np.where(np.abs(change) < fine / 3, change, 0.0)
            found.append(fine + change)
        return found[0], found[1]


def results(path: SampledPath) -> ExtrapolatedResults:
    """Return the results of a load path with nonlinear load steps.

    Raises InputError for a tangential force above mu F_N anywhere on the path.
    """
    if path.over_forces:
        # A force that changes while the bodies are separated exceeds friction there.
        separated = np.minimum(path.prescribed[1:], path.prescribed[:-1]) < 0
        beyond = np.where(separated & path.nonlinear, 1.0, 0.0)
        path.within_friction(0 * beyond, beyond, path.step)
    nonlinear = NonlinearSteps(path)
    sets, (lines, _) = [], path.at_start
    if len(lines) == 1:
        lines *= SETS
    for halvings, line in enumerate(lines):
        points, last = nonlinear.chords(halvings)
        sets.append((StepResults(path.moments, points, line, path.begin.regime), last))
    return ExtrapolatedResults(nonlinear, tuple(sets))
