"""Array types shared by all modules."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
# Of real or complex numbers.
Numbers: TypeAlias = NDArray[Any]
Indices: TypeAlias = NDArray[np.intp]
# Chosen elements of an array: any, or a contiguous range, which is a view and not a copy.
Chosen: TypeAlias = Indices | slice
Flags: TypeAlias = NDArray[np.bool_]
# Parameter of a profile: one number, or an array over the cases of a sweep.
Parameter: TypeAlias = float | Array
