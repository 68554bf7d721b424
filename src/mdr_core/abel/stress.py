"""The two-limit stress kernel of functions known as panels."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.abel.clusters import FAR, Clusters, add, clusters, masses_at_nodes, nodes_for, pairs
from mdr_core.abel.displacement import Branch
from mdr_core.abel.panel_moments import PLACES, PowerPanels, interpolated, power_panels
from mdr_core.abel.pieces import DEGREE
from mdr_core.abel.roots import leg, one_sided
from mdr_core.lazy import cached_property
from mdr_core.quadrature import Analytic, gauss_legendre
from mdr_core.typing import Array, Chosen, Flags, Indices

# Of a panel's masses, and of a part of a panel that is seen from afar, where 2 x 14 nodes
# leave 3.4^-28.
_MASS_NODES: Final = 16
_FAR_NODES: Final = 14
# Interpolation errs by 7.3^-12 of the part of a block: below 1e-13 of the whole.
_CLUSTER_NODES: Final = 12
# Parts of the accuracy: what a panel may lose that is expanded anew, and the ends of an annulus.
_ANEW: Final = 0.1
_SAME: Final = 1e-3
# The axis of the first panel: nearer than this nothing changes for a function smooth there.
_AXIS: Final = 1e-8
# G(0) below this, relative to the largest G, is what an interpolation leaves of a smooth tip.
_TIP: Final = 1e-6
# The panels' polynomials have degree 23.
_POLYNOMIALS: Final = Analytic(growth=12.0, fewest=24)


def _basis(points: Array) -> Array:
    """The polynomials of a piece at points between -1 and 1 (degree + 1, points)."""
    return np.asarray(chebyshev.chebvander(points, DEGREE).T, dtype=float)


_AT_PLACES: Final = _basis(2 * PLACES - 1)
_AT_NODES: Final = _basis(gauss_legendre(_MASS_NODES)[0])


@dataclass(frozen=True)
class _Annulus:
    """Where is integrated: c <= x <= a, `width` = a - c with its digits."""

    a: float
    c: float
    width: float


@dataclass(frozen=True, eq=False)
class StressPanels:
    """G = g' between `edges` as polynomials in s = sqrt(x^2 - b^2), b the panel's own left edge.

    There the root that G carries at b is gone; what remains of a jump, `pole`/s, is kept apart.
    A panel is one piece or several: all other arrays have one entry a piece; `coefficients` are
    Chebyshev, on [start, stop] in s.
    """

    edges: Array
    base: Array
    start: Array
    stop: Array
    pole: Array
    coefficients: Array
    error: float
    accuracy: float
    """What closed moments next to a point may lose, of the largest value in a panel."""

    @cached_property
    def branches(self) -> tuple[Branch, ...]:
        """The pieces as stretches for the displacement integrals."""
        return tuple(self._branch(piece) for piece in range(self.base.size))

    def _branch(self, piece: int) -> Branch:
        base, start, stop = (float(part[piece]) for part in (self.base, self.start, self.stop))
        middle, half = (start + stop) / 2, (stop - start) / 2
        pole, row = float(self.pole[piece]), self.coefficients[piece]
        row = row[: int(np.flatnonzero(row).max(initial=0)) + 1]

        def weight(x: Array, s: Array, _index: Chosen) -> Array:
            value = chebyshev.chebval(np.clip((s - middle) / half, -1, 1), row)
            return np.asarray((value * s + pole) / x)

        return Branch(base, weight, float(self._ends[piece]), start=float(np.hypot(base, start)))

    @cached_property
    def _first(self) -> Indices:
        """First piece of each panel, and the number of all."""
        return np.append(np.flatnonzero(self.start == 0), self.base.size)

    @cached_property
    def _ends(self) -> Array:
        """Where each piece ends as a radius: the last of a panel on its edge, to the last bit."""
        ends = np.hypot(self.base, self.stop)
        ends[self._first[1:] - 1] = self.edges[1:]
        return np.asarray(ends)

    @cached_property
    def _powers(self) -> PowerPanels:
        """The panels in powers of s."""
        left, right = self.edges[:-1], self.edges[1:]
        pole = self.pole[self._first[:-1]]
        on_axis = chebyshev.chebval(-1.0, self.coefficients[0])
        at_left = np.append(on_axis, pole[1:] / left[1:])
        every = np.arange(left.size)
        values = self._weights(every, PLACES)
        powers = power_panels(left, right, values, at_left, self.accuracy)
        # One piece is resolved; of several, one polynomial may miss what lies between its places.
        cut = np.flatnonzero((np.diff(self._first) > 1) & powers.known)
        if not cut.size:
            return powers
        between = (PLACES[1:] + PLACES[:-1]) / 2
        between = np.concatenate([PLACES[:1] * [0.03, 0.3], between])
        fitted = interpolated(values[cut], between)
        missed = np.abs(fitted - self._weights(cut, between)).max(axis=1, initial=0.0)
        powers.known[cut] = missed <= self.accuracy / 4 * np.abs(values[cut]).max(axis=1)
        return powers

    def _weights(self, panel: Indices, places: Array) -> Array:
        """W = (G s + pole)/x at places in panels of length one (panels, places)."""
        left = self.edges[panel, None]
        length = leg(self.edges[panel + 1], left[:, 0])[:, None]
        s = length * places
        first = self._first[panel]
        basis = _AT_PLACES if places is PLACES else _basis(2 * places - 1)
        value = self.coefficients[first] @ basis
        cut = np.flatnonzero(np.diff(self._first)[panel] > 1)
        if cut.size:
            value[cut] = self._from_pieces(panel[cut], places, s[cut])
        return np.asarray((value * s + self.pole[first, None]) / np.hypot(left, s))

    def _from_pieces(self, panel: Indices, places: Array, s: Array) -> Array:
        """G without its pole, in panels of several pieces."""
        number = np.repeat(np.arange(self.edges.size - 1), np.diff(self._first))
        at = number + self.start / leg(self.edges[1:], self.edges[:-1])[number]
        piece = np.searchsorted(at, panel[:, None] + places, side="right") - 1
        return self._regular(piece, s)

    @cached_property
    def _clusters(self) -> Clusters:
        """Whole panels, as they are seen from smaller radii afar."""
        first = self._first
        nodes, weights = gauss_legendre(_MASS_NODES)
        span = self.stop - self.start
        s = self.start[:, None] + np.multiply.outer(span, (1 + nodes) / 2)
        # The nodes are in the same places of all pieces.
        value = self.coefficients @ _AT_NODES * s + self.pole[:, None]
        masses = span[:, None] / 2 * weights * value / np.hypot(self.base[:, None], s)
        square = np.diff(self.edges) * (self.edges[1:] + self.edges[:-1])
        parts = masses_at_nodes(
            s * s / np.repeat(square, np.diff(first))[:, None],
            masses,
            min(nodes_for(self.accuracy), _CLUSTER_NODES),
        )
        return clusters(self.edges, np.add.reduceat(parts, first[:-1]), above=False)

    def kernel(
        self,
        a: Array,
        r: Array,
        rtol: float,
        width: Array | None = None,
        inner: Array | None = None,
    ) -> Array:
        """Return int_max(r,c)^a G(x)/sqrt(x^2 - r^2) dx, c = a - width.

        a of shape (1,) or (m,), r of shape (m,), r < a. Source: mdr-5, Eqs. (5.68), (5.70).
        """
        width = a if width is None else width
        c = a - width if inner is None else inner
        annuli = np.stack([np.ravel(part) for part in np.broadcast_arrays(a, c, width)])
        if annuli.shape[1] == 1:
            return self._sorted(_Annulus(*annuli[:, 0].tolist()), r, rtol)
        different, number = np.unique(annuli, axis=1, return_inverse=True)
        result = np.empty_like(r)
        for i, column in enumerate(different.T.tolist()):
            points = np.flatnonzero(number == i)
            result[points] = self._sorted(_Annulus(*column), r[points], rtol)
        return result

    def _sorted(self, annulus: _Annulus, r: Array, rtol: float) -> Array:
        if bool((r[1:] >= r[:-1]).all()):
            return self._over(annulus, r, rtol)
        order = np.argsort(r)
        result = np.empty_like(r)
        result[order] = self._over(annulus, r[order], rtol)
        return result

    def _over(self, annulus: _Annulus, r: Array, rtol: float) -> Array:
        """The kernel at ascending radii: whole panels, and those that the annulus cuts."""
        last = int(np.searchsorted(self.edges, annulus.a)) - 1
        first = int(np.searchsorted(self.edges, annulus.c))
        total = self._whole(first, last, r, rtol) if first < last else np.zeros_like(r)
        for panel in {last, first - 1} - {-1}:
            total += self._cut(panel, annulus, r, rtol)
        return total

    def _whole(self, first: int, last: int, r: Array, rtol: float) -> Array:
        """Panels first <= i < last: afar in clusters, the others one by one."""
        low, high = self._clusters.far_from(r, self._clusters.usable(first, last))
        total = self._clusters.sums(r, None, low, high)
        end = np.searchsorted(r, self.edges[first + 1 : last + 1])
        for number, point in pairs(np.minimum(high[first:last], end), end):
            add(total, point, self._near(number + first, r[point], rtol))
        return total

    def _near(self, panel: Indices, r: Array, rtol: float) -> Array:
        """Whole panels, each seen from its own radius."""
        at, infinite = self._off_axis(panel, r)
        known = self._powers.known[panel]
        if known.all():
            value = self._powers.chosen(panel).integrals(at)
        else:
            value = np.empty_like(r)
            value[known] = self._powers.chosen(panel[known]).integrals(at[known])
            rest = np.flatnonzero(~known)
            whole = _Annulus(np.inf, 0.0, np.inf)
            value[rest] = self._by_rule(panel[rest], at[rest], whole, rtol)
        value[infinite] = np.inf
        return value

    def _off_axis(self, panel: Indices, r: Array, c: float = 0.0) -> tuple[Array, Flags]:
        """Radii moved off the axis, and where a tip makes the integral from c on infinite there.

        G(0) > 0 is a tip, and the integral of G/x over it infinite.
        """
        on_axis = (r == 0) & (panel == 0)
        if not on_axis.any():
            return r, on_axis
        if c > 0:
            return np.where(on_axis, _AXIS * c, r), np.zeros_like(on_axis)
        row = self.coefficients[0]
        tip = abs(float(chebyshev.chebval(-1.0, row))) > _TIP * np.abs(self.coefficients).max()
        return np.where(on_axis, _AXIS * self.stop[0], r), on_axis & tip

    def _cut(self, panel: int, annulus: _Annulus, r: Array, rtol: float) -> Array:
        """The part of one panel that lies in the annulus."""
        left = max(float(self.edges[panel]), annulus.c)
        right = min(float(self.edges[panel + 1]), annulus.a)
        powers = self._cut_powers(panel, annulus, left, right)
        square = (right - left) * (right + left)
        above = (left - r) * (left + r)
        far = int(np.searchsorted(-above, -FAR * square, side="right"))
        total = np.zeros_like(r)
        if powers is None:
            total[:far] = self._by_nodes(panel, annulus, left, above[:far])
        else:
            total[:far] = powers.from_afar(above[:far], self.accuracy)
        near = slice(far, int(np.searchsorted(r, right)))
        if near.start < near.stop:
            every = np.full(near.stop - far, panel)
            at, infinite = self._off_axis(every, r[near], annulus.c)
            if powers is None:
                total[near] = self._by_rule(every, at, annulus, rtol)
            else:
                total[near] = powers.chosen(np.zeros_like(every)).integrals(at)
            total[near][infinite] = np.inf
        return total

    def _cut_powers(
        self, panel: int, annulus: _Annulus, left: float, right: float
    ) -> PowerPanels | None:
        """A panel's part between two radii in powers of its own; None where they are no good."""
        powers = self._powers.chosen(np.array([panel])).cut(right)
        if powers.known[0] and left > self.edges[panel]:
            # Of a narrow annulus the width has digits that its ends have not.
            miss = abs((annulus.a - annulus.c) - annulus.width)
            if right == annulus.a and miss > _SAME * self.accuracy * annulus.width:
                return None
            powers = powers.begun(left, _ANEW * self.accuracy)
        return powers if powers.known[0] else None

    def _by_nodes(self, panel: int, annulus: _Annulus, left: float, above: Array) -> Array:
        """Fixed nodes on a part of a panel for all points far below it, `above` = left^2 - r^2."""
        pieces = np.arange(self._first[panel], self._first[panel + 1])
        low, _, span, _ = self._part(pieces, annulus)
        steps, masses = self._nodes(pieces, low, span, _FAR_NODES)
        bottom = leg(np.asarray(left), self.base[pieces])
        gaps = ((low - bottom)[:, None] + steps) * ((low + bottom)[:, None] + steps)
        total = np.zeros_like(above)
        for piece in np.flatnonzero(span > 0):
            root = above[:, None] + gaps[piece]
            np.sqrt(root, out=root)
            total += np.divide(1.0, root, out=root) @ masses[piece]
        return total

    def _part(self, piece: Indices, annulus: _Annulus) -> tuple[Array, Array, Array, Array]:
        """Where the annulus begins and ends in each piece, its length, and its end as a radius."""
        base, start, stop = self.base[piece], self.start[piece], self.stop[piece]
        leg_a, leg_c = leg(np.asarray(annulus.a), base), leg(np.asarray(annulus.c), base)
        low, high = np.maximum(start, leg_c), np.minimum(stop, leg_a)
        cut_twice = (low == leg_c) & (high == leg_a) & (leg_c > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            width = annulus.width * (annulus.a + annulus.c) / (leg_a + leg_c)
        span = np.where(cut_twice, width, np.maximum(high - low, 0.0))
        return low, high, span, np.where(high == leg_a, annulus.a, self._ends[piece])

    def _nodes(self, piece: Indices, low: Array, span: Array, count: int) -> tuple[Array, Array]:
        """Gauss' nodes of pieces from `low` on, as steps from there, and the masses G dx."""
        nodes, weights = gauss_legendre(count)
        steps = np.multiply.outer(span, (1 + nodes) / 2)
        s = low[:, None] + steps
        value = self._regular(piece[:, None], s) * s + self.pole[piece, None]
        return steps, span[:, None] / 2 * weights * value / np.hypot(self.base[piece, None], s)

    def _regular(self, piece: Indices, s: Array) -> Array:
        """G without its pole."""
        start, stop = self.start[piece], self.stop[piece]
        u = np.clip((2 * s - start - stop) / (stop - start), -1, 1)
        rows = np.moveaxis(self.coefficients[piece], -1, 0)
        return np.asarray(chebyshev.chebval(u, rows, tensor=False))

    def _by_rule(self, panel: Indices, r: Array, annulus: _Annulus, rtol: float) -> Array:
        """Two-root rule on the part of each panel that lies in the annulus and above its own r."""
        counts = self._first[panel + 1] - self._first[panel]
        number = np.repeat(np.arange(panel.size), counts)
        piece = (self._first[panel] - np.cumsum(counts) + counts)[number] + np.arange(number.size)
        low, high, span, edge = self._part(piece, annulus)
        leg_r = leg(r[number], self.base[piece])
        # The root at r inside the piece: the rule starts on it, at y = 0, even in y.
        on_root = leg_r >= low
        span = np.where(on_root, high, span)
        begin = np.where(low > self.start[piece], annulus.c, np.hypot(self.base[piece], low))
        used = np.flatnonzero((span > 0) & (high > leg_r))
        piece, number = piece[used], number[used]
        ends = high[used], span[used], edge[used], begin[used]
        values = self._rule(piece, r[number], ends, rtol)
        return np.bincount(number, weights=values, minlength=r.size).astype(float, copy=False)

    def _rule(
        self, piece: Indices, r: Array, ends: tuple[Array, Array, Array, Array], rtol: float
    ) -> Array:
        """Two-root rule on each pair of a piece and a point, from high - span to high in s.

        `ends` are high and span, and the radii that go with the upper and the lower end.
        """
        high, span, edge, begin = ends
        start, stop, pole = self.start[piece], self.stop[piece], self.pole[piece]
        rows = self.coefficients[piece].T

        def weight(x: Array, s: Array, index: Chosen) -> Array:
            u = np.clip((2 * s - (start + stop)[index]) / (stop - start)[index], -1, 1)
            value = chebyshev.chebval(u, rows[:, None, index], tensor=False)
            return np.asarray((value * s + pole[index]) / x)

        return one_sided(
            weight,
            self.base[piece],
            r,
            high,
            width=span,
            edge=edge,
            inner=begin,
            odd=False,
            rtol=rtol,
            analytic=_POLYNOMIALS,
        )
