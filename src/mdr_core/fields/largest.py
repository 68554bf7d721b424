"""The largest pressure and the largest shear stress of a contact, one number for each load."""

from collections.abc import Callable
from math import inf
from typing import Final

import numpy as np
from scipy.optimize import minimize_scalar

from mdr_core.fields import contact as fields
from mdr_core.fields.rows import graded
from mdr_core.normal import NormalContact
from mdr_core.profiles import Paraboloid, Profile
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array

# Radii between which a peak is looked for, besides those at which the profile or the slip changes.
_LOOKS: Final = 64
# Every peak that comes so near to the largest is followed to its top.
_RIVAL: Final = 0.9
# Around a top the field is flat: so close to it, relative to the radius, all its digits are there.
_CLOSE: Final = 1e-9


def largest_pressure(contact: NormalContact, *, rtol: float = 1e-10) -> Array:
    """Return the largest p(r) of each load [pressure].

    Infinite where a tip, a kink or an edge makes it so. A paraboloid has it on its axis,
    p_0 = 2 E* a/(pi R), mdr-5, Eq. (5.38); elsewhere it is looked for, from radii that crowd at the
    breaks and the edge.

    Parameters
    ----------
    contact : of one profile, best under one load; of paraboloids any sweep.
    rtol : relative accuracy of the pressure, 1e-13 to 1e-3.
    """
    profile = contact.profile
    if isinstance(profile, Paraboloid):
        peak = 2 * contact.e_star * contact.contact_radius / (np.pi * profile.radius)
        return np.asarray(peak)
    singular = [np.asarray(b) for b in profile.infinite_pressure_radii]

    def one(index: int, a: float) -> float:
        if any(b <= a for b in singular):
            return inf

        def field(r: Array) -> Array:
            return np.asarray(fields.pressure(contact, r, rtol=rtol).reshape(-1, r.size)[index])

        return _largest(field, _stops(profile, a, ()))

    return _over_loads(_touching(contact), one)


def largest_shear_stress(contact: TangentialContact, *, rtol: float = 1e-10) -> Array:
    """Return the largest |tau(r)| of each load [pressure].

    Infinite where the slip annulus, its ends included, holds a tip, a kink or an edge of infinite
    pressure, and under the edge of a flat punch. A paraboloid has it at the stick edge,
    mu (2 E*/(pi R)) sqrt(a^2 - c^2), mdr-5, Eq. (5.38). Parameters as of `largest_pressure`.
    """
    normal = contact.normal
    profile = normal.profile
    shape = contact.width.shape
    a = np.broadcast_to(_touching(normal), shape)
    c = np.broadcast_to(contact.stick_radius, shape)
    if isinstance(profile, Paraboloid):
        leg = np.sqrt(contact.slip_width * (a + c))
        scale = 2 * contact.friction_coefficient * normal.e_star / (np.pi * profile.radius)
        return np.asarray(scale * leg)
    singular = [np.asarray(b) for b in profile.infinite_pressure_radii]
    force = np.ravel(np.broadcast_to(contact.tangential_force, shape))

    def one(index: int, edge: float) -> float:
        inner = float(np.ravel(c)[index])
        if force[index] == 0:
            return 0.0
        if any(inner <= b <= edge for b in singular):
            return inf

        def field(r: Array) -> Array:
            found = fields.shear_stress(contact, r, rtol=rtol).reshape(-1, r.size)[index]
            return np.asarray(np.abs(found))

        return _largest(field, _stops(profile, edge, (inner,)))

    return _over_loads(a, one)


def _touching(contact: NormalContact) -> Array:
    """The contact radius [length]; zero without a load, under a flat punch as well."""
    return np.where(contact.normal_force > 0, contact.contact_radius, 0.0)


def _over_loads(a: Array, one: Callable[[int, float], float]) -> Array:
    """One number for each load; nothing where nothing touches."""
    found = [one(i, float(edge)) if edge > 0 else 0.0 for i, edge in enumerate(np.ravel(a))]
    return np.reshape(np.array(found), a.shape)


def _stops(profile: Profile, a: float, inner: tuple[float, ...]) -> Array:
    """Radii up to the edge at which a peak may be sharp, ascending."""
    special = [0.0, a, *inner, *map(float, profile.breaks)]
    special += profile.contact_radius(profile.coordinate_breaks).tolist()
    return np.unique([r for r in special if r <= a])


def _largest(field: Callable[[Array], Array], stops: Array) -> float:
    """The largest value between the first stop and the last."""
    radii = graded(stops, _LOOKS + 4 * stops.size)
    values = field(radii)
    best = float(values.max())
    inside = np.arange(1, radii.size - 1)
    tops = (values[inside] >= values[inside - 1]) & (values[inside] >= values[inside + 1])
    for i in inside[tops & (values[inside] >= _RIVAL * best)]:
        ends = float(radii[i - 1]), float(radii[i + 1])
        found = minimize_scalar(
            lambda r: -float(field(np.array([r]))[0]),
            bounds=ends,
            method="bounded",
            options={"xatol": _CLOSE * ends[1]},
        )
        best = max(best, -float(found.fun))
    return best
