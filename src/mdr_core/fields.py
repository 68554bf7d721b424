"""Fields over the radius."""

from math import inf
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.checks import extremes
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.typing import Array

# Radii handled at once: the temporaries stay in cache, and below the size from which the
# allocator fetches fresh pages for each.
_BLOCK: Final = 8_192


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
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    edges = np.atleast_1d(contact.contact_radius)
    coordinates = np.atleast_1d(contact.coordinate)
    exact = contact.control == "contact_radius"
    out = np.empty((edges.size, r.size))
    for start in range(0, r.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        block = r[part]
        highest = _checked_maximum(block, start)
        for row, a, s in zip(out, edges[:, None], coordinates[:, None], strict=True):
            edge = a if exact else None
            target = row[part]
            if highest < a[0]:
                kernel = contact.profile.pressure_kernel(s, block, rtol, edge=edge)
                np.multiply(kernel, contact.e_star, out=target)
                continue
            inside = block < a
            target[:] = 0.0
            if inside.any():
                kernel = contact.profile.pressure_kernel(s, block[inside], rtol, edge=edge)
                target[inside] = kernel * contact.e_star
    return out.reshape(contact.contact_radius.shape + r.shape)


def _checked_maximum(block: Array, start: int) -> float:
    """Largest radius of the block, all of them checked."""
    lowest, highest = extremes(block)
    if not (lowest >= 0 and highest < inf):
        bad = np.flatnonzero(~((block >= 0) & (block < inf)))
        raise InputError(("radius", start + int(bad[0])), "must be finite and not negative")
    return highest
