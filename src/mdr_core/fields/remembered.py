"""The tangential fields that a loading history leaves: sums over its branches.

Between two neighbouring fronts q_x falls by mu k per unit of q, k the slope of the anchors. So
the stress is a sum of kernels between the fronts, each an integral over its own annulus.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import annulus
from mdr_core.fields.on_arcs import Arc, anchor_step
from mdr_core.fields.rows import fill, grid_through, kernel, slip_kernel
from mdr_core.history import State
from mdr_core.normal import Load
from mdr_core.typing import Array

_EDGE: Final = 1 + 4 * float(np.finfo(float).eps)


def shear_stress(state: State, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return tau(r) = (mu E*/pi) sum k_i int g'(x)/sqrt(x^2 - r^2) dx [pressure], shape (m,).

    The i-th integral goes over [max(r, x_i-1), x_i] between neighbouring fronts.

    Source: mdr-5, Eqs. (5.34), (5.70); notes, §10.

    Raises
    ------
    InputError : a radius that is negative or not finite.

    Examples
    --------
    After a full cycle nothing but the last swing is remembered: Eq. (5.54), on a cone.

    >>> from mdr_core.history import solve
    >>> from mdr_core.profiles import Cone
    >>> way = solve(Cone(0.2), 1.0, 1.0, 0.5, indentation_depth=np.pi / 10,
    ...             tangential_displacement=[0.0, 0.05, -0.05, 0.05])
    >>> c = 1 - 0.05 / (0.5 * np.pi / 10)
    >>> bool(abs(shear_stress(way.state, [0.0])[0] / (0.5 * 0.1 * np.log(1 / c)) - 1) < 1e-13)
    True
    """
    scale = state.friction_coefficient * state.e_star / np.pi

    def values(r: Array, highest: float) -> Array:
        result = np.zeros(r.shape)
        for load, slip_annulus, modulus in _pieces(state):
            result += kernel(load, r, highest, slip_annulus, modulus, rtol)
        for arc in _arcs(state):
            result += scale * arc.stress(r, rtol)
        return result

    return fill((), [values], radius)


def slip(state: State, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the displacement s(r) of the surface in the contact against the axis [length].

    s = -mu (E*/G*) sum (k_i - k_i-1) S(x_i-1; r), S the slip kernel. Where the bodies have
    touched under a tangential displacement it is not all slip: their surfaces met like that.

    Source: mdr-5, Eqs. (5.39)-(5.41); notes, §10. Returns and errors as of `shear_stress`.
    """
    profile = state.profile
    # The edge as another route gives it, to the last digit but one, belongs to the contact.
    a = state.contact_radius * _EDGE
    pieces = state.pieces
    bends = np.diff(np.where(pieces.rate == 0, pieces.slope, 0.0), prepend=0.0, append=0.0)
    # S(0; r) and S(b; r) are the same: g is zero on a flat.
    fronts = np.append(0.0, profile.contact_radius(pieces.coordinate[1:]))[: bends.size]

    def values(r: Array, _highest: float) -> Array:
        result = np.zeros(r.shape)
        for bend, front in zip(bends.tolist(), fronts.tolist(), strict=True):
            inside = (r > front) & (r <= a)
            if bend != 0 and inside.any():
                result[inside] -= bend * slip_kernel(profile, front, r[inside], rtol)
        inside = r <= a
        for arc in _arcs(state):
            result[inside] -= arc.slip(r[inside], rtol)
        return state.compliance * result

    return fill((), [values], radius)


def foundation_shear(state: State, radius: ArrayLike) -> Array:
    """Return q_x(x) of the foundation [force/length], shape (m,).

    It is linear in g(x) between the fronts. Source: notes, §10. Errors as of `shear_stress`.
    """
    profile, scale = state.profile, state.friction_coefficient * state.e_star
    pieces = state.pieces
    edges = profile.contact_radius(pieces.coordinate)

    def values(r: Array, _highest: float) -> Array:
        result = np.zeros(r.shape)
        if not state.touches:
            return result
        if profile.slips_at_once:
            result[r <= edges[-1]] = state.load[0]
            return result
        # The piece in which each radius lies; a flat carries what its edge does.
        x = np.maximum(r, edges[0])
        index = np.clip(np.searchsorted(edges, x, side="left") - 1, 0, edges.size - 2)
        at, top = profile.coordinate_from_radius(x), pieces.coordinate[index + 1]
        inside = r < edges[-1]
        upper = np.maximum(edges[index + 1], x)
        width = profile.coordinate_width(upper, x, np.maximum(top, at), at)
        step = annulus.depth_step(profile, np.maximum(top, at), width, at)
        # Of an arc the depths say nothing.
        step = np.where(pieces.rate[index] == 0, pieces.slope[index] * step, 0.0)
        for number in np.flatnonzero(pieces.rate):
            chosen = index == number
            end = float(pieces.coordinate[number + 1])
            rate = float(pieces.rate[number])
            step[chosen] = anchor_step(profile, rate, end, at[chosen], inverse=pieces.by_force)
        result[inside] = scale * (pieces.load[index + 1] + step)[inside]
        return result

    return fill((), [values], radius)


def grid(state: State, points: int) -> Array:
    """Return radii from 0 to half as far again as the contact [length], shape (points,).

    They crowd towards the axis, the breaks, the fronts and the contact's edge.

    Raises
    ------
    InputError : fewer points than there are such radii.
    """
    special = [np.array([state.contact_radius]), state.slip_fronts]
    return grid_through(state.profile, special, state.contact_radius, points)


def _pieces(state: State) -> list[tuple[Load, tuple[float, float] | None, float]]:
    """Contact up to each front, the annulus below it, and mu E* times the slope there."""
    profile, modulus = state.profile, state.friction_coefficient * state.e_star
    if not state.touches:
        return []
    pieces = state.pieces
    radii = profile.contact_radius(pieces.coordinate)
    found = []
    if profile.slips_at_once:
        # One spring stands for all: what it carries is the load of the kernel.
        depth, q = float(state.coordinate[-1]), float(state.load[0])
        load = Load(profile, state.e_star, depth, float(radii[-1]), None)
        return [(load, (abs(q) / modulus, load.a), np.copysign(modulus, q))] if q else []
    for i, (slope, rate) in enumerate(zip(pieces.slope, pieces.rate, strict=True)):
        if slope != 0 and rate == 0:
            load = Load(
                profile, state.e_star, float(pieces.coordinate[i + 1]), float(radii[i + 1]), None
            )
            below = None if i == 0 else (float(pieces.width[i]), float(radii[i]))
            found.append((load, below, slope * modulus))
    return found


def _arcs(state: State) -> list[Arc]:
    """The pieces that are arcs."""
    profile, pieces = state.profile, state.pieces
    radii = profile.contact_radius(pieces.coordinate)
    found = []
    for i in np.flatnonzero(pieces.rate):
        width = profile.radius_width(pieces.coordinate[i + 1], pieces.width[i])
        ends = float(radii[i]), float(radii[i + 1]), float(width)
        found.append(Arc(profile, float(pieces.rate[i]), pieces.by_force, *ends))
    return found
