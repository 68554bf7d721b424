"""Elementary differences, free of cancellation.

Source: notes, §4.
"""

from collections.abc import Sequence
from functools import reduce
from math import factorial
from typing import Final

import numpy as np

from mdr_core.elementwise import piecewise
from mdr_core.typing import Array, Parameter

# Below this argument a power series replaces the difference, which would lose more than four bits.
_THRESHOLD: Final = 0.4
# Coefficients in u = z^2, from the highest power on, of (1 - arctan(z)/z)/u and of
# (cosh(z) - sinh(z)/z)/u: the terms left out are below rounding error.
_ATAN: Final = [(-1) ** k / (2 * k + 3) for k in range(19, -1, -1)]
_TANH: Final = [2 * k / factorial(2 * k + 1) for k in range(7, 0, -1)]


def _polynomial(coefficients: Sequence[float], u: Array) -> Array:
    """Horner's scheme, for a number in a tenth of the time of NumPy's."""
    return reduce(lambda value, each: value * u + each, coefficients, 0.0 * u)


def atan_gap(s: Array, b: Parameter) -> Array:
    """Return s - b arctan(s/b) for s >= 0, b > 0 [length]: s^3/(3 b^2) for small s."""
    z = s / b
    return piecewise(
        z,
        _THRESHOLD,
        lambda z: s * (z * z) * _polynomial(_ATAN, z * z),
        lambda _: s - b * np.arctan(z),
    )


def tanh_gap(v: Array) -> Array:
    """Return v - tanh(v) for v >= 0 [1]: v^3/3 for small v, v - 1 for large."""
    return piecewise(
        v,
        _THRESHOLD,
        lambda v: v * (v * v) * _polynomial(_TANH, v * v) / np.cosh(v),
        lambda v: v - np.tanh(v),
    )
