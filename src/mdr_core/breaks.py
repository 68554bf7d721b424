"""Breaks of an equivalent profile, where its slope has a root, in the contact coordinate."""

import numpy as np

from mdr_core.elementwise import full, where
from mdr_core.profiles import Profile
from mdr_core.typing import Array


def break_below(profile: Profile, high: Array) -> tuple[Array, Array]:
    """Return the nearest break below each coordinate and the one before it; zero for none."""
    breaks = profile.coordinate_breaks
    if has_many_breaks(profile):
        padded = np.concatenate([[0.0, 0.0], breaks])
        index = np.maximum(np.searchsorted(padded, high, side="left") - 1, 1)
        return padded[index], padded[index - 1]
    nothing = full(0.0, high)
    if not breaks.size:
        return nothing, nothing
    # Every case of a sweep has its own break.
    own = breaks if profile.swept else breaks[0]
    return where(high > own, own, 0.0), nothing


def has_many_breaks(profile: Profile) -> bool:
    """True for tables of several intervals, whose parameters are never arrays."""
    return profile.coordinate_breaks.size > 1 and not profile.swept
