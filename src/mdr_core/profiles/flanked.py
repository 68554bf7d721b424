"""Profiles whose g has a root at the end of a flat or of a tip."""

from abc import abstractmethod
from collections.abc import Callable
from math import radians, tan

import numpy as np

from mdr_core.profiles.base import Profile
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.typing import Array, Parameter


def slope_of_half_angle(half_angle: float) -> float:
    """Return the slope tan(90 - half_angle) [1] of a flank at this angle to the axis [degree]."""
    # Neither angle has a rounding error: 90 - half_angle is exact above 45.
    return tan(radians(90 - half_angle)) if half_angle > 45 else 1 / tan(radians(half_angle))


class Flanked(Profile):
    """Profile given in x and s = sqrt(x^2 - b^2) on its flank, beyond the radius b."""

    @property
    @abstractmethod
    def flank_start(self) -> Parameter:
        """Radius b at which the flat, or the tip, ends [length]."""

    @abstractmethod
    def _flank_depth(self, x: Array, s: Array) -> Array:
        """g(x) on the flank [length]."""

    @abstractmethod
    def _flank_slope(self, x: Array, s: Array) -> Array:
        """g'(x) on the flank [1]."""

    @abstractmethod
    def _flank_force(self, x: Array, s: Array) -> Array:
        """F_N(x)/E* on the flank [length^2]."""

    @abstractmethod
    def weight(self, x: Array, s: Array) -> Array:
        """Slope dg/ds = g'(x) s/x on the flank [1], analytic in s."""

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.flank_start,)

    @property
    def scale(self) -> Parameter:
        return self.flank_start

    def flank(self, past: Array) -> tuple[Array, Array]:
        """x and s at x = b + past."""
        b = self.flank_start
        return b + past, np.sqrt(past * (2 * b + past))

    def _over_flank(self, factor: Callable[[Array, Array], Array], past: Array) -> Array:
        """Integral of a factor of x and s over g, from b to b + past."""
        b = self.flank_start

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            return factor(x, s) * self.weight(x, s)

        nearest = np.minimum(b, self.opposite_singularity)
        return power_law_integral(density, self.flank(past)[1], nearest)
