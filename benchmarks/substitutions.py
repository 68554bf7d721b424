"""int_low^a g'(x)/sqrt(x^2 - r^2) dx for `quad_vec`, as a user of SciPy writes it.

`slope(x, above)` is g' at x = b + above, with the profile's break b; low = max(r, b, c).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Array = np.ndarray
Slope = Callable[[Array, Array], Array]


def one_root_removed(
    slope: Slope, r: Array, a: float, b: float, c: float = 0.0
) -> Callable[[float], Array]:
    """The usual substitution, t = sqrt(x^2 - r^2), starting at the break or the stick edge."""
    low = max(b, c)
    start = np.sqrt(np.maximum((low - r) * (low + r), 0.0))
    length = np.sqrt((a - r) * (a + r)) - start

    def integrand(u: float) -> Array:
        t = start + length * u
        x = np.sqrt(t * t + r * r)
        return slope(x, np.maximum(x - b, 0.0)) * length / x

    return integrand


def both_roots_removed(
    slope: Slope, r: Array, a: float, b: float, c: float = 0.0
) -> Callable[[float], Array]:
    """The best substitution for SciPy: x = low + (a - low) u^2."""
    low = np.maximum(r, max(b, c))
    length, gap, above = a - low, low - r, low - b

    def integrand(u: float) -> Array:
        step = length * (u * u)
        x = low + step
        return slope(x, above + step) * (2 * u) * length / np.sqrt((gap + step) * (x + r))

    return integrand
