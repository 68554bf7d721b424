"""Bounds of inputs, cheap enough for a sweep over millions of scenes."""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

# Both passes over a block find it in cache.
_BLOCK: Final = 16_384


def extremes(values: ArrayLike) -> tuple[float, float]:
    """Smallest and largest value, NaN if any is NaN; (NaN, NaN) of nothing."""
    flat = np.asarray(values, dtype=float).ravel()
    if flat.size == 0:
        return float("nan"), float("nan")
    if flat.size <= _BLOCK:
        return float(flat.min()), float(flat.max())
    blocks = [flat[start : start + _BLOCK] for start in range(0, flat.size, _BLOCK)]
    lowest = np.array([block.min() for block in blocks])
    highest = np.array([block.max() for block in blocks])
    return float(lowest.min()), float(highest.max())
