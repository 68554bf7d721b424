"""Energy dissipated by friction, from the segments that the slip front swept.

While the slip front runs down a segment of the polyline from n_H to n_L, every spring above it
slips by the front's own shift, mu (E*/G*) |1 -+ k| dw, under the friction mu E* (d - w'):

    G* D/(mu E*)^2 = |1 -+ k| int dw int_w^d (d - w') 2 dx'.

Interchanged, the inner integral M over the path of the front is known for each spring. The load
point moves linearly, so M is a polynomial of degree 2 in w' between the four ends of the two
paths, and its Bernstein coefficients are positive: D is a sum of positive terms. Where forces are
prescribed the identity holds with the reduced force in place of the depth and the measure
|d(1/2x)| in place of 2 dx. Source: notes, §10.
"""

import numpy as np

from mdr_core.history.slip_memory import SlipSegments
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array


def per_segment(moments: IntervalMoments, segments: SlipSegments) -> Array:
    """Return G* D/(mu E*)^2 of every segment [length^3]."""
    dissipated = np.zeros(segments.step.size)
    full = np.flatnonzero(segments.full)
    if full.size and not moments.over_forces:
        # In full slip friction is mu F_N. Prescribed forces do not exceed it.
        ends = segments.upper_gap[full], segments.lower_gap[full]
        low, high = np.minimum(*ends), np.maximum(*ends)
        dissipated[full] = segments.slip[full] * moments.conjugate_mean(low, high - low)
    if moments.profile.has_no_partial_slip:
        return dissipated
    partial = np.flatnonzero(~segments.full & (segments.span > 0))
    given = segments.normal, segments.span, segments.upper_gap, segments.lower_gap
    low, length, coefficients = _intervals(*(row[partial] for row in given))
    some = length > 0
    part = np.zeros(coefficients.shape)
    weights = moments.over(low[some], length[some]).weights
    # Over forces the measure is infinite on the axis, where M is zero.
    chosen = coefficients[:, some]
    part[:, some] = np.multiply(chosen, weights, where=chosen > 0, out=np.zeros(chosen.shape))
    total = part.sum(axis=0).sum(axis=0)
    dissipated[partial] = segments.slip[partial] / segments.span[partial] * total
    return dissipated


def _intervals(
    normal: Array, span: Array, upper: Array, lower: Array
) -> tuple[Array, Array, Array]:
    """Return the three intervals between the four ends of the paths of front and load point.

    Lower ends and lengths, shape (3, n), and the Bernstein coefficients of M, shape (3, 3, n).
    Above the lower end `normal` of the segment, the front moves from `span` to 0 and the load
    point from span + upper to `lower`.
    """
    top = span + upper
    overtaken, rising = lower <= span, lower > top
    # The load point moves by this many times the movement of the front.
    ratio = np.where(overtaken, (span - lower) + upper, top - lower) / span
    first = np.minimum(span, lower)
    second = np.where(overtaken, span - lower, np.where(rising, upper, lower - span))
    third = np.where(overtaken, upper, np.abs(lower - top))
    nothing, some = np.zeros(span.shape), np.where(ratio > 0, ratio, 1.0)
    # M at the ends of the first and the second interval, and the middle coefficient between.
    at_first = ratio * np.square(lower) / 2
    at_first = np.where(overtaken, at_first, span * ((lower - span) + upper) / 2)
    at_second = np.where(ratio > 0, np.square(upper) / (2 * some), 0.0)
    at_second = np.where(overtaken, at_second, np.abs(ratio) * np.square(span) / 2)
    between = np.where(overtaken, lower * upper / 2, (at_first + at_second) / 2)
    ends = np.cumsum([normal, first, second], axis=0)
    coefficients = [
        [nothing, at_first, at_second],
        [first * lower / 2, between, nothing],
        [at_first, at_second, nothing],
    ]
    return ends, np.array([first, second, third]), np.array(coefficients)
