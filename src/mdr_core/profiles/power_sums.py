"""Zeros of sums of powers with positive and negative terms.

Coefficients and radii are stored as logarithms, because steep powers of ordinary radii leave the
range of doubles.
"""

from collections.abc import Callable, Iterable
from itertools import pairwise
from math import copysign, exp, inf, log
from typing import NamedTuple

from scipy.optimize import brentq

from mdr_core.doubles import LOG_RANGE


class LogTerm(NamedTuple):
    """Term sign exp(size) r^exponent of a sum."""

    sign: float
    size: float
    exponent: float


LogTerms = tuple[LogTerm, ...]


def log_terms(
    powers: Iterable[tuple[float, float]], factor: Callable[[float], float] = lambda _: 1.0
) -> LogTerms:
    """Return the terms factor(n) C r^n of the pairs (C, n), C != 0; the factor is positive."""
    return tuple(LogTerm(copysign(1.0, c), log(abs(c)) + log(factor(n)), n) for c, n in powers)


def first_negative_radius(terms: LogTerms) -> float:
    """Return the smallest r >= 0 beyond which the sum is negative, or infinity.

    The terms ascend in the exponent.
    """
    ends = [-LOG_RANGE, *_log_roots(terms), LOG_RANGE]
    for start, end in pairwise(ends):
        if _scaled_sum(terms, (start + end) / 2) < 0:
            return exp(start) if start > -LOG_RANGE else 0.0
    return inf


def _scaled_sum(terms: LogTerms, u: float) -> float:
    """Sum at r = exp(u), divided by its largest term."""
    logs = [term.size + term.exponent * u for term in terms]
    top = max(logs)
    return sum(exp(part - top) * term.sign for part, term in zip(logs, terms, strict=True))


def _log_roots(terms: LogTerms) -> list[float]:
    """All zeros u at which the sum changes sign, ascending.

    Division by its lowest power and differentiation remove one term of the sum. By Rolle's theorem
    it is monotone between the roots of that derivative, so each interval holds at most one root.
    """
    if len(terms) == 1:
        return []
    lowest = terms[0].exponent
    # The derivative is multiplied by the lowest power again, which keeps its roots and the
    # exponents.
    derivative = tuple(
        LogTerm(sign, size + log(exponent - lowest), exponent) for sign, size, exponent in terms[1:]
    )
    turns = [-LOG_RANGE, *_log_roots(derivative), LOG_RANGE]
    return [
        float(brentq(lambda u: _scaled_sum(terms, u), start, end, xtol=1e-15))
        for start, end in pairwise(turns)
        if _scaled_sum(terms, start) * _scaled_sum(terms, end) < 0
    ]
