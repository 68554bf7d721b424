"""The worn surface at any radius, and the pressure on it, from a state of the annulus.

In the units of `mdr_core.wear.rates`.
"""

import numpy as np

from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array
from mdr_core.wear.course import Trail
from mdr_core.wear.rates import State


def worn_depth(state: State, trail: Trail, radius: Array) -> Array:
    """h(r): what the annulus has lost, and what shows of the springs that the edge has passed.

    h = (sigma - S_0) H(r - c) + (2/pi) int_c0^min(r,c) arccos(x/r) dw_c(x).
    Source: mdr-5, Eq. (5.75), integrated by parts; notes, §11.
    """
    result = np.zeros(radius.shape)
    a = float(state.x[-1])
    inside = (radius > state.stick) & (radius < a)
    s = _leg(radius[inside], state.stick)
    squares = (s / state.end) ** 2
    result[inside] = s * state.system.maps.at(state.worn, squares)
    at, step = trail.steps
    if step.any():
        worn = radius < a
        legs = _leg(radius[worn][:, None], at)
        result[worn] += 2 / np.pi * (np.arctan2(legs, at) @ step)
    # Wear takes away: below rounding at the edges the polynomial may say otherwise.
    return np.maximum(result, 0.0)


def worn_volume(state: State, trail: Trail) -> float:
    """2 pi int h r dr. Source: notes, §11."""
    b, a = state.end, float(state.x[-1])
    total = b**3 * float(state.system.maps.volume @ state.worn)
    at, step = trail.steps
    legs = _leg(np.full(at.shape, a), at)
    total += float(step @ (a * a * np.arctan2(legs, at) - at * legs)) / np.pi
    return 2 * np.pi * total


def annulus_pressure(state: State, radius: Array) -> Array:
    """p/E* at radii of the annulus, c < r < a. Source: mdr-5, Eq. (5.79)."""
    squares = (_leg(radius, state.stick) / state.end) ** 2
    smooth = state.system.maps.at(state.smooth_pressure, squares)
    return np.asarray(np.sqrt(np.maximum(1 - squares, 0.0)) * smooth / state.end)


def stick_pressure(state: State, trail: Trail, radius: Array) -> Array:
    """The part of p/E* at r < c that the annulus and the passed springs add to the shape's own.

    (1/pi) int g'(x)/sqrt(x^2 - r^2) dx over c < x < a, with the step g(c+) - g(c) that is left
    when all slip has worn off, and over the worn part of the springs behind the edge.

    Source: mdr-5, Eqs. (5.34), (5.79).
    """
    maps, b, c = state.system.maps, state.end, state.stick
    below = _leg(np.full(radius.shape, c), radius)
    nodes, weights = gauss_legendre(2 * maps.zeta.size)
    # u^2 = X^2 + c^2 - r^2 takes out the root at r.
    span = np.sqrt(below**2 + b * b) - below
    u = below + np.multiply.outer((1 + nodes) / 2, span)
    squares = np.clip((u - below) * (u + below) / (b * b), 0.0, 1.0)
    slope = maps.at(maps.derivative @ state.gamma, squares)
    total = span / 2 * (weights @ slope) * 2 / (b * b)
    step = float(maps.at_stick @ state.gamma)
    total += step / below
    if trail.radius.size > 1:
        total += _trail_stress(trail, radius)
    return np.asarray(total / np.pi)


def _trail_stress(trail: Trail, radius: Array) -> Array:
    """Int dw_c(x)/sqrt(x^2 - r^2) over the trail's pieces above each radius."""
    at = radius[:, None]
    ends = np.maximum(trail.radius, at)
    logs = np.log(ends + np.sqrt((ends - at) * (ends + at)))
    width, step = np.diff(trail.radius), np.diff(trail.worn)
    wide = width > 0
    total = np.diff(logs, axis=1) @ np.where(wide, step / np.where(wide, width, 1.0), 0.0)
    # Where the edge rested w_c rose at one place, and stands there as a step.
    return np.asarray(total + step[~wide].sum() / _leg(trail.radius[-1:], radius))


def _leg(r: Array, c: float | Array) -> Array:
    return np.asarray(np.sqrt(np.maximum(r - c, 0.0) * (r + c)))
