"""Closed integrals of the stress kernel over a panel on which dg/ds is a polynomial in s.

On a panel from b to a, u = s/L with s = sqrt(x^2 - b^2) and L = s(a), the kernel of a point r is
1/sqrt(s^2 + b^2 - r^2). With k = (b^2 - r^2)/L^2 and t = sqrt(1 + k) the moments of u^n obey
n M_n = t - (n - 1) k M_(n-2), which is stable for |k| <= 1. Source: notes, §5.
"""

from typing import Final

import numpy as np

from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array

# Largest number of powers of u.
_MAX_POWERS: Final = 28
# Value of t below which arcosh(1/root) is computed as artanh(t).
_SMALL: Final = 0.5
# Nodes of a panel at a distance of half its length in x^2, where n nodes leave 3.6^-2n.
_FAR_NODES: Final = 12


def _scales() -> Array:
    """Return f_n = f_(n-2) (n - 1)/n: M_n = f_n m_n makes m_n = t/(n f_n) - k m_(n-2)."""
    scales = np.ones(_MAX_POWERS)
    for n in range(2, _MAX_POWERS):
        scales[n] = scales[n - 2] * (n - 1) / n
    return scales


_SCALES: Final = _scales()
_OF_ROOT: Final = np.append([0.0, 0.0], 1 / (np.arange(2, _MAX_POWERS) * _SCALES[2:]))


def scaled(coefficients: Array) -> Array:
    """Return coefficients (n, panels) of the powers of u, scaled for `near`; n becomes even."""
    rows = coefficients * _SCALES[: len(coefficients), None]
    return np.append(rows, np.zeros_like(rows[:1]), axis=0) if len(rows) % 2 else rows


def near(rows: Array, length: Array | float, above: Array, to_right: Array) -> Array:
    """Return int sum_n c_n u^n ds/sqrt(s^2 + b^2 - r^2) above each radius r, shape (m,).

    Parameters
    ----------
    rows : `scaled` coefficients of each radius's panel, overwritten, shape (n, m) [any].
    length : L of the panels [length], shape (m,) or ().
    above, to_right : b^2 - r^2 <= L^2 and a^2 - r^2 > 0 [length^2], shape (m,).
    """
    square = length * length
    k = above / square
    root = np.sqrt(np.abs(k))
    t = np.sqrt(np.where(k < 0, to_right / square, 1 + k))
    c = rows
    step = np.empty((2, k.size))
    for n in range(len(c) - 4, -1, -2):
        np.multiply(k, c[n + 2 : n + 4], out=step)
        c[n : n + 2] -= step
    arc = np.where(t < _SMALL, np.arctanh(np.minimum(t, _SMALL)), np.log1p(t) - np.log(root))
    # At the left end itself the integral is infinite only if the weight is not zero.
    arc = np.where(c[0] == 0, 0.0, c[0] * arc)
    return np.asarray(
        arc + c[1] * np.where(k > 0, 1 / (t + root), t) + t * (_OF_ROOT[: len(c)] @ c)
    )


def far(rows: Array, length: float, above: Array, start: float = 0.0, part: float = 1.0) -> Array:
    """Return the integral of `near` over a panel, or over a part of it, for radii far below it.

    The radii are below the place where the integral begins by at least half of its length in x^2.

    Parameters
    ----------
    rows : `scaled` coefficients, shape (n,) [any].
    length : L [length].
    above : x^2 - r^2, x where the integral begins [length^2], shape (m,).
    start, part : u where the integral begins, and its length in u [1].
    """
    nodes, weights = gauss_legendre(_FAR_NODES)
    past = part * (1 + nodes) / 2
    powers = (start + past) ** np.arange(len(rows))[:, None]
    masses = (rows / _SCALES[: len(rows)]) @ powers * (weights / 2) * (part * length)
    kernel = np.add.outer(length * length * past * (2 * start + past), above)
    np.divide(1.0, np.sqrt(kernel, out=kernel), out=kernel)
    return np.asarray(masses @ kernel)
