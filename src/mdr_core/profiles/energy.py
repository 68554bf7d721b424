"""Elastic energy by quadrature, for profiles without a closed form of it."""

from collections.abc import Callable
from functools import lru_cache
from typing import Final

import numpy as np

from mdr_core.elementwise import full, some, where
from mdr_core.quadrature import gauss_legendre, sum_in_order
from mdr_core.typing import Array, Parameter
from mdr_core.validation import extremes

# Length in w = arcsinh(s/scale) beyond which a density has decayed to rounding error.
_DECAY: Final = 40.0
# Gauss-Legendre nodes of a piece.
_NODES: Final = 16
# Longest piece in w: the integrand grows at most like exp(5 w), for which the a priori bound of 16
# nodes is 1e-17.
_LONGEST: Final = 1.5
# Nodes times loads evaluated at once, so that temporaries stay in the processor's cache.
_BLOCK: Final = 12_288


def energy_integral(density: Callable[[Array], Array], upper: Array, scale: Parameter) -> Array:
    """Return int_0^upper density(s) ds of a positive density that is a power of s at either end.

    s = scale sinh(w) resolves it also where s is much larger than the scale.
    """
    top = np.arcsinh(upper / scale)
    if not some(top):
        return top
    length = where(top < _DECAY, top, _DECAY)
    # Every load has its own pieces, summed in order: its result does not depend on other loads.
    count = where(length > _LONGEST, np.ceil(length / _LONGEST), 1.0)
    places, weights = _rule(int(extremes(count)[1]) if top.size else 1)
    step = max(_BLOCK // max(top.size, 1), 1)
    total = full(0.0, top)
    for start in range(0, places.size, step):
        part = slice(start, start + step)
        # Loads with fewer pieces have no nodes beyond the lower end.
        fraction = np.minimum(np.divide.outer(places[part], count), 1.0)
        w = top - fraction * length
        values = density(scale * np.sinh(w)) * np.cosh(w)
        values = np.where(fraction < 1, values, 0.0)
        values *= weights[part].reshape(-1, *[1] * top.ndim)
        values[0] += total
        total = sum_in_order(values)
    return total * scale * length / (2 * count)


@lru_cache(maxsize=32)
def _rule(pieces: int) -> tuple[Array, Array]:
    """Distances of the nodes from the upper end, in pieces, and their weights."""
    nodes, weights = gauss_legendre(_NODES)
    places = (np.arange(pieces)[:, None] + (1 - nodes) / 2).ravel()
    return places, np.tile(weights, pieces)
