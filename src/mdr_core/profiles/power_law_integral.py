"""Quadrature of densities that are powers of s near zero and in the far field."""

from collections.abc import Callable

import numpy as np

from mdr_core.doubles import EPS
from mdr_core.elementwise import full, in_order, some, where
from mdr_core.quadrature import NODES, PIECE, gauss_legendre
from mdr_core.typing import Array, Parameter
from mdr_core.validation import extremes


def power_law_integral(density: Callable[[Array], Array], upper: Array, scale: Parameter) -> Array:
    """Return int_0^upper density(s) ds of a positive density that is a power of s at either end.

    The substitution s = scale sinh(w) resolves s far above the scale as well; the integrand grows
    at most like exp(5 w).
    """
    top = np.arcsinh(upper / scale)
    if not some(top):
        return top
    # On the axis a density may be 0/0.
    span = where(top > 0, top, EPS)
    # Every load has its own pieces, summed in order, so that its result does not depend on other
    # loads.
    count = where(top > PIECE, np.ceil(top / PIECE), 1.0)
    nodes, weights = gauss_legendre(NODES)
    shares = ((1 - nodes) / 2).reshape(-1, *(1,) * top.ndim)
    total = full(0.0, top)
    for piece in range(int(extremes(count)[1])):
        fraction = (piece + shares) / count
        if piece:
            # Surplus nodes of loads with fewer pieces have no weight; they stay off the axis, where
            # a density may be undefined.
            fraction = np.where(piece < count, fraction, 0.5)
        w = span - fraction * span
        values = density(scale * np.sinh(w)) * np.cosh(w)
        total = total + where(piece < count, in_order(weights, values), 0.0)
    return total * scale * top / (2 * count)
