"""The points of a table: what they must be, and the cubics through them."""

from typing import Final, Literal

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

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
    spline = CubicSpline(r, f)
    slopes = spline.c[2]
    if r[0] == 0 and -RINGING * np.abs(slopes).max() <= slopes[0] < 0:
        # A tip that falls by an interpolation's error is meant to be smooth. Left alone, it
        # would push the smallest loads below zero.
        spline = CubicSpline(r, f, bc_type=((1, np.zeros(())), "not-a-knot"))
        spline.c[2, 0] = 0.0
    return np.flip(np.asarray(spline.c), axis=0)


def check_points(r: Array, f: Array) -> None:
    """Refuse what is not a table of a rising profile."""
    if r.ndim != 1 or r.size < 2:
        raise InputError(("profile", "r"), "at least two points are needed")
    if f.shape != r.shape:
        raise InputError(("profile", "f"), f"has {f.size} values for {r.size} radii")
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
