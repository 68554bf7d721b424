"""The surface beside a spheroid that is pressed in nearly to its equator.

There g' has a pole just behind the contact's edge, and a radius has no digits of its distance
from it. In v = artanh(x/R) both are gone: g' dx = h (v sech^2 v + tanh v) dv.
"""

from math import ceil
from typing import Final

import numpy as np

from mdr_core.quadrature import graded_rule, halvings_towards
from mdr_core.typing import Array

# Nodes by the tolerance: pieces have a half length of one in a strip of pi/2.
_POINTS: Final = ((1e-4, 8), (1e-8, 12), (0.0, 20))
_PIECE: Final = 2.0


def slope_integral_beside(big_radius: float, v: float, r: Array, rtol: float) -> Array:
    """Return (1/h) int_0^a g'(x) arcsin(x/r) dx for r >= a = R tanh(v), not small against R.

    Source: mdr-5, Eq. (5.75), by parts; notes, §7.
    """
    edge = _below_equator(big_radius, v)
    beyond = np.maximum((r - big_radius) + edge, 0.0)
    places, weights = _rule(v, _nearest_root(big_radius, edge, beyond), rtol)
    down = v * places
    at = v - down
    x = big_radius * np.tanh(at)
    density = at / np.cosh(at) ** 2 + np.tanh(at)
    # a - x, with the digits of a short step.
    short = big_radius * np.sinh(down) / (np.cosh(v) * np.cosh(at))
    leg = np.sqrt(np.add.outer(short, beyond) * np.add.outer(x, r))
    angle = np.arctan2(x[:, None], leg)
    return np.asarray(v * ((weights * density) @ angle))


def _below_equator(big_radius: float, v: float) -> float:
    """R - a."""
    return float(2 * big_radius / (np.exp(2 * v) + 1))


def _nearest_root(big_radius: float, edge: float, beyond: Array) -> float:
    """How far from the edge in v the nearest of the radii r = a + beyond lies; at most one.

    Beyond the equator there is none: its root has an imaginary part of pi/2.
    """
    least = float(beyond.min())
    if least >= edge:
        return 1.0
    # artanh(r/R) - artanh(a/R).
    a = big_radius - edge
    difference = big_radius * least / (big_radius * edge + a * (edge - least))
    return min(float(np.arctanh(difference)), 1.0)


def _rule(v: float, root: float, rtol: float) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], the edge at 0, where pieces halve down to the nearest root."""
    points = next(count for limit, count in _POINTS if rtol >= limit)
    count = ceil(v / _PIECE)
    return graded_rule(points, halvings_towards(root * count / v), count)
