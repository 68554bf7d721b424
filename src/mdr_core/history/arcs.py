"""The curves that a load follows if one of each pair of loads is controlled: arcs.

The polyline of `memory` goes over levels: depths if the displacement is controlled, reduced forces
if the tangential force is. The normal load is given by the other of the two, and on a leg the
shift is linear in that one. So whatever the profile, and whatever the leg,

    shift = shift_0 + rate (other(s) - other(s_0)),    level = level(s),

with d(other)/d(level) = 2 a or 1/(2 a) from dF_N/E* = 2 a dd: in the contact coordinate s an arc is
the profile's own force over its own depth, stretched. On a leg its slope passes the cone's at one
radius at most. Source: notes, §10.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.errors import DefectError
from mdr_core.foundation import Function, coordinate_from_depth, coordinate_from_force
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices

_STEPS: Final = 120
# Newton's step, relative to the root, at which the next error is below rounding.
_LAST_STEP: Final = 1e-9
_SETTLED: Final = 1e-6
# A root on the axis is nearer to it than this, of the bracket.
_NEXT_TO_NOTHING: Final = 1e-12
_ADJACENT: Final = 2.0**-51


@dataclass(frozen=True)
class Plane:
    """What levels are, and what is linear in time."""

    profile: Profile
    by_force: bool
    """Levels are I = F_N/E* [length^2] and the depth is given; else the other way round."""

    @property
    def level(self) -> Function:
        """Level of a contact coordinate."""
        return self.profile.reduced_force if self.by_force else self.profile.depth

    @property
    def other(self) -> Function:
        """The other of the two, which is given."""
        return self.profile.depth if self.by_force else self.profile.reduced_force

    def slopes(self, s: Array) -> tuple[Array, Array]:
        """d(level)/ds and d(other)/ds."""
        rise = self.profile.depth_slope(s)
        force = 2 * self.profile.contact_radius(s) * rise
        return (force, rise) if self.by_force else (rise, force)

    def at_level(self, level: Array) -> Array:
        """Contact coordinate of a level."""
        find = coordinate_from_force if self.by_force else coordinate_from_depth
        return find(self.profile, level)

    def at_other(self, other: Array) -> Array:
        """Contact coordinate of the other."""
        find = coordinate_from_depth if self.by_force else coordinate_from_force
        return find(self.profile, other)

    def steepness(self, s: Array) -> Array:
        """d(other)/d(level)."""
        twice = 2 * self.profile.contact_radius(s)
        return 1 / twice if self.by_force else twice

    def radius_on_the_cone(self, rate: Array) -> Array:
        """Radius at which an arc of this rate is as steep as the cone; infinite without one."""
        size = np.abs(rate)
        if self.by_force:
            return size / 2
        with np.errstate(divide="ignore"):
            return 1 / (2 * size)


def rising_root(
    function: Callable[[Indices, Array], tuple[Array, Array]],
    low: Array,
    high: Array,
    goal: Array | None = None,
) -> Array:
    """Return where increasing functions are zero; function(index, s) gives values and slopes.

    Newton's method; the bracket [low, high] is narrowed by the signs, and its middle replaces a
    step that leaves it, or is not half as long as the one before. Beyond the bracket's ends by a
    rounding, the end is the root. All arrays have one axis.

    Where a function is -`goal` < 0 at its lower end, it is better known by how it grows from there:
    like powers of the distance, which logarithms make straight. It is followed down from the
    upper end, where powers are the highest.
    """
    s, last = high if goal is not None else (low + high) / 2, high - low
    least = _ADJACENT * _NEXT_TO_NOTHING * high
    root, index, start = s.copy(), np.arange(s.size), low
    settling = np.zeros(s.shape, dtype=bool)
    for _ in range(_STEPS):
        with np.errstate(all="ignore"):
            value, slope = function(index, s)
            moved = s - value / slope
            if goal is not None:
                grown, far = value + goal[index], s - start[index]
                power = far * slope / grown
                moved = start[index] + far * np.exp(-np.log(grown / goal[index]) / power)
        low, high = np.where(value < 0, s, low), np.where(value > 0, s, high)
        # At a break of the profile the slope may be infinite.
        known = (moved >= low) & (moved <= high) & (slope < np.inf)
        # One short step may only say that the function is steep; and next to where it is level
        # the steps end in rounding.
        done = settling & (np.abs(moved - s) <= _SETTLED * s)
        known &= (np.abs(moved - s) <= np.maximum(last / 2, _LAST_STEP * s)) | done
        rests = (value == 0) | (done & (np.abs(moved - s) > last))
        moved = np.where(rests, s, np.where(known, moved, (low + high) / 2))
        s, last = moved, np.abs(moved - s)
        short = known & (last <= _LAST_STEP * s) | (value == 0)
        done |= (high - low <= np.maximum(_ADJACENT * high, least)) | (settling & short)
        if done.any():
            root[index] = s
            rest = ~done
            index, least = index[rest], least[rest]
            s, last, low, high = (part[rest] for part in (s, last, low, high))
            short = short[rest]
        if not index.size:
            return root
        settling = short
    raise DefectError("a point on an arc was not found")
