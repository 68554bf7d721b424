"""Sweeps towards the places where methods fail: our error, and that of the textbook's formula.

The test modules of this folder name in `CURVES` the functions that make them; their tests hold ours
against the bound, and the charts draw the same curves with the naive formula's beside them.
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

#: What the project promises of closed forms, and of quadrature asked for `RTOL`.
CLOSED = 1e-13
RTOL = 1e-13
#: An input is a double that stands for its neighbourhood: per unit of condition number.
ROUNDING = 8 * EPS
FEWEST = 30
#: Digits of the references: closed forms lose some thirty of them at the far ends.
DIGITS = 60


@dataclass(frozen=True)
class Curve:
    """Relative errors over the distance from a limit."""

    name: str
    title: str
    distance: str
    """What the distance is, as the label of its axis."""
    naive_formula: str
    distances: Array
    ours: Array
    naive: Array
    """Infinite where the naive formula fails or gives no number."""
    bound: Array

    def holds(self) -> None:
        """Assert that the sweep is one, and that our error is within the bound everywhere."""
        assert self.distances.size >= FEWEST
        assert self.ours.shape == self.naive.shape == self.bound.shape == self.distances.shape
        beyond = ~(self.ours <= self.bound)
        assert not beyond.any(), list(
            zip(self.distances[beyond], self.ours[beyond], self.bound[beyond], strict=True)
        )

    def naive_dies(self, error: float) -> None:
        """Assert that the naive formula does reach such an error: else it would be good enough."""
        assert np.max(self.naive) >= error


def steps(first: float, last: float, count: int = 36) -> Array:
    """Distances in geometric steps, rounded to doubles."""
    return np.geomspace(first, last, count)


def relative(value: float, exact: mpf) -> float:
    """Error relative to the exact value; what is no number is infinitely wrong."""
    value = float(value)
    if isinf(exact):
        return 0.0 if value == float(exact) else float("inf")
    if not np.isfinite(value):
        return float("inf")
    if exact == 0:
        return 0.0 if value == 0 else float("inf")
    return float(abs((mpf(value) - exact) / exact))


def errors(values: Iterable[float], exact: Iterable[mpf]) -> Array:
    """Relative errors of many values."""
    return np.array([relative(value, truth) for value, truth in zip(values, exact, strict=True)])


def references(formula: Callable[..., mpf], *arguments: Iterable[float]) -> list[mpf]:
    """The formula of the exact doubles, at `DIGITS` digits."""
    with mp.workdps(DIGITS):
        return [+formula(*map(mpf, row)) for row in zip(*map(_row, arguments), strict=True)]


def _row(values: Iterable[float]) -> list[float]:
    return [float(value) for value in values]


def attempt(formula: Callable[..., Any], *arguments: Iterable[float]) -> Array:
    """A naive formula over the rows; NaN where it raises."""
    return np.array([_one(formula, row) for row in zip(*map(_row, arguments), strict=True)])


def _one(formula: Callable[..., Any], row: tuple[float, ...]) -> float:
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return float(formula(*(np.float64(value) for value in row)))
        except (ArithmeticError, ValueError):
            return float("nan")


def plain_quad(density: Callable[[float], float], low: float, high: float) -> float:
    """The library's adaptive rule as it comes, no substitution and no break declared."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IntegrationWarning)
        return float(quad(density, low, high, epsabs=0.0, epsrel=1e-12, limit=200)[0])


def curve(
    name: str,
    title: str,
    distance: str,
    naive_formula: str,
    distances: Array,
    found: tuple[Iterable[float], Iterable[float], Iterable[mpf]],
    bound: float | Array = CLOSED,
) -> Curve:
    """A curve from our values, the naive ones and the exact ones."""
    ours, naive, exact = found
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
