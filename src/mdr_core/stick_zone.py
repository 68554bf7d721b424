"""Stick zone and slip annulus under one monotonic tangential load."""

from typing import Final

import numpy as np

from mdr_core.elementwise import number, some, where
from mdr_core.equivalent_1d import stick_edge
from mdr_core.normal import NormalContact
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import extremes, reject, require_finite

# Quantities of the normal contact that limit the tangential loads.
CONTROLS: Final = {
    "tangential_force": "normal_force",
    "tangential_displacement": "indentation_depth",
    "stick_radius": "contact_radius",
}
# Stick edge, width, sign, full slip and excess: see `TangentialContact`.
StickZone = tuple[Array, Array, Array, Flags, Array]
_NO_EXCESS: Final = number(0.0)
_POSITIVE: Final = number(1.0)
_NO_FULL_SLIP: Final = _NO_EXCESS > 0


def solve(
    contact: NormalContact, g_star: Parameter, friction: Parameter, name: str, given: Array
) -> StickZone:
    """Return the stick zone of every case.

    Raises InputError for a value without equilibrium, outside the contact or not finite.
    Source: mdr-5, Eqs. (5.18)-(5.23).

    Parameters
    ----------
    contact : the normal contact.
    g_star, friction : effective shear modulus [pressure] and friction coefficient [1].
    name, given : one of `CONTROLS`, and its value.
    """
    require_finite(("tangential", name), given)
    if name == "stick_radius":
        return _by_radius(contact, given)
    of_force = name == "tangential_force"
    # The load or depth at the onset of full slip.
    ratio = friction if of_force else friction * contact.e_star / g_star
    limit = ratio * getattr(contact, CONTROLS[name])
    is_positive = extremes(given)[0] >= 0
    sign, size = (_POSITIVE, given) if is_positive else (np.sign(given), np.abs(given))
    full_slip, excess, left = _NO_FULL_SLIP, _NO_EXCESS, limit - size
    if some(left <= 0):
        if of_force:
            detail = (
                "no equilibrium: the force exceeds friction_coefficient x normal_force; reduce it, "
                "or prescribe tangential_displacement"
            )
            reject(("tangential", name), size, left < 0, detail)
        loaded = limit > 0
        # Without loads there is no slip; without a normal load any displacement is full slip.
        full_slip = where(loaded, left <= 0, size > 0)
        excess = np.maximum(-left, 0.0)
        size = np.minimum(size, limit)
        left, limit = where(loaded, np.maximum(left, 0.0), 1.0), where(loaded, limit, 1.0)
    ratios = size / limit, left / limit
    edge, width = stick_edge(contact.profile, contact.coordinate, *ratios, of_force=of_force)
    return edge, width, sign, full_slip, excess


def _by_radius(contact: NormalContact, radius: Array) -> StickZone:
    """Results of `solve` for a prescribed stick radius."""
    profile, a = contact.profile, contact.contact_radius
    innermost = profile.first_radius
    all_slips = (radius == 0) & (a > 0)
    bad = (radius > a) | (radius < 0) | ((radius > 0) & (radius < innermost))
    detail = "must lie between the flat's radius, or 0, and the contact radius"
    if profile.is_flat_punch:
        bad = bad | (radius > 0)
        detail = "a flat punch has no slip annulus: prescribe tangential_force or another load"
    reject(("tangential", "stick_radius"), radius, bad, detail)
    if profile.is_flat_punch:
        return 0 * radius, contact.coordinate + 0 * radius, _POSITIVE, all_slips, _NO_EXCESS
    c = np.maximum(radius, innermost)
    edge = profile.coordinate_from_radius(c)
    if contact.control == "contact_radius":
        width = a - c
    else:
        # The contact coordinate of a computed edge is accurate; its radius may not be.
        width = where(c < a, np.maximum(contact.coordinate - edge, 0.0), 0.0)
    return edge, width, _POSITIVE, all_slips, _NO_EXCESS
