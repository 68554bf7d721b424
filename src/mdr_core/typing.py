"""The array types that all modules share."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]
# Some of an array's entries: any, or a run of neighbours, which is a view and no copy.
Chosen: TypeAlias = Indices | slice
Flags: TypeAlias = NDArray[np.bool_]
# A profile's parameter: one number, or an array over the scenes of a sweep.
Parameter: TypeAlias = float | Array
