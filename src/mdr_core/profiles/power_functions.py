"""Powers C r^n of the radius and their differences over an annulus.

`np.power` calls other functions for some exponents, if all are equal. `np.float_power` does not,
so that a sweep over exponents is bit-identical to its cases. Source: notes, §4.
"""

from typing import Any

import numpy as np
from scipy.special import beta

from mdr_core.elementwise import where
from mdr_core.typing import Array, Parameter


def power(coefficient: Parameter, r: Array, exponent: Parameter) -> Array:
    """Return C r^n; the caller handles overflow, with one `np.errstate` for a sum of terms."""
    return coefficient * np.float_power(r, exponent)


def power_slope(coefficient: Parameter, r: Array, exponent: Parameter) -> Array:
    """Return C n r^(n-1), infinite at r = 0 for n < 1; the caller handles overflow."""
    return coefficient * exponent * np.float_power(r, exponent - 1)


def power_root(value: Array, coefficient: Parameter, exponent: Parameter) -> Array:
    """Return (value/C)^(1/n).

    The rounding error of 1/n costs eps log(value/C)/n; one step of Newton's method removes it.
    """
    n = exponent
    with np.errstate(divide="ignore", over="ignore", under="ignore", invalid="ignore"):
        root = np.float_power(value / coefficient, 1 / n)
        miss = (value - power(coefficient, root, n)) / where(value > 0, value, 1.0)
        polished = root * (1 + miss / n)
    return where((value > 0) & np.isfinite(root), polished, root)


def kappa(exponent: Parameter) -> Array:
    """Return kappa_n = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2) [1]: g = kappa_n C x^n.

    Source: mdr-5, Eq. (5.25), as pi/B((n + 1)/2, 1/2).
    """
    inverse: Any = beta((exponent + 1) / 2, 0.5)
    return np.pi / inverse


def power_stick(exponent: Parameter, ratio: Array, rest: Array) -> tuple[Array, Array]:
    """Return c/a and 1 - c/a for (c/a)^exponent = rest = 1 - ratio.

    The ratio is the load divided by the load of full slip [1]. Source: notes, §4.
    """
    with np.errstate(divide="ignore"):
        exact = where(ratio < 0.5, np.log1p(-np.minimum(ratio, 0.5)), np.log(rest))
    e = exact / exponent
    return np.exp(e), -np.expm1(e)
