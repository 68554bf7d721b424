"""What all fields share: one load's contact, its kernels, and the blocks of radii."""

from collections.abc import Callable
from math import inf
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import annulus
from mdr_core.checks import largest
from mdr_core.errors import InputError
from mdr_core.normal import Load
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Radii handled at once: bounds the memory, whatever their number.
_BLOCK: Final = 131_072
# A grid goes on outside the contact up to so many times its radius.
_BEYOND: Final = 1.5

# One load at some radii, of which `highest` is the largest.
Row = Callable[[Array, float], Array]


def graded(stops: Array, points: int) -> Array:
    """Return `points` radii from the first stop to the last, crowding towards each of them.

    Raises
    ------
    InputError : fewer points than stops.
    """
    end = stops[-1]
    if points < stops.size:
        raise InputError(("points",), f"at least {stops.size} are needed for the singular radii")
    gaps = np.diff(stops)
    # Every gap gets one point and its share of the rest, by its length to a half.
    spare = points - stops.size
    share = np.sqrt(gaps) / np.sqrt(gaps).sum() * spare
    counts = np.floor(share).astype(int)
    counts[np.argsort(counts - share, kind="stable")[: spare - int(counts.sum())]] += 1
    parts = [
        low + gap * (1 - np.cos(np.pi * np.arange(count + 1) / (count + 1))) / 2
        for low, gap, count in zip(stops[:-1], gaps, counts, strict=True)
    ]
    return np.append(np.concatenate(parts), end)


def grid_through(profile: Profile, special: list[Array], largest: float, points: int) -> Array:
    """Return radii from 0 to half as far again as the largest contact [length], shape (points,).

    They crowd towards the axis, the profile's breaks and the special radii, all among them.

    Raises
    ------
    InputError : fewer points than there are such radii.
    """
    breaks = [np.ravel(np.asarray(b, dtype=float)) for b in profile.breaks]
    end = _BEYOND * largest or 1.0
    if not profile.slips_at_once:
        end = min(end, float(np.max(profile.domain)))
    stops = np.unique(np.concatenate([np.zeros(1), *breaks, *special]))
    return graded(np.append(stops[stops < end], end), points)


def foundation_row(load: Load) -> Row:
    """q(x) as the step from x to a: near the edge a difference of depths has no digits."""
    profile = load.profile

    def values(r: Array, _highest: float) -> Array:
        result = np.zeros(r.shape)
        inside = r < load.a
        if profile.slips_at_once:
            result[r <= load.a] = load.e_star * load.coordinate
        elif inside.any():
            least = float(profile.contact_radius(np.asarray(profile.first_coordinate)))
            x, a = np.maximum(r[inside], least), np.array([load.a])
            top = np.array([load.coordinate])
            at = profile.coordinate_from_radius(x)
            width = profile.coordinate_width(a, x, top, at)
            result[inside] = load.e_star * annulus.depth_step(profile, top, width, at)
        return result

    return values


def kernel(
    load: Load,
    r: Array,
    highest: float,
    slip_annulus: tuple[float, float] | None,
    modulus: float,
    rtol: float,
) -> Array:
    """The stress kernel at all radii, zero outside the contact.

    `slip_annulus` is its width in the contact coordinate and c; None for c = 0.
    """
    at = _single(load.coordinate)
    span, inner = (None, None) if slip_annulus is None else map(_single, slip_annulus)
    inside = slice(None) if highest < load.a else np.asarray(r < load.a)
    chosen = r[inside]
    values = np.zeros(0)
    if chosen.size:
        values = load.profile.pressure_kernel(
            at, chosen, rtol, span, edge=load.edge, modulus=modulus, inner=inner
        )
        if chosen.size == r.size:
            return values
    result = np.zeros(r.shape)
    result[inside] = values
    if load.profile.slips_at_once:
        # The rim of a flat punch carries an infinite stress.
        result[r == load.a] = np.copysign(inf, modulus) if load.coordinate > 0 else 0.0
    return result


def slip_kernel(profile: Profile, c: float, r: Array, rtol: float) -> Array:
    """S(c; r) of one stick radius at many radii [length]; zero on a flat."""
    if profile.slips_at_once:
        return np.zeros(r.shape)
    return profile.slip_kernel(np.full(r.shape, c), r, rtol)


def fill(shape: tuple[int, ...], rows: list[Row], radius: ArrayLike) -> Array:
    """Evaluate every load's row, block by block of the radii, all of them checked."""
    r = np.ascontiguousarray(np.atleast_1d(np.asarray(radius, dtype=float)))
    if r.size == 0:
        raise InputError(("radius",), "at least one radius is needed")
    if len(rows) == 1 and r.size <= _BLOCK:
        return rows[0](r, _checked_largest(r, 0)).reshape(shape + r.shape)
    out = np.empty((len(rows), r.size))
    for start in range(0, r.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        block = r[part]
        highest = _checked_largest(block, start)
        for target, row in zip(out, rows, strict=True):
            target[part] = row(block, highest)
    return out.reshape(shape + r.shape)


def _checked_largest(block: Array, start: int) -> float:
    """Largest radius of the block, all of them checked."""
    highest = largest(block)
    if not highest < inf:
        bad = ~((block >= 0) & (block < inf))
        if not bad.any():
            # Only a negative zero, which counts as zero.
            return float(block.max())
        raise InputError(
            ("radius", start + int(np.flatnonzero(bad)[0])), "must be finite and not negative"
        )
    return highest


def _single(value: float) -> Array:
    return np.array([value])
