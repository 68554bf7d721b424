"""Functions resolved into Chebyshev panels, and their forward Abel transforms.

A function that is smooth between breaks becomes a short list of polynomials; declared breaks are
panel ends, undeclared ones are closed in on by bisection. Polynomials have no surprises left: all
later quadratures know their error beforehand.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.abel.interpolation import chebyshev_points
from mdr_core.errors import AccuracyError
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Flags, Indices

Function = Callable[[Array], Array]

_DEGREE: Final = 23
_TAIL: Final = 1e-14
_EPS: Final = float(np.finfo(float).eps)
# A panel this narrow, relative to its place, is a jump.
_JUMP_WIDTH: Final = 8 * _EPS
# Where a panel is cut: about its middle, but at no place where a round number would hide a kink
# that nobody declared, on a cut.
_CUT: Final = 0.4812118
# Panels shrink by it this often towards the axis and each break: down to 1e-12 of the whole.
_STEPS: Final = 38
# A narrower panel has its nodes on too few doubles.
_NODE_WIDTH: Final = 1e3 * _EPS
_ROUNDING: Final = 4 * _EPS
_FIRST_WIDTH: Final = 1e-9
_RISE: Final = 0.02
# Rounds of carrying values from rounded nodes to the exact ones.
_CARRIES: Final = 3
# What the axis panel may still hold, relative to the first one looked at.
_NEGLIGIBLE: Final = 1e-17
_MOST_CUTS: Final = 4000
# A panel this narrow, relative to its place, whose tail is this large, holds a jump.
_NEEDLE: Final = 1e-11
_UNRESOLVED: Final = 1e-8
# Panels narrower than this, relative to their place, are closing in on a break.
_CLOSING_IN: Final = 1e-3
# Values below have lost digits to underflow: there is no structure left to resolve.
_UNDERFLOW: Final = float(np.finfo(float).tiny) / _EPS
_NODES: Final = 32

_POINTS, _TO_COEFFICIENTS = chebyshev_points(_DEGREE + 1)
_TO_SLOPES: Final = chebyshev.chebval(_POINTS, chebyshev.chebder(np.eye(_DEGREE + 1), axis=0)).T


@dataclass(frozen=True)
class Panels:
    """Chebyshev coefficients (panels, degree + 1) between `edges` (panels + 1) [any].

    `error` is the largest tail of any panel, relative to the panel's largest value.
    """

    edges: Array
    coefficients: Array
    error: float
    found: tuple[float, ...] = ()
    """Where the function jumps and nobody had declared it."""

    def at_ends(self) -> tuple[Array, Array]:
        """Values at the left and the right end of each panel."""
        signs = (-1.0) ** np.arange(self.coefficients.shape[1])
        return self.coefficients @ signs, self.coefficients.sum(axis=1)


def resolve(function: Function, upper: float, breaks: Sequence[float] = ()) -> Panels:
    """Return the function on [0, upper] as Chebyshev panels of degree 23.

    A panel whose last two coefficients are not down to rounding is bisected, so that a kink or a
    jump nobody declared ends in panels of rounding's width. The rounding of the nodes
    themselves, eps r f', is not mistaken for structure.

    Source: notes, §5.

    Parameters
    ----------
    function : vectorised, finite in the open panels.
    breaks : radii across which nothing is interpolated [length].

    Raises
    ------
    AccuracyError : more than 4000 cuts would be needed: the function is noise.

    Examples
    --------
    Eq. (5.25): the factor of g for f = r^3 is 3 pi/4.

    >>> panels = resolve(lambda r: 3 * r**2, 1.0)
    >>> float(f"{forward(panels, np.array([1.0]))[0]:.6g}")
    2.35619
    """
    inner = sorted({float(b) for b in breaks if 0 < b < upper})
    ends = np.array([0.0, *inner, upper])
    graded = [_graded(function, low, high) for low, high in pairwise(ends)]
    intervals = np.concatenate(graded)
    first = intervals[:1, 1]
    negligible = _NEGLIGIBLE * float(np.abs(function(first))[0] * first[0])
    intervals, _, coefficients, error = bisect(
        lambda r, _: function(r),
        intervals,
        np.zeros(len(intervals), int),
        lambda r, _: _EPS * r,
        lambda high, largest: high * largest <= negligible,
    )
    return _without_needles(Panels(np.append(intervals[:, 0], upper), coefficients, error))


def _without_needles(panels: Panels) -> Panels:
    """The same with panels of rounding's width replaced by the jump that they closed in on.

    Their error is left out of account: a jump is exact.
    """
    low, high = panels.edges[:-1], panels.edges[1:]
    tail = np.abs(panels.coefficients[:, -2:]).max(axis=1)
    unresolved = tail > _UNRESOLVED * np.abs(panels.coefficients).max(axis=1)
    needle = (high - low <= _NEEDLE * high) & (low > 0) & unresolved
    if not needle.any():
        return panels
    # A run of needles is one jump: it moves to where the run ends.
    last = needle & ~np.append(needle[1:], False)
    edges = np.append(low[~needle], panels.edges[-1])
    kept = panels.coefficients[~needle]
    return Panels(edges, kept, _largest_tail(kept), tuple(high[last].tolist()))


def _largest_tail(coefficients: Array) -> float:
    """Largest of the last two coefficients, relative to the largest of their panel."""
    scale = np.abs(coefficients).max(axis=1)
    tail = np.abs(coefficients[:, -2:]).max(axis=1)
    return float((tail[scale > _UNDERFLOW] / scale[scale > _UNDERFLOW]).max(initial=0.0))


def find_breaks(function: Function, upper: float) -> list[float]:
    """Return the radii in (0, upper) where the function has a kink, a jump or a root's end.

    Bisection closes in on each, as far as it is felt: runs of narrow panels mark one place, the
    narrowest of them where it is.

    Source: notes, §5.

    Raises
    ------
    AccuracyError : the function is noise.
    """
    edges = resolve(function, upper).edges
    width = np.diff(edges)
    narrow = np.flatnonzero((width < _CLOSING_IN * edges[1:]) & (edges[:-1] > 0))
    runs = np.split(narrow, np.flatnonzero(np.diff(narrow) > 1) + 1)
    tightest = [run[np.argmin(width[run] / edges[1:][run])] for run in runs if run.size]
    return [float((edges[i] + edges[i + 1]) / 2) for i in tightest]


def _graded(function: Function, low: float, high: float) -> Array:
    """Intervals that shrink towards `low` where the function vanishes there, to keep its digits.

    Elsewhere they would only lose the digits of its derivative.
    """
    near, far = np.abs(function(low + (high - low) * np.array([_FIRST_WIDTH, 0.5])))
    if low > 0 and near > _RISE * far:
        return np.array([[low, high]])
    widths = (high - low) * _CUT ** np.arange(_STEPS, -1, -1)
    ends = low + widths[widths > _NODE_WIDTH * low]
    return np.stack([np.append(low, ends[:-1]), ends], axis=1)


def bisect(
    function: Callable[[Array, Indices], Array],
    intervals: Array,
    tags: Indices,
    blur: Callable[[Array, Indices], Array],
    tip_is_done: Callable[[Array, Array], Flags],
) -> tuple[Array, Indices, Array, float]:
    """Split tagged intervals until each is one polynomial; ascending in tag and place.

    `function(points, tags)` takes flat arrays; `blur(points, tags)` is the points' rounding.
    `tip_is_done(high, largest)` says when a panel that starts at zero needs no more cutting.
    Returns intervals, tags, coefficients and the largest tail kept.
    """
    done: list[tuple[Array, Indices, Array]] = []
    worst, count, most = 0.0, 0, len(intervals) + _MOST_CUTS
    while len(intervals):
        low, high = intervals[:, 0], intervals[:, 1]
        half = (high - low)[:, None] / 2
        nodes = low[:, None] + half * (1 + _POINTS)
        values = function(nodes.ravel(), np.repeat(tags, _POINTS.size)).reshape(nodes.shape)
        coefficients = values @ _TO_COEFFICIENTS.T
        # The nodes are rounded where they are large against the panel: carry the values over.
        missed = (1 + _POINTS) - (nodes - low[:, None]) / half
        for _ in range(_CARRIES):
            moved = values + missed * (coefficients @ _TO_SLOPES.T)
            coefficients = moved @ _TO_COEFFICIENTS.T
        tail = np.abs(coefficients[:, -2:]).max(axis=1)
        largest = np.abs(values).max(axis=1)
        narrow = (high - low <= _JUMP_WIDTH * high) | ((low == 0) & tip_is_done(high, largest))
        steepness = np.abs(np.diff(values, axis=1) / np.diff(nodes, axis=1))
        rounding = (steepness * blur(nodes[:, 1:], tags[:, None])).max(axis=1)
        smooth = (tail <= _TAIL * largest + 2 * rounding) & ~_steep(values, low, high)
        good = smooth | narrow | (largest < _UNDERFLOW)
        done.append((intervals[good], tags[good], _chopped(coefficients[good], largest[good])))
        seen = (largest > _UNDERFLOW) & good & ~narrow
        worst = max(worst, float((tail[seen] / largest[seen]).max(initial=0.0)))
        count += int(good.sum())
        intervals, tags = _split(intervals[~good]), np.tile(tags[~good], 2)
        if count + len(intervals) > most:
            raise AccuracyError(
                f"the function is not piecewise smooth: it needs more than {most} panels"
            )
    places, kept_tags, kept = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.lexsort((places[:, 0], kept_tags))
    return places[order], kept_tags[order], kept[order], worst


def _chopped(coefficients: Array, largest: Array) -> Array:
    """Without the trailing coefficients that are rounding: differentiated, they would grow."""
    real = np.abs(coefficients) > _ROUNDING * largest[:, None]
    needed = np.flip(np.maximum.accumulate(np.flip(real, axis=1), axis=1), axis=1)
    return np.where(needed, coefficients, 0.0)


def _steep(values: Array, low: Array, high: Array) -> Flags:
    """Panels that rise so much that their left end would lose its relative digits.

    The first panel behind the axis or a break is left alone: there the function may vanish.
    """
    rises = np.abs(values[:, 0]) < _RISE * np.abs(values[:, -1])
    return rises & (low > 0) & (high - low > _FIRST_WIDTH * high)


def _split(intervals: Array) -> Array:
    """Cut the intervals in two: all lefts, then all rights."""
    low, high = intervals[:, 0], intervals[:, 1]
    middle = low + _CUT * (high - low)
    return np.concatenate([np.stack([low, middle], axis=1), np.stack([middle, high], axis=1)])


def forward(slope: Panels, x: Array) -> Array:
    """Return g(x) = x int_0^x F(r)/sqrt(x^2 - r^2) dr from the panels of F = f'.

    Source: mdr-5, Eq. (5.74).

    Parameters
    ----------
    slope : from `resolve`.
    x : places, 0 <= x <= the last edge [length], shape (m,).

    Examples
    --------
    Eq. (5.5): g = x^2/R of the paraboloid f = r^2/(2R), here R = 2.

    >>> slope = resolve(lambda r: r / 2.0, 3.0)
    >>> [float(f"{g:.6g}") for g in forward(slope, np.array([0.0, 1.0, 3.0]))]
    [0.0, 0.5, 4.5]
    """
    return x * _angle_sums(slope, x, np.zeros_like(x))


def forward_moment(slope: Panels, x: Array) -> Array:
    """Return 2 int_0^x r^2 F(r)/sqrt(x^2 - r^2) dr = 2 int_0^x y g'(y) dy.

    Source: notes, §1.
    """
    return 2 * _angle_sums(slope, x, np.zeros_like(x), weight=lambda r: r * r)


@dataclass(frozen=True)
class Jumps:
    """Radii `at` where F jumps, and by how much (`size`)."""

    at: Array
    size: Array

    def contribution(self, base: Array, offset: Array) -> Array:
        """Sum of J b/sqrt(x^2 - b^2) over the jumps at b < x = base + offset, but b = base."""
        total = np.zeros_like(base)
        for b, size in zip(self.at, self.size, strict=True):
            gap = (base - b) + offset
            beyond = (gap > 0) & (base != b)
            gap = gap[beyond]
            total[beyond] += size * b / np.sqrt(gap * (2 * b + gap))
        return total


def slope_source(slope: Panels) -> Panels:
    """Panels of (r F)' from those of F: what g'(x) is the transform of. Source: notes, §1."""
    half = np.diff(slope.edges) / 2
    middle = slope.edges[:-1] + half
    derivative = chebyshev.chebder(slope.coefficients, axis=1) / half[:, None]
    source = slope.coefficients.copy()
    source[:, :-1] += middle[:, None] * derivative
    # u T_0 = T_1, u T_k = (T_(k-1) + T_(k+1))/2.
    scaled = half[:, None] * derivative
    source[:, 1] += scaled[:, 0]
    source[:, :-2] += scaled[:, 1:] / 2
    source[:, 2:] += scaled[:, 1:] / 2
    return Panels(slope.edges, source, slope.error)


def forward_slope(source: Panels, base: Array, offset: Array) -> Array:
    """Return int_0^x (r F)'/sqrt(x^2 - r^2) dr: g'(x) but for the jumps of F.

    x = base + offset: near a break, x alone would have lost its distance from it.
    Source: mdr-5, Eq. (5.74), differentiated. `source` comes from `slope_source`.
    """
    return _angle_sums(source, base, offset)


def jumps_at(slope: Panels, breaks: Sequence[float]) -> Jumps:
    """Jumps of the resolved function at its declared breaks and those found. Source: notes, §1."""
    left, right = slope.at_ends()
    found = np.searchsorted(slope.edges, np.unique([*breaks, *slope.found]))
    inner = [int(i) for i in found if 0 < i < len(left)]
    size = np.array([left[i] - right[i - 1] for i in inner])
    scale = np.array([np.abs(slope.coefficients[i - 1 : i + 1]).sum() for i in inner])
    # The function's own change over the rounding of the break is no jump.
    widths = np.diff(slope.edges)
    rise = np.array([np.abs(right[i] - left[i]) / widths[i] for i in inner])
    real = np.abs(size) > 64 * _EPS * scale + 16 * _EPS * slope.edges[inner] * rise
    return Jumps(slope.edges[inner][real], size[real])


def _angle_sums(
    panels: Panels, base: Array, offset: Array, weight: Function | None = None
) -> Array:
    """Sum over panels of int F weight / sqrt(x^2 - r^2) dr, r = x cos(alpha), x = base + offset.

    Offsets from each panel's left end are formed without cancellation, so that a function that
    vanishes at a break keeps its relative digits beyond it.
    """
    nodes, weights = gauss_legendre(_NODES)
    total = np.zeros_like(base)
    edges = panels.edges
    for low, high, row in zip(edges[:-1], edges[1:], panels.coefficients, strict=True):
        above = (base - low) + offset
        index = np.flatnonzero(above > 0)
        above = above[index]
        beyond = np.maximum((base[index] - high) + offset[index], 0.0)
        x = base[index] + offset[index]
        width = np.minimum(high - low, above)
        alpha, span = _angles(low, width, above, beyond, x)
        turn = span / 2 * (1 + nodes[:, None])
        place = 2 * x * np.sin(turn / 2) * np.sin(alpha - turn / 2)
        values = chebyshev.chebval(np.minimum(2 * place / (high - low) - 1, 1), row)
        if weight is not None:
            values = values * weight(low + place)
        total[index] += span / 2 * (weights @ values)
    return total


def _angles(low: float, width: Array, above: Array, beyond: Array, x: Array) -> tuple[Array, Array]:
    """arccos(low/x), and how much it exceeds arccos(high/x), high = low + width <= x.

    `above` = x - low and `beyond` = x - high are given with their digits.
    """
    high = low + width
    leg_low, leg_high = np.sqrt(above * (x + low)), np.sqrt(beyond * (x + high))
    # x (high^2 - low^2)/(...) is (high leg_low - low leg_high)/x without the cancellation.
    cross = x * (width * (high + low) / (high * leg_low + low * leg_high))
    span = np.arctan2(cross, (low * high + leg_low * leg_high) / x)
    return np.arctan2(leg_low, low), span
