"""Amplitudes and grids of the limiting state and of the wear over the cycles."""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.fields import graded
from mdr_core.profiles import Profile
from mdr_core.typing import Array
from mdr_core.validation import only_one, require_not_negative

# The grid extends beyond the worn annulus up to this multiple of its radius.
_GRID_END: Final = 1.25


def one_amplitude(displacement: ArrayLike | None, force: ArrayLike | None) -> tuple[str, Array]:
    """Return the name and the values of the one amplitude that is prescribed.

    Raises InputError for none or both, no value, or a value that is negative or not finite.
    """
    given = {"tangential_displacement": displacement, "tangential_force": force}
    name, values = only_one(("tangential",), given)
    require_not_negative(("tangential", name), values)
    return name, values


def grid(profile: Profile, edges: Array, points: int) -> Array:
    """Return radii from 0 to a quarter beyond the largest edge [length], shape (points,).

    They cluster at the axis, the breaks and the edges that are finite. Raises InputError if there
    are fewer points than such radii.
    """
    known = edges[np.isfinite(edges)]
    last = min(_GRID_END * float(known.max()) or 1.0, float(profile.domain))
    stops = np.unique([0.0, *map(float, profile.breaks), *known])
    return graded(np.append(stops[stops < last], last), points)
