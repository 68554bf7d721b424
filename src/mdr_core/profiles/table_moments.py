"""Transforms of a slope that is quadratic between the radii of a table, in closed moments.

Next to a point, int u^k dr/sqrt(x^2 - r^2) over a panel, u = r - left, is what the same polynomial
gives from the panel's left end to x less what it gives from its right end. With u = (x - left) y
each of them has the weight 1/sqrt(1 - y) and a smooth rest, all of one sign: it does not cancel,
however narrow the panel and however far from the axis. Source: notes, §5.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np

from mdr_core.abel.clusters import Clusters, add, clusters, masses_at_nodes, nodes_for, pairs
from mdr_core.lazy import cached_property
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Indices

# Interpolation errs by 7.3^-14 of the part of a block: nothing that a later bisection would take
# for structure.
_CLUSTER_NODES: Final = 14
# So many more has the rule by which clusters see a quadratic from afar.
_MORE: Final = 2
# Of the rule next to a point 2 x 10 points leave 5.8^-20, panels off the axis far less: as many
# as two thirds of the nodes of a cluster are always enough.
_PART: Final = 3
# Of a quadratic times r^2.
_POWERS: Final = 5
# Rounding of what should be zero, relative to the largest of its kind next to it.
_NOISE: Final = 256 * float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class TableSlope:
    """F = c0 + c1 u + c2 u^2, u = r - left edge, between `edges` (k + 1); coefficients (3, k).

    `jumps` (k,): what F' holds of Dirac's kind at each left edge, times its radius. `nodes`: of a
    block of panels that is seen from afar.
    """

    edges: Array
    coefficients: Array
    jumps: Array | None = None
    nodes: int = _CLUSTER_NODES

    def to(self, accuracy: float) -> "TableSlope":
        """The same, transformed to no more than this accuracy."""
        return replace(self, nodes=min(nodes_for(accuracy), _CLUSTER_NODES))

    def at(self, u: Array, panel: Array) -> Array:
        """F at the offset u in the given panel."""
        c = self.coefficients[:, panel]
        return np.asarray(c[0] + u * (c[1] + u * c[2]))

    @cached_property
    def source(self) -> "TableSlope":
        """(r F)' = F + r F', again quadratic in each panel but for the jumps of F between them."""
        left = self.edges[:-1]
        c0, c1, c2 = self.coefficients
        rows = np.empty(self.coefficients.shape)
        rows[0] = c0 + left * c1
        rows[1] = 2 * (c1 + left * c2)
        rows[2] = 3 * c2
        return TableSlope(self.edges, rows, self.steps * left)

    @cached_property
    def _width(self) -> Array:
        return self.edges[1:] - self.edges[:-1]

    @cached_property
    def _at_right(self) -> Array:
        """F at each right edge, from the left."""
        c0, c1, c2 = self.coefficients
        return np.asarray(c0 + self._width * (c1 + self._width * c2))

    @cached_property
    def steps(self) -> Array:
        """How far F jumps at each left edge, zero where no more than rounding."""
        c0, c1, c2 = np.abs(self.coefficients)
        terms = c0 + self._width * (c1 + self._width * c2)
        size = np.zeros(self._width.size)
        size[1:] = self.coefficients[0, 1:] - self._at_right[:-1]
        size[1:][np.abs(size[1:]) <= _NOISE * np.maximum(terms[1:], terms[:-1])] = 0.0
        return size

    def kinks(self) -> Array:
        """How large a part of the transform begins anew at each left edge, relative to it.

        Within a panel's width: that of F's jump and of its polynomial's change there.
        """
        left, width = self.edges[1:-1], self._width[1:]
        c0, c1, c2 = self.coefficients
        before = self._width[:-1]
        change = np.abs(c2[1:] - c2[:-1]) * width
        change += np.abs(c1[1:] - (c1[:-1] + 2 * before * c2[:-1]))
        change *= width
        change += np.abs(c0[1:] - self._at_right[:-1])
        change *= 2
        if self.jumps is not None:
            change += np.abs(self.jumps[1:]) / width
        with np.errstate(divide="ignore", invalid="ignore"):
            change /= np.abs(c0[1:])
        change *= np.sqrt(width / (2 * left))
        return np.append(0.0, np.fmax(change, 0.0))

    def first_negative(self, noise: float) -> float | None:
        """Radius where F first falls below zero, but for rounding."""
        if self._surely_positive(noise):
            return None
        low, place = self._minimum()
        bad = low < -noise * np.abs(self.coefficients[0]).max()
        return float(place[bad][0]) if bad.any() else None

    def source_is_positive(self, noise: float) -> bool:
        """(r F)' >= 0 everywhere: enough for g' >= 0, without a transform."""
        return self.source.first_negative(noise) is None

    def _surely_positive(self, noise: float) -> bool:
        """Whether each quadratic is, by its coefficients in Bernstein's polynomials."""
        c0, c1, _ = self.coefficients
        middle = c0 + self._width / 2 * c1
        least = min(float(part.min()) for part in (c0, middle, self._at_right))
        return bool(least >= -noise * np.abs(c0).max())

    def _minimum(self) -> tuple[Array, Array]:
        """Smallest value of each panel's quadratic, and where."""
        width = self._width
        c0, c1, c2 = self.coefficients
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = np.where(c2 > 0, -c1 / (2 * c2), width)
        u = np.stack([np.zeros_like(width), np.clip(turn, 0, width), width])
        values = c0 + u * (c1 + u * c2)
        lowest = values.argmin(axis=0)
        panel = np.arange(width.size)
        return values[lowest, panel], self.edges[:-1] + u[lowest, panel]

    def transform(self, x: Array, offset: Array | None = None, *, weighted: bool = False) -> Array:
        """Return int_0^x F dr/sqrt(x^2 - r^2), at x + offset where an offset is given.

        The jump at x itself is left out, whatever the offset. `weighted`: of r^2 F. The panels
        next to a point by their moments, those farther below in clusters.
        """
        x = np.asarray(x, dtype=float)
        base = x.ravel()
        shift = None if offset is None else offset.ravel()
        place = base if shift is None else base + shift
        if bool((place[1:] >= place[:-1]).all()):
            return self._ascending(base, shift, place, weighted=weighted).reshape(x.shape)
        order = np.argsort(place)
        result = np.empty_like(base)
        shift = None if shift is None else shift[order]
        result[order] = self._ascending(base[order], shift, place[order], weighted=weighted)
        return result.reshape(x.shape)

    def _ascending(
        self, base: Array, offset: Array | None, place: Array, *, weighted: bool
    ) -> Array:
        afar = self._weighted_clusters if weighted else self._clusters
        low, high = afar.far_from(place, afar.usable(0, self.edges.size))
        total = afar.sums(base, offset, low, high)
        moments = self._weighted_moments if weighted else self._moments
        # A point may lie above an edge by less than the edge's rounding.
        begin = np.searchsorted(place, self.edges[:-1])
        end = np.maximum(low[: begin.size], begin)
        for panel, point in pairs(begin, end):
            shift = np.zeros(point.size) if offset is None else offset[point]
            add(total, point, moments(panel, base[point], shift))
        return total

    @cached_property
    def _clusters(self) -> Clusters:
        return self._seen_from_above(lambda r, values: values)

    @cached_property
    def _weighted_clusters(self) -> Clusters:
        return self._seen_from_above(lambda r, values: values * r * r)

    def _seen_from_above(self, weigh: Callable[[Array, Array], Array]) -> Clusters:
        """Whole panels, as they are seen from larger radii afar."""
        left, right = self.edges[:-1, None], self.edges[1:, None]
        nodes, weights = gauss_legendre(self.nodes + _MORE)
        width = right - left
        u = width * (1 + nodes) / 2
        c0, c1, c2 = self.coefficients[:, :, None]
        values = weigh(left + u, c0 + u * (c1 + u * c2)) * (width / 2 * weights)
        v = (width - u) * (right + left + u) / (width * (right + left))
        if self.jumps is not None and self.jumps.any():
            v = np.append(v, np.ones_like(left), axis=1)
            values = np.append(values, self.jumps[:, None], axis=1)
        return clusters(self.edges, masses_at_nodes(v, values, self.nodes), above=True)

    def _moments(self, panel: Indices, base: Array, offset: Array) -> Array:
        total = self._seen(self.coefficients[:, panel], panel, base, offset)
        if self.jumps is not None and self.jumps.any():
            left = self.edges[panel]
            above = (base - left) + offset
            seen = (above > 0) & (base != left)
            gap = above[seen]
            total[seen] += self.jumps[panel[seen]] / np.sqrt(gap) / np.sqrt(2 * left[seen] + gap)
        return total

    def _weighted_moments(self, panel: Indices, base: Array, offset: Array) -> Array:
        left = self.edges[panel]
        return self._seen(_times_square(self.coefficients[:, panel], left), panel, base, offset)

    def _seen(self, powers: Array, panel: Indices, base: Array, offset: Array) -> Array:
        """A polynomial in each panel, as far as it lies below the panel's own point."""
        left, right = self.edges[panel], self.edges[panel + 1]
        rule = _rule(self.nodes - self.nodes // _PART)
        total = _reach(powers, left, np.maximum((base - left) + offset, 0.0), rule)
        beyond = (base - right) + offset
        over = np.flatnonzero(beyond > 0)
        # The polynomial goes on; what is too much is no larger than what is left.
        moved = _moved(powers.take(over, axis=1), (right - left)[over])
        total[over] -= _reach(moved, right[over], beyond[over], rule)
        return total


@lru_cache(maxsize=16)
def _rule(points: int) -> tuple[Array, Array]:
    """Nodes of int_0^1 y^n h(y)/sqrt(1 - y) dy, and weights for n = 0 to 4, (5, points)."""
    nodes, weights = gauss_legendre(2 * points)
    y = 1 - np.square(nodes[points:])
    return y, 2 * weights[points:] * y ** np.arange(_POWERS)[:, None]


def _reach(powers: Array, left: Array, above: Array, rule: tuple[Array, Array]) -> Array:
    """int_left^x sum_n c_n (r - left)^n dr/sqrt(x^2 - r^2), x = left + above.

    With r = left + y above the other root is that of 2 left + above (1 + y), smooth in y.
    """
    nodes, weights = rule
    span = 2 * left + above
    part = above / np.where(span > 0, span, 1.0)
    root = np.multiply.outer(nodes, part)
    root += 1
    np.sqrt(root, out=root)
    np.divide(1.0, root, out=root)
    terms = weights[: len(powers)] @ root
    terms *= powers
    total: Array = np.zeros_like(above)
    for term in terms[::-1]:
        total *= above
        total += term
    total *= np.sqrt(part)
    return total


def _moved(powers: Array, step: Array) -> Array:
    """The polynomials in the distance from a place that lies `step` further."""
    rows = powers.copy()
    for lowest in range(len(rows) - 1):
        for n in range(len(rows) - 2, lowest - 1, -1):
            rows[n] += step * rows[n + 1]
    return rows


def _times_square(powers: Array, left: Array) -> Array:
    """The polynomials times (left + u)^2."""
    rows = np.zeros((powers.shape[0] + 2, left.size))
    rows[:-2] = left * left * powers
    rows[1:-1] += 2 * left * powers
    rows[2:] += powers
    return rows
