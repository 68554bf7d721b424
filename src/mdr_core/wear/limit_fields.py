"""Worn depth and pressure of the limiting state over the radius, for all loads at once."""

from collections.abc import Callable
from math import inf

import numpy as np

from mdr_core.abel.annulus import whole
from mdr_core.elementwise import in_blocks
from mdr_core.typing import Array, Flags, Indices
from mdr_core.wear.limiting_stick import LimitingStick
from mdr_core.wear.worn_annulus import angle


def worn_depth(stick_zone: LimitingStick, outer: Array, r: Array) -> Array:
    """Return (2/pi) int_c^r (d - g(x))/sqrt(r^2 - x^2) dx in the annulus up to `outer` [length].

    Source: mdr-5, Eqs. (5.75), (5.82).
    """
    profile, c, step = stick_zone.profile, np.ravel(stick_zone.radius), np.ravel(stick_zone.step)
    inner, end = c[:, None], np.ravel(outer)[:, None]
    # In full slip the axis wears as well, and a flat punch wears up to its edge.
    worn = (r <= end if profile.is_flat_punch else r < end) & ((r > inner) | (inner == 0))
    worn &= (step > 0)[:, None]

    def values(load: Indices, at: Array) -> Array:
        lag = profile.slip_integral(c[load], at)
        share = np.where(at > 0, 2 / np.pi * angle(c[load], at - c[load]), 1.0)
        # At the outer edge of the annulus the terms cancel but for rounding error.
        return np.asarray(np.maximum(share * step[load] - lag, 0.0))

    return _filled(worn, r, values).reshape(outer.shape + r.shape)


def pressure(stick_zone: LimitingStick, e_star: Array, r: Array) -> Array:
    """Return (E*/pi) [int_r^c g'/sqrt(x^2 - r^2) dx + (d - g(c))/sqrt(c^2 - r^2)] [pressure].

    Source: mdr-5, Eqs. (5.34), (5.79), (5.82).
    """
    profile = stick_zone.profile
    radius = stick_zone.radius
    c, step, edge = (np.ravel(part) for part in (radius, stick_zone.step, stick_zone.coordinate))
    moduli = np.ravel(np.broadcast_to(e_star, radius.shape))

    def values(load: Indices, at: Array) -> Array:
        inner = profile.pressure_kernel(whole(edge[load]), at)
        annulus = step[load] / (np.pi * np.sqrt((c[load] - at) * (c[load] + at)))
        return np.asarray(moduli[load] * (inner + annulus))

    result = _filled(r < c[:, None], r, values)
    singular = (c > 0) & ((step > 0) | (profile.is_flat_punch & (edge > 0)))
    result[(r == c[:, None]) & singular[:, None]] = inf
    return result.reshape(radius.shape + r.shape)


def _filled(where: Flags, r: Array, values: Callable[[Indices, Array], Array]) -> Array:
    """Return `values(load, radius)` at the chosen pairs of (loads, m), zero elsewhere."""
    result = np.zeros(where.shape)
    load, place = np.nonzero(where)
    for block in in_blocks(load.size):
        which, at = load[block], place[block]
        result[which, at] = values(which, r[at])
    return result
