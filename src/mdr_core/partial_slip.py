"""How far slip has come under one given tangential load: the stick edge and the annulus."""

from collections.abc import Callable, Mapping
from math import inf
from typing import Final, NamedTuple

import numpy as np

from mdr_core import annulus
from mdr_core.checks import extremes, first_index, largest, least
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.sweeps import in_blocks
from mdr_core.typing import Array, Flags, Parameter


class State(NamedTuple):
    """Stick edge and annulus, and what lies beyond full slip, at every load at once."""

    edge: Array
    """In the contact coordinate, as the width; without meaning in full slip."""
    width: Array
    sign: Array
    """Direction of the load; a single 1 where all are positive."""
    full: Flags
    """Where everything slips; a single false for nowhere."""
    excess: Array
    """What the displacement exceeds that of full slip by [length]; a single 0 for none."""


# What may be given, and the answer of the normal contact that it is measured by.
CONTROLS: Final = {
    "tangential_force": "normal_force",
    "tangential_displacement": "indentation_depth",
    "stick_radius": "contact_radius",
}
# Edge, width, full and excess.
_Slipped = tuple[Array, Array, Flags, Array]
# Below it doubles lose their digits one by one.
_TINY: Final = float(np.finfo(float).tiny)
_Inverse = Callable[[Profile, Array, Array, Array], tuple[Array, Array]]


def state(
    contact: NormalContact, g_star: Parameter, friction: Parameter, name: str, given: Array
) -> State:
    """Return the state under the load of that name, one of `CONTROLS`.

    Source: mdr-5, Eqs. (5.18)-(5.23).
    """
    sign, size = _sign_and_size(name, given)
    edge, width, full, excess = _BY_CONTROL[name](contact, g_star, friction, size)
    return State(edge, width, sign, full, excess)


def state_of_sweep(
    contact: NormalContact, g_star: Parameter, friction: Parameter, name: str, given: Array
) -> State | None:
    """Return the same for many scenes; None if one is refused, which no block can name."""
    needed = CONTROLS[name]

    def block(
        profile: Profile, e_star: Parameter, coordinate: Array, answer: Array, *rest: Array
    ) -> State:
        part = NormalContact(profile, e_star, coordinate)
        vars(part)[needed] = answer
        return state(part, rest[0], rest[1], name, rest[2])

    values = contact.e_star, contact.coordinate, getattr(contact, needed), g_star, friction, given
    try:
        return State(*in_blocks(block, contact.profile, values))
    except InputError:
        return None


def _sign_and_size(name: str, given: Array) -> tuple[Array, Array]:
    """Direction and amount of the load, all of it checked; the sign 1 stands for all."""
    if given.ndim and given.flags.c_contiguous and given.size and largest(given) < inf:
        # Of many loads one pass says that all are good, and none negative.
        return np.asarray(1.0), given
    low, high = extremes(given)
    if not (low > -inf and high < inf):
        detail = "must be finite" if given.size else "at least one load is needed"
        bad = np.asarray(~np.isfinite(given))
        index = first_index(bad) if given.size else ()
        raise InputError(("tangential", name, *index), detail, bad)
    if low >= 0 or name == "stick_radius":
        return np.asarray(1.0), given
    return np.sign(given), np.abs(given)


def _by_force(
    contact: NormalContact, g_star: Parameter, friction: Parameter, size: Array
) -> _Slipped:
    del g_star
    name = "tangential_force"
    limit = np.asarray(friction * contact.normal_force)
    left = np.asarray(limit - size)
    smallest = left.min()
    if smallest < 0:
        raise InputError(
            ("tangential", name, *(first_index(left < 0) if size.ndim else ())),
            "no equilibrium: the force exceeds friction_coefficient x normal_force",
            left < 0,
        )
    if smallest > 0:
        return *_partial(name, contact, size, left, limit), _NOWHERE, _NOTHING
    return _somewhere_full(name, contact, size, left, limit)


def _by_displacement(
    contact: NormalContact, g_star: Parameter, friction: Parameter, size: Array
) -> _Slipped:
    name = "tangential_displacement"
    limit = np.asarray(friction * contact.e_star / g_star * contact.indentation_depth)
    left = np.asarray(limit - size)
    if left.min() > 0:
        return *_partial(name, contact, size, left, limit), _NOWHERE, _NOTHING
    return _somewhere_full(name, contact, size, left, limit)


def _somewhere_full(
    name: str, contact: NormalContact, size: Array, left: Array, limit: Array
) -> _Slipped:
    """Loads of which some leave nothing of the limit, `left` <= 0."""
    some = limit > 0
    # Where neither load is, nothing slips; without a normal load any displacement slides.
    full = np.asarray(np.where(some, left <= 0, size > 0))
    edge, width = _partial(
        name,
        contact,
        np.minimum(size, limit),
        np.where(some, np.maximum(left, 0.0), 1.0),
        np.where(some, limit, 1.0),
    )
    return edge, width, full, np.maximum(-left, 0.0)


def _partial(
    name: str, contact: NormalContact, size: Array, left: Array, limit: Array
) -> tuple[Array, Array]:
    """Stick edge and annulus under size = limit - left, each with its own digits; limit > 0.

    Consumes `left` and `limit`: what is written to memory of its own has to leave the cache.
    """
    left /= limit
    ratio = np.divide(size, limit, out=limit if limit.shape == left.shape else None)
    if contact.profile.slips_at_once:
        edge, width = contact.coordinate, ratio
    else:
        edge, width = _INVERSES[name](contact.profile, contact.coordinate, ratio, left)
    if min(least(ratio), least(width)) < _TINY:
        lost = (size > 0) & ((ratio < _TINY) | (width < _TINY))
        if lost.any():
            raise InputError(
                ("tangential", name, *(first_index(lost) if size.ndim else ())),
                "slip of this load is too narrow for double precision",
                lost,
            )
    return edge, width


def _by_stick_radius(
    contact: NormalContact, g_star: Parameter, friction: Parameter, radius: Array
) -> _Slipped:
    del g_star, friction
    profile, a = contact.profile, np.asarray(contact.contact_radius)
    innermost = profile.contact_radius(np.asarray(profile.first_coordinate))
    all_slips = np.asarray((radius == 0) & (a > 0))
    bad = np.asarray((radius > a) | (radius < 0) | ((radius > 0) & (radius < innermost)))
    detail = "must lie between the flat's radius, or 0, and the contact radius"
    if profile.slips_at_once:
        bad = bad | (radius > 0)
        detail = "a flat punch sticks wholly under any force below full slip: give the force"
    if bad.any():
        index = first_index(bad) if radius.ndim else ()
        raise InputError(("tangential", "stick_radius", *index), detail, bad)
    if profile.slips_at_once:
        shape = np.broadcast_shapes(radius.shape, a.shape)
        return contact.coordinate, np.ones(shape), all_slips, _NOTHING
    c = np.maximum(radius, innermost)
    edge = profile.coordinate_from_radius(c)
    if contact.control == "contact_radius":
        width = profile.coordinate_width(a, c, contact.coordinate, edge)
    else:
        # Of an edge that follows from a load the coordinate has the digits, not the radius.
        width = np.where(c < a, np.maximum(contact.coordinate - edge, 0.0), 0.0)
    return edge, width, all_slips, _NOTHING


_INVERSES: Final[Mapping[str, _Inverse]] = {
    "tangential_force": annulus.stick_from_force,
    "tangential_displacement": annulus.stick_from_depth,
}
_NOTHING: Final = np.asarray(0.0)
_NOWHERE: Final = np.zeros((), dtype=bool)
_BY_CONTROL: Final = {
    "tangential_force": _by_force,
    "tangential_displacement": _by_displacement,
    "stick_radius": _by_stick_radius,
}
