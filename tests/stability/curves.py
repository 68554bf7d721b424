"""Convergence towards limits where methods fail: error of this project and of a naive formula.

Each test module of this package lists curves in `CURVES`. The tests compare the project's error
with a bound; the charts draw the curves beside those of the naive formulas.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import isinf, mp, mpf
from numpy.typing import NDArray
from scipy.integrate import IntegrationWarning, quad

from tests.core.comparison import EPS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

Array = NDArray[np.float64]

#: Relative error limits of closed forms, and requested tolerance of quadrature.
CLOSED = 1e-13
RTOL = 1e-13
#: Allowance per unit of condition number: each input carries the rounding error of a double.
ROUNDING = 8 * EPS
MIN_POINTS = 30
#: Digits of the reference values: closed forms lose about thirty at the far ends.
DIGITS = 60


@dataclass(frozen=True)
class Curve:
    """Relative errors as a function of the distance from a limit."""

    name: str
    title: str
    distance: str
    """Axis label of the distance."""
    naive_formula: str
    distances: Array
    ours: Array
    naive: Array
    """Infinite where the naive formula fails or is not finite."""
    bound: Array

    def holds(self) -> None:
        """Assert that the project's error is within the bound at every distance."""
        assert self.distances.size >= MIN_POINTS
        assert self.ours.shape == self.naive.shape == self.bound.shape == self.distances.shape
        beyond = ~(self.ours <= self.bound)
        assert not beyond.any(), list(
            zip(self.distances[beyond], self.ours[beyond], self.bound[beyond], strict=True)
        )

    def naive_fails(self, error: float) -> None:
        """Assert that the naive formula reaches this error, so that the case is a hard one."""
        assert np.max(self.naive) >= error


def steps(first: float, last: float, count: int = 36) -> Array:
    """Geometrically spaced distances."""
    return np.geomspace(first, last, count)


def relative(value: float, exact: mpf) -> float:
    """Relative error; infinite if the value is not finite but the exact value is."""
    value = float(value)
    if isinf(exact):
        return 0.0 if value == float(exact) else float("inf")
    if not np.isfinite(value):
        return float("inf")
    if exact == 0:
        return 0.0 if value == 0 else float("inf")
    return float(abs((mpf(value) - exact) / exact))


def errors(values: Iterable[float], exact: Iterable[mpf]) -> Array:
    return np.array([relative(value, truth) for value, truth in zip(values, exact, strict=True)])


def references(formula: Callable[..., mpf], *arguments: Iterable[float]) -> list[mpf]:
    """Evaluate the formula for the exact doubles, with `DIGITS` digits."""
    with mp.workdps(DIGITS):
        return [+formula(*map(mpf, row)) for row in zip(*map(_row, arguments), strict=True)]


def _row(values: Iterable[float]) -> list[float]:
    return [float(value) for value in values]


def attempt(formula: Callable[..., Any], *arguments: Iterable[float]) -> Array:
    """Evaluate a naive formula row by row; NaN where it raises."""
    return np.array([_one(formula, row) for row in zip(*map(_row, arguments), strict=True)])


def _one(formula: Callable[..., Any], row: tuple[float, ...]) -> float:
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return float(formula(*(np.float64(value) for value in row)))
        except (ArithmeticError, ValueError):
            return float("nan")


def plain_quad(density: Callable[[float], float], low: float, high: float) -> float:
    """Adaptive quadrature by SciPy without substitution or break points."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IntegrationWarning)
        return float(quad(density, low, high, epsabs=0.0, epsrel=1e-12, limit=200)[0])


def curve(
    name: str,
    title: str,
    distance: str,
    naive_formula: str,
    distances: Array,
    results: tuple[Iterable[float], Iterable[float], Iterable[mpf]],
    bound: float | Array = CLOSED,
) -> Curve:
    """Build a curve from the project's, the naive and the exact results."""
    ours, naive, exact = results
    truth = list(exact)
    return Curve(
        name,
        title,
        distance,
        naive_formula,
        distances,
        errors(ours, truth),
        errors(naive, truth),
        np.broadcast_to(np.asarray(bound, dtype=float), distances.shape),
    )
