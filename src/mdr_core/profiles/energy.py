"""Elastic energy by quadrature, for profiles without a closed form of it."""

from collections.abc import Callable
from functools import lru_cache
from typing import Final

import numpy as np

from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Parameter

# Length in w = arcsinh(s/scale) beyond which the energy has decayed by exp(-2 x 20), below rounding
# error.
_DECAY: Final = 20.0
# Gauss-Legendre nodes of a piece.
_NODES: Final = 16
# Longest piece in w: the integrand grows at most like exp(5 w), for which the a priori bound of 16
# nodes is 1e-17.
_LONGEST: Final = 1.5
# Nodes times loads evaluated at once, so that temporaries stay in the processor's cache.
_BLOCK: Final = 12_288


def energy_integral(density: Callable[[Array], Array], upper: Array, scale: Parameter) -> Array:
    """Return int_0^upper density(s) ds of a positive density that is a power of s at either end.

    With density = (F/E*) dd/ds this is the elastic energy without any cancellation.
    s = scale sinh(w) resolves it also where s is much larger than the scale.
    """
    scale = np.asarray(scale, dtype=float)
    top = np.arcsinh(upper / scale)
    length = np.minimum(top, _DECAY)
    # Every load has its own pieces, summed in order: its result does not depend on other loads.
    count = np.maximum(np.ceil(length / _LONGEST), 1.0)
    places, weights = _rule(int(np.max(count, initial=1.0)))
    step = max(_BLOCK // max(top.size, 1), 1)
    total = np.zeros_like(top)
    for start in range(0, places.size, step):
        part = slice(start, start + step)
        fraction = np.divide.outer(places[part], count)
        own = fraction < 1
        w = top - np.where(own, fraction, 0.0) * length
        values = np.where(own, density(scale * np.sinh(w)) * np.cosh(w), 0.0)
        values *= weights[part].reshape(-1, *[1] * top.ndim)
        values[0] += total
        total = np.cumsum(values, axis=0)[-1] if len(values) > 1 else values[0]
    return total * scale * length / (2 * count)


@lru_cache(maxsize=32)
def _rule(pieces: int) -> tuple[Array, Array]:
    """Distances of the nodes from the upper end, in pieces, and their weights."""
    nodes, weights = gauss_legendre(_NODES)
    places = (np.arange(pieces)[:, None] + (1 - nodes) / 2).ravel()
    return places, np.tile(weights, pieces)
