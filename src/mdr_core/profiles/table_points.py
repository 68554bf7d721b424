"""Points of a table in normal form: sorted, merged, over their last radius and height.

Numbers that are multiples of a common unit are rounded to it: their rounding error is found here.

Source: notes, §5.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

import numpy as np

from mdr_core.doubles import EPS, ROUNDING
from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags

# Standard error of numbers, over their range, below which their rounding needs no weights.
_EXACT: Final = 1e-8
# Gap of merged radii, over the last one. The mean of two heights errs by its square.
_SAME: Final = np.sqrt(EPS)
# Gap of radii that count as one in spacings and slopes, over the mean spacing at equal radii.
_NEAR: Final = 1e-2
# Rounded numbers: largest unit over the mean step between them, and largest number of units: a
# smaller one is below `_EXACT`.
_FINEST_STEP, _MOST_UNITS = 0.05, round(1 / (np.sqrt(12) * _EXACT))
# Smallest error of a rounded height, over that of most.
_LEAST_ERROR: Final = 1e-2
# Windows about the axis of a scan, each about the axis in the one before.
_WINDOWS: Final = 8
# Distance of a scan's axis from r = 0 that is reported, over the last radius.
_OFF_AXIS: Final = 0.02


@dataclass(frozen=True, eq=False)
class TablePoints:
    """Points of a table over its last radius and its height, ascending; equal radii merged."""

    x: Array
    y: Array
    weight: Array
    """Weight of the deviation: square root of the number of points that were merged."""
    rounding: Array
    """Standard errors of the heights by the digits of the numbers."""
    distinct: Flags
    """Points that are not next to the one beyond."""
    breaks: tuple[float, ...]
    scale: tuple[float, float]
    """Last radius and height [length]."""
    least: float
    """Lowest noise of the heights: the median of those errors; zero for heights of all digits."""

    @property
    def by_digits(self) -> "TablePoints":
        """The points with weights by the errors of their digits, of which one is not zero."""
        # On a flat an error of the radius is none of the height.
        typical = np.median(self.rounding[self.rounding > 0])
        weight = self.weight / (self.rounding / typical).clip(_LEAST_ERROR)
        return replace(self, weight=weight)


def cleaned(r: Array, f: Array, breaks: Sequence[float]) -> TablePoints:
    """Sort the points and merge those of equal radii, which may have any sign."""
    end, height = float(np.abs(r).max()), float(f.max() - f.min())
    # A point that is given twice is no second measurement.
    x, y = given = np.unique(np.stack([np.abs(r) / end, (f - f.min()) / height]), axis=1)
    group = np.cumsum(np.append(False, np.diff(x) > _SAME))
    count = np.bincount(group)
    x, y = np.bincount(group, x) / count, np.bincount(group, y) / count
    x[0] *= x[0] > ROUNDING
    x[-1] = 1.0
    curved = np.square(x) - np.mean(np.square(x))
    if y @ curved <= 0:
        advice = off_axis(r, f) or "reverse their sign"
        raise InputError(("profile", "f"), f"the heights fall away from the axis: {advice}")
    distinct = np.diff(x, append=2.0) > _NEAR * x / x.size
    of_radius, of_height = (np.bincount(group, _rounding(each, x.size)) / count for each in given)
    rounding, least = of_height, 0.0
    if max(of_radius.max(), of_height.max()) > _EXACT and distinct.sum() > 1:
        # An error of the radius is one of the height on a slope.
        slope = np.interp(x, x[distinct], np.gradient(y[distinct], x[distinct]))
        rounding = np.hypot(of_radius * slope, of_height)
        # Heights with all digits tell of no rounding.
        least = np.median(rounding[rounding > 0]) * of_height.any()
    scaled = tuple(b / end for b in breaks)
    weight = np.sqrt(count)
    return TablePoints(x, y, weight, rounding, distinct, scaled, (end, height), float(least))


def off_axis(r: Array, f: Array) -> str:
    """Return what to do with positions of a scan that are not measured from the axis, else ""."""
    axis, bend = axis_of(r, f)
    if axis is None or abs(axis) < _OFF_AXIS * np.abs(r).max():
        return ""
    reverse = "" if bend > 0 else ", and reverse the sign of the heights"
    return f"if r is the position on a scan, subtract that of the axis, near {axis:.4g}{reverse}"


def axis_of(r: Array, f: Array) -> tuple[float | None, float]:
    """Return the axis of a scan and the bend there; None if the points lie on one side of it.

    It is that of the parabola through the points that reach equally far on both sides of it.
    """
    first, last = r.min(), r.max()
    axis, bend = (first + last) / 2, 0.0
    for _ in range(_WINDOWS):
        half = min(axis - first, last - axis)
        if not half > 0:
            return None, bend
        inside = np.abs(r - axis) <= half
        bend, slope, _ = np.linalg.lstsq(np.vander((r[inside] - axis) / half, 3), f[inside])[0]
        axis -= half * (slope / bend) / 2 if bend else np.inf
    return (float(axis) if first < axis < last else None), bend


def _rounding(values: Array, points: int) -> Array:
    """Standard errors of numbers that are multiples of a small unit; else zeros."""
    unit = _common_unit(values)
    # On a grid the unit is the spacing, which is no rounding.
    if points < 3 or not 0 < unit < _FINEST_STEP / points:
        return 0 * values
    # Of numbers with as many significant digits each, the larger ones are rounded to more units; a
    # power of ten is the last number of its decade. Numbers of one or two digits, as 1, 2, 5, 10,
    # are round, not rounded.
    counts = [round(count) for count in (values / unit).tolist()]
    digits = max(len(str(count).rstrip("0")) for count in counts)
    places = np.array([max(len(str(max(count - 1, 0))) - digits, 0) for count in counts])
    return np.asarray(unit * 10.0 ** (places * (digits > 2)) / np.sqrt(12))


def _common_unit(values: Array) -> float:
    """Largest number of which all values, the largest of which is 1, are multiples; else 0."""
    count = 1
    while count <= _MOST_UNITS:
        parts = count * values
        off = np.abs(parts - parts.round())
        worst = int(np.argmax(off))
        if off[worst] <= ROUNDING * count:
            return 1 / count
        part = Fraction(float(parts[worst])).limit_denominator(_MOST_UNITS // count)
        count *= max(part.denominator, 2)
    return 0.0
