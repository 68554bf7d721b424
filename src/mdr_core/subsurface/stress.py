"""Stress tensor of a contact at any points of either body. Source: notes, §12."""

from math import inf, sqrt
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields
from mdr_core.adhesion import AdhesiveContact
from mdr_core.doubles import EPS
from mdr_core.fields.radii import Edges, error_near
from mdr_core.history import ContactState
from mdr_core.subsurface.foundation import Contact, Foundation, foundations
from mdr_core.typing import Array, Numbers
from mdr_core.validation import (
    as_numbers,
    require_finite,
    require_not_negative,
    require_poissons_ratio,
)

MOMENT_ERROR: Final = 3e-13
"""Error of a moment, of the largest stress, as measured with room for poles near the edge."""

# Radii and depths [length], shape (m,), and directions e^(i phi), shape (..., m).
Rings: TypeAlias = tuple[Array, Array, Numbers]


class StressTensor(NamedTuple):
    """Stresses [pressure], tension positive, x along the tangential force, z into the body.

    Each has the shape of the points, or of loads and points. Where the pressure is infinite, the
    normal stresses are -inf and the shear stresses inf, whatever their signs.
    """

    xx: Array
    yy: Array
    zz: Array
    xy: Array
    xz: Array
    yz: Array

    @property
    def mean_stress(self) -> Array:
        """A third of the trace [pressure]."""
        return np.asarray((self.xx + self.yy + self.zz) / 3)

    @property
    def von_mises(self) -> Array:
        """Von Mises' equivalent stress [pressure]; infinite where the stress is."""
        xx, yy, zz, xy, xz, yz = np.where(np.isinf(self), 0.0, self)
        normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
        values = np.sqrt(normal / 2 + 3 * (xy**2 + xz**2 + yz**2))
        return np.where(np.isinf(self.zz), inf, values)

    @property
    def principal(self) -> Array:
        """Principal stresses, ascending in a last axis of length 3 [pressure]."""
        xx, yy, zz, xy, xz, yz = np.where(np.isinf(self), 0.0, self)
        rows = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        values = np.linalg.eigvalsh(np.moveaxis(rows, (0, 1), (-2, -1)))
        return np.where(np.isinf(self.zz)[..., None], -inf, values)

    @property
    def maximum_shear(self) -> Array:
        """Largest shear stress, half the difference of the extreme principal ones [pressure]."""
        low, _, high = np.moveaxis(self.principal, -1, 0)
        span = np.subtract(high, low, out=np.full_like(low, inf), where=np.isfinite(low))
        return np.asarray(span / 2)


def stress(
    contact: Contact,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    *,
    poissons_ratio: float,
    body: int = 1,
) -> StressTensor:
    """Return the stress tensor of one body at points, of the shape of loads and points [pressure].

    The tangential force acts on body 1, the profile's, which passes it on: the traction on body 2
    is tau of `fields.shear_stress`, on body 1 its opposite. As z points into the body, sigma_xz on
    the surface is the opposite of the traction: -tau in body 2, tau in body 1. Source: notes, §12.

    Parameters
    ----------
    contact : normal, tangential or adhesive contact under any loads, or state at the end of a
        history.
    x, y : coordinates on the surface from the axis, x along the tangential force [length].
    z : depth in the body, >= 0 [length]. The three broadcast to the shape of the points.
    poissons_ratio : of this body, -1 to 1/2 [1].
    body : 1 for the body of the profile, 2 for the other.

    Raises
    ------
    InputError : a coordinate that is not finite, a negative depth, a body other than 1 or 2, or a
        Poisson's ratio out of range.

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
    if isinstance(contact, AdhesiveContact):

        def tensor(part: Contact) -> Array:
            found = stress(part, x, y, z, poissons_ratio=poissons_ratio, body=body)
            return np.stack(found, axis=-1)

        return StressTensor(*np.moveaxis(contact.superposed(tensor), -1, 0))
    where = [as_numbers((name,), part) for name, part in zip("xyz", (x, y, z), strict=True)]
    for name, given in zip("xyz", where, strict=True):
        require_finite((name,), given)
    require_not_negative(("z",), where[2])
    require_poissons_ratio(("poissons_ratio",), poissons_ratio)
    across, aside, depth = np.broadcast_arrays(*where)
    r = np.hypot(across, aside)
    e = np.where(r > 0, across + 1j * aside, 1.0) / np.where(r > 0, r, 1.0)
    under, shape = foundations(contact, body)
    place = r.ravel(), depth.ravel(), e.ravel()
    found = np.stack([on_rings(each, place, poissons_ratio) for each in under], axis=1)
    return StressTensor(*found.reshape(6, *shape, *depth.shape))


def on_rings(under: Foundation, place: Rings, nu: float) -> StressTensor:
    """Return the stress tensor under a load, of the shape of the directions [pressure]."""
    load, (r, z, e) = under.load, place
    if not under.loaded:
        return StressTensor(*np.zeros((6, *e.shape)))
    edges = np.array([0.0, *load.radius, *map(float, load.profile.breaks)])[:, None]
    near = np.maximum(np.abs(edges - r), np.spacing(edges)).min(axis=0)
    center = (z == 0) & (r == 0)
    # On the surface the kernels are singular.
    depth = np.maximum(z, EPS * np.where(center, load.radius[-1], near))
    moments = under.moments(r, depth)
    infinite = (z == 0) & np.isin(r, under.infinite_radii)
    origin = center & ~infinite
    if origin.any() and not load.profile.is_flat_punch:
        # Powers next to a cone approach the tractions there slowly. Om_r/r is a half of V_z.
        whole = load._replace(slope=np.ones_like(load.slope))
        p, tau = (each.stress(np.zeros(1)) for each in (whole, load))
        moments[:, origin], moments[0, origin] = 0.0, -np.pi * (p + 1j * under.friction * tau)
        moments[4, origin] = moments[0, origin] / 2
    found = load.e_star / np.pi * of_moments(moments, (r, depth, e), nu)
    found[:3, ..., infinite], found[3:, ..., infinite] = -inf, inf
    return StressTensor(*found)


def of_moments(moments: Numbers, place: Rings, nu: float) -> Array:
    """Return the stresses over E*/pi of moments (7, m), as in `StressTensor`; shape (6, ..., m)."""
    r, z, e = place
    v_z, zz, mixed, rz, om, _, _ = moments.real
    zz, mixed, rz = z * zz, z * mixed, z * r * rz
    second = (1 - 2 * nu) * (v_z - 2 * om) + 2 * mixed - zz
    shear, t_zz, t_mixed, t_rz, _, ring, z_ring = moments.imag
    t_zz, t_r, t_rz = z * t_zz, r * t_mixed, z * r * t_rz
    first = (2 - nu) * t_r - t_rz / 2
    third = nu * (2 * r * ring - t_r) + r * (2 * z * z_ring) - t_rz / 2
    total = (1 + 2 * nu) * v_z - zz + ((2 + 2 * nu) * t_r - t_rz) * e.real
    # sigma_xx - sigma_yy + 2i tau_xy and tau_xz + i tau_yz have few harmonics of the direction.
    difference = e * (first + e * (second + e * third))
    along = shear - t_zz / 2 + e * (rz + e * (z * t_mixed - t_zz / 2))
    vertical = v_z + zz + t_rz * e.real
    xx, yy = (total + difference.real) / 2, (total - difference.real) / 2
    return np.array([xx, yy, vertical, difference.imag / 2, along.real, along.imag])


def error_estimate(contact: Contact, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> float:
    """Return a bound on the error of the stresses at points, relative to the largest of them [1].

    It contains rounding errors, and the error of a contact radius or slip front that follows from
    a load, near which stresses change like a root. The error of a load history is left out.

    Parameters
    ----------
    contact, x, y, z : see `stress`.
    """
    r, z = map(np.ravel, np.broadcast_arrays(np.hypot(x, y), z))
    known, near = fields.edges(contact), 0.0
    for i, at in enumerate(known.radius):
        edge = Edges(*(part[i : i + 1] for part in known))
        far = np.hypot(r - at, z)
        # The stress of a moved front falls from 1/sqrt(c D) to c/D^2, of which a tangential force
        # has 2(1 + nu) in sigma_xx. Next to it sigma_xx has twice the root of the traction.
        far *= np.maximum(far / (2 * at or inf), 1.0) ** 3
        near = max(near, sqrt(2) * error_near(edge, at - far, root=True))
    own = 0.0 if isinstance(contact, ContactState) else 4 * fields.own_error(contact)
    return MOMENT_ERROR + own + near
