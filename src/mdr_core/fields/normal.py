"""Pressure, displacement and foundation load of a normal contact, over the radius.

Every function returns an array of shape (loads, radii), or (radii,) if the load is a single number.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.adhesion import AdhesiveContact
from mdr_core.fields.traction import Traction, by_load, fill, over_loads
from mdr_core.layer import LayerContact
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Indices
from mdr_core.validation import require_type

Contact = NormalContact | TangentialContact
"""A contact with or without tangential load, which does not affect the normal fields."""


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
    return _load_field(contact, Traction.stress, LayerContact.correction, radius)


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
    return _load_field(contact, Traction.foundation, LayerContact.load_correction, radius)


def _load_field(
    contact: Contact,
    of_traction: Callable[[Traction, Array], Array],
    of_layer: Callable[[LayerContact, Indices, Array], Array],
    radius: ArrayLike,
) -> Array:
    """Return the pressure or the foundation load of a contact over the radius.

    `of_traction` is the field over E* of a half-space, and `of_layer` the part that a layer adds to
    it within the contact, under the loads of given indices.
    """
    if isinstance(contact, AdhesiveContact):
        return contact.superposed(lambda part: _load_field(part, of_traction, of_layer, radius))
    layer = contact if isinstance(contact, LayerContact) else None
    pressed = layer.half_space if layer else _pressed(contact)
    found = over_loads(pressed, lambda load, r: load.modulus * of_traction(load, r), radius)
    if not layer:
        return found

    def added(load: int, r: Array) -> Array:
        inside = r <= np.ravel(layer.contact_radius)[load]
        part = of_layer(layer, np.full(r.size, load), np.where(inside, r, 0.0))
        return np.where(inside, layer.e_star * part, 0.0)

    return found + fill(layer.contact_radius.shape, added, radius)


def _pressed(contact: Contact) -> NormalContact:
    """Return the normal contact; raise InputError if there is none."""
    needed = "a contact from normal.solve or tangential.solve"
    require_type("contact", contact, (NormalContact, TangentialContact), needed)
    return contact.normal
