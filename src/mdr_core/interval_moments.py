"""Moments of the conjugate's slope over intervals of the normal coordinate.

The normal coordinate n of a contact is its depth d, where displacements are prescribed, or its
reduced force I = F_N/E*, where forces are prescribed. The other one is its conjugate y. From dI = 2
a dd the slope y' = dy/dn is 2a or 1/(2a): it is monotonic, so |dy'| is a positive measure. Over
depths it counts the foundation springs, 2 dx, that come into contact.

Steps of the conjugate and all energies of a load history are integrals of polynomials of degree
0 to 2 over this measure. Computed from the three moments below, they are free of cancellation for
every interval and amplitude. Source: notes, §6 and §10.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf
from typing import Final, NamedTuple

import numpy as np

from mdr_core.doubles import EPS, TINY
from mdr_core.elementwise import in_blocks, in_order, quotient, some, where
from mdr_core.equivalent_1d import break_below, depth_step, force_step, has_many_breaks
from mdr_core.inversion import Function
from mdr_core.profiles import Profile
from mdr_core.quadrature import NODES, cumulative_rule
from mdr_core.typing import Array, Flags, Indices

# An interval is wide if the normal coordinate grows on it by more than the first factor, or the
# contact radius by more than the second. Beyond a break the third factor applies to the radius.
# Differences of closed forms over a wide interval hardly suffer cancellation. The steps of the rule
# resolve a pole from which the distance changes by more than the second factor.
_WIDE_IN_NORMAL, _WIDE, _WIDE_BEYOND_BREAK = 16.0, 3.0, 1.3


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
    """True if the normal coordinate is the reduced force [length^2], false for the depth
    [length]."""

    @property
    def normal(self) -> Function:
        """Normal coordinate of a contact coordinate."""
        return self.profile.reduced_force if self.over_forces else self.profile.depth

    def conjugate(self, normal: Array, coordinate: Array) -> Array:
        """Conjugate of a normal coordinate, given with its contact coordinate."""
        profile = self.profile
        found = (profile.depth if self.over_forces else profile.reduced_force)(coordinate)
        if not profile.coordinate_breaks.size:
            return found
        # Just beyond a break the normal coordinates of neighbouring doubles are far apart.
        rest, twice = normal - self.normal(coordinate), 2 * profile.contact_radius(coordinate)
        return found + (quotient(rest, twice) if self.over_forces else rest * twice)

    def contact_coordinate(self, normal: Array) -> Array:
        """Contact coordinate of a normal coordinate; rounding may put it just beyond the domain."""
        normal = np.minimum(normal, self.profile.largest_loads[self.over_forces])
        found = self.profile.coordinate_from_load(normal, of_force=self.over_forces)
        if not has_many_breaks(self.profile):
            return found
        # Beyond a break of a table g' may be many orders of magnitude larger than below, so that
        # the normal coordinate decides on which side of the break a rounded place lies.
        at_breaks, least, most = self._pieces
        index = at_breaks.searchsorted(normal)
        return np.clip(found, least[index], most[index])

    @cached_property
    def _pieces(self) -> tuple[Array, Array, Array]:
        """Normal coordinates of the breaks, and the ends of the pieces between them."""
        breaks = self.profile.coordinate_breaks
        least = np.append(0.0, np.nextafter(breaks, inf))
        return self.normal(breaks), least, np.append(breaks, inf)

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
        if not self.profile.swept:
            # Identical cycles repeat their intervals.
            key, first, index = np.unique(low + 1j * span, return_index=True, return_inverse=True)
            if 2 * key.size < low.size:
                different = self.over(low[first], span[first], ends[:, first])
                return Moments(span, different.weights[:, index])
        if len(several := in_blocks(low.size, NODES)) > 1:
            parts = [self.part(at).over(low[at], span[at], ends[:, at]) for at in several]
            return Moments(span, np.concatenate([part.weights for part in parts], axis=1))
        base, _ = break_below(self.profile, ends[1])
        crossed, weights = base > ends[0], np.empty((3, span.size))
        if not some(crossed):
            return Moments(span, self.over_smooth(low, span, ends, base))
        for chosen, over in (
            (crossed, IntervalMoments._over_breaks),
            (~crossed, IntervalMoments.over_smooth),
        ):
            cases = low[chosen], span[chosen], ends[:, chosen], base[chosen]
            weights[:, chosen] = over(self.part(chosen), *cases)
        return Moments(span, weights)

    def _over_breaks(self, low: Array, span: Array, ends: Array, top: Array) -> Array:
        """Return the moments over intervals that contain breaks, the highest of which is `top`."""
        bottom, between = top, np.zeros((3, span.size))
        if has_many_breaks(self.profile):
            breaks = self.profile.coordinate_breaks
            first, last = breaks.searchsorted(ends[0], side="right"), breaks.searchsorted(top)
            bottom, between = breaks[first], self._between[:, first, last]
        start, stop = self.normal(np.array([bottom, top]))
        length = np.clip(start - low, 0.0, span)
        rest = np.maximum(span - length - (stop - start), 0.0)
        below, _ = break_below(self.profile, bottom)
        lower = self.over_smooth(low, length, np.array([ends[0], bottom]), below)
        upper = self.over_smooth(stop, rest, np.array([top, ends[1]]), top)
        # The first moment is infinite on the axis where forces are prescribed.
        with np.errstate(invalid="ignore"):
            inner = Moments(length, lower).joined(Moments(stop - start, between))
            return inner.joined(Moments(rest, upper)).weights

    def mean_slope(self, low: Array, high: Array) -> Array:
        """Return the mean slope of the conjugate between two contact coordinates, low <= high.

        It is free of cancellation at every distance, and insensitive to errors of the distance.
        """
        width = high - low
        steps = [step(self.profile, high, width, low) for step in (depth_step, force_step)]
        normal, conjugate = reversed(steps) if self.over_forces else steps
        twice = 2 * self.profile.contact_radius(high)
        apart = (width > 0) & (normal > 0)
        edge = 1 / twice if self.over_forces else twice
        return where(apart, conjugate / where(apart, normal, 1.0), edge)

    @cached_property
    def _between(self) -> Array:
        """Moments from each break to each later break, shape (3, k, k)."""
        breaks = self.profile.coordinate_breaks
        normal, ends = self.normal(breaks), np.array([breaks[:-1], breaks[1:]])
        span, first = np.diff(normal), np.arange(breaks.size)
        panels = Moments(span, self.over_smooth(normal[:-1], span, ends, ends[0]))
        # The moments add up to the change of the slope, 2a or 1/(2a). Scaling ensures this, because
        # on a flat the length in the normal coordinate is dominated by rounding error.
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

    def over_smooth(self, low: Array, span: Array, ends: Array, base: Array) -> Array:
        """Return the moments over intervals without a break. Parameters: `over`, `over_narrow`."""
        profile, weights, long = self.profile, np.zeros((3, low.size)), span > 0
        grows = low + span > _WIDE_IN_NORMAL * low
        # Next to a flat the contact radius hardly changes while the normal coordinate grows.
        grows &= (base == 0) & (profile.first_radius == 0)
        radius = profile.contact_radius(ends)
        # On the pieces of a table the slope is a polynomial.
        beyond = _WIDE if has_many_breaks(profile) else _WIDE_BEYOND_BREAK
        wide = grows | (radius[1] > np.where(base > 0, beyond, _WIDE) * radius[0])
        closed, by_rule = wide & long, ~wide & long
        if some(closed):
            weights[:, closed] = self.part(closed).over_wide(span[closed], ends[:, closed])
        if some(by_rule):
            at = span[by_rule], ends[:, by_rule], base[by_rule]
            weights[:, by_rule] = self.part(by_rule).over_narrow(*at)
        return weights

    def part(self, chosen: Flags | Indices | slice) -> "IntervalMoments":
        """Return the moments of the chosen cases of a sweep."""
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

    def over_narrow(self, span: Array, ends: Array, base: Array) -> Array:
        """Return the moments over narrow intervals, by Gauss' rule in the contact coordinate.

        Parameters
        ----------
        span, ends : see `over_wide`.
        base : contact coordinates of the breaks below, zero for none, shape (m,); the integrands
            are smooth in the root of the distance from the break.
        """
        profile, (start, stop) = self.profile, ends
        # The moments do not depend on the width in the contact coordinate, which may be below
        # rounding error.
        width = np.maximum(stop - start, EPS * stop)
        share, weights, cumulative = cumulative_rule(NODES)
        high, bottom = np.sqrt(stop - base), np.sqrt(np.maximum(start - base, 0.0))
        climb = width / np.where(high > 0, high + bottom, inf)
        # The steps resolve a singularity on the other side of the break: the distance from it grows
        # by a constant factor. Far from a singularity the steps are equal.
        opposite = profile.opposite_singularity / np.sqrt(2 * np.where(base > 0, base, TINY))
        near = bottom + np.minimum(opposite, np.maximum(high, TINY) / EPS)
        growth = np.log1p(climb / near)
        step = near * np.expm1(growth * share)
        root = bottom + step
        past, moved = root * root, 2 * root * growth * (near + step)
        farthest, nearest = profile.pole - ends
        if some(graded := (base == 0) & (farthest > _WIDE * nearest)):
            # Next to a pole its distance shrinks by a constant factor instead.
            growth = np.log(np.where(graded, farthest, 1.0) / np.where(graded, nearest, 1.0))
            distance = farthest * np.exp(-growth * share)
            past = np.where(graded, profile.pole - base - distance, past)
            moved = np.where(graded, growth * distance, moved)
        place = np.minimum(base + past, stop)
        slope = profile.depth_slope_beyond(place, base, past)
        # Rounding may put nodes of narrow intervals on a break, next to which g' may be infinite.
        slope = np.where(slope < inf, slope, slope.min(axis=0))
        rise, measure = moved * slope, weights * moved
        if self.over_forces:
            twice = 2 * profile.contact_radius(place)
            rise, measure = rise * twice, measure / np.square(twice)
        # Rise and measure are proportional to the width; the more accurate span replaces it.
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


# The sums between breaks are cached: they take as long as a short history, and 1 MB for 2000
# points.
_of_table: Final = lru_cache(maxsize=16)(IntervalMoments)
