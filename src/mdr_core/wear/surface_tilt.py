"""Tilt of the surface outside the contact by a stick zone that has grown over worn material."""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.typing import Array

# The branch point of the arccosine lies a quarter of the interval before it: 16 points resolve
# the tilt to (3/2 + sqrt(5)/2)^-16 = 2e-7.
_COUNT: Final = 16


@dataclass(frozen=True)
class SurfaceTilt:
    """C(r) = -(2/pi) int arccos(c/r) dw_c on Chebyshev points in 1/r, from a_0 outwards.

    w_c is the wear that the springs keep when the stick edge passes them. All in the units of
    `mdr_core.wear.annulus_state`. Source: notes, §11.
    """

    stick: float
    """c_0."""
    width: float
    """a_0 - c_0."""
    reach: float
    """How far the contact may grow."""

    @property
    def count(self) -> int:
        """Number of points."""
        return _COUNT

    @cached_property
    def _growth(self) -> Array:
        """r - a_0 of the points."""
        share = (1 + chebyshev.chebpts1(_COUNT)) / 2 * self.reach / self._stop
        return np.asarray(share * self._first / (1 - share))

    @property
    def _first(self) -> float:
        return self.stick + self.width

    @property
    def _stop(self) -> float:
        return self._first + self.reach

    def rates(self, shift: float) -> Array:
        """Return dC/dw_c at the points, for a stick edge at c_0 + shift."""
        c, offset = self.stick + shift, self.width + self._growth - shift
        return -2 / np.pi * np.arctan2(np.sqrt(offset * (offset + 2 * c)), c)

    def weights(self, growth: float) -> Array:
        """Return the weights of the values in C(a_0 + growth)."""
        return np.asarray(self._basis(growth)[0] @ self._inverse)

    def at(self, values: Array, growth: float) -> tuple[float, float]:
        """Return C and its slope at the radius a_0 + growth."""
        basis, slopes = self._basis(growth)
        series = self._inverse @ values
        return float(basis @ series), float(slopes @ series)

    def _basis(self, growth: float) -> tuple[Array, Array]:
        radius = self._first + growth
        place = 2 * growth * self._stop / (radius * self.reach) - 1
        slope = 2 * self._first * self._stop / (radius**2 * self.reach)
        basis = chebyshev.chebvander(place, _COUNT - 1)[0]
        return np.asarray(basis), np.asarray(slope * (basis @ _DERIVATIVE))

    @cached_property
    def _inverse(self) -> Array:
        return np.asarray(
            np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(_COUNT), _COUNT - 1))
        )


_DERIVATIVE: Final = np.pad(chebyshev.chebder(np.eye(_COUNT)), ((0, 1), (0, 0)))
