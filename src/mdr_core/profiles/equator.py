"""Surface displacements of a spheroid that is indented nearly to its equator.

There g' has a pole just beyond the contact edge, and a radius does not resolve the distance from
it. The variable v = artanh(x/R) removes the pole and resolves the distance:
g' dx = h (v sech^2 v + tanh v) dv.
"""

from math import ceil
from typing import Final

import numpy as np

from mdr_core.quadrature import composite_rule, graded_rule, halvings_towards, nodes_of_pieces
from mdr_core.typing import Array

# Length of a piece in v; `nodes_of_pieces` returns its number of nodes.
_PIECE: Final = 2.0


def slope_integral_outside(big_radius: float, v: float, r: Array, rtol: float) -> Array:
    """Return (1/h) int_0^a g'(x) arcsin(x/r) dx for a = R tanh(v) near the equator [1].

    Source: mdr-5, Eq. (5.75), by parts; notes, §7.

    Parameters
    ----------
    big_radius : R [length].
    v : contact coordinate of a [1].
    r : radii r >= a [length], shape (m,).
    rtol : relative tolerance.
    """
    edge = _below_equator(big_radius, v)
    beyond = np.maximum((r - big_radius) + edge, 0.0)
    places, weights = _rule(v, _nearest_root(big_radius, edge, beyond), rtol)
    x, short, density = _stepped(big_radius, np.asarray(v), v * places)
    root = np.sqrt(np.add.outer(short, beyond) * np.add.outer(x, r))
    angle = np.arctan2(x[:, None], root)
    return np.asarray(v * ((weights * density) @ angle))


def slope_integral_inside(
    big_radius: float, v: Array, width: Array, r: Array, rtol: float
) -> Array:
    """Return (1/h) int_c^r g'(x) arccos(x/r) dx for r = R tanh(v), c = R tanh(v - width) [1].

    The substitution v - `width` u^2 for x removes the root at r.

    Source: mdr-5, Eq. (5.40), by parts; notes, §7.

    Parameters
    ----------
    big_radius : R [length].
    v, width : r, and the distance of c from it, in the contact coordinate [1], shape (m,).
    r : radii [length], shape (m,).
    rtol : relative tolerance.
    """
    u, weights = composite_rule(nodes_of_pieces(rtol), ceil(float(width.max(initial=1.0))))
    x, short, density = _stepped(big_radius, v, np.multiply.outer(u * u, width))
    angle = np.arctan2(np.sqrt(short * (x + r)), x)
    return np.asarray(width * ((2 * u * weights) @ (density * angle)))


def _stepped(big_radius: float, v: Array, down: Array) -> tuple[Array, Array, Array]:
    """x at v - down, its distance below R tanh(v), and g' dx/dv / h."""
    at = v - down
    x = big_radius * np.tanh(at)
    short = big_radius * np.sinh(down) / (np.cosh(v) * np.cosh(at))
    return x, short, at / np.cosh(at) ** 2 + np.tanh(at)


def _below_equator(big_radius: float, v: float) -> float:
    """R - a."""
    return float(2 * big_radius / (np.exp(2 * v) + 1))


def _nearest_root(big_radius: float, edge: float, beyond: Array) -> float:
    """Distance in v of the edge from the nearest of the radii r = a + beyond, at most one.

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
