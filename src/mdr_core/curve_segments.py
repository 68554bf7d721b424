"""Segments of a measured curve in the order of time: loading, hold and unloading.

A hold is a run of points in which force or depth is constant while the other quantity creeps,
relaxes or drifts, and at whose ends the constant quantity changes abruptly. All other points are
classified by the direction of the depth. Durations are numbers of points where times are unknown.
"""

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdr_core import residuals
from mdr_core.doubles import EPS, TINY
from mdr_core.typing import Array, Flags

BRANCHES: Final = "loading", "unloading"
"""Segments that are fitted."""
# Lengths of the searched windows, over the duration of the curve.
_WINDOWS: Final = np.geomspace(0.05, 0.4, 7)
# Smallest number of points in a window, and of a line of drift.
_FEWEST: Final = 8
# Largest rate of a constant quantity, over its range divided by the duration.
_CONSTANT: Final = 0.05
# Largest rate of the other quantity, over its range divided by the duration.
_SLOW: Final = 1.0
# Standard errors of a mean over a third of a window that the largest drift of a hold must exceed.
_CHANCE: Final = 2.0
# Deviation of the points of a hold from its level, in standard deviations.
_LEVEL: Final = 3.0
# Smallest mean change beyond an end of a hold, over its duration; a crest of a sine changes less.
_SHARP: Final = 0.25
# Change beyond an end of a hold, over the range, that always suffices.
_STEP: Final = 0.04
# Largest depth before contact, over the range of depths.
_APPROACH: Final = 0.05
# Largest difference from the force before contact, over the range of forces, that is not a hold.
_LOADED: Final = 0.05
# Largest force of a hold that shows the drift, above the least force, over the range.
_LOW: Final = 0.5
# Part of a hold that is omitted at each end.
_END: Final = 0.1
# Upper limit of the correlation of neighbouring residuals.
_ALIKE: Final = 0.99
# Standard deviation over the median of the absolute values of normal errors.
_BY_MEDIAN: Final = 1.4826


class Segment(NamedTuple):
    """Successive points of a curve of one kind."""

    kind: str
    """`loading`, `hold` or `unloading`."""
    first: int
    """Index of the first point."""
    last: int
    """Index of the last point."""


def phases(depth: Array, force: Array, time: Array | None = None) -> NDArray[np.str_]:
    """Return "loading", "hold" or "unloading" for each point.

    Parameters: the curve in the order of time, and times that do not fall, shape (k,).
    """
    kinds = np.where(residuals.directions(depth) > 0, "loading", "unloading")
    times = np.arange(float(depth.size)) if time is None else time
    if min(np.ptp(each) for each in (depth, force, times)) > 0:
        kinds[_held(depth, force, times)] = "hold"
    return kinds


def segments(kinds: NDArray[np.str_]) -> list[Segment]:
    """Return the runs of points of one kind, see `phases`."""
    return [Segment(str(kinds[first]), first, last) for first, last in _runs(kinds)]


def _runs(values: NDArray[Any]) -> list[tuple[int, int]]:
    """Return the first and last indices of the runs of equal values."""
    last = [*np.flatnonzero(values[1:] != values[:-1]).tolist(), values.size - 1]
    return list(zip([0, *(end + 1 for end in last[:-1])], last, strict=True))


def _held(depth: Array, force: Array, time: Array) -> Flags:
    """Return True for points of holds."""
    y, x, t = ((each - each.min()) / np.ptp(each) for each in (force, depth, time))
    before, loaded = np.median(y[x <= _APPROACH]), _LOADED + _LEVEL * _noise(y)
    held = np.zeros(t.size, dtype=bool)
    for constant, other in ((y, x), (x, y)):
        noise = _noise(constant)
        found = _in_windows(constant, other, t, noise)
        for first, last in _runs(found):
            if found[first]:
                run = _at_level(constant, first, last, noise)
                touches = abs(np.mean(y[run]) - before) > loaded
                held[run] |= touches and _ends_abruptly(constant, t, run)
    return held


def _noise(y: Array) -> float:
    """Return the standard deviation of the noise; second differences have 6 times its variance."""
    return _BY_MEDIAN * float(np.median(np.abs(np.diff(y, 2)))) / 6**0.5 if y.size > 2 else 0.0


def _in_windows(constant: Array, other: Array, t: Array, noise: float) -> Flags:
    """Return True for points of windows in which a quantity is constant, and the other one slow.

    The means over the thirds of a window differ by a drift; a window needs enough points for this.
    """
    sums = [np.append(0.0, np.cumsum(each)) for each in (other, t, t * t, other * t)]
    total = np.append(0.0, np.cumsum(constant))
    changes = np.zeros(t.size + 1)
    for part in _WINDOWS:
        end = np.maximum(np.searchsorted(t, t + part), np.arange(t.size) + _FEWEST)
        begin = np.flatnonzero(end <= t.size)
        end = end[begin]
        thirds = np.linspace(begin, end, 4).round().astype(int)
        means = np.diff(total[thirds], axis=0) / np.diff(thirds, axis=0)
        drift = 2 / 3 * _CONSTANT * (t[end - 1] - t[begin])
        x, m, mm, xm = ((each[end] - each[begin]) / (end - begin) for each in sums)
        found = begin[
            (np.ptp(means, axis=0) <= drift)
            & (_CHANCE * noise * np.sqrt(3 / (end - begin)) <= drift)
            & (np.abs(xm - x * m) <= _SLOW * (mm - m * m))
        ]
        np.add.at(changes, found, 1)
        np.add.at(changes, end[np.searchsorted(begin, found)], -1)
    return np.asarray(np.cumsum(changes)[:-1] > 0)


def _at_level(constant: Array, first: int, last: int, noise: float) -> slice:
    """Return the points about a run that are at its level."""
    run = constant[first : last + 1]
    level = np.median(run)
    scatter = max(_BY_MEDIAN * float(np.median(np.abs(run - level))), noise)
    inside = np.abs(constant - level) <= _LEVEL * scatter
    at = first + np.flatnonzero(inside[first : last + 1])
    before, after = np.flatnonzero(~inside[: at[0]]), np.flatnonzero(~inside[at[-1] :])
    return slice(
        before[-1] + 1 if before.size else 0, at[-1] + after[0] if after.size else constant.size
    )


def _ends_abruptly(constant: Array, t: Array, run: slice) -> bool:
    """Return True if a quantity changes at the ends of a run, and not gradually."""
    level, half = np.mean(constant[run]), (t[run][-1] - t[run][0]) / 2
    before = constant[np.searchsorted(t, t[run][0] - half) : run.start]
    after = constant[run.stop : np.searchsorted(t, t[run][-1] + half)]
    least = min(_SHARP * 2 * half, _STEP)
    return all(abs(np.mean(each) - level) >= least for each in (before, after) if each.size > 2)


class Drift(NamedTuple):
    """Rate at which the measured depth drifts, and its standard error."""

    rate: float
    """Rate [length/time]."""
    error: float
    """Standard error of the rate [length/time]."""


def drift(depth: Array, force: Array, time: Array, kinds: NDArray[np.str_]) -> Drift | None:
    """Return the drift in the last hold at a constant low force, None without one.

    In a hold at a high force the sample creeps too, and a depth that is constant to the last digit
    is controlled and shows no drift. The points next to its ends may belong to the branches.

    Parameters
    ----------
    depth, force, time : the curve in the order of time, shape (k,).
    kinds : see `phases`.
    """
    for kind, first, last in reversed(segments(kinds)):
        if kind != "hold":
            continue
        run = _at_level(force, first, last, _noise(force))
        end = int(_END * (run.stop - run.start)) + 1
        t, x, y = (each[run][end:-end] for each in (time, depth, force))
        least, most = force.min(), np.ptp(force)
        if t.size < _FEWEST or np.ptp(t) == 0 or np.ptp(x) == 0:
            continue
        found, relaxation = _line(t, x), _line(t, y)
        is_constant = abs(relaxation.rate) <= max(
            _LEVEL * relaxation.error, abs(found.rate) * most / np.ptp(depth)
        )
        if is_constant and np.mean(y) - least <= _LOW * most:
            return found
    return None


def _line(t: Array, y: Array) -> Drift:
    """Return the slope of the line of least squares.

    The standard error of white noise is multiplied by ((1 + r)/(1 - r))^(1/2), with the correlation
    r of neighbouring residuals corrected for its bias in short lists.
    """
    t, y = t - t.mean(), y - y.mean()
    square = float(t @ t)
    rate = float(t @ y) / square
    left = y - rate * t
    squares = max(float(left @ left), (EPS * np.abs(y).max()) ** 2, TINY)
    r = min(max(float(left[1:] @ left[:-1]) / squares + 2 / t.size, 0.0), _ALIKE)
    return Drift(rate, float(np.sqrt(squares / (t.size - 2) / square * (1 + r) / (1 - r))))
