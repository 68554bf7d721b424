"""Transforms of a slope that is quadratic between the radii of a table, in closed moments.

With r = x cos(alpha), int u^k dr/sqrt(x^2 - r^2) over a panel becomes int u^k dt over
t = alpha(left) - alpha, where u = r - left = S sin t - L (1 - cos t), S = sqrt(x^2 - L^2), and the
moments are elementary. Written in 1 - cos t and t - sin t they do not cancel, however narrow the
panel and however far from the axis. Source: notes, §5.
"""

from dataclasses import dataclass
from math import factorial
from typing import Final

import numpy as np

from mdr_core.abel.panels import Jumps
from mdr_core.lazy import cached_property
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array

_FORCE_POINTS: Final = 12
# Points handled at once, neighbours of each other.
_BLOCK: Final = 64
# So many panels below its own a point sees by their moments; beyond them six nodes a panel leave
# an error of (7 + sqrt(48))^-12, the root being seven half panels away.
_NEAR: Final = 3
_FAR_POINTS: Final = 6
# Panels taken at once: their roots at 64 points stay in cache.
_FAR_BLOCK: Final = 80
_SERIES: Final = 1.0


@dataclass(frozen=True, eq=False)
class TableSlope:
    """F = c0 + c1 u + c2 u^2, u = r - left edge, between `edges` (k + 1); coefficients (3, k)."""

    edges: Array
    coefficients: Array

    def at(self, u: Array, panel: Array) -> Array:
        """F at the offset u in the given panel."""
        c = self.coefficients[:, panel]
        return np.asarray(c[0] + u * (c[1] + u * c[2]))

    @cached_property
    def source(self) -> "TableSlope":
        """(r F)' = F + r F', again quadratic in each panel."""
        left = self.edges[:-1]
        c0, c1, c2 = self.coefficients
        return TableSlope(self.edges, np.stack([c0 + left * c1, 2 * c1 + 2 * left * c2, 3 * c2]))

    def jumps(self, noise: float) -> Jumps:
        """Jumps of F between the panels, but for rounding."""
        width = np.diff(self.edges)
        c = self.coefficients
        right = c[0] + width * (c[1] + width * c[2])
        size = c[0, 1:] - right[:-1]
        terms = np.abs(c[0]) + width * (np.abs(c[1]) + width * np.abs(c[2]))
        real = np.abs(size) > noise * np.maximum(terms[1:], terms[:-1])
        return Jumps(self.edges[1:-1][real], size[real])

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

        `weighted`: of r^2 F. The panels next to a point by their moments, those farther below,
        where the root is smooth, by fixed nodes that all points share.
        """
        x = np.asarray(x, dtype=float)
        base = x.ravel()
        off = np.zeros_like(base) if offset is None else offset.ravel()
        place = base + off
        order = np.argsort(place)
        result = np.empty_like(base)
        for start in range(0, order.size, _BLOCK):
            index = order[start : start + _BLOCK]
            # From the right: a point may lie above an edge by less than its rounding.
            first, last = np.searchsorted(self.edges, place[index[[0, -1]]], side="right")
            near = slice(max(int(first) - 2 - _NEAR, 0), min(int(last), self.edges.size - 1))
            sums = self._weighted_sums if weighted else self._moment_sums
            result[index] = sums(base[index], off[index], near)
            if near.start:
                result[index] += self._far_sums(place[index], near.start, weighted=weighted)
        return result.reshape(x.shape)

    @cached_property
    def _fixed(self) -> tuple[Array, Array]:
        """Nodes and F dr at them, (panels, nodes)."""
        nodes, weights = gauss_legendre(_FAR_POINTS)
        width = np.diff(self.edges)[:, None]
        u = width * (1 + nodes) / 2
        c0, c1, c2 = self.coefficients[:, :, None]
        return self.edges[:-1, None] + u, width / 2 * weights * (c0 + u * (c1 + u * c2))

    def _far_sums(self, x: Array, panels: int, *, weighted: bool) -> Array:
        nodes, values = self._fixed
        total = np.zeros_like(x)
        for start in range(0, panels, _FAR_BLOCK):
            part = slice(start, min(start + _FAR_BLOCK, panels))
            r, weights = nodes[part].ravel(), values[part].ravel()
            if weighted:
                weights = weights * r * r
            root = x[:, None] - r
            root *= x[:, None] + r
            np.sqrt(root, out=root)
            np.divide(1.0, root, out=root)
            total += root @ weights
        return total

    def _geometry(self, base: Array, offset: Array, near: slice) -> tuple[Array, Array]:
        """S and the angle t spanned, (points, near panels)."""
        left, right = self.edges[:-1][near], self.edges[1:][near]
        x = (base + offset)[:, None]
        above = np.maximum((base[:, None] - left) + offset[:, None], 0.0)
        beyond = np.maximum((base[:, None] - right) + offset[:, None], 0.0)
        width = np.minimum(right - left, above)
        high = left + width
        leg, leg_high = np.sqrt(above * (x + left)), np.sqrt(beyond * (x + high))
        with np.errstate(divide="ignore", invalid="ignore"):
            cross = x * (width * (high + left) / (high * leg + left * leg_high))
            span = np.arctan2(cross, (left * high + leg * leg_high) / x)
        return leg, np.where(above > 0, span, 0.0)

    def _moment_sums(self, base: Array, offset: Array, near: slice) -> Array:
        leg, t = self._geometry(base, offset, near)
        left = self.edges[:-1][near]
        c0, c1, c2 = self.coefficients[:, near]
        rise = 2 * np.square(np.sin(t / 2))
        first = leg * rise - left * _lag(t)
        # int sin^2, int sin (1 - cos) and int (1 - cos)^2.
        second = leg * leg * (_lag(2 * t) / 4) - leg * left * rise * rise + left * left * _rise2(t)
        return np.asarray((c0 * t + c1 * first + c2 * second).sum(axis=1))

    def _weighted_sums(self, base: Array, offset: Array, near: slice) -> Array:
        """A trigonometric polynomial of degree four: the rule is exact for it to rounding."""
        leg, span = self._geometry(base, offset, near)
        left = self.edges[:-1][near]
        c0, c1, c2 = self.coefficients[:, near]
        nodes, weights = gauss_legendre(_FORCE_POINTS)
        t = span[:, :, None] * (1 + nodes) / 2
        u = leg[:, :, None] * np.sin(t) - left[:, None] * 2 * np.square(np.sin(t / 2))
        values = c0[:, None] + u * (c1[:, None] + u * c2[:, None])
        values *= np.square(left[:, None] + u)
        return np.asarray((span / 2 * (values @ weights)).sum(axis=1))


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
