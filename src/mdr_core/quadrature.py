"""Gauss-Legendre rules for integrands that are analytic in a strip about the real axis.

The substitutions of `mdr_core.abel` turn every singular integral of the project into one whose
integrand h(y) is analytic for |Im y| < pi/2 and grows no faster than exp(growth |Re y|). For such
functions the error of a rule is known beforehand, so that each integral gets just the nodes that
its length and the asked tolerance need, and is evaluated once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, exp, floor, inf, log, log10, pi, sqrt
from typing import Final

import numpy as np
from scipy.special import roots_legendre

from mdr_core.typing import Array, Chosen, Indices

# h(y, index): y has shape (nodes, m), index (m,) says which integrals they belong to.
Integrand = Callable[[Array, Chosen], Array]

# Number of nodes of the rules on offer, as points of the full rule on [-H, H].
_POINTS: Final = (4, 8, 12, 24, 48)
# Longest piece of an integral that is cut: the cheapest nodes per unit length.
_PIECE_POINTS: Final = 24
# Evaluations at so many nodes take as long as what one more call takes by itself.
_CALL: Final = 2000
_LOG_LARGEST: Final = 700.0
# Nodes x integrals handled at once: the temporaries stay in the processor's cache.
_BLOCK: Final = 12_288


@dataclass(frozen=True)
class Analytic:
    """Where an integrand is analytic, |Im y| < strip, and how it grows, exp(growth |Re y|).

    The singularities that the substitutions leave sit at |Im y| = pi/2; the strip stays inside.
    `fewest`: points that an integrand of some degree needs on any interval, however short.
    """

    growth: float = 2.0
    strip: float = 0.47 * pi
    fewest: int = 0


DEFAULT: Final = Analytic()


@lru_cache(maxsize=64)
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Return the nodes and weights of the rule on [-1, 1]."""
    nodes, weights = roots_legendre(points)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


def error_bound(points: int, half_length: float, analytic: Analytic) -> float:
    """Bound the relative error of the `points`-point rule on an interval of length 2H.

    For h analytic and |h| <= M in the Bernstein ellipse of parameter rho the error is below
    (64/15) M rho^(-2n) / (1 - rho^-2); with |h| growing like exp(growth |Re y|) the ellipse that
    fits the strip, or a smaller one, gives the bound, here relative to the largest h inside.

    Source: trefethen, Thm 19.3.
    """
    if half_length == 0:
        return 0.0
    growth, beta = analytic.growth, analytic.strip / half_length
    widest = log(beta + sqrt(1 + beta * beta))
    best = inf
    for part in np.linspace(0.1, 1, 10) * widest:
        rho2 = exp(2 * part)
        semi_axis = (exp(part) + exp(-part)) / 2
        log_bound = growth * half_length * (semi_axis - 1) - 2 * points * part
        best = min(best, exp(min(log_bound, _LOG_LARGEST)) / (1 - 1 / rho2))
    return best * (64 / 15) * (1 + growth * half_length)


@lru_cache(maxsize=256)
def _longest(points: int, decade: int, analytic: Analytic) -> float:
    """Largest half length at which the rule's bound stays below 10^decade."""
    low, high = min(1e-3, 1e-2 / analytic.growth), 40.0
    tolerance = 10.0**decade
    for _ in range(40):
        middle = sqrt(low * high)
        low, high = (
            (middle, high) if error_bound(points, middle, analytic) < tolerance else (low, middle)
        )
    return low


@lru_cache(maxsize=64)
def _limits(decade: int, analytic: Analytic) -> Array:
    """Half lengths up to which each rule of `_POINTS` suffices."""
    return np.array(
        [
            _longest(points, decade, analytic) if points >= analytic.fewest else 0.0
            for points in _POINTS
        ]
    )


def _decade(rtol: float) -> int:
    """Tolerances are served by whole decades, so that the limits are computed once."""
    return max(floor(log10(rtol) + 1e-9), -15)


def integrate_even(h: Integrand, upper: Array, rtol: float, analytic: Analytic = DEFAULT) -> Array:
    """Return the integrals of h over [0, upper], h even in y and analytic in the strip.

    The rule of 2n points on [-upper, upper] costs n evaluations and converges as twice as many.
    `upper` has shape (m,); what is too long for one rule is cut into pieces.
    Source: notes, §5; trefethen, Thm 19.3.
    """
    result = np.empty_like(upper)
    for index, points in _groups(upper, rtol, analytic):
        length = upper[index]
        if points:
            result[index] = _apply(h, _half_rule(points), None, length, index)
        else:
            result[index] = _pieces(h, np.zeros_like(length), length, index, rtol, analytic)
    return result


def integrate_plain(
    h: Integrand, lower: Array, length: Array, rtol: float, analytic: Analytic = DEFAULT
) -> Array:
    """Return the integrals of h over [lower, lower + length], h analytic in the strip.

    `length` is asked for by itself: as a difference of ends it would lose the digits of a
    short interval.

    Source: notes, §5; trefethen, Thm 19.3.
    """
    result = np.empty_like(lower)
    for index, points in _groups(length / 2, rtol, analytic):
        start, span = lower[index], length[index]
        if points:
            result[index] = _apply(h, composite_rule(points, 1), start, span, index)
        else:
            result[index] = _pieces(h, start, span, index, rtol, analytic)
    return result


def _groups(half_length: Array, rtol: float, analytic: Analytic) -> list[tuple[Chosen, int]]:
    """The integrals that share a rule, with its points; 0 where none suffices.

    A few integrals join those of the next finer rule: no call is worth making for them.
    """
    choice = np.searchsorted(_limits(_decade(rtol), analytic), half_length)
    counts = np.bincount(choice, minlength=len(_POINTS) + 1).tolist()
    present = [number for number, count in enumerate(counts) if count]
    for number, finer in pairwise(present):
        more = counts[number] * (_POINTS[finer] - _POINTS[number]) if finer < len(_POINTS) else inf
        if more <= _CALL:
            choice[choice == number] = finer
            counts[number], counts[finer] = 0, counts[number] + counts[finer]
    groups = [(number, points) for number, points in enumerate((*_POINTS, 0)) if counts[number]]
    if len(groups) == 1:
        return [(slice(0, choice.size), groups[0][1])]
    return [(_chosen(np.flatnonzero(choice == number)), points) for number, points in groups]


def _chosen(index: Indices) -> Chosen:
    """The ascending indices, as a slice where they are neighbours, as of sorted radii they are."""
    first, last = int(index[0]), int(index[-1])
    return slice(first, last + 1) if last - first + 1 == index.size else index


def _pieces(
    h: Integrand, lower: Array, length: Array, index: Chosen, rtol: float, analytic: Analytic
) -> Array:
    """Cut [lower, lower + length] into equal pieces that one rule carries."""
    half = float(length.max()) / 2
    count = ceil(half / _longest(_PIECE_POINTS, _decade(rtol), analytic))
    return _apply(h, composite_rule(_PIECE_POINTS, count), lower, length, index)


def _apply(
    h: Integrand, rule: tuple[Array, Array], lower: Array | None, length: Array, index: Chosen
) -> Array:
    """Apply a rule on [0, 1] to [lower, lower + length], in blocks that stay in cache."""
    nodes, weights = rule
    step = max(_BLOCK // nodes.size, 1)
    result = np.empty_like(length)
    for start in range(0, length.size, step):
        block = slice(start, min(start + step, length.size))
        y = nodes[:, None] * length[block]
        if lower is not None:
            y += lower[block]
        if isinstance(index, slice):
            part: Chosen = slice(index.start + block.start, index.start + block.stop)
        else:
            part = index[block]
        result[block] = length[block] * (weights @ h(y, part))
    return result


@lru_cache(maxsize=64)
def _half_rule(points: int) -> tuple[Array, Array]:
    """Positive nodes of the rule on [-1, 1], and their weights for an even h over [0, 1]."""
    nodes, weights = gauss_legendre(points)
    return nodes[points // 2 :], weights[points // 2 :]


@lru_cache(maxsize=256)
def composite_rule(points: int, count: int) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], cut into `count` equal pieces."""
    nodes, weights = gauss_legendre(points)
    starts = np.arange(count)[:, None]
    return ((starts + (nodes + 1) / 2) / count).ravel(), np.tile(weights / (2 * count), count)


@lru_cache(maxsize=256)
def graded_rule(points: int, halvings: int) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], cut into pieces that halve towards 0."""
    nodes, weights = gauss_legendre(points)
    ends = np.append(0.0, 0.5 ** np.arange(halvings, -1, -1))
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * (nodes + 1) / 2).ravel(), (width * weights / 2).ravel()
