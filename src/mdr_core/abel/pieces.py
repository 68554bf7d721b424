"""A slope between the edges of a table, resolved behind each of them in polynomials.

G(x) = g'(x) carries a root at every edge b, which s = sqrt(x^2 - b^2) takes away.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.abel.interpolation import chebyshev_points
from mdr_core.abel.panels import bisect
from mdr_core.abel.roots import leg
from mdr_core.typing import Array, Flags, Indices

# Of b and x - b: near an edge x alone would have lost its distance from it.
Slope = Callable[[Array, Array], Array]

# Degree of the polynomials of a panel that is not easily resolved.
DEGREE: Final = 23
# So many of the last coefficients of a panel are looked at.
_LAST: Final = 2
_FEWEST: Final = 8
# Numbers of nodes are multiples of it: panels alike are looked at together.
_STEP: Final = 4
# So many nodes resolve a panel that is one polynomial, at first, where no more than this is asked
# and kinks that are missed would not matter: a tenth of them is felt.
_FIRST_LOOK: Final = 12
_COARSE: Final = 1e-7
_MISSED: Final = 10.0
_SPARE: Final = 1.5
# How much of g' the root at the axis is, at most.
_AXIS: Final = 1.0
_NEGLIGIBLE: Final = 1e-16
_EPS: Final = float(np.finfo(float).eps)
_TINY: Final = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class Pieces:
    """Polynomials of s between `start` and `stop`, each in the panel behind the edge `panel`.

    `coefficients` (pieces, degree + 1) are Chebyshev; ascending in panel and place. `error` is the
    largest tail.
    """

    panel: Indices
    start: Array
    stop: Array
    coefficients: Array
    error: float


def pieces_behind(
    slope: Slope, edges: Array, kinks: Array | None = None, tolerance: float = 1e-14
) -> Pieces:
    """Resolve G in each panel: at as many nodes as should be enough, else by bisection.

    `kinks` (panels,) are the parts of G that begin at each edge, relative to G; without them all
    panels take all nodes. `tolerance` bounds the last coefficients of an easy panel.

    Source: notes, §5.

    Raises
    ------
    AccuracyError : G is not piecewise smooth.
    """
    base = edges[:-1]
    length = leg(edges[1:], base)
    if kinks is None:
        counts = np.full(base.size, DEGREE + 1)
    else:
        counts = _counts(base, length, kinks, tolerance)
    coefficients, at_end, tail = _looked_at(slope, base, length, counts)
    every = np.arange(base.size)
    hard = np.flatnonzero(~(tail <= tolerance))
    if hard.size and counts[hard].min() <= DEGREE:
        every_node = np.full(hard.size, DEGREE + 1)
        coefficients[hard], _, tail[hard] = _looked_at(slope, base[hard], length[hard], every_node)
        hard = hard[~(tail[hard] <= tolerance)]
    if not hard.size:
        return Pieces(every, np.zeros_like(length), length, coefficients, float(tail.max()))
    # The pressure on the axis holds int G/x and feels G itself there; where G grows towards the
    # axis that pressure is infinite, and elsewhere int G is what counts.
    at_edge, at_tip = abs(float(at_end[-1])), abs(float(at_end[0])) * float(edges[1])
    places, cut, finer, worst = _bisected(slope, base, length, hard, at_edge, at_tip)
    kept = np.delete(every, hard)
    panel = np.append(kept, cut)
    start = np.append(np.zeros(kept.size), places[:, 0])
    stop = np.append(length[kept], places[:, 1])
    order = np.lexsort((start, panel))
    coefficients = np.concatenate([coefficients[kept], finer])[order]
    error = max(worst, float(tail[kept].max(initial=0.0)))
    return Pieces(panel[order], start[order], stop[order], coefficients, error)


def _counts(base: Array, length: Array, kinks: Array, tolerance: float) -> Indices:
    """How many nodes each panel needs, by the roots of g' in s that lie next to it.

    They are that of the edge before, at -length^2 of the panel before, as large as the kink
    there, and that of x = sqrt(b^2 + s^2) itself, at -b^2. The coefficients fall like the powers of
    Bernstein's ellipse through them.
    """
    before = np.empty_like(length)
    before[0], before[1:] = np.inf, length[:-1] / length[1:]
    kink = np.append(0.0, kinks[:-1])
    needed = np.full(base.size, float(_FEWEST))
    for distance, size in ((before, kink), (base / length, np.full_like(base, _AXIS))):
        u = -1 + 2j * distance[1:]
        ellipse = (np.abs(u - 1) + np.abs(u + 1)) / 2
        ellipse += np.sqrt(ellipse * ellipse - 1)
        with np.errstate(divide="ignore"):
            fall = np.log(size[1:] / tolerance) / np.log(ellipse)
        needed[1:] = np.maximum(needed[1:], fall + _SPARE)
    counts = _STEP * np.ceil(np.clip(needed, 0, DEGREE + 1) / _STEP).astype(int)
    return np.asarray(counts)


def _looked_at(
    slope: Slope, base: Array, length: Array, counts: Indices
) -> tuple[Array, Array, Array]:
    """Coefficients from so many nodes, values at the last, and tails relative to the largest."""
    most = DEGREE + 1
    used = np.arange(most) < counts[:, None]
    s = np.zeros(used.shape)
    different = sorted(set(counts.tolist()))
    for count in different:
        rows = counts == count
        s[rows, :count] = np.multiply.outer(length[rows], (1 + chebyshev_points(count)[0]) / 2)
    values = np.zeros(used.shape)
    values[used] = slope(np.repeat(base, counts), _offset(base[:, None], s)[used])
    largest = np.abs(values).max(axis=1)
    coefficients = np.zeros(used.shape)
    tail = np.empty(base.size)
    for count in different:
        rows = np.flatnonzero(counts == count)
        found = values[rows, :count] @ chebyshev_points(count)[1].T
        coefficients[rows, :count] = found
        tail[rows] = np.abs(found[:, -_LAST:]).max(axis=1)
    at_end = values[np.arange(base.size), counts - 1]
    return coefficients, at_end, tail / np.where(largest > 0, largest, 1.0)


def whole_pieces(slope: Slope, edges: Array, tolerance: float, kink: float) -> Pieces | None:
    """Resolve G in each panel without a cut; None where some panel is not one polynomial.

    The tolerance is that of the last coefficients, relative to the smallest value in the panel;
    `kink` bounds the parts of G that begin inside of panels, relative to G.
    """
    base = edges[:-1]
    length = leg(edges[1:], base)
    panel = np.arange(base.size)
    coefficients, tails = np.zeros((base.size, DEGREE + 1)), np.empty(base.size)
    rest = panel
    few = tolerance >= _COARSE and kink <= _MISSED * tolerance
    for count in (_FIRST_LOOK, DEGREE + 1) if few else (DEGREE + 1,):
        points, inverse = chebyshev_points(count)
        s = np.multiply.outer(length[rest], (1 + points) / 2)
        b = np.repeat(base[rest], count)
        values = slope(b, _offset(b, s.ravel())).reshape(s.shape)
        found = values @ inverse.T
        coefficients[rest, :count] = found
        smallest = np.abs(values).min(axis=1)
        tail = np.abs(found[:, -_LAST:]).max(axis=1)
        tails[rest] = tail / np.where(smallest > 0, smallest, 1.0)
        rest = rest[~(tail <= tolerance * smallest)]
        if not rest.size:
            start = np.zeros_like(length)
            return Pieces(panel, start, length, coefficients, float(tails.max()))
    return None


def _offset(base: Array, s: Array) -> Array:
    """x - b of s."""
    return np.asarray(s * s / np.maximum(base + np.hypot(base, s), _TINY))


def _bisected(
    slope: Slope, base: Array, length: Array, panels: Indices, at_edge: float, at_tip: float
) -> tuple[Array, Indices, Array, float]:
    def in_s(s: Array, tags: Indices) -> Array:
        b = base[tags]
        return slope(b, _offset(b, s))

    def blur(s: Array, tags: Indices) -> Array:
        # x = sqrt(b^2 + s^2) is rounded to eps x, its root s to eps x^2/s.
        return np.asarray(_EPS * (np.square(base[tags]) / s + s))

    def tip_is_done(high: Array, largest: Array) -> Flags:
        steep = (largest > at_edge) & (high * largest <= _NEGLIGIBLE * at_tip)
        return np.asarray(steep | (largest <= _NEGLIGIBLE * at_edge))

    intervals = np.stack([np.zeros(panels.size), length[panels]], axis=1)
    return bisect(in_s, intervals, panels, blur, tip_is_done)
