"""Energy lost to friction, from what slipped.

While the slip front runs down a piece of the polyline, from w_H to w_L, everything above it
slips by the front's own shift, under the friction of the depth d that the load then has:

    D/(mu E*) = |1 -+ k| int_L^H R dw,    R(w, d) = 2 int_w^d (x(w') - x(w)) dw'.

R is the reduced force of the springs above the front. Where depths are controlled d is linear
in w on a straight step, where forces are I(d) is linear in I(w): either way the integral is
closed in w, I and En = int I dw. Where front and edge are near each other that difference has
no digits, and positive integrals take its place. Source: notes, §10.
"""

from collections.abc import Callable, Iterator
from math import ceil, log
from typing import Final

import numpy as np

from mdr_core import annulus
from mdr_core.foundation import coordinate_from_depth, coordinate_from_force
from mdr_core.history.branches import (
    breaks_below,
    coordinate_from_level,
    ends_below,
    integral,
    mean,
    radius_at_force,
    radius_slope_at_depth,
)
from mdr_core.history.memory import Pieces
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices

# Below this relative difference a mean is taken from values between, not from a quotient.
_CLOSE: Final = 1e-4
# Pieces evaluated at once where each takes a square of nodes.
_BLOCK: Final = 512
# Up to this part of the level a gap is near: the closed form loses its third power.
_NEAR: Final = 0.25
# Up to so many radii of its flat a contact is shallow.
_SHALLOW: Final = 1.5
# So short a way, relative to the level, costs the closed form more digits than a rule.
_THIN: Final = 1e-4
# A load is constant on the way of a front that moves as far as its gap, up to rounding.
_EVEN: Final = 1e-12
# A piece that comes nearer to the axis than so many gaps has digits enough for the closed form.
_GAPS: Final = 4.0

_FOURFOLD: Final = 4.0

# Level at the lower end, span, gap at the upper end, gap at the lower end.
_Rows = tuple[Array, Array, Array, Array]


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
    given = pieces.level, pieces.span, pieces.upper_gap, pieces.lower_gap
    level, span, upper, lower = (row[partial] for row in given)
    reach = np.maximum(level + lower, level + span + upper)
    gap = np.maximum(upper, lower)
    close = gap < _NEAR * reach
    area = np.zeros(partial.size)
    shallow = _shallow(profile, reach, by_force=by_force) & (
        np.abs(lower - upper - span) < _EVEN * gap
    )
    for front, chosen in ((_closed, ~close & ~shallow), (_even_front, ~close & shallow)):
        for index in _blocks(np.flatnonzero(chosen)):
            rows = level[index], span[index], upper[index], lower[index]
            area[index] = front(profile, rows, by_force=by_force)
    near = np.flatnonzero(close & (gap > 0))
    if near.size:
        whole = level[near], span[near], upper[near], lower[near]
        area[near] = _of_near_pieces(profile, whole, by_force=by_force)
    result[partial] = pieces.slip[partial] / pieces.span[partial] * area
    return result


def _blocks(index: Indices) -> Iterator[Indices]:
    return (index[start : start + _BLOCK] for start in range(0, index.size, _BLOCK))


def _closed(profile: Profile, rows: _Rows, *, by_force: bool) -> Array:
    front = _force_front if by_force else _depth_front
    area = front(profile, *rows)
    level, span, *_ = rows
    thin = np.flatnonzero(span < _THIN * (level + span))
    if thin.size:
        thin_rows = level[thin], span[thin], rows[2][thin], rows[3][thin]
        area[thin] = _thin_front(profile, thin_rows, by_force=by_force)
    # A difference of rounded numbers may fall below zero, a loss may not.
    return np.maximum(area, 0.0)


def _thin_front(profile: Profile, rows: _Rows, *, by_force: bool) -> Array:
    """int R dw over so short a way of the front that the closed form's ends are all but one."""
    level, span, upper, lower = rows

    def overlap(left: Array, at: Array) -> Array:
        share = left / span[:, None]
        top = at + (upper[:, None] + (lower - upper)[:, None] * share)
        front = coordinate_from_level(profile, at, by_force=by_force)
        edge = coordinate_from_level(profile, top, by_force=by_force)
        depth = profile.depth(edge) - profile.depth(front)
        force = profile.reduced_force(edge) - profile.reduced_force(front)
        x = profile.contact_radius(front)
        moved = force - 2 * x * depth
        return moved / (2 * x) if by_force else moved

    breaks = breaks_below(profile, float((level + span).max()), by_force=by_force)
    return integral(overlap, level, span, breaks)


def _shallow(profile: Profile, reach: Array, *, by_force: bool) -> Flags:
    """Contacts little larger than the flat they began with: all radii are nearly the same."""
    flat = float(profile.contact_radius(np.asarray(profile.first_coordinate)))
    if flat == 0:
        return np.zeros(reach.shape, dtype=bool)
    s = coordinate_from_level(profile, reach, by_force=by_force)
    return np.asarray(profile.contact_radius(s) < _SHALLOW * flat)


def _even_front(profile: Profile, rows: _Rows, *, by_force: bool) -> Array:
    """int R dw under a constant load: 2 int (d - w)(w - w_L) dx less that from w_H on."""
    level, span, upper, lower = rows
    top = level + lower
    s = coordinate_from_level(profile, top, by_force=by_force)

    def moment(gap: Array, below: Array) -> Array:
        stick, width = ends_below(profile, s, gap / top, below / top, by_force=by_force)
        return 2 * annulus.slip_moment(profile, s, width, stick)

    beyond = np.where(upper > 0, moment(upper, level + span), 0.0)
    return np.maximum(moment(lower, level) - beyond, 0.0)


def _of_near_pieces(profile: Profile, whole: _Rows, *, by_force: bool) -> Array:
    """Pieces whose front stays near the edge, cut until each part has its digits."""
    level, span, upper, _ = whole
    breaks = breaks_below(profile, float((level + span + upper).max()), by_force=by_force)
    owner, (level, span, upper, lower) = _cut(whole, breaks)
    gap = np.maximum(upper, lower)
    area = np.zeros(owner.size)
    # Next to the axis the gap is no small part of the level.
    wide = level <= (_GAPS - 1) * gap
    narrow_front = _narrow_force_front if by_force else _narrow_depth_front
    for index in _blocks(np.flatnonzero(wide)):
        rows = level[index], span[index], upper[index], lower[index]
        area[index] = _closed(profile, rows, by_force=by_force)
    for index in _blocks(np.flatnonzero(~wide)):
        rows = level[index], span[index], upper[index], lower[index]
        area[index] = narrow_front(profile, breaks, *rows)
    return np.bincount(owner, area, minlength=whole[0].size).astype(float, copy=False)


def _cut(whole: _Rows, breaks: Array) -> tuple[Indices, _Rows]:
    """Parts of pieces, and whose they are: halved towards the axis, and cut at every break.

    A break is met by the front and, before it, by the edge: it cuts a piece twice.
    """
    level, span, upper, lower = whole
    gap = np.maximum(upper, lower)
    owners, shares = [np.arange(level.size)] * 2, [np.zeros(level.size), np.ones(level.size)]
    end = level + span
    while True:
        end = end / 2
        inside = np.flatnonzero((end > level) & (end > _GAPS / 2 * gap))
        if not inside.size:
            break
        owners.append(inside)
        shares.append((end[inside] - level[inside]) / span[inside])
    # Only a row of breaks on or just above the piece matters.
    first = np.searchsorted(breaks, level)
    last = np.searchsorted(breaks, level + span + gap)
    for i in np.flatnonzero(last > first).tolist():
        at = breaks[first[i] : last[i]] - level[i]
        # The edge is at the break where level + share span + gap(share) is.
        climb = span[i] + upper[i] - lower[i]
        ahead = (at - lower[i]) / climb if climb != 0 else at[:0]
        # Behind it all changes over the gap first, then over the distance.
        steps = _FOURFOLD ** np.arange(_after(gap[i], span[i]))
        behind = np.add.outer(at, gap[i] * steps).ravel()
        cuts = np.concatenate([at / span[i], ahead, behind / span[i]])
        cuts = cuts[(cuts > 0) & (cuts < 1)]
        owners.append(np.full(cuts.size, i))
        shares.append(cuts)
    return _parts(whole, np.concatenate(owners), np.concatenate(shares))


def _after(gap: float, span: float) -> int:
    """How many fourfold steps lead from the gap to the span."""
    return max(ceil(log(span / gap) / log(_FOURFOLD)), 0) if gap > 0 else 0


def _parts(whole: _Rows, owner: Indices, share: Array) -> tuple[Indices, _Rows]:
    """The parts between the shares of each piece."""
    level, span, upper, lower = whole
    order = np.lexsort((share, owner))
    owner, share = owner[order], share[order]
    same = owner[1:] == owner[:-1]
    low, high, owner = share[:-1][same], share[1:][same], owner[:-1][same]
    climb = upper[owner] - lower[owner]
    rows = (
        level[owner] + low * span[owner],
        (high - low) * span[owner],
        lower[owner] + high * climb,
        lower[owner] + low * climb,
    )
    return owner, rows


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
    profile: Profile, breaks: Array, level: Array, span: Array, upper: Array, lower: Array
) -> Array:
    def overlap(t: Array, w: Array) -> Array:
        gap = lower[:, None] + (upper - lower)[:, None] * t
        return _overlap(profile, breaks, w, gap)

    return span * mean(overlap, level, span, level if breaks.size else None)


def _narrow_force_front(
    profile: Profile, breaks: Array, level: Array, span: Array, upper: Array, lower: Array
) -> Array:
    depths = profile.depth(coordinate_from_force(profile, breaks))

    def overlap(t: Array, force: Array) -> Array:
        gap = lower[:, None] + (upper - lower)[:, None] * t
        # dw = dI/(2 x): the gap in depth with the digits of that in force.
        deeper = integral(lambda _, at: 0.5 / radius_at_force(profile, at), force, gap, breaks)
        s = coordinate_from_force(profile, force)
        overlapping = _overlap(profile, depths, profile.depth(s), deeper)
        return overlapping / (2 * profile.contact_radius(s))

    return span * mean(overlap, level, span, level if breaks.size else None)


def _overlap(profile: Profile, breaks: Array, w: Array, gap: Array) -> Array:
    """R = 2 int_w^d (d - w') dx [length^2], over a narrow gap."""
    return integral(lambda left, at: 2 * left * radius_slope_at_depth(profile, at), w, gap, breaks)


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
