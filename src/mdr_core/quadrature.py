"""Gauss-Legendre rules for integrands that are analytic in a strip about the real axis.

The substitutions of `mdr_core.abel` turn every singular stress integral into one whose
integrand h(y) is analytic for |Im y| < pi/2 and grows no faster than exp(growth |Re y|). The error
of a rule for such functions is bounded a priori. Each integral therefore takes only the nodes that
its length and the tolerance need, and nothing is evaluated twice.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, floor, inf, log2, log10, pi
from typing import Final

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_legendre

from mdr_core.elementwise import every, some
from mdr_core.typing import Array, Chosen, Flags, Indices

# h(y, index): y has shape (nodes, m) and may be overwritten; index (m,) selects the integrals.
Integrand = Callable[[Array, Chosen], Array]

# Points of the rules for any integral.
_POINTS: Final = (2, 3, 4, 5, 6, 8, 12, 16, 24, 48)
# Points of the rules on [-H, H] for an even integrand, of which half are evaluated.
_EVEN_POINTS: Final = (4, 6, 8, 10, 12, 16, 24, 48)
# Points of the rule for pieces of a long integral, within 5 % of the fewest nodes per unit length.
_PIECE_POINTS: Final = 24
# Nodes evaluated in the time of one more call of an integrand, by measurement.
_CALL: Final = 2000
# Logarithm of the largest double, rounded down.
_LOG_LARGEST: Final = 700.0
# Parts of the widest ellipse among which the best bound is searched.
_ELLIPSES: Final = np.linspace(0.1, 1.0, 10)
# Bisections of the logarithm of a half length, to 1e-8.
_BISECTIONS: Final = 30
# Nodes of pieces of half length 1 in a strip of pi/2, by the smallest tolerance that they reach.
_NODES_OF_PIECES: Final = ((1e-4, 8), (1e-8, 12), (0.0, 20))
PIECE: Final = 2.0
"""Length of those pieces."""
# Distance from the end of a piece below which a singularity lies on it.
_NEAREST: Final = 2.0**-52
# Nodes times integrals evaluated at once, so that temporaries stay in the processor's cache.
_BLOCK: Final = 12_288


@dataclass(frozen=True)
class Analytic:
    """Strip |Im y| < strip in which an integrand is analytic, and its growth exp(growth |Re y|).

    The singularities that the substitutions leave lie at |Im y| = pi/2, outside the strip.
    An integrand of high degree needs the `fewest` points on any interval, however short. `zeros`
    counts the zeros in or next to the interval, near which the integrand is small throughout.
    `before` is the distance of a near singularity on the real axis before y = 0.
    """

    growth: float = 2.0
    strip: float = 0.47 * pi
    fewest: int = 0
    zeros: int = 0
    before: float = inf


DEFAULT: Final = Analytic()


@lru_cache(maxsize=64)
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Return the nodes and weights of the rule on [-1, 1]."""
    nodes, weights = roots_legendre(points)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


def in_order(weights: Array, values: Array) -> Array:
    """Return sum w_i values_i over the first axis, bit-identical for one load and for many."""
    if weights.size * values.shape[-1] > _BLOCK:
        total = np.zeros(values.shape[1:])
        for weight, value in zip(weights, values, strict=True):
            total = total + weight * value
        return total
    added = (1,) * (values.ndim - weights.ndim)
    spread = weights.reshape(weights.shape[:1] + added + weights.shape[1:])
    terms = np.multiply(spread, values, order="C")
    # NumPy adds numbers that are contiguous in pairs, rows in their order.
    return np.add.accumulate(terms)[-1] if terms[0].size == 1 else np.add.reduce(terms)


def error_bound(points: int | Indices, half_length: float | Array, analytic: Analytic) -> Array:
    """Bound the relative error of the `points`-point rule on an interval of length 2H.

    For h analytic and |h| <= M in the Bernstein ellipse of parameter rho the error is below
    (64/15) M rho^(-2n)/(1 - rho^-2). With |h| growing like exp(growth |Re y|) the best ellipse
    within the strip gives the bound, relative to the largest h inside the interval. The ellipse
    is farther from each zero than the interval by at most its semi-axis.

    Source: trefethen, Thm 19.3.
    """
    # log(rho), up to the ellipse that touches the edge of the strip.
    part = np.multiply.outer(_ELLIPSES, np.arcsinh(analytic.strip / half_length))
    semi_axis = np.cosh(part)
    log_bound = analytic.growth * half_length * (semi_axis - 1) - 2 * points * part
    log_bound += analytic.zeros * np.log(semi_axis)
    bound = np.exp(np.minimum(log_bound, _LOG_LARGEST)) / -np.expm1(-2 * part)
    # The mean of a growing integrand, or of one with zeros, is by so much below its maximum.
    factor = 64 / 15 * (1 + analytic.growth * half_length) * (1 + analytic.zeros)
    return np.asarray(bound.min(axis=0) * factor)


@lru_cache(maxsize=512)
def _half_lengths(rules: tuple[int, ...], decade: int, analytic: Analytic) -> Array:
    """Largest half length at which the bound of each rule is below 10^decade, ascending."""
    points = np.array(rules)
    low = np.full(points.shape, min(1e-3, 1e-2 / analytic.growth))
    high = np.full(points.shape, 40.0)
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        good = error_bound(points, middle, analytic) < 10.0**decade
        low, high = np.where(good, middle, low), np.where(good, high, middle)
    return np.where(points >= analytic.fewest, low, 0.0)


def integrate(
    h: Integrand,
    length: Array,
    rtol: float,
    lower: Array | None = None,
    *,
    even: Flags | bool = True,
    analytic: Analytic = DEFAULT,
) -> Array:
    """Return the integrals of h over [lower, lower + length], h analytic in the strip.

    Where all h are even and all begin at zero, the rule of 2n points on [-length, length] costs n
    evaluations and converges as twice as many.

    Source: notes, §5; trefethen, Thm 19.3.

    Parameters
    ----------
    h : integrand.
    length : lengths, accurate also where the ends are close, shape (m,).
    rtol : relative tolerance.
    lower : lower ends, shape (m,); None for zero.
    even : True where h is even in y.
    analytic : strip and growth of h.
    """
    if analytic.before < inf:
        rule = rule_towards(analytic.before, float(length.max(initial=0.0)), rtol)
        return _apply(h, rule, lower, length, slice(0, length.size))
    halved = every(even) and (lower is None or not some(lower))
    points = _EVEN_POINTS if halved else _POINTS
    # The half lengths are computed once for each decade of the tolerance.
    decade = max(floor(log10(rtol) + 1e-9), -15)

    def by_rule(number: int, index: Chosen) -> Array:
        span, start = length[index], None if lower is None else lower[index]
        if number == len(points):
            piece = 2 * float(_half_lengths((_PIECE_POINTS,), decade, analytic)[0])
            rule = composite_rule(_PIECE_POINTS, ceil(float(span.max()) / piece))
        else:
            rule = (_half_rule if halved else composite_rule)(points[number])
        return _apply(h, rule, start, span, index)

    limits, half = _half_lengths(points, decade, analytic), length if halved else length / 2
    return _by_groups(by_rule, half, limits, [count // (1 + halved) for count in points])


def _by_groups(
    by_rule: Callable[[int, Chosen], Array],
    half_length: Array,
    longest: Array,
    nodes: Sequence[int],
) -> Array:
    """Evaluate integrals that share a rule in one call; the rule after the last one uses pieces.

    A few integrals are merged with those of the next finer rule where one more call would take
    longer than the additional `nodes`. Up to the half length `longest` a rule meets the tolerance.
    """
    if half_length.size * nodes[-1] <= _CALL:
        finest = int(longest.searchsorted(half_length.max(initial=0.0)))
        return by_rule(finest, slice(0, half_length.size))
    rule = longest.searchsorted(half_length)
    counts = np.bincount(rule).tolist()
    present = [number for number, count in enumerate(counts) if count]
    result = np.empty_like(half_length)
    first, waiting, more = 0, 0, 0
    for this, finer in pairwise([*present, len(nodes)]):
        waiting += counts[this]
        if finer < len(nodes):
            more += waiting * (nodes[finer] - nodes[this])
            if more <= _CALL:
                continue
        if waiting == half_length.size:
            return by_rule(this, slice(0, waiting))
        index = _chosen(((rule >= first) & (rule <= this)).nonzero()[0])
        result[index] = by_rule(this, index)
        first, waiting, more = this + 1, 0, 0
    return result


def _chosen(index: Indices) -> Chosen:
    """Ascending indices, as a slice if they are contiguous, as those of sorted radii are."""
    first, last = int(index[0]), int(index[-1])
    return slice(first, last + 1) if last - first + 1 == index.size else index


def _apply(
    h: Integrand, rule: tuple[Array, Array], lower: Array | None, length: Array, index: Chosen
) -> Array:
    """Rule on [0, 1] applied to [lower, lower + length], in blocks that stay in the cache."""
    nodes, weights = rule
    step = max(_BLOCK // nodes.size, 1)
    if length.size > step:
        result = np.empty_like(length)
        for start in range(0, length.size, step):
            part = slice(start, start + step)
            low = None if lower is None else lower[part]
            result[part] = _apply(h, rule, low, length[part], _part_of(index, part))
        return result
    y = nodes[:, None] * length
    if lower is not None:
        y += lower
    return np.asarray(weights @ h(y, index) * length)


def _part_of(index: Chosen, part: slice) -> Chosen:
    if isinstance(index, slice):
        return slice(index.start + part.start, min(index.start + part.stop, index.stop))
    return index[part]


@lru_cache(maxsize=64)
def _half_rule(points: int) -> tuple[Array, Array]:
    """Positive nodes of the rule on [-1, 1], and their weights for an even h over [0, 1]."""
    nodes, weights = gauss_legendre(points)
    return nodes[points // 2 :], weights[points // 2 :]


@lru_cache(maxsize=256)
def composite_rule(points: int, count: int = 1) -> tuple[Array, Array]:
    """Return nodes and weights on [0, 1], cut into `count` equal pieces."""
    return piecewise_rule(points, np.linspace(0.0, 1.0, count + 1))


@lru_cache(maxsize=4)
def cumulative_rule(points: int) -> tuple[Array, Array, Array]:
    """Return nodes and weights on [0, 1], and the weights of the integrals from 0 to each node.

    Columns, shape (points, 1); the weights of the value at node j are [j, :, 0].
    """
    nodes, _ = gauss_legendre(points)
    vander = legendre.legvander(nodes, points - 1)
    integrals = [legendre.legint(row, lbnd=-1) for row in np.eye(points)]
    values = np.stack([legendre.legval(nodes, row) for row in integrals], axis=1)
    cumulative = (values @ np.linalg.inv(vander)).T / 2
    shares, weights = composite_rule(points, 1)
    return shares[:, None], weights[:, None], cumulative[:, :, None]


def nodes_of_pieces(rtol: float) -> int:
    """Return the number of nodes of a piece of length 2 where h is analytic for |Im y| < pi/2."""
    return next(count for limit, count in _NODES_OF_PIECES if rtol >= limit)


@lru_cache(maxsize=256)
def graded_rule(points: int, halvings: int, count: int = 1) -> tuple[Array, Array]:
    """Return nodes and weights on [0, 1], in equal pieces of which the first halves towards 0."""
    first = np.append(0.0, 0.5 ** np.arange(halvings, -1, -1))
    return piecewise_rule(points, np.append(first, np.arange(2, count + 1)) / count)


def piecewise_rule(points: int, ends: Array) -> tuple[Array, Array]:
    """Return nodes and weights on the pieces between the ends."""
    nodes, weights = gauss_legendre(points)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * (nodes + 1) / 2).ravel(), (width * weights / 2).ravel()


def halvings_towards(distance: float) -> int:
    """Return the halvings of a piece of length 1 for a singularity at a distance before it."""
    return max(ceil(-log2(max(distance, _NEAREST))), 0)


def rule_towards(distance: float, length: float, rtol: float) -> tuple[Array, Array]:
    """Return nodes and weights on [0, 1] for [0, length], singular at a distance before 0."""
    count = max(ceil(length / PIECE), 1)
    halvings = halvings_towards(distance * count / length) if length > 0 else 0
    return graded_rule(nodes_of_pieces(rtol), halvings, count)
