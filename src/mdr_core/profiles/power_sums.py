"""Zeros of sums of powers with positive and negative terms.

Coefficients and radii are stored as logarithms, because steep powers of ordinary radii leave the
range of doubles.
"""

from itertools import pairwise
from math import exp, inf

import numpy as np
from scipy.optimize import brentq

from mdr_core.doubles import LOG_RANGE
from mdr_core.typing import Array


def first_negative_radius(terms: Array) -> float:
    """Return the smallest r >= 0 beyond which a sum is negative, or infinity.

    Parameters
    ----------
    terms : sign, logarithm of the size and exponent of each power, ascending in the exponent,
        shape (3, k).
    """
    ends = [-LOG_RANGE, *_log_roots(terms), LOG_RANGE]
    for start, end in pairwise(ends):
        if _scaled_sum(terms, (start + end) / 2) < 0:
            return exp(start) if start > -LOG_RANGE else 0.0
    return inf


def _scaled_sum(terms: Array, u: float) -> float:
    """Sum at r = exp(u), divided by its largest term."""
    sign, size, exponent = terms
    logs = size + exponent * u
    return float(sign @ np.exp(logs - logs.max()))


def _log_roots(terms: Array) -> list[float]:
    """All zeros u at which the sum changes sign, ascending.

    Division by its lowest power and differentiation remove one term of the sum. By Rolle's theorem
    it is monotone between the roots of that derivative, so each interval holds at most one root.
    """
    sign, size, exponent = terms
    if sign.size == 1:
        return []
    # The derivative is multiplied by the lowest power again, which keeps its roots and the
    # exponents.
    factors = exponent[1:] - exponent[0]
    derivative = np.array([sign[1:], size[1:] + np.log(factors), exponent[1:]])
    turns = [-LOG_RANGE, *_log_roots(derivative), LOG_RANGE]
    return [
        float(brentq(lambda u: _scaled_sum(terms, u), start, end, xtol=1e-15))
        for start, end in pairwise(turns)
        if _scaled_sum(terms, start) * _scaled_sum(terms, end) < 0
    ]
