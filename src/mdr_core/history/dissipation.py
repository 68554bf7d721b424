"""Energy lost to friction, from what slipped.

While the slip front runs down a piece of the polyline, from w_H to w_L, everything above it
slips by the front's own shift, under the friction of the depth d that the load then has:

    D/(mu E*) = |1 -+ k| int_L^H R dw,    R(w, d) = 2 int_w^d (x(w') - x(w)) dw'.

R is the reduced force of the springs above the front. Where depths are controlled d is linear
in w on a straight step, where forces are I(d) is linear in I(w): either way the integral is
closed in w, I and En = int I dw. Where front and edge are near each other that difference has
no digits, and positive integrals take its place. Source: notes, §10.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from mdr_core.foundation import coordinate_from_depth, coordinate_from_force
from mdr_core.history.branches import (
    NARROW,
    mean,
    radius_at_force,
    radius_slope_at_depth,
)
from mdr_core.history.memory import Pieces
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Below this relative difference a mean is taken from values between, not from a quotient.
_CLOSE: Final = 1e-4
# Pieces evaluated at once where each takes a square of nodes.
_BLOCK: Final = 512


def per_piece(profile: Profile, pieces: Pieces, *, by_force: bool) -> Array:
    """Return D/(mu E*) of every piece [length^3]."""
    result = np.zeros(len(pieces.step))
    slide = np.flatnonzero(pieces.everything)
    if slide.size and not by_force:
        # Under force control nothing lies beyond the brink of sliding.
        low, high = pieces.upper_gap[slide], pieces.lower_gap[slide]
        result[slide] = pieces.slip[slide] * _mean_force(profile, low, high)
    if profile.slips_at_once:
        return result
    partial = np.flatnonzero(~pieces.everything & (pieces.span > 0))
    level, span, slip, upper, lower = (
        rows[partial]
        for rows in (
            pieces.level,
            pieces.span,
            pieces.slip,
            pieces.upper_gap,
            pieces.lower_gap,
        )
    )
    reach = np.maximum(level + lower, level + span + upper)
    narrow = np.maximum(upper, lower) + span < NARROW * reach
    wide_front = _force_front if by_force else _depth_front
    narrow_front = _narrow_force_front if by_force else _narrow_depth_front
    for chosen, front in ((~narrow, wide_front), (narrow, narrow_front)):
        index = np.flatnonzero(chosen)
        for start in range(0, index.size, _BLOCK):
            part = index[start : start + _BLOCK]
            parts = level[part], span[part], upper[part], lower[part]
            # A difference of rounded numbers may fall below zero, a loss may not.
            area = np.maximum(front(profile, *parts), 0.0)
            result[partial[part]] = slip[part] / span[part] * area
    return result


def _depth_front(profile: Profile, level: Array, span: Array, upper: Array, lower: Array) -> Array:
    """int R dw with d linear in w, closed."""
    ends = np.stack([level, level + span])
    gaps = np.stack([lower, upper])
    s = coordinate_from_depth(profile, ends)
    force, energy = profile.reduced_force(s), profile.reduced_energy(s)
    load = span * _mean_force(profile, ends[0] + gaps[0], ends[1] + gaps[1])
    edges = force[1] * gaps[1] - force[0] * gaps[0]
    climb = (gaps[1] - gaps[0]) / span - 1
    return np.asarray(load + climb * (energy[1] - energy[0]) - edges)


def _force_front(profile: Profile, level: Array, span: Array, upper: Array, lower: Array) -> Array:
    """int R dw with I(d) linear in I(w), closed."""
    s = coordinate_from_force(profile, np.stack([level, level + span]))
    depth, energy = profile.depth(s), profile.reduced_energy(s)
    rise, gained = depth[1] - depth[0], energy[1] - energy[0]
    climb = (upper - lower) / span
    # int (I(d) - I(w)) dw, with the gap I(d) - I(w) linear in I(w).
    above = lower * rise + climb * (gained - level * rise)
    # int 2 x (d - w) dw = int (d - w) dI.
    top = _mean_depth(profile, level + lower, level + span + upper)
    return np.asarray(above - span * top + depth[1] * (level + span) - depth[0] * level - gained)


def _narrow_depth_front(
    profile: Profile, level: Array, span: Array, upper: Array, lower: Array
) -> Array:
    def overlap(t: Array, w: Array) -> Array:
        gap = lower[:, None] + (upper - lower)[:, None] * t
        return _overlap(profile, w, gap)

    return span * mean(overlap, level, span)


def _narrow_force_front(
    profile: Profile, level: Array, span: Array, upper: Array, lower: Array
) -> Array:
    def overlap(t: Array, force: Array) -> Array:
        gap = lower[:, None] + (upper - lower)[:, None] * t
        # dw = dI/(2 x): the gap in depth with the digits of that in force.
        deeper = gap * mean(lambda _, at: 0.5 / radius_at_force(profile, at), force, gap)
        s = coordinate_from_force(profile, force)
        return _overlap(profile, profile.depth(s), deeper) / (2 * profile.contact_radius(s))

    return span * mean(overlap, level, span)


def _overlap(profile: Profile, w: Array, gap: Array) -> Array:
    """R = 2 int_w^d (d - w') dx [length^2], over a narrow gap."""
    return 2 * gap * gap * mean(lambda t, at: (1 - t) * radius_slope_at_depth(profile, at), w, gap)


def _mean_force(profile: Profile, low: Array, high: Array) -> Array:
    """Mean of I over the depths between [length^2]: (En(high) - En(low))/(high - low)."""
    s = coordinate_from_depth(profile, np.stack([low, high]))
    energy = profile.reduced_energy(s)
    return _mean(
        low, high, lambda difference: (energy[1] - energy[0]) / difference,
        lambda _, w: profile.reduced_force(coordinate_from_depth(profile, w)),
    )  # fmt: skip


def _mean_depth(profile: Profile, low: Array, high: Array) -> Array:
    """Mean of d over the reduced forces between [length]: (d I - En)/(high - low)."""
    s = coordinate_from_force(profile, np.stack([low, high]))
    integral = profile.depth(s) * np.stack([low, high]) - profile.reduced_energy(s)
    return _mean(
        low, high, lambda difference: (integral[1] - integral[0]) / difference,
        lambda _, force: profile.depth(coordinate_from_force(profile, force)),
    )  # fmt: skip


def _mean(
    low: Array,
    high: Array,
    quotient: Callable[[Array], Array],
    between: Callable[[Array, Array], Array],
) -> Array:
    difference = high - low
    close = np.abs(difference) <= _CLOSE * np.maximum(low, high)
    result = quotient(np.where(close, 1.0, difference))
    index = np.flatnonzero(close)
    if index.size:
        result[index] = mean(between, low[index], difference[index])
    return result
