"""What the foundation carries where pieces of the polyline are arcs.

On an arc the slope is k = rate d(other)/d(level), so that the sums of `branches` over it are

    int k d(other) = rate M,  M = int d(other)/d(level) d(other),

and for the energy another integral of the same kind. Both are smooth in the contact coordinate.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.history.adaptive import integrate
from mdr_core.history.arcs import Plane
from mdr_core.history.branches import Branches, last_break
from mdr_core.history.memory import total
from mdr_core.lazy import cached_property
from mdr_core.typing import Array, Indices

_TINY: Final = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class ArcBranches(Branches):
    """The vertices of a walk of mixed control; a piece that is on no face is an arc."""

    rtol: float
    known: Array
    """Contact coordinate of the vertices, NaN where it is not known."""
    rates: Array
    """d(shift)/d(other) of the pieces below the vertices, NaN on a face."""

    @cached_property
    def coordinate(self) -> Array:
        """Contact coordinate of each vertex."""
        missing = np.isnan(self.known)
        found = self.known.copy()
        if missing.any():
            found[missing] = self._plane.at_level(self.tree.level[missing])
        return found

    @property
    def _plane(self) -> Plane:
        return Plane(self.profile, self.by_force)

    @cached_property
    def arcs(self) -> Indices:
        """Vertices with an arc below them on which the shift moves."""
        return np.flatnonzero(np.abs(self.rates) > 0)

    @cached_property
    def rate(self) -> Array:
        """d(shift)/d(other) on the arcs."""
        moved = self.tree.slope[self.arcs] * self.tree.span[self.arcs]
        return np.asarray(moved / self._integrals[2])

    @cached_property
    def _given_step(self) -> Array:
        return self.depth_step if self.by_force else self.force_step

    @cached_property
    def _integrals(self) -> tuple[Array, Array, Array, float]:
        """M on the arcs, the energy of each for a rate of one, its step of the other, and an error.

        Arcs lie above each other: what is between two neighbours of all their ends is integrated
        once.
        """
        plane = self._plane
        upper, lower = self.coordinate[self.arcs], self.coordinate[self.tree.parent[self.arcs]]
        if not upper.size:
            return np.zeros(0), np.zeros(0), np.zeros(0), 0.0
        breaks = self.profile.coordinate_breaks
        breaks = breaks[(breaks > lower.min()) & (breaks < upper.max())]
        edges = np.unique(np.concatenate([lower, upper, breaks]))
        first, last = np.searchsorted(edges, lower), np.searchsorted(edges, upper)
        other = plane.other(edges)
        # Measured from the end at which the integrand of the energy is zero.
        zero = 0 if self.by_force else 1
        starts, stops = (np.bincount(end, minlength=edges.size) for end in (first, last))
        used = np.flatnonzero(np.cumsum(starts - stops) > 0)

        # Behind a break all is smooth in the root of the distance.
        base = last_break(self.profile.coordinate_breaks, edges)

        def outer(index: Indices, root: Array) -> Array:
            return 2 * root * self.steep(base[index] + root * root)

        def inner(index: Indices, root: Array) -> Array:
            met = plane.other(base[index] + root * root)
            return np.abs(met - other[index + zero]) * outer(index, root)

        def span(index: Indices, root: Array) -> Array:
            return 2 * root * plane.slopes(base[index] + root * root)[1]

        pieces = used, np.sqrt(edges[used] - base[used]), np.sqrt(edges[used + 1] - base[used])
        whole, part, step = (
            integrate(density, pieces, self.rtol / 20, rough=False)
            for density in (outer, inner, span)
        )
        missing = max(
            float(each.missing.sum() / max(each.value.sum(), _TINY)) for each in (whole, part, step)
        )
        values = np.zeros((3, edges.size - 1))
        values[:, used] = [each.value[used] for each in (whole, part, step)]
        moment, energy, spans = _over_ranges((first, last), other, values, from_below=self.by_force)
        # Both ends of an arc may be one double: then it is as steep as there.
        none = np.flatnonzero(spans == 0)
        steep = plane.steepness(upper[none])
        spans[none] = steep * self.tree.span[self.arcs[none]]
        moment[none], energy[none] = steep * spans[none], steep * np.square(spans[none]) / 2
        return moment, energy, spans, missing

    def steep(self, s: Array) -> Array:
        """d(other)/d(level) d(other)/ds."""
        return self._plane.steepness(s) * self._plane.slopes(s)[1]

    @cached_property
    def _summed(self) -> Array:
        """Rises of what is summed over arcs: the force over depths, the anchor over forces."""
        rise = np.array(self._given_step)
        # What slope x rise stands for rate x M there.
        rise[self.arcs] = self._integrals[0] * self.tree.span[self.arcs] / self._integrals[2]
        return rise

    @property
    def anchor_step(self) -> Array:
        """Anchor of each vertex above its parent's [length]."""
        return self.tree.slope * (self._summed if self.by_force else self.depth_step)

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) of each vertex as a load point [length^2]."""
        return total(self.tree, self.force_step if self.by_force else self._summed)

    @cached_property
    def anchor(self) -> Array:
        """Anchor of each vertex above that of the axis [length]."""
        return total(self.tree, self._summed if self.by_force else self.depth_step)

    @cached_property
    def square(self) -> Array:
        """int_0^x (anchor of the vertex - anchor)^2 dx up to each vertex [length^3]."""
        tree, below = self.tree, self.shear[self.tree.parent]
        rise = below * (self._summed if self.by_force else self.depth_step)
        rise += tree.slope * self._lens_on_faces
        times = tree.slope[self.arcs] * (tree.span[self.arcs] / self._integrals[2]) ** 2
        rise[self.arcs] += times * self._integrals[1]
        return total(tree, rise)

    @cached_property
    def _lens_on_faces(self) -> Array:
        lens = self._lens.copy()
        lens[self.arcs] = 0.0
        return lens

    @property
    def missing(self) -> float:
        """How much of the integrals along arcs may be missing, relative."""
        return self._integrals[3]


def _over_ranges(
    ends: tuple[Indices, Indices], other: Array, pieces: Array, *, from_below: bool
) -> Array:
    """Sums over ranges of pieces: of M, of the energy about one end of the range, and of steps.

    Two neighbours of 2^k pieces each make one of twice as many, and every range is made of a few
    of different sizes: nothing is subtracted, and many ranges may lie above each other. What an
    energy is about moves with the end: by the moment times the distance.
    """
    first, last = ends
    moment, energy, step = pieces
    found = np.zeros((3, first.size))
    done, size = first.copy(), 1
    while moment.size:
        some = np.flatnonzero((last - first) & size)
        at = done[some]
        moments, energies, steps = found[:, some]
        if from_below:
            energies += (other[at] - other[first[some]]) * moment[at]
        else:
            energies += np.abs(other[at + size] - other[at]) * moments
        found[:, some] = moments + moment[at], energies + energy[at], steps + step[at]
        done[some] = at + size
        joined = moment.size - size
        if joined <= 0:
            break
        left, right = slice(joined), slice(size, size + joined)
        low, middle, high = (other[k * size : k * size + joined] for k in range(3))
        moved = (middle - low) * moment[right] if from_below else (high - middle) * moment[left]
        energy = energy[left] + energy[right] + np.abs(moved)
        moment, step = moment[left] + moment[right], step[left] + step[right]
        size *= 2
    return found
