"""Equivalent one-dimensional problem: steps of depth and force between c and a, and stick edges.

Near incipient slip the difference of a function between a and c suffers cancellation. Then the
unknown is the width of the slip annulus in the contact coordinate, and the difference is an
integral of the slope.

Source: notes, §1 and §4.
"""

from collections.abc import Callable
from math import inf
from typing import Final

import numpy as np

from mdr_core.elementwise import every, full, in_order, is_number, some, where
from mdr_core.inversion import Function, invert
from mdr_core.profiles import Profile
from mdr_core.quadrature import NODES, gauss_legendre
from mdr_core.typing import Array
from mdr_core.validation import require_inside

NARROW: Final = 0.05
"""A step over an annulus up to this width, relative to a, is an integral. The width is the unknown
as long as the load is at most this part of the full-slip load. Beyond these limits differences
amplify rounding errors at most 20-fold. Loads that differ from the full-slip load by less than this
part of it are ill-conditioned (`conditioning`)."""
# Slope at a coordinate. Its arguments are the coordinate, a break, and the distance from the break.
_Slope = Callable[[Array, Array, Array], Array]


def coordinate_from_radius(profile: Profile, contact_radius: Array) -> Array:
    """Return the contact coordinate of a contact radius.

    Raises InputError beyond the end of the profile, and for a flat punch.
    """
    if not every(profile.domain == inf):
        beyond = contact_radius > profile.domain
        require_inside(("load", "contact_radius"), beyond, profile)
    return profile.coordinate_from_radius(contact_radius)


def depth_step(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return d(a) - d(c) = int_c^a g' dx [length].

    Source: mdr-5, Eq. (5.20); notes, §1.

    Parameters
    ----------
    profile : parameters broadcast with the annuli.
    coordinate : a as a contact coordinate.
    width, stick : a - c and c in the contact coordinate, each accurate by itself.
    """
    closed = profile.depth_step(coordinate, width, stick)
    if closed is not None:
        return closed
    return _step(profile, profile.depth, profile.depth_slope_beyond, (coordinate, width, stick))


def force_step(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return (F_N(a) - F_N(c))/E* = 2 int_c^a x g' dx [length^2].

    Source: mdr-5, Eq. (5.19). Parameters: see `depth_step`.
    """
    closed = profile.force_step(coordinate, width, stick)
    if closed is not None:
        return closed

    def slope(at: Array, start: Array, past: Array) -> Array:
        return 2 * profile.contact_radius(at) * profile.depth_slope_beyond(at, start, past)

    return _step(profile, profile.reduced_force, slope, (coordinate, width, stick))


def stick_edge(
    profile: Profile, coordinate: Array, ratio: Array, rest: Array, *, of_force: bool
) -> tuple[Array, Array]:
    """Return stick edge and width of the slip annulus, both in the contact coordinate.

    At small ratios the unknown is the width. At large ratios it is c, from the closed inverse if
    there is one. Source: mdr-5, Eqs. (5.19), (5.20).

    Parameters
    ----------
    profile : parameters broadcast with the loads.
    coordinate : contact radii as contact coordinates.
    ratio, rest : F_x/(mu F_N) and 1 - F_x/(mu F_N), each accurate by itself; ratios of
        displacements if `of_force` is false.

    Returns
    -------
    c and a - c in the contact coordinate.
    """
    if parts := profile.stick_parts(ratio, rest, of_force=of_force):
        return coordinate * parts[0], coordinate * parts[1]
    step = force_step if of_force else depth_step
    slope_at = profile.force_slope if of_force else profile.depth_slope
    with np.errstate(divide="ignore", invalid="ignore"):
        total, first = profile.load_and_slope(coordinate, of_force=of_force)
    if not is_number(ratio * total):
        coordinate, total, ratio, rest = np.broadcast_arrays(coordinate, total, ratio, rest)
    early = ratio < NARROW
    with np.errstate(divide="ignore", invalid="ignore"):
        late = coordinate
        if not every(early):
            goal = where(early, 0.0, rest * total)
            late = profile.coordinate_from_load(goal, of_force=of_force)
        if not some(early):
            return late, coordinate - late
        target = where(early, ratio * total, 0.0)
        # An infinite slope gives no first approximation of the width.
        known = (target > 0) & (first < inf)
        start = where(known, np.minimum(target / first, coordinate / 2), coordinate / 2)
    # A width that underflows is zero.
    target = where(start > 0, target, 0.0)

    def sloped(width: Array) -> tuple[Array, Array]:
        stick = coordinate - width
        value = step(profile, coordinate, width, stick)
        return value, width * slope_at(stick) / value

    width = invert(
        sloped,
        target,
        where(start > 0, start, 1.0),
        full(0.0, target),
        where(coordinate > 0, coordinate, 2.0),
    )
    return where(early, coordinate - width, late), where(early, width, coordinate - late)


def _step(
    profile: Profile, function: Function, slope: _Slope, ends: tuple[Array, Array, Array]
) -> Array:
    """Difference function(a) - function(c), by the integral of the slope in a narrow annulus."""
    high, width, low = ends if is_number(sum(ends)) else np.broadcast_arrays(*ends)
    below, before = break_below(profile, high)
    limit = np.minimum(NARROW * high, (high - before) / 2)
    if profile.steepens:
        # The steeper the load, the narrower the annulus over which it is smooth.
        rate = slope(high, below, high - below)
        limit = np.minimum(limit, NARROW * function(high) / where(rate > 0, rate, inf))
    narrow = width <= limit
    if every(narrow):
        return _narrow_step(slope, high, width, below)
    wide = function(high) - function(where(low < 0, 0.0, low))
    if not some(narrow):
        return wide
    return where(narrow, _narrow_step(slope, high, where(narrow, width, 0.0), below), wide)


def _narrow_step(slope: _Slope, high: Array, width: Array, below: Array) -> Array:
    """Integral of the slope over [high - width, high], split at the break `below` if it is inside.

    Beyond a break the slope is smooth in v, s = break + v^2.
    """
    low = high - width
    # Next to a break, low - below would be dominated by the rounding error of low.
    beyond = np.maximum((high - below) - width, 0.0)
    top, bottom = np.sqrt(high - below), np.sqrt(beyond)
    inner = np.minimum(width, high - below)
    nodes, weights = gauss_legendre(NODES)
    with np.errstate(invalid="ignore"):
        half = where(inner > 0, inner / (top + bottom), 0.0) / 2
        v = bottom + np.multiply.outer(1 + nodes, half)
        past = v * v
        # Rounding must not carry a node beyond the edge, where a break may lie.
        at = np.minimum(below + past, high)
        total = half * in_order(weights, 2 * v * slope(at, below, past))
    outer = width - inner
    if some(outer > 0):
        s = low + np.multiply.outer(1 + nodes, outer / 2)
        values = np.where(outer > 0, slope(s, s, np.zeros_like(s)), 0.0)
        total = total + outer / 2 * in_order(weights, values)
    # At the tip the slope may be infinite.
    return where(width > 0, total, 0.0)


def break_below(profile: Profile, high: Array) -> tuple[Array, Array]:
    """Return the two nearest breaks below each coordinate; zero where there is none."""
    breaks = profile.coordinate_breaks
    if profile.swept and breaks.size:
        # Every case of a sweep has its own break.
        return where(high > breaks, breaks, 0.0), full(0.0, high)
    padded = np.concatenate([[0.0, 0.0], breaks])
    index = np.maximum(np.searchsorted(padded, high, side="left") - 1, 1)
    return padded[index], padded[index - 1]


def has_many_breaks(profile: Profile) -> bool:
    """True for tables of several intervals, whose parameters are never arrays."""
    return profile.coordinate_breaks.size > 1 and not profile.swept
