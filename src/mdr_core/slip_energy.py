"""Moment of the slip annulus, to which the energy dissipated by monotonic loading is proportional.

Source: notes, §6.
"""

import numpy as np

from mdr_core.equivalent_1d import depth_step
from mdr_core.interval_moments import interval_moments
from mdr_core.profiles import Profile
from mdr_core.typing import Array


def slip_moment(profile: Profile, coordinate: Array, width: Array, stick: Array) -> Array:
    """Return int_c^a (g(a) - g(x)) (g(x) - g(c)) dx [length^3].

    It is D^2/4 int 2t(1-t) 2 dx, where D = g(a) - g(c), and t from 0 to 1 is the part of it up to
    x: a Bernstein moment of the springs.

    Source: notes, §6. Parameters: see `depth_step`.
    """
    shape = np.broadcast_shapes(coordinate.shape, width.shape, stick.shape)
    high, width, low = (np.broadcast_to(end, shape).ravel() for end in (coordinate, width, stick))
    swept = {name: np.broadcast_to(profile.parameters[name], shape) for name in profile.swept}
    profile = profile.with_parameters({name: column.ravel() for name, column in swept.items()})
    span = depth_step(profile, high, width, low)
    moments = interval_moments(profile, over_forces=False)
    found = moments.over(profile.depth(low), span, np.array([low, high]))
    return np.asarray(np.square(span) * found.weights[1] / 4).reshape(shape)[()]
