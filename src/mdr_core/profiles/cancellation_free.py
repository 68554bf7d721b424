"""Elementary differences, free of cancellation.

Source: notes, §4.
"""

from typing import Any, Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.elementwise import is_number, piecewise
from mdr_core.typing import Array, Parameter

# Below it a series replaces the difference, which loses more than three bits there.
_THRESHOLD: Final = 0.5
# Terms of the series in Chebyshev's form that leave 1e-17 below the threshold.
_TERMS: Final = 15


def _economised(sign: float) -> tuple[float, ...]:
    """Coefficients in u of sum_k (sign u)^k / (2k + 3), economised on 0 <= u <= 1/4."""
    k = np.arange(60)
    points = chebyshev.chebpts1(_TERMS)
    u = (points + 1) / 8
    values = ((sign * u[:, None]) ** k / (2 * k + 3)).sum(axis=1)
    fitted = np.linalg.solve(chebyshev.chebvander(points, _TERMS - 1), values)
    cheb = chebyshev.Chebyshev(fitted, domain=[0, 0.25])
    return tuple(cheb.convert(kind=np.polynomial.Polynomial, domain=[-1, 1], window=[-1, 1]).coef)


_ATAN: Final = _economised(-1.0)
_ATANH: Final = _economised(1.0)


def _horner(coefficients: tuple[float, ...], u: Any) -> Any:
    if is_number(u):
        # Python's own numbers have the same digits in a third of the time.
        u = u.item()
    value = coefficients[-1] * u
    value += coefficients[-2]
    for coefficient in coefficients[-3::-1]:
        value *= u
        value += coefficient
    return value


def atan_gap(s: Array, b: Parameter) -> Array:
    """Return s - b arctan(s/b) for s >= 0, b > 0 [length]: s^3/(3 b^2) for small s."""

    def series(z: Array) -> Array:
        u = z * z
        return s * u * _horner(_ATAN, u)

    z = s / b
    return piecewise(z, _THRESHOLD, series, lambda _: s - b * np.arctan(z))


def tanh_gap(v: Array) -> Array:
    """Return v - tanh(v) for v >= 0 [1]: v^3/3 for small v, v - 1 for large."""

    def series(v: Array) -> Array:
        t = np.tanh(v)
        u = t * t
        return t * u * _horner(_ATANH, u)

    return piecewise(v, _THRESHOLD, series, lambda v: v - np.tanh(v))
