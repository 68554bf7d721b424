"""Double precision: its spacing, and the range in which it has all its digits."""

from typing import Final

import numpy as np

EPS: Final = float(np.finfo(float).eps)
"""Distance from 1 to the next double."""
TINY: Final = float(np.finfo(float).tiny)
"""Smallest number with all its digits."""
ADJACENT: Final = 4 * EPS
"""Relative distance within which two numbers are the same but for a few roundings."""
ROUNDING: Final = 16 * EPS
"""Bound, with a margin, on the relative rounding error of a short sum of products and of its square
root."""
LARGEST: Final = 1e290
"""Sums of a few products are accurate if their factors lie between the inverse of this number and
this number."""
LOG_RANGE: Final = 600.0
"""Bound on the logarithm of a ratio of radii: exp(-600) of 1e-50 is subnormal."""
