"""Stress tensor of a contact at any points of either body."""

from math import inf
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields
from mdr_core.errors import InputError
from mdr_core.fields.radii import Edges, edge_error
from mdr_core.history import ContactState
from mdr_core.normal import NormalContact
from mdr_core.subsurface.foundation import (
    Contact,
    Foundation,
    foundations,
    normal_of,
    shape_of,
)
from mdr_core.subsurface.moments import moments, rule_error
from mdr_core.subsurface.tensor import StressTensor
from mdr_core.typing import Array
from mdr_core.validation import require_not_negative

# A point is moved off the surface by this part of its distance from the nearest edge or break, at
# such a radius by the second part of the contact radius: stresses have at worst a root there.
_SURFACE: Final = 1e-18
# See _SURFACE.
_SURFACE_AT_EDGE: Final = 1e-34
# Rounding error of a moment, of the largest stress, as measured with room for poles near the edge.
_ROUNDING: Final = 3e-13


def stress(
    contact: Contact,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    *,
    poissons_ratio: float,
    body: int = 1,
    rtol: float = 1e-10,
) -> StressTensor:
    """Return the stress tensor of one body at any points.

    The tangential force acts on body 1, the profile's, which passes it on: the shear stress on
    the surface of body 2 is that of `fields.shear_stress`, and on body 1 its opposite.

    Source: notes, §14.

    Parameters
    ----------
    contact : a normal contact, or one that is loaded tangentially as well, under any loads; or
        the state at the end of a load history.
    x, y : coordinates on the surface from the axis, x along the tangential force [length].
    z : depth in the body, >= 0 [length]. The three broadcast to the shape of the points.
    poissons_ratio : of this body, -1 to 1/2 [1].
    body : 1 for the body of the profile, 2 for the other.
    rtol : accuracy relative to the largest stress, 1e-13 to 1e-3.

    Returns
    -------
    Components of the shape of the loads and the points [pressure].

    Raises
    ------
    InputError : a coordinate that is not finite, or a negative depth.

    Examples
    --------
    On the axis of Hertz' contact sigma_zz = -p_0/(1 + z^2/a^2), Johnson's Eq. (3.45).

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> at = stress(contact, 0.0, 0.0, [0.0, 0.1], poissons_ratio=0.3)
    >>> [float(f"{one:.6g}") for one in at.zz / contact.maximum_pressure]
    [-1.0, -0.5]
    """
    where = [np.asarray(part, dtype=float) for part in (x, y, z)]
    for name, given in zip("xyz", where, strict=True):
        if not np.isfinite(given).all():
            raise InputError((name,), "must be finite")
    require_not_negative(("z",), where[2])
    across, aside, depth = np.broadcast_arrays(*where)
    r = np.hypot(across, aside).ravel()
    away = np.where(r > 0, r, 1.0)
    cos, sin = np.where(r > 0, across.ravel() / away, 1.0), aside.ravel() / away
    rings = Rings(r, depth.ravel(), cos, sin)
    nearest = float(np.hypot(r, rings.z).min(initial=np.inf))
    under = foundations(contact, rtol, nearest)
    found = np.stack([on_rings(one, rings, poissons_ratio, body) for one in under], axis=1)
    origin = (r == 0) & (rings.z == 0)
    if origin.any():
        found[..., origin] = _at_origin(contact, poissons_ratio, body)[..., None]
    return StressTensor(*found.reshape(6, *shape_of(contact), *across.shape))


def _at_origin(contact: Contact, nu: float, body: int) -> Array:
    """Stresses at the origin by the tractions there, which powers next to a cone approach slowly.

    The in-plane stresses are (1 + 2 nu)/2 times -p: V_r/r and Om_r/r are halves of V_rr and Om_rr.
    """
    pressed, shape = normal_of(contact), shape_of(contact)
    pressure = np.broadcast_to(fields.pressure(pressed, [0.0])[..., 0], shape).ravel()
    found = np.zeros((6, pressure.size))
    found[:3] = -np.outer([(1 + 2 * nu) / 2, (1 + 2 * nu) / 2, 1.0], pressure)
    if not isinstance(contact, NormalContact):
        shear = np.ravel(fields.shear_stress(contact, [0.0])[..., 0])
        found[4] = shear if body == 1 else -shear
    found[3:, np.isinf(pressure)] = inf
    return found


class Rings(NamedTuple):
    """Points in cylindrical coordinates: radii and depths of shape (m,), directions (..., m)."""

    r: Array
    z: Array
    cos: Array
    sin: Array


def on_rings(under: Foundation, rings: Rings, nu: float, body: int) -> StressTensor:
    """Return the stress tensor at points that share radii and depths, of shape (..., m).

    The quadrature does not depend on the direction.

    Parameters
    ----------
    under : the loads of the foundation.
    rings : points.
    nu : Poisson's ratio of this body [1].
    body : 1 for the body of the profile, 2 for the other.
    """
    r, breaks = rings.r, [float(np.asarray(b)) for b in under.profile.breaks]
    near = np.abs(r[:, None] - np.array([0.0, *under.edges, *breaks])).min(axis=1)
    least = np.maximum(_SURFACE * near, _SURFACE_AT_EDGE * under.edges[-1])
    # In points with depths > 0 the kernels are regular.
    inner = rings._replace(z=np.maximum(rings.z, least))
    total = np.zeros((6, *rings.cos.shape))
    if under.pressed is not None:
        pressed = moments(under.pressed, r, inner.z, under.rtol)
        total += _normal(pressed, inner, nu)
        shear = np.zeros_like(pressed)
        for slope, block in under.sheared:
            of_block = block is under.pressed
            shear += slope * (pressed if of_block else moments(block, r, inner.z, under.rtol))
        if under.sheared:
            total += (1 if body == 2 else -1) * _tangential(shear, inner, nu)
    for b in under.profile.infinite_pressure_radii:
        infinite = (r == b) & (rings.z == 0) & bool(b <= under.edges[-1])
        total[:3, ..., infinite], total[3:, ..., infinite] = -inf, inf
    return StressTensor(*(under.modulus * total))


def error_estimate(
    contact: Contact, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, rtol: float = 1e-10
) -> float:
    """Return a bound on the error of the stresses at points, relative to the largest of them [1].

    It contains the rule's error, rounding errors, and the error of a contact radius or slip front
    that follows from a load, near which stresses change like a root. That of a load history itself
    is left out. Parameters: see `stress`.
    """
    across, aside, depth = np.broadcast_arrays(x, y, z)
    r, z = np.hypot(across, aside).ravel(), np.ravel(depth)
    known, near = fields.edges(contact), 0.0
    for i, at in enumerate(known.radius):
        edge = Edges(*(part[i : i + 1] for part in known))
        near = max(near, edge_error(edge, at + np.hypot(r - at, z), root=True))
    own = 0.0 if isinstance(contact, ContactState) else 4 * contact.error_estimate
    return rule_error(rtol) + _ROUNDING + own + near


def _normal(moments: Array, place: Rings, nu: float) -> Array:
    """Stresses of a normal load over its scale E*/pi, in the order of `StressTensor`."""
    r, z, k, m = place.r, place.z, place.cos, place.sin
    v_z, zz, mixed, rz, om, _, _ = moments
    zz, mixed, rz = z * zz, z * mixed, z * r * rz
    radial = v_z - zz + mixed - (1 - 2 * nu) * om
    hoop = 2 * nu * v_z - mixed + (1 - 2 * nu) * om
    return _stacked(
        [
            k * k * radial + m * m * hoop,
            m * m * radial + k * k * hoop,
            v_z + zz,
            k * m * (radial - hoop),
            k * rz,
            m * rz,
        ]
    )


def _stacked(components: list[Array]) -> Array:
    return np.stack(np.broadcast_arrays(*components))


def _tangential(moments: Array, place: Rings, nu: float) -> Array:
    """Stresses of a load along x over its scale, with the third derivatives of Om and F1."""
    r, z, k, m = place.r, place.z, place.cos, place.sin
    v_z, zz, mixed, rz, _, second, third = moments
    v_r, zz, rz = r * mixed, z * zz, z * r * rz
    mixed = z * mixed
    f_ring, om_ring = -r * second / 2, z * r * third
    f_rrr, om_rrr = -v_r - f_ring, rz - om_ring

    def third_derivatives(rrr: Array, ring: Array) -> tuple[Array, Array, Array]:
        """XXX, XYY and XXY of a potential from its rrr and (Phi_r/r)_r."""
        return (
            k * (k * k * rrr + 3 * m * m * ring),
            k * (m * m * rrr + (k * k - 2 * m * m) * ring),
            m * (k * k * rrr + (m * m - 2 * k * k) * ring),
        )

    f_xxx, f_xyy, f_xxy = third_derivatives(f_rrr, f_ring)
    om_xxx, om_xyy, om_xxy = third_derivatives(om_rrr, om_ring)
    return _stacked(
        [
            (2 + 2 * nu) * k * v_r + 2 * nu * f_xxx - om_xxx,
            2 * nu * k * v_r + 2 * nu * f_xyy - om_xyy,
            k * rz,
            m * v_r + 2 * nu * f_xxy - om_xxy,
            v_z - k * k * (zz - mixed) - m * m * mixed,
            -k * m * (zz - 2 * mixed),
        ]
    )
