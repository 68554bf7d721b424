"""What lies between the stick edge c and the contact's edge a: steps of depth and force.

Near incipient slip the annulus is narrow, and a difference of two values at a and c has no digits
left; its width, in the contact coordinate, is therefore the unknown, and steps over a narrow
annulus are integrals. Source: notes, §1 and §4.
"""

from collections.abc import Callable
from functools import lru_cache
from math import ceil, inf
from typing import Final

import numpy as np
from numpy.polynomial import legendre

from mdr_core.foundation import (
    Function,
    coordinate_from_depth,
    coordinate_from_force,
    force_slope,
    invert,
)
from mdr_core.profiles import Profile
from mdr_core.quadrature import gauss_legendre
from mdr_core.sweeps import alike_with
from mdr_core.typing import Array

# Up to this part of the contact an annulus is narrow; beyond, a difference keeps its digits.
_NARROW: Final = 0.05
_POINTS: Final = 16
# Up to this part of full slip the width is the unknown, beyond it the stick edge itself.
_HALF: Final = 0.5
# Pieces of the energy's integral shrink towards the axis until g is down to rounding; where the
# profile is steep there are others, over each of which its power changes by exp(2.4).
_SHRINK: Final = 0.5
_PIECES: Final = 54
_STEEP: Final = 3.5
_RESOLVED: Final = 2.4
_MOMENT_POINTS: Final = 16
_MOMENT_BLOCK: Final = 65_536

# The slope at a coordinate, which is that of a break and how far it lies past it.
_Slope = Callable[[Array, Array, Array], Array]


def depth_step(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return d(a) - d(c) = int_c^a g' dx [length]. Source: mdr-5, Eq. (5.20); notes, §1.

    `stick` = coordinate - width: of the two, each is used where it has its digits.
    """
    closed = profile.depth_step(coordinate, width, stick)
    if closed is not None:
        return closed
    ends = coordinate, width, stick
    return _step(profile, profile.depth, profile.depth_slope_behind, ends)


def force_step(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return (F(a) - F(c))/E* = 2 int_c^a x g' dx [length^2]. Source: mdr-5, Eq. (5.19)."""
    closed = profile.force_step(coordinate, width, stick)
    if closed is not None:
        return closed

    def slope(at: Array, start: Array, past: Array) -> Array:
        return 2 * profile.contact_radius(at) * profile.depth_slope_behind(at, start, past)

    return _step(profile, profile.reduced_force, slope, (coordinate, width, stick))


def stick_from_force(
    profile: Profile, coordinate: Array, ratio: Array, rest: Array
) -> tuple[Array, Array]:
    """Return the stick edge at F_x = ratio mu F_N and the annulus' width, in the coordinate.

    `rest` = 1 - ratio, formed where it has its digits. Source: mdr-5, Eq. (5.19).
    """
    closed = profile.stick_from_force_ratio(coordinate, ratio, rest)
    if closed is not None:
        return closed
    return _stick(
        profile,
        (coordinate, ratio, rest),
        profile.reduced_force,
        force_slope(profile),
        force_step,
        coordinate_from_force,
    )


def stick_from_depth(
    profile: Profile, coordinate: Array, ratio: Array, rest: Array
) -> tuple[Array, Array]:
    """Return the same at u_x = ratio u_x,max. Source: mdr-5, Eq. (5.20)."""
    closed = profile.stick_from_depth_ratio(coordinate, ratio, rest)
    if closed is not None:
        return closed
    return _stick(
        profile,
        (coordinate, ratio, rest),
        profile.depth,
        profile.depth_slope,
        depth_step,
        coordinate_from_depth,
    )


def slip_moment(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return int_c^a (g(a) - g(x)) (g(x) - g(c)) dx [length^3].

    It grows like the third power of the width: both factors are integrals of g' over parts of
    the annulus, formed from its values at the nodes. Source: notes, §6.
    """
    closed = profile.slip_moment(coordinate, width, stick)
    if closed is None:
        return np.asarray(_moment(profile, coordinate, width))
    missing = np.isnan(closed)
    if not missing.any():
        return closed
    high, span = (np.broadcast_to(part, closed.shape)[missing] for part in (coordinate, width))
    named = (
        (name, np.broadcast_to(value, closed.shape)[missing] if name in profile.swept else value)
        for name, value in profile.parameters.items()
    )
    filled = np.array(closed)
    filled[missing] = _moment(alike_with(profile, named), high, span)
    return filled


def _stick(
    profile: Profile,
    given: tuple[Array, Array, Array],
    function: Function,
    slope: Function,
    step: Callable[[Profile, Array, Array, Array], Array],
    inverse: Callable[[Profile, Array], Array],
) -> tuple[Array, Array]:
    """Solve for the stick edge c, where function(a) - function(c) = ratio function(a).

    `given` are a, ratio and 1 - ratio. While slip begins the width is the unknown of the
    `step`; later on it is the edge, by the `inverse` of the function.
    """
    coordinate, ratio, rest = given
    total = function(coordinate)
    shape = np.broadcast_shapes(coordinate.shape, total.shape, ratio.shape)
    coordinate, total = np.broadcast_to(coordinate, shape), np.broadcast_to(total, shape)
    early = np.broadcast_to(ratio < _HALF, shape)
    target = np.where(early, ratio * total, 0.0)
    reach = coordinate - profile.first_coordinate
    with np.errstate(divide="ignore", invalid="ignore"):
        first = slope(coordinate)
        # Where the slope is infinite, the load says nothing of the width.
        known = (target > 0) & (first < inf)
        start = np.where(known, np.minimum(target / first, reach / 2), reach / 2)
    # A width below all doubles is none.
    target = np.where(start > 0, target, 0.0)

    def log_slope(width: Array, value: Array) -> Array:
        return width * slope(coordinate - width) / value

    width = invert(
        lambda width: step(profile, coordinate, width, coordinate - width),
        log_slope,
        target,
        np.where(start > 0, start, 1.0),
        np.zeros(shape),
        np.where(reach > 0, reach, 2.0),
        f"{profile.kind}'s slip annulus",
    )
    late = inverse(profile, np.where(early, 0.0, rest * total))
    edge = np.where(early, coordinate - width, late)
    return edge, np.where(early, width, coordinate - late)


def _step(
    profile: Profile, function: Function, slope: _Slope, ends: tuple[Array, Array, Array]
) -> Array:
    """function(high) - function(low), by the integral of its slope where they are close."""
    high, width, low = np.broadcast_arrays(*ends)
    below = _break_below(profile, high)
    limit = (high - below[1]) / 2 if _has_many_breaks(profile) else _NARROW * high
    narrow = width <= limit
    if narrow.all():
        # An empty annulus may lie on a tip where the slope is infinite.
        return np.where(width > 0, _narrow_step(slope, high, width, below[0]), 0.0)
    if not narrow.any():
        return function(high) - function(np.maximum(low, 0.0))
    if profile.swept:
        # The functions are those of all scenes.
        wide = function(high) - function(np.maximum(low, 0.0))
        part = _narrow_step(slope, high, np.where(narrow, width, 0.0), below[0])
        return np.where(narrow, np.where(width > 0, part, 0.0), wide)
    result = np.zeros(narrow.shape)
    result[~narrow] = function(high[~narrow]) - function(np.maximum(low[~narrow], 0.0))
    few = narrow & (width > 0)
    result[few] = _narrow_step(slope, high[few], width[few], below[0][few])
    return result


def _break_below(profile: Profile, high: Array) -> tuple[Array, Array]:
    """The nearest break below each coordinate and the one before; zero where there is none."""
    if not _has_many_breaks(profile):
        nothing = np.zeros_like(high)
        if not profile.coordinate_breaks.size:
            return nothing, nothing
        # Of a sweep each scene has its own.
        own = profile.coordinate_breaks if profile.swept else profile.coordinate_breaks[0]
        return np.where(high > own, own, 0.0), nothing
    breaks = np.concatenate([[0.0, 0.0], profile.coordinate_breaks])
    index = np.searchsorted(breaks, high, side="left") - 1
    index = np.maximum(index, 1)
    return breaks[index], breaks[index - 1]


def _has_many_breaks(profile: Profile) -> bool:
    """Whether one scene has more than one break: only those do that take no arrays."""
    return profile.coordinate_breaks.size > 1 and not profile.swept


def _narrow_step(slope: _Slope, high: Array, width: Array, below: Array) -> Array:
    """int slope ds over [high - width, high], split at the break `below` if that is inside.

    Behind a break the slope is smooth in v, s = break + v^2.
    """
    low = high - width
    # Never through low itself: next to a break its rounding is a large part of low - below.
    beyond = np.maximum((high - below) - width, 0.0)
    top, bottom = np.sqrt(high - below), np.sqrt(beyond)
    inner = np.minimum(width, high - below)
    nodes, weights = gauss_legendre(_POINTS)
    with np.errstate(invalid="ignore"):
        half = np.where(inner > 0, inner / (top + bottom), 0.0) / 2
    v = bottom + np.multiply.outer(1 + nodes, half)
    past = v * v
    # Rounding must not carry a node beyond the edge: a break may lie there.
    at = np.minimum(below + past, high)
    with np.errstate(invalid="ignore"):
        total = half * _summed(weights, 2 * v * slope(at, below, past))
    outer = width - inner
    if np.any(outer > 0):
        s = low + np.multiply.outer(1 + nodes, outer / 2)
        values = np.where(outer > 0, slope(s, s, np.zeros_like(s)), 0.0)
        total = total + outer / 2 * _summed(weights, values)
    return np.asarray(total)


def _summed(weights: Array, values: Array) -> Array:
    """sum w_i values_i over the first axis, term by term: the same for one load as for many."""
    total = np.zeros(values.shape[1:])
    for weight, value in zip(weights, values, strict=True):
        total = total + weight * value
    return total


def _moment(profile: Profile, coordinate: Array, width: Array) -> Array:
    """`slip_moment` by pieces that shrink towards the axis and end on every break."""
    named = profile.parameters
    shape = np.broadcast_shapes(
        coordinate.shape, width.shape, *(np.shape(named[name]) for name in profile.swept)
    )
    high, width = np.broadcast_to(coordinate, shape), np.broadcast_to(width, shape)
    if profile.swept:
        return _moment_of_scenes(profile, high, width)
    result = np.empty(high.size)
    step = max(
        _MOMENT_BLOCK // ((profile.coordinate_breaks.size + 4 * _PIECES) * _MOMENT_POINTS), 1
    )
    for start in range(0, high.size, step):
        part = slice(start, start + step)
        result[part] = _moment_block(profile, high.ravel()[part], width.ravel()[part])
    return result.reshape(shape)


def _moment_of_scenes(profile: Profile, high: Array, width: Array) -> Array:
    """The same where every scene has its own profile, in blocks that fit into the cache."""
    named = {
        name: np.broadcast_to(value, high.shape).ravel()
        for name, value in profile.parameters.items()
    }
    # Steep scenes and sharp tips have other pieces than the rest.
    plain = profile.steepness <= _STEEP and profile.tip_exponent >= 1
    step = max(_MOMENT_BLOCK // (4 * _PIECES * _MOMENT_POINTS), 1) if plain else 1
    result = np.empty(high.size)
    for start in range(0, high.size, step):
        part = slice(start, start + step)
        block = alike_with(profile, ((name, value[part]) for name, value in named.items()))
        result[part] = _moment_block(block, high.ravel()[part], width.ravel()[part])
    return result.reshape(high.shape)


def _moment_block(profile: Profile, high: Array, width: Array) -> Array:
    breaks = profile.coordinate_breaks
    own = bool(breaks.size) and not _has_many_breaks(profile)
    # Ends of the pieces as distances below the contact's edge, where they have their digits.
    powers = np.arange(1, _PIECES)
    to_tip = np.arange(1, ceil(_PIECES / profile.tip_exponent))
    parts = [_SHRINK**to_tip]
    if profile.steepness > _STEEP:
        parts.append(np.exp(-_RESOLVED / profile.steepness) ** powers)
    shrinking = np.concatenate(parts)
    halves = high - np.multiply.outer(shrinking, high)
    if own:
        # Below its own break a profile may be steep as well.
        halves = np.concatenate([halves, high - np.multiply.outer(shrinking, breaks + 0 * high)])
    at_breaks = high - (breaks[None] if own else breaks[:, None])
    ends = np.sort(np.clip(np.concatenate([halves, at_breaks]), 0.0, width), axis=0)
    ends = np.concatenate([np.zeros_like(high)[None], ends, width[None]])
    length, low = np.diff(ends, axis=0), high - ends[1:]
    below, _ = _break_below(profile, low + length / 2)
    above_break = np.maximum((high - below) - ends[1:], 0.0)
    top, bottom = np.sqrt(above_break + length), np.sqrt(above_break)
    nodes, weights = gauss_legendre(_MOMENT_POINTS)
    with np.errstate(invalid="ignore"):
        half = np.where(length > 0, length / (top + bottom), 0.0)[..., None] / 2
    v = bottom[..., None] + half * (1 + nodes)
    past = v * v
    start = np.broadcast_to(below[..., None], past.shape)
    s = np.minimum(start + past, high[..., None])
    at_nodes = _over_nodes(profile)
    with np.errstate(all="ignore"):
        rise = np.where(half > 0, 2 * v * half * at_nodes.depth_slope_behind(s, start, past), 0.0)
        run = np.where(half > 0, 2 * v * half * at_nodes.radius_slope(s), 0.0)
    piece = (rise * weights).sum(axis=-1)
    # Rows run from the contact's edge inwards.
    above = _before(piece)
    # Summed from its own side: most of the rise may lie above.
    inside = _before(piece[::-1])[::-1]
    climbed = (rise[..., None, :] * _cumulative(_MOMENT_POINTS)).sum(axis=-1)
    to_edge = above[..., None] + (piece[..., None] - climbed)
    to_stick = inside[..., None] + climbed
    rows = (to_edge * to_stick * run * weights).sum(axis=-1)
    return _summed(np.ones(len(rows)), rows)


def _over_nodes(profile: Profile) -> Profile:
    """The profile whose scenes are the last axis but one."""
    if not profile.swept:
        return profile
    return alike_with(profile, ((n, value[:, None]) for n, value in profile.parameters.items()))


def _before(rows: Array) -> Array:
    """Sum of the rows before each."""
    return np.concatenate([np.zeros_like(rows[:1]), np.cumsum(rows[:-1], axis=0)])


@lru_cache(maxsize=4)
def _cumulative(points: int) -> Array:
    """Matrix of int_-1^(node i) of the polynomial through the values at the nodes."""
    nodes, _ = gauss_legendre(points)
    vander = legendre.legvander(nodes, points - 1)
    integrals = [legendre.legint(row, lbnd=-1) for row in np.eye(points)]
    values = np.stack([legendre.legval(nodes, row) for row in integrals], axis=1)
    return np.asarray(values @ np.linalg.inv(vander))
