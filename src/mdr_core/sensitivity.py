"""How much of the loads' own rounding is felt in partial slip: what no method can win back.

A double stands for its neighbourhood. Where answers differ much between neighbouring loads, as
the stick radius does next to full slip, that is a part of their error.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from mdr_core.annulus import stick_from_force
from mdr_core.foundation import Function, force_slope
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags

# Relative step of the difference that shows how fast the slope changes next to a break.
_STEP: Final = 4e-11
_EPS: Final = float(np.finfo(float).eps)
_TINY: Final = float(np.finfo(float).tiny)
# The energy over a narrow annulus goes with the third power of its width.
_CUBE: Final = 3.0
# Up to this part of full slip nothing feels more than some times what it is given.
_LATE: Final = 0.9
# A force so near to its limit slides.
_SLIDING: Final = 1e-12


def near_full_slip(
    profile: Profile,
    ends: tuple[Array, Array],
    ratio: Array,
    partial: Flags,
    *,
    by_force: bool,
    edges: bool = True,
) -> float:
    """Return the most that an answer feels of the load: large where little is left to full slip.

    `ends` are a and c in the contact coordinate, `ratio` the load in parts of full slip. What is
    left is F_N(c) under a force and d(c) under a displacement: c feels it by one over its
    elasticity, and by c all else; without `edges`, forces, displacements and energies alone.
    """
    late = partial & (ratio > _LATE)
    if profile.slips_at_once or not late.any():
        return 0.0
    high, low = ends[0], np.maximum(ends[1], _TINY)
    load, slope = _load(profile, by_force=by_force)
    other, other_slope = _load(profile, by_force=not by_force)
    with np.errstate(all="ignore"):
        moved = load(low) / (slope(low) * np.maximum(1 - ratio, _EPS / 2))
        felt = _CUBE * moved * other_slope(low) / (other(high) - other(low))
        if edges:
            radial = moved * profile.radius_slope(low)
            c, a = profile.contact_radius(low), profile.contact_radius(high)
            felt = np.stack(np.broadcast_arrays(radial / c, radial / (a - c), felt))
    return float(np.max(np.where(late & np.isfinite(felt), felt, 0.0)))


def of_forces(contact: NormalContact, size: Array, limit: Array) -> float:
    """Return the most that a way given by forces feels of them, next to full slip."""
    partial = (limit > 0) & (size < limit)
    ratio = np.where(partial, size / np.where(limit > 0, limit, 1.0), 0.0)
    worst = np.argmax(ratio)
    if contact.profile.slips_at_once or not ratio[worst] > _LATE:
        return 0.0
    given = contact.coordinate[worst], ratio[worst], 1 - ratio[worst]
    edge, _ = stick_from_force(contact.profile, *map(np.asarray, given))
    ends = np.asarray(given[0]), edge
    part = ratio[worst], partial[worst]
    return near_full_slip(contact.profile, ends, *part, by_force=True, edges=False)


def of_travel(travel: Array, force: Array, limit: Array, lost: Callable[[], Array]) -> float:
    """Return the most that the energy lost on a way feels of its travel, beyond full slip."""
    slides = (limit > 0) & (np.abs(force) >= limit * (1 - _SLIDING))
    if not slides.any():
        return 0.0
    most = float(np.max(lost()))
    felt = np.max(np.where(slides, limit * np.abs(travel), 0.0))
    return float(felt) / most if most > 0 else 0.0


def narrow_annulus(coordinate: Array, width: Array) -> float:
    """Return the most that an annulus between two given edges feels of them, 3 a/(a - c)."""
    some = width > 0
    if not np.any(some):
        return 0.0
    return _CUBE * float(np.max(np.where(some, coordinate / np.where(some, width, 1.0), 0.0)))


def excess_of_travel(displacement: Array, excess: Array) -> float:
    """Return the most that the travel beyond full slip feels of the displacement, u/(u - u_max)."""
    slides = np.asarray(excess > 0)
    if not slides.any():
        return 0.0
    parts = np.abs(displacement) / np.where(slides, excess, 1.0)
    return float(np.max(np.where(slides, parts, 0.0)))


def behind_break(contact: NormalContact) -> float:
    """Return |d log g'(a) / d log(load)|, large where the edge has just passed a break.

    The first slip annulus is as narrow as g' at the edge is large.
    """
    profile = contact.profile
    if not np.size(profile.coordinate_breaks):
        return 0.0
    load, slope = _load(profile, by_force=contact.control == "normal_force")
    if contact.control == "contact_radius":
        load, slope = profile.contact_radius, profile.radius_slope
    at = np.where(contact.coordinate > 0, contact.coordinate, np.nan)
    with np.errstate(all="ignore"):
        rise = np.log(_radial_slope(profile, at * (1 + _STEP)))
        rise = rise - np.log(_radial_slope(profile, at * (1 - _STEP)))
        felt = np.abs(rise) * load(at) / (2 * _STEP * at * slope(at))
    return float(np.max(np.where(np.isfinite(felt), felt, 0.0)))


def _radial_slope(profile: Profile, coordinate: Array) -> Array:
    """g'(a) [1]."""
    return profile.depth_slope(coordinate) / profile.radius_slope(coordinate)


def _load(profile: Profile, *, by_force: bool) -> tuple[Function, Function]:
    """F_N/E* or d as a function of the contact coordinate, and its derivative."""
    if by_force:
        return profile.reduced_force, force_slope(profile)
    return profile.depth, profile.depth_slope
