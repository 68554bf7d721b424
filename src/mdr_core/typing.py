"""Array types shared by all modules."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
# Array of real or complex numbers.
Numbers: TypeAlias = NDArray[Any]
Indices: TypeAlias = NDArray[np.intp]
# Selected elements of an array: an index array, or a slice, which gives a view and not a copy.
Chosen: TypeAlias = Indices | slice
Flags: TypeAlias = NDArray[np.bool_]
# Parameter of a profile: one number, or an array over the cases of a sweep.
Parameter: TypeAlias = float | Array
