"""Stress tensor of a contact at any points of either body."""

from dataclasses import dataclass, replace
from math import inf
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.abel.displacement import Branch
from mdr_core.errors import InputError
from mdr_core.fields.contact import edges
from mdr_core.fields.radii import Edges, edge_error
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Hyperboloid, Paraboloid, Profile
from mdr_core.subsurface.moments import (
    Smooth,
    Span,
    edge_moments,
    rule_error,
    slope_moments,
)
from mdr_core.subsurface.tensor import StressTensor
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags
from mdr_core.validation import require_not_negative

# A point is moved off the surface by this part of its distance from the nearest edge or break, at
# such a radius by the second part of the contact radius: stresses have at worst a root there.
_SURFACE: Final = 1e-18
# Rounding error of a moment, of the largest stress, as measured with room for poles near the edge.
_ROUNDING: Final = 3e-13
# See _SURFACE.
_SURFACE_AT_EDGE: Final = 1e-34


def stress(
    contact: NormalContact | TangentialContact,
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
    contact : a normal contact, or one that is loaded tangentially as well, under any loads.
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
    found = on_rings(
        contact, Rings(r, depth.ravel(), cos, sin), poissons_ratio, body=body, rtol=rtol
    )
    return StressTensor(*(part.reshape((*part.shape[:-1], *across.shape)) for part in found))


@dataclass
class Rings:
    """Points in cylindrical coordinates: radii and depths of shape (m,), directions (..., m)."""

    r: Array
    z: Array
    cos: Array
    sin: Array

    def off_surface(self, profile: Profile, edges: list[float]) -> "Rings":
        """Return the points with depths > 0, in which the kernels are regular."""
        breaks = [float(np.asarray(b)) for b in profile.breaks]
        near = np.abs(self.r[:, None] - np.array([0.0, *edges, *breaks])).min(axis=1)
        least = np.maximum(_SURFACE * near, _SURFACE_AT_EDGE * edges[0])
        return replace(self, z=np.maximum(self.z, least))


def on_rings(
    contact: NormalContact | TangentialContact,
    place: Rings,
    poissons_ratio: float,
    *,
    body: int,
    rtol: float,
) -> StressTensor:
    """Return the stress tensor at points that share radii and depths, of shape loads + (..., m).

    The quadrature does not depend on the direction. Parameters: see `stress`.
    """
    if isinstance(contact, TangentialContact):
        normal, shape = contact.normal, contact.width.shape
        sheared = _sheared(contact, 1 if body == 2 else -1)
    else:
        normal, shape = contact, contact.coordinate.shape
        sheared = []
    profile = normal.profile
    modulus = np.broadcast_to(normal.e_star, shape).ravel() / np.pi
    pressed = _pressed(normal, shape)
    values = np.empty((6, len(pressed), *place.cos.shape))
    for i, whole in enumerate(pressed):
        part = sheared[i] if sheared else None
        stick = [] if part is None else [part.span.c]
        near = place.off_surface(profile, [whole.span.a, *stick])
        total = _normal(whole.moments(profile, near, rtol), near, poissons_ratio)
        if part is not None and part.scale:
            total += part.scale * _tangential(
                part.moments(profile, near, rtol), near, poissons_ratio
            )
        infinite = _infinite(profile, whole.span.a, place)
        total[:3, ..., infinite], total[3:, ..., infinite] = -inf, inf
        values[:, i] = modulus[i] * total
    return StressTensor(*values.reshape(6, *shape, *place.cos.shape))


def error_estimate(
    contact: NormalContact | TangentialContact,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    *,
    rtol: float = 1e-10,
) -> float:
    """Return a bound on the error of the stresses at points, relative to the largest of them [1].

    It contains the rule's error, rounding errors, and the error of a contact or stick radius that
    follows from a load, near which stresses change like a root. Parameters: see `stress`.
    """
    across, aside, depth = np.broadcast_arrays(x, y, z)
    r, z = np.hypot(across, aside).ravel(), np.ravel(depth)
    known, near = edges(contact), 0.0
    for i, at in enumerate(known.radius):
        edge = Edges(*(part[i : i + 1] for part in known))
        near = max(near, edge_error(edge, at + np.hypot(r - at, z), root=True))
    return rule_error(rtol) + _ROUNDING + 4 * contact.error_estimate + near


class _Part(NamedTuple):
    """A load of the foundation, in units of E*: `scale` times g' over a span."""

    scale: float
    span: Span
    step: float
    """Height of the step of g at a, under a flat punch, instead of the slope [length]."""

    def moments(self, profile: Profile, place: Rings, rtol: float) -> Array:
        """Return the moments of the load at points with depths > 0, shape (7, m)."""
        if self.step:
            return edge_moments(self.span.a, self.step, place.r, place.z)
        return slope_moments(_smooth(profile, rtol), self.span, place.r, place.z, rtol)


def _pressed(contact: NormalContact, shape: tuple[int, ...]) -> list[_Part]:
    """The normal load of each case."""
    profile = contact.profile
    a = np.broadcast_to(contact.contact_radius, shape).ravel().tolist()
    s = np.broadcast_to(contact.coordinate, shape).ravel().tolist()
    if profile.slips_at_once:
        return [
            _Part(1.0, Span(one, 0.0, one, None), depth) for one, depth in zip(a, s, strict=True)
        ]
    blunt = float(profile.contact_radius(np.asarray(profile.first_coordinate))) > 0
    return [
        _Part(1.0, Span(one, 0.0, one, root if blunt else None), 0.0)
        for one, root in zip(a, s, strict=True)
    ]


def _sheared(contact: TangentialContact, direction: int) -> list[_Part]:
    """The tangential load of each case, of scale 0 where there is none."""
    shape = contact.width.shape
    friction = contact.sign * contact.friction_coefficient * direction
    columns = [
        np.broadcast_to(part, shape).ravel().tolist()
        for part in (
            friction,
            contact.full_slip,
            contact.stick_radius,
            contact.slip_width,
            contact.width,
        )
    ]
    found = []
    for whole, scale, full, c, width, share in zip(
        _pressed(contact.normal, shape), *columns, strict=True
    ):
        span = whole.span if full else whole.span._replace(c=c, width=width)
        # Of a flat punch, which sticks wholly, the width is the part of its depth.
        step = whole.step if full else whole.step * share
        found.append(_Part(scale if share > 0 or full else 0.0, span, step))
    return found


def _smooth(profile: Profile, rtol: float) -> list[Smooth]:
    """The branches of g', with the distance over which each changes at its beginning."""
    panels = profile.panels(rtol)
    branches = profile.branches if panels is None else panels.branches
    return [Smooth(branch, _near(profile, branch)) for branch in branches]


def _near(profile: Profile, branch: Branch) -> float:
    if branch.base > 0:
        return min(branch.base, branch.behind)
    if branch.stop < inf or branch.pole < inf or isinstance(profile, Cone | Paraboloid):
        return inf
    return float(np.asarray(profile.scale)) if isinstance(profile, Hyperboloid) else 0.0


def _infinite(profile: Profile, a: float, place: Rings) -> Flags:
    """Points at which the pressure is infinite."""
    found = np.zeros(place.r.shape, dtype=bool)
    for b in profile.infinite_pressure_radii:
        found |= (place.r == b) & (place.z == 0) & bool(b <= a)
    return found


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
