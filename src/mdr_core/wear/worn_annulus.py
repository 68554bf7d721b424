"""Annulus c < r < c + w outside the stick zone, with the relative accuracy of its width w.

The worn depth follows from g - g(c) in the annulus. Near incipient slip the annulus is narrow: its
width is the unknown, and the root at the inner edge follows from it, not from two radii.
Source: notes, §9.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.abel.displacement import Kernel, arccosine
from mdr_core.inversion import invert
from mdr_core.profiles import Profile
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Indices

# Relative tolerance of the integrals, about 500 times the rounding error. A looser one would save
# less than a tenth of the time, and the worn depth is a difference.
RTOL: Final = 1e-13
# As near to the end of a profile as its functions are evaluated: they may be infinite there.
ALMOST: Final = 1 - 1e-9
# Gauss-Legendre nodes of the area of a segment, over an angle of at most pi/2.
_NODES: Final = 10


@dataclass(frozen=True)
class WornAnnulus:
    """Worn annuli about the stick zones of contacts with one profile; arrays of shape (m,)."""

    profile: Profile
    stick: Array
    """c, the inner edge [length]."""

    @property
    def largest_width(self) -> Array:
        """Width at which the annulus reaches the end of the profile [length], > 0."""
        room = ALMOST * float(self.profile.domain) - self.stick
        return np.asarray(np.maximum(room, np.finfo(float).tiny))

    def chosen(self, which: Indices) -> "WornAnnulus":
        """Return some of the annuli."""
        return WornAnnulus(self.profile, self.stick[which])

    def slip_kernel(self, width: Array) -> Array:
        """Return S(c; c + w) = (2/pi) int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx [length].

        Source: mdr-5, Eq. (5.41).
        """
        return 2 / np.pi * self._integrals(width, arccosine)[0]

    def mean_rise(self, width: Array) -> Array:
        """Return the mean of g(r cos(t)) - g(c) over 0 < t < arccos(c/r), r = c + w [length].

        At the outer edge, where the worn depth vanishes, it equals d - g(c), Eq. (5.88). It grows
        with the width wherever g does. Source: notes, §9.
        """
        return self._integrals(width, arccosine)[0] / self.angle(width)

    def _root(self, width: Array) -> Array:
        """Return sqrt(r^2 - c^2) [length]."""
        return np.asarray(np.sqrt(width * (2 * self.stick + width)))

    def angle(self, width: Array) -> Array:
        """Return arccos(c/r) [1]."""
        return np.asarray(np.arctan2(self._root(width), self.stick))

    def worn_volume(self, width: Array, step: Array) -> Array:
        """Return 4 int_c^r (d - g(x)) sqrt(r^2 - x^2) dx = 2 pi int_c^r h r dr [length^3].

        `step` = d - g(c). At the outer edge the derivative by the width vanishes with the worn
        depth h, so that the rounding error of the width has no effect. Source: notes, §9.
        """
        constant = _segment(self.stick, self._root(width))
        return np.asarray(4 * (step * constant - self._integrals(width, _segment)[0]))

    def width_where_worn(self, step: Array, start: Array) -> Array:
        """Return the width at which `mean_rise` equals the step; NaN if it is not representable.

        Source: mdr-5, Eq. (5.88), for any profile.
        """

        def sloped(width: Array) -> tuple[Array, Array]:
            root, c, r = self._root(width), self.stick, self.stick + width
            total, growth = self._integrals(width, arccosine, _rate)
            angle = np.arctan2(root, c)
            return total / angle, width * (growth / total - c / (r * root) / angle)

        return invert(
            sloped,
            step,
            start,
            np.zeros_like(step),
            self.largest_width,
            f"{self.profile.kind}'s worn annulus",
        )

    def _integrals(self, width: Array, *kernels: Kernel) -> Array:
        """Return int_c^r g'(x) K dx for each kernel K, shape (k, m)."""
        if self.profile.has_no_partial_slip:
            return np.zeros((len(kernels), width.size))
        return self.profile.annulus_integrals(self.stick, width, *kernels, rtol=RTOL)


def _rate(x: Array, root: Array) -> Array:
    """Return d arccos(x/r)/dr = x/(r sqrt(r^2 - x^2))."""
    return np.asarray(x / (root * np.hypot(x, root)))


def _segment(x: Array, root: Array) -> Array:
    """Return int_x^r sqrt(r^2 - t^2) dt = r^2 int_0^arccos(x/r) sin^2 t dt."""
    angle = np.arctan2(root, x)
    nodes, weights = gauss_legendre(_NODES)
    sines = np.sin(np.multiply.outer(angle, (1 + nodes) / 2))
    return np.asarray((x * x + root * root) * angle / 2 * (sines**2 @ weights))
