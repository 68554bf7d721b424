"""Integrals of a slope g' that is given by polynomials between knots.

Depth, force and energy are sums of closed integrals. An integral with a root at r is taken piece
by piece: by Gauss's rule in x on pieces whose distance from r is at least twice their length, and
next to r in the angle that removes the root,

    x = r cosh y    for 1/sqrt(x^2 - r^2),        x = r cos y    for functions of sqrt(r^2 - x^2),

in which a polynomial is an entire function. On the piece next to the axis the moments of
1/sqrt(x^2 - r^2) are closed. Lengths of pieces are carried, not differences of their ends, so that
an annulus may be as narrow as its width is accurate.

Source: notes, §5.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from scipy import sparse
from scipy.interpolate import PPoly

from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array, Indices

# K(x, sqrt(r^2 - x^2)), by which the slope is multiplied.
Kernel = Callable[[Array, Array], Array]

# Distance of a piece from r, over its length, from which Gauss's rule in x converges as 9.9^-2n.
_FAR: Final = 2.0
# Nodes there: they leave 1e-11 of the roughest piece, and 1e-16 of a smooth one.
_FAR_NODES, _FAR_WEIGHTS = composite_rule(8)
# Nodes of a piece next to r. The integrand is entire, of degree six at most in the angle.
_NEAR_NODES, _NEAR_WEIGHTS = composite_rule(16)
# Sorted radii that share their far pieces.
_BLOCK: Final = 16
# Radii whose near pieces are held at once: 40 MiB.
_MANY: Final = 16_384
# Ratio of the ends of a piece above which it is divided, so that its angle stays short.
_RATIO: Final = 2.0
# Least denominator.
_LEAST: Final = float(np.finfo(float).tiny)
# Distance from the axis, over the first piece, within which a smooth stress is constant.
_AXIS: Final = 1e-8


@dataclass(frozen=True)
class _Parts:
    """Pieces between two radii, cut at both."""

    left: Array
    """Lower ends [length], shape (n,)."""
    length: Array
    """Lengths [length], shape (n,)."""
    piece: Indices
    """Piece of the slope that each part belongs to, shape (n,)."""
    offset: Array
    """Distance of the lower end from that of its piece [length], shape (n,)."""

    @property
    def right(self) -> Array:
        return self.left + self.length


@dataclass(frozen=True, eq=False)
class SlopePieces:
    """Slope g' as a polynomial in u = x - left edge on each piece, positive."""

    edges: Array
    """Knots, ascending from the axis [length], shape (k + 1,)."""
    rows: Array
    """Coefficients of the powers of u, from 0 on, shape (n, k)."""

    @property
    def smooth_tip(self) -> bool:
        """True if the slope vanishes on the axis: the stress there is finite."""
        return bool(self.rows[0, 0] == 0)

    def _located(self, x: Array) -> tuple[Indices, Array]:
        """Piece of each place and the distance from its left edge."""
        piece = self.edges[1:-1].searchsorted(x, side="right")
        return piece, x - self.edges[piece]

    def _polynomial(self, rows: Array, piece: Indices, u: Array) -> Array:
        """Value of the polynomials of the pieces (m,) at u (..., m), by Horner's rule."""
        value = rows[-1][piece]
        for row in rows[-2::-1]:
            value = value * u + row[piece]
        return np.asarray(value)[()]

    @cached_property
    def _slope(self) -> PPoly:
        return PPoly(self.rows[::-1], self.edges)

    @cached_property
    def _depth(self) -> PPoly:
        return self._slope.antiderivative()

    @cached_property
    def _half_force(self) -> PPoly:
        moment = np.pad(self.edges[:-1] * self.rows, ((0, 1), (0, 0)))
        moment[1:] += self.rows
        return PPoly(moment[::-1], self.edges).antiderivative()

    @cached_property
    def _energy(self) -> PPoly:
        half_force = self._half_force.c[::-1]
        product = np.zeros((len(self.rows) + len(half_force) - 1, self.edges.size - 1))
        for power, row in enumerate(self.rows):
            product[power : power + len(half_force)] += 2 * row * half_force
        return PPoly(product[::-1], self.edges).antiderivative()

    @cached_property
    def _over_axis(self) -> Array:
        """Axial stress up to each edge, shape (k + 1,)."""
        every = np.arange(self.edges.size - 1)
        return np.append(0.0, np.cumsum(self._over_axis_in(every, np.diff(self.edges))))

    def _over_axis_in(self, piece: Indices, u: Array) -> Array:
        """int g'/x dx; next to the axis without the constant of a sharp tip."""
        at = _NEAR_NODES[:, None] * u
        first = piece == 0
        rest = self._polynomial(self.rows[1:], piece, at)
        beyond = self._polynomial(self.rows, piece, at) / (self.edges[piece] + at + first)
        return u * (_NEAR_WEIGHTS @ np.where(first, rest, beyond))

    def slope(self, x: Array) -> Array:
        """g'(x) [1]."""
        return self._slope(x)[()]

    def depth(self, x: Array) -> Array:
        """g(x) = int_0^x g' [length]."""
        return self._depth(x)[()]

    def half_force(self, x: Array) -> Array:
        """int_0^x t g'(t) dt [length^2]."""
        return self._half_force(x)[()]

    def energy(self, x: Array) -> Array:
        """int_0^x (g(x) - g)^2 dt = 2 int (half force) g' dt [length^3]."""
        return self._energy(x)[()]

    def over_axis(self, x: Array) -> Array:
        """int_0^x g'(t)/t dt of a smooth tip [1]."""
        piece, u = self._located(np.ravel(x))
        return (self._over_axis[piece] + self._over_axis_in(piece, u)).reshape(np.shape(x))[()]

    def _parts(self, low: float, high: float, width: float) -> _Parts:
        """Pieces from `low` to `high` = low + width; long ones that start near the axis divided."""
        inner = self.edges[(self.edges > low) & (self.edges < high)]
        ends = np.concatenate([[low], inner, [high]])
        long = np.flatnonzero((ends[1:] > _RATIO * ends[:-1]) & (ends[:-1] > 0))
        if long.size:
            counts = np.ceil(np.log(ends[long + 1] / ends[long]) / np.log(_RATIO)).astype(int)
            steps = [ends[i] * _RATIO ** np.arange(1, n) for i, n in zip(long, counts, strict=True)]
            ends = np.sort(np.concatenate([ends, *steps]))
        length = np.diff(ends) if ends.size > 2 else np.array([width])
        piece = self.edges[1:-1].searchsorted(ends[:-1], side="right")
        return _Parts(ends[:-1], length, piece, ends[:-1] - self.edges[piece])

    def _nodes(self, parts: _Parts) -> tuple[Array, Array]:
        """Nodes of Gauss's rule on all parts, and weights times g', shape (n, nodes)."""
        u = parts.length[:, None] * _FAR_NODES
        value = self._polynomial(self.rows, parts.piece, (parts.offset[:, None] + u).T).T
        return parts.left[:, None] + u, value * (parts.length[:, None] * _FAR_WEIGHTS)

    def stress(self, low: float, high: float, width: float, r: Array) -> Array:
        """Return int_max(r,low)^high g'(x)/sqrt(x^2 - r^2) dx at radii r < high.

        Parameters
        ----------
        low, high, width : ends c and a of the annulus, and a - c as accurate as it is narrow.
        r : radii [length], shape (m,).
        """
        if r.size > _MANY:
            blocks = np.array_split(r, -(-r.size // _MANY))
            return np.concatenate([self.stress(low, high, width, block) for block in blocks])
        if low == 0 and self.smooth_tip:
            r = np.maximum(r, _AXIS * min(self.edges[1], high))
        parts, total = self._parts(low, high, width), np.zeros_like(r)
        order = np.argsort(r, kind="stable")
        at = r[order]
        x, weight = (part.ravel() for part in self._nodes(parts))
        # First part from which on all are far.
        reach = np.minimum.accumulate((parts.left - _FAR * parts.length)[::-1])[::-1]
        square, count = x * x, _FAR_NODES.size
        near: list[tuple[int, int, int]] = []
        for start in range(0, at.size, _BLOCK):
            block = at[start : start + _BLOCK]
            far = int(reach.searchsorted(block[-1]))
            root = np.sqrt(square[far * count :] - (block * block)[:, None])
            total[order[start : start + _BLOCK]] = (1 / root) @ weight[far * count :]
            near.append((start, int(parts.right.searchsorted(block[0], side="right")), far))
        point, part = _pairs(near, at.size)
        point = order[point]
        seen = parts.right[part] > r[point]
        point, part = point[seen], part[seen]
        np.add.at(total, point, self._near_stress(parts, part, r[point]))
        return total

    def _near_stress(self, parts: _Parts, part: Indices, r: Array) -> Array:
        """Parts next to their radii, in y with x = r cosh y."""
        left, length = parts.left[part], parts.length[part]
        # A radius inside a part cuts it.
        past = np.maximum(r - left, 0.0)
        x, length = left + past, length - past
        right = x + length
        root_x, root_right = np.sqrt((x - r) * (x + r)), np.sqrt((right - r) * (right + r))
        from_axis = left == 0
        span = np.arcsinh(
            length * (right + x) / np.maximum(root_right * x + root_x * right, _LEAST)
        )
        y = _NEAR_NODES[:, None] * np.where(from_axis, 0.0, span)
        half = np.sinh(y / 2)
        u = root_x * np.sinh(y) + 2 * x * half * half
        value = self._polynomial(self.rows, parts.piece[part], (parts.offset[part] + past) + u)
        result = np.asarray(span * (_NEAR_WEIGHTS @ value))
        if from_axis.any():
            # Closed moments int x^n/sqrt(x^2 - r^2) dx: sums of positive terms.
            a, s, r2 = right[from_axis], root_right[from_axis], np.square(r[from_axis])
            moments = [np.log((a + s) / np.maximum(r[from_axis], _LEAST)), s]
            for n in range(2, len(self.rows)):
                moments.append((a ** (n - 1) * s + (n - 1) * r2 * moments[n - 2]) / n)
            result[from_axis] = sum(
                row * m for row, m in zip(self.rows[:, 0], moments, strict=True)
            )
            if not self.smooth_tip:
                result[from_axis & (r == 0)] = np.inf
        return result

    def under(self, low: float, high: float, r: Array, kernel: Kernel) -> Array:
        """Return int_low^min(high,r) g'(x) K(x, sqrt(r^2 - x^2)) dx at radii r > low.

        Parameters
        ----------
        low, high : ends [length].
        r : radii [length], shape (m,).
        kernel : K.
        """
        total, order = np.zeros_like(r), np.argsort(r, kind="stable")
        at = r[order]
        parts = self._parts(low, high, high - low)
        x, weight = (part.ravel() for part in self._nodes(parts))
        # Last part up to which all are far.
        reach = np.maximum.accumulate(parts.right + _FAR * parts.length)
        count = _FAR_NODES.size
        near: list[tuple[int, int, int]] = []
        for start in range(0, at.size, _BLOCK):
            block = at[start : start + _BLOCK, None]
            far = int(reach.searchsorted(block[0, 0], side="right"))
            own = x[: far * count]
            if far:
                root = np.sqrt((block - own) * (block + own))
                total[order[start : start + _BLOCK]] = kernel(own, root) @ weight[: far * count]
            near.append((start, far, int(parts.left.searchsorted(block[-1, 0]))))
        point, part = _pairs(near, at.size)
        point = order[point]
        seen = parts.left[part] < r[point]
        point, part = point[seen], part[seen]
        left, radius = parts.left[part], r[point]
        gap = radius - left
        inside = np.minimum(parts.length[part], gap)
        values = self._near_under(parts, part, radius, gap, inside, [kernel])[0]
        np.add.at(total, point, values)
        return total

    def annulus(self, low: float, width: float, kernels: Sequence[Kernel]) -> list[float]:
        """Return int_low^r g'(x) K(x, sqrt(r^2 - x^2)) dx, r = low + width, for each kernel K.

        Parameters
        ----------
        low, width : inner radius and width, as accurate as it is narrow [length].
        kernels : K of each integral.
        """
        parts = self._parts(low, low + width, width)
        every = np.arange(parts.left.size)
        gap = width - (parts.left - low)
        radius = np.full(every.shape, low + width)
        inside = np.minimum(parts.length, gap)
        return [
            float(values.sum())
            for values in self._near_under(parts, every, radius, gap, inside, kernels)
        ]

    def _near_under(
        self,
        parts: _Parts,
        part: Indices,
        r: Array,
        gap: Array,
        length: Array,
        kernels: Sequence[Kernel],
    ) -> list[Array]:
        """Parts below their radii, in the angle y with x = r cos y.

        `gap` is the distance of the lower end from the radius, `length` that of both ends.
        """
        left = parts.left[part]
        root = np.sqrt(gap * (r + left))
        rest, right = gap - length, left + length
        root_right = np.sqrt(rest * (r + right))
        sine = length * (right + left) / (right * root + left * root_right)
        span = np.arctan2(sine, (left * right + root * root_right) / (r * r))
        y = _NEAR_NODES[:, None] * span
        half = np.sin(y / 2)
        u = root * np.sin(y) - 2 * left * half * half
        height = np.maximum(root * np.cos(y) - left * np.sin(y), 0.0)
        slope = self._polynomial(self.rows, parts.piece[part], parts.offset[part] + u) * height
        x = left + u
        return [
            np.asarray(span * (_NEAR_WEIGHTS @ (slope * kernel(x, height)))) for kernel in kernels
        ]


def _pairs(ranges: Sequence[tuple[int, int, int]], size: int) -> tuple[Indices, Indices]:
    """Return the pairs of points and parts of blocks that share the parts first <= i < last."""
    points, parts = [np.empty(0, dtype=int)], [np.empty(0, dtype=int)]
    for start, first, last in ranges:
        block = np.arange(start, min(start + _BLOCK, size))
        points.append(np.repeat(block, max(last - first, 0)))
        parts.append(np.tile(np.arange(first, last), block.size))
    return np.concatenate(points), np.concatenate(parts)


def heights(knots: Array, r: Array, basis: Callable[[Array], Any]) -> Array:
    """Return f(r_i) = (2/pi) int_0^r_i B_j(x) arccos(x/r_i) dx of every function B_j of a basis.

    Source: mdr-5, Eq. (5.75), by parts.

    Parameters
    ----------
    knots : radii between which the functions are polynomials, from 0 on [length].
    r : radii up to the last knot, ascending [length], shape (m,).
    basis : values of all functions at places (n,), as a sparse matrix (n, functions).
    """
    left, length = knots[:-1], np.diff(knots)
    inside = left < r[:, None]
    far = inside & (r[:, None] - knots[1:] >= _FAR * length)
    point, part = np.nonzero(far)
    x = left[:, None] + length[:, None] * _FAR_NODES
    at = x[part]
    root = np.sqrt((r[point, None] - at) * (r[point, None] + at))
    table = np.zeros((r.size, left.size, _FAR_NODES.size))
    table[point, part] = np.arctan2(root, at) * (length[part, None] * _FAR_WEIGHTS)
    total = table.reshape(r.size, -1) @ basis(x.ravel())
    point, part = np.nonzero(inside & ~far)
    radius, low = r[point], left[part]
    high = np.minimum(low + length[part], radius)
    first, last = (np.arccos(end / radius) for end in (low, high))
    angle = last + (first - last) * _NEAR_NODES[:, None]
    weight = _NEAR_WEIGHTS[:, None] * (first - last) * radius * np.sin(angle) * angle
    places = np.clip(radius * np.cos(angle), low, high)
    shape = (r.size, places.size)
    spread = sparse.csr_matrix(
        (weight.ravel(), (np.tile(point, _NEAR_NODES.size), np.arange(places.size))), shape=shape
    )
    near = spread @ basis(places.ravel())
    return np.asarray(2 / np.pi * (total + near.toarray()))
