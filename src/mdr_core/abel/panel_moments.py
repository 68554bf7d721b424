"""The stress kernel over single panels whose weight is a polynomial, by closed moments."""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.abel.interpolation import chebyshev_points
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Flags, Indices

_DEGREE: Final = 23
_POINTS, _TO_COEFFICIENTS = chebyshev_points(_DEGREE + 1)
# Places in a panel of length one.
PLACES: Final = (1 + _POINTS) / 2
_EPS: Final = float(np.finfo(float).eps)
# What is left out of the last coefficients, of the largest value: as powers they would grow. It
# is this part of the accuracy, down to rounding.
_NOISE: Final = 1e-14
_UNFELT: Final = 1e-3
_SMALL: Final = 0.5
# Of a panel that is half its own length away, measured in x^2, n nodes leave 3.4^-2n, and they may
# leave this part of the accuracy.
_FALL: Final = 2 * log(3.4)
_LEFT: Final = 1e-2
_MOST_NODES: Final = 14


def _to_powers() -> Array:
    """Chebyshev polynomials on [0, 1] as sums of powers, (degree + 1, degree + 1)."""
    rows = np.zeros((_DEGREE + 1, _DEGREE + 1))
    for degree in range(_DEGREE + 1):
        # T_2n(sqrt(u)) = T_n(2u - 1).
        rows[degree, : degree + 1] = chebyshev.cheb2poly(np.eye(2 * degree + 1)[-1])[::2]
    return rows


def _factors() -> Array:
    """G_n of G_n/G_(n-2) = (n - 1)/n: M_n = G_n m_n makes m_n = t/(n G_n) - k m_(n-2)."""
    factors = np.ones(_DEGREE + 1)
    for n in range(2, _DEGREE + 1):
        factors[n] = factors[n - 2] * (n - 1) / n
    return factors


_POWERS: Final = _to_powers()
_FACTORS: Final = _factors()
_OF_ROOT: Final = np.append([0.0, 0.0], 1 / (np.arange(2, _DEGREE + 1) * _FACTORS[2:]))


@lru_cache(maxsize=16)
def _nodes(accuracy: float) -> tuple[Array, Array]:
    """Squares of Gauss' nodes of a panel of length one, and each one's weight times powers."""
    count = min(ceil(log(1 / (_LEFT * accuracy)) / _FALL), _MOST_NODES)
    nodes, weights = gauss_legendre(count)
    u = (1 + nodes) / 2
    powers = u[:, None] ** np.arange(_DEGREE + 1)
    return u * u, weights[:, None] / 2 * powers / _FACTORS


@dataclass(frozen=True, eq=False)
class PowerPanels:
    """W = sum_n c_n u^n, u = s/length, s = sqrt(x^2 - left^2), between `left` and `right` in x.

    `coefficients` (degree + 1, panels) hold c_n times the factors of the moments; `known` says
    where the polynomial is good enough.
    """

    left: Array
    right: Array
    length: Array
    coefficients: Array
    known: Flags

    def chosen(self, panel: Indices) -> "PowerPanels":
        """Some of the panels."""
        return PowerPanels(
            self.left[panel],
            self.right[panel],
            self.length[panel],
            self.coefficients.take(panel, axis=1),
            self.known[panel],
        )

    def cut(self, right: float) -> "PowerPanels":
        """The panels, but only up to the radius `right`."""
        length = np.sqrt((right - self.left) * (right + self.left))
        part = (length / self.length) ** np.arange(self.coefficients.shape[0])[:, None]
        return PowerPanels(
            self.left, np.full_like(self.left, right), length, self.coefficients * part, self.known
        )

    def begun(self, left: float, accuracy: float) -> "PowerPanels":
        """A single panel, but only from the radius `left` on, in powers from there."""
        begin = np.array([left])
        length = np.sqrt((self.right - begin) * (self.right + begin))
        s = length * PLACES
        own = np.hypot(np.sqrt((begin - self.left) * (begin + self.left)), s)
        rows = self.coefficients.shape[0]
        powers = (own / self.length)[:, None] ** np.arange(rows) / _FACTORS[:rows]
        values = (powers @ self.coefficients[:, 0]) * s / own
        part = power_panels(begin, self.right, values[None], np.zeros(1), accuracy)
        part.known[:] &= self.known
        return part

    def from_afar(self, above: Array, accuracy: float) -> Array:
        """`integrals` of a single panel for radii far below it, above = left^2 - r^2."""
        squares, powers = _nodes(accuracy)
        masses = powers[:, : self.coefficients.shape[0]] @ self.coefficients[:, 0] * self.length
        root = np.add.outer(above, self.length * self.length * squares)
        np.sqrt(root, out=root)
        return np.asarray(np.divide(1.0, root, out=root) @ masses)

    def integrals(self, r: Array) -> Array:
        """int W ds/sqrt(s^2 + left^2 - r^2) over each panel, or what lies above its r < right.

        With k = (left^2 - r^2)/length^2 and t = sqrt(1 + k) the moments of u^n obey
        n M_n = t - (n - 1) k M_(n-2), stable for |k| <= 1. Source: notes, §5.
        """
        gap = self.left - r
        # The square of a radius may be no double.
        root = np.sqrt(np.abs(gap)) * np.sqrt(self.left + r) / self.length
        t = np.sqrt(self.right - r) * np.sqrt(self.right + r) / self.length
        k = np.copysign(root * root, gap)
        c = self.coefficients.copy()
        step = np.empty((2, k.size))
        for n in range(c.shape[0] - 4, -1, -2):
            np.multiply(k, c[n + 2 : n + 4], out=step)
            c[n : n + 2] -= step
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = np.arctanh(np.minimum(t, _SMALL))
            even = np.where(t < _SMALL, inverse, np.log1p(t) - np.log(root))
            # At a panel's own left end the integral is infinite only if the weight is not zero.
            even = np.where(c[0] == 0, 0.0, c[0] * even)
            odd = c[1] * np.where(k > 0, 1 / (t + root), t)
        return np.asarray(even + odd + t * (_OF_ROOT[: c.shape[0]] @ c))


def interpolated(values: Array, places: Array) -> Array:
    """The polynomials through the values (panels, places) at `PLACES`, at other places."""
    basis = chebyshev.chebvander(2 * places - 1, _DEGREE)
    return np.asarray(values @ _TO_COEFFICIENTS.T @ basis.T)


def power_panels(
    left: Array, right: Array, values: Array, at_left: Array, accuracy: float
) -> PowerPanels:
    """Expand W in powers from its values (panels, places) at `PLACES`, and that at s = 0.

    Known are panels where a dozen of the last coefficients, the rounding, and the distance of the
    polynomial from the value at s = 0 stay below `accuracy` of the largest value.
    """
    length = np.sqrt((right - left) * (right + left))
    chebyshev_ = values @ _TO_COEFFICIENTS.T
    largest = np.abs(values).max(axis=1)
    sizes = np.abs(chebyshev_)
    good = sizes[:, -2:].max(axis=1) <= accuracy / 12 * largest
    real = sizes > max(_NOISE, _UNFELT * accuracy) * largest[:, None]
    needed = np.flip(np.maximum.accumulate(np.flip(real, axis=1), axis=1), axis=1)
    kept = np.where(needed, chebyshev_, 0.0)
    powers = kept @ _POWERS
    good &= (np.abs(kept) @ np.abs(_POWERS)).max(axis=1) * _EPS <= accuracy * largest
    # Next to the left end W may change where no place sees it.
    good &= np.abs(powers[:, 0] - at_left) <= accuracy * largest
    powers[:, 0] = at_left
    good &= length > 0
    # In pairs of an even and an odd one, no more of them than some panel needs.
    rows = 2 * (np.flatnonzero(needed[good].any(axis=0)).max(initial=0) // 2 + 1)
    scaled = powers[:, :rows] * _FACTORS[:rows]
    return PowerPanels(left, right, length, np.ascontiguousarray(scaled.T), good)
