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

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mdr_core.cached import cached_property
from mdr_core.elementwise import indices
from mdr_core.history.slip_memory import FrontPath, SlipSegments, slip_segments
from mdr_core.interval_moments import IntervalMoments
from mdr_core.typing import Array, Indices


class _SlipIntervals(NamedTuple):
    """The three intervals between the four ends of the paths of front and load point."""

    segment: Indices
    """Index of each segment in partial slip, shape (n,)."""
    ends: Array
    """The four ends in the normal coordinate, ascending, shape (4, n)."""
    length: Array
    """Length of each interval, shape (3, n)."""
    coefficients: Array
    """Bernstein coefficients of M on each interval, shape (3, 3, n)."""


@dataclass(frozen=True)
class Dissipation:
    """Energy dissipated on the steps of one path of the slip front."""

    moments: IntervalMoments
    path: FrontPath

    @property
    def ends(self) -> Array:
        """Ends of the intervals in the normal coordinate, shape (4, n)."""
        return np.zeros((4, 0)) if self._has_no_partial_slip else self._intervals.ends

    def per_step(self, coordinate: Array) -> Array:
        """Return G* D/(mu E*)^2 of every step [length^3].

        `coordinate` has the contact coordinates of the ends, shape (4, n).
        """
        if self._has_no_partial_slip and self.moments.over_forces:
            # Prescribed forces do not exceed friction.
            return np.zeros(self.path.load.size)
        segments = self._segments
        dissipated = np.zeros(segments.step.size)
        full = indices(segments.full)
        if full.size and not self.moments.over_forces:
            # In full slip friction is mu F_N.
            ends = segments.upper_gap[full], segments.lower_gap[full]
            low, high = np.minimum(*ends), np.maximum(*ends)
            dissipated[full] = segments.slip[full] * self.moments.conjugate_mean(low, high - low)
        if not self._has_no_partial_slip:
            partial = self._intervals.segment
            ratio = segments.slip[partial] / segments.span[partial]
            dissipated[partial] = ratio * self._in_partial_slip(coordinate)
        return np.asarray(np.bincount(segments.step, dissipated, self.path.load.size), dtype=float)

    def _in_partial_slip(self, coordinate: Array) -> Array:
        """Return int M |dy'| over the three intervals of each segment in partial slip."""
        _, ends, length, coefficients = self._intervals
        some = length > 0
        part = np.zeros(coefficients.shape)
        edges = np.array([coordinate[:-1][some], coordinate[1:][some]])
        weights = self.moments.over(ends[:-1][some], length[some], edges).weights
        # Over forces the measure is infinite on the axis, where M is zero.
        chosen = coefficients[:, some]
        part[:, some] = np.multiply(chosen, weights, where=chosen > 0, out=np.zeros(chosen.shape))
        return np.asarray(part.sum(axis=0).sum(axis=0))

    @property
    def _has_no_partial_slip(self) -> bool:
        return self.moments.profile.has_no_partial_slip

    @cached_property
    def _segments(self) -> SlipSegments:
        return slip_segments(self.path)

    @cached_property
    def _intervals(self) -> _SlipIntervals:
        return _slip_intervals(self._segments)


def _slip_intervals(segments: SlipSegments) -> _SlipIntervals:
    """Return the intervals of the segments in partial slip.

    Above the lower end `normal` of the segment, the front moves from `span` to 0 and the load
    point from span + upper to `lower`.
    """
    partial = indices(~segments.full & (segments.span > 0))
    given = segments.normal, segments.span, segments.upper_gap, segments.lower_gap
    normal, span, upper, lower = (row[partial] for row in given)
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
    ends = np.cumsum([normal, first, second, third], axis=0)
    coefficients = [
        [nothing, at_first, at_second],
        [first * lower / 2, between, nothing],
        [at_first, at_second, nothing],
    ]
    return _SlipIntervals(partial, ends, np.array([first, second, third]), np.array(coefficients))
