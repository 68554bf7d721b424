"""The stress of a profile that is smooth at the axis, while its slope is a short polynomial."""

from collections.abc import Callable
from functools import lru_cache
from typing import Final

import numpy as np

from mdr_core.abel.polynomial import StressPolynomial, economised, end, interval
from mdr_core.profiles.power_kernels import odd_moment
from mdr_core.typing import Array, Parameter

# Of a over the scale: further out no polynomial is short.
_REACH: Final = 2.0


def smooth_tip_kernel(
    slope: Callable[[Array], Array],
    scale: Parameter,
    a: Array,
    r: Array,
    rtol: float,
    width: Array | None,
    inner: Array | None,
) -> Array | None:
    """(1/pi) int_max(r,c)^a q slope(q^2) / sqrt(x^2 - r^2) dx with q = x/scale, c = a - width.

    None where the slope is no short polynomial. Of one contact, at any radii. Source: notes, §5.
    """
    length = np.asarray(scale).item()
    reach = a.item() / length
    if reach > _REACH:
        return None
    number = interval(reach * reach)
    polynomial = _economised(slope, number, rtol)
    if polynomial is None:
        return None
    kernel = odd_moment(polynomial, length * length * end(number), a, r, width, inner)
    kernel /= np.pi * length
    return kernel


@lru_cache(maxsize=256)
def _economised(
    slope: Callable[[Array], Array], number: int, rtol: float
) -> StressPolynomial | None:
    return economised(slope, (0.0, end(number)), rtol, odd=True)
