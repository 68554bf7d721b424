"""Stick zone in the limiting state of wear, for each pair of constant quantities.

The surface inside it never slips and keeps its profile, so that the stick radius c and the step
d - g(c) at the stick edge describe the whole limiting state. Source: notes, §9.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Final

import numpy as np

from mdr_core import equivalent_1d
from mdr_core.doubles import ROUNDING
from mdr_core.elementwise import broadcast, full, where
from mdr_core.inversion import invert
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags

# Points of the search for the largest of several possible stick zones, and its rounds, in each of
# which the interval becomes 16 times narrower: a largest value is exact to 1e-16.
_POINTS, _ROUNDS = 33, 7


@dataclass(frozen=True)
class LimitingStick:
    """Stick zone in the limit; all arrays of one shape.

    In full slip c is zero, and the step is the depth, which is infinite under a constant force.
    """

    coordinate: Array
    """c in the profile's contact coordinate."""
    radius: Array
    """c [length]."""
    step: Array
    """d - g(c) in the limit [length], free of cancellation."""
    slip_width: Array
    """Width of the slip annulus before wear, or outside c [length]; zero without slip."""
    separated: Flags
    """Full slip at a constant depth: the contact wears until nothing touches."""
    unbounded: Flags
    """Full slip under a constant normal force: wear is unbounded."""
    width_error: Array
    """Relative error of the slip width by that of the stick radius, where that has moved [1]."""
    error: Array
    """Error of c [length]."""


def by_depth_and_displacement(contact: TangentialContact, amplitude: Array) -> LimitingStick:
    """Return the stick zone before wear: G* u = mu E* (d - g(c)) holds at all times.

    Source: mdr-5, Eq. (5.80).
    """
    step = amplitude / contact.displacement_ratio
    return _from(contact, step, separated=contact.full_slip)


def by_forces(contact: TangentialContact, amplitude: Array) -> LimitingStick:
    """Return the stick zone before wear: F_N(c) = F_N - F_x/mu is constant, and the depth grows.

    In the limit the stick zone carries the force: F_x = 2 mu E* c (d - g(c)). Source: notes, §9.
    """
    step = _step_of_force(contact, amplitude, contact.stick_radius)
    return _from(contact, step, unbounded=contact.full_slip)


def by_force_and_displacement(contact: TangentialContact, amplitude: Array) -> LimitingStick:
    """Return the stick zone with F_N = F_N(c) + 2 E* c (d - g(c)), d - g(c) = G* u/(mu E*).

    The book's limit neglects that the stick edge moves outwards, over worn material, as the depth
    grows. Source: mdr-5, Eq. (5.90), for any profile.
    """
    normal, profile = contact.normal, contact.normal.profile
    step = broadcast(amplitude / contact.displacement_ratio, contact.width.shape)
    unbounded = contact.full_slip
    if profile.is_flat_punch:
        return _from(contact, step, unbounded=unbounded)
    top = broadcast(normal.coordinate, step.shape)
    target = where(unbounded | (contact.width <= 0), 0.0, step)

    def step_by_force(width: Array) -> tuple[Array, Array]:
        """Return (F_N(a) - F_N(c))/(2 E* c), and its logarithmic slope."""
        edge = top - width
        c = profile.contact_radius(edge)
        value = equivalent_1d.force_step(profile, top, width, edge) / (2 * c)
        return value, width * (profile.depth_slope(edge) / value + 1 / c)

    # The stick edge before wear lies further in: there the annulus outside carries load as well.
    widest = where(target > 0, contact.width, 1.0)
    width = invert(step_by_force, target, widest / 2, full(0.0, target), widest)
    moved = width, full(ROUNDING, width)
    return _from(contact, step, unbounded=unbounded, moved=moved)


def by_depth_and_force(contact: TangentialContact, amplitude: Array) -> LimitingStick:
    """Return the stick zone of the largest c with 2 mu E* c (d - g(c)) = F_x.

    Wear at a constant depth reduces F_N, and with it F_N(c) = F_N - F_x/mu: the stick zone shrinks,
    over unworn material, until it carries the whole remaining load. Source: notes, §9.

    No stick zone carries a larger force than the largest 2 mu E* c (d - g(c)): then wear ends in
    full slip.
    """
    normal, profile = contact.normal, contact.normal.profile
    target = _step_of_force(contact, amplitude, np.ones(()))
    target = broadcast(target, contact.width.shape)
    if profile.is_flat_punch:
        return _from(contact, full(0.0, target), separated=contact.full_slip)
    top = broadcast(normal.coordinate, target.shape)

    def carried(width: Array) -> tuple[Array, Array]:
        """Return c (d - g(c)), and its logarithmic slope, `width` below the contact's edge."""
        edge = np.maximum(top - width, 0.0)
        c, step = profile.contact_radius(edge), equivalent_1d.depth_step(profile, top, width, edge)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = c * profile.depth_slope(edge) - step
            return c * step, width * slope / (c * step)

    low, high = _first_crossing(lambda width: carried(width)[0], top, target)
    separated = ~(carried(high)[0] >= target) | contact.full_slip
    target = where(separated, 0.0, target)
    width = invert(
        carried,
        target,
        where(target > 0, (low + high) / 2, 1.0),
        low,
        where(target > 0, high, 2.0),
    )
    step = _step_of_force(contact, amplitude, profile.contact_radius(top - width))
    slope = np.abs(carried(width)[1])
    # Next to the largest force the error is of second order.
    error = ROUNDING / (where(slope > 0, slope, 0.0) + np.sqrt(ROUNDING))
    return _from(contact, step, separated=separated, moved=(width, error))


def _first_crossing(
    function: Callable[[Array], Array], widest: Array, target: Array
) -> tuple[Array, Array]:
    """Return the ends of the first interval of [0, widest] in which a function reaches a target.

    If the function does not, they enclose its largest value. For a profile with a slope
    discontinuity the function can rise, fall and rise again.
    """
    low, high = np.zeros_like(widest), widest
    for _ in range(_ROUNDS):
        places = low + np.multiply.outer(np.linspace(0.0, 1.0, _POINTS), high - low)
        values = np.array([function(place) for place in places])
        reached = values >= target
        first = np.where(reached.any(axis=0), reached.argmax(axis=0), values.argmax(axis=0))[None]
        # A crossing lies before the first place that reaches the target, a peak on either side.
        low = np.take_along_axis(places, np.maximum(first - 1, 0), axis=0)[0]
        beyond = np.where(reached.any(axis=0), first, np.minimum(first + 1, _POINTS - 1))
        high = np.take_along_axis(places, beyond, axis=0)[0]
    return low, high


# By the constant load and the amplitude.
_BY_CONTROL: Final = {
    ("indentation_depth", "tangential_displacement"): by_depth_and_displacement,
    ("indentation_depth", "tangential_force"): by_depth_and_force,
    ("normal_force", "tangential_force"): by_forces,
    ("normal_force", "tangential_displacement"): by_force_and_displacement,
}


def find(contact: TangentialContact, amplitude: Array) -> LimitingStick:
    """Return the stick zone in the limit; the amplitude is the contact's tangential load."""
    return _BY_CONTROL[contact.normal.control, contact.control](contact, amplitude)


def _step_of_force(contact: TangentialContact, force: Array, radius: Array) -> Array:
    """Return the step F_x/(2 mu E* c) at a stick radius c, zero for c = 0 [length]."""
    resistance = 2 * contact.friction_coefficient * contact.normal.e_star * radius
    return where(resistance > 0, force / where(resistance > 0, resistance, 1.0), 0.0)


def _from(
    contact: TangentialContact,
    step: Array,
    *,
    separated: Flags | bool = False,
    unbounded: Flags | bool = False,
    moved: tuple[Array, Array] | None = None,
) -> LimitingStick:
    """Return the stick zone before wear, or after it has moved.

    `moved` is the new slip width in the contact coordinate, and its relative error.
    """
    normal, slides = contact.normal, separated | unbounded
    if moved is None:
        coordinate, radius = contact.stick_coordinate, contact.stick_radius
        slip_width = contact.slip_width
        # The coordinate resolves the distance from a flat.
        flat = where(contact.full_slip, 0.0, normal.profile.first_radius)
        width_error, error = full(0.0, slip_width), contact.stick_error - ROUNDING * flat
    else:
        slip_width, width_error = moved
        coordinate = normal.coordinate - slip_width
        radius = normal.profile.contact_radius(coordinate)
        beyond = normal.contact_radius - normal.profile.first_radius
        width = where(slides, normal.contact_radius, slip_width)
        error = normal.edge_errors * beyond + width_error * width
    # Without a normal load nothing wears, and a flat punch either sticks or is in full slip.
    loaded = normal.coordinate > 0
    rests = ~loaded | ((slip_width <= 0) & ~slides)
    depth = where(unbounded, inf, normal.indentation_depth)
    cases = (
        (normal.coordinate, 0.0, coordinate),
        (normal.contact_radius, 0.0, radius),
        (0.0, depth, step),
        (0.0, normal.contact_radius, slip_width),
    )
    parts = [where(rests, still, where(slides, lost, found)) for still, lost, found in cases]
    parts += [separated & loaded, unbounded & loaded, where(rests, 0.0, width_error), error]
    return LimitingStick(*(broadcast(part, contact.width.shape) for part in parts))
