"""Double precision: its spacing, its least number, and blocks of values that fit in the cache."""

from typing import Final

import numpy as np

EPS: Final = float(np.finfo(float).eps)
"""Distance from 1 to the next double."""
TINY: Final = float(np.finfo(float).tiny)
"""Smallest number with all its digits."""
ADJACENT: Final = 4 * EPS
"""Relative distance within which two numbers are the same but for a few roundings."""
ROUNDING: Final = 16 * EPS
"""Relative rounding error of a short sum of products, and of a root of one, with room."""
LARGEST: Final = 1e290
"""Largest result, and inverse of the smallest, of which sums of a few products are exact."""
LOG_RANGE: Final = 600.0
"""Bound on the logarithm of a ratio of radii: exp(-600) of 1e-50 is next to underflow."""
# Values evaluated at once: arrays above 128 kB, here of complex numbers, are mapped each time.
_AT_ONCE: Final = 8_192


def in_blocks(count: int, values: int = 1) -> list[slice]:
    """Return slices of `count` rows of so many values each, whose arrays stay in the cache."""
    step = max(_AT_ONCE // values, 1)
    return [slice(start, start + step) for start in range(0, count, step)]
