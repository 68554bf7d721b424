"""Energy dissipated by friction, from the segments of the polyline that the slip front sweeps.

On each segment it is the integral of a polynomial of degree 2 over the springs, in three intervals:
see `slip_kernel.SlipFront`. In Bernstein moments of the springs it is a sum of positive terms.
Where forces are prescribed the identity holds with the reduced force in place of the depth and the
measure |d(1/2x)| in place of 2 dx. Source: notes, §10.
"""

import numpy as np

from mdr_core.history.slip_memory import VertexTree
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array


def per_step(moments: IntervalMoments, tree: VertexTree) -> Array:
    """Return G* D/(mu E*)^2 of every step [length^3], >= 0."""
    intervals = tree.slip_intervals
    if not intervals.size:
        return np.zeros(tree.top.shape)
    step = intervals[6].astype(np.intp)
    return np.asarray(np.bincount(step, _work(moments, intervals), tree.top.size), dtype=float)


def _work(moments: IntervalMoments, intervals: Array) -> Array:
    """Return G* D/(mu E*)^2 of each interval, given by its seven numbers."""
    (low, length), coefficients, full = intervals[:2], intervals[2:5], intervals[5]
    edges = moments.contact_coordinate(np.append(low, low + length)).reshape(2, -1)
    weights = moments.over(low, length, edges).weights
    # Over forces the measure is infinite on the axis, where M is zero.
    some = coefficients > 0
    work = np.multiply(coefficients, weights, where=some, out=np.zeros(weights.shape)).sum(axis=0)
    slides = np.flatnonzero(full > 0)
    if slides.size:
        # Prescribed forces do not exceed friction: full slip is rounding error there.
        at = edges[0, slides]
        mean = moments.conjugate(at) + length[slides] * moments.profile.contact_radius(at)
        work[slides] = 0.0 if moments.over_forces else work[slides] + full[slides] * mean
    return np.asarray(work)
