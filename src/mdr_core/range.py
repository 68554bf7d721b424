"""Contacts that doubles hold with all their answers: the others are refused, never answered."""

from typing import Final

import numpy as np

from mdr_core.checks import extremes, first_index, require_positive
from mdr_core.errors import InputError
from mdr_core.profiles import Profile
from mdr_core.profiles.profile import LARGEST_HELD, NOWHERE, ORDINARY, SMALLEST_HELD
from mdr_core.typing import Array, Flags, Parameter

# Lengths whose squares have all their digits.
_SHORTEST: Final = 1e-145
_LONGEST: Final = 1e145
_SAID: Final = "leaves the range of double precision"


def require_range(
    profile: Profile, e_star: Parameter, name: str, load: Array, coordinate: Array
) -> None:
    """Raise InputError unless the contacts are doubles, as are depth, force and energy.

    A vanished load is no contact, and answered as such. An ordinary contact of an ordinary body
    is told by its coordinate alone.
    """
    softest, stiffest = extremes(e_star)
    ordinary = ORDINARY[0] < softest and stiffest < ORDINARY[1]
    first, last = profile.ordinary_coordinates if ordinary else NOWHERE
    low, high = extremes(coordinate)
    if first < low and high < last:
        return
    require_positive(("material", "e_star"), e_star)
    touching = load > 0 if name != "contact_radius" else coordinate != 0
    touching = np.asarray(touching & ~((first < coordinate) & (coordinate < last)))
    if not touching.any():
        return
    bad = touching & ~_held(profile, e_star, coordinate)
    if bad.any():
        index = first_index(bad) if load.ndim else ()
        detail = f"the contact that answers this load {_SAID}"
        raise InputError(("load", name, *index), detail, bad)
    if not profile.slips_at_once and not all(_measurable(b) for b in profile.breaks):
        raise InputError(("profile",), f"the radius at which the profile changes {_SAID}")


def _held(profile: Profile, e_star: Parameter, coordinate: Array) -> Flags:
    """Where every answer of the contact is a double with all its digits; NaN is none."""
    with np.errstate(all="ignore"):
        depth, reduced = profile.depth(coordinate), profile.reduced_force(coordinate)
        force, energy = e_star * reduced, e_star * profile.reduced_energy(coordinate)
        good = (depth > SMALLEST_HELD) & (reduced > SMALLEST_HELD) & (force > SMALLEST_HELD)
        for answer in (depth, reduced, force, energy):
            good = good & (answer < LARGEST_HELD)
    if profile.slips_at_once:
        return np.asarray(good)
    return np.asarray(good & (coordinate > _SHORTEST) & (coordinate < _LONGEST))


def _measurable(radius: Parameter) -> bool:
    low, high = extremes(radius)
    return low > _SHORTEST and high < _LONGEST
