"""Transform of a table's slope, fitted by polynomials on subpanels. Source: notes, §5."""

from collections.abc import Sequence
from math import sqrt
from typing import Final

import numpy as np

from mdr_core.abel.interpolation import fit_points, fitted
from mdr_core.abel.piecewise_quadratic import PiecewiseQuadratic, slope_source
from mdr_core.abel.subpanels import FEW, LONGEST, Subpanels
from mdr_core.abel.two_root import inverse_hypot
from mdr_core.typing import Array

# Points in a subpanel where those of a spline do not suffice.
_MANY: Final = 22
# Bound of the last Chebyshev coefficients over the largest value, ten times rounding error.
_TOLERANCE: Final = 1e-13
# Beyond a flat of radius b g' has one root, at s^2 = -b^2, and is a series in s^2: of a panel of
# this length, over b^2, so many terms leave 82^-n.
_BEYOND_FLAT, _TERMS = 0.05, 9


def subpanel_edges(knots: Array, cuts: Sequence[float] = ()) -> Array:
    """Return knots and cuts with further edges that keep subpanels short next to roots of g'.

    The first knot is the axis or the edge of a flat.
    """
    roots = set(knots.tolist())
    left = knot = float(knots[0])
    edges = [left]
    # Largest length of the next subpanel in x^2, by the distance from the last knot below it.
    room = _BEYOND_FLAT * left * left if left > 0 else np.inf
    for right in sorted({*knots[1:].tolist(), *cuts}):
        while (right - left) * (right + left) > room:
            middle = sqrt(left * left + room)
            if not left < middle < right:
                break
            edges.append(middle)
            left, room = middle, LONGEST * (middle - knot) * (middle + knot)
        edges.append(right)
        left, room = right, LONGEST * (right - knot) * (right + knot)
        knot = right if right in roots else knot
    return np.array(edges)


def resolve(knots: Array, slope: Array, plateaus: Array, *, spline: bool = False) -> Subpanels:
    """Return the subpanels of a table whose slope f' is quadratic between the knots.

    Parameters
    ----------
    knots : radii of the table, from the axis or the flat's edge on [length], shape (k + 1,).
    slope : coefficients of the powers 0 to 2 of the distance from the left knot, shape (3, k).
    plateaus : intervals of the radius in which g is taken as constant [length], shape (m, 2).
    spline : True if f'' is continuous except at a few knots.

    Returns
    -------
    Depth, half force and energy / E*, relatively accurate at every load.
    """
    source, jumps = slope_source(knots, slope)
    edges = subpanel_edges(knots, plateaus.ravel().tolist())
    left, right = edges[:-1], edges[1:]
    length = inverse_hypot(right, left)
    pole = np.zeros_like(left)
    pole[np.searchsorted(left, knots[:-1])] = jumps * knots[:-1]
    by_depth, by_force, error = _fitted(
        source, left, length, pole, (FEW, _MANY) if spline else (_MANY,)
    )
    if left[0] > 0:
        by_depth[0], by_force[0] = _beyond_flat(source, left[0], length[0], slope[0, 0] * left[0])
    else:
        # Next to the axis s = x and g' is a polynomial.
        by_depth[0, :3] = slope[:, 0] * [np.pi / 2, 2.0, 3 * np.pi / 4] * length[0] ** np.arange(3)
        by_force[0, 1:4] = by_depth[0, :3] * length[0]
    for low, high in plateaus.tolist():
        by_depth[(left >= low) & (right <= high)] = 0.0
        by_force[(left >= low) & (right <= high)] = 0.0
    used = np.flatnonzero((by_depth != 0).any(axis=0) | (by_force != 0).any(axis=0))
    degrees = np.arange(1, used.max(initial=2) + 2)
    depth = by_depth[:, : degrees.size] * length[:, None] / degrees
    half_force = by_force[:, : degrees.size] * length[:, None] / degrees
    at_edges = np.zeros((3, edges.size))
    np.cumsum(depth.sum(axis=1), out=at_edges[0, 1:])
    np.cumsum(half_force.sum(axis=1), out=at_edges[1, 1:])
    found = Subpanels(edges, length, depth, half_force, at_edges, error)
    np.cumsum(found.energy_at(np.arange(left.size), length), out=at_edges[2, 1:])
    return found


def _fitted(
    source: PiecewiseQuadratic, left: Array, length: Array, pole: Array, counts: tuple[int, ...]
) -> tuple[Array, Array, float]:
    """Coefficients of the powers of u of dg/ds and x dg/ds = s G + pole, and the largest tail.

    G = g' less the pole/s of the jump at the left edge. The first subpanel is left out.
    """
    by_depth, by_force = np.zeros((2, left.size, _MANY + 1))
    rest, error = np.arange(1, left.size), 0.0
    for count in counts:
        points, to_chebyshev, _ = fit_points(count)
        b, at_pole = left[rest, None], pole[rest, None]
        s = length[rest, None] * points
        x = np.hypot(b, s)
        value = source.transform(np.repeat(left[rest], count), (s * s / (b + x)).ravel())
        value = value.reshape(s.shape)
        whole = value * s + at_pole
        tail = np.zeros(rest.size)
        for part, size in ((value * length[rest, None], whole), (whole / x, whole / x)):
            largest = np.abs(size).max(axis=1)
            last = np.abs(part @ to_chebyshev[-2:].T).max(axis=1)
            tail = np.maximum(tail, last / np.where(largest > 0, largest, 1.0))
        span = length[rest, None]
        by_force[rest, 0] = at_pole[:, 0]
        by_force[rest, 1 : count + 1] = fitted(value) * span
        by_depth[rest, :count] = at_pole * fitted(1 / x) if at_pole.any() else 0.0
        by_depth[rest, count] = 0.0
        by_depth[rest, 1 : count + 1] += fitted(value / x) * span
        error = max(error, float(tail[(tail <= _TOLERANCE) | (count == _MANY)].max(initial=0.0)))
        rest = rest[tail > _TOLERANCE]
        if not rest.size:
            break
    return by_depth, by_force, error


def _beyond_flat(
    source: PiecewiseQuadratic, left: float, length: float, pole: float
) -> tuple[Array, Array]:
    """Coefficients as from `_fitted` next to a flat, where G/s is a series in s^2."""
    points, _, _ = fit_points(_TERMS)
    s = length * np.sqrt(points)
    x = np.hypot(left, s)
    value = source.transform(np.full(_TERMS, left), s * s / (left + x)) / s * length**2
    by_depth, by_force = np.zeros((2, _MANY + 1))
    by_force[0], by_force[2 : 2 * _TERMS + 2 : 2] = pole, fitted(value)
    by_depth[: 2 * _TERMS : 2] = pole * fitted(1 / x)
    by_depth[2 : 2 * _TERMS + 2 : 2] += fitted(value / x)
    return by_depth, by_force
