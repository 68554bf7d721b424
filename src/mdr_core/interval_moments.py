"""Moments of the conjugate's slope over intervals of the normal coordinate.

The normal coordinate n of a contact is its depth d, where displacements are prescribed, or its
reduced force I = F_N/E*, where forces are. The other of the two is its conjugate y. From
dI = 2 a dd the slope y' = dy/dn is 2a or 1/(2a): it is monotonic, so |dy'| is a positive measure.
Over depths it counts the foundation springs, 2 dx, that come into contact.

Steps of the conjugate and all energies of a load history are integrals of polynomials of degree
0 to 2 over this measure. Formed from the three moments below, none of them suffers cancellation,
however narrow the interval and however small the amplitude. Source: notes, §6 and §10.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf
from typing import Final, NamedTuple

import numpy as np

from mdr_core.breaks import break_below, has_many_breaks
from mdr_core.elementwise import every, some, where
from mdr_core.equivalent_1d import coordinate_from_load, depth_step, force_step
from mdr_core.inversion import Function
from mdr_core.profiles import Profile
from mdr_core.quadrature import cumulative_rule, in_order
from mdr_core.typing import Array, Flags, Indices, Parameter

# Intervals evaluated at once, so that their nodes stay in the processor's cache.
_BLOCK: Final = 1024
# Gauss nodes on an interval without a break, see notes, §10.
_POINTS: Final = 16
# An interval before the first break is wide if the normal coordinate grows by more than this factor
# on it. Differences of closed forms over a wide interval do not suffer cancellation.
_WIDE: Final = 16.0
# The same for the contact coordinate.
_WIDE_FROM_AXIS: Final = 400.0
# The same for the distance from a pole of the slope.
_WIDE_AT_POLE: Final = 100.0
# The same for the contact coordinate beyond a break.
_WIDE_BEYOND_BREAK: Final = 2.5
# Below this multiple of the flat's radius the contact radius hardly changes: differences cancel.
_SHALLOW: Final = 1.5
# So far below a break, as a part of it, all functions are those of the panel that ends there.
_BELOW: Final = 1e-11
_EPS: Final = float(np.finfo(float).eps)


class Moments(NamedTuple):
    """Bernstein moments int (1-t)^2, int 2t(1-t) and int t^2 of |dy'|, t from 0 to 1 upwards."""

    span: Array
    """Length of each interval in the normal coordinate, shape (m,)."""
    weights: Array
    """The three moments of each interval, >= 0, shape (3, m)."""

    def joined(self, upper: "Moments") -> "Moments":
        """Return the moments over each interval and its upper neighbour together."""
        span = self.span + upper.span
        low, high = (part / np.where(span > 0, span, 1.0) for part in (self.span, upper.span))
        a, b = self.weights, upper.weights
        middle = a[2] + b[0]
        left, right = a[1] + high * middle, low * middle + b[1]
        weights = [a[0] + high * left, low * left + high * right, low * right + b[2]]
        return Moments(span, np.array(weights))

    def at(self, index: Indices | slice) -> "Moments":
        """Return the moments of some of the intervals."""
        return Moments(self.span[index], self.weights[:, index])


@dataclass(frozen=True)
class IntervalMoments:
    """Moments of one profile, over intervals of depth or of reduced force."""

    profile: Profile
    over_forces: bool
    """The normal coordinate is the reduced force [length^2], not the depth [length]."""

    @property
    def normal(self) -> Function:
        """Normal coordinate of a contact coordinate."""
        return self.profile.reduced_force if self.over_forces else self.profile.depth

    @property
    def conjugate(self) -> Function:
        """Conjugate of a contact coordinate."""
        return self.profile.depth if self.over_forces else self.profile.reduced_force

    def contact_coordinate(self, normal: Array) -> Array:
        """Contact coordinate of a normal coordinate, which rounding may put beyond the domain."""
        if self.profile.largest_loads is not None:
            normal = np.minimum(normal, self.profile.largest_loads[self.over_forces])
        return coordinate_from_load(self.profile, normal, of_force=self.over_forces)

    def over(self, low: Array, span: Array, ends: Array) -> Moments:
        """Return the moments over the intervals [low, low + span], shape (m,).

        Parameters
        ----------
        low, span : lower ends and lengths in the normal coordinate, shape (m,).
        ends : both ends in the contact coordinate, shape (2, m).

        The parameters of the profile may be arrays over the intervals.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            closed = self.profile.interval_moments(span, ends, over_forces=self.over_forces)
        if closed is not None:
            return Moments(span, np.where(span > 0, closed, 0.0))
        if low.size > _BLOCK:
            blocks = [slice(i, i + _BLOCK) for i in range(0, low.size, _BLOCK)]
            parts = [self._part(part).over(low[part], span[part], ends[:, part]) for part in blocks]
            return Moments(span, np.concatenate([part.weights for part in parts], axis=1))
        if not has_many_breaks(self.profile):
            return self._by_break(low, span, ends)
        breaks, normal_at_breaks = self._breaks
        first = np.searchsorted(normal_at_breaks, low, side="right")
        last = np.searchsorted(normal_at_breaks, low + span, side="left")
        base, crossed = np.append(0.0, breaks)[first], np.flatnonzero(last > first)
        start, stop, length = np.maximum(ends[0], base), ends[1].copy(), span.copy()
        low_break, high_break = first[crossed], last[crossed] - 1
        bottom, top = normal_at_breaks[[low_break, high_break]]
        stop[crossed] = breaks[low_break]
        length[crossed] = np.maximum(bottom - low[crossed], 0.0)
        rest = np.maximum(span[crossed] - length[crossed] - (top - bottom), 0.0)
        # The parts above the highest break are further cases.
        edge = breaks[high_break]
        above = [edge, np.maximum(ends[1][crossed], edge)]
        cases = np.append(low, top), np.append(length, rest), np.hstack([[start, stop], above])
        found = self.over_smooth(*cases, np.append(base, edge))
        lower, upper = found.at(slice(span.size)), found.at(slice(span.size, None))
        between = Moments(top - bottom, self._between[:, low_break, high_break])
        between = lower.at(crossed).joined(between)
        lower.weights[:, crossed] = between.joined(upper).weights
        return Moments(span, lower.weights)

    def _by_break(self, low: Array, span: Array, ends: Array) -> Moments:
        """Return the moments for a profile with one break at most, or one in each case."""
        if not self.profile.coordinate_breaks.size:
            return self.over_smooth(low, span, ends, np.zeros_like(span))
        base, _ = break_below(self.profile, ends[1])
        crossed = base > ends[0]
        if not some(crossed):
            return self.over_smooth(low, span, ends, base)
        # The parts below a break are further cases.
        below = np.flatnonzero(crossed)
        inside = np.maximum(_from_below(self.normal, base) - low, 0.0)
        part = np.where(crossed, np.minimum(inside, span), 0.0)
        found = self._part(np.append(np.arange(span.size), below)).over_smooth(
            np.append(low + part, low[below]),
            np.append(span - part, part[below]),
            np.hstack([[np.maximum(base, ends[0]), ends[1]], [ends[0][below], base[below]]]),
            np.append(base, np.zeros(below.size)),
        )
        upper, lower = found.at(slice(span.size)), found.at(slice(span.size, None))
        # The first moment is infinite on the axis where forces are prescribed.
        with np.errstate(invalid="ignore"):
            upper.weights[:, below] = lower.joined(upper.at(below)).weights
        return Moments(span, upper.weights)

    def mean_slope(self, low: Array, high: Array) -> Array:
        """Return the mean slope of the conjugate between two contact coordinates, low <= high.

        It has no cancellation, however near they are: errors of their difference hardly matter.
        """
        width = high - low
        steps = [step(self.profile, high, width, low) for step in (depth_step, force_step)]
        normal, conjugate = reversed(steps) if self.over_forces else steps
        twice = 2 * self.profile.contact_radius(high)
        apart = (width > 0) & (normal > 0)
        edge = 1 / twice if self.over_forces else twice
        return where(apart, conjugate / where(apart, normal, 1.0), edge)

    @cached_property
    def _breaks(self) -> tuple[Array, Array]:
        """Coordinates of the profile's breaks and their normal coordinates."""
        breaks = self.profile.coordinate_breaks
        breaks = breaks[breaks > self.profile.first_coordinate]
        # A break that no load reaches may have no normal coordinate in doubles.
        with np.errstate(over="ignore", invalid="ignore"):
            normal_at_breaks = _from_below(self.normal, breaks)
        return breaks, normal_at_breaks

    def _slope(self, s: Array) -> Array:
        """Derivative of the normal coordinate with respect to the contact coordinate."""
        return (self.profile.force_slope if self.over_forces else self.profile.depth_slope)(s)

    @cached_property
    def _between(self) -> Array:
        """Moments from each break to each later one, shape (3, k, k)."""
        breaks, normal = self._breaks
        ends, first = np.array([breaks[:-1], breaks[1:]]), np.arange(breaks.size)
        panels = self.over_smooth(normal[:-1], np.diff(normal), ends, ends[0])
        # The moments add up to the step of the slope 2a or 1/(2a). They scale with the length in
        # the normal coordinate, which has no digits on a flat.
        radius = self.profile.contact_radius(breaks)
        whole = 2 * np.diff(radius)
        whole = whole / (4 * radius[1:] * radius[:-1]) if self.over_forces else whole
        total = panels.weights.sum(axis=0)
        panels.weights[:] *= whole / np.where(total > 0, total, 1.0)
        table, found = np.zeros((3, breaks.size, breaks.size)), panels
        for step in range(1, breaks.size):
            table[:, first[:-step], first[step:]] = found.weights
            found = found.at(slice(None, -1)).joined(panels.at(slice(step, None)))
        return table

    def over_smooth(self, low: Array, span: Array, ends: Array, base: Array) -> Moments:
        """Return the moments over intervals without a break. Parameters: `over`, `over_narrow`."""
        profile, weights = self.profile, np.zeros((3, low.size))
        beyond, long = base > 0, span > 0
        limit = np.where(beyond, _WIDE_BEYOND_BREAK, _WIDE_FROM_AXIS)
        wide = (ends[1] > limit * ends[0]) | (~beyond & (low + span > _WIDE * low))
        start, stop = profile.pole - ends
        wide |= ~beyond & (start > _WIDE_AT_POLE * stop)
        if some(profile.first_radius > 0):
            shallow = profile.contact_radius(ends[1]) < _SHALLOW * profile.first_radius
            shallow &= ~beyond
            beyond, wide = beyond | shallow, wide & ~shallow
        closed, by_rule = wide & long, ~wide & long
        if every(by_rule):
            return Moments(span, self.over_narrow(span, ends, base, beyond))
        if some(closed):
            weights[:, closed] = self._part(closed).over_wide(span[closed], ends[:, closed])
        if some(by_rule):
            at = span[by_rule], ends[:, by_rule], base[by_rule], beyond[by_rule]
            weights[:, by_rule] = self._part(by_rule).over_narrow(*at)
        return Moments(span, weights)

    def _part(self, chosen: Flags | Indices | slice) -> "IntervalMoments":
        """The chosen cases of a sweep."""
        profile = self.profile
        if not profile.swept:
            return self
        part = {name: profile.parameters[name][chosen] for name in profile.swept}
        return IntervalMoments(profile.with_parameters(part), self.over_forces)

    def over_wide(self, span: Array, ends: Array) -> Array:
        """Return the moments over wide intervals, by parts, in closed form.

        Parameters
        ----------
        span : lengths of the intervals in the normal coordinate, shape (m,).
        ends : both ends in the contact coordinate, shape (2, m).
        """
        profile = self.profile
        twice = 2 * profile.contact_radius(ends)
        depth, force = profile.depth(ends), profile.reduced_force(ends)
        energy = profile.reduced_energy(ends)
        if self.over_forces:
            with np.errstate(divide="ignore"):
                slope = 1 / twice
            conjugate, integral, sign = depth, depth * force - energy, -1.0
        else:
            slope, conjugate, integral, sign = twice, force, energy, 1.0
        rise = (conjugate[1] - conjugate[0]) / span
        mean = ((integral[1] - integral[0]) / span - conjugate[0]) / span
        first, second = sign * (slope[1] - rise), sign * (slope[1] - 2 * (rise - mean))
        # The measure itself is infinite on the axis where forces are prescribed.
        whole = sign * (slope[1] - slope[0])
        return np.array([whole - 2 * first + second, 2 * (first - second), second])

    def over_narrow(self, span: Array, ends: Array, base: Array, beyond: Flags) -> Array:
        """Return the moments over narrow intervals, by Gauss' rule in the contact coordinate.

        Parameters
        ----------
        span, ends : see `over_wide`.
        base : contact coordinates of the breaks below, zero for none, shape (m,).
        beyond : True beyond a break or a flat's edge, where all is smooth in the root of the
            distance from `base`; elsewhere it is in the logarithm.
        """
        profile, (start, stop) = self.profile, ends
        width = stop - start
        thin = width * width < _EPS * stop * np.minimum(stop - base, profile.pole - stop)
        if some(thin):
            slope = self._slope(stop)
            # An interval may end where g becomes constant.
            slope = np.where(slope > 0, slope, self._slope(start))
            with np.errstate(divide="ignore"):
                estimate = span / slope
            width = np.where(thin & (estimate > 0), np.minimum(estimate, stop), width)
        share, weights, cumulative = cumulative_rule(_POINTS)
        place, moved = _in_logarithm(stop, width, share, np.where(beyond, 0.0, 1 / profile.pole))
        if some(beyond):
            root, climb = _in_root(stop - base, start - base, width, share)
            place = np.where(beyond, np.minimum(base + root * root, stop), place)
            moved = np.where(beyond, 2 * root * climb, moved)
            origin, past = np.where(beyond, base, place), np.where(beyond, root * root, 0.0)
            slope = profile.depth_slope_beyond(place, origin, past)
        else:
            slope = profile.depth_slope(place)
        rise, measure = moved * slope, weights * moved * profile.radius_slope(place)
        if self.over_forces:
            twice = 2 * profile.contact_radius(place)
            rise, measure = rise * twice, measure / np.square(twice)
        # Both scale with the width, which has fewer digits than the span.
        total = in_order(weights, rise)
        # The slope of g may underflow on a flat.
        total = np.where(total > 0, total, inf)
        t = in_order(cumulative, rise[:, None]) / total
        rest, parts = 1 - t, np.empty((share.size, 3, span.size))
        parts[:, 0], parts[:, 1], parts[:, 2] = rest * rest, 2 * t * rest, t * t
        return in_order(measure, parts) * (2 * span / total)


def interval_moments(profile: Profile, *, over_forces: bool) -> IntervalMoments:
    """Return the moments of a profile over intervals of depth, or of reduced force."""
    return (_of_table if has_many_breaks(profile) else IntervalMoments)(profile, over_forces)


# The sums between breaks take as long as a short history; those of 2000 points have 1 MB.
_of_table: Final = lru_cache(maxsize=16)(IntervalMoments)


def _from_below(function: Function, breaks: Array) -> Array:
    """Limit of a function from below: above, an infinite slope magnifies rounding errors."""
    near, far = function(np.multiply.outer([1 - _BELOW, 1 - 2 * _BELOW], breaks))
    return np.asarray(2 * near - far)


def _in_logarithm(
    stop: Array, width: Array, share: Array, per_pole: Parameter
) -> tuple[Array, Array]:
    """Return the places at parts `share` of intervals in log(s/(R - s)), and their derivatives.

    1/R = `per_pole`, zero for the logarithm of s.
    """
    ahead = 1 - stop * per_pole
    stretch = -np.log1p(-np.minimum(width / stop, 1 - _EPS)) + np.log1p(width * per_pole / ahead)
    place = stop / (ahead * np.exp(stretch * (1 - share)) + stop * per_pole)
    return place, place * (1 - place * per_pole) * stretch


def _in_root(top: Array, bottom: Array, width: Array, share: Array) -> tuple[Array, Array]:
    """Return roots of distances from a break, `top` and `bottom` at the ends, and derivatives."""
    high, low = (np.sqrt(np.maximum(distance, 0.0)) for distance in (top, bottom))
    climb = width / np.where(high > 0, high + low, inf)
    return low + climb * share, climb
