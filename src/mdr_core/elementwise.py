"""One formula for a number and for arrays; ordered sums; blocks of bounded size.

A single load is an `np.float64`, because every operation on an array without dimension takes ten
times as long. One formula serves numbers and arrays. For a single number these functions evaluate
only the branch that it needs, and return a number.
"""

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from mdr_core.typing import Array, Parameter

# Types of single numbers and flags; NumPy's doubles are floats as well.
_NUMBERS: Final = (float, int)
_FLAGS: Final = (np.bool_, bool)
# Number of values evaluated at once. The memory of a larger array, above 128 kB in complex numbers,
# is mapped at every allocation, which is slow.
_AT_ONCE: Final = 8_192


def number(value: Parameter) -> Any:
    """Return a value as the single number that the formulas take."""
    return np.float64(value)


def is_number(value: Any) -> bool:
    """True for a single number, false for an array."""
    return isinstance(value, _NUMBERS)


def _number(value: Any) -> Any:
    """Return a Python float as np.float64, whose comparisons have NumPy's methods."""
    return np.float64(value) if type(value) is float else value


def some(flags: Any) -> bool:
    """True if a flag is set, in at most a tenth of the time of NumPy's method."""
    return bool(np.count_nonzero(flags) if isinstance(flags, np.ndarray) else flags)


def every(flags: Any) -> bool:
    """True if all flags are set; see `some`."""
    return bool(np.count_nonzero(flags) == flags.size if isinstance(flags, np.ndarray) else flags)


def where(condition: Any, this: Any, other: Any) -> Any:
    """Return `this` where the condition holds, else `other`."""
    if isinstance(condition, _FLAGS):
        return _number(this if condition else other)
    return np.where(condition, this, other)


def quotient(part: Any, whole: Any, other: Any = 0.0) -> Any:
    """Return part/whole where the whole is positive, else `other`."""
    positive = whole > 0
    return where(positive, part / where(positive, whole, 1.0), other)


def piecewise(
    place: Any, start: Any, below: Callable[[Any], Any], beyond: Callable[[Any], Any]
) -> Any:
    """Return below(place) up to `start` and beyond(place) beyond it.

    Each formula is evaluated only at places on its own side.

    Parameters
    ----------
    place : numbers or arrays at which the formulas are evaluated.
    start : place beyond which `beyond` applies.
    below, beyond : formulas, functions of a place.
    """
    if is_number(place) and is_number(start):
        return _number(below(place) if place < start else beyond(place))
    first = place < start
    count = np.count_nonzero(first)
    if count in {0, first.size}:
        return broadcast(below(place) if count else beyond(place), first.shape)
    return np.where(first, below(np.minimum(place, start)), beyond(np.maximum(place, start)))


def broadcast(value: Any, shape: tuple[int, ...]) -> Any:
    """Broadcast a value to a shape; a shape without dimensions gives a number."""
    return value if getattr(value, "shape", ()) == shape else np.broadcast_to(value, shape)


def full(value: Parameter, like: Any) -> Any:
    """Broadcast a value to the shape of an array, or return a number if that is a number."""
    return np.float64(value) if is_number(like) else np.full_like(like, value, dtype=float)


def in_order(weights: Array, values: Array) -> Array:
    """Return sum w_i values_i over the first axis, bit-identical for one load and for many."""
    added = (1,) * (values.ndim - weights.ndim)
    spread = weights.reshape(weights.shape[:1] + added + weights.shape[1:])
    terms = np.multiply(spread, values, order="C")
    # NumPy adds contiguous numbers pairwise, but rows one after the other.
    return np.add.accumulate(terms)[-1] if terms[0].size == 1 else np.add.reduce(terms)


def in_blocks(count: int, values: int = 1) -> list[slice]:
    """Divide `count` rows of `values` numbers each into slices of bounded size."""
    step = max(_AT_ONCE // values, 1)
    return [slice(start, start + step) for start in range(0, count, step)]
