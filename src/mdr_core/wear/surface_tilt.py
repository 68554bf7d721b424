"""Tilt of the surface outside the contact by a stick zone that has grown over worn material."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.typing import Array

# The branch point of the arccosine lies a quarter of the interval before it: 16 terms resolve
# the tilt to (3/2 + sqrt(5)/2)^-16 = 2e-7.
COUNT: Final = 16


@dataclass(frozen=True)
class SurfaceTilt:
    """C(r) = -(2/pi) int arccos(c/r) dw_c as a Chebyshev series in 1/r, from a_0 outwards.

    w_c is the wear that the springs keep when the stick edge passes them. All in the units of
    `mdr_core.wear.initial_state`. Source: notes, §11.
    """

    stick: float
    """c_0."""
    width: float
    """a_0 - c_0."""
    largest_growth: float
    """Largest growth of the contact radius."""

    def rates(self, stick_shift: float) -> Array:
        """Return the terms of dC/dw_c, for a stick edge at c_0 + stick_shift, (COUNT,)."""
        first, c = self.stick + self.width, self.stick + stick_shift
        share = (1 + _POINTS) / 2 * self.largest_growth / (first + self.largest_growth)
        offset = self.width + share * first / (1 - share) - stick_shift
        values = -2 / np.pi * np.arctan2(np.sqrt(offset * (offset + 2 * c)), c)
        return np.asarray(_TO_SERIES @ values)

    def basis(self, growth: float) -> tuple[Array, Array]:
        """Return the values of the terms at the radius a_0 + growth, and their slopes, (COUNT,)."""
        first = self.stick + self.width
        radius, stop = first + growth, first + self.largest_growth
        place = 2 * growth * stop / (radius * self.largest_growth) - 1
        slope = 2 * first * stop / (radius**2 * self.largest_growth)
        values = chebyshev.chebvander(place, COUNT - 1)[0]
        return np.asarray(values), np.asarray(slope * (values @ _DERIVATIVE))


_POINTS: Final = chebyshev.chebpts1(COUNT)
_TO_SERIES: Final = np.linalg.inv(chebyshev.chebvander(_POINTS, COUNT - 1))
_DERIVATIVE: Final = np.pad(chebyshev.chebder(np.eye(COUNT)), ((0, 1), (0, 0)))
