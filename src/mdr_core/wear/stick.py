"""The stick zone that is left when all slip has worn off, for each pair of held quantities.

Whatever lies inside it never slips and keeps its first shape, so the zone's radius c and the step
d - g(c) at its edge describe the whole limit. Source: notes, §9.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core import annulus, tangential
from mdr_core.checks import first_index
from mdr_core.errors import InputError
from mdr_core.foundation import invert
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags, Parameter

# Places at which a zone that may not be the only one is looked for, and halvings about the best.
_LOOKS: Final = 65
_HALVINGS: Final = 40


@dataclass(frozen=True)
class LimitingStick:
    """The stick zone in the limit; all of one shape.

    Where everything slips c is zero, and the step is the depth itself.
    """

    coordinate: Array
    """c in the profile's contact coordinate."""
    radius: Array
    """c [length]."""
    step: Array
    """d - g(c) in the limit, with its digits [length]."""
    slip_width: Array
    """a - c before any wear: about how wide the worn rim becomes [length]."""
    lost: Flags
    """Where everything slips under a held depth: it wears until nothing touches."""
    endless: Flags
    """Where everything slips under a held force: it wears without end."""


def by_depth_and_displacement(sideways: TangentialContact, amplitude: Array) -> LimitingStick:
    """Both are held, so the last sticking spring stays the same: G* u = mu E* (d - g(c)).

    Source: mdr-5, Eq. (5.80).
    """
    depth = sideways.normal.indentation_depth
    step = np.where(sideways.full_slip, depth, amplitude / sideways.compliance)
    return _from(sideways, step, lost=sideways.full_slip)


def by_forces(sideways: TangentialContact, amplitude: Array) -> LimitingStick:
    """Both forces are held, so F_N(c) = F_N - F_x/mu stays, and the depth grows.

    In the limit the stick zone carries it all: F_x = 2 mu E* c (d - g(c)). Source: notes, §9.
    """
    return _from(
        sideways, _carried(sideways, amplitude, sideways.stick_radius), endless=sideways.full_slip
    )


def by_force_and_displacement(sideways: TangentialContact, amplitude: Array) -> LimitingStick:
    """F_N = F_N(c) + 2 E* c (d - g(c)) with the step that the displacement asks for.

    The book's limit, as if c had not moved: it moves outwards as the depth grows, over what was
    worn before. Source: mdr-5, Eq. (5.90), for any profile.
    """
    contact, profile = sideways.normal, sideways.normal.profile
    step = np.broadcast_to(amplitude / sideways.compliance, sideways.width.shape)
    endless = sideways.full_slip
    if profile.slips_at_once:
        return _from(sideways, step, endless=endless)
    top = np.broadcast_to(contact.coordinate, step.shape)
    target = np.where(endless | (sideways.width <= 0), 0.0, step)

    def held(width: Array) -> Array:
        """(F_N(a) - F_N(c))/(2 E* c)."""
        edge = top - width
        gained = annulus.force_step(profile, top, width, edge)
        return np.asarray(gained / (2 * profile.contact_radius(edge)))

    def log_slope(width: Array, value: Array) -> Array:
        edge = top - width
        c = profile.contact_radius(edge)
        rise = profile.depth_slope(edge) / value + profile.radius_slope(edge) / c
        return np.asarray(width * rise)

    # The first stick edge lies further in: there the annulus outside it bears load as well.
    widest = np.where(target > 0, sideways.width, 1.0)
    width = invert(
        held,
        log_slope,
        target,
        widest / 2,
        np.zeros_like(target),
        widest,
        f"{profile.kind}'s stick edge under a held force",
    )
    moved = np.where(endless, sideways.stick_coordinate, top - width)
    radius = np.where(width > 0, profile.contact_radius(moved), sideways.stick_radius)
    reach = profile.radius_width(top, width)
    return _from(sideways, step, endless=endless, moved=(moved, radius, reach))


def by_depth_and_force(sideways: TangentialContact, amplitude: Array) -> LimitingStick:
    """The depth and F_x are held: the largest c with 2 mu E* c (d - g(c)) = F_x.

    Wear at a held depth takes load off, so F_N(c) = F_N - F_x/mu falls: the stick zone shrinks,
    over what was never worn, until all that is left of the load is its own. Source: notes, §9.

    Raises
    ------
    InputError : a force that no such zone carries: the wear ends in full slip, without a limit.
    """
    contact, profile = sideways.normal, sideways.normal.profile
    share = _carried(sideways, amplitude, np.ones(()))
    share = np.broadcast_to(share, sideways.width.shape)
    if profile.slips_at_once:
        _refuse_overload(sideways, amplitude, sideways.full_slip, sideways.limiting_force)
        return _from(sideways, np.zeros_like(share))
    top = np.broadcast_to(contact.coordinate, share.shape)

    def carried(width: Array) -> Array:
        """c (d - g(c)), c at `width` below the first contact's edge."""
        edge = np.maximum(top - width, profile.first_coordinate)
        return np.asarray(
            profile.contact_radius(edge) * annulus.depth_step(profile, top, width, edge)
        )

    def slope(width: Array) -> Array:
        edge = np.maximum(top - width, profile.first_coordinate)
        step = annulus.depth_step(profile, top, width, edge)
        shrinks = profile.radius_slope(edge) * step
        return np.asarray(profile.contact_radius(edge) * profile.depth_slope(edge) - shrinks)

    reach = top - profile.first_coordinate
    target = np.where(reach > 0, share, 0.0)
    low, high, most = _first_crossing(carried, slope, reach, target)
    largest = 2 * sideways.friction_coefficient * contact.e_star * most
    _refuse_overload(sideways, amplitude, most < target, largest)
    width = invert(
        carried,
        lambda width, value: np.asarray(width * slope(width) / value),
        target,
        np.where(target > 0, (low + high) / 2, 1.0),
        low,
        np.where(target > 0, high, 2.0),
        f"{profile.kind}'s stick edge at a held depth",
    )
    edge = top - width
    radius = np.where(width > 0, profile.contact_radius(edge), contact.contact_radius)
    moved = edge, radius, profile.radius_width(top, width)
    return _from(sideways, _carried(sideways, amplitude, radius), moved=moved)


def _first_crossing(
    function: Callable[[Array], Array],
    slope: Callable[[Array], Array],
    reach: Array,
    target: Array,
) -> tuple[Array, Array, Array]:
    """The first stretch of [0, reach] at whose end the function has risen to the target.

    With the largest value seen: where that is below the target there is no such stretch. A
    profile with a kink lets the function rise, fall and rise again.
    """
    places = np.multiply.outer(np.linspace(0.0, 1.0, _LOOKS), reach)
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.array([function(place) for place in places])
        peak = np.argmax(values, axis=0)[None]
        left = np.take_along_axis(places, np.maximum(peak - 1, 0), axis=0)[0]
        right = np.take_along_axis(places, np.minimum(peak + 1, _LOOKS - 1), axis=0)[0]
        for _ in range(_HALVINGS):
            middle = (left + right) / 2
            rising = slope(middle) > 0
            left, right = np.where(rising, middle, left), np.where(rising, right, middle)
        at_peak = function(left)
    reached = values >= target
    found = reached.any(axis=0)
    index = np.argmax(reached, axis=0)[None]
    before = np.take_along_axis(places, np.maximum(index - 1, 0), axis=0)[0]
    at = np.take_along_axis(places, index, axis=0)[0]
    start = np.take_along_axis(places, np.maximum(peak - 1, 0), axis=0)[0]
    most = np.maximum(at_peak, values.max(axis=0))
    return np.where(found, before, start), np.where(found, at, left), most


def _refuse_overload(
    sideways: TangentialContact, force: Array, beyond: Flags, largest: Array
) -> None:
    if not np.any(beyond):
        return
    beyond, most = np.broadcast_arrays(beyond, largest)
    raise InputError(
        ("oscillation", "tangential_force", *(first_index(beyond) if force.ndim else ())),
        "wear at this depth takes off so much load that everything slips in the end: a stick zone "
        f"remains under amplitudes below {float(most[beyond][0]):.12g} only",
    )


# What is held and what oscillates, to the exact statement about it.
BY_CONTROL: Final = {
    ("indentation_depth", "tangential_displacement"): by_depth_and_displacement,
    ("indentation_depth", "tangential_force"): by_depth_and_force,
    ("normal_force", "tangential_force"): by_forces,
    ("normal_force", "tangential_displacement"): by_force_and_displacement,
}


def find(sideways: TangentialContact, name: str, size: Array) -> LimitingStick:
    """Return the stick zone in the limit, by what is held and what oscillates."""
    return BY_CONTROL[sideways.normal.control, name](sideways, size)


def first_slip(
    contact: NormalContact, g_star: Parameter, friction: Parameter, name: str, size: Array
) -> TangentialContact:
    """The contact before any wear, with the amplitude applied once."""
    try:
        return tangential.solve(contact, g_star, friction, **{name: size})
    except InputError as error:
        if error.path[0] != "tangential":
            raise
        raise InputError(("oscillation", *error.path[1:]), error.detail) from None


def _carried(sideways: TangentialContact, force: Array, radius: Array) -> Array:
    """F_x/(2 mu E* c), zero where there is neither."""
    resistance = 2 * sideways.friction_coefficient * sideways.normal.e_star * radius
    return np.where(resistance > 0, force / np.where(resistance > 0, resistance, 1.0), 0.0)


def _from(
    sideways: TangentialContact,
    step: Array,
    *,
    lost: Flags | None = None,
    endless: Flags | None = None,
    moved: tuple[Array, Array, Array] | None = None,
) -> LimitingStick:
    """With c where it was before any wear, or where it has moved to."""
    first = sideways.stick_coordinate, sideways.stick_radius, sideways.slip_width
    coordinate, radius, reach = first if moved is None else moved
    contact = sideways.normal
    # Without a load nothing wears, however far it slides.
    loaded = np.asarray(contact.coordinate > contact.profile.first_coordinate)
    # A flat punch sticks wholly or slides at once: nothing wears before it does.
    rests = (reach <= 0) | ~loaded
    nowhere = np.zeros((), dtype=bool)
    parts = (
        np.where(rests, contact.coordinate, coordinate),
        np.where(rests, contact.contact_radius, radius),
        np.where(rests, 0.0, step),
        np.where(rests, 0.0, reach),
        nowhere if lost is None else lost & loaded,
        nowhere if endless is None else endless & loaded,
    )
    return LimitingStick(*(np.broadcast_to(part, sideways.width.shape) for part in parts))
