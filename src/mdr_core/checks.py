"""Bounds of inputs, cheap enough for a sweep over millions of scenes."""

from math import inf
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags

# Doubles that stay in cache between two reductions.
_AT_ONCE: Final = 65_536


def extremes(values: float | ArrayLike) -> tuple[float, float]:
    """Smallest and largest value, NaN if any is NaN; (NaN, NaN) of nothing."""
    if isinstance(values, (int, float)):
        # One number needs no reduction; NumPy's own doubles are floats as well.
        return float(values), float(values)
    array = np.asarray(values, dtype=float)
    if array.ndim == 0:
        return float(array), float(array)
    if array.size == 0:
        return float("nan"), float("nan")
    if array.size <= _AT_ONCE or not array.flags.c_contiguous:
        return float(array.min()), float(array.max())
    # Of each part the second reduction finds what the first has fetched from the memory.
    flat = array.ravel()
    ends = [
        (part.min(), part.max())
        for part in (flat[i : i + _AT_ONCE] for i in range(0, flat.size, _AT_ONCE))
    ]
    lows, highs = zip(*ends, strict=True)
    return float(np.min(lows)), float(np.max(highs))


def least(values: Array) -> float:
    """Smallest value, NaN if any is NaN; of a single one, without the cost of a reduction."""
    return float(values) if values.ndim == 0 else float(values.min())


def require_positive(path: tuple[str | int, ...], value: float | ArrayLike) -> None:
    """Raise InputError at the path unless all of the value is positive and finite."""
    low, high = extremes(value)
    if not (low > 0 and high < inf):
        raise InputError(path, "must be positive and finite")


def first_index(bad: Flags) -> tuple[int, ...]:
    """Index of the first true element, empty where `bad` has no dimension."""
    return (int(np.flatnonzero(bad)[0]),) if bad.ndim else ()


def largest(values: Array) -> float:
    """Largest of values >= 0; NaN if any is negative (zero included), infinite or NaN.

    Non-negative doubles are ordered like their bits read as integers, and whatever else there
    is lies above them: one pass says it all.
    """
    bits = values.view(np.uint64).max()
    return float(bits.view(np.float64)) if bits < _INFINITY else float("nan")


_INFINITY: Final = np.float64(np.inf).view(np.uint64)
