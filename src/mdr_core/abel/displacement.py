"""Displacements of the surface: integrals of a slope over the contact, seen from a radius.

Integrated by parts, both transforms have positive integrands and nothing to cancel:
int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx = int_c^r g'(x) arccos(x/r) dx, and outside the contact
int_0^a (g(a) - g(x))/sqrt(r^2 - x^2) dx = int_0^a g'(x) arcsin(x/r) dx.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import asinh, ceil, inf, log, sqrt
from typing import Final

import numpy as np

from mdr_core.abel.roots import Weight
from mdr_core.quadrature import (
    composite_rule,
    graded_rule,
    halvings_towards,
    nodes_of_pieces,
    piecewise_rule,
)
from mdr_core.typing import Array, Indices

# Above this part of the reach the angle resolves the root at r; below it the weight is smooth in
# the logarithm of its distance from the break.
_UPPER: Final = 0.5
_PIECE: Final = 2.0
# Radii below exp(-690) have no digits.
_LOG_RANGE: Final = 690.0
# Power of the radius that one piece resolves.
_STEEP: Final = 8.0
# A stretch over which the radius grows by a factor of e takes so many times the pieces.
_SPARE: Final = 1.5
# Of the tolerance, and of what is left of an integral next to the axis: so much is left out there.
_LEFT_OUT: Final = 1e-2
_LEAST_LEFT_OUT: Final = 1e-17


@dataclass(frozen=True)
class Branch:
    """A stretch base <= x <= stop on which weight(x, s, index) = g'(x) s/x is analytic in s.

    s = sqrt(x^2 - base^2); the stretch may begin only at `start`. On the axis g(x) is at most
    `tip_size` g(a) (x/a)^`tip`; `steepness` is the highest power that g' resembles, `pole` a radius
    beyond `stop` where it is infinite, and at s = -`behind` it is not analytic. `of_powers`: g' is
    a sum of powers, as smooth in log(x) at any distance from the edge as these are.
    """

    base: float
    weight: Weight
    stop: float = inf
    start: float = 0.0
    tip: float = 1.0
    tip_size: float = 1.0
    of_powers: bool = False
    steepness: float = 3.5
    pole: float = inf
    behind: float = inf


# K(x, leg), leg = sqrt(r^2 - x^2): what the slope is weighted with.
Kernel = Callable[[Array, Array], Array]


def arccosine(x: Array, leg: Array) -> Array:
    """arccos(x/r)."""
    return np.asarray(np.arctan2(leg, x))


def arcsine(x: Array, leg: Array) -> Array:
    """arcsin(x/r)."""
    return np.asarray(np.arctan2(x, leg))


@dataclass(frozen=True)
class _Way:
    """What the slope is weighted with, as x^`order` on the axis, and how exactly."""

    kernel: Kernel
    order: int
    rtol: float

    @property
    def points(self) -> int:
        """Nodes of a piece."""
        return nodes_of_pieces(self.rtol)

    def felt(self, branch: Branch) -> float:
        """How far down from the upper end x itself is felt, in its logarithm."""
        return log(branch.tip_size / max(_LEFT_OUT * self.rtol, _LEAST_LEFT_OUT))

    def reach(self, branch: Branch) -> float:
        """The same of the integral; where that grows without an end, down to the last double."""
        power = branch.tip + self.order
        return min(self.felt(branch) / power, _LOG_RANGE) if power > 0 else _LOG_RANGE


@dataclass(frozen=True)
class _Ends:
    """Where a stretch starts and ends: its s there, sqrt(r^2 - x^2) there, and s at r itself."""

    s_low: Array
    s_high: Array
    s_r: Array
    leg_low: Array
    leg_high: Array


def slope_integral(
    branches: Sequence[Branch], low: Array, high: Array, r: Array, rtol: float, *, outside: bool
) -> Array:
    """Return int_low^high g'(x) K(x/r) dx, K = arcsin for `outside`, else arccos; high <= r.

    Source: mdr-5, Eqs. (5.41), (5.75), integrated by parts; notes, §7. All of shape (m,).
    """
    way = _Way(arcsine, 1, rtol) if outside else _Way(arccosine, 0, rtol)
    total = np.zeros_like(r)
    for branch in branches:
        start = np.maximum(low, max(branch.base, branch.start))
        end = np.minimum(high, branch.stop)
        index = np.flatnonzero(end > start)
        if index.size:
            start, end, far = start[index], end[index], r[index]
            s_low, s_high, s_r = (_leg(x, branch.base) for x in (start, end, far))
            leg_low, leg_high = (np.sqrt((far - x) * (far + x)) for x in (start, end))
            ends = _Ends(s_low, s_high, s_r, leg_low, leg_high)
            total[index] += _branch(branch, ends, way)
    return total


def annulus_integral(
    branches: Sequence[Branch],
    low: Array,
    width: Array,
    below: Callable[[float], Array],
    kernel: Kernel,
    rtol: float,
) -> Array:
    """Return int_low^r g'(x) K(x, sqrt(r^2 - x^2)) dx, r = low + width, however narrow that is.

    `below(x)` = low - x, with the digits that the difference of two radii may not have.
    Source: notes, §7. All of shape (m,).
    """
    way = _Way(kernel, 0, rtol)
    total = np.zeros_like(low)
    for branch in branches:
        begin = max(branch.base, branch.start)
        inside = below(begin) + width > 0
        if branch.stop < inf:
            inside &= below(branch.stop) < 0
        index = np.flatnonzero(inside)
        if index.size:
            ends = _annulus_ends(branch, low, width, below, index)
            total[index] += _branch(branch, ends, way)
    return total


def _annulus_ends(
    branch: Branch, low: Array, width: Array, below: Callable[[float], Array], index: Indices
) -> _Ends:
    """The part of a branch between low and r = low + width, every leg from its own width."""
    base, begin, stop = branch.base, max(branch.base, branch.start), branch.stop
    c, w = low[index], width[index]
    r = c + w

    def leg(gap: Array, at: float | Array) -> Array:
        """sqrt(r^2 - at^2) from gap = r - at."""
        return np.asarray(np.sqrt(np.maximum(gap, 0.0) * (r + at)))

    above_base, above_begin = below(base)[index], below(begin)[index]
    s_r = leg(above_base + w, base)
    later = above_begin < 0
    at_begin = sqrt((begin - base) * (begin + base))
    s_low = np.where(later, at_begin, np.sqrt(np.maximum(above_base, 0.0) * (c + base)))
    leg_low = np.where(later, leg(above_begin + w, begin), leg(w, c))
    if not stop < inf:
        return _Ends(s_low, s_r, s_r, leg_low, np.zeros_like(s_r))
    past = below(stop)[index] + w
    s_high = np.where(past > 0, sqrt((stop - base) * (stop + base)), s_r)
    return _Ends(s_low, s_high, s_r, leg_low, leg(past, stop))


def _branch(branch: Branch, ends: _Ends, way: _Way) -> Array:
    base, s_r, s_low, s_high = branch.base, ends.s_r, ends.s_low, ends.s_high
    split = np.minimum(np.maximum(_UPPER * s_r, s_low), s_high)
    # Angles from the point itself, s = s_r cos(alpha): the narrow end is the exact one.
    top = np.arctan2(ends.leg_high, s_high)
    leg_split = np.where(split > s_low, np.sqrt((s_r - split) * (s_r + split)), ends.leg_low)
    # On a stretch too narrow for s itself the legs still tell its ends apart.
    upper = (split < s_high) | (split <= s_low)
    span = np.where(upper, np.arctan2(leg_split, split) - top, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        stretch = float(np.max(np.where(upper, np.log(s_high / split), 0.0)))
    nodes, weights = _rule(branch, way.points, _pole_distance(branch, ends, top, span), stretch)
    alpha = top + nodes[:, None] * span
    s, leg = s_r * np.cos(alpha), s_r * np.sin(alpha)
    x = np.hypot(base, s)
    everything = np.arange(s_r.size)
    total = span * (weights @ (branch.weight(x, s, everything) * way.kernel(x, leg) * leg))
    index = np.flatnonzero(split > s_low)
    if index.size:
        total[index] += _lower(branch, s_low[index], split[index], s_r[index], way)
    return np.asarray(total)


def _pole_distance(branch: Branch, ends: _Ends, top: Array, span: Array) -> float:
    """How far beyond the upper end the pole lies in the angle, at least, in parts of a stretch."""
    if not branch.pole < inf or not (seen := span > 0).any():
        return inf
    s_pole = sqrt((branch.pole - branch.base) * (branch.pole + branch.base))
    # Imaginary for a point below the pole.
    at_pole = np.arccos(s_pole / ends.s_r[seen] + 0j)
    return float((np.abs(at_pole - top[seen]) / span[seen]).min())


def _rule(branch: Branch, points: int, pole: float, stretch: float) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], finer towards 0 where a pole lies closely behind it.

    `stretch` is the logarithm of the largest part of the radius that is to be covered.
    """
    pieces = max(ceil(branch.steepness * min(1.0, _SPARE * stretch) / _STEEP), 1)
    if not pole < inf:
        return composite_rule(points, pieces)
    return graded_rule(points, halvings_towards(pole * pieces) + 1, pieces)


def _lower(branch: Branch, low: Array, high: Array, s_r: Array, way: _Way) -> Array:
    """From s = low to high <= s_r/2, in y = arcsinh(s/base), or log(s) on the axis."""
    base = branch.base
    if base > 0:
        upper, lower = np.arcsinh(high / base), np.arcsinh(low / base)
        length = upper - lower
    else:
        upper = np.log(high)
        with np.errstate(divide="ignore"):
            length = np.minimum(upper - np.log(low), way.reach(branch))
        length = np.minimum(length, upper + _LOG_RANGE)
    if not length.max() > 0:
        # Two neighbouring doubles may have one logarithm.
        return np.zeros_like(s_r)
    piece = _PIECE * min(1.0, _STEEP / branch.steepness)
    count = max(ceil(length.max() / piece), 1)
    part = count / float(length.max())
    if branch.of_powers:
        nodes, weights = _rule_of_powers(piece, way.felt(branch), float(length.max()), way.points)
    elif branch.pole < inf:
        # From the upper end on the pole is log(pole/x) away.
        distance = log(branch.pole / float(np.hypot(base, high.max())))
        nodes, weights = graded_rule(way.points, halvings_towards(distance * part) + 1, count)
    elif branch.behind < inf:
        distance = asinh(branch.behind / base)
        nodes, weights = graded_rule(way.points, halvings_towards(distance * part), count)
        nodes = 1 - nodes
    else:
        nodes, weights = composite_rule(way.points, count)
    y = upper - nodes[:, None] * length
    s, run = (base * np.sinh(y), base * np.cosh(y)) if base > 0 else (np.exp(y), np.exp(y))
    x = np.hypot(base, s)
    leg = np.sqrt((s_r - s) * (s_r + s))
    values = branch.weight(x, s, np.arange(s_r.size)) * way.kernel(x, leg) * run
    return np.asarray(length * (weights @ values))


def _rule_of_powers(piece: float, felt: float, length: float, points: int) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1] of the length, down from the upper end.

    The higher a power, the sooner nothing is felt of it: at the distance y none above felt/y.
    """
    ends = [0.0]
    while ends[-1] < length:
        ends.append(ends[-1] + max(piece, _PIECE * _STEEP * ends[-1] / felt))
    return piecewise_rule(points, np.array(ends) / ends[-1])


def _leg(x: Array, base: float) -> Array:
    return np.asarray(np.sqrt((x - base) * (x + base)))
