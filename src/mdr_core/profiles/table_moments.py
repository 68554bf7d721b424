"""Transforms of a slope that is quadratic between the radii of a table, in closed moments.

With r = x cos(alpha), int u^k dr/sqrt(x^2 - r^2) over a panel becomes int u^k dt over
t = alpha(left) - alpha, where u = r - left = S sin t - L (1 - cos t), S = sqrt(x^2 - L^2), and the
moments are elementary. Written in 1 - cos t and t - sin t they do not cancel, however narrow the
panel and however far from the axis. Source: notes, §5.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial
from typing import Final

import numpy as np

from mdr_core.abel.clusters import Clusters, add, clusters, masses_at_nodes, pairs
from mdr_core.lazy import cached_property
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Indices

_FORCE_POINTS: Final = 12
# Of a quadratic, as clusters see it from afar.
_FAR_POINTS: Final = 24
# Interpolation errs by 7.3^-18: nothing that a later resolution would mistake for structure.
_CLUSTER_NODES: Final = 18
# Rounding of what should be zero, relative to the largest of its kind next to it.
_NOISE: Final = 256 * float(np.finfo(float).eps)
_SERIES: Final = 1.0


@dataclass(frozen=True, eq=False)
class TableSlope:
    """F = c0 + c1 u + c2 u^2, u = r - left edge, between `edges` (k + 1); coefficients (3, k).

    `jumps` (k,): what F' holds of Dirac's kind at each left edge, times its radius.
    """

    edges: Array
    coefficients: Array
    jumps: Array | None = None

    def at(self, u: Array, panel: Array) -> Array:
        """F at the offset u in the given panel."""
        c = self.coefficients[:, panel]
        return np.asarray(c[0] + u * (c[1] + u * c[2]))

    @cached_property
    def source(self) -> "TableSlope":
        """(r F)' = F + r F', again quadratic in each panel but for the jumps of F between them."""
        left = self.edges[:-1]
        c0, c1, c2 = self.coefficients
        rows = np.stack([c0 + left * c1, 2 * c1 + 2 * left * c2, 3 * c2])
        return TableSlope(self.edges, rows, self.steps * left)

    @cached_property
    def steps(self) -> Array:
        """How far F jumps at each left edge, zero where no more than rounding."""
        width = np.diff(self.edges)
        c = self.coefficients
        right = c[0] + width * (c[1] + width * c[2])
        size = np.append(0.0, c[0, 1:] - right[:-1])
        terms = np.abs(c[0]) + width * (np.abs(c[1]) + width * np.abs(c[2]))
        noise = _NOISE * np.append(0.0, np.maximum(terms[1:], terms[:-1]))
        return np.where(np.abs(size) > noise, size, 0.0)

    def first_negative(self, noise: float) -> float | None:
        """Radius where F first falls below zero, but for rounding."""
        low, place = self.minimum()
        bad = low < -noise * np.abs(self.coefficients[0]).max()
        return float(place[bad][0]) if bad.any() else None

    def source_is_positive(self, noise: float) -> bool:
        """(r F)' >= 0 everywhere: enough for g' >= 0, without a transform."""
        low, _ = self.source.minimum()
        return bool((low >= -noise * np.abs(self.source.coefficients[0]).max()).all())

    def minimum(self) -> tuple[Array, Array]:
        """Smallest value of each panel's quadratic, and where."""
        width = np.diff(self.edges)
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
        nodes, weights = gauss_legendre(_FAR_POINTS)
        width = right - left
        u = width * (1 + nodes) / 2
        c0, c1, c2 = self.coefficients[:, :, None]
        values = weigh(left + u, c0 + u * (c1 + u * c2)) * (width / 2 * weights)
        v = (width - u) * (right + left + u) / (width * (right + left))
        if self.jumps is not None and self.jumps.any():
            v = np.append(v, np.ones_like(left), axis=1)
            values = np.append(values, self.jumps[:, None], axis=1)
        return clusters(self.edges, masses_at_nodes(v, values, _CLUSTER_NODES), above=True)

    def _geometry(self, panel: Indices, base: Array, offset: Array) -> tuple[Array, Array, Array]:
        """Left edge, S and the angle t spanned by each panel, seen from its own point."""
        left, right = self.edges[panel], self.edges[panel + 1]
        x = base + offset
        above = np.maximum((base - left) + offset, 0.0)
        beyond = np.maximum((base - right) + offset, 0.0)
        # Over x: the square of a radius may be no double.
        unit = np.where(x > 0, x, 1.0)
        low, width = left / unit, np.minimum(right - left, above) / unit
        high = low + width
        leg, leg_high = np.sqrt(above / unit * (1 + low)), np.sqrt(beyond / unit * (1 + high))
        with np.errstate(divide="ignore", invalid="ignore"):
            cross = width * (high + low) / (high * leg + low * leg_high)
            span = np.arctan2(cross, low * high + leg * leg_high)
        return left, leg * unit, np.where(above > 0, span, 0.0)

    def _moments(self, panel: Indices, base: Array, offset: Array) -> Array:
        left, leg, t = self._geometry(panel, base, offset)
        c0, c1, c2 = self.coefficients[:, panel]
        rise = 2 * np.square(np.sin(t / 2))
        first = leg * rise - left * _lag(t)
        # int sin^2, int sin (1 - cos) and int (1 - cos)^2.
        second = leg * leg * (_lag(2 * t) / 4) - leg * left * rise * rise + left * left * _rise2(t)
        total = c0 * t + c1 * first + c2 * second
        if self.jumps is not None and self.jumps.any():
            seen = (leg > 0) & (base != left)
            total[seen] += self.jumps[panel[seen]] / leg[seen]
        return np.asarray(total)

    def _weighted_moments(self, panel: Indices, base: Array, offset: Array) -> Array:
        """A trigonometric polynomial of degree four: the rule is exact for it to rounding."""
        left, leg, span = self._geometry(panel, base, offset)
        c0, c1, c2 = self.coefficients[:, panel]
        nodes, weights = gauss_legendre(_FORCE_POINTS)
        t = np.multiply.outer((1 + nodes) / 2, span)
        u = leg * np.sin(t) - left * 2 * np.square(np.sin(t / 2))
        values = c0 + u * (c1 + u * c2)
        values *= np.square(left + u)
        return np.asarray(span / 2 * (weights @ values))


def _series(t2: Array, coefficients: tuple[float, ...]) -> Array:
    value: Array = np.full_like(t2, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        value = value * t2 + coefficient
    return value


# t - sin t = t^3 sum, and int (1 - cos)^2 = 3t/2 - 2 sin t + sin(2t)/4 = t^5 sum.
_LAG: Final = tuple((-1.0) ** k / factorial(2 * k + 3) for k in range(9))
_RISE2: Final = tuple(
    (-1.0) ** k * (-2 + 4.0 ** (k + 2) / 2) / factorial(2 * k + 5) for k in range(14)
)


def _lag(t: Array) -> Array:
    """t - sin t, with its digits."""
    small = np.minimum(t, _SERIES)
    t2 = small * small
    return np.where(t < _SERIES, small * t2 * _series(t2, _LAG), t - np.sin(t))


def _rise2(t: Array) -> Array:
    """int_0^t (1 - cos)^2, with its digits."""
    small = np.minimum(t, _SERIES)
    t2 = small * small
    direct = 1.5 * t - 2 * np.sin(t) + np.sin(2 * t) / 4
    return np.asarray(np.where(t < _SERIES, small * t2 * t2 * _series(t2, _RISE2), direct))
