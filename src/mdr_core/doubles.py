"""Double precision: spacing of numbers, and range of full accuracy."""

from typing import Final

import numpy as np

EPS: Final = float(np.finfo(float).eps)
"""Distance from 1 to the next double."""
TINY: Final = float(np.finfo(float).tiny)
"""Smallest normal number; smaller ones have fewer digits."""
ADJACENT: Final = 4 * EPS
"""Relative distance within which two numbers differ by a few rounding errors at most."""
ROUNDING: Final = 16 * EPS
"""Bound, with a margin, on the relative rounding error of a short sum of products and of its square
root."""
LARGEST: Final = 1e290
"""Sums of a few products are accurate if their factors lie between the inverse of this number and
this number."""
LOG_RANGE: Final = 600.0
"""Bound on the logarithm of a ratio of radii: 1e-50 times exp(-600) is subnormal."""
