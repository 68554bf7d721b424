"""Integrals of a slope g' that is given by polynomials between knots.

Depth, force and energy are sums of closed integrals. An integral with a root at r is taken piece
by piece: by Gauss's rule in x on pieces whose distance from r is at least twice their length, and
next to r in w, x = r +- w^2, which removes the root. Each piece stores its length, not only its
ends, so that a narrow annulus keeps the accuracy of its width.

Source: notes, §5.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from scipy import sparse
from scipy.interpolate import PPoly

from mdr_core.abel.annulus import Annulus, log_ratio
from mdr_core.abel.displacement import Kernel, arccosine
from mdr_core.doubles import EPS
from mdr_core.elementwise import in_blocks
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array

# Distance of a piece from r, over its length, from which Gauss's rule in x converges as 9.9^-2n.
_FAR: Final = 2.0
# Nodes on far pieces: the error is 1e-11 on the roughest piece, and 1e-16 on a smooth one.
_FAR_NODES, _FAR_WEIGHTS = composite_rule(8)
# Rules for a piece next to r: beyond r (1), and within r (-1), where the pole x = -r is nearer.
_NEAR: Final = {1: composite_rule(12), -1: composite_rule(16)}
# Number of sorted radii whose far pieces are merged.
_BLOCK: Final = 64


def integrals(
    slope: Callable[[Array], Any], left: Array, length: Array, r: Array, kernel: Kernel, sign: int
) -> Array:
    """Return int g'(x) K dx over the pieces beyond each radius, or within it.

    Parameters
    ----------
    slope : g' at places (n,), or several g' as a sparse matrix (n, k).
    left, length : lower ends and lengths of the pieces, ascending [length].
    r : radii [length], shape (m,).
    kernel : K.
    sign : 1 for x > r, no piece of which is longer than its distance from the axis; -1 for x < r.

    Returns
    -------
    Array of shape (m,) or (m, k).
    """
    if len(several := in_blocks(r.size)) > 1:
        found = [integrals(slope, left, length, r[block], kernel, sign) for block in several]
        return np.concatenate(found)
    order = np.argsort(sign * r, kind="stable")
    at = r[order, None]
    x = (left[:, None] + length[:, None] * _FAR_NODES).ravel()
    weighted = sparse.diags((length[:, None] * _FAR_WEIGHTS).ravel()) @ slope(x)
    inner, outer = (left, left + length)[::sign]
    # In this order of radii a piece is far from all radii before its limit.
    limit = sign * inner - _FAR * length
    limits, squares = limit.repeat(_FAR_NODES.size), sign * (x * x)
    total = np.zeros((r.size, *weighted.shape[1:]))
    for start in range(0, r.size, _BLOCK):
        index = slice(start, start + _BLOCK)
        block = at[index]
        seen = limits >= sign * block[0]
        far = sign * block <= limits[seen]
        root = np.sqrt(np.where(far, squares[seen] - sign * (block * block), 1.0))
        total[index] = (kernel(x[seen], root) * far) @ weighted[seen]
    near = (sign * at > limit) & (sign * (outer - at) > 0)
    point, piece = np.divmod(np.flatnonzero(near), left.size)
    at = at[point, 0]
    distance = np.maximum(sign * (inner[piece] - at), 0.0)
    reach = np.minimum(length[piece], sign * (outer[piece] - at))
    places, root, weight = near_rule(at, distance, reach, sign)
    # Next to an end rounding error may lead beyond it, where a spline is not defined, or to x = 0.
    low, high = left + EPS * length, left + length
    places = np.clip(places, low[piece, None], high[piece, None])
    values = (weight * kernel(places, root)).ravel()
    ends = weight.shape[1] * np.searchsorted(point, np.arange(r.size + 1))
    spread = sparse.csr_matrix((values, np.arange(values.size), ends), (r.size, values.size))
    rest: Any = spread @ slope(places.ravel())
    total += rest if isinstance(rest, np.ndarray) else rest.toarray()
    result = np.empty_like(total)
    result[order] = total
    return result


def near_rule(r: Array, distance: Array, length: Array, sign: int) -> tuple[Array, Array, Array]:
    """Return places x, roots sqrt|r^2 - x^2| and weights, x = r + sign w^2; each (m, nodes).

    Parameters
    ----------
    r : radii [length], shape (m,).
    distance : of the nearer end of the piece from r [length], shape (m,).
    length : of the piece [length], shape (m,).
    sign : 1 for a piece beyond r, -1 for one within.
    """
    nodes, weights = _NEAR[sign]
    first = np.sqrt(distance)
    step = (length / (first + np.sqrt(distance + length)))[:, None]
    w = first[:, None] + step * nodes
    x = r[:, None] + sign * w * w
    return x, w * np.sqrt(x + r[:, None]), 2 * w * step * weights


def heights(knots: Array, r: Array, basis: Callable[[Array], Any]) -> Array:
    """Return f(r_i) = (2/pi) int_0^r_i B_j(x) arccos(x/r_i) dx of every function B_j of a basis.

    Source: mdr-5, Eq. (5.75), by parts.

    Parameters
    ----------
    knots : radii between which the functions are polynomials, from 0 on [length].
    r : radii up to the last knot, ascending [length], shape (m,).
    basis : values of all functions at places (n,), as a sparse matrix (n, functions).
    """
    return 2 / np.pi * integrals(basis, knots[:-1], np.diff(knots), r, arccosine, -1)


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

    @cached_property
    def slope(self) -> PPoly:
        """g'(x) [1]."""
        return PPoly(self.rows[::-1], self.edges)

    @cached_property
    def depth(self) -> PPoly:
        """g(x) = int_0^x g' [length]."""
        return self.slope.antiderivative()

    def half_force(self, x: Array) -> Array:
        """int_0^x t g'(t) dt [length^2]."""
        return self._unit**2 * self._integrals[0](x / self._unit)

    def energy(self, x: Array) -> Array:
        """int_0^x (g(x) - g)^2 dt = 2 int (half force) g' dt [length^3]."""
        return self._unit**3 * self._integrals[1](x / self._unit)

    @property
    def _unit(self) -> float:
        """Unit of length of the integrals, whose powers leave the range of doubles otherwise."""
        return float(self.edges[-1])

    @cached_property
    def _integrals(self) -> tuple[PPoly, PPoly]:
        """Half force and energy, with lengths over `_unit`."""
        edges = self.edges / self._unit
        rows = self.rows * self._unit ** np.arange(len(self.rows))[:, None]
        moment = np.pad(edges[:-1] * rows, ((0, 1), (0, 0)))
        moment[1:] += rows
        half_force = PPoly(moment[::-1], edges).antiderivative()
        integral = half_force.c[::-1]
        product = np.zeros((len(rows) + len(integral) - 1, edges.size - 1))
        for power, row in enumerate(rows):
            product[power : power + len(integral)] += 2 * row * integral
        return half_force, PPoly(product[::-1], edges).antiderivative()

    def stress(self, low: float, high: float, width: float, r: Array) -> Array:
        """Return int_max(r,low)^high g'(x)/sqrt(x^2 - r^2) dx at radii r < high.

        A sharp tip is a cone to first order, whose integral is closed.

        Parameters
        ----------
        low, high, width : ends c and a of the annulus, and a - c, accurate by itself.
        r : radii [length], shape (m,).
        """
        # Next to the axis a smooth stress is constant to second order.
        nearest, sharp = np.sqrt(EPS) * min(self.edges[1], high), self.rows[0, 0]
        # Pieces are no longer than their distance from it.
        halves = high / 2.0 ** np.arange(1, np.log2(high / nearest) + 1)
        pieces = _pieces(np.union1d(self.edges, halves), low, high, width)
        places = np.maximum(r, nearest) if low == 0 else r
        total = integrals(lambda x: self.slope(x) - sharp, *pieces, places, lambda _, s: 1 / s, 1)
        if sharp > 0:
            total += sharp * log_ratio(Annulus(*map(np.asarray, (high, width, low))), r)
        return total

    def under(self, low: float, high: float, r: Array, kernel: Kernel) -> Array:
        """Return int_low^min(high,r) g'(x) K(x, sqrt(r^2 - x^2)) dx at radii r > low.

        Parameters
        ----------
        low, high : ends [length].
        r : radii [length], shape (m,).
        kernel : K.
        """
        pieces = _pieces(self.edges, low, high, high - low)
        return integrals(self.slope, *pieces, r, kernel, -1)

    def annulus(self, low: float, width: float, kernels: Sequence[Kernel]) -> list[float]:
        """Return int_low^r g'(x) K(x, sqrt(r^2 - x^2)) dx, r = low + width, for each kernel K.

        Parameters
        ----------
        low, width : inner radius and width, each accurate by itself [length].
        kernels : K of each integral.
        """
        if width == 0:
            return [0.0] * len(kernels)
        left, length = _pieces(self.edges, low, low + width, width)
        distance = np.maximum(width - (left - low) - length, 0.0)
        x, root, weight = near_rule(np.array([low + width]), distance, length, -1)
        slope = weight * self.slope(x)
        return [float((slope * kernel(x, root)).sum()) for kernel in kernels]


def _pieces(edges: Array, low: float, high: float, width: float) -> tuple[Array, Array]:
    """Return lower ends and lengths of the pieces from `low` to `high` = low + width."""
    ends = np.concatenate([[low], edges[(edges > low) & (edges < high)], [high]])
    return ends[:-1], np.diff(ends) if ends.size > 2 else np.array([width])
