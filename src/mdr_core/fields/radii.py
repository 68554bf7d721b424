"""Grids of radii, and the error of fields due to the rounding error of computed edges.

A contact radius or slip front that follows from a load has a rounding error. A stress has a root at
each of them, so that its error grows towards an edge. Source: notes, §8.
"""

from math import inf
from typing import Final, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.abel.annulus import Annulus
from mdr_core.adhesion import AdhesiveContact
from mdr_core.doubles import ADJACENT, EPS, ROUNDING
from mdr_core.elementwise import broadcast, some, where
from mdr_core.errors import InputError
from mdr_core.history import ContactState, LoadHistory
from mdr_core.layer import LayerContact
from mdr_core.normal import NormalContact, solve
from mdr_core.tangential import TangentialContact
from mdr_core.torsion import TorsionalContact
from mdr_core.typing import Array
from mdr_core.validation import extremes, require_type, require_whole

# Largest error of a field due to the error of an edge, relative to its largest value, on a grid
# with enough space between the edges. It is a tenth of the other estimated errors.
_GRID_ERROR: Final = 1e-12


Contact = NormalContact | TangentialContact | TorsionalContact


class Edges(NamedTuple):
    """Contact radii and slip fronts with their rounding errors; all of shape (k,)."""

    radius: Array
    """[length]"""
    error: Array
    """Rounding errors of the radii [length]."""
    scale: Array
    """Distance over which a stress changes next to the edge [length]; infinite for the
    stress of adhesion, which is 1/sqrt(distance)."""
    reach: Array
    """Distance over which a displacement changes next to the edge [length]."""


def edges(contact: Contact | ContactState) -> Edges:
    """Return the contact radii and slip fronts of all loads, with their rounding errors."""
    if isinstance(contact, ContactState):
        radius = np.append(contact.slip_fronts, contact.contact_radius)
        gaps = np.diff(radius, prepend=0.0)
        scale = np.minimum(gaps, np.append(gaps[1:], gaps[-1])) / contact.profile.steepness
        depth = max(contact.indentation_depth, 0.0)
        end = solve(contact.profile, contact.e_star, indentation_depth=depth)
        error = end.edge_errors * radius + np.append(contact.front_errors, 0.0)
        return Edges(radius, error, *_near_axis(end, radius, error, scale))
    needed = "a contact, or the state of a load history"
    if isinstance(contact, AdhesiveContact):
        a = np.ravel(contact.contact_radius)
        return Edges(a, a * np.ravel(contact.edge_errors), np.full_like(a, inf), a)
    if not isinstance(contact, LayerContact):
        require_type("contact", contact, get_args(Contact), needed)
    normal = contact.normal
    profile, a = normal.profile, normal.contact_radius
    # The coordinate resolves the distance from a flat.
    beyond = a - profile.first_radius
    error, scale = beyond * normal.edge_errors, beyond / profile.steepness
    if isinstance(contact, NormalContact):
        return Edges(*map(np.ravel, (a, error, scale, scale)))
    c, scale = contact.stick_radius, np.minimum(scale, contact.slip_width)
    if isinstance(contact, TorsionalContact):
        # The stress of a twist rises in the stick zone from 0 at the axis to mu p(c).
        at_c = reach = np.minimum(scale, c)
    else:
        at_c, reach = _near_axis(normal, c, contact.stick_error, scale)
    parts = (a, c), (error, contact.stick_error), (scale, at_c), (scale, reach)
    return Edges(*(np.ravel([broadcast(part, c.shape) for part in pair]) for pair in parts))


def _near_axis(contact: NormalContact, c: Array, error: Array, scale: Array) -> tuple[Array, Array]:
    """Return the distances over which stresses and displacements change next to a slip front.

    A front c moves the stress by (E*/pi) g'(c) dc/sqrt(c^2 - r^2), and the foundation by g'(c) dc.
    For c < a/2 the changes are divided by the depth, and by the mean pressure F_N/(pi a^2) or the
    stress that slip outside c causes on the axis. For larger c, and next to a flat, which c does
    not reach, both distances are `scale`.
    """
    profile, top, a = contact.profile, contact.coordinate, contact.contact_radius
    inner = (c > 0) & (c < a / 2) & (profile.first_radius == 0)
    if profile.swept or not some(inner):
        return scale, scale
    with np.errstate(all="ignore"):
        slope = np.maximum(profile.dg(c), profile.dg(np.minimum(c + error, a)))
        high, low = (part[inner] for part in np.broadcast_arrays(top, c))
        on_axis = np.zeros(inner.shape)
        on_axis[inner] = profile.pressure_kernel(Annulus(high, high - low, low), 0 * low)
        size = np.maximum(profile.reduced_force(top) / (2 * a * a), np.pi / 2 * on_axis)
        stress = c * np.square(size / slope)
        return where(inner, stress, scale), where(inner, profile.depth(top) / slope, scale)


def edge_error(contact: Contact | ContactState, name: str, radius: ArrayLike) -> float:
    """Return the error of a field due to errors of edges, relative to its largest value [1].

    Edges are the contact radius and the slip fronts if they follow from a load. Radii within four
    units in the last place of an edge are excluded, because the relative error at a root is
    unbounded, unless the edge has lost half of its digits.

    Parameters
    ----------
    contact : contact, or end of a load history.
    name : `pressure`, `shear_stress`, `slip` or `foundation_shear`; other fields have no edge.
    radius : radii of the field [length], shape (m,).
    """
    if name not in ("pressure", "shear_stress", "slip", "foundation_shear"):
        return 0.0
    stress = name in ("pressure", "shear_stress")
    radius = np.atleast_1d(np.asarray(radius, dtype=float))
    known = edges(contact)
    if name == "slip":
        # Slip grows as (r - c)^(3/2) from a front, and is small at radii next to c. Far from c it
        # is of the size of g(r), and changes with c by g'(c) dc.
        reach = known.reach.copy()
        if isinstance(contact, ContactState):
            fronts, profile = slice(-1), contact.profile
        else:
            fronts, profile = slice(reach.size // 2, reach.size), contact.normal.profile
        c, last = known.radius[fronts], radius[radius <= known.radius.max()].max(initial=0.0)
        with np.errstate(all="ignore"):
            rise = (profile.g(last) - profile.g(c)) / profile.dg(c)
        beyond = 2 / 3 * np.maximum(last - c, rise)
        reach[fronts] = where(last > c, np.minimum(reach[fronts], beyond), inf)
        known = known._replace(reach=reach)
    return error_near(known, radius, root=stress)


def error_near(edges: Edges, radius: Array, *, root: bool) -> float:
    """Return the `edge_error` for the edges of all loads.

    `root` is True for stresses, which have a root at the edges, unlike displacements.
    """
    used = (edges.error > 0) & (edges.scale > 0)
    if not some(used):
        return 0.0
    at, error, scale, reach = (part[used] for part in edges)
    if not root:
        return float((2 * error / reach).max())
    # Take the nearest radii on either side of each edge. An edge does not change stresses outside.
    r, away = np.concatenate([(-inf,), radius, (inf,)]), at * ADJACENT * (error < EPS**0.5 * at)
    r.sort()
    below = at - r[r.searchsorted(at - away, side="right") - 1]
    above = r[r.searchsorted(at + away, side="right")] - at
    nearest = np.minimum(below, where(above <= error, above, inf))
    # Next to an infinite stress the error is relative to the local stress.
    # The slope of a root is largest at its end moved towards r, and a move beyond r changes the
    # stress by its value at a distance `error`.
    size = np.sqrt(scale * np.maximum(4 * (nearest - error), error))
    return float((error / where(scale < inf, size, nearest)).max())


def own_error(contact: NormalContact | TangentialContact | LoadHistory) -> float:
    """Return the error of fields apart from `edge_error`, relative to their largest value [1].

    Next to full slip the stick radius is ill-conditioned, which `edge_error` contains.
    """
    if isinstance(contact, TangentialContact):
        return extremes(contact.step_error)[1]
    return contact.error_estimate


def grid(contact: Contact | ContactState, points: int) -> Array:
    """Return radii from 0 to 1.5 times the largest contact radius [length], shape (points,).

    They cluster at the axis, the breaks, and the slip fronts and contact radius of every load.
    Prescribed edges are radii of the grid; of edges that follow from a load the grid takes a radius
    just inside, where their rounding error is insignificant.

    Parameters
    ----------
    contact : contact under any number of loads, or end of a load history.
    points : number of radii.

    Raises
    ------
    InputError : fewer points than edges and breaks.
    """
    known = edges(contact)
    profile = (contact if isinstance(contact, ContactState) else contact.normal).profile
    breaks = [np.ravel(np.asarray(b, dtype=float)) for b in profile.breaks]
    end = 1.5 * float(np.max(known.radius)) or 1.0
    if not profile.is_flat_punch:
        end = min(end, float(np.max(profile.domain)))
    exact = known.error == 0
    fixed = np.unique(np.concatenate([np.zeros(1), *breaks, known.radius[exact]]))
    moving = np.setdiff1d(known.radius[~exact], fixed)
    stops = np.union1d(fixed, moving)
    gaps = np.diff(stops, append=inf)
    place = np.searchsorted(stops, moving)
    gap = np.minimum(gaps[place], gaps[place - 1])
    clear = (ROUNDING / (2 * _GRID_ERROR)) ** 2 * np.square(moving) / gap
    if isinstance(contact, AdhesiveContact):
        clear = known.error.max() / _GRID_ERROR
    stops[place] = moving - np.minimum(clear, gap / 4)
    return graded(np.append(stops[stops < end], end), points)


def graded(stops: Array, points: int) -> Array:
    """Return radii from the first of the stops to the last, clustered at each of them [length].

    Parameters
    ----------
    stops : radii of the grid [length], ascending, shape (k,).
    points : number of radii, m.

    Returns
    -------
    Array of shape (m,).

    Raises
    ------
    InputError : fewer points than stops.
    """
    end = stops[-1]
    require_whole(("points",), points)
    if points < stops.size:
        raise InputError(("points",), f"at least {stops.size} are needed for the singular radii")
    gaps = np.diff(stops)
    # Every gap gets one point, and the other points in proportion to the root of its length.
    spare = points - stops.size
    share = np.sqrt(gaps) / np.sqrt(gaps).sum() * spare
    counts = np.floor(share).astype(int)
    counts[np.argsort(counts - share, kind="stable")[: spare - int(counts.sum())]] += 1
    parts = [
        low + gap * (1 - np.cos(np.pi * np.arange(count + 1) / (count + 1))) / 2
        for low, gap, count in zip(stops[:-1], gaps, counts, strict=True)
    ]
    return np.append(np.concatenate(parts), end)
