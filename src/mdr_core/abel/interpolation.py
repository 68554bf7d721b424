"""Where a polynomial is fixed by its values: Chebyshev's points, which leave out the ends."""

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.typing import Array


@lru_cache(maxsize=16)
def chebyshev_points(count: int) -> tuple[Array, Array]:
    """Return the points of the first kind on [-1, 1], and the matrix from values to coefficients.

    The polynomial of degree count - 1 with the values f at the points (count,) has the Chebyshev
    coefficients M f, M (count, count).

    Examples
    --------
    >>> points, to_coefficients = chebyshev_points(3)
    >>> bool(np.allclose(to_coefficients @ (2 * points**2 - 1), [0.0, 0.0, 1.0]))
    True
    """
    points = np.asarray(chebyshev.chebpts1(count), dtype=float)
    return points, np.linalg.inv(chebyshev.chebvander(points, count - 1))
