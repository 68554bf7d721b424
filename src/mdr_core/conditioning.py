"""Relative condition numbers of partial slip with respect to the loads.

Loads are rounded. Where results change much between neighbouring loads, as the stick radius does
near full slip, the rounding error of the load limits the accuracy of every method.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from mdr_core.doubles import ADJACENT, EPS, ROUNDING, TINY
from mdr_core.elementwise import full, quotient, some, where
from mdr_core.equivalent_1d import NARROW, stick_edge
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags

OF_SUMS: Final = 40.0
"""Rounding error of sums over annuli and segments, relative to the rounding error of closed
forms."""


def near_full_slip(
    profile: Profile,
    ends: tuple[Array, Array],
    ratio: Array,
    partial: Flags,
    *,
    force_prescribed: bool,
    edges: bool = True,
) -> Array:
    """Return the largest condition number of each load's results near full slip [1].

    The distance from full slip is F_N(c) under a force and d(c) under a displacement. Divided by
    the logarithmic derivative of the distance with respect to c, its condition number is the
    condition number of c. All other results follow from c.

    Parameters
    ----------
    profile : parameters broadcast with the loads.
    ends : a and c in the contact coordinate.
    ratio : load divided by the load at full slip [1].
    partial : True in partial slip.
    force_prescribed : True if the tangential force is prescribed, False for the displacement.
    edges : True to include c and a - c in addition to forces, displacements and energies.
    """
    late = partial & (ratio > 1 - NARROW)
    if not some(late):
        return full(0.0, ratio)
    high, low = ends[0], np.maximum(ends[1], TINY)
    other = profile.depth if force_prescribed else profile.reduced_force
    with np.errstate(all="ignore"):
        load, slope = profile.load_and_slope(low, of_force=force_prescribed)
        other_load, other_slope = profile.load_and_slope(low, of_force=not force_prescribed)
        moved = load / (slope * np.maximum(1 - ratio, EPS / 2))
        # The energy of a narrow annulus grows with the cube of its width.
        condition = 3 * moved * other_slope / (other(high) - other_load)
        if edges:
            c, a = profile.contact_radius(low), profile.contact_radius(high)
            condition = np.stack(np.broadcast_arrays(moved / c, moved / (a - c), condition))
            condition = np.where(np.isfinite(condition), condition, 0.0).max(axis=0)
    return where(late & np.isfinite(condition), condition, 0.0)


def of_forces(contact: NormalContact, size: Array, limit: Array) -> float:
    """Return the largest condition number of a history prescribed by forces near full slip [1].

    `size` and `limit` are |F_x| and mu F_N of every load step [force]; `contact` has the normal
    contact of each step, or a single one for all.
    """
    partial = (limit > 0) & (size < limit)
    ratio = np.where(partial, quotient(size, limit), 0.0)
    worst = np.argmax(ratio)
    if not ratio[worst] > 1 - NARROW:
        return 0.0
    coordinate, part = np.broadcast_to(contact.coordinate, ratio.shape)[worst], ratio[worst]
    edge, _ = stick_edge(contact.profile, coordinate, part, 1 - part, of_force=True)
    ends = coordinate, edge
    return float(
        near_full_slip(contact.profile, ends, part, part > 0, force_prescribed=True, edges=False)
    )


def of_sliding(
    displacement: Array, force: Array, limit: Array, dissipated: Callable[[], float]
) -> float:
    """Return the condition number of the dissipated energy with respect to sliding distance [1].

    Parameters
    ----------
    displacement, force, limit : displacement [length], F_x and mu F_N [force] of every load step.
    dissipated : energy dissipated up to the last load step, evaluated only if the contact slides.
    """
    slides = (limit > 0) & (np.abs(force) >= limit * (1 - ROUNDING))
    if not slides.any():
        return 0.0
    total = dissipated()
    moved = np.sum(np.where(slides, limit * np.abs(displacement), 0.0))
    return float(moved) / total if total > 0 else 0.0


def narrow_annulus(coordinate: Array, width: Array) -> Array:
    """Return the condition number 3 a/(a - c) of each annulus between two edges [1]."""
    return quotient(3 * coordinate, width)


def of_edge_slope(contact: NormalContact) -> Array:
    """Return the relative error of a slip annulus due to rounding of the contact coordinate [1].

    The width of a narrow annulus is inversely proportional to g' at the edge. g' changes rapidly
    just beyond a break, and where it falls to zero.
    """
    profile, at = contact.profile, contact.coordinate
    if not (profile.coordinate_breaks.size or profile.flattens):
        return full(0.0, at)
    at = where(at > 0, at, np.nan)
    with np.errstate(all="ignore"):
        error = np.maximum(contact.edge_errors, ADJACENT)
        # A prescribed radius that is the contact coordinate is exact: rounding does not move it
        # onto a break.
        exact = (contact.control == "contact_radius") & (at == contact.contact_radius)
        sides = np.stack(np.broadcast_arrays((1 - error) * at, where(exact, at, (1 + error) * at)))
        slopes = profile.depth_slope(sides)
        change = np.abs(np.log(slopes[1] / slopes[0]))
    return where(np.isfinite(change), change, 0.0)


def of_steep_edge(profile: Profile, edge: Array, steps: tuple[Array, Array]) -> Array:
    """Return the relative error of wide annuli due to rounding of c where loads rise steeply [1].

    Parameters
    ----------
    profile : parameters broadcast with the loads.
    edge : c in the contact coordinate.
    steps : d(a) - d(c) [length] and (F(a) - F(c))/E* [length^2].
    """
    error = full(0.0, edge)
    beyond = np.minimum(edge * (1 + ADJACENT), profile.domain)
    for load, step in zip((profile.depth, profile.reduced_force), steps, strict=True):
        below = load(edge)
        wide = step > NARROW / 2 * below
        rise = (load(beyond) - below) / where(wide, step, 1.0)
        error = np.maximum(error, where(wide, rise, 0.0))
    return error
