"""Work of friction on each step, from the pieces of the polyline that the slip front sweeps.

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

import numpy as np

from mdr_core.doubles import EPS
from mdr_core.elementwise import in_blocks
from mdr_core.history import slip_kernel as kernel
from mdr_core.history.slip_memory import VertexTree
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array

# Number of values by which the kernel describes a piece.
_NUMBERS = 6


def dissipation(moments: IntervalMoments, tree: VertexTree) -> Array:
    """Return G* D/(mu E*)^2 of every step [length^3], >= 0.

    The parameters of the profile may be arrays over the steps.
    """
    pieces = swept(tree)
    step, work = pieces[0].astype(np.intp), np.empty(pieces.shape[1])
    if moments.over_forces:
        # In full slip the front reaches the axis, or a vertex; rounding may keep it from the axis.
        (normal, tangential), low = tree.path[:, step], pieces[1]
        near = np.flatnonzero((np.abs(tangential) == normal) & (low < np.sqrt(EPS) * normal))
        near = near[~np.isin(low[near], tree.normal)]
        pieces[2, near] += low[near]
        pieces[1, near] = 0.0
    for block in in_blocks(work.size):
        work[block] = _work(moments.part(step[block]), pieces[1:, block])
    return np.asarray(np.bincount(step, work, tree.top.size), dtype=float)


def _work(moments: IntervalMoments, pieces: Array) -> Array:
    """Return G* D/(mu E*)^2 of pieces, given as rows of `SlipFront` without the step."""
    low, span, terms = pieces[0], pieces[1], pieces[2:]
    if moments.over_forces:
        # Prescribed forces stay below the friction limit: work on the axis is rounding error.
        terms[0, low == 0] = 0.0
    edges = moments.contact_coordinate(np.array([low, low + span]))
    weights = moments.over(low, span, edges).weights
    # Over forces the measure is infinite on the axis, where M is zero.
    work = np.multiply(terms, weights, where=terms > 0, out=np.zeros(terms.shape)).sum(axis=0)
    # All springs of a flat are on the axis.
    return work + np.where(low == 0, 2 * moments.profile.first_radius * terms[0], 0.0)


def swept(tree: VertexTree) -> Array:
    """Return the pieces that the slip front sweeps on every step, see `slip_kernel.SlipFront`."""
    count, (top, load_points) = tree.top.size, tree.start
    tops = np.append(top, tree.top)[:count]
    before = np.hstack([load_points, tree.path])[:, :count].copy()
    steps = tree.parent, tree.vertices, tops, before, tree.path
    # A sweep into an empty array counts the pieces.
    made = kernel.SlipFront(np.empty((_NUMBERS, 0))).run(*steps)
    pieces = np.empty((_NUMBERS, made))
    kernel.SlipFront(pieces).run(*steps)
    return pieces
