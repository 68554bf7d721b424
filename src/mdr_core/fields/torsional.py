"""Shear stress of a twisted contact, over the radius."""

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.stress import stress_integral
from mdr_core.fields.normal import pressure
from mdr_core.fields.traction import by_load, fill
from mdr_core.torsion import TorsionalContact
from mdr_core.torsion.curve import VirginCurves
from mdr_core.typing import Array
from mdr_core.validation import require_type


def torsional_stress(contact: TorsionalContact, radius: ArrayLike) -> Array:
    """Return the circumferential shear stress tau(r) [pressure].

    It is mu p(r) in the slip annulus, and (2 mu E* r/pi^2) int_c^a (-dP/dx)/sqrt(x^2 - r^2) dx, the
    sum over the discs that turned, in the stick zone. It is positive in the direction of a positive
    torque, zero outside the contact, and infinite at the edge of a flat punch.

    Source: jaeger; notes, §16.

    Parameters
    ----------
    contact : twisted contact of one profile, under any number of loads.
    radius : radii [length], >= 0, shape (m,).

    Returns
    -------
    Array of shape (loads, m), or (m,) if the load is a single number.

    Raises
    ------
    InputError : a radius that is negative or not finite, or an array as a parameter of the profile.
    """
    require_type("contact", contact, TorsionalContact, "a contact from torsion.solve")
    normal, profile, shape = contact.normal, contact.normal.profile, contact.rotation.shape
    shear = contact.friction_coefficient * normal.e_star
    columns = normal.coordinate, normal.contact_radius, contact.stick_radius, contact.slip_width
    turned = 2 * np.pi * contact.shear_modulus / shear * np.abs(contact.rotation)
    edge, a, c, width, rotation = by_load(profile, shape, *columns, turned)

    def stuck(load: int, r: Array) -> Array:
        """Stress over mu E* in the stick zone [1]."""
        result, inside = np.zeros(r.shape), r < c[load]
        if inside.any():
            at, ends = r[inside], Annulus(*map(np.array, (a[load], width[load], c[load])))
            depth = max(1.0, np.log(a[load] / c[load]))
            curve = VirginCurves(profile, np.array(edge[load : load + 1]), depth)
            # The disc of the flat takes the first part of the rotation.
            step = min(rotation[load], float(curve.step[0]) * np.pi / 2)
            disc = step / np.sqrt((a[load] - at) * (a[load] + at))
            others = stress_integral(curve.branches, ends, at) if width[load] > 0 else 0.0
            result[inside] = 2 / np.pi**2 * at * (disc + others)
        return result

    friction, e_star, turned = (
        np.broadcast_to(each, shape)[..., None]
        for each in (contact.friction_coefficient, normal.e_star, contact.rotation)
    )
    slips = np.atleast_1d(radius) >= contact.stick_radius[..., None]
    part = np.where(slips, pressure(normal, radius), e_star * fill(shape, stuck, radius))
    whole = friction * part
    # Without a twist the stress is zero at the edge of a flat punch as well.
    return np.where(turned == 0, 0.0, np.copysign(whole, turned)) + 0.0
