"""Fields over the radius: stresses, slip, displacement, and what the foundation carries.

Every function answers [load][radius], or [radius] where all loads were single numbers. Only what
is called is computed.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.fields.rows import (
    Row,
    fill,
    foundation_row,
    grid_through,
    kernel,
    slip_kernel,
)
from mdr_core.normal import Load, NormalContact
from mdr_core.tangential import Slip, TangentialContact
from mdr_core.typing import Array

_FAR: Final = 1e8


def pressure(contact: NormalContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return p(r) = (E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx [pressure].

    Positive in compression, zero outside the contact, infinite only where the model says so.

    Source: mdr-5, Eqs. (5.68), (5.79).

    Parameters
    ----------
    contact : the normal contact of one profile and one material, under any number of loads.
    radius : the radii [length], >= 0, shape (m,).
    rtol : relative accuracy asked for, 1e-13 to 1e-3.

    Returns
    -------
    Array of shape (loads, m), or (m,) where the load was a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite.

    Examples
    --------
    The peak of Eq. (5.38) is 2 E* a/(pi R).

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> [float(f"{p:.6g}") for p in pressure(contact, [0.0, 0.06, 0.2])]
    [0.095493, 0.0763944, 0.0]
    """

    def row(load: Load) -> Row:
        return lambda r, highest: kernel(load, r, highest, None, load.e_star, rtol)

    return fill(contact.contact_radius.shape, [row(load) for load in contact.loads], radius)


def shear_stress(contact: TangentialContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return tau(r) = (mu E*/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx [pressure].

    Positive along a positive tangential force, zero outside the contact. It is the integral
    over the slip annulus, not a difference of pressures: it keeps its digits as c -> a.

    Source: mdr-5, Eqs. (5.18), (5.38), (5.53), (5.70). Parameters, returns and errors as of
    `pressure`.
    """

    def row(slip: Slip) -> Row:
        load, modulus = slip.normal, slip.sign * slip.friction * slip.normal.e_star
        if slip.width == 0 and not slip.full:
            return lambda r, _highest: np.zeros(r.shape)
        slip_annulus = None if slip.full else (slip.width, slip.c)
        return lambda r, highest: kernel(load, r, highest, slip_annulus, modulus, rtol)

    return fill(contact.width.shape, [row(slip) for slip in contact.slips], radius)


def slip(contact: TangentialContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the slip s(r) = u_x(r) - delta_x of the surface in the contact [length].

    s = -mu (E*/G*) (2/pi) int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx for c < r <= a, zero in the
    stick zone and outside the contact: a slipping point lags behind, so the slip is negative
    for a positive displacement. Beyond full slip the whole contact lags by the excess.

    Source: mdr-5, Eqs. (5.39)-(5.45). Parameters, returns and errors as of `pressure`.
    """

    def row(part: Slip) -> Row:
        scale = part.sign * part.compliance
        profile, c, a = part.normal.profile, (0.0 if part.full else part.c), part.normal.a

        def values(r: Array, _highest: float) -> Array:
            result = np.zeros(r.shape)
            inside = (r > c) & (r <= a)
            result[inside] = -scale * slip_kernel(profile, c, r[inside], rtol)
            if part.excess:
                result[r <= a] -= part.sign * part.excess
            return result

        return values

    return fill(contact.width.shape, [row(part) for part in contact.slips], radius)


def normal_displacement(contact: NormalContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the normal displacement of the surface, positive into the body [length].

    d - f(r) in the contact, (2/pi) int_0^a (d - g(x))/sqrt(r^2 - x^2) dx outside it.

    Source: mdr-5, Eq. (5.75). Parameters, returns and errors as of `pressure`.
    """
    depths = np.atleast_1d(contact.indentation_depth)

    def row(load: Load, depth: float) -> Row:
        def values(r: Array, _highest: float) -> Array:
            inside = r <= load.a
            result = np.empty(r.shape)
            result[inside] = depth - load.profile.f(r[inside])
            far = r > _FAR * load.a
            outer = ~(inside | far)
            if outer.any():
                edge = np.full(int(outer.sum()), load.a)
                at = load.coordinate
                result[outer] = load.profile.outer_displacement(edge, r[outer], rtol, at)
            if far.any():
                # The contact is a point to them: the next term is (a/r)^2, below rounding.
                force = load.profile.reduced_force(np.asarray(load.coordinate))
                result[far] = force / (np.pi * r[far])
            return result

        return values

    rows = [row(load, float(d)) for load, d in zip(contact.loads, depths, strict=True)]
    return fill(contact.contact_radius.shape, rows, radius)


def foundation_load(contact: NormalContact, radius: ArrayLike) -> Array:
    """Return q(x) = E* (d - g(x)) of the one-dimensional foundation [force/length].

    Zero outside the contact. Source: mdr-5, Eqs. (5.8), (5.23). Parameters, returns and errors
    as of `pressure`.
    """
    rows = [foundation_row(load) for load in contact.loads]
    return fill(contact.contact_radius.shape, rows, radius)


def foundation_shear(contact: TangentialContact, radius: ArrayLike) -> Array:
    """Return q_x(x) of the foundation [force/length].

    G* u_x for |x| <= c, mu q(x) for c < |x| <= a, 0 outside. Source: mdr-5, Eq. (5.23).
    Parameters, returns and errors as of `pressure`.
    """

    def row(part: Slip, displacement: float) -> Row:
        load = foundation_row(part.normal)

        def values(r: Array, highest: float) -> Array:
            sliding = part.sign * part.friction * load(r, highest)
            sticks = (r <= part.c) & (not part.full)
            return np.where(sticks, part.g_star * displacement, sliding)

        return values

    shape = contact.width.shape
    moved = np.broadcast_to(contact.tangential_displacement, shape).ravel().tolist()
    rows = [row(part, u_x) for part, u_x in zip(contact.slips, moved, strict=True)]
    return fill(shape, rows, radius)


def grid(contact: NormalContact | TangentialContact, points: int) -> Array:
    """Return radii from 0 to half as far again as the largest contact [length], shape (points,).

    They crowd towards every radius where a field is singular: the axis, the breaks, and every
    load's stick radius and contact radius, all of which are among them.

    Raises
    ------
    InputError : fewer points than there are such radii.
    """
    normal = contact.normal if isinstance(contact, TangentialContact) else contact
    special = [np.ravel(normal.contact_radius)]
    if isinstance(contact, TangentialContact):
        special.append(np.ravel(contact.stick_radius))
    return grid_through(normal.profile, special, float(np.max(normal.contact_radius)), points)
