"""Tests of whether the residuals of a least-squares fit are white noise.

All regressors depend on the displacements and the order alone, so that the tests have their sizes
for independent errors of equal variance. Outliers are cut first. The probability for the curve is
the smallest one times the number of tests (Bonferroni).

Source: notes, §15.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.ndimage import convolve1d
from scipy.special import fdtrc, ndtr, ndtri
from scipy.stats import rankdata

from mdr_core.doubles import TINY
from mdr_core.errors import Notice
from mdr_core.typing import Array

FALSE_ALARM: Final = 0.01
"""Probability of a warning that is false."""
ROUNDING: Final = 1e-11
"""Scatter over the largest force that is rounding error."""
# Reversals below this part of the range are noise of the displacement.
_REVERSAL: Final = 0.05
# Huber's threshold and the cut, over the standard deviation from the median: 95 % as efficient as
# least squares for normal errors, of which 0.3 % exceed the cut; and the number of iterations.
_HUBER, _CUT, _STEPS = 1.5, 3.0, 6
# Standard deviation over the median of the absolute values, for normal errors.
_BY_MEDIAN: Final = 1.4826
# Residuals over the step of rounded forces: below the first they show the rounding alone, below the
# second their size varies with it.
_ROUNDED, _STEPPED = 0.6, 2.0
# Maximum numbers of polynomials of the depth, of each branch, and of the size of the residuals.
_DEPTH, _BRANCH, _SCATTER = 8, 4, 3
# Relative size below which a regressor depends linearly on the parameters or on other regressors.
_CONTAINED: Final = 1e-6
# Maximum number of polynomials of the time.
_TIME: Final = 4
# More general warning in place of one whose cause a caller does not distinguish.
_GENERAL: Final = {"two_branches": "misfit", "drift": "correlated_noise"}
# Fewest points of a branch.
_FEWEST: Final = 3


def directions(x: Array) -> Array:
    """Return 1 where a displacement rises and -1 where it falls; turning points end a branch.

    Reversals below 5 % of the range are noise.
    """
    least, sign, begin, far = _REVERSAL * np.ptp(x), 0, 0, 0
    low = high = 0
    signs = np.ones(x.size)
    for i, value in enumerate(x.tolist()):
        if not sign:
            low, high = (i if value < x[low] else low), (i if value > x[high] else high)
            if x[high] - x[low] > least:
                sign, far, begin = (1 if high > low else -1), max(high, low), min(high, low)
                signs[:begin] = -sign
        elif sign * (value - x[far]) >= 0:
            far = i
        elif sign * (x[far] - value) > least:
            signs[begin : far + 1] = sign
            begin, far, sign = far + 1, i, -sign
    signs[begin:] = sign or 1
    return signs


def rank(x: Array) -> Array:
    """Return the places of values in ascending order, from -1 to 1; ties share the mean."""
    return np.asarray(2 * (rankdata(x) - 1) / max(x.size - 1, 1) - 1)


def misfit(
    depth: Array, q: Array, residual: Array, force: Array, *, in_time: bool = False
) -> dict[str, float]:
    """Return the probability of residuals like these by chance, by the code of the warning.

    Parameters
    ----------
    depth, force : the curve in its order, shape (k,).
    q : orthonormal slopes of the fitted forces in the parameters, shape (k, p).
    residual : measured less fitted forces, shape (k,).
    in_time : True to test neighbours in the order of the curve, and for a drift, in place of the
        scatter over the depth.
    """
    left, cut, step = _prepared(q, residual, force)
    size = float(np.sqrt(np.mean(np.square(residual))))
    if size <= ROUNDING * np.abs(force).max() or size < _ROUNDED * step:
        return {}
    free, x, sign = depth.size - q.shape[1], rank(depth), directions(depth)
    found = {"misfit": _f_test(q, cut, _polynomials(x, min(_DEPTH, free // 3)))}
    order = np.arange(depth.size) if in_time else np.argsort(depth, kind="stable")
    found["correlated_noise"] = _lag(q, cut, order)
    if min(np.sum(sign > 0), np.sum(sign < 0)) >= _FEWEST:
        even = legendre.legvander(x, max(min(_BRANCH, free // 4) - 1, 0))
        found["two_branches"] = _f_test(q, cut, sign[:, None] * even)
    if in_time:
        time = np.linspace(-1.0, 1.0, depth.size)
        found["drift"] = _f_test(q, cut, _polynomials(time, min(_TIME, free // 3)))
        return found
    if size >= _STEPPED * step:
        spread = np.sqrt(np.maximum(1 - np.sum(q * q, axis=1), _CONTAINED))
        score = ndtri((rankdata(np.abs(left) / spread) - 0.375) / (depth.size + 0.25))
        mean = np.full((depth.size, 1), depth.size**-0.5)
        found["noise_grows"] = _f_test(mean, score - score.mean(), _polynomials(x, _SCATTER))
    return found


def judged(
    found: Mapping[str, float], causes: Mapping[str, str], remedy: str = ""
) -> tuple[float, tuple[Notice, ...]]:
    """Return the joint probability of all tests, and the warning that residuals are not noise.

    Parameters: the result of `misfit`; causes by warning code, of which `_GENERAL` replaces missing
    ones; a remedy of a misfit.
    """
    code = min(found, key=lambda each: found[each], default="misfit")
    joint = min(1.0, len(found) * found[code]) if found else 1.0
    if joint >= FALSE_ALARM:
        return joint, ()
    if code == "correlated_noise" and found["misfit"] * len(found) < FALSE_ALARM:
        code = "misfit"
    code = code if code in causes else _GENERAL[code]
    message = (
        f"the residuals are not noise (probability {joint:.1g}), and the standard errors do not "
        f"hold: {causes[code]}{remedy if code == 'misfit' else ''}"
    )
    return joint, (Notice(code, message, joint, FALSE_ALARM),)


def _prepared(q: Array, residual: Array, force: Array) -> tuple[Array, Array, float]:
    """Return the residuals of a robust fit, the cut residuals, and the step of rounding.

    The robust fit is linear about the least squares: another minimum would change the sizes.
    """
    r = left = residual - q @ (q.T @ residual)
    for _ in range(_STEPS):
        scale = _BY_MEDIAN * float(np.median(np.abs(left))) or float(np.std(left)) or 1.0
        root = np.sqrt(_HUBER * scale / np.maximum(np.abs(left), _HUBER * scale))
        left = r - q @ np.linalg.lstsq(q * root[:, None], r * root, rcond=None)[0]
    free = max(r.size - q.shape[1], 1)
    scale = _BY_MEDIAN * float(np.median(np.abs(left))) * np.sqrt(r.size / free)
    scale = scale or float(np.std(left)) or 1.0
    cut = np.clip(left, -_CUT * scale, _CUT * scale)
    steps = np.diff(np.unique(force))
    parts = steps / steps.min(initial=np.inf)
    # Decimal numbers are multiples of the step within their own rounding.
    rounded = steps.size and np.abs(parts - np.round(parts)).max() < 1e-3
    return left, cut - q @ (q.T @ cut), float(steps.min()) if rounded else 0.0


def _polynomials(x: Array, degree: int) -> Array:
    return np.asarray(legendre.legvander(x, degree)[:, 1:])


def _f_test(q: Array, r: Array, regressors: Array) -> float:
    """Probability of the part of the residuals in regressors, by the F-distribution."""
    if not regressors.size:
        return 1.0
    u, size, _ = np.linalg.svd(regressors - q @ (q.T @ regressors), full_matrices=False)
    u = u[:, size > _CONTAINED * np.linalg.norm(regressors)]
    count, free = u.shape[1], r.size - q.shape[1] - u.shape[1]
    if not count or free < _FEWEST:
        return 1.0
    part = float(np.sum(np.square(u.T @ r)))
    rest = max(float(r @ r) - part, TINY)
    return float(fdtrc(count, free, part / count / (rest / free)))


def _lag(q: Array, r: Array, order: NDArray[np.intp]) -> float:
    """Probability of the correlation of neighbours (Durbin and Watson), given the slopes."""
    q, r = q[order], r[order]
    free = r.size - q.shape[1]
    if free < _FEWEST:
        return 1.0

    def neighbours(v: Array) -> Array:
        return np.asarray(convolve1d(v, [0.5, 0.0, 0.5], axis=0, mode="constant"))

    moved = neighbours(q)
    inside = q.T @ moved
    mean = -np.trace(inside) / free
    square = (r.size - 1) / 2 - 2 * np.sum(moved * moved) + np.sum(inside * inside)
    variance = 2 * (square - free * mean**2) / (free * (free + 2))
    away = (float(r @ neighbours(r)) / max(float(r @ r), TINY) - mean) / np.sqrt(
        max(variance, TINY)
    )
    return float(2 * ndtr(-abs(away)))
