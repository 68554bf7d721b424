"""Stick zone and slip annulus under one monotonic tangential load."""

from collections.abc import Callable, Mapping
from math import inf
from typing import Final, NamedTuple

import numpy as np

from mdr_core import equivalent_1d
from mdr_core.elementwise import full, least, number, some, where
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import extremes, first_index


class StickZone(NamedTuple):
    """Stick edge, slip annulus and displacement beyond full slip of every case."""

    edge: Array
    """Stick radius in the contact coordinate; undefined in full slip."""
    width: Array
    """Distance of the stick edge from the contact edge in the contact coordinate."""
    sign: Array
    """Direction of the load; a single 1 if all are positive."""
    full: Flags
    """True in full slip; a single False for no case."""
    excess: Array
    """Displacement beyond that of full slip [length]; a single 0 for no case."""


# Quantities of the normal contact that limit those of the tangential one.
CONTROLS: Final = {
    "tangential_force": "normal_force",
    "tangential_displacement": "indentation_depth",
    "stick_radius": "contact_radius",
}
# Edge, width, full and excess.
_Slipped = tuple[Array, Array, Flags, Array]
_Inverse = Callable[[Profile, Array, Array, Array], tuple[Array, Array]]
_NO_EXCESS: Final = number(0.0)
_POSITIVE: Final = number(1.0)
_NO_FULL_SLIP: Final = _NO_EXCESS > 0


def solve(
    contact: NormalContact, g_star: Parameter, friction: Parameter, name: str, given: Array
) -> StickZone:
    """Return the stick zone of every case.

    Source: mdr-5, Eqs. (5.18)-(5.23).

    Parameters
    ----------
    contact : the normal contact.
    g_star, friction : effective shear modulus [pressure] and friction coefficient [1].
    name, given : one of `CONTROLS`, and its value.

    Raises
    ------
    InputError : a value without equilibrium, outside the contact or not finite.
    """
    sign, size = _sign_and_size(name, given)
    edge, width, full, excess = _BY_CONTROL[name](contact, g_star, friction, size)
    return StickZone(edge, width, sign, full, excess)


def _sign_and_size(name: str, given: Array) -> tuple[Array, Array]:
    """Direction and magnitude of the load, which is checked; a single sign 1 stands for all."""
    low, high = extremes(given)
    if not (low > -inf and high < inf):
        detail = "must be finite" if given.size else "at least one load is needed"
        bad = ~np.isfinite(given)
        index = first_index(bad) if given.size else ()
        raise InputError(("tangential", name, *index), detail, bad)
    if low >= 0 or name == "stick_radius":
        return _POSITIVE, given
    return np.sign(given), np.abs(given)


def _by_force(
    contact: NormalContact, _g_star: Parameter, friction: Parameter, size: Array
) -> _Slipped:
    limit = friction * contact.normal_force
    return _within_limit(equivalent_1d.stick_from_force, contact, size, limit, bounded=True)


def _by_displacement(
    contact: NormalContact, g_star: Parameter, friction: Parameter, size: Array
) -> _Slipped:
    limit = friction * contact.e_star / g_star * contact.indentation_depth
    return _within_limit(equivalent_1d.stick_from_depth, contact, size, limit, bounded=False)


def _within_limit(
    inverse: _Inverse, contact: NormalContact, size: Array, limit: Array, *, bounded: bool
) -> _Slipped:
    """Stick edge and annulus; full slip from the limit on, which a bounded load does not exceed."""
    left, full_slip, excess = limit - size, _NO_FULL_SLIP, _NO_EXCESS
    if least(left) <= 0:
        if bounded and least(left) < 0:
            raise InputError(
                ("tangential", "tangential_force", *(first_index(left < 0) if size.ndim else ())),
                "no equilibrium: the force exceeds friction_coefficient x normal_force",
                left < 0,
            )
        some = limit > 0
        # Without loads there is no slip; without a normal load any displacement is full slip.
        full_slip = where(some, left <= 0, size > 0)
        excess = np.maximum(-left, 0.0)
        size = np.minimum(size, limit)
        left, limit = where(some, np.maximum(left, 0.0), 1.0), where(some, limit, 1.0)
    ratio = size / limit
    left /= limit
    if contact.profile.has_no_partial_slip:
        return contact.coordinate, ratio, full_slip, excess
    return *inverse(contact.profile, contact.coordinate, ratio, left), full_slip, excess


def _by_stick_radius(
    contact: NormalContact, _g_star: Parameter, _friction: Parameter, radius: Array
) -> _Slipped:
    profile, a = contact.profile, contact.contact_radius
    innermost = profile.first_radius
    all_slips = (radius == 0) & (a > 0)
    bad = (radius > a) | (radius < 0) | ((radius > 0) & (radius < innermost))
    detail = "must lie between the flat's radius, or 0, and the contact radius"
    if profile.has_no_partial_slip:
        bad = bad | (radius > 0)
        detail = "a flat punch has no slip annulus: prescribe tangential_force or another load"
    if some(bad):
        index = first_index(bad) if radius.ndim else ()
        raise InputError(("tangential", "stick_radius", *index), detail, bad)
    if profile.has_no_partial_slip:
        return contact.coordinate, full(1.0, radius + a), all_slips, _NO_EXCESS
    c = np.maximum(radius, innermost)
    edge = profile.coordinate_from_radius(c)
    if contact.control == "contact_radius":
        if profile.coordinate_plateaus.size:
            # Beyond it the springs of a plateau of g carry no load.
            a = np.minimum(a, profile.contact_radius(contact.coordinate))
            c = np.minimum(c, a)
        width = profile.coordinate_width(a, c, contact.coordinate, edge)
    else:
        # The coordinate of an edge that follows from a load is accurate, its radius may not be.
        width = where(c < a, np.maximum(contact.coordinate - edge, 0.0), 0.0)
    return edge, width, all_slips, _NO_EXCESS


_BY_CONTROL: Final[
    Mapping[str, Callable[[NormalContact, Parameter, Parameter, Array], _Slipped]]
] = {
    "tangential_force": _by_force,
    "tangential_displacement": _by_displacement,
    "stick_radius": _by_stick_radius,
}
