"""Tangential fields of a contact or at the end of a load history: sums over annuli.

Between two neighbouring slip fronts dq_x/dq = mu k, k the slope of the anchors: 0 where the springs
stick under a monotonic load, 1 where they slip. The stress is therefore a sum of kernels, each over
the annulus between two fronts.
"""

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import equivalent_1d
from mdr_core.abel.annulus import Annulus
from mdr_core.doubles import ADJACENT
from mdr_core.fields.normal import by_load, fill, stress
from mdr_core.history import ContactState
from mdr_core.profiles import Profile
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import require_type


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

    def annulus(self, i: int) -> Annulus:
        """Return the i-th annulus."""
        outer = self.radius[i + 1] if self.exact else None
        coordinate = self.coordinate[i : i + 2]
        return Annulus(coordinate[1], self.width[i], self.radius[i], outer, coordinate[0])

    def stress(self, r: Array) -> Array:
        """Return the stress at radii, over mu E* [1], shape (m,)."""
        result = np.zeros(r.shape)
        for i in np.flatnonzero(self.slope).tolist():
            a = float(self.radius[i + 1])
            result += self.slope[i] * stress(self.profile, self.annulus(i), a, r)
        return result

    def step(self, i: int, x: Array) -> Array:
        """Return the growth of q_x/(mu E*) from the outer end of the i-th annulus to x [length]."""
        if not self.slope[i]:
            return np.zeros(x.shape)
        at = np.maximum(self.profile.coordinate_from_radius(x), self.coordinate[i])
        x, top = np.maximum(x, self.radius[i]), np.maximum(self.coordinate[i + 1], at)
        width = np.where(at == self.coordinate[i], self.width[i], self.radius[i + 1] - x)
        return self.slope[i] * equivalent_1d.depth_step(self.profile, top, width, at)


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
    return _fill(contact, lambda load, r: load.modulus * load.stress(r), radius)


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

    return _fill(contact, values, radius)


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

    def values(load: Traction, r: Array) -> Array:
        profile, result = load.profile, np.zeros(r.shape)
        if profile.is_flat_punch:
            # All springs carry the same load.
            result[r <= load.radius[-1]] = load.modulus * (load.slope @ load.width)
            return result
        # The springs of a flat carry the load of its edge.
        inside = r < load.radius[-1]
        x = np.maximum(r[inside], load.radius[0])
        total = np.zeros(x.shape)
        for i, above in enumerate(load.above.tolist()):
            here = (load.radius[i] <= x) & (x < load.radius[i + 1])
            total[here] = above + load.step(i, x[here])
        result[inside] = load.modulus * total
        return result

    return _fill(contact, values, radius)


def _fill(
    contact: TangentialContact | ContactState,
    field: Callable[[Traction, Array], Array],
    radius: ArrayLike,
) -> Array:
    """Field of every load at all radii."""
    shape, traction = tractions(contact)
    return fill(shape, lambda load, r: field(traction(load), r), radius)


def tractions(
    contact: TangentialContact | ContactState,
) -> tuple[tuple[int, ...], Callable[[int], Traction]]:
    """Return the shape of the loads, and the traction under the load of an index."""
    needed = "a contact from tangential.solve, or the state of a load history"
    require_type("contact", contact, (TangentialContact, ContactState), needed)
    if isinstance(contact, ContactState):
        traction = _at_end(contact)
        return (), lambda _load: traction
    return contact.width.shape, _of_loads(contact)


def _at_end(state: ContactState) -> Traction:
    """Traction at the end of a load history."""
    profile = state.profile
    modulus = state.friction_coefficient * state.e_star
    known = profile, state.e_star, modulus, state.displacement_ratio
    if not state.in_contact:
        ends, nothing = np.zeros(1), np.zeros(0)
        return Traction(*known, ends, ends, nothing, nothing, nothing)
    if profile.is_flat_punch:
        depth = state.load[:1] / modulus
        ends = np.append(0.0, state.coordinate[-1])
        rows = profile.contact_radius(ends), np.abs(depth), np.sign(depth), 0 * depth
        return Traction(*known, ends, *rows)
    radius, width = profile.contact_radius(state.coordinate), np.diff(state.coordinate)
    return Traction(*known, state.coordinate, radius, width, state.slope, state.load[1:] / modulus)


def _of_loads(contact: TangentialContact) -> Callable[[int], Traction]:
    """Traction under the load of an index."""
    normal, profile = contact.normal, contact.normal.profile
    modulus = contact.friction_coefficient * normal.e_star
    columns = by_load(
        profile,
        contact.width.shape,
        *(normal.e_star, modulus, contact.displacement_ratio),
        *(normal.coordinate, normal.contact_radius),
        *(contact.stick_coordinate, contact.stick_radius, contact.width),
        *(contact.sign, contact.full_slip, contact.sign * contact.excess),
        contact.tangential_displacement / contact.displacement_ratio,
    )
    flat = float(profile.first_radius)
    exact = normal.control == "contact_radius"

    def traction(load: int) -> Traction:
        e_star, mu_e, ratio, *places, sign, slides, excess, moved = (part[load] for part in columns)
        top, a, edge, c, width = places
        ends, radii, widths, slopes, above = [0.0, top], [flat, a], [top], [0.0], [0.0]
        if profile.is_flat_punch:
            widths = [top if slides else width]
            slopes = [sign if widths[0] > 0 else 0.0]
        elif slides:
            slopes = [sign]
        elif width > 0:
            ends, radii = [0.0, edge, top], [flat, c, a]
            widths, slopes, above = [edge, width], [0.0, sign], [moved, 0.0]
        parts = np.array(ends), np.array(radii), np.array(widths), np.array(slopes), np.array(above)
        return Traction(profile, e_star, mu_e, ratio, *parts, exact=exact, excess=excess)

    return traction
