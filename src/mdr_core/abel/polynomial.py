"""Stress integrals of a weight that is economised to a short polynomial: closed, without nodes.

A profile's g' is analytic far beyond the contact, seen in s^2 = x^2 - b^2. Where a few powers give
it to the asked tolerance, so do the closed integrals of the powers: the weight is positive, and
what it lacks relatively the integral lacks at most. Source: notes, §5.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate, repeat
from math import ceil, log2
from operator import mul
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.interpolation import chebyshev_points
from mdr_core.typing import Array

#: The loosest tolerances, for which a tenth of what is asked is left out.
COARSE: Final = 1e-8
# Of tighter ones nothing is left out but this, and beyond the finest a rule's rounding is smaller.
_EXACT: Final = 1e-14
_FINEST: Final = 1e-12
# An interval stands for all that are shorter by up to this part of an octave.
_PARTS: Final = 4
_SHORTEST: Final = 2.0**-5
# Terms of each sum, so that there always are some.
_FEWEST: Final = 3
_DEGREE: Final = 32
_PLACES, _TO_COEFFICIENTS = chebyshev_points(_DEGREE + 1)
# The places on [0, 1].
_SPREAD: Final[Array] = np.asarray((_PLACES + 1) * 0.5)
_EPSILON: Final = float(np.finfo(float).eps)
# Powers x points handled at once: they stay in the processor's cache.
_BLOCK: Final = 32_768
# So many roundings of the largest term are not seen.
_ROUNDINGS: Final = 16.0


def interval(square: float) -> int:
    """Number of the shortest interval on offer, [0, end(number)], that holds the square."""
    return ceil(_PARTS * log2(max(square, _SHORTEST)))


def end(number: int) -> float:
    """Where that interval ends."""
    return float(2.0 ** (number / _PARTS))


def single(*parts: Array | None) -> bool:
    """Whether all of them are those of one contact."""
    return all(part is None or part.size == 1 for part in parts)


class Inner(NamedTuple):
    """The lower end c of an annulus, seen from each point."""

    leg: Array
    """s^(1-p) e there, zero for c < r."""
    square: float
    """s^2."""
    gap: float
    """By how much that is less than the upper end's, with the digits of a narrow annulus."""


@dataclass(frozen=True, eq=False)
class StressPolynomial:
    """The weight s^p (c_0 + c_1 s^2 + ...), p = 1 if odd, p = 0 if even; the unit is where it ends.

    With e^2 = s^2 + delta, I_n = int s^n ds/e = [s^(n-1) e - (n - 1) delta I_(n-2)]/n, so that
    the integral is a polynomial in delta times s^(1-p) e, and for p = 0 another times the arc.
    Source: notes, §5.
    """

    table: Array
    """Coefficients of delta^j that stand with s^(1-p) e s^2m; in the last row of an even weight
    those that stand with the arc. Shape (m, j)."""

    def between(
        self, delta: Array, step: Array, upper2: float, arc: Array | None, inner: Inner | None
    ) -> Array:
        """The integral of the weight over e, at each delta.

        `step` is what s^(1-p) e grows by, and `arc` what arcsinh(s/sqrt(delta)) does, for an even
        weight; `upper2` is s^2 at the upper end. Without an `inner` end both start from nothing.
        """
        count = len(self.table)
        factors, ends = [step], [_powers_of(upper2, count)]
        if inner is not None:
            factors.append(inner.leg)
            ends.append(_steps(upper2, inner, count))
        if arc is not None:
            factors.append(arc)
            for of_end in ends:
                of_end[-1] = 0.0
            ends.append([0.0] * (count - 1) + [1.0])
        rows = np.array(ends) @ self.table
        powers = np.empty((count, min(_BLOCK // count, delta.size)))
        if delta.size == powers.shape[1]:
            return _summed(rows, delta, factors, powers)
        result = np.empty_like(delta)
        for start in range(0, delta.size, powers.shape[1]):
            part = slice(start, start + powers.shape[1])
            result[part] = _summed(rows, delta[part], [factor[part] for factor in factors], powers)
        return result


def _summed(rows: Array, delta: Array, factors: list[Array], powers: Array) -> Array:
    """Each row's polynomial in delta times its factor, all together; `powers` is overwritten."""
    parts = rows @ _raised(delta, powers[:, : delta.size])
    value: Array = parts[0]
    value *= factors[0]
    for row, factor in enumerate(factors[1:], start=1):
        parts[row] *= factor
        value += parts[row]
    return value


def _powers_of(square: float, count: int) -> list[float]:
    return list(accumulate(repeat(square, count - 1), mul, initial=1.0))


def _steps(upper2: float, inner: Inner, count: int) -> list[float]:
    """a^2m - c^2m for m from 0 on: sums of positive terms."""
    steps, power = [0.0], 1.0
    for _ in range(count - 1):
        steps.append(steps[-1] * upper2 + power * inner.gap)
        power *= inner.square
    return steps


def _raised(delta: Array, powers: Array) -> Array:
    """delta^j in the rows j = 0, 1, ... of `powers`."""
    powers[0], powers[1] = 1, delta
    done, count = 1, len(powers)
    while done < count - 1:
        more = min(done, count - 1 - done)
        np.multiply(powers[1 : 1 + more], powers[done], out=powers[done + 1 : done + 1 + more])
        done += more
    return powers


def economised(
    weight: Callable[[Array], Array],
    ends: tuple[float, float],
    rtol: float,
    *,
    odd: bool,
    starts: int = 0,
) -> StressPolynomial | None:
    """Return the shortest polynomial of q^starts weight(q), weight > 0, or None if it is too long.

    It holds between the ends, 0 <= q, and is one of q over the upper end.
    """
    if rtol < _FINEST:
        return None
    low, high = ends
    values = weight(low + (high - low) * _SPREAD)
    found = _TO_COEFFICIENTS @ values
    accuracy = rtol / 10 if rtol >= COARSE else _EXACT
    # What is left out from each coefficient on; twice, for what the interpolation itself lacks.
    left_out = 2 * np.cumsum(np.abs(found[::-1]))[::-1] / values.min()
    if not left_out[-1] <= accuracy:
        return None
    count = max(int(np.argmax(left_out <= accuracy)), _FEWEST)
    powers = _in_powers(found[:count], low / high)
    if np.abs(powers).sum() * _ROUNDINGS * _EPSILON > accuracy * values.min():
        return None
    return _tabulated(np.append(np.zeros(starts), powers * high**starts), odd=odd)


def _in_powers(coefficients: Array, low: float) -> Array:
    """The powers of q of a sum of Chebyshev's polynomials on [low, 1], by their recurrence."""
    count = coefficients.size
    scale, shift = 2 / (1 - low), -(1 + low) / (1 - low)
    before, this = np.zeros(count), np.zeros(count)
    before[0] = 1
    this[:2] = shift, scale
    result: Array = coefficients[0] * before + coefficients[1] * this
    for coefficient in coefficients[2:].tolist():
        following = 2 * shift * this - before
        following[1:] += 2 * scale * this[:-1]
        before, this = this, following
        result += coefficient * this
    return result


def _tabulated(coefficients: Array, *, odd: bool) -> StressPolynomial:
    """The table of a weight: the m-th row is what goes with s^(n-1) e, n = 2m + 1 or 2m + 2."""
    count, first = coefficients.size, 1 if odd else 2
    rows = count if odd else count - 1
    n = first + 2 * np.arange(rows)[:, None]
    j = np.arange(count)
    # 1/n of I_n itself, and as I_(n+2j) comes down to it, -(n + 2j - 1)/(n + 2j) by each step.
    factors = -(n + 2 * j - 1) / (n + 2 * j)
    factors[:, 0] = 1 / n[:, 0]
    place = np.arange(rows)[:, None] + j + (count - rows)
    padded = np.append(coefficients, np.zeros(count))
    table = np.cumprod(factors, axis=1) * padded[place]
    if odd:
        return StressPolynomial(table)
    of_arc = -(2 * j - 1) / np.maximum(2 * j, 1)
    return StressPolynomial(np.vstack((table, coefficients * np.cumprod(of_arc))))
