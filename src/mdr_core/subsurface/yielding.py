"""Largest stress of a contact, the load at which yield begins, and the loads beyond it.

Source: notes, §12; johnson, section 4.2.
"""

from collections.abc import Callable
from functools import cache, lru_cache
from math import ceil, cos, exp, inf, log, sin
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter

from mdr_core import normal, tangential
from mdr_core.doubles import EPS, TINY
from mdr_core.elementwise import number
from mdr_core.errors import AccuracyError, DefectError, InputError
from mdr_core.fields import graded
from mdr_core.half_space import ASSUMED_RATIO
from mdr_core.history import LoadHistory
from mdr_core.inversion import MAX_STEPS
from mdr_core.profiles import Power, Profile
from mdr_core.profiles.powers import PowerLaw
from mdr_core.subsurface.foundation import Contact, Foundation, foundations
from mdr_core.subsurface.stress import MOMENT_ERROR, on_rings
from mdr_core.typing import Array, Indices
from mdr_core.validation import require_poissons_ratio, require_single_positive, require_type
from mdr_core.validity import Finding, infinite_deviator

# Radii, and depths per e-fold, of a grid. The radii cluster at the axis, the edges and the breaks;
# the depths lie between these parts of the contact radius.
_RADII, _PER_E_FOLD, _SHALLOWEST, _DEEPEST = 24, 2, 1e-4, 2.0
# Points of the spline per point of the grid; part of the highest stress above which its peaks are
# refined.
_FINER, _ALMOST = 4, 0.8
# Directions of the grid if there is friction: it may lift a peak out of the plane y = 0.
_ANGLES: Final = np.linspace(0, np.pi / 2, 4)
# Points across a box around a peak, and half of the first box in steps of the spline.
_ACROSS, _STEPS = np.linspace(-1, 1, 5), 3.0
# Factor by which a box shrinks, and part of the stress by which it varies in the last one.
_SHRINK, _FLAT = 0.3, 4e-6
# Relative accuracy of the force at the onset of yield, which bounds the product of its last two
# steps. It is also the distance from forces of singular stresses, and the step of the first slope.
_RTOL: Final = 1e-6
# Contact coordinate over the radius of a flat below which no radius in double precision resolves
# the stress beneath the edge: at this one it is too low by 5e-6 of its value.
_RESOLVED: Final = 5e-13
# Largest logarithm of a ratio of forces or of stresses in the search for the onset, from which the
# least slope follows.
_REACH: Final = 60.0

MEASURES: Final = ("von_mises", "maximum_shear")

_Loaded: TypeAlias = normal.NormalContact | tangential.TangentialContact


class Peak(NamedTuple):
    """Largest stress under each load [pressure], and its place [length]; shape of the loads.

    y >= 0, as the field is symmetric. An infinite stress lies at a radius of infinite pressure.
    """

    value: Array
    x: Array
    y: Array
    z: Array


def largest(
    contact: Contact, measure: str = "von_mises", *, poissons_ratio: float, body: int = 1
) -> Peak:
    """Return the largest von Mises or shear stress in a body under each load, and its place.

    Its relative accuracy is about 1e-5. Source: notes, §12.

    Parameters
    ----------
    measure : "von_mises" or "maximum_shear".
    contact, poissons_ratio, body : see `stress`.

    Raises
    ------
    InputError : an unknown measure or body, or a Poisson's ratio out of range.
    AccuracyError : the contact extends beyond a flat by less than 5e-13 of its radius.
    """
    _require_measure(measure)
    require_poissons_ratio(("poissons_ratio",), poissons_ratio)
    under, shape = foundations(contact, body)
    found = [_peak(each, measure, poissons_ratio) for each in under]
    return Peak(*np.array(found).T.reshape(4, *shape))


def _require_measure(measure: str) -> None:
    if measure not in MEASURES:
        raise InputError(("measure",), f"must be one of {', '.join(MEASURES)}")


def yield_onset_force(
    contact: _Loaded,
    yield_strength: float,
    measure: str = "von_mises",
    *,
    poissons_ratio: float,
    body: int = 1,
) -> Array:
    """Return the normal force at which yield begins, in the ratio F_x/F_N of each load [force].

    Yield begins where the von Mises stress reaches the yield strength, or the largest shear stress
    half of it (Tresca). The force is 0 where the stress is infinite under any load, and inf where
    no load up to the end of the profile reaches it. Source: johnson, section 4.2; notes, §12.

    Parameters
    ----------
    yield_strength : in uniaxial tension [pressure].
    contact, measure, poissons_ratio, body : see `largest`.

    Raises
    ------
    InputError : an unknown measure, no load, or a yield strength that is not positive.
    AccuracyError : see `largest`.
    """
    require_single_positive(("yield_strength",), yield_strength)
    _require_measure(measure)
    profile, (columns, shape) = contact.normal.profile, _columns(contact)
    if not np.all(contact.normal.loaded):
        raise InputError(("load",), "the onset of yield needs a load that is not zero")
    limit = yield_strength if measure == "von_mises" else yield_strength / 2
    # Loads in one ratio of the forces share the onset.
    _, first, which = np.unique(columns[1:], axis=1, return_index=True, return_inverse=True)
    with np.errstate(all="ignore"):
        onset = [
            _onset(profile, columns[:, i].tolist(), measure, limit, poissons_ratio, body)
            for i in first
        ]
    return np.array(onset)[which].reshape(shape)


def yield_finding(
    contact: _Loaded | LoadHistory, poissons_ratios: tuple[float, ...], yield_strength: float
) -> Finding:
    """Return `yield`: loads under which a body has yielded by Tresca's criterion.

    `yield_strength` is for the softer body [pressure]. Poisson's ratio 0.3 is assumed if none
    are known. Along a load history the forces of every sample count as applied once; at its end
    the traction follows from the path. Source: johnson, section 4.2; notes, §12.
    """
    ratios, pressed = poissons_ratios or (ASSUMED_RATIO,), contact.normal
    profile, (columns, shape) = pressed.profile, _columns(contact)

    def yields(one: Contact) -> bool:
        ((under,), _), limit = foundations(one, 1), yield_strength / 2
        return any(_peak(under, "maximum_shear", nu, limit)[0] >= limit for nu in ratios)

    reaches = cache(lambda *case: yields(_under(profile, *case)))

    # The largest stress grows with the load, and with the ratio of the forces: a box of both is
    # cut in two unless a corner decides about all of it.
    def decide(box: Indices) -> None:
        low, high = columns[:, box].min(axis=1), columns[:, box].max(axis=1)
        if not reaches(*high.tolist()):
            return
        if reaches(*low.tolist()):
            where.flat[box] = True
        else:
            order = np.argsort(columns[int(low[0] == high[0]), box], kind="stable")
            for half in np.array_split(box[order], 2):
                decide(half)

    where = np.zeros(shape, dtype=bool)
    if isinstance(profile, PowerLaw) and not columns[1].any():
        # Under a power the stresses are similar at all loads.
        factors = [np.vectorize(_factor, otypes=[float])(profile.exponent, nu) for nu in ratios]
        peaks = 2 * np.max(factors, axis=0) * pressed.mean_pressure
        where |= pressed.loaded & (peaks >= yield_strength)
    else:
        loaded = np.flatnonzero(np.broadcast_to(pressed.loaded, shape))
        _, group = np.unique(columns[2:, loaded], axis=1, return_inverse=True)
        for number in np.unique(group):
            decide(loaded[group == number])
    if isinstance(contact, LoadHistory) and not where[-1]:
        where[-1] = yields(contact.state)

    def message(_size: float) -> str:
        least = float(np.min(np.broadcast_to(pressed.normal_force, shape)[where]))
        assumed = "" if poissons_ratios else f" for an assumed Poisson's ratio of {ASSUMED_RATIO}"
        return f"the stresses meet Tresca's criterion under a normal force of {least:.4g}{assumed}"

    return Finding("yield", where, message, instead="elastic_plastic")


def _columns(contact: _Loaded | LoadHistory) -> tuple[Array, tuple[int, ...]]:
    """F_N, |F_x|/(mu F_N), mu, E* and swept parameters by load, and the shape of the loads."""
    require_type("contact", contact, _Loaded | LoadHistory, "a contact under loads")
    pressed, ratio, friction = contact.normal, np.zeros(()), np.ones(())
    if not isinstance(contact, normal.NormalContact):
        start = contact.path.start if isinstance(contact, LoadHistory) else contact
        friction = np.asarray(start.friction_coefficient)
        limit = friction * pressed.normal_force
        ratio = np.minimum(np.abs(contact.tangential_force) / np.where(limit > 0, limit, 1.0), 1.0)
    swept = [pressed.profile.parameters[name] for name in pressed.profile.swept]
    columns = np.broadcast_arrays(pressed.normal_force, ratio, friction, pressed.e_star, *swept)
    return np.array([np.ravel(each) for each in columns]), columns[0].shape


def _under(profile: Profile, *case: float) -> tangential.TangentialContact:
    """Contact under one load; parameters: see `_columns`."""
    force, ratio, friction, e_star, *swept = case
    one = profile.with_parameters(dict(zip(profile.swept, swept, strict=True)))
    pressed = normal.solve(one, e_star, normal_force=force)
    # The stresses depend on the ratio of the forces alone, not on G*.
    return tangential.solve(pressed, e_star, friction, tangential_force=ratio * friction * force)


def _onset(
    profile: Profile, case: list[float], measure: str, limit: float, nu: float, body: int
) -> float:
    """Normal force at which the largest stress is `limit`, at the ratio of the forces of a case.

    Secant steps in the logarithms, which are nearly in proportion, and bisections where they leave
    the bracket. The error after two secant steps is of the order of their product.
    """
    force, ratio, _, e_star, *_ = case
    at = cache(lambda load: _under(profile, exp(load), *case[1:]))
    # Slip begins at the contact edge: it reaches every radius that the contact reaches.
    one, slips_from = at(log(force)).normal.profile, 0.0 if ratio > 0 else inf
    # The stress becomes infinite when the contact reaches one of these radii.
    radii = [b for b in one.infinite_pressure_radii if one.first_radius < b < inf]
    radii = [b for b in radii if infinite_deviator(one, b, (nu,), slips_from)]
    forces = [normal.solve(one, e_star, contact_radius=b).normal_force for b in radii]
    singular = min(map(float, forces), default=inf)
    last = one.largest_loads[1]
    # Nearer the edge of a flat the stress beneath it no longer depends on the load.
    least = e_star * float(one.reduced_force(number(_RESOLVED * one.first_radius)))
    lowest = max(log(force) - _REACH, log(least) + _RTOL if least > 0 else -inf)
    highest = min(log(force) + _REACH, log(min(singular, e_star * last)) - _RTOL)
    load = max(min(log(force), highest), lowest)
    # The first step takes the stress to grow like the mean pressure, which is exact for powers.
    means = [at(each).normal.mean_pressure for each in (load, load - _RTOL)]
    slope = log(means[0] / means[1]) / _RTOL
    similar = isinstance(profile, PowerLaw) and slope > 1 / _REACH
    low, high, excess, before = -inf, inf, 0.0, load
    for _ in range(MAX_STEPS):
        value = _peak(foundations(at(load), body)[0][0], measure, nu)[0]
        found = min(max(log(max(value, TINY) / limit), -_REACH), _REACH)
        if value == inf or (load == lowest and found > 0):
            return 0.0
        if load == highest and found < 0:
            return singular
        low, high = (low, load) if found > 0 else (load, high)
        slope = (found - excess) / (load - before) if load != before else slope
        step, last = -found / max(slope, 1 / _REACH), load - before
        # A step below the rounding error of the load leaves no bracket to halve.
        exact = load + step == load or (similar and lowest < load + step < highest)
        if exact or (excess and abs(step * last) <= _RTOL):
            return exp(min(max(load + step, lowest), highest))
        before, excess, load = load, found, min(max(load + step, lowest), highest)
        if not low < load < high:
            load = (low + high) / 2
    raise DefectError("the search for the onset of yield did not converge")


@lru_cache(maxsize=256)
def _factor(exponent: float, poissons_ratio: float) -> float:
    """Largest shear stress over the mean pressure under a power."""
    contact = normal.solve(Power(1.0, exponent), 1.0, contact_radius=1.0)
    peak = largest(contact, "maximum_shear", poissons_ratio=poissons_ratio)
    return float(peak.value / contact.mean_pressure)


def _peak(
    under: Foundation, measure: str, nu: float, limit: float | None = None
) -> tuple[float, ...]:
    """Value and place of the largest stress in one case; parameters: see `largest`.

    With a `limit`, only a value that is on the same side of it as the largest stress.
    """
    if not under.loaded:
        return 0.0, 0.0, 0.0, 0.0
    profile, edges = under.load.profile, under.load.radius
    for b in under.infinite_radii:
        if infinite_deviator(profile, b, (nu,), under.slips_from):
            return inf, b, 0.0, 0.0
    if limit is None and under.load.coordinate[-1] < _RESOLVED * profile.first_radius:
        raise AccuracyError(
            "the contact extends so little beyond the flat that no radius in double precision "
            "resolves the largest stress beneath its edge: increase the load",
            ("load",),
        )

    def on(*place: Array) -> Array:
        """The measure by angle, r of either sign and z, which broadcast; zero where infinite.

        Directions are the first axis: r and z are the same in all.
        """
        angle, r, z = np.broadcast_arrays(*place)
        turned = np.exp(1j * angle) * np.where(r < 0, -1, 1)
        rings = np.abs(r[0]).ravel(), z[0].ravel(), turned.reshape(len(angle), -1)
        values = getattr(on_rings(under, rings, nu), measure)
        return np.nan_to_num(values, posinf=0.0).reshape(angle.shape)

    # Radii, of either sign if there is a tangential load, and depths.
    a = float(edges[-1])
    stops = np.unique([0.0, *edges, *(float(b) for b in profile.breaks if b < a)])
    r = graded(np.append(stops, 1.5 * a), max(_RADII, 4 * stops.size))
    if under.sheared:
        r = np.append(-r[:0:-1], r)
    shallow, deep = min(_SHALLOWEST * a, 0.1 * float(np.diff(stops).min())), _DEEPEST * a
    z = np.append(0.0, np.geomspace(shallow, deep, ceil(_PER_E_FOLD * log(deep / shallow))))
    angles = _ANGLES if under.sheared else _ANGLES[:1]
    values = on(angles[:, None, None], r[:, None], z)
    if limit is not None and values.max() >= limit:
        return (float(values.max()),)
    # Where two peaks share a ridge the grid may have one maximum, but the spline through it has
    # both.
    steps = [np.arange(part.size) for part in (r, z)]
    finer = [np.linspace(0, part[-1], _FINER * part[-1] + 1) for part in steps]
    fine = CubicSpline(steps[0], values, axis=1)(finer[0])
    fine = CubicSpline(steps[1], fine, axis=2)(finer[1])
    r, z = (np.interp(*columns) for columns in zip(finer, steps, (r, z), strict=True))
    # On the axis the directions differ by rounding errors.
    fine[1:, r == 0] = fine[0, r == 0]
    high = (fine == maximum_filter(fine, 3)) & (fine >= _ALMOST * values.max())
    # One direction stands for all on the axis, and for both beside the plane of the load.
    high[1:, r == 0] = high[len(_ANGLES) - 1 :, r < 0] = False
    # The spline oscillates beside the cusp at the edge of a sliding contact, and may hide it.
    at = np.unravel_index(values.argmax(), values.shape)
    high[at[0], _FINER * at[1], _FINER * at[2]] = True
    k, i, j = np.nonzero(high)
    place = np.stack([angles[k], r[i], z[j]], axis=1)
    turn = np.full(k.size, _ANGLES[1] / _FINER * under.sheared)
    box = _STEPS * np.stack([turn, np.gradient(r)[i], np.gradient(z)[j]], axis=1)
    value, (angle, radius, depth) = _climbed(on, place, box, EPS * a, limit)
    return value, radius * cos(angle), abs(radius * sin(angle)), depth


def _climbed(
    on: Callable[..., Array], place: Array, box: Array, least: float, limit: float | None
) -> tuple[float, Array]:
    """Return the highest of the peaks next to some places, and its own place.

    A box around each place moves to its highest point. In each direction it grows if that lies on
    its boundary and shrinks if it is the middle, so that it takes the shape of the peak, however
    narrow. The peak is taken to rise above the middle no more than the middle above the lowest
    point: a box that stays below the highest peak, or the limit, is left.

    Parameters
    ----------
    on, limit : see `_peak`.
    place, box : angle, r and z of each start, and half the sizes of its box, shape (n, 3).
    least : half the size at which a box is left, even at a cusp [length].
    """
    half, highest, top = box, 0.0, place[0]
    for _ in range(MAX_STEPS):
        axes = place[..., None] + half[..., None] * _ACROSS
        axes[:, 2] = np.abs(axes[:, 2])
        angle, r, z = np.moveaxis(axes, 1, 0)
        values = on(angle.T[..., None, None], r[..., None], z[:, None])
        values = values.swapaxes(0, 1).reshape(len(place), -1)
        rows = np.arange(len(place))
        spot, middle = values.argmax(axis=1), values.shape[1] // 2
        spot[values[rows, spot] <= values[:, middle] * (1 + MOMENT_ERROR)] = middle
        index = np.stack(np.unravel_index(spot, (_ACROSS.size,) * 3), axis=1)
        place, value = axes[rows[:, None], range(3), index], values[rows, spot]
        if value.max() > highest:
            highest, top = float(value.max()), place[value.argmax()]
        rise, reach = value - values.min(axis=1), np.abs(_ACROSS[index])
        needed = value + rise > max(highest, limit or 0.0)
        left = (
            (rise > _FLAT * value)
            & (needed | (reach == 1).any(axis=1))
            & (half[:, 1:] > least).any(axis=1)
        )
        if not left.any() or (limit is not None and highest >= limit):
            break
        half = half * np.where(reach == 1, 1 / _SHRINK, np.where(reach == 0, _SHRINK, 1.0))
        half[:, 0] = np.minimum(half[:, 0], box[:, 0])
        place, half, box = place[left], half[left], box[left]
    return highest, top
