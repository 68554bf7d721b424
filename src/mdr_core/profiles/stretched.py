"""Contact coordinates that go on beyond a break, finely where the load needs it.

Right behind a break b the load may grow over a length much shorter than b: over h = b/t where a
steep cone leaves its sphere near the equator, over b R2/R1 where a flat cap ends in a sharp
flank. Neither a nor b + s, s = sqrt(a^2 - b^2), has digits for that length; s over that length
has them, but then b itself, and a stick radius inside it, would be lost in the coordinate of a
contact a few b wide. A power of it keeps both. Source: notes, §4.
"""

from dataclasses import dataclass

import numpy as np

from mdr_core.profiles.power_kernels import power_step, raised
from mdr_core.typing import Array, Parameter


@dataclass(frozen=True)
class Stretched:
    """w = w_b (1 + e)^(1/C) beyond the break's coordinate w_b = `start`, C = `power` >= 1 [1].

    The excess e >= 0 is the kind's own measure of how far the contact is past the break.
    """

    start: Parameter
    power: Parameter

    def coordinate(self, excess: Array) -> Array:
        """w of an excess; each branch where it has its digits."""
        near = np.exp(np.log1p(np.minimum(excess, 1.0)) / self.power)
        far = raised(1 + excess, 1 / np.asarray(self.power))
        return np.asarray(self.start * np.where(excess < 1, near, far))

    def past(self, excess: Array) -> Array:
        """w - w_b, with the digits of a small excess."""
        near = self.start * np.expm1(np.log1p(np.minimum(excess, 1.0)) / self.power)
        return np.asarray(np.where(excess < 1, near, self.coordinate(excess) - self.start))

    def excess(self, coordinate: Array) -> Array:
        """e of a coordinate, zero up to the break."""
        past = np.maximum(coordinate - self.start, 0.0) / self.start
        near = np.expm1(self.power * np.log1p(np.minimum(past, 1.0)))
        far = raised(np.maximum(coordinate, self.start) / self.start, self.power) - 1
        return np.asarray(np.where(past < 1, near, far))

    def slope(self, coordinate: Array) -> Array:
        """de/dw."""
        return self.power * (1 + self.excess(coordinate)) / coordinate

    def step(self, high: Array, width: Array, low: Array) -> Array:
        """e(high) - e(low), low = high - width, both beyond the break."""
        return (1 + self.excess(high)) * power_step(high, width, low, np.asarray(self.power))

    def width(self, high: Array, low: Array, step: Array) -> Array:
        """high - low with the digits of the step of the excess: the inverse of `step`."""
        part = step / (1 + self.excess(high))
        narrow = -high * np.expm1(np.log1p(-np.minimum(part, 0.5)) / self.power)
        return np.asarray(np.where(part < 0.5, narrow, high - low))
