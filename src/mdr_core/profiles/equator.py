"""The surface about a spheroid that is pressed in nearly to its equator.

There g' has a pole just behind the contact's edge, and a radius has no digits of its distance
from it. In v = artanh(x/R) both are gone: g' dx = h (v sech^2 v + tanh v) dv.
"""

from math import ceil
from typing import Final

import numpy as np

from mdr_core.quadrature import composite_rule, graded_rule, halvings_towards, nodes_of_pieces
from mdr_core.typing import Array

_PIECE: Final = 2.0


def slope_integral_beside(big_radius: float, v: float, r: Array, rtol: float) -> Array:
    """Return (1/h) int_0^a g'(x) arcsin(x/r) dx for r >= a = R tanh(v), not small against R.

    Source: mdr-5, Eq. (5.75), by parts; notes, §7.
    """
    edge = _below_equator(big_radius, v)
    beyond = np.maximum((r - big_radius) + edge, 0.0)
    places, weights = _rule(v, _nearest_root(big_radius, edge, beyond), rtol)
    x, short, density = _stepped(big_radius, np.asarray(v), v * places)
    leg = np.sqrt(np.add.outer(short, beyond) * np.add.outer(x, r))
    angle = np.arctan2(x[:, None], leg)
    return np.asarray(v * ((weights * density) @ angle))


def slope_integral_within(
    big_radius: float, v: Array, width: Array, r: Array, rtol: float
) -> Array:
    """Return (1/h) int_c^r g'(x) arccos(x/r) dx for r = R tanh(v), c = R tanh(v - width).

    With v - `width` u^2 for x the root at r is gone.

    Source: mdr-5, Eq. (5.40), by parts; notes, §7.
    """
    u, weights = composite_rule(nodes_of_pieces(rtol), ceil(float(width.max(initial=1.0))))
    x, short, density = _stepped(big_radius, v, np.multiply.outer(u * u, width))
    angle = np.arctan2(np.sqrt(short * (x + r)), x)
    return np.asarray(width * ((2 * u * weights) @ (density * angle)))


def _stepped(big_radius: float, v: Array, down: Array) -> tuple[Array, Array, Array]:
    """x at v - down, how far it lies below R tanh(v), and g' dx/dv / h."""
    at = v - down
    x = big_radius * np.tanh(at)
    short = big_radius * np.sinh(down) / (np.cosh(v) * np.cosh(at))
    return x, short, at / np.cosh(at) ** 2 + np.tanh(at)


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
    count = ceil(v / _PIECE)
    return graded_rule(nodes_of_pieces(rtol), halvings_towards(root * count / v), count)
