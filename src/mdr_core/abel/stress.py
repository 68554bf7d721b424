"""The two-limit stress kernel of a table, int g'(x)/sqrt(x^2 - r^2) dx over an annulus."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt
from typing import Final, NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.displacement import Branch, Kernel
from mdr_core.abel.interpolation import fit_points, fitted
from mdr_core.abel.multipole import FAR, Multipoles, add, multipoles, pairs, panel_sums
from mdr_core.abel.panel_moments import far, near, scaled
from mdr_core.abel.subpanels import LONGEST
from mdr_core.cached import cached_property
from mdr_core.quadrature import composite_rule, gauss_legendre
from mdr_core.typing import Array, Chosen, Indices

# Points in a panel that become masses.
_MASSES: Final = 16
# Powers of a block in the far field: they leave 7.3^-14 = 8e-13 of the block's part, and 1e-13 of
# the whole in the bank of tables.
_POWERS: Final = 14
# Gauss nodes in a panel of a displacement's integral: the root at its left edge leaves 3^-32.
_POINTS_OF_DISPLACEMENT: Final = 16
# Points of a panel that is expanded about another edge.
_POINTS: Final = 24
# Distance from the axis, over the first panel or the contact, within which a smooth stress is
# constant.
_AXIS: Final = 1e-8


class _RadialEnds(NamedTuple):
    """Ends of an annulus [length]; the roots are those of `StressPanels.kernel`."""

    outer: float
    inner: float
    width: float
    outer_root: float
    inner_root: float


@dataclass(frozen=True, eq=False)
class StressPanels:
    """W = dg/ds as a polynomial in u = s/length, s = sqrt(x^2 - left^2), on each panel."""

    edges: Array
    """Ends of the panels, ascending [length], shape (k + 1,)."""
    length: Array
    """s at the right end of each panel [length], shape (k,)."""
    weight: Array
    """Coefficients of the powers of u, from 0 on [1], shape (k, n)."""
    smooth_tip: bool
    """True if the slope on the axis is zero up to interpolation error: its stress is finite."""

    @cached_property
    def branches(self) -> tuple[Branch, ...]:
        """Panels as intervals for the displacement integrals."""
        return tuple(self._branch(panel) for panel in range(self.length.size))

    def _branch(self, panel: int) -> Branch:
        left, right = self.edges[panel : panel + 2].tolist()
        length, row = float(self.length[panel]), self.weight[panel]

        def weight(x: Array, s: Array, _index: Chosen) -> Array:
            del x
            return np.asarray(polynomial.polyval(np.minimum(s / length, 1.0), row))

        return Branch(left, weight, right)

    def annulus_integrals(
        self, low: float, width: float, below: Callable[[float], Array], kernels: Sequence[Kernel]
    ) -> list[float]:
        """Return int_low^r g'(x) K(x, sqrt(r^2 - x^2)) dx, r = low + width, for each kernel K.

        All panels at once, in tan(alpha/2), s = sqrt(r^2 - left^2) cos(alpha).
        Source: notes, §7. Parameters: see `displacement.annulus_integrals`.
        """
        r = low + width
        first = int(np.searchsorted(self.edges[1:-1], low, side="right"))
        last = int(np.searchsorted(self.edges[1:-1], r)) + 1
        edges, length = self.edges[first : last + 1], self.length[first:last]
        past = low - edges
        past[:1] = below(float(edges[0]))
        roots = np.sqrt(np.maximum(past + width, 0.0) * (r + edges))
        s_r, root_high = roots[:-1], roots[1:]
        inside = past[:-1] > 0
        s_low = np.where(inside, np.sqrt(np.maximum(past, 0.0) * (low + edges))[:-1], 0.0)
        root_low = np.where(inside, sqrt(width * (r + low)), s_r)
        s_high = np.where(root_high > 0, length, s_r)
        top = root_high / (s_high + s_r)
        span = np.maximum(root_low / (s_low + s_r) - top, 0.0)
        nodes, weights = composite_rule(_POINTS_OF_DISPLACEMENT, 1)
        half = top[:, None] + span[:, None] * nodes
        run = 2 / (1 + half * half)
        s, root = s_r[:, None] * (run - 1), s_r[:, None] * (half * run)
        x = np.hypot(edges[:-1, None], s)
        u, value = np.minimum(s / length[:, None], 1.0), np.zeros_like(s)
        for row in self.weight[first:last].T[::-1]:
            value = value * u + row[:, None]
        value *= root * run
        return [float(span @ ((value * kernel(x, root)) @ weights)) for kernel in kernels]

    @cached_property
    def _rows(self) -> Array:
        return scaled(self.weight.T)

    @cached_property
    def _counts(self) -> Indices:
        return _nonzero(self._rows)

    @cached_property
    def _multipoles(self) -> Multipoles:
        nodes, weights = gauss_legendre(_MASSES)
        u = (1 + nodes) / 2
        powers = u ** np.arange(self.weight.shape[1])[:, None]
        masses = (self.weight @ powers * (weights / 2)).T * self.length
        return multipoles(
            self.edges, panel_sums(np.square(u)[:, None], masses, _POWERS), above=False
        )

    def kernel(
        self,
        annulus: Annulus,
        roots: tuple[Array, Array],
        r: Array,
        beyond: Array | None = None,
    ) -> Array:
        """Return int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx.

        Source: mdr-5, Eqs. (5.68), (5.70).

        Parameters
        ----------
        annulus : its coordinate is the radius.
        roots : sqrt(x^2 - flat^2) at a and at c, 0 inside the flat, as accurate as the load
            however near they are to it [length].
        r : radii r < a, or r <= a where `beyond` is known [length], shape (m,).
        beyond : sqrt(r^2 - flat^2), if all radii lie beyond the flat and it has more digits
            [length], shape (m,).
        """
        a, inner, _ = annulus
        width, c = (a, np.zeros(1)) if inner is None else inner[:2]
        ends = a, c, width, *roots
        if all(end.size == 1 for end in ends):
            return self._over(_RadialEnds(*(end.item() for end in ends)), r, beyond)
        annuli = np.stack([np.ravel(end) for end in np.broadcast_arrays(*ends)])
        different, number = np.unique(annuli, axis=1, return_inverse=True)
        result = np.empty_like(r)
        for i, annulus_ends in enumerate(different.T.tolist()):
            points = np.flatnonzero(number == i)
            there = None if beyond is None else beyond[points]
            result[points] = self._over(_RadialEnds(*annulus_ends), r[points], there)
        return result

    def _over(self, ends: _RadialEnds, radius: Array, beyond: Array | None) -> Array:
        """Kernel of an annulus, over whole panels and those at its ends."""
        a, c = ends.outer, ends.inner
        order = np.argsort(radius if beyond is None else beyond, kind="stable")
        r, s = radius[order], None if beyond is None else beyond[order]
        if self.smooth_tip and self.edges[0] == c == 0:
            r = np.maximum(r, _AXIS * min(self.length[0], a))
        last = min(int(np.searchsorted(self.edges[1:], a)), self.length.size - 1)
        first = max(int(np.searchsorted(self.edges, c)), int(ends.inner_root > 0))
        # Next to an edge of a panel its integral may be infinite.
        with np.errstate(divide="ignore", invalid="ignore"):
            total = self._whole(first, last, r) if first < last else np.zeros_like(r)
            for panel in {last, first - 1} - {-1}:
                total += self._cut(panel, ends, r, s)
        result = np.empty_like(r)
        result[order] = total
        return result

    def _whole(self, first: int, last: int, r: Array) -> Array:
        """Panels first <= i < last: as multipoles in the far field, the others one by one."""
        low, high = self._multipoles.far_from(r, first, last)
        total = self._multipoles.sums(r, None, low, high)
        end = np.searchsorted(r, self.edges[first + 1 : last + 1])
        columns = self.edges[:-1], self.edges[1:], self.length
        for panels, counts, point in pairs(np.minimum(high[first:last], end), end):
            used, at = slice(first + panels.start, first + panels.stop), r[point]
            left, right, length = (column[used].repeat(counts) for column in columns)
            above, to_right = (left - at) * (left + at), (right - at) * (right + at)
            rows = self._rows[: self._counts[used].max(), used].repeat(counts, axis=1)
            add(total, point, near(rows, length, above, to_right))
        return total

    def _cut(self, panel: int, ends: _RadialEnds, r: Array, s: Array | None) -> Array:
        """Part of one panel that lies in the annulus c <= x <= a, at ascending radii.

        s is `beyond` of `kernel`.
        """
        a, c, width, root_a, root_c = ends
        b, right = float(self.edges[panel]), min(float(self.edges[panel + 1]), a)
        total, begins_inside = np.zeros_like(r), c > b or (panel == 0 and root_c > 0)
        # Next to the flat only the root tells a from it.
        length = root_a if panel == 0 and right == a else sqrt((right - b) * (right + b))
        # The width is accurate however narrow the annulus.
        whole = (width if right == a else right - c) * (right + c)
        # The rounding error of root_c is that of root_a.
        by_root = panel == 0 and (c == b or root_a * root_c < b * b)
        past = root_c * root_c if by_root else (c - b) * (c + b)
        if panel == 0 and s is not None:
            # All differences of squares are those of the roots.
            b, right, c, r = 0.0, length, root_c, s
        # For radii above c the integral starts at the radius and does not depend on c.
        beyond = int(np.searchsorted(r, c)) if begins_inside else 0
        at = r[beyond : int(np.searchsorted(r, right))]
        rows = self._rows[: self._counts[panel], panel]
        rows = rows * (length / self.length[panel]) ** np.arange(rows.size)
        above, to_right = (b - at) * (b + at), (right - at) * (right + at)
        total[beyond : beyond + at.size] = _panel_integral(rows, length, above, to_right)
        if beyond:
            below = (c - r[:beyond]) * (c + r[:beyond])
            total[:beyond] = self._from_inner(panel, past, whole, below)
        return total

    def _from_inner(self, panel: int, past: float, whole: float, below: Array) -> Array:
        """Part of one panel from c on, `whole` long in x^2, at radii below c, c^2 - r^2 = `below`.

        At near radii W is expanded about c, on pieces that are short next to its root at the
        panel's left edge, where x^2 is less by `past`.
        """
        total, panel_length, s_c = np.zeros_like(below), float(self.length[panel]), sqrt(past)
        begin = int(np.searchsorted(-below, -FAR * whole, side="right"))
        rows = self._rows[: self._counts[panel], panel]
        part = whole / (sqrt(past + whole) + s_c) / panel_length
        total[:begin] = far(rows, panel_length, below[:begin], s_c / panel_length, part)
        close = below[begin:]
        if not close.size:
            return total
        ends = [0.0]
        while ends[-1] < whole:
            ends.append(min(ends[-1] + LONGEST * (past + ends[-1]), whole))
        points, _, _ = fit_points(_POINTS)
        degrees = np.arange(self.weight.shape[1])[:, None]
        for low, high in pairwise(ends):
            length = sqrt(high - low)
            own = length * points
            s = np.sqrt(past + low + own * own)
            weight = self.weight[panel] @ (s / panel_length) ** degrees * own / s
            piece = scaled(fitted(weight)[:, None])
            piece[0] = 0.0
            piece = piece[: _nonzero(piece)[0], 0]
            total[begin:] += _panel_integral(piece, length, close + low, close + high)
        return total


def _nonzero(rows: Array) -> Indices:
    """Number of `scaled` coefficients of each panel up to the last pair that is not zero."""
    used = rows[::-1] != 0
    pairs = np.logical_or.accumulate(used[::2] | used[1::2])
    return np.asarray(2 * np.maximum(pairs.sum(axis=0), 1))


def _panel_integral(rows: Array, length: float, above: Array, to_right: Array) -> Array:
    """Integral over one panel at ascending radii, in the far and the near field."""
    begin = int(np.searchsorted(-above, -FAR * length * length, side="right"))
    total = np.empty_like(above)
    if begin:
        total[:begin] = far(rows, length, above[:begin])
    if begin < above.size:
        every = np.repeat(rows[:, None], above.size - begin, axis=1)
        total[begin:] = near(every, length, above[begin:], to_right[begin:])
    return total
