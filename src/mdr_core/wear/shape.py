"""The worn shape and what presses on it, over the radius, for all loads at once."""

from collections.abc import Callable
from math import inf
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.checks import extremes, first_index
from mdr_core.errors import InputError
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices
from mdr_core.wear.rim import Rim
from mdr_core.wear.stick import LimitingStick

# Pairs of loads and radii handled at once: bounds the memory, whatever their number.
_BLOCK: Final = 8192


def worn_depth(stuck: LimitingStick, rim: Rim, outer: Array, r: Array, rtol: float) -> Array:
    """Return (2/pi) int_c^r (d - g(x))/sqrt(r^2 - x^2) dx in the rim up to `outer` [length].

    Source: mdr-5, Eqs. (5.75), (5.82).
    """
    profile, step = rim.profile, np.ravel(stuck.step)
    inner, end = rim.stick[:, None], np.ravel(outer)[:, None]
    # Where nothing sticks the axis wears as well, and a flat punch up to its very edge.
    worn = (r <= end if profile.slips_at_once else r < end) & ((r > inner) | (inner == 0))
    worn &= (step > 0)[:, None]

    def values(load: Indices, at: Array) -> Array:
        rims = rim.chosen(load)
        width = rims.at(at)
        # S(0; r) is the profile itself.
        lag = np.where(profile.slips_at_once, 0.0, profile.f(at))
        some = np.flatnonzero(rims.stick > 0)
        if some.size and "slip" in profile.closed_forms:
            lag[some] = profile.slip_kernel(rims.stick[some], at[some], rtol)
        elif some.size:
            lag[some] = rims.chosen(some).slip_kernel(width[some], rtol)
        share = np.where(at > 0, 2 / np.pi * rims.angle(width), 1.0)
        # At the rim's outer edge the two are equal but for rounding.
        return np.asarray(np.maximum(share * step[load] - lag, 0.0))

    result = _filled(worn, r, values)
    result[np.ravel(stuck.endless)] = inf
    return result.reshape(outer.shape + r.shape)


def pressure(profile: Profile, stuck: LimitingStick, e_star: Array, r: Array, rtol: float) -> Array:
    """Return (E*/pi) [int_r^c g'/sqrt(x^2 - r^2) dx + (d - g(c))/sqrt(c^2 - r^2)] [pressure].

    Source: mdr-5, Eqs. (5.34), (5.79), (5.82).
    """
    # Where everything slipped nothing touches any more, or nothing presses.
    held = np.where(stuck.lost | stuck.endless, 0.0, stuck.radius)
    c, step, edge = (np.ravel(part) for part in (held, stuck.step, stuck.coordinate))
    moduli = np.ravel(np.broadcast_to(e_star, held.shape))

    def values(load: Indices, at: Array) -> Array:
        inner = profile.pressure_kernel(edge[load], at, rtol)
        rim = step[load] / (np.pi * np.sqrt((c[load] - at) * (c[load] + at)))
        return np.asarray(moduli[load] * (inner + rim))

    result = _filled(r < c[:, None], r, values)
    rimmed = (c > 0) & ((step > 0) | (profile.slips_at_once & (edge > 0)))
    result[(r == c[:, None]) & rimmed[:, None]] = inf
    return result.reshape(held.shape + r.shape)


def _filled(where: Flags, r: Array, values: Callable[[Indices, Array], Array]) -> Array:
    """`values(load, radius)` at the chosen pairs, zero elsewhere."""
    result = np.zeros(where.shape)
    load, place = np.nonzero(where)
    for start in range(0, load.size, _BLOCK):
        which, at = load[start : start + _BLOCK], place[start : start + _BLOCK]
        result[which, at] = values(which, r[at])
    return result


def checked_radii(radius: ArrayLike, end: float = inf) -> Array:
    """Return the radii as an array (m,).

    Raises
    ------
    InputError : one that is negative, not finite or beyond the end.
    """
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    low, high = extremes(r)
    if not (low >= 0 and high < inf):
        index = first_index(~((r >= 0) & (r < inf))) if r.size else ()
        detail = "must be finite and not negative" if r.size else "at least one radius is needed"
        raise InputError(("radius", *index), detail)
    if high > end:
        detail = f"the profile ends at radius {end:.12g}"
        raise InputError(("radius", *first_index(r > end)), detail)
    return r
