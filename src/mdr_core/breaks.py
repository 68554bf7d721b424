"""Breaks of an equivalent profile, where its slope has a root, in the contact coordinate."""

from typing import Final

import numpy as np

from mdr_core.elementwise import full, where
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# A gap between breaks longer than twice this many times the one before is divided in such ratios.
_GROWTH: Final = 4.0


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


def divided_breaks(profile: Profile) -> Array:
    """Return the coordinates of a profile's breaks, and points that divide long gaps between them.

    The root singularity at one break limits the convergence of quadrature beyond the next.
    """
    breaks = profile.coordinate_breaks
    gaps, added = np.diff(breaks), [breaks]
    for i in np.flatnonzero(gaps[1:] > 2 * _GROWTH * gaps[:-1]).tolist():
        count = int(np.log(gaps[i + 1] / (2 * gaps[i])) / np.log(_GROWTH))
        added.append(breaks[i + 1] + gaps[i] * _GROWTH ** np.arange(1, count + 1))
    return np.sort(np.concatenate(added))


def has_many_breaks(profile: Profile) -> bool:
    """True for tables of several intervals, whose parameters are never arrays."""
    return profile.coordinate_breaks.size > 1 and not profile.swept
