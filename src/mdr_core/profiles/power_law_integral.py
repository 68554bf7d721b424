"""Quadrature of densities that are powers of the place, near zero and far from it."""

from collections.abc import Callable

import numpy as np

from mdr_core.doubles import EPS
from mdr_core.elementwise import full, in_order, some, where
from mdr_core.quadrature import NODES, PIECE, gauss_legendre
from mdr_core.typing import Array, Parameter
from mdr_core.validation import extremes


def power_law_integral(density: Callable[[Array], Array], upper: Array, scale: Parameter) -> Array:
    """Return int_0^upper density(s) ds of a positive density that is a power of s at either end.

    s = scale sinh(w) resolves it also where s is much larger than the scale; the integrand grows at
    most like exp(5 w).
    """
    top = np.arcsinh(upper / scale)
    if not some(top):
        return top
    # On the axis a density may be 0/0.
    span = where(top > 0, top, EPS)
    # Every load has its own pieces, summed in order: its result does not depend on other loads.
    count = where(top > PIECE, np.ceil(top / PIECE), 1.0)
    nodes, weights = gauss_legendre(NODES)
    shares = ((1 - nodes) / 2).reshape(-1, *(1,) * top.ndim)
    total = full(0.0, top)
    for piece in range(int(extremes(count)[1])):
        fraction = (piece + shares) / count
        if piece:
            # Nodes of loads with fewer pieces do not count, and stay off the axis.
            fraction = np.where(piece < count, fraction, 0.5)
        w = span - fraction * span
        values = density(scale * np.sinh(w)) * np.cosh(w)
        total = total + where(piece < count, in_order(weights, values), 0.0)
    return total * scale * top / (2 * count)
