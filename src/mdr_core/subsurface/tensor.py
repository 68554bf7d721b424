"""Stress tensor at points, with its invariants."""

from math import inf
from typing import NamedTuple

import numpy as np

from mdr_core.typing import Array


class StressTensor(NamedTuple):
    """Stresses at points, tension positive, x along the tangential force, z into the body.

    Each has the shape of the points, or of loads and points. Where the pressure is infinite, the
    normal stresses are -inf.
    """

    xx: Array
    """[pressure]"""
    yy: Array
    """[pressure]"""
    zz: Array
    """[pressure]"""
    xy: Array
    """[pressure]"""
    xz: Array
    """[pressure]"""
    yz: Array
    """[pressure]"""

    @property
    def mean_stress(self) -> Array:
        """A third of the trace [pressure]."""
        return np.asarray((self.xx + self.yy + self.zz) / 3)

    @property
    def von_mises(self) -> Array:
        """Von Mises' equivalent stress [pressure]; infinite where the stress is."""
        xx, yy, zz, xy, xz, yz = self._finite()
        normal = np.square(xx - yy) + np.square(yy - zz) + np.square(zz - xx)
        shear = np.square(xy) + np.square(xz) + np.square(yz)
        return np.where(np.isinf(self.zz), inf, np.sqrt(normal / 2 + 3 * shear))

    @property
    def principal(self) -> Array:
        """Principal stresses, ascending in a last axis of length 3 [pressure]."""
        xx, yy, zz, xy, xz, yz = self._finite()
        rows = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        values = np.linalg.eigvalsh(np.moveaxis(rows, (0, 1), (-2, -1)))
        return np.where(np.isinf(self.zz)[..., None], -inf, values)

    @property
    def maximum_shear(self) -> Array:
        """Largest shear stress, half the difference of the extreme principal ones [pressure]."""
        values = StressTensor(*self._finite()).principal
        return np.where(np.isinf(self.zz), inf, (values[..., 2] - values[..., 0]) / 2)

    def _finite(self) -> list[Array]:
        """The components, zero where they are infinite."""
        return [np.where(np.isinf(self.zz), 0.0, part) for part in self]
