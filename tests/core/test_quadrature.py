"""Integrals of functions with poles next to the strip keep their accuracy."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core.quadrature import integrate

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

LENGTHS = (0.05, 0.2, 0.7, 1.5, 3.0, 6.0, 11.0, 20.0)
#: Error of the rule, and rounding error of a sum of about fifty positive terms.
BOUND = 1.1e-13

# Integrands with poles or branch points on the boundary of the strip, and their growth. Each is
# written once for arrays and mpmath.
FAMILY = {
    "sech": (lambda m, y: 1 / m.cosh(y), 2.0),
    "sech at 1": (lambda m, y: 1 / m.cosh(y - 1), 2.0),
    "sech at -4": (lambda m, y: 1 / m.cosh(y + 4), 2.0),
    "exp(2y) sech": (lambda m, y: m.exp(2 * y) / m.cosh(y), 2.0),
    "cosh^2": (lambda m, y: m.cosh(y) ** 2, 2.0),
    "cosh^2 + sech": (lambda m, y: m.cosh(y) ** 2 + 1 / m.cosh(y), 2.0),
    "y tanh": (lambda m, y: y * m.tanh(y), 2.0),
    "root": (lambda m, y: m.sqrt(m.cosh(y)), 2.0),
    "two roots": (lambda m, y: m.sinh(y) ** 2 / m.sqrt(1.2 + m.sinh(y) ** 2), 2.0),
    "cosh^6": (lambda m, y: m.cosh(y) ** 6, 6.0),
}


@cache
def exact(name: str, low: float, high: float) -> mpf:
    fn = FAMILY[name][0]
    with mp.workdps(30):
        # Subpanels a tenth of the strip's width are resolved safely.
        count = max(int((high - low) / 0.8), 1)
        ends = [mpf(low) + (mpf(high) - mpf(low)) * i / count for i in range(count + 1)]
        return mp.quad(lambda y: fn(mp, y), ends, method="gauss-legendre")


def relative_error(value: float, truth: mpf) -> float:
    return float(abs(mpf(value) / truth - 1))


@pytest.mark.parametrize("name", FAMILY)
def test_plain_integrals_are_exact_to_rounding(name: str) -> None:
    fn, growth = FAMILY[name]
    ends = [(low, low + length) for low in (0.0, 0.3, 2.0) for length in (1e-9, *LENGTHS)]
    lower, length = np.array(ends).T[0], np.array([high - low for low, high in ends])
    result = integrate(lambda y, _: fn(np, y), length, lower, growth=growth)
    for value, (low, high) in zip(result, ends, strict=True):
        assert relative_error(value, exact(name, low, high)) <= BOUND, (low, high)
