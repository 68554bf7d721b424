"""Response of an elastic layer on a rigid base to a wave of pressure.

Source: hayes; manual, Contact with a layer.
"""

import numpy as np

from mdr_core.errors import InputError
from mdr_core.materials import Layer
from mdr_core.typing import Array


def softening(layer: Layer, w: Array) -> Array:
    """Return 1 - L(w), by which the layer's response to a wave differs from a half-space's [1]."""
    if layer.base == "frictionless":
        return (1 + 2 * w - np.exp(-2 * w)) / (np.sinh(2 * w) + 2 * w)
    if layer.poissons_ratio is None:
        raise InputError(("material", "poissons_ratio"), "is needed for a layer on a bonded base")
    kappa = 3 - 4 * layer.poissons_ratio
    both = 1 + kappa**2 + 4 * w * w
    return (2 * kappa * np.exp(-2 * w) + both + 4 * w) / (2 * kappa * np.cosh(2 * w) + both)
