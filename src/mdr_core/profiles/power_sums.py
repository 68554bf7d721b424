"""Where a sum of powers with terms of either sign vanishes, and how much its terms cancel.

Sizes and radii are logarithms here: of steep powers neither need be a double.
"""

from collections.abc import Callable, Iterable
from itertools import pairwise
from math import copysign, exp, inf, log
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import brentq

from mdr_core.typing import Array

LOG_FARTHEST: Final = 690.0
"""Radii beyond have no double."""
_LOG_LARGEST: Final = 700.0
_EPS: Final = float(np.finfo(float).eps)
# Terms are looked at as far about their crossing as sixteen of them can move it, in so many places.
_REACH: Final = 3.0
_PLACES: Final = 25
# Rounds of looking closer, each at so many places between those next to the worst.
_ROUNDS: Final = 3
# Nothing positive is left of the sum: a logarithm below all others.
_NOTHING: Final = -1e290


class LogTerm(NamedTuple):
    """A term sign exp(size) r^exponent."""

    sign: float
    size: float
    exponent: float


LogTerms = tuple[LogTerm, ...]


def log_terms(
    powers: Iterable[tuple[float, float]], factor: Callable[[float], float] = lambda _: 1.0
) -> LogTerms:
    """Return the terms factor(n) C r^n of the pairs (C, n), C != 0; the factor is positive."""
    return tuple(LogTerm(copysign(1.0, c), log(abs(c)) + log(factor(n)), n) for c, n in powers)


def first_fall(terms: LogTerms) -> float:
    """Smallest r >= 0 beyond which the sum, ascending in exponent, is negative, or infinity."""
    if terms[0].sign < 0:
        return 0.0
    ends = [*_log_roots(terms), inf]
    for start, end in pairwise(ends):
        middle = start + 1 if end == inf else (start + end) / 2
        if _sign_at(terms, middle) < 0:
            return exp(start) if start < _LOG_LARGEST else inf
    return inf


def log_radius_of(terms: LogTerms, goal: float, last: float) -> float:
    """The logarithm of the radius, up to `last`, where that of the sum is the goal."""

    def excess(u: float) -> float:
        top = max(term.size + term.exponent * u for term in terms)
        rest = _sign_at(terms, u)
        return top - goal + (log(rest) if rest > 0 else _NOTHING)

    if excess(last) <= 0:
        return last
    if excess(-LOG_FARTHEST) >= 0:
        return -LOG_FARTHEST
    return float(brentq(excess, -LOG_FARTHEST, last, xtol=1e-6))


def cancelling(terms: LogTerms, last: float) -> float:
    """Largest sum of the terms' sizes over their total, less one, up to exp(last).

    Terms cancel where two of either sign are alike, and at the end.
    """
    u = np.linspace(-_REACH, _REACH, _PLACES)
    centres = [
        (_crossing(one, other), abs(one.exponent - other.exponent))
        for one in terms
        for other in terms
        if one.sign > 0 > other.sign
    ]
    places = np.concatenate([[last], *(centre + u / apart for centre, apart in centres)])
    places = np.unique(places[(np.abs(places) <= LOG_FARTHEST) & (places <= last)])
    if not places.size:
        return 0.0
    for _ in range(_ROUNDS):
        worst = int(np.argmax(_sizes_over_sum(terms, places)))
        around = places[max(worst - 1, 0)], places[min(worst + 1, places.size - 1)]
        places = np.append(np.linspace(*around, _PLACES), places[worst])
        places.sort()
    return float(_sizes_over_sum(terms, places).max() - 1)


def _sizes_over_sum(terms: LogTerms, places: Array) -> Array:
    """Sum |c| r^e / |sum c r^e| at the logarithms of r."""
    sizes = np.array([term.size + term.exponent * places for term in terms])
    parts = np.exp(sizes - sizes.max(axis=0))
    total = np.abs((parts * [[term.sign] for term in terms]).sum(axis=0))
    return np.asarray(parts.sum(axis=0) / np.maximum(total, _EPS))


def _sign_at(terms: LogTerms, u: float) -> float:
    """The sum at r = exp(u), over its largest term: its sign, always within range."""
    logs = [term.size + term.exponent * u for term in terms]
    top = max(logs)
    return sum(exp(part - top) * term.sign for part, term in zip(logs, terms, strict=True))


def _log_roots(terms: LogTerms) -> list[float]:
    """All u where the sum vanishes and changes sign, ascending.

    Divided by its lowest power and differentiated, the sum loses one term (Rolle): between the
    roots of that derivative it is monotone, so each stretch holds at most one root. Times the
    same power again it keeps its roots, and its exponents to the last digit.
    """
    if len(terms) == 1:
        return []
    lowest = terms[0].exponent
    derivative = tuple(
        LogTerm(sign, size + log(exponent - lowest), exponent) for sign, size, exponent in terms[1:]
    )
    low, high = _log_bounds(terms)
    turns = [low, *(u for u in _log_roots(derivative) if low < u < high), high]
    return [
        float(brentq(lambda u: _sign_at(terms, u), start, end, xtol=1e-15))
        for start, end in pairwise(turns)
        if _sign_at(terms, start) * _sign_at(terms, end) < 0
    ]


def _log_bounds(terms: LogTerms) -> tuple[float, float]:
    """Logarithms of radii within which every root lies.

    Below the first the lowest power outweighs all others together, above the second the highest.
    """
    shift = log(len(terms))
    low = min(
        _crossing(terms[0], other) - shift / (other.exponent - terms[0].exponent)
        for other in terms[1:]
    )
    high = max(
        _crossing(terms[-1], other) + shift / (terms[-1].exponent - other.exponent)
        for other in terms[:-1]
    )
    return low - 1, high + 1


def _crossing(one: LogTerm, other: LogTerm) -> float:
    """Logarithm of the radius where both are of one size."""
    return (one.size - other.size) / (other.exponent - one.exponent)
