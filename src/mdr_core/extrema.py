"""Largest pressure and shear stress of a contact, searched where no closed form exists."""

from collections.abc import Callable
from functools import cache, lru_cache, partial
from math import inf, nan
from typing import Final

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from mdr_core.abel.annulus import Annulus, whole
from mdr_core.doubles import ADJACENT
from mdr_core.elementwise import every, full, in_blocks, number, some, where
from mdr_core.errors import InputError
from mdr_core.inversion import MAX_STEPS, invert
from mdr_core.profiles import (
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    SphericalTipCone,
    Tabulated,
)
from mdr_core.typing import Array, Flags, Indices
from mdr_core.validation import first_index, require_inside, require_not_negative

# Stress at radii, given as contact coordinates, under the loads of these indices; all (m,).
_Field = Callable[[Indices, Array], Array]

# Number of brackets between two singular radii, at both of which they cluster. The pressure under
# the power r^100 has the narrowest smooth peak, next to the contact edge.
_BRACKETS: Final = 8
# Relative variation of the stress in the last bracket.
_LEAST_STEP: Final = 1e-13
# Relative step of the derivative of a searched maximum, whose own error is about 1e-13.
_DIFFERENCE: Final = 1e-5
# Coordinate whose energy overflows on every profile without an end. The pressure under a blunt cone
# grows with the logarithm of the radius, so that a search would find no end.
_FARTHEST: Final = 1e150
LEAST_GAP: Final = 1e-13
"""1 - (r/a)^2 below which the infinite tension of adhesion is taken to be constant."""
# Points across the bracket of a peak, in parts of it. The same points sample each interval of a
# table, because its interpolation may have a peak in each.
_NINE: Final = np.linspace(0.0, 1.0, 9)
# a/R beyond which the flank of a spherical-tip cone adds the same pressure everywhere on the tip,
# with a relative error of (R/a)^2.
_FAR: Final = 1e8
# All contacts of rounded punches are similar. One spline serves them up to this absolute value of
# log(s/b); its number of places and its degree leave an error of 3e-15.
_CURVED, _PLACES, _DEGREE = 14.0, 600, 7


def largest_stress(
    profile: Profile, edge: Array, loaded: Flags, slip: tuple[Array, Array] | None = None
) -> Array:
    """Return the largest (1/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx of each contact [1].

    It is p/E* for c = 0 and |tau|/(mu E*) otherwise. The stress is infinite if [c, a] contains a
    sharp tip, a slope discontinuity or the edge of a flat punch, and zero without a load. Under a
    paraboloid it is (2/(pi R)) sqrt(a^2 - c^2), at r = c.

    Source: mdr-5, Eqs. (5.38), (5.68), (5.70).

    Parameters
    ----------
    profile : parameters broadcast with the loads.
    edge : contact radii a as contact coordinates, shape of the loads.
    loaded : True for loads that are not zero.
    slip : widths a - c of the slip annulus and stick radii c in the contact coordinate; None for
        c = 0.
    """
    if slip and isinstance(profile, Paraboloid):
        return 2 * np.sqrt(slip[0] * (edge + slip[1])) / (np.pi * profile.radius)
    infinite, known = _infinite(profile, edge, loaded, slip), full(nan, edge)
    if not slip:
        falls = profile.falls_from_axis(edge)
        if every(falls & ~infinite):
            return where(loaded, profile.axis_stress(edge), 0.0)
        known = _of_similar(profile, edge)
        if some(falls):
            known = where(falls, profile.axis_stress(edge), known)
    result = np.atleast_1d(where(infinite, inf, where(loaded, known, 0.0)))
    shape, unknown = loaded.shape, np.isnan(result)
    parts = [np.broadcast_to(part, result.shape) for part in (edge, *(slip or ()))]
    if not profile.swept:
        result[unknown] = _search(profile, *(part[unknown] for part in parts))
        return result.reshape(shape)[()]
    named = {name: np.broadcast_to(value, shape) for name, value in profile.parameters.items()}
    for place in zip(*np.nonzero(unknown), strict=True):
        one = profile.with_parameters({name: float(value[place]) for name, value in named.items()})
        result[place] = _search(one, *(part[place][None] for part in parts))[0]
    return result.reshape(shape)[()]


def _of_similar(profile: Profile, edge: Array) -> Array:
    """Largest pressure over E* of kinds whose contacts are similar [1], NaN where unknown."""
    if isinstance(profile, Power):
        # The stress over the slope g' depends on the exponent alone.
        exponent = where(profile.exponent > 1, number(1.0) * profile.exponent, 2.0)
        return np.vectorize(_over_slope, otypes=[float])(exponent)[()] * profile.dg(edge)
    if isinstance(profile, RoundedPunch):
        with np.errstate(divide="ignore", invalid="ignore"):
            _, s = profile.flank(edge)
            height = _curve()(np.log(s / profile.flat_radius), extrapolate=False)[()]
            return height * profile.depth(edge) / s
    if isinstance(profile, SphericalTipCone):
        far = edge > _FAR * profile.tip_radius
        if some(far):
            excess = np.vectorize(_over_axis, otypes=[float])(profile.slope)
            return where(far, profile.axis_stress(edge) + excess, nan)
    return full(nan, edge)


def pressure_and_slope(profile: Profile, edge: Array) -> tuple[Array, Array]:
    """Return the largest pressure over E* and its logarithmic derivative in the edge.

    Parameters: see `largest_stress`.
    """
    ends = edge, edge * (1 - _DIFFERENCE)
    stress, below = (largest_stress(profile, end, end > 0) for end in ends)
    return stress, np.log(stress / below) / -np.log1p(-_DIFFERENCE)


def coordinate_from_pressure(profile: Profile, target: Array) -> Array:
    """Return the contact coordinate at which the largest pressure over E* has a value.

    Raises InputError for a table, whose points do not determine the pressure, for a pressure that
    is infinite under any load, and for one that no contact within the profile has.
    """
    path = ("load", "maximum_pressure")
    require_not_negative(path, target)
    infinite = number(inf)
    for radius in profile.infinite_pressure_radii:
        infinite = np.minimum(infinite, radius)
    if isinstance(profile, Tabulated) or some(infinite <= profile.first_radius):
        reason = "infinite under any load, or not determined by the points of a table"
        raise InputError(path, f"is {reason}: give another load, or a profile that is smooth")
    end = np.minimum(infinite, profile.domain)
    farthest = where(end < inf, end * (1 - ADJACENT), _FARTHEST)
    last = full(profile.coordinate_from_radius(farthest), target)
    # The largest pressure is at least the mean pressure.
    beyond = ~(target <= profile.reduced_force(last) / (np.pi * farthest * farthest))
    if some(beyond):
        largest = largest_stress(profile, last, last > 0)
        beyond = target > largest
        require_inside(path, beyond & (end < inf) & (end == profile.domain), profile)
    if some(beyond):
        index = first_index(beyond)
        most, radius = (np.broadcast_to(each, beyond.shape)[index] for each in (largest, infinite))
        cause = f"up to radius {_FARTHEST} it is at most {most:.3g} E*: check the units"
        if radius < inf:
            cause = f"at radius {radius:.12g} it is infinite"
        raise InputError((*path, *index), f"no contact has it: {cause}", beyond)
    # The search of a profile without an end begins at its own scale.
    middle = where(end < inf, last / 2, profile.scale)
    start, low = (full(each, target) for each in (middle, 0.0))
    return invert(partial(pressure_and_slope, profile), target, start, low, last)


def largest_with(profile: Profile, edge: Array, loaded: Flags, added: _Field) -> Array:
    """Return the largest sum of the stress and of another field, each of a contact [1].

    The other field must fall from the axis wherever the stress is known to. Within a flat, the sum
    must be largest on the axis or at the edge.

    Parameters
    ----------
    profile, edge, loaded : see `largest_stress`.
    added : the field, finite, of indices of loads and radii.
    """
    ends, pressed = np.atleast_1d(edge), np.atleast_1d(loaded)
    infinite = _infinite(profile, ends, pressed)
    largest = added(np.arange(ends.size), np.zeros(ends.size))
    largest[infinite], finite = inf, pressed & ~infinite
    if finite.any():
        largest[finite] += profile.axis_stress(ends[finite])
    found = np.flatnonzero(finite & ~profile.falls_from_axis(ends))
    if found.size:
        others = _search(profile, ends[found], added=lambda i, r: added(found[i], r))
        largest[found] = np.maximum(largest[found], others)
    return largest.reshape(np.shape(edge))[()]


def _infinite(
    profile: Profile, edge: Array, loaded: Flags, slip: tuple[Array, Array] | None = None
) -> Flags:
    """True where the stress is infinite. Parameters: see `largest_stress`."""
    a, c = profile.contact_radius(edge), profile.contact_radius(slip[1]) if slip else 0.0
    infinite = loaded & False
    for b in profile.infinite_pressure_radii:
        begins = c <= b
        if slip and not profile.is_flat_punch:
            # A radius just beyond a flat may round to the radius of the flat.
            begins = where(b == profile.first_radius, slip[1] <= 0, begins)
        infinite = infinite | (loaded & begins & (b <= a))
    return infinite


@lru_cache(maxsize=1024)
def _over_slope(exponent: float) -> float:
    """Largest pressure under a power, over E* g'(a), for an exponent > 1."""
    unit = Power(1.0, exponent)
    return float(_search(unit, np.ones(1))[0] / unit.dg(np.ones(1))[0])


@lru_cache(maxsize=1024)
def _over_axis(slope: float) -> float:
    """Largest pressure less the pressure on the axis, over E*, far beyond a spherical tip [1]."""
    unit, edge = SphericalTipCone(slope, 1.0), np.array([_FAR])
    return float(_search(unit, edge)[0] - unit.axis_stress(edge)[0])


@cache
def _curve() -> BSpline:
    """Largest pressure of all rounded punches, times s/(d E*), over log(s/b)."""
    unit, places = RoundedPunch(1.0, 1.0), np.linspace(-_CURVED, _CURVED, _PLACES)
    s = np.exp(places)
    edge = s * s / (1 + np.hypot(1, s))
    return make_interp_spline(places, _search(unit, edge) * s / unit.depth(edge), k=_DEGREE)


def _search(profile: Profile, edge: Array, *slip: Array, added: _Field | None = None) -> Array:
    """The largest stress of contacts with one profile, where it is finite; shape (loads,).

    The brackets lie between the singular radii, at which they cluster.
    """
    c = [profile.contact_radius(part) for part in slip[1:]]

    def field(load: Indices, at: Array) -> Array:
        outer, annulus = edge[load], whole(edge[load])
        if slip:
            annulus = Annulus(outer, slip[0][load], c[0][load], coordinate=slip[1][load])
        stress = profile.pressure_kernel_at(annulus, at)
        return stress if added is None else stress + added(load, profile.contact_radius(at))

    best = np.full(edge.size, -inf)
    fixed = np.append(0.0, profile.coordinate_breaks)
    count = max(_BRACKETS // max(fixed.size - 1, 1), 1)
    for block in in_blocks(edge.size, fixed.size * count * _NINE.size):
        load = np.arange(edge.size)[block]
        same = np.broadcast_to(fixed, (load.size, fixed.size))
        stops = np.concatenate([same, *(part[load, None] for part in (edge, *slip[1:]))], axis=1)
        stops = np.sort(np.clip(stops, fixed[0], edge[load, None]), axis=1)
        shares = (1 - np.cos(np.pi * np.arange(count + 1) / count)) / 2
        ends = np.minimum(
            stops[:, :-1, None] + np.diff(stops)[..., None] * shares, stops[:, 1:, None]
        )
        row, *place = np.nonzero(np.diff(ends) > 0)
        low, high = (part[row, *place] for part in (ends[..., :-1], ends[..., 1:]))
        _refine(field, load[row], low, high, best)
    return best


def _refine(field: _Field, load: Indices, low: Array, high: Array, best: Array) -> None:
    """Zoom into each bracket around its highest point, and write the top of its peak to `best`.

    A bracket is the index of its load, and both ends in the contact coordinate, all of shape (k,).
    The peak is assumed to exceed the highest of the nine points by at most as much as that point
    exceeds the lowest. A bracket whose peak must stay below `best` is dropped. In the last bracket
    the stress or the place varies by rounding errors, on the axis relative to the first bracket.
    """
    first = high
    for _ in range(MAX_STEPS):
        at = np.clip(low[:, None] + (high - low)[:, None] * _NINE, low[:, None], high[:, None])
        values = field(np.repeat(load, _NINE.size), at.ravel()).reshape(at.shape)
        rows, place = np.arange(load.size), values.argmax(axis=1)
        top = values[rows, place]
        np.maximum.at(best, load, top)
        rise = top - values.min(axis=1)
        before, after = np.maximum(place - 1, 0), np.minimum(place + 1, _NINE.size - 1)
        low, high = at[rows, before], at[rows, after]
        left = (rise > _LEAST_STEP * np.abs(top)) & (top + rise > best[load])
        left &= high - low > ADJACENT * where(low > 0, high, first)
        if not left.any():
            break
        load, low, high, first = load[left], low[left], high[left], first[left]
