"""Largest pressure and shear stress of a contact, searched where no closed form exists."""

from collections.abc import Callable
from functools import cache
from math import comb, inf
from typing import Any, Final

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import BPoly

from mdr_core.abel.annulus import Annulus, InnerEnd
from mdr_core.elementwise import every, full, is_number, some, where
from mdr_core.profiles import Paraboloid, Profile, RoundedPunch
from mdr_core.typing import Array, Flags, Indices

# A stress at a radius, given as a contact coordinate, under the load of that index; all (m,).
_Field = Callable[[Indices, Array], Array]

# Relative accuracy of the stress: that of closed forms, whatever the tolerance of the query.
_RTOL: Final = 1e-13
# Samples between two singular radii, clustered at both. The pressure under the power r^100 has the
# narrowest smooth peak, next to the contact edge: four samples lie above half its height.
_SAMPLES: Final = 64
# Samples in each interval of a table, whose interpolation may have a peak in every one.
_FEWEST: Final = 6
# Nodes of the polynomial through a stress around its peak.
_NODES: Final = 9
# Intervals in which the highest point of that polynomial is searched.
_FINE: Final = 128
# Factor by which a round narrows the bracket of a smooth peak: two rounds reach rounding error.
_NARROWER: Final = 16.0
# Factor by which the bracket widens next to a discontinuity of the curvature, where the polynomial
# misses the peak.
_WIDER: Final = 4.0
# Bound on the number of rounds.
_ROUNDS: Final = 12
# Part of a polynomial's height up to which its last two coefficients are those of a series that has
# converged to rounding error: they fall by more than a factor of five each.
_CONVERGED: Final = 1e-12
# Relative change that ends the search, a few units in the last place.
_SETTLED: Final = 4 * float(np.finfo(float).eps)
# Size of log(s/b) up to which one curve of Bernstein polynomials serves all rounded punches, whose
# contacts are similar; number and degree of the polynomials, which leave 2e-14.
_CURVED, _PIECES, _DEGREE = 14.0, 28, 16
# Samples evaluated at once, so that temporaries stay in the processor's cache.
_BLOCK: Final = 65_536


# Intervals of the contact coordinate that may hold the highest peak of a load: the load, both ends
# and the stress at a point inside, all (k,).
_Brackets = tuple[Indices, Array, Array, Array]


def largest_stress(
    profile: Profile, edge: Array, loaded: Flags, slip: tuple[Array, Array] | None = None
) -> Array:
    """Return the largest (1/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx of each contact [1].

    It is p/E* for c = 0 and |tau|/(mu E*) otherwise. Infinite where [c, a] holds a sharp tip, a
    slope discontinuity or the edge of a flat punch; zero without a load. Under a paraboloid it is
    (2/(pi R)) sqrt(a^2 - c^2), at r = c.

    Source: mdr-5, Eqs. (5.38), (5.68), (5.70).

    Parameters
    ----------
    profile : parameters broadcast with the loads.
    edge : contact radii a as contact coordinates, shape of the loads.
    loaded : loads that are not zero.
    slip : widths a - c of the slip annulus and stick radii c in the contact coordinate; None for
        c = 0.
    """
    if isinstance(profile, Paraboloid):
        root = edge if slip is None else np.sqrt(slip[0] * (edge + slip[1]))
        return 2 * root / (np.pi * profile.radius)
    shape = loaded.shape
    a, c = profile.contact_radius(edge), profile.contact_radius(slip[1]) if slip else 0.0
    infinite = loaded & False
    for b in profile.infinite_pressure_radii:
        begins = c <= b
        if slip and not profile.has_no_partial_slip:
            # A radius just beyond a flat may round to that of the flat.
            begins = where(b == profile.first_radius, slip[1] <= profile.first_coordinate, begins)
        infinite = infinite | (loaded & begins & (b <= a))
    unknown, result = loaded & ~infinite, where(infinite, inf, full(0.0, edge))
    if isinstance(profile, RoundedPunch) and slip is None:
        on_curve = _on_curve(profile, edge)
        known = unknown & np.isfinite(on_curve)
        unknown, result = unknown & ~known, where(known, on_curve, result)
    if not some(unknown):
        return result
    if is_number(edge):
        return _largest(profile, edge, *(slip or ()))
    finite, result = np.atleast_1d(unknown), np.atleast_1d(result)
    parts = [np.broadcast_to(part, finite.shape) for part in (edge, *(slip or ()))]
    if not profile.swept:
        result[finite] = _largest(profile, *(part[finite] for part in parts))
        return result.reshape(shape)
    named = {name: np.broadcast_to(value, shape) for name, value in profile.parameters.items()}
    for place in zip(*np.nonzero(finite), strict=True):
        one = profile.with_parameters({name: float(value[place]) for name, value in named.items()})
        result[place] = _largest(one, *(part[place][None] for part in parts))[0]
    return result


def _largest(profile: Profile, edge: Array, *slip: Array) -> Array:
    """The largest stress of contacts with one profile, where it is finite; shape of `edge`."""
    if not slip:
        at_axis = profile.falls_from_axis(edge)
        if every(at_axis):
            return profile.axis_stress(edge, _RTOL)
        if some(at_axis):
            result = np.empty_like(edge)
            result[at_axis] = profile.axis_stress(edge[at_axis], _RTOL)
            result[~at_axis] = _search(profile, edge[~at_axis])
            return result
    return _search(profile, *map(np.atleast_1d, (edge, *slip))).reshape(edge.shape)[()]


def _on_curve(profile: RoundedPunch, edge: Array) -> Array:
    """The largest pressure over E* under rounded punches [1], NaN beyond the curve."""
    with np.errstate(divide="ignore", invalid="ignore"):
        height = _curve()(np.log(edge / profile.flat_radius))[()]
        return height * profile.depth(edge) / edge


@cache
def _curve() -> BPoly:
    """Largest pressure of all rounded punches, times s/(d E*), over log(s/b)."""
    unit = RoundedPunch(1.0, 1.0)
    share = _clustered(_DEGREE)
    ends = np.linspace(-_CURVED, _CURVED, _PIECES + 1)
    edge = np.exp(ends[:-1] + np.diff(ends) * share[:, None])
    height = _search(unit, edge.ravel()).reshape(edge.shape) * edge / unit.depth(edge)
    basis = [comb(_DEGREE, k) * share**k * (1 - share) ** (_DEGREE - k) for k in range(_DEGREE + 1)]
    return BPoly(np.linalg.solve(np.transpose(basis), height), ends, extrapolate=False)


def _search(profile: Profile, edge: Array, *slip: Array) -> Array:
    """The largest stress of contacts with one profile, where it is finite; shape (loads,).

    The stress is sampled between its singular radii. Every candidate for the highest peak is then
    refined by polynomial interpolation.
    """
    c = [profile.contact_radius(part) for part in slip[1:]]

    def field(load: Indices, at: Array) -> Array:
        inner = InnerEnd(slip[0][load], c[0][load], slip[1][load]) if slip else None
        return profile.pressure_kernel_at(Annulus(edge[load], inner), at, _RTOL)

    best = np.zeros(edge.size)
    fixed = np.append(profile.first_coordinate, profile.coordinate_breaks)
    count = max(_SAMPLES // max(fixed.size - 1, 1), _FEWEST)
    step = max(_BLOCK // (fixed.size * count), 1)
    for start in range(0, edge.size, step):
        load = np.arange(start, min(start + step, edge.size))
        same = np.broadcast_to(fixed, (load.size, fixed.size))
        stops = np.concatenate([same, *(part[load, None] for part in (edge, *slip[1:]))], axis=1)
        stops = np.sort(_within(stops, fixed[0], edge[load, None]), axis=1)
        _refine(field, _sampled(field, load, _between(stops, count), best), best)
    return best


def _clustered(count: int) -> Array:
    """Points of [0, 1] that divide it into `count` intervals and cluster at both ends."""
    return np.asarray((1 - np.cos(np.pi * np.arange(count + 1) / count)) / 2)


def _between(stops: Array, count: int) -> Array:
    """Samples of each load between its stops, at which they cluster; shape (loads, m)."""
    samples = stops[:, :-1, None] + np.diff(stops)[..., None] * _clustered(count)[:-1]
    return np.concatenate([samples.reshape(len(stops), -1), stops[:, -1:]], axis=1)


def _sampled(field: _Field, load: Indices, samples: Array, best: Array) -> _Brackets:
    """Brackets around the samples that rise above the others, whose largest value goes to `best`.

    Between its neighbours a peak is taken to exceed the sample by no more than the sample exceeds
    the lower one of them.
    """
    values = field(np.repeat(load, samples.shape[1]), samples.ravel()).reshape(samples.shape)
    best[load] = values.max(axis=1)
    before = np.concatenate([values[:, :1], values[:, :-1]], axis=1)
    after = np.concatenate([values[:, 1:], values[:, -1:]], axis=1)
    reach = 2 * values - np.minimum(before, after)
    peak = (values >= before) & (values >= after) & (values > 0)
    row, at = np.nonzero(peak & (reach >= best[load][:, None]))
    last = samples.shape[1] - 1
    ends = samples[row, np.maximum(at - 1, 0)], samples[row, np.minimum(at + 1, last)]
    return load[row], *ends, values[row, at]


def _refine(field: _Field, brackets: _Brackets, best: Array) -> None:
    """Refine each peak to its top, whose value goes to `best`.

    `outer` brackets the top; [low, high] is the part of it around the top of a polynomial.
    """
    load, low, high, sample = brackets
    outer, highest, peak = np.array([low, high]), low, np.zeros(load.size)
    for _ in range(_ROUNDS):
        rows, middle, half = np.arange(load.size), (low + high) / 2, (high - low) / 2
        at = _within(middle[:, None] + half[:, None] * _LOBATTO, low[:, None], high[:, None])
        values = field(np.repeat(load, _NODES), at.ravel()).reshape(at.shape)
        place = np.argmax(values, axis=1)
        rises = values[rows, place] >= peak
        peak = np.where(rises, values[rows, place], peak)
        highest = np.where(rises, at[rows, place], highest)
        np.maximum.at(best, load, peak)
        # The top lies between the points on either side of the highest one.
        below, above = at < highest[:, None], at > highest[:, None]
        outer[0] = np.where(below, at, outer[0][:, None]).max(axis=1)
        outer[1] = np.where(above, at, outer[1][:, None]).min(axis=1)
        series = values @ _TO_SERIES.T
        top, height = _vertex(series)
        top = middle + half * top
        # Else it lies beyond the nodes, or the polynomial is no approximation yet.
        inside = (low <= outer[0]) & (outer[1] <= high) & (outer[0] <= top) & (top <= outer[1])
        converged = inside & (np.abs(series[:, -2:]).sum(axis=1) <= _CONVERGED * height)
        np.maximum.at(best, load[converged], height[converged])
        centre = np.where(inside, top, highest)
        reach = half * np.where(inside, 1 / _NARROWER, _WIDER)
        low, high = _within(centre - reach, *outer), _within(centre + reach, *outer)
        left = ~inside | (peak < sample) | (height > best[load] * (1 + _SETTLED))
        if not left.any():
            break
        load, low, high, sample = load[left], low[left], high[left], sample[left]
        outer, highest, peak = outer[:, left], highest[left], peak[left]


def _vertex(series: Array) -> tuple[Array, Array]:
    """Place in [-1, 1] and height of the highest point of each Chebyshev series."""
    curve = series @ _FINE_GRID.T
    rows, at = np.arange(len(curve)), _within(np.argmax(curve, axis=1), 1, _FINE - 1)
    before, highest, after = (curve[rows, at + step] for step in (-1, 0, 1))
    bend = 2 * highest - before - after
    with np.errstate(divide="ignore", invalid="ignore"):
        offset = np.where(bend > 0, (after - before) / (2 * bend), 0.0)
    top = (at + _within(offset, -1.0, 1.0)) * (2 / _FINE) - 1
    angle = np.multiply.outer(np.arccos(_within(top, -1.0, 1.0)), np.arange(_NODES))
    return top, (series * np.cos(angle)).sum(axis=1)


def _within(values: Any, low: Any, high: Any) -> Any:
    """Values clipped to an interval; NumPy's own function takes four times as long for a few."""
    return np.minimum(np.maximum(values, low), high)


_LOBATTO: Final = -np.cos(np.pi * np.arange(_NODES) / (_NODES - 1))
# From values at the nodes to the coefficients of the polynomial, and from these to its values at
# evenly spaced points of [-1, 1].
_TO_SERIES: Final = np.linalg.inv(chebyshev.chebvander(_LOBATTO, _NODES - 1))
_FINE_GRID: Final = chebyshev.chebvander(np.linspace(-1, 1, _FINE + 1), _NODES - 1)
