"""Elementary differences, free of cancellation.

Source: notes, §4.
"""

from typing import Any, Final

import numpy as np

from mdr_core.elementwise import is_number, piecewise
from mdr_core.typing import Array, Parameter

# Below it a rational function replaces the difference, which loses more than three bits there.
_THRESHOLD: Final = 0.5
# Coefficients of numerator and denominator of (1 - arctan(z)/z)/u for u = z^2 <= 1/4, ascending.
# The function interpolates at the Chebyshev nodes of [0, 1/4], to 1.3e-18.
_ATAN: Final = (
    (
        0.3333333333333333,
        0.6490285937792852,
        0.4104489023900728,
        0.09273181111564717,
        0.0053660801980405775,
    ),
    (
        1.0,
        2.547085781337855,
        2.331026747401623,
        0.9185366231129339,
        0.14451007251714845,
        0.006165875923157523,
    ),
)
# The same of (1 - tanh(z)/z)/u.
_TANH: Final = (
    (0.3333333333333333, 0.02050385004918763, 0.00019940191776318837),
    (1.0, 0.4615115501475625, 0.023298063907570273, 0.00020677352824930548),
)


def _ratio(polynomials: tuple[tuple[float, ...], tuple[float, ...]], u: Any) -> Any:
    if is_number(u):
        # Python's own numbers have the same digits in a third of the time.
        u = u.item()
    numerator, denominator = (_horner(coefficients, u) for coefficients in polynomials)
    return numerator / denominator


def _horner(coefficients: tuple[float, ...], u: Any) -> Any:
    value = coefficients[-1] * u
    value += coefficients[-2]
    for coefficient in coefficients[-3::-1]:
        value *= u
        value += coefficient
    return value


def atan_gap(s: Array, b: Parameter) -> Array:
    """Return s - b arctan(s/b) for s >= 0, b > 0 [length]: s^3/(3 b^2) for small s."""

    def small(z: Array) -> Array:
        u = z * z
        return s * u * _ratio(_ATAN, u)

    z = s / b
    return piecewise(z, _THRESHOLD, small, lambda _: s - b * np.arctan(z))


def tanh_gap(v: Array) -> Array:
    """Return v - tanh(v) for v >= 0 [1]: v^3/3 for small v, v - 1 for large."""

    def small(v: Array) -> Array:
        u = v * v
        return v * u * _ratio(_TANH, u)

    return piecewise(v, _THRESHOLD, small, lambda v: v - np.tanh(v))
