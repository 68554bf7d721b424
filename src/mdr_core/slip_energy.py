"""Moment of the slip annulus, to which the energy dissipated by monotonic loading is proportional.

Source: notes, §6.
"""

from typing import Final

import numpy as np

from mdr_core.elementwise import is_number, some
from mdr_core.equivalent_1d import depth_step
from mdr_core.interval_moments import interval_moments
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Area over F d from which on it is a difference of energies: cancellation costs less than three of
# the digits that the estimate leaves.
_MIN_AREA_RATIO: Final = 2e-3


def slip_moment(
    profile: Profile, coordinate: Array, width: Array, stick: Array, energy: Array
) -> Array:
    """Return int_c^a (g(a) - g(x)) (g(x) - g(c)) dx [length^3].

    It is the area between F(d) from c to a and its chord. In narrow annuli, where that is a small
    difference, it is D^2/4 int 2t(1-t) 2 dx, where D = g(a) - g(c), and t from 0 to 1 is the part
    of it up to x: a moment of the springs.

    Source: notes, §6. Parameters: see `depth_step`; `energy` is the elastic energy over E* at a
    [length^3].
    """
    closed = profile.slip_moment(coordinate, width, stick)
    if closed is not None:
        return closed
    with np.errstate(over="ignore", invalid="ignore"):
        d, force = profile.depth(coordinate), profile.reduced_force(coordinate)
        chord = (d - profile.depth(stick)) * (force + profile.reduced_force(stick)) / 2
        area = chord - (energy - profile.reduced_energy(stick))
        narrow = ~(area > _MIN_AREA_RATIO * d * force)
    if not some(narrow):
        return area
    ends = coordinate, width, stick
    if is_number(area):
        return _by_springs(profile, *map(np.atleast_1d, ends))[0]
    cases = [np.broadcast_to(end, area.shape)[narrow] for end in ends]
    swept = {name: np.broadcast_to(profile.parameters[name], area.shape) for name in profile.swept}
    part = profile.with_parameters({name: column[narrow] for name, column in swept.items()})
    area[narrow] = _by_springs(part, *cases)
    return area


def _by_springs(profile: Profile, high: Array, width: Array, low: Array) -> Array:
    """D^2/4 times the second Bernstein moment of the springs."""
    span = depth_step(profile, high, width, low)
    moments = interval_moments(profile, over_forces=False)
    found = moments.over(profile.depth(low), span, np.array([low, high]))
    return np.asarray(np.square(span) * found.weights[1] / 4)
