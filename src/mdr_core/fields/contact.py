"""Stresses, slip, displacement and foundation loads of a contact, over the radius.

Every function returns an array of shape (loads, radii), or (radii,) if the load is a single number.
"""

from collections.abc import Callable
from math import inf, prod
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import equivalent_1d
from mdr_core.abel import Annulus, InnerEnd
from mdr_core.elementwise import broadcast
from mdr_core.errors import InputError
from mdr_core.fields.radii import EDGE_ROUNDING, Edges, grid_through
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import require_not_negative

# Values of a field under the load of this index, at some radii.
Field = Callable[[int, Array], Array]

# Radii evaluated at once, which bounds the memory.
_BLOCK: Final = 131_072


def pressure(contact: NormalContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return p(r) = (E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx [pressure].

    Positive in compression, zero outside the contact, infinite at sharp tips, slope
    discontinuities and the edge of a flat punch.

    Source: mdr-5, Eqs. (5.68), (5.79).

    Parameters
    ----------
    contact : normal contact of one profile, under any number of loads.
    radius : radii [length], >= 0, shape (m,). Within a few units in the last place of the contact
        radius the pressure has a root, and no accuracy relative to itself.
    rtol : relative accuracy, 1e-13 to 1e-3.

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

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
    shape = contact.contact_radius.shape
    a, coordinate = _by_load(shape, contact.contact_radius, contact.coordinate)

    def values(load: int, r: Array) -> Array:
        annulus = _annulus(contact, a[load], coordinate[load], None)
        return contact.e_star * stress(contact.profile, annulus, a[load], r, rtol)

    return fill(shape, values, radius)


def shear_stress(contact: TangentialContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return tau(r) = (mu E*/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx [pressure].

    Positive in the direction of a positive tangential force, zero outside the contact. It is an
    integral over the slip annulus, not a difference of pressures, and free of cancellation.

    Source: mdr-5, Eqs. (5.18), (5.38), (5.53), (5.70). Parameters, returns and errors as of
    `pressure`.
    """
    normal, shape = contact.normal, contact.width.shape
    profile = normal.profile
    # The kernel of a flat punch, which has no slip annulus, reads the depth from the width.
    annuli = contact.width * normal.coordinate if profile.has_no_partial_slip else contact.width
    modulus = contact.sign * contact.friction_coefficient * normal.e_star
    a, coordinate, scale, width, c, slides = _by_load(
        shape,
        normal.contact_radius,
        normal.coordinate,
        modulus,
        annuli,
        contact.stick_radius,
        contact.full_slip,
    )

    def values(load: int, r: Array) -> Array:
        if width[load] == 0 and not slides[load]:
            return np.zeros_like(r)
        inner = None if slides[load] else (width[load], c[load])
        annulus = _annulus(normal, a[load], coordinate[load], inner)
        return scale[load] * stress(profile, annulus, a[load], r, rtol)

    return fill(shape, values, radius)


def slip(contact: TangentialContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the slip s(r) = u_x(r) - delta_x of the surface in the contact [length].

    s = -mu (E*/G*) (2/pi) int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx for c < r <= a, zero in the
    stick zone and outside the contact. Slip is negative for a positive displacement. In full slip
    the displacement beyond full slip is subtracted throughout the contact.

    Source: mdr-5, Eqs. (5.39)-(5.45). Parameters, returns and errors as of `pressure`.
    """
    normal, shape = contact.normal, contact.width.shape
    scales = contact.sign * contact.displacement_ratio, contact.sign * contact.excess
    a, c, scale, excess = _by_load(shape, normal.contact_radius, contact.stick_radius, *scales)

    def values(load: int, r: Array) -> Array:
        result = np.zeros(r.shape)
        slips = (r > c[load]) & (r <= a[load])
        result[slips] = -scale[load] * slip_kernel(normal.profile, c[load], r[slips], rtol)
        if excess[load]:
            result[r <= a[load]] -= excess[load]
        return result

    return fill(shape, values, radius)


def normal_displacement(contact: NormalContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the normal displacement of the surface, positive into the body [length].

    d - f(r) in the contact, (2/pi) int_0^a (d - g(x))/sqrt(r^2 - x^2) dx outside it.

    Source: mdr-5, Eq. (5.75). Parameters, returns and errors as of `pressure`.
    """
    profile, shape = contact.profile, contact.contact_radius.shape
    columns = contact.contact_radius, contact.coordinate, contact.indentation_depth
    a, coordinate, depth = _by_load(shape, *columns)

    def values(load: int, r: Array) -> Array:
        inside = r <= a[load]
        result = np.empty(r.shape)
        result[inside] = depth[load] - profile.f(r[inside])
        if not inside.all():
            outer = r[~inside]
            edge = np.full(outer.shape, a[load])
            result[~inside] = profile.outer_displacement(edge, outer, rtol, coordinate[load])
        return result

    return fill(shape, values, radius)


def foundation_load(contact: NormalContact, radius: ArrayLike) -> Array:
    """Return q(x) = E* (d - g(x)) of the one-dimensional foundation [force/length].

    Zero outside the contact. Source: mdr-5, Eqs. (5.8), (5.23). Parameters, returns and errors
    as of `pressure`.
    """
    shape = contact.contact_radius.shape
    a, coordinate = _by_load(shape, contact.contact_radius, contact.coordinate)

    def values(load: int, r: Array) -> Array:
        return contact.e_star * _depth_left(contact.profile, a[load], coordinate[load], r)

    return fill(shape, values, radius)


def foundation_shear(contact: TangentialContact, radius: ArrayLike) -> Array:
    """Return q_x(x) of the foundation [force/length].

    G* u_x for |x| <= c, mu q(x) for c < |x| <= a, 0 outside. Source: mdr-5, Eq. (5.23).
    Parameters, returns and errors as of `pressure`.
    """
    normal, shape = contact.normal, contact.width.shape
    modulus = contact.sign * contact.friction_coefficient * normal.e_star
    sticking = contact.g_star * contact.tangential_displacement
    # In full slip there is no stick zone.
    stick_radius = np.where(contact.full_slip, -1.0, contact.stick_radius)
    edges = normal.contact_radius, normal.coordinate, stick_radius
    a, coordinate, c, scale, held = _by_load(shape, *edges, modulus, sticking)

    def values(load: int, r: Array) -> Array:
        slipping = scale[load] * _depth_left(normal.profile, a[load], coordinate[load], r)
        return np.where(r <= c[load], held[load], slipping)

    return fill(shape, values, radius)


def grid(contact: NormalContact | TangentialContact, points: int) -> Array:
    """Return radii from 0 to 1.5 times the largest contact radius [length], shape (points,).

    They cluster at the axis, the breaks, and the stick radius and contact radius of every load.
    Prescribed edges are radii of the grid; of edges that follow from a load the grid takes a radius
    just inside, where their rounding error is insignificant.

    Raises
    ------
    InputError : fewer points than such radii.
    """
    profile = (contact.normal if isinstance(contact, TangentialContact) else contact).profile
    return grid_through(profile, edges(contact), points)


def edges(contact: NormalContact | TangentialContact) -> Edges:
    """Return the contact and stick radii of all loads, with their rounding errors."""
    normal = contact.normal if isinstance(contact, TangentialContact) else contact
    profile, a = normal.profile, normal.contact_radius
    # The coordinate resolves the distance from a flat.
    beyond = a - profile.contact_radius(np.asarray(profile.first_coordinate))
    exact = normal.control == "contact_radius" or profile.has_no_partial_slip
    error, scale = beyond * (0.0 if exact else EDGE_ROUNDING), beyond / profile.steepness
    if not isinstance(contact, TangentialContact):
        return Edges(*map(np.ravel, (a, error, scale)))
    exact = contact.control == "stick_radius" or profile.has_no_partial_slip
    c, scale = contact.stick_radius, np.minimum(scale, contact.slip_width)
    # Near full slip the condition number of c amplifies the rounding error of the load.
    condition = 1 + contact.load_rounding / normal.error_estimates
    error_c = c * (0.0 if exact else EDGE_ROUNDING * condition)
    parts = (a, c), (error, error_c), (scale, scale)
    columns = [[np.ravel(broadcast(part, c.shape)) for part in pair] for pair in parts]
    return Edges(*map(np.concatenate, columns))


def fill(shape: tuple[int, ...], field: Field, radius: ArrayLike) -> Array:
    """Return the field of every load at all radii.

    Parameters
    ----------
    shape : shape of the loads.
    field : values under one load.
    radius : radii [length], >= 0, shape (m,).

    Raises
    ------
    InputError : no radius, or one that is negative or not finite.
    """
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    if r.size == 0:
        raise InputError(("radius",), "at least one radius is needed")
    require_not_negative(("radius",), r)
    out = np.empty((prod(shape), r.size))
    for start in range(0, r.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        for load, row in enumerate(out):
            row[part] = field(load, r[part])
    return out.reshape(shape + r.shape)


def stress(profile: Profile, annulus: Annulus, a: float, r: Array, rtol: float) -> Array:
    """Return (1/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx at all radii, zero outside [1].

    Parameters
    ----------
    profile : one profile.
    annulus : its ends c and a in the contact coordinate.
    a : contact radius [length].
    r : radii [length], shape (m,).
    rtol : relative accuracy.
    """
    result, inside = np.zeros(r.shape), r < a
    if inside.any():
        result[inside] = profile.pressure_kernel(annulus, r[inside], rtol)
    if profile.has_no_partial_slip and annulus.outer[0] > 0:
        # The stress at the edge of a flat punch.
        result[r == a] = inf
    return result


def slip_kernel(profile: Profile, c: float, r: Array, rtol: float) -> Array:
    """Return S(c; r) of one stick radius [length], zero under a flat punch.

    Parameters
    ----------
    profile : one profile.
    c : stick radius [length].
    r : radii r >= c [length], shape (m,).
    rtol : relative accuracy.
    """
    if profile.has_no_partial_slip:
        return np.zeros(r.shape)
    return profile.slip_kernel(np.full(r.shape, c), r, rtol)


def _by_load(shape: tuple[int, ...], *columns: Any) -> list[list[float]]:
    """Values of each column under every load."""
    return [np.ravel(broadcast(column, shape)).tolist() for column in columns]


def _annulus(
    contact: NormalContact, a: float, coordinate: float, inner: tuple[float, float] | None
) -> Annulus:
    """Annulus of one load; `inner` is the width in the contact coordinate, and c."""
    end = None if inner is None else InnerEnd(*(np.array([part]) for part in inner))
    exact = contact.control == "contact_radius"
    return Annulus(np.array([coordinate]), end, np.array([a]) if exact else None)


def _depth_left(profile: Profile, a: float, coordinate: float, r: Array) -> Array:
    """d - g(r) as the step from r to a, free of cancellation near the edge [length]."""
    result = np.zeros(r.shape)
    inside = r < a
    if profile.has_no_partial_slip:
        result[r <= a] = coordinate
    elif inside.any():
        least = float(profile.contact_radius(np.asarray(profile.first_coordinate)))
        x, edge, top = np.maximum(r[inside], least), np.array([a]), np.array([coordinate])
        at = profile.coordinate_from_radius(x)
        width = profile.coordinate_width(edge, x, top, at)
        result[inside] = equivalent_1d.depth_step(profile, top, width, at)
    return result
