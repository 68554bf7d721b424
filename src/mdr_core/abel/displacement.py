"""Displacements of the surface: integrals of a slope over the contact, seen from a radius.

Integrated by parts, both transforms have positive integrands and nothing to cancel:
int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx = int_c^r g'(x) arccos(x/r) dx, and outside the contact
int_0^a (g(a) - g(x))/sqrt(r^2 - x^2) dx = int_0^a g'(x) arcsin(x/r) dx.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, inf, log, log2, sqrt
from typing import Final

import numpy as np

from mdr_core.abel.roots import Weight
from mdr_core.quadrature import composite_rule, graded_rule
from mdr_core.typing import Array

# Above this part of the reach the angle resolves the root at r; below it the weight is smooth in
# the logarithm of its distance from the break.
_UPPER: Final = 0.5
_PIECE: Final = 2.0
# Radii below exp(-690) have no digits.
_LOG_RANGE: Final = 690.0
# Power of the radius that one piece resolves.
_STEEP: Final = 8.0
# Nodes by the tolerance: pieces have a half length of one in a strip of pi/2.
_POINTS: Final = ((1e-4, 8), (1e-8, 12), (0.0, 20))


@dataclass(frozen=True)
class Branch:
    """A stretch base <= x <= stop on which weight(x, s, index) = g'(x) s/x is analytic in s.

    s = sqrt(x^2 - base^2); the stretch may begin only at `start`. Below `reach` times the radius
    nothing of the integral is left; `steepness` is the highest power that g' resembles, `pole`
    a radius beyond `stop` where it is infinite.
    """

    base: float
    weight: Weight
    stop: float = inf
    reach: float = 1e-18
    start: float = 0.0
    steepness: float = 3.5
    pole: float = inf


def slope_integral(
    branches: Sequence[Branch], low: Array, high: Array, r: Array, rtol: float, *, outside: bool
) -> Array:
    """Return int_low^high g'(x) K(x/r) dx, K = arcsin for `outside`, else arccos; high <= r.

    Source: mdr-5, Eqs. (5.41), (5.75), integrated by parts; notes, §7. All of shape (m,).
    """
    points = next(count for limit, count in _POINTS if rtol >= limit)
    total = np.zeros_like(r)
    for branch in branches:
        start = np.maximum(low, max(branch.base, branch.start))
        end = np.minimum(high, branch.stop)
        index = np.flatnonzero(end > start)
        if index.size:
            ends = start[index], end[index], r[index]
            total[index] += _branch(branch, *ends, points, outside=outside)
    return total


def _branch(
    branch: Branch, low: Array, high: Array, r: Array, points: int, *, outside: bool
) -> Array:
    base = branch.base
    s_low, s_high, s_r = (_leg(x, base) for x in (low, high, r))
    split = np.minimum(np.maximum(_UPPER * s_r, s_low), s_high)
    # Angles from the point itself, s = s_r cos(alpha): the narrow end is the exact one.
    top = np.arctan2(np.sqrt((r - high) * (r + high)), s_high)
    leg_low = np.sqrt((r - low) * (r + low))
    leg_split = np.where(split > s_low, np.sqrt((s_r - split) * (s_r + split)), leg_low)
    span = np.where(split < s_high, np.arctan2(leg_split, split) - top, 0.0)

    def kernel(x: Array, leg: Array) -> Array:
        return np.arctan2(x, leg) if outside else np.arctan2(leg, x)

    nodes, weights = _rule(branch, points, float(high.max()))
    alpha = top + nodes[:, None] * span
    s, leg = s_r * np.cos(alpha), s_r * np.sin(alpha)
    x = np.hypot(base, s)
    everything = np.arange(r.size)
    total = span * (weights @ (branch.weight(x, s, everything) * kernel(x, leg) * leg))
    index = np.flatnonzero(split > s_low)
    if index.size:
        total[index] += _lower(
            branch, s_low[index], split[index], s_r[index], points, outside=outside
        )
    return np.asarray(total)


def _rule(branch: Branch, points: int, highest: float) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], finer towards 0 where a pole lies close behind it."""
    pieces = max(ceil(branch.steepness / _STEEP), 1)
    if not branch.pole < inf:
        return composite_rule(points, pieces)
    # In the angle the pole lies at i sqrt(2 (pole/x - 1)).
    distance = sqrt(max(2 * (branch.pole / highest - 1), 1e-15))
    return graded_rule(points, max(ceil(-log2(distance)) + 1, 1))


def _lower(
    branch: Branch, low: Array, high: Array, s_r: Array, points: int, *, outside: bool
) -> Array:
    """From s = low to high <= s_r/2, in y = arcsinh(s/base), or log(s) on the axis."""
    base = branch.base
    if base > 0:
        upper, lower = np.arcsinh(high / base), np.arcsinh(low / base)
        length = upper - lower
    else:
        upper = np.log(high)
        with np.errstate(divide="ignore"):
            length = np.minimum(upper - np.log(low), -np.log(branch.reach))
        length = np.minimum(length, upper + _LOG_RANGE)
    piece = _PIECE * min(1.0, _STEEP / branch.steepness)
    count = max(ceil(length.max() / piece), 1)
    nodes, weights = composite_rule(points, count)
    if branch.pole < inf:
        # From the upper end on the pole is log(pole/x) away.
        distance = max(log(branch.pole / float(np.hypot(base, high.max()))), 1e-15)
        halvings = max(ceil(log2(float(length.max()) / distance)) + 1, 1)
        nodes, weights = graded_rule(points, max(halvings, ceil(log2(count)) + 1))
    y = upper - nodes[:, None] * length
    s, run = (base * np.sinh(y), base * np.cosh(y)) if base > 0 else (np.exp(y), np.exp(y))
    x = np.hypot(base, s)
    leg = np.sqrt((s_r - s) * (s_r + s))
    kernel = np.arctan2(x, leg) if outside else np.arctan2(leg, x)
    values = branch.weight(x, s, np.arange(s_r.size)) * kernel * run
    return np.asarray(length * (weights @ values))


def _leg(x: Array, base: float) -> Array:
    return np.asarray(np.sqrt((x - base) * (x + base)))
