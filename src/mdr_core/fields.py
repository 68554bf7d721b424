"""Fields over the radius."""

from math import inf
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.checks import largest
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.typing import Array

# Radii handled at once: bounds the memory, whatever their number.
_BLOCK: Final = 131_072


def pressure(contact: NormalContact, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return p(r) = (E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx [pressure], [load][radius].

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
    r = np.ascontiguousarray(np.atleast_1d(np.asarray(radius, dtype=float)))
    edges = np.atleast_1d(contact.contact_radius)
    coordinates = np.atleast_1d(contact.coordinate)
    # Where the radius is what was given, a - r is exact.
    exact = edges if contact.control == "contact_radius" else [None] * edges.size
    shape = contact.contact_radius.shape + r.shape
    if edges.size == 1 and r.size <= _BLOCK:
        row = _row(contact, r, _checked_largest(r, 0), edges[0], coordinates[0], exact[0], rtol)
        return row.reshape(shape)
    out = np.empty((edges.size, r.size))
    for start in range(0, r.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        block = r[part]
        highest = _checked_largest(block, start)
        for row, a, s, edge in zip(out, edges, coordinates, exact, strict=True):
            row[part] = _row(contact, block, highest, a, s, edge, rtol)
    return out.reshape(shape)


def _row(
    contact: NormalContact,
    r: Array,
    highest: float,
    a: float,
    coordinate: float,
    exact: float | None,
    rtol: float,
) -> Array:
    """The pressure of one load at some radii."""
    kernel, modulus = contact.profile.pressure_kernel, float(contact.e_star)
    at, edge = np.array([coordinate]), None if exact is None else np.array([exact])
    if highest < a:
        return kernel(at, r, rtol, edge=edge, modulus=modulus)
    row = np.zeros(r.shape)
    inside = r < a
    if inside.any():
        row[inside] = kernel(at, r[inside], rtol, edge=edge, modulus=modulus)
    return row


def _checked_largest(block: Array, start: int) -> float:
    """Largest radius of the block, all of them checked."""
    highest = largest(block)
    if not highest < inf:
        bad = ~((block >= 0) & (block < inf))
        if not bad.any():
            # Only a negative zero, which counts as zero.
            return float(block.max())
        raise InputError(
            ("radius", start + int(np.flatnonzero(bad)[0])), "must be finite and not negative"
        )
    return highest
