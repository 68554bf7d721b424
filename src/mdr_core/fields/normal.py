"""Pressure, displacement and foundation load of a normal contact, over the radius.

Every function returns an array of shape (loads, radii), or (radii,) if the load is a single number.
"""

from collections.abc import Callable
from math import inf, prod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import equivalent_1d
from mdr_core.abel.annulus import Annulus, whole
from mdr_core.adhesion import AdhesiveContact
from mdr_core.elementwise import every, number
from mdr_core.layer import LayerContact
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Indices
from mdr_core.validation import (
    checked_radii,
    require_single_profile,
    require_type,
)

Contact = NormalContact | TangentialContact
"""A contact with or without tangential load, which does not affect the normal fields."""
# Values of a field under the load of this index, at some radii.
Field = Callable[[int, Array], Array]


def pressure(contact: Contact, radius: ArrayLike) -> Array:
    """Return p(r) = (E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx [pressure].

    Positive in compression, zero outside the contact, infinite at sharp tips, slope
    discontinuities and the edge of a flat punch. Adhesion subtracts
    E* Delta_l/(pi sqrt(a^2 - r^2)), which is infinite at the edge.

    Source: mdr-5, Eqs. (5.68), (5.79).

    Parameters
    ----------
    contact : contact of one profile, with or without friction, under any number of loads.
    radius : radii [length], >= 0, shape (m,). The pressure has a root at the contact radius: its
        relative error grows without bound within a few units in the last place of it.

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the
        profile.

    Examples
    --------
    The peak of Eq. (5.38) is 2 E* a/(pi R).

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> [float(f"{p:.6g}") for p in pressure(contact, [0.0, 0.06, 0.2])]
    [0.095493, 0.0763944, 0.0]
    """
    if isinstance(contact, AdhesiveContact):
        return contact.superposed(lambda part: pressure(part, radius))
    if isinstance(contact, LayerContact):
        beyond = _beyond_half_space(contact, contact.correction, radius)
        return pressure(contact.half_space, radius) + beyond
    contact = _pressed(contact)
    shape = contact.contact_radius.shape
    a, coordinate = by_load(contact.profile, shape, contact.contact_radius, contact.coordinate)

    def values(load: int, r: Array) -> Array:
        edge = number(a[load]) if contact.control == "contact_radius" else None
        annulus = whole(number(coordinate[load]), edge)
        return contact.e_star * stress(contact.profile, annulus, a[load], r)

    return fill(shape, values, radius)


def normal_displacement(contact: Contact, radius: ArrayLike) -> Array:
    """Return the normal displacement of the surface, positive into the body [length].

    d - f(r) in the contact, (2/pi) int_0^a (d - g(x))/sqrt(r^2 - x^2) dx outside it.

    Source: mdr-5, Eq. (5.75).

    Parameters
    ----------
    contact : contact of one profile, with or without friction, under any number of loads.
    radius : radii [length], >= 0, shape (m,).

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the
        profile.
    """
    if isinstance(contact, AdhesiveContact):
        return contact.superposed(lambda part: normal_displacement(part, radius))
    layer = contact if isinstance(contact, LayerContact) else None
    contact = layer or _pressed(contact)
    profile, shape = contact.profile, contact.contact_radius.shape
    columns = contact.contact_radius, contact.coordinate, contact.indentation_depth
    a, coordinate, depth = by_load(profile, shape, *columns)

    def values(load: int, r: Array) -> Array:
        inside = r <= a[load]
        result = np.empty(r.shape)
        result[inside] = depth[load] - profile.f(r[inside])
        if not inside.all():
            outer = r[~inside]
            edge = np.full(outer.shape, a[load])
            result[~inside] = profile.outer_displacement(edge, outer, coordinate[load])
            if layer:
                result[~inside] = layer.displacement(load, outer, result[~inside])
        return result

    return fill(shape, values, radius)


def foundation_load(contact: Contact, radius: ArrayLike) -> Array:
    """Return q(x) = E* (d - g(x)) of the one-dimensional foundation [force/length].

    Zero outside the contact. Source: mdr-5, Eqs. (5.8), (5.23).

    Parameters
    ----------
    contact : contact of one profile, with or without friction, under any number of loads.
    radius : radii [length], >= 0, shape (m,).

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the profile.
    """
    if isinstance(contact, AdhesiveContact):
        return contact.superposed(lambda part: foundation_load(part, radius))
    if isinstance(contact, LayerContact):
        beyond = _beyond_half_space(contact, contact.load_correction, radius)
        return foundation_load(contact.half_space, radius) + beyond
    contact = _pressed(contact)
    shape = contact.contact_radius.shape
    a, coordinate = by_load(contact.profile, shape, contact.contact_radius, contact.coordinate)

    def values(load: int, r: Array) -> Array:
        return contact.e_star * _depth_left(contact.profile, a[load], coordinate[load], r)

    return fill(shape, values, radius)


def _beyond_half_space(
    contact: LayerContact, correction: Callable[[Indices, Array], Array], radius: ArrayLike
) -> Array:
    """Return a correction of the layer over E* as a field, zero outside the contact."""

    def values(load: int, r: Array) -> Array:
        inside = r <= np.ravel(contact.contact_radius)[load]
        added = correction(np.full(r.size, load), np.where(inside, r, 0.0))
        return np.where(inside, contact.e_star * added, 0.0)

    return fill(contact.contact_radius.shape, values, radius)


def _pressed(contact: Contact) -> NormalContact:
    """Return the normal contact; raise InputError if there is none."""
    needed = "a contact from normal.solve or tangential.solve"
    require_type("contact", contact, (NormalContact, TangentialContact), needed)
    return contact.normal


def fill(shape: tuple[int, ...], field: Field, radius: ArrayLike) -> Array:
    """Return the field of every load at all radii; `field` returns the field of one load.

    Raises InputError if there is no radius, or one that is negative or not finite.
    """
    r = checked_radii(radius)
    return np.array([field(load, r) for load in range(prod(shape))]).reshape(shape + r.shape)


def stress(profile: Profile, annulus: Annulus, a: float, r: Array) -> Array:
    """Return (1/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx at all radii, zero outside [1].

    Parameters
    ----------
    profile : one profile.
    annulus : annulus from c to a in the contact coordinate.
    a : contact radius [length].
    r : radii [length], shape (m,).
    """
    inside = r < a
    if every(inside):
        # Most radii of a query are inside the contact, and selecting them takes as long as a closed
        # form.
        return profile.pressure_kernel(annulus, r)
    result = np.zeros(r.shape)
    if inside.any():
        result[inside] = profile.pressure_kernel(annulus, r[inside])
    if profile.is_flat_punch and annulus.outer > 0:
        # The stress is infinite at the edge of a flat punch.
        result[r == a] = inf
    return result


def by_load(profile: Profile, shape: tuple[int, ...], *columns: Any) -> list[list[float]]:
    """Return the values of each column under every load.

    Raises InputError if a parameter of the profile is an array.
    """
    require_single_profile(profile.swept)
    return [np.broadcast_to(column, shape).ravel().tolist() for column in columns]


def _depth_left(profile: Profile, a: float, coordinate: float, r: Array) -> Array:
    """d - g(r), as the step from r to a, which is free of cancellation near the edge [length]."""
    result = np.zeros(r.shape)
    inside = r < a
    if profile.is_flat_punch:
        result[r <= a] = coordinate
    elif inside.any():
        least = float(profile.first_radius)
        x, top = np.maximum(r[inside], least), np.array([coordinate])
        at = profile.coordinate_from_radius(x)
        result[inside] = equivalent_1d.depth_step(profile, top, a - x, at)
    return result
