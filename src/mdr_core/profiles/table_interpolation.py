"""Interpolation of a table: piecewise cubic polynomials through its points. Source: notes, §5."""

from collections.abc import Sequence
from itertools import pairwise
from math import frexp, inf
from typing import Any, Final, Literal

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags

Interpolation = Literal["auto", "cubic", "pchip", "linear"]
# Ringing of a spline: a slope this small, relative to the steepest, is zero. It is the spline's own
# error for a smooth body at a hundredth of its radius.
RINGING: Final = 1e-8
# Lowest slope of a spline below zero, over the steepest, that "auto" accepts. Next to jumps of the
# slope it is larger, in smooth bodies and next to jumps of the curvature smaller: 4e-2 against 7e-3
# in the bodies of the tests, from ten intervals on.
SLOPE_FALLS: Final = 1e-2
# Rounding errors of heights that are differences of numbers as large as the last height.
_ROUNDING: Final = 4 * float(np.finfo(float).eps)


def interpolate(
    r: Array, f: Array, kind: Interpolation, breaks: Sequence[float] = ()
) -> tuple[Array, Array]:
    """Return the piecewise cubic f(r), and the radii at which it falls.

    Parameters
    ----------
    r, f : points of a table that passed `checked_heights` [length], shape (k + 1,).
    kind : "cubic" (not-a-knot spline), "pchip", "linear", or "auto": a spline that may fall by
        `SLOPE_FALLS`, and has no slope on the axis if it is within the interpolation error.
    breaks : inner radii of the table that no polynomial spans [length].

    Returns
    -------
    Coefficients of the powers 0 to 3 of r - r_i, shape (4, k), and one radius for each panel in
    which the spline falls too steeply. Smaller falls are removed by limiting its slopes there.
    """
    width = r[1:] - r[:-1]
    chord = (f[1:] - f[:-1]) / width
    if kind == "linear":
        return np.stack([f[:-1], chord, np.zeros_like(chord), np.zeros_like(chord)]), r[:0]
    cuts = np.searchsorted(r, sorted({0.0, *breaks, float(r[-1])})).tolist()
    segments = [slice(i, j + 1) for i, j in pairwise(cuts)]
    if kind == "pchip":
        # Cubics of these slopes are monotone. Source: fritsch-carlson.
        slopes = _at_ends([PchipInterpolator(r[part], f[part])(r[part], 1) for part in segments])
        return _hermite(f, width, chord, slopes), r[:0]
    fall = SLOPE_FALLS if kind == "auto" else RINGING
    slopes = _at_ends(_spline_slopes(r, f, segments, smooth=kind == "auto"))
    rows = _hermite(f, width, chord, slopes)
    lowest, place = _lowest_slopes(rows, width)
    falls = (r[:-1] + place)[lowest < -fall * float(slopes.max())]
    if not falls.size and (lowest < 0).any():
        rows = _hermite(f, width, chord, _limited(slopes, chord, lowest < 0))
    return rows, falls


def _at_ends(slopes: Sequence[Array]) -> Array:
    """Slopes of each segment's points, at both ends of each panel (2, panels)."""
    return np.concatenate([[part[:-1], part[1:]] for part in slopes], axis=1)


def _limited(slopes: Array, chord: Array, falls: Flags) -> Array:
    """Slopes for which the cubics of the falling panels are monotone.

    Slopes up to three times the chord's are enough. Source: fritsch-carlson.
    """
    bound = np.where(falls, 3 * chord, inf)
    at_left = np.minimum(bound, np.append(inf, bound[:-1]))
    at_right = np.minimum(bound, np.append(bound[1:], inf))
    return np.asarray(np.clip(slopes, 0.0, [at_left, at_right]))


def _hermite(f: Array, width: Array, chord: Array, slopes: Array) -> Array:
    """Coefficients of the cubics with given slopes at both ends of each panel."""
    turn = (slopes[0] + slopes[1] - 2 * chord) / width
    return np.stack([f[:-1], slopes[0], (chord - slopes[0]) / width - turn, turn / width])


def _lowest_slopes(rows: Array, width: Array) -> tuple[Array, Array]:
    """Lowest slope of each panel's cubic, and its distance from the panel's left end."""
    _, c1, c2, c3 = rows
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = np.where(c3 > 0, -c2 / (3 * c3), 0.0)
    u = np.stack([np.zeros_like(width), np.clip(turn, 0.0, width), width])
    slopes = c1 + u * (2 * c2 + u * 3 * c3)
    lowest = slopes.argmin(axis=0), np.arange(width.size)
    return slopes[lowest], u[lowest]


def _spline_slopes(r: Array, f: Array, segments: Sequence[slice], *, smooth: bool) -> list[Array]:
    """Slopes of a not-a-knot spline on each segment.

    A slope below zero on the axis (any slope there if `smooth`) or a drop of the slope at a break
    is removed if it is within the interpolation error: the spline is fitted again with the slope
    of a smooth body.
    """
    slopes = [_not_a_knot(r[part], f[part]) for part in segments]
    noise = RINGING * max(float(np.abs(part).max()) for part in slopes)
    joints: list[float | None] = []
    before, error_before = 0.0, 0.0
    for part, slope in zip(segments, slopes, strict=True):
        first, error = float(slope[0]), _end_error(r[part][:4], f[part][:4])
        drop = before - first if joints or not smooth else abs(first)
        joined = 0 < drop <= max(error + error_before, noise)
        joints.append((before if error_before <= error else first) if joined else None)
        before, error_before = float(slope[-1]), _end_error(r[part][:-5:-1], f[part][:-5:-1])
    for i, (first_slope, last_slope) in enumerate(pairwise([*joints, None])):
        if first_slope is not None or last_slope is not None:
            slopes[i] = _not_a_knot(r[segments[i]], f[segments[i]], first_slope, last_slope)
    return slopes


def _end_error(r: Array, f: Array) -> float:
    """Difference of slope at the first point of the cubic and of the parabola through the points.

    It estimates the error of the parabola, which is larger than that of a spline.
    """
    if r.size < 4:
        return 0.0
    first = np.diff(f) / np.diff(r)
    second = np.diff(first) / (r[2:] - r[:-2])
    third = (second[1] - second[0]) / (r[3] - r[0])
    return float(abs(third * (r[1] - r[0]) * (r[2] - r[0])))


def _not_a_knot(r: Array, f: Array, first: float | None = None, last: float | None = None) -> Array:
    """Slopes of a cubic spline at the points; a prescribed slope at an end replaces its condition.

    Three points give a parabola, two a straight line.
    """
    # Widths below 1 keep the order of the equations; a power of two adds no rounding error.
    unit = 2.0 ** frexp(r[-1])[1]
    ends: Any = tuple(
        "not-a-knot" if slope is None else (1, unit * slope) for slope in (first, last)
    )
    try:
        spline = CubicSpline(r / unit, f, bc_type=ends)
    except (np.linalg.LinAlgError, ValueError):
        detail = "radii are too close together for cubic interpolation"
        raise InputError(("profile", "r"), detail) from None
    return np.asarray(spline(r / unit, 1) / unit)


def checked_heights(r: Array, f: Array) -> Array:
    """Return the heights, made monotone where they fall by rounding errors of the last height.

    Raises InputError unless the points are those of a profile that rises from f(0) = 0.
    """
    if r.ndim != 1 or r.size < 2:
        raise InputError(("profile", "r"), "at least two points are needed")
    if f.shape != r.shape:
        raise InputError(("profile", "f"), f"has {f.size} values for {r.size} radii")
    _reject_first("r", ~np.isfinite(r), "must be finite")
    _reject_first("f", ~np.isfinite(f), "must be finite")
    _reject_first("r", r[:1] != 0, "the table must start at radius 0")
    _reject_first("f", f[:1] != 0, "the profile must start at f = 0")
    _reject_first("r", np.append(False, np.diff(r) <= 0), "the radii must increase")
    falls = np.append(False, np.diff(f) < -_ROUNDING * f[-1])
    radius = r[np.argmax(falls)]
    _reject_first("f", falls, f"f falls before radius {radius:.12g}")
    if f[-1] <= 0:
        raise InputError(("profile", "f"), "f is zero everywhere: extend the table beyond the flat")
    return np.asarray(np.maximum.accumulate(f))


def _reject_first(name: str, bad: Flags, detail: str) -> None:
    """Raise InputError at the first rejected point."""
    if bad.any():
        raise InputError(("profile", name, int(np.argmax(bad))), detail)
