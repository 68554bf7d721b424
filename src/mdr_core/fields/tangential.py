"""Tangential fields of a contact or at the end of a load history: sums over annuli."""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.doubles import ADJACENT
from mdr_core.fields.traction import Traction, over_loads
from mdr_core.history import ContactState
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import require_type


def shear_stress(contact: TangentialContact | ContactState, radius: ArrayLike) -> Array:
    """Return tau(r) = (mu E*/pi) sum k_i int g'(x)/sqrt(x^2 - r^2) dx [pressure].

    The i-th integral goes over [max(r, x_i-1), x_i] between neighbouring slip fronts; under a
    monotonic load the only one goes from c to a. The stress is positive in the direction of a
    positive tangential force, and zero outside the contact. The sum is free of cancellation, unlike
    a difference of pressures.

    Source: mdr-5, Eqs. (5.18), (5.34), (5.38), (5.53), (5.70); notes, §10.

    Parameters
    ----------
    contact : tangential contact under any number of loads, or end of a load history.
    radius : radii [length], >= 0, shape (m,).

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the
        profile.

    Examples
    --------
    After a full cycle only the last load step is in the slip memory: Eq. (5.54), on a cone.

    >>> from mdr_core.history import solve
    >>> from mdr_core.profiles import Cone
    >>> history = solve(Cone(0.2), 1.0, 1.0, 0.5, indentation_depth=np.pi / 10,
    ...                 tangential_displacement=[0.0, 0.05, -0.05, 0.05])
    >>> c = 1 - 0.05 / (0.5 * np.pi / 10)
    >>> bool(abs(shear_stress(history.state, [0.0])[0] / (0.05 * np.log(1 / c)) - 1) < 1e-13)
    True
    """
    _require_shear(contact)
    return over_loads(contact, lambda load, r: load.modulus * load.stress(r), radius)


def slip(contact: TangentialContact | ContactState, radius: ArrayLike) -> Array:
    """Return the slip s(r) = u(r) - u_x of the surface in the contact [length].

    u(r) is the displacement of the surface, u_x the displacement of the body.

    s = -mu (E*/G*) sum (k_i - k_i-1) S(x_i-1; r), S the slip kernel; zero in the stick zone and
    outside the contact, negative for a positive displacement. In full slip the displacement
    beyond full slip is subtracted throughout the contact. Where the bodies came into contact under
    a tangential displacement, part of it is not slip but the initial mismatch.

    Source: mdr-5, Eqs. (5.39)-(5.45); notes, §10.

    Parameters
    ----------
    contact : tangential contact under any number of loads, or end of a load history.
    radius : radii [length], >= 0, shape (m,).

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the
        profile.
    """

    def values(load: Traction, r: Array) -> Array:
        result = np.zeros(r.shape)
        # A radius that differs from the contact radius by rounding alone belongs to the contact.
        inside = r <= load.radius[-1] * (1 + ADJACENT)
        # S(0; r) and S(b; r) are equal: g is zero on a flat.
        fronts = [0.0, *load.radius[1:].tolist()]
        slopes = pairwise([0.0, *load.slope.tolist(), 0.0])
        for front, (below, above) in zip(fronts, slopes, strict=True):
            slips = inside & (r > front)
            if below != above and slips.any():
                at = r[slips]
                kernel = load.profile.slip_integral(np.full(at.shape, front), at)
                result[slips] -= (above - below) * kernel
        result *= load.ratio
        result[inside] -= load.excess
        return result

    _require_shear(contact)
    return over_loads(contact, values, radius)


def foundation_shear(contact: TangentialContact | ContactState, radius: ArrayLike) -> Array:
    """Return q_x(x) of the foundation [force/length].

    It is linear in g(x) between the slip fronts. Under a monotonic load it is G* u_x in the stick
    zone and mu q(x) outside.

    Source: mdr-5, Eq. (5.23); notes, §10.

    Parameters
    ----------
    contact : tangential contact under any number of loads, or end of a load history.
    radius : radii [length], >= 0, shape (m,).

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the profile.
    """
    _require_shear(contact)
    return over_loads(contact, lambda load, r: load.modulus * load.foundation(r), radius)


def _require_shear(contact: TangentialContact | ContactState) -> None:
    """Raise InputError unless a contact has a tangential load."""
    needed = "a contact from tangential.solve, or the state of a load history"
    require_type("contact", contact, (TangentialContact, ContactState), needed)
