"""Elementary differences, free of cancellation.

Source: notes, §4.
"""

from typing import Any, Final

import numpy as np

from mdr_core.elementwise import is_number, piecewise
from mdr_core.typing import Array, Parameter

# Below it a series replaces the difference, which loses more than three bits there.
_THRESHOLD: Final = 0.5
# Terms of the series in u that leave 1e-17 below the threshold, u = 1/4.
_TERMS: Final = 26
# Coefficients of u^k in arctan and artanh, from the power of 3 on.
_ATANH: Final = tuple(1 / (2 * k + 3) for k in range(_TERMS))
_ATAN: Final = tuple((-1) ** k * c for k, c in enumerate(_ATANH))


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
