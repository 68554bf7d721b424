"""Gauss-Legendre rules for integrands that are analytic in a strip about the real axis.

The substitutions of `mdr_core.abel` turn every singular integral of the project into one whose
integrand h(y) is analytic for |Im y| < pi/2 and grows no faster than exp(growth |Re y|). For such
functions the error of a rule is known beforehand, so that each integral gets just the nodes that
its length and the asked tolerance need, and is evaluated once.
"""

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, floor, log2, log10, pi
from typing import Final

import numpy as np
from scipy.special import roots_legendre

from mdr_core.checks import extremes
from mdr_core.typing import Array, Chosen, Indices

# h(y, index): y has shape (nodes, m), index (m,) says which integrals they belong to. y is the
# integrand's own, to be overwritten as it likes.
Integrand = Callable[[Array, Chosen], Array]

# Points of the rules on offer: of any integral, and on [-H, H] of an even one over [0, H].
_POINTS: Final = (2, 3, 4, 5, 6, 8, 12, 16, 24, 48)
_EVEN_POINTS: Final = (4, 6, 8, 12, 16, 24, 48)
# Longest piece of an integral that is cut: the cheapest nodes per unit length.
_PIECE_POINTS: Final = 24
# Evaluations at so many nodes take as long as what one more call takes by itself.
_CALL: Final = 2000
_LOG_LARGEST: Final = 700.0
# Of the widest ellipse, where the best one is looked for; and how often a length is halved in.
_ELLIPSES: Final = np.linspace(0.1, 1.0, 10)
_BISECTIONS: Final = 30
# Nodes of equal pieces by the tolerance: their half length is one in a strip of pi/2.
_NODES_OF_PIECES: Final = ((1e-4, 8), (1e-8, 12), (0.0, 20))
# What lies nearer than this to the end of a piece lies on it.
_NEAREST: Final = 2.0**-52
# Nodes x integrals handled at once: the temporaries stay in the processor's cache.
_BLOCK: Final = 12_288


@dataclass(frozen=True)
class Analytic:
    """Where an integrand is analytic, |Im y| < strip, and how it grows, exp(growth |Re y|).

    The singularities that the substitutions leave sit at |Im y| = pi/2; the strip stays inside.
    `fewest`: points that an integrand of some degree needs on any interval, however short.
    `zeros`: how many zeros it may have in or next to the interval, where it is small all over.
    """

    growth: float = 2.0
    strip: float = 0.47 * pi
    fewest: int = 0
    zeros: int = 0


DEFAULT: Final = Analytic()


@lru_cache(maxsize=64)
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Return the nodes and weights of the rule on [-1, 1]."""
    nodes, weights = roots_legendre(points)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


def error_bound(points: int | Indices, half_length: float | Array, analytic: Analytic) -> Array:
    """Bound the relative error of the `points`-point rule on an interval of length 2H.

    For h analytic and |h| <= M in the Bernstein ellipse of parameter rho the error is below
    (64/15) M rho^(-2n) / (1 - rho^-2); with |h| growing like exp(growth |Re y|) the ellipse that
    fits the strip, or a smaller one, gives the bound, here relative to the largest h inside. From
    each zero the ellipse reaches further than the interval by its semi-axis, at most.

    Source: trefethen, Thm 19.3.
    """
    given = np.asarray(half_length, dtype=float)
    half = np.where(given > 0, given, 1.0)
    # log(rho), up to the ellipse that touches the strip's edge.
    part = np.multiply.outer(_ELLIPSES, np.arcsinh(analytic.strip / half))
    semi_axis = np.cosh(part)
    log_bound = analytic.growth * half * (semi_axis - 1) - 2 * points * part
    log_bound += analytic.zeros * np.log(semi_axis)
    bound = np.exp(np.minimum(log_bound, _LOG_LARGEST)) / -np.expm1(-2 * part)
    # An integrand with zeros is by so much less on the average than where it is largest.
    factor = 64 / 15 * (1 + analytic.growth * half) * (1 + analytic.zeros)
    return np.asarray(np.where(given > 0, bound.min(axis=0) * factor, 0.0))


@lru_cache(maxsize=512)
def _longest(rules: tuple[int, ...], decade: int, analytic: Analytic) -> tuple[float, ...]:
    """Largest half lengths at which the bounds of the rules stay below 10^decade."""
    points = np.array(rules)
    low = np.full(points.shape, min(1e-3, 1e-2 / analytic.growth))
    high = np.full(points.shape, 40.0)
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        good = error_bound(points, middle, analytic) < 10.0**decade
        low, high = np.where(good, middle, low), np.where(good, high, middle)
    return tuple(low.tolist())


@lru_cache(maxsize=512)
def _limits(decade: int, analytic: Analytic, rules: tuple[int, ...]) -> tuple[float, ...]:
    """Half lengths up to which each of the rules suffices."""
    return tuple(
        length if points >= analytic.fewest else 0.0
        for points, length in zip(rules, _longest(rules, decade, analytic), strict=True)
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

    def by_rule(points: int, index: Chosen) -> Array:
        length = upper[index]
        if points:
            return _apply(h, _half_rule(points), None, length, index)
        return _pieces(h, np.zeros_like(length), length, index, rtol, analytic)

    limits = _limits(_decade(rtol), analytic, _EVEN_POINTS)
    return _by_groups(by_rule, upper, limits, _EVEN_POINTS, 2)


def integrate_plain(
    h: Integrand, lower: Array, length: Array, rtol: float, analytic: Analytic = DEFAULT
) -> Array:
    """Return the integrals of h over [lower, lower + length], h analytic in the strip.

    `length` is asked for by itself: as a difference of ends it would lose the digits of a
    short interval.

    Source: notes, §5; trefethen, Thm 19.3.
    """

    def by_rule(points: int, index: Chosen) -> Array:
        start, span = lower[index], length[index]
        if points:
            return _apply(h, composite_rule(points, 1), start, span, index)
        return _pieces(h, start, span, index, rtol, analytic)

    limits = _limits(_decade(rtol), analytic, _POINTS)
    return _by_groups(by_rule, length / 2, limits, _POINTS, 1)


def _by_groups(
    by_rule: Callable[[int, Chosen], Array],
    half_length: Array,
    limits: tuple[float, ...],
    rules: tuple[int, ...],
    points_a_node: int,
) -> Array:
    """Integrate together those that share a rule; of 0 points where none suffices.

    A few integrals join those of the next finer rule: no call is worth making for them.
    """
    count = half_length.size
    worth = _CALL * points_a_node
    low, high = (bisect_left(limits, end) for end in extremes(half_length))
    if low == high or (high < len(rules) and count * (rules[high] - rules[low]) <= worth):
        return by_rule((*rules, 0)[high], slice(0, count))
    # For each rule, and for none before the first, the integrals for which it suffices.
    suffice = [half_length <= limits[number] for number in range(low, high)]
    none = np.zeros(count, bool)
    enough = [none, *suffice, ~none]
    counts = [int(np.count_nonzero(part)) for part in enough]
    present = [i for i in range(1, len(enough)) if counts[i] > counts[i - 1]]
    points = (0, *(*rules, 0)[low : high + 1])
    result = np.empty_like(half_length)
    more, done = 0, 0
    for this, finer in zip(present, [*present[1:], 0], strict=True):
        if points[finer]:
            more += (counts[this] - counts[done]) * (points[finer] - points[this])
            if more <= worth:
                continue
        index = _chosen((enough[this] ^ enough[done]).nonzero()[0])
        result[index] = by_rule(points[this], index)
        more, done = 0, this
    return result


def _chosen(index: Indices) -> Chosen:
    """The ascending indices, as a slice where they are neighbours, as of sorted radii they are."""
    first, last = int(index[0]), int(index[-1])
    return slice(first, last + 1) if last - first + 1 == index.size else index


def _pieces(
    h: Integrand, lower: Array, length: Array, index: Chosen, rtol: float, analytic: Analytic
) -> Array:
    """Cut [lower, lower + length] into equal pieces that one rule carries."""
    half = float(length.max()) / 2
    count = ceil(half / _longest((_PIECE_POINTS,), _decade(rtol), analytic)[0])
    return _apply(h, composite_rule(_PIECE_POINTS, count), lower, length, index)


def _apply(
    h: Integrand, rule: tuple[Array, Array], lower: Array | None, length: Array, index: Chosen
) -> Array:
    """Apply a rule on [0, 1] to [lower, lower + length], in blocks that stay in cache."""
    step = max(_BLOCK // rule[0].size, 1)
    if length.size <= step:
        return _at_once(h, rule, lower, length, index)
    result = np.empty_like(length)
    for start in range(0, length.size, step):
        block = slice(start, min(start + step, length.size))
        if isinstance(index, slice):
            part: Chosen = slice(index.start + block.start, index.start + block.stop)
        else:
            part = index[block]
        low = None if lower is None else lower[block]
        result[block] = _at_once(h, rule, low, length[block], part)
    return result


def _at_once(
    h: Integrand, rule: tuple[Array, Array], lower: Array | None, length: Array, index: Chosen
) -> Array:
    nodes, weights = rule
    y = nodes[:, None] * length
    if lower is not None:
        y += lower
    result: Array = weights @ h(y, index)
    result *= length
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


def nodes_of_pieces(rtol: float) -> int:
    """Return how many nodes a piece of length two needs where h is analytic for |Im y| < pi/2."""
    return next(count for limit, count in _NODES_OF_PIECES if rtol >= limit)


@lru_cache(maxsize=256)
def graded_rule(points: int, halvings: int, count: int = 1) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], cut into equal pieces of which the first halves towards 0."""
    first = np.append(0.0, 0.5 ** np.arange(halvings, -1, -1))
    return piecewise_rule(points, np.append(first, np.arange(2, count + 1)) / count)


def piecewise_rule(points: int, ends: Array) -> tuple[Array, Array]:
    """Nodes and weights on pieces between all the ends."""
    nodes, weights = gauss_legendre(points)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * (nodes + 1) / 2).ravel(), (width * weights / 2).ravel()


def halvings_towards(distance: float) -> int:
    """How often a piece of length one is halved for a singularity so far behind its beginning."""
    return max(ceil(-log2(max(distance, _NEAREST))), 0)
