"""The points of a table: what they must be, and the cubics through them."""

from math import inf
from typing import Final, Literal

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.linalg.lapack import dgtsv

from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags

Interpolation = Literal["cubic", "pchip", "linear"]
# A smooth body's spline rings a little: a slope this much below zero, relative to the
# steepest, is the interpolation's and not the body's.
RINGING: Final = 1e-8


def interpolate(r: Array, f: Array, interpolation: Interpolation) -> Array:
    """Return the coefficients (4, panels), ascending, of one segment."""
    if interpolation == "linear" or r.size == 2:
        slope = np.diff(f) / np.diff(r)
        return np.stack([f[:-1], slope, np.zeros_like(slope), np.zeros_like(slope)])
    if interpolation == "pchip":
        return np.flip(np.asarray(PchipInterpolator(r, f).c), axis=0)
    spline = _not_a_knot(r, f)
    slopes = spline[1]
    if r[0] == 0 and -RINGING * np.abs(slopes).max() <= slopes[0] < 0:
        # A tip that falls by an interpolation's error is meant to be smooth. Left alone, it
        # would push the smallest loads below zero.
        spline = _not_a_knot(r, f, flat_tip=True)
        spline[1, 0] = 0.0
    return spline


def _not_a_knot(r: Array, f: Array, *, flat_tip: bool = False) -> Array:
    """The coefficients of SciPy's `CubicSpline`, to the last digit, without its checks.

    `flat_tip`: the slope at the first point is zero instead. Three points are on a parabola.
    """
    if r.size == 3:
        if not flat_tip:
            return np.flip(np.asarray(CubicSpline(r, f).c), axis=0)
        clamped = CubicSpline(r, f, bc_type=((1, np.zeros(())), "not-a-knot"))
        return np.flip(np.asarray(clamped.c), axis=0)
    width = r[1:] - r[:-1]
    chord = (f[1:] - f[:-1]) / width
    upper, lower = np.empty((2, width.size))
    diagonal, right = np.empty((2, r.size))
    diagonal[1:-1] = 2 * (width[:-1] + width[1:])
    upper[1:], lower[:-1] = width[:-1], width[1:]
    right[1:-1] = 3 * (width[1:] * chord[:-1] + width[:-1] * chord[1:])
    if flat_tip:
        diagonal[0], upper[0], right[0] = 1.0, 0.0, 0.0
    else:
        ends = width[0], width[1], r[2] - r[0], chord[0], chord[1]
        diagonal[0], upper[0] = ends[1:3]
        right[0] = _end(*ends)
    ends = width[-1], width[-2], r[-1] - r[-3], chord[-1], chord[-2]
    diagonal[-1], lower[-1] = ends[1:3]
    right[-1] = _end(*ends)
    *_, slopes, failed = dgtsv(lower, diagonal, upper, right, 1, 1, 1, 1)
    if failed:
        raise InputError(("profile", "r"), "no cubic can be put through radii so close together")
    turn = (slopes[:-1] + slopes[1:] - 2 * chord) / width
    rows = np.empty((4, width.size))
    rows[0], rows[1] = f[:-1], slopes[:-1]
    rows[2] = (chord - slopes[:-1]) / width - turn
    rows[3] = turn / width
    return rows


def _end(first: float, second: float, both: float, chord: float, next_chord: float) -> float:
    """Right side of the condition that the second point from an end is no knot."""
    return ((first + 2 * both) * second * chord + first**2 * next_chord) / both


def check_points(r: Array, f: Array) -> None:
    """Refuse what is not a table of a rising profile."""
    if r.ndim != 1 or r.size < 2:
        raise InputError(("profile", "r"), "at least two points are needed")
    if f.shape != r.shape:
        raise InputError(("profile", "f"), f"has {f.size} values for {r.size} radii")
    rises = bool((r[1:] > r[:-1]).all() and (f[1:] >= f[:-1]).all())
    if rises and r[0] == f[0] == 0 and r[-1] < inf and 0 < f[-1] < inf:
        return
    refuse_first("r", ~np.isfinite(r), "must be finite")
    refuse_first("f", ~np.isfinite(f), "must be finite")
    refuse_first("r", r[:1] != 0, "the table must start at radius 0")
    refuse_first("f", f[:1] != 0, "the profile must start at f = 0")
    refuse_first("r", np.append(False, np.diff(r) <= 0), "the radii must increase")
    falls = np.append(False, np.diff(f) < 0)
    radius = r[np.argmax(falls)]
    refuse_first("f", falls, f"f falls before radius {radius:.12g}")
    if f[-1] == 0:
        raise InputError(("profile", "f"), "f is zero everywhere: the edge is not in the table")


def refuse_first(name: str, bad: Flags, detail: str) -> None:
    """Raise InputError at the first point that is bad."""
    if bad.any():
        raise InputError(("profile", name, int(np.argmax(bad))), detail)
