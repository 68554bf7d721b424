"""Inverse of an increasing function, accurate relative to its value at every scale."""

from collections.abc import Callable
from math import inf
from typing import Final

import numpy as np

from mdr_core.doubles import EPS, LARGEST, ROUNDING, TINY
from mdr_core.elementwise import every, some, where
from mdr_core.errors import DefectError
from mdr_core.typing import Array, Flags

Function = Callable[[Array], Array]
# A function and its logarithmic slope d log(function)/d log(argument).
Sloped = Callable[[Array], tuple[Array, Array]]

MAX_STEPS: Final = 200
"""Maximum number of iterations that narrow a bracket or move a box, in searches of peaks as well.

Newton's method takes 5 to 10 steps; with bisections between its steps, bounds 1e50 apart take 140.
"""
# Newton's steps without bisections between them.
_ALONE: Final = 20
# Newton's step and distance from the target, both in log, below which one more step follows. Both
# are needed: beside a slope discontinuity convergence is not quadratic, and just above one a step
# is short long before the target is close.
_LAST_BUT_ONE: Final = 1e-10


def invert(function: Sloped, target: Array, start: Array, low: Array, high: Array) -> Array:
    """Return s with function(s) = target for an increasing function.

    Newton's method in log(s) and log(function), in which the functions of all profiles are nearly
    linear. The bracket [low, high] shrinks by the sign of the residual. Its middle replaces a step
    that leaves it and, after many steps, every second step, because steps beside a break can
    alternate between its two sides.

    Parameters
    ----------
    function : function of arrays, increasing and not negative, that also returns its logarithmic
        slope.
    target : values >= 0; where it is zero, `low` is returned.
    start : first approximation, inside the bracket.
    low, high : bracket of the root; `high` may be infinite.

    Returns
    -------
    Array of the common shape. It is zero or infinite where the root is not representable, and NaN
    where a value of the function is not.

    Raises
    ------
    DefectError : the iteration does not converge.
    """
    positive = target > 0
    goal = where(positive, target, 1.0)
    s, root_at_zero = start, low
    done = ~positive
    settling = done & positive
    with np.errstate(all="ignore"):
        for count in range(MAX_STEPS):
            value, slope = function(s)
            residual = np.log(goal / value)
            known = (slope > 0) & (slope < inf)
            # Where the slope is not finite, the residual gives only the direction, and convergence
            # is linear.
            step = where(known, residual / slope, residual)
            longest = where(known, _LAST_BUT_ONE, ROUNDING)
            size = abs(step)
            # A short step may merely mean that the function is steep here.
            short = (abs(residual) <= _LAST_BUT_ONE) & (size <= longest)
            converged = short & known & (size <= ROUNDING)
            proposed = s * np.exp(step)
            if every(done | converged):
                s, done = where(done, s, proposed), done | converged
                break
            low = where(value < goal, s, low)
            high = where(value > goal, s, high)
            last = short | ~_in_range(s)
            # Where the function hardly rises, a step leaves the range of doubles.
            inside = (proposed > low) & (proposed < high) & _in_range(proposed)
            usable = (inside & (count < _ALONE or count % 2 == 1)) | last
            moved = proposed if every(usable) else where(usable, proposed, _middle(low, high))
            moved = where(moved < LARGEST, where(moved > 1 / LARGEST, moved, 0.0), inf)
            # If the function has no value here, neither bound moves, and the next middle is here.
            if count >= _ALONE and every(done | (np.isnan(residual) & (moved == s))):
                break
            # A converged root does not change any more, so that it does not depend on the other
            # roots.
            s = where(done, s, moved)
            done = done | settling | converged
            if every(done):
                break
            # The rounding error of the middle itself is up to two spacings of doubles on either
            # side.
            settling = last | (high - low <= where(high < inf, 2 * EPS * high, 0.0))
    if some(known & ~done):
        raise DefectError("the inverse of a function did not converge")
    root = where(positive, np.maximum(s, root_at_zero), root_at_zero)
    return where(done, root, np.nan)


def _in_range(s: Array) -> Flags:
    """Return True where an argument lies between 1/`LARGEST` and `LARGEST`."""
    return (s > 1 / LARGEST) & (s < LARGEST)


def _middle(low: Array, high: Array) -> Array:
    """Geometric middle of the bracket, with the range of doubles in place of an open end."""
    return np.sqrt(np.maximum(low, TINY)) * np.sqrt(np.minimum(high, 1 / TINY))
