"""Traction of a contact as annuli under one load, and evaluation of fields for many loads.

Between two neighbouring slip fronts dq_x/dq = mu k, k the slope of the anchors: 0 where the springs
stick under a monotonic load, 1 where they slip. A stress is therefore a sum of kernels, each over
the annulus between two fronts. The pressure is the stress of one annulus with k = mu = 1.
"""

from collections.abc import Callable
from math import inf, prod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import equivalent_1d
from mdr_core.abel.annulus import Annulus
from mdr_core.elementwise import every
from mdr_core.history import ContactState
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import checked_radii, require_single_profile

Loaded = NormalContact | TangentialContact | ContactState


class Traction(NamedTuple):
    """Annuli of a contact under one load, from the axis, each with one slope of the anchors."""

    profile: Profile
    e_star: float
    modulus: float
    """mu E* [pressure]."""
    ratio: float
    """mu E*/G* [1]."""
    coordinate: Array
    """Contact coordinates of the ends of the annuli, shape (n + 1,)."""
    radius: Array
    """Radii of the ends of the annuli [length], shape (n + 1,)."""
    width: Array
    """Widths in the contact coordinate, shape (n,). The coordinate of a flat punch is its depth,
    and all its springs carry the load of a depth `width`."""
    slope: Array
    """Slope k of the anchors in each annulus [1], shape (n,)."""
    above: Array
    """q_x/(mu E*) at the outer end of each annulus [length], shape (n,)."""
    exact: bool = False
    """True if the contact radius is prescribed."""
    excess: float = 0.0
    """Displacement beyond full slip [length]."""

    def stress(self, r: Array) -> Array:
        """Return sum k_i/pi int g'(x)/sqrt(x^2 - r^2) dx at radii (m,), zero outside [1].

        The i-th integral goes over the part of the i-th annulus beyond r.
        """
        result = np.zeros(r.shape)
        for i in self.slope.nonzero()[0].tolist():
            a = self.radius[i + 1]
            ends = self.coordinate[i + 1], self.width[i], self.radius[i], a if self.exact else None
            annulus, inside = Annulus(*ends, self.coordinate[i]), r < a
            if inside.any():
                # Selecting radii takes as long as a closed form, and most are inside the contact.
                chosen = slice(None) if every(inside) else inside
                result[chosen] += self.slope[i] * self.profile.pressure_kernel(annulus, r[chosen])
            if self.profile.is_flat_punch:
                # The stress is infinite at the edge of a flat punch.
                result[r == a] = self.slope[i] * inf
        return result

    def foundation(self, r: Array) -> Array:
        """Return sum k_i int g'(x) dx, each integral as in `stress`, zero outside [length].

        In each annulus it is the value at the outer end and the step from there, which is free of
        cancellation.
        """
        result, profile = np.zeros(r.shape), self.profile
        if profile.is_flat_punch:
            result[r <= self.radius[-1]] = self.slope @ self.width
            return result
        # The springs of a flat carry the load of its edge.
        inside = r < self.radius[-1]
        x = np.maximum(r[inside], self.radius[0])
        # At the onset of the load the contact radius is the radius of the flat.
        i = np.minimum(np.searchsorted(self.radius, x, side="right"), self.slope.size) - 1
        result[inside] = self.above[i]
        inside[inside] = slips = self.slope[i] != 0
        x, i = x[slips], i[slips]
        at = np.maximum(profile.coordinate_from_radius(x), self.coordinate[i])
        top = np.maximum(self.coordinate[i + 1], at)
        width = np.where(at == self.coordinate[i], self.width[i], self.radius[i + 1] - x)
        result[inside] += self.slope[i] * equivalent_1d.depth_step(profile, top, width, at)
        return result


def over_loads(
    contact: Loaded, field: Callable[[Traction, Array], Array], radius: ArrayLike
) -> Array:
    """Return the field of every load at all radii; `field` returns the field of a traction."""
    shape, traction = tractions(contact)
    return fill(shape, lambda load, r: field(traction(load), r), radius)


def fill(shape: tuple[int, ...], field: Callable[[int, Array], Array], radius: ArrayLike) -> Array:
    """Return the field of every load at all radii; `field` returns the field of one load.

    Raises InputError if there is no radius, or one that is negative or not finite.
    """
    r = checked_radii(radius)
    return np.array([field(load, r) for load in range(prod(shape))]).reshape(shape + r.shape)


def by_load(profile: Profile, shape: tuple[int, ...], *columns: Any) -> list[list[float]]:
    """Return the values of each column under every load.

    Raises InputError if a parameter of the profile is an array.
    """
    require_single_profile(profile.swept)
    return [np.broadcast_to(column, shape).ravel().tolist() for column in columns]


def tractions(contact: Loaded) -> tuple[tuple[int, ...], Callable[[int], Traction]]:
    """Return the shape of the loads, and the traction under the load of an index.

    Without friction the traction is the pressure, as in full slip for mu = 1.
    """
    if isinstance(contact, ContactState):
        at_end = _at_end(contact)
        return (), lambda _load: at_end
    normal, profile = contact.normal, contact.normal.profile
    shape = normal.coordinate.shape
    sheared: tuple[Any, ...] = (1.0, 1.0, 0.0, 0.0, 0.0, 1.0, True, 0.0, 0.0)
    if isinstance(contact, TangentialContact):
        shape, c = contact.width.shape, contact
        sheared = (
            *(c.friction_coefficient, c.displacement_ratio),
            *(c.stick_coordinate, c.stick_radius, c.width),
            *(c.sign, c.full_slip, c.sign * c.excess),
            c.tangential_displacement / c.displacement_ratio,
        )
    pressed = normal.e_star, normal.coordinate, normal.contact_radius
    columns = by_load(profile, shape, *pressed, *sheared)
    flat, exact = float(profile.first_radius), normal.control == "contact_radius"

    def traction(load: int) -> Traction:
        e_star, top, a, *friction, sign, slides, excess, moved = (part[load] for part in columns)
        mu, ratio, edge, c, width = friction
        ends, radii, widths, slopes, above = [0.0, top], [flat, a], [top], [0.0], [0.0]
        if profile.is_flat_punch:
            widths = [top if slides else width]
            slopes = [sign if widths[0] > 0 else 0.0]
        elif slides:
            slopes = [sign]
        elif width > 0:
            ends, radii, widths = [0.0, edge, top], [flat, c, a], [edge, width]
            slopes, above = [0.0, sign], [moved, 0.0]
        annuli: Any = map(np.array, (ends, radii, widths, slopes, above))
        found = Traction(profile, e_star, mu * e_star, ratio, *annuli)
        return found._replace(exact=exact, excess=excess)

    return shape, traction


def _at_end(state: ContactState) -> Traction:
    """Traction at the end of a load history."""
    profile = state.profile
    modulus = state.friction_coefficient * state.e_star
    known = profile, state.e_star, modulus, state.displacement_ratio
    if not state.in_contact:
        return Traction(*known, *np.zeros((2, 1)), *np.zeros((3, 0)))
    if profile.is_flat_punch:
        depth, ends = state.load[:1] / modulus, np.append(0.0, state.coordinate[-1])
        rows = profile.contact_radius(ends), np.abs(depth), np.sign(depth), 0 * depth
        return Traction(*known, ends, *rows)
    radius, width = profile.contact_radius(state.coordinate), np.diff(state.coordinate)
    return Traction(*known, state.coordinate, radius, width, state.slope, state.load[1:] / modulus)
