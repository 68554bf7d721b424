"""Displacement beside a spheroid, integrated over its contact coordinate v = artanh(x/R).

g' dx = h (v sech^2 v + tanh v) dv has no pole at the equator, and v resolves the distance from it.
Source: notes, §7.
"""

from math import ceil, log2
from typing import Final

import numpy as np

from mdr_core.quadrature import PIECE, nodes_of_pieces, piecewise_rule
from mdr_core.typing import Array, Parameter

# Closer to the edge a root lies on it.
_EPS: Final = float(np.finfo(float).eps)
# Nodes times radii evaluated at once.
_BLOCK: Final = 12_288


def slope_integral_outside(big_radius: Parameter, v: float, r: Array, rtol: float) -> Array:
    """Return (1/h) int_0^a g'(x) arcsin(x/r) dx, a = R tanh(v) [1].

    Source: mdr-5, Eq. (5.75), by parts.

    Parameters
    ----------
    big_radius : R [length].
    v : contact coordinate of a [1].
    r : radii r >= a [length], shape (m,).
    rtol : relative tolerance.
    """
    if v == 0:
        return np.zeros_like(r)
    edge = float(2 * big_radius / (np.exp(2 * v) + 1))
    # Next to the equator R - a is accurate, next to the axis a is.
    past = (r - big_radius) + edge if v > 1 else r - big_radius * np.tanh(v)
    beyond = np.maximum(past, 0.0)
    # The first piece halves towards the edge, down to the nearest root.
    count = max(ceil(v / PIECE), 1)
    halvings = max(ceil(-log2(max(_nearest_root(big_radius, edge, beyond) * count / v, _EPS))), 0)
    ends = np.concatenate([[0.0], 0.5 ** np.arange(halvings, 0, -1), np.arange(1, count + 1)])
    places, weights = piecewise_rule(nodes_of_pieces(rtol), ends / count)
    down = v * places
    at = v - down
    x = big_radius * np.tanh(at)
    short = big_radius * np.sinh(down) / (np.cosh(v) * np.cosh(at))
    density = at / np.cosh(at) ** 2 + np.tanh(at)

    result, step = np.empty_like(r), max(_BLOCK // weights.size, 1)
    for start in range(0, r.size, step):
        part = slice(start, start + step)
        root = np.sqrt(np.add.outer(short, beyond[part]) * np.add.outer(x, r[part]))
        result[part] = v * ((weights * density) @ np.arctan2(x[:, None], root))
    return result


def _nearest_root(big_radius: Parameter, edge: float, beyond: Array) -> float:
    """Distance in v of the edge R - `edge` from the nearest radius `beyond` it, at most one.

    Beyond the equator there is none: its root has an imaginary part of pi/2.
    """
    least = float(beyond.min(initial=edge))
    if least >= edge:
        return 1.0
    # artanh(r/R) - artanh(a/R).
    a = big_radius - edge
    difference = big_radius * least / (big_radius * edge + a * (edge - least))
    return min(float(np.arctanh(difference)), 1.0)
