"""Tangential fields at the end of a load history: sums over the branches of the traction.

Between two neighbouring slip fronts q_x falls by mu k per unit of q, k the slope of the anchors.
The stress is therefore a sum of kernels, each over the annulus between two fronts. On the arcs
that curved load steps leave, k varies with the radius, and the kernels are superposed.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import equivalent_1d
from mdr_core.abel import Annulus, InnerEnd
from mdr_core.fields.arc import Arc
from mdr_core.fields.contact import fill, slip_kernel, stress
from mdr_core.fields.radii import EDGE_ROUNDING, Edges, grid_through
from mdr_core.history import ContactState
from mdr_core.typing import Array

# An edge that differs from the contact radius by rounding belongs to the contact.
_EDGE: Final = 1 + 4 * float(np.finfo(float).eps)


def shear_stress(state: ContactState, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return tau(r) = (mu E*/pi) sum k_i int g'(x)/sqrt(x^2 - r^2) dx [pressure].

    The i-th integral goes over [max(r, x_i-1), x_i] between neighbouring slip fronts.

    Source: mdr-5, Eqs. (5.34), (5.70); notes, §10.

    Parameters
    ----------
    state : state at the end of a load history.
    radius : radii [length], >= 0, shape (m,).
    rtol : relative accuracy, 1e-13 to 1e-3.

    Returns
    -------
    Array of shape (m,), zero outside the contact.

    Raises
    ------
    InputError : a radius that is negative or not finite.

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
    modulus = state.friction_coefficient * state.e_star

    def values(_load: int, r: Array) -> Array:
        result = np.zeros(r.shape)
        for a, annulus, slope in _segments(state):
            result += slope * stress(state.profile, annulus, a, r, rtol)
        for arc in arcs(state):
            result += arc.stress(r, rtol) / np.pi
        return modulus * result

    return fill((), values, radius)


def slip(state: ContactState, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the displacement s(r) of the surface in the contact relative to the axis [length].

    s = -mu (E*/G*) sum (k_i - k_i-1) S(x_i-1; r), S the slip kernel. Where the bodies came into
    contact under a tangential displacement, part of it is not slip but the initial mismatch.

    Source: mdr-5, Eqs. (5.39)-(5.41); notes, §10. Parameters, returns and errors as of
    `shear_stress`.
    """
    profile = state.profile
    a = state.contact_radius * _EDGE
    segments = state.segments
    change = np.diff(segments.slope, prepend=0.0, append=0.0)
    # S(0; r) and S(b; r) are equal: g is zero on a flat.
    fronts = np.append(0.0, profile.contact_radius(segments.coordinate[1:]))[: change.size]

    def values(_load: int, r: Array) -> Array:
        result = np.zeros(r.shape)
        for step, front in zip(change.tolist(), fronts.tolist(), strict=True):
            inside = (r > front) & (r <= a)
            if step != 0 and inside.any():
                result[inside] -= step * slip_kernel(profile, front, r[inside], rtol)
        inside = r <= a
        for arc in arcs(state):
            result[inside] -= arc.slip(r[inside], rtol)
        return state.displacement_ratio * result

    return fill((), values, radius)


def foundation_shear(state: ContactState, radius: ArrayLike) -> Array:
    """Return q_x(x) of the foundation [force/length].

    It is linear in g(x) between the slip fronts, except on an arc.

    Source: notes, §10. Parameters, returns and errors as of `shear_stress`.
    """
    profile, segments = state.profile, state.segments
    edges = profile.contact_radius(segments.coordinate)

    def values(_load: int, r: Array) -> Array:
        result = np.zeros(r.shape)
        if not state.in_contact:
            return result
        if profile.has_no_partial_slip:
            result[r <= edges[-1]] = state.load[0]
            return result
        # The springs of a flat carry the load of its edge.
        inside = r < edges[-1]
        x = np.maximum(r[inside], edges[0])
        at = profile.coordinate_from_radius(x)
        pieces = iter(arcs(state))
        load = np.zeros(x.shape)
        for i, (slope, rate) in enumerate(zip(segments.slope, segments.rate, strict=True)):
            below = x < edges[i + 1]
            # From the radius, or the lower end of the segment, to its upper end.
            place = np.maximum(x[below], edges[i])
            if rate:
                load[below] += next(pieces).anchor_step(place)
            elif slope:
                lower = np.maximum(at[below], segments.coordinate[i])
                load[below] += slope * _depth_step(state, i, place, lower)
        result[inside] = state.friction_coefficient * state.e_star * load
        return result

    return fill((), values, radius)


def _depth_step(state: ContactState, i: int, x: Array, at: Array) -> Array:
    """Depth from radii x on a segment, of contact coordinates `at`, to its upper end [length]."""
    profile, segments = state.profile, state.segments
    top = np.maximum(segments.coordinate[i + 1], at)
    edge = np.maximum(profile.contact_radius(top), x)
    width = profile.coordinate_width(edge, x, top, at)
    width = np.where(at == segments.coordinate[i], segments.width[i], width)
    return equivalent_1d.depth_step(profile, top, width, at)


def grid(state: ContactState, points: int) -> Array:
    """Return radii from 0 to 1.5 times the contact radius [length], shape (points,).

    They cluster at the axis, the breaks of the profile, the slip fronts and the contact edge.

    Raises
    ------
    InputError : fewer points than there are such radii.
    """
    return grid_through(state.profile, edges(state), points)


def edges(state: ContactState) -> Edges:
    """Return the contact radius and the slip fronts, with their rounding errors."""
    radius = np.append(state.slip_fronts, state.contact_radius)
    gaps = np.diff(radius, prepend=0.0)
    scale = np.minimum(gaps, np.append(gaps[1:], gaps[-1])) / state.profile.steepness
    rounding = 0.0 if state.profile.has_no_partial_slip else EDGE_ROUNDING
    return Edges(radius, rounding * radius, scale)


def _segments(state: ContactState) -> list[tuple[float, Annulus, float]]:
    """Outer radius, annulus and slope of every straight segment with a load."""
    if not state.in_contact:
        return []
    segments = state.segments
    radii = state.profile.contact_radius(segments.coordinate)
    if state.profile.has_no_partial_slip:
        # All springs carry the same load, which the kernel takes as a depth.
        depth = float(state.load[0]) / (state.friction_coefficient * state.e_star)
        end = InnerEnd(np.array([abs(depth)]), radii[-1:])
        annulus = Annulus(segments.coordinate[-1:], end)
        return [(float(radii[-1]), annulus, float(np.sign(depth)))] if depth else []
    found = []
    for i in np.flatnonzero(segments.slope):
        inner = None if i == 0 else InnerEnd(segments.width[i : i + 1], radii[i : i + 1])
        annulus = Annulus(segments.coordinate[i + 1 : i + 2], inner)
        found.append((float(radii[i + 1]), annulus, float(segments.slope[i])))
    return found


def arcs(state: ContactState) -> list[Arc]:
    """Return the segments of curved load steps."""
    profile, segments = state.profile, state.segments
    radii = profile.contact_radius(segments.coordinate)
    found = []
    for i in np.flatnonzero(segments.rate):
        width = float(profile.radius_width(segments.coordinate[i + 1], segments.width[i]))
        ends = float(radii[i]), float(radii[i + 1]), width
        found.append(Arc(profile, float(segments.rate[i]), segments.inverse, *ends))
    return found
