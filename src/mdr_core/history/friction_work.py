"""Work of friction on each step, from the parts of the polylines that the slip front sweeps.

On a step from P to P' the load point moves along a straight line. A spring slips from the moment at
which it exceeds the load point in one of the sums, f or b, until the end of the step or the loss of
contact. From that moment on its anchor moves by the decrease of this sum, under the friction n_P -
n, which varies linearly. The work on the spring, over (mu E*)^2/G*, is

    M(n) = (decrease of the sum) (friction at first + friction at last)/2,

and the work on all springs is int M(n) 2 dx. Both factors are piecewise linear in n. Their breaks
are the vertices, the normal coordinate of P', and the place at which the path of P crosses the
polyline, beyond which the other sum is exceeded first. In Bernstein moments of the springs the work
is a sum of positive terms. Where forces are prescribed the identity holds with the reduced force in
place of the depth and the measure |d(1/2x)| in place of 2 dx. Source: notes, §10.
"""

from typing import NamedTuple

import numpy as np

from mdr_core.elementwise import in_blocks
from mdr_core.history import slip_kernel as kernel
from mdr_core.history.slip_memory import VertexTree
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array, Indices

# Number of values by which the kernel describes a part.
_NUMBERS = 6


class SweptParts(NamedTuple):
    """The m parts of straight segments that the slip front sweeps in all steps."""

    step: Indices
    fallen: Array
    """Decrease of both coordinates of the load point on the step, shape (2, m)."""
    low: Array
    """Normal coordinate of the lower end."""
    upper: Array
    """Distance of the upper end from P in the normal coordinate and the anchor, shape (2, m)."""
    run: Array
    """Distance of the lower end from the upper one, free of cancellation, shape (2, m)."""

    @property
    def ends(self) -> tuple[Array, Array]:
        """Distances of the upper and the lower end from P, shape (2, m)."""
        return self.upper, self.upper + self.run

    @property
    def sides(self) -> tuple[Array, Array]:
        """Cross products of P' and both ends: positive where b is exceeded first."""
        n, s = self.fallen
        upper, lower = (end[1] * n - end[0] * s for end in self.ends)
        return upper, lower

    def divided(self, share: Array) -> "SweptParts":
        """Return the parts, each divided at a share of its length from the upper end, if inside."""
        at = np.flatnonzero((share > 0) & (share < 1))
        above = SweptParts._make(row[..., at] for row in self)
        first, rest = share[at] * above.run, (1 - share[at]) * above.run
        self.upper[:, at], self.run[:, at] = above.upper + first, rest
        pairs = zip(self, above._replace(low=above.low + rest[0], run=first), strict=True)
        return SweptParts._make(np.concatenate(pair, axis=-1) for pair in pairs)


def dissipation(moments: IntervalMoments, tree: VertexTree) -> Array:
    """Return G* D/(mu E*)^2 of every step [length^3], >= 0.

    The parameters of the profile may be arrays over the steps.
    """
    parts = swept(tree)
    found = [
        _work_on(moments, SweptParts._make(row[..., block] for row in parts))
        for block in in_blocks(parts.low.size)
    ]
    if not found:
        return np.zeros(tree.top.size)
    step, work = map(np.concatenate, zip(*found, strict=True))
    return np.asarray(np.bincount(step, work, tree.top.size), dtype=float)


def _work_on(moments: IntervalMoments, parts: SweptParts) -> tuple[Indices, Array]:
    """Return steps, and G* D/(mu E*)^2 of pieces of the parts; the parts are changed."""
    span = parts.run[0]
    ended = (parts.fallen[0] - parts.upper[0]) / np.where(span > 0, span, 1.0)
    parts = parts.divided(ended)
    upper, lower = parts.sides
    passes = upper * lower < 0
    parts = parts.divided(np.where(passes, upper / np.where(passes, upper - lower, 1.0), 0.0))
    terms, low, length = _work(parts), parts.low, parts.run[0]
    if moments.over_forces:
        # Prescribed forces do not exceed friction, so that work on the axis is rounding error.
        terms[0, low == 0] = 0.0
    moments = moments.part(parts.step)
    edges = moments.contact_coordinate(np.array([low, low + length]))
    weights = moments.over(low, length, edges).weights
    # Over forces the measure is infinite on the axis, where M is zero.
    work = np.multiply(terms, weights, where=terms > 0, out=np.zeros(terms.shape)).sum(axis=0)
    # All springs of a flat are on the axis.
    work += np.where(low == 0, 2 * moments.profile.first_radius * terms[0], 0.0)
    return parts.step, work


def _work(parts: SweptParts) -> Array:
    """Return the Bernstein coefficients of M on each part, upwards, >= 0, shape (3, m)."""
    (n_end, s_end), sides = parts.fallen, np.array(parts.sides)
    backward = (n_end + s_end <= 0) | ((n_end > s_end) & (sides[0] + sides[1] >= 0))
    sign = np.where(backward, -1.0, 1.0)
    fall = n_end + sign * s_end
    n, s = np.stack(parts.ends, axis=1)
    first, last = np.maximum(-sign * sides / fall, 0.0), np.maximum(n - n_end, 0.0)
    # The contact of springs above P' ends before the step.
    in_contact, apart = fall - (n + sign * s), first * fall / np.where(n_end > 0, n_end, 1.0)
    high, low = np.where(n < n_end, apart, np.maximum(in_contact, 0.0))
    high_friction, low_friction = (first + last) / 2
    between = (low * high_friction + high * low_friction) / 2
    return np.array([low * low_friction, between, high * high_friction])


def swept(tree: VertexTree) -> SweptParts:
    """Return what the slip front sweeps of the polyline before each step, and of the path of P."""
    count = tree.top.size
    starts = zip(tree.start, (tree.top, *tree.path), strict=True)
    tops, n, s = (np.append(np.asarray(first), later)[:count] for first, later in starts)
    n_end, s_end = tree.path
    # Contact begins, or ends, where the straight step crosses normal coordinate zero.
    touch, moved = np.maximum(n, n_end) > 0, n - n_end
    crossing = s + (s_end - s) * n / np.where(touch & (moved != 0), moved, 1.0)
    s, s_end = np.where(n > 0, s, crossing), np.where(n_end > 0, s_end, crossing)
    n, n_end = np.maximum(n, 0.0), np.maximum(n_end, 0.0)
    fallen = np.where(touch, [n - n_end, s - s_end], 0.0)
    count += tree.parent.size
    while True:
        room, found = count, np.empty((_NUMBERS, count))
        count = kernel.sweep(tree.parent, tree.vertices, tops, fallen, found)
        if count <= room:
            break
    # Springs that come into contact slip at once where the path is steeper than friction.
    new = np.flatnonzero((fallen[0] < 0) & (np.abs(fallen[1]) > -fallen[0]))
    fresh = np.array([new, n[new], *fallen[:, new], *-fallen[:, new]])
    step, low, *places = np.hstack([found[:, :count], fresh])
    step = step.astype(np.intp)
    return SweptParts(step, fallen[:, step], low, np.array(places[:2]), np.array(places[2:]))
