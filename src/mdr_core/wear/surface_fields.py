"""Worn depth and pressure over the radius, from the state of the annulus.

In the units of `mdr_core.wear.annulus_state`.
"""

import numpy as np

from mdr_core.typing import Array
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.integrator import StickTrail


def worn_depth(state: AnnulusState, trail: StickTrail, radius: Array) -> Array:
    """Return h(r) = (sigma - S_0) H(r - c) + (2/pi) int_c0^min(r,c) arccos(x/r) dw_c(x).

    The second term is of the springs that a growing stick zone has passed.
    Source: mdr-5, Eq. (5.75), integrated by parts; notes, §11.
    """
    result = np.zeros(radius.shape)
    a = float(state.x[-1])
    inside = (radius > state.stick) & (radius < a)
    s = _leg(radius[inside], state.stick)
    result[inside] = s * state.model.maps.at(state.worn, np.minimum((s / state.end) ** 2, 1.0))
    at, step = trail.steps
    if step.any():
        worn = radius < a
        legs = _leg(radius[worn][:, None], at)
        result[worn] += 2 / np.pi * (np.arctan2(legs, at) @ step)
    # Below rounding at the edges, and between nodes that are too few, the polynomials may be < 0.
    return np.maximum(result, 0.0)


def worn_volume(state: AnnulusState, trail: StickTrail) -> float:
    """Return 2 pi int h r dr. Source: notes, §11."""
    b, a = state.end, float(state.x[-1])
    total = b**3 * float(state.model.maps.volume @ state.worn)
    at, step = trail.steps
    legs = _leg(np.full(at.shape, a), at)
    total += float(step @ (a * a * np.arctan2(legs, at) - at * legs)) / np.pi
    return 2 * np.pi * total


def annulus_pressure(state: AnnulusState, radius: Array) -> Array:
    """Return p/E* at radii of the annulus, c < r < a. Source: mdr-5, Eq. (5.79)."""
    maps = state.model.maps
    even = np.append(state.pressure[:-1] / maps.cosine[:-1], 0.0)
    # At the edge, from the even polynomial of degree 4 through its three neighbours.
    even[-1] = (15 * even[-2] - 6 * even[-3] + even[-4]) / 10
    squares = np.minimum((_leg(radius, state.stick) / state.end) ** 2, 1.0)
    return np.asarray(maps.at(maps.cosine, squares) * maps.at(even, squares))


def stick_pressure(state: AnnulusState, trail: StickTrail, radius: Array) -> Array:
    """Return the part of p/E* at r < c that is not of the unworn shape inside c.

    (1/pi) int g'(x)/sqrt(x^2 - r^2) dx over c < x < a, with the step g(c+) - g(c) of a worn
    layer that is too thin for the nodes, and over the worn part of the springs inside c.

    Source: mdr-5, Eqs. (5.34), (5.79).
    """
    maps, c = state.model.maps, state.stick
    inner = _leg(np.full(radius.shape, c), radius)
    total = (1 / np.sqrt(np.add.outer(inner**2, state.end**2 * maps.points))) @ (
        maps.steps @ state.gamma
    )
    total += float(maps.at_stick @ state.gamma) / inner
    if trail.radius.size > 1:
        total += _trail_stress(trail, radius)
    return np.asarray(total / np.pi)


def _trail_stress(trail: StickTrail, radius: Array) -> Array:
    """Return int dw_c(x)/sqrt(x^2 - r^2) over the part of the trail above each radius."""
    at = radius[:, None]
    ends = np.maximum(trail.radius, at)
    logs = np.log(ends + np.sqrt((ends - at) * (ends + at)))
    width, step = np.diff(trail.radius), np.diff(trail.worn)
    wide = width > 0
    total = np.diff(logs, axis=1) @ np.where(wide, step / np.where(wide, width, 1.0), 0.0)
    # Where the edge rested, w_c rose at one radius.
    return np.asarray(total + step[~wide].sum() / _leg(trail.radius[-1:], radius))


def _leg(r: Array, c: float | Array) -> Array:
    return np.asarray(np.sqrt(np.maximum(r - c, 0.0) * (r + c)))
