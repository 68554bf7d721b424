"""Polynomials through Chebyshev points, and interpolation between few values at many points.

Source: notes, §5.
"""

import itertools
from collections.abc import Sequence
from functools import lru_cache
from math import ceil, floor, log10
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import PPoly

from mdr_core.quadrature import Analytic, error_bound
from mdr_core.typing import Array

# Rounding errors of a Chebyshev coefficient, over the largest value.
_ROUNDING: Final = 4 * float(np.finfo(float).eps)
# Length of the pieces over the interval of the points.
_LONGER: Final = 1 + 1e-12


@lru_cache(maxsize=32)
def fit_points(count: int) -> tuple[Array, Array, Array]:
    """Return points in [0, 1], and the matrices to Chebyshev coefficients and on to powers of u.

    Each row of the last matrix holds the powers of u in one Chebyshev polynomial.
    """
    x = np.asarray(chebyshev.chebpts1(count), dtype=float)
    to_chebyshev = np.linalg.inv(chebyshev.chebvander(x, count - 1))
    powers = np.zeros((count, count))
    for degree in range(count):
        # T_n(2u - 1) = T_2n(sqrt(u)).
        powers[degree, : degree + 1] = chebyshev.cheb2poly(np.eye(2 * degree + 1)[-1])[::2]
    return (1 + x) / 2, to_chebyshev, powers


def fitted(values: Array) -> Array:
    """Return the coefficients of the powers of u of polynomials through values (m, count).

    Coefficients of Chebyshev polynomials within rounding are left out from the last: as powers they
    would grow.

    Examples
    --------
    >>> points, _, _ = fit_points(3)
    >>> (fitted(2 * points**2 - points).round(12) + 0.0).tolist()
    [0.0, -1.0, 2.0]
    """
    _, to_chebyshev, powers = fit_points(values.shape[-1])
    coefficients = values @ to_chebyshev.T
    real = np.abs(coefficients) > _ROUNDING * np.abs(values).max(axis=-1, keepdims=True)
    needed = np.logical_or.accumulate(real[..., ::-1], axis=-1)[..., ::-1]
    return np.asarray(np.where(needed, coefficients, 0.0) @ powers)


@lru_cache(maxsize=64)
def _points_of_piece(decade: int, growth: float) -> int:
    """Return the points that interpolate on a piece of length 1 with an error below 10^decade.

    They are twice those of a Gauss rule with the same error.
    """
    analytic = Analytic(growth=growth)
    rules = itertools.count(1)
    return 2 * next(n for n in rules if error_bound(n, 0.5, analytic) < 10.0**decade)


class Interpolation:
    """Values of functions at many points, by polynomials on pieces no longer than 1.

    value/y is analytic for |Im y| < pi/2, and grows no faster than exp(growth |Re y|) there.
    """

    def __init__(self, parts: Sequence[tuple[Array, float]], rtol: float, growth: float) -> None:
        """Place the nodes of each function, whose points y (m_i,) are at least a number."""
        points = _points_of_piece(floor(log10(rtol) + 1e-9), growth)
        u, self._to_chebyshev, self._powers = fit_points(points)
        self.nodes: list[Array] = []
        places, pieces = [], 0
        for y, begin in parts:
            # A little longer than needed, so that the last point lies on the last piece.
            span = (float(y.max(initial=begin)) - begin) * _LONGER or 1.0
            own = ceil(span)
            piece = span / own
            self.nodes.append((begin + piece * (np.arange(own)[:, None] + u)).ravel())
            places.append((y - begin) / piece + pieces)
            pieces += own
        self._places, self._pieces = np.concatenate(places), np.arange(pieces + 1.0)
        self._y = np.concatenate([y for y, _ in parts])

    def __call__(self, values: Array) -> Array:
        """Return the values at all points, shape (sum of m_i,), from those at all nodes."""
        scaled = (values / np.concatenate(self.nodes)).reshape(self._pieces.size - 1, -1)
        # Not `fitted`, which takes four times as long: coefficients within rounding may stay,
        # because their powers cancel wherever a point lies on its piece.
        rows = scaled @ self._to_chebyshev.T @ self._powers
        polynomials = PPoly.construct_fast(rows.T[::-1], self._pieces)
        return np.asarray(polynomials(self._places) * self._y)
