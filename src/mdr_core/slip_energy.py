"""Moment of the slip annulus, to which the energy dissipated by monotonic loading is proportional.

Source: notes, §6.
"""

from typing import Final

import numpy as np

from mdr_core.broadcasting import in_blocks
from mdr_core.elementwise import is_number, where
from mdr_core.equivalent_1d import depth_step
from mdr_core.interval_moments import IntervalMoments
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Cases evaluated at once, so that their nodes stay in the processor's cache.
_BLOCK: Final = 4096
# Area over F d from which on it is a difference of energies: cancellation costs less than three of
# the digits that the estimate leaves.
_BOWED: Final = 2e-3


def slip_moment(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return int_c^a (g(a) - g(x)) (g(x) - g(c)) dx [length^3].

    It is the area between F(d) from c to a and its chord. In narrow annuli, where that is a small
    difference, it is D^2/4 int 2t(1-t) 2 dx, where D = g(a) - g(c), and t from 0 to 1 is the part
    of it up to x: a moment of the springs.

    Source: notes, §6.

    Parameters
    ----------
    profile : parameters broadcast with the annuli.
    coordinate : a as a contact coordinate.
    width, stick : a - c and c in the contact coordinate, each accurate by itself.
    """
    closed = profile.slip_moment(coordinate, width, stick)
    if closed is not None:
        return closed
    if not profile.has_closed_energy:
        return _by_springs(profile, coordinate, width, stick)
    with np.errstate(over="ignore", invalid="ignore"):
        low = np.maximum(stick, profile.first_coordinate)
        (d, force, energy), (less, weaker, lower) = (
            (profile.depth(s), profile.reduced_force(s), profile.reduced_energy(s))
            for s in (coordinate, low)
        )
        area = (d - less) * (force + weaker) / 2 - (energy - lower)
        bowed = area > _BOWED * d * force
    if bowed.all():
        return area
    return where(bowed, area, _by_springs(profile, coordinate, width, stick))


def _by_springs(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """D^2/4 times the second Bernstein moment of the springs."""

    def _moment(profile: Profile, high: Array, width: Array, low: Array) -> tuple[Array]:
        span = depth_step(profile, high, width, low)
        moments = IntervalMoments(profile, by_force=False)
        found = moments.over(profile.depth(low), span, np.stack([low, high]))
        return (np.square(span) * found.weights[1] / 4,)

    ends = coordinate, width, stick
    if is_number(sum(ends)) and not profile.swept:
        return _moment(profile, *map(np.atleast_1d, ends))[0][0]
    swept = [profile.parameters[name] for name in profile.swept]
    shape = np.broadcast_shapes(*map(np.shape, (*ends, *swept)))
    (result,) = in_blocks(_moment, profile, [np.atleast_1d(end) for end in ends], _BLOCK)
    return result.reshape(shape)
