"""The stress integral of a power as a hypergeometric function, in two economised series.

F(rho) = int_rho^1 t^m / sqrt(t^2 - rho^2) dt has, with u^2 = 1 - rho^2 and q = (1 - m)/2,

    F = u 2F1(1, q; 3/2; u^2)                                           towards the edge,
    F = (u/m) 2F1(1, q; 1 - m/2; rho^2) + C rho^m                       towards the axis,
    C = (sqrt(pi)/2) Gamma(-m/2)/Gamma(q).

Each serves where its argument is at most 1/2. Source: notes, §5; dlmf, Eqs. (15.8.1), (15.8.4).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import inf, pi, sqrt
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import gamma, rgamma

from mdr_core.abel.interpolation import chebyshev_points
from mdr_core.typing import Array

# Of the plain series at 1/2, whose terms end at 1e-19, and of the polynomials made of it.
_TERMS: Final = 64
_DEGREE: Final = 22
_PLACES, _TO_COEFFICIENTS = chebyshev_points(_DEGREE + 1)
# Of each Chebyshev polynomial, the powers: integers.
_POWERS: Final = np.array(
    [
        np.pad(chebyshev.cheb2poly(unit[: degree + 1]), (0, _DEGREE - degree))
        for degree, unit in enumerate(np.eye(_DEGREE + 1))
    ]
)
# Next to an even power the axis' two parts cancel, and far above one its series grows first.
_MOST_LOST: Final = 4.0
_STEEPEST: Final = 6.0
# Beyond this a rule is asked: its rounding is smaller.
_FINEST: Final = 1e-12


@dataclass(frozen=True)
class MomentSeries:
    """F of one power to one tolerance: polynomials in 4 u^2 - 1 and 4 rho^2 - 1, highest first."""

    power: float
    edge: tuple[float, ...]
    axis: tuple[float, ...]
    factor: float

    def at(self, a: Array, r: Array) -> Array:
        """F(r/a), infinite on the axis for m < 0; 0 <= r <= a."""
        rho = r / a
        t = rho * rho
        near_edge = t > 0.5
        t *= 4
        t -= 1
        axis = _horner(self.axis, t)
        np.subtract(2, t, out=t)
        edge = _horner(self.edge, t)
        leg = a - r
        leg *= a + r
        np.sqrt(leg, out=leg)
        leg /= a
        axis *= leg
        edge *= leg
        if self.power < 0:
            with np.errstate(divide="ignore"):
                rho **= self.power
        else:
            rho **= self.power
        rho *= self.factor
        axis += rho
        np.copyto(axis, edge, where=near_edge)
        return axis


@lru_cache(maxsize=256)
def moment_series(power: float, rtol: float) -> MomentSeries | None:
    """The series of one power, m > -1, or None where they lose digits or are long."""
    q, factor = (1 - power) / 2, 0.0
    if rtol < _FINEST or power == 0 or not -1 < power <= _STEEPEST:
        return None
    if q > 0 or q != round(q):
        factor = float(sqrt(pi) / 2 * gamma(-power / 2) * rgamma(q))
    if not abs(factor) <= _MOST_LOST:
        return None
    # F is least at an end of the axis' half: it falls from there, or rises first.
    at_half = float(_series(q, 1.5, np.array(0.5)))
    least = min(sqrt(0.5) * at_half, 1 / power if power > 0 else inf)
    edge = _economised(lambda x: _series(q, 1.5, x), rtol * min(at_half, 1.0))
    axis = _economised(lambda x: _series(q, 1 - power / 2, x) / power, rtol * least)
    return MomentSeries(power, edge, axis, factor) if edge and axis else None


def _series(b: float, c: float, x: Array) -> Array:
    """2F1(1, b; c; x) for |x| <= 1/2."""
    k = np.arange(_TERMS)
    terms = np.cumprod(np.multiply.outer((b + k) / (c + k), x), axis=0)
    return np.asarray(1 + terms.sum(axis=0))


def _economised(function: Callable[[Array], Array], accuracy: float) -> tuple[float, ...]:
    """Its polynomial in t = 4x - 1 on [0, 1/2], highest first; empty where none is good enough."""
    coefficients = _TO_COEFFICIENTS @ function((_PLACES + 1) / 4)
    # What is left out from each coefficient on; twice, for what the interpolation itself lacks.
    left_out = 2 * np.cumsum(np.abs(coefficients[::-1]))[::-1]
    if left_out[-1] > accuracy:
        return ()
    count = max(int(np.argmax(left_out <= accuracy)), 2)
    return tuple((coefficients[:count] @ _POWERS[:count, :count])[::-1].tolist())


def _horner(coefficients: tuple[float, ...], t: Array) -> Array:
    value = t * coefficients[0]
    value += coefficients[1]
    for coefficient in coefficients[2:]:
        value *= t
        value += coefficient
    return value
