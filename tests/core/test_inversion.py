"""Inversion of increasing functions for which Newton's method alone fails."""

from collections.abc import Callable

import numpy as np
import pytest

from mdr_core.errors import DefectError
from mdr_core.inversion import invert
from mdr_core.typing import Array

Function = Callable[[Array], Array]
# Value, derivative and closed-form inverse. The first step from 1 leaves the bracket, or the slope
# on one side of a slope discontinuity misleads on the other.
CASES: dict[str, tuple[Function, Function, Function]] = {
    "steep beyond a slope discontinuity": (
        lambda s: s + 1e6 * np.maximum(s - 2.0, 0.0),
        lambda s: np.where(s > 2.0, 1e6 + 1, 1.0),
        lambda y: np.where(y > 2.0, 2.0 + (y - 2.0) / (1e6 + 1), y),
    ),
    "flat beyond a slope discontinuity": (
        lambda s: np.minimum(s, 2.0) + 1e-6 * np.maximum(s - 2.0, 0.0),
        lambda s: np.where(s > 2.0, 1e-6, 1.0),
        lambda y: np.where(y > 2.0, 2.0 + (y - 2.0) / 1e-6, y),
    ),
    "slope jumps to infinity": (
        lambda s: s + np.sqrt(np.maximum(s - 2.0, 0.0)),
        lambda s: np.where(s > 2.0, 1 + 0.5 / np.sqrt(np.maximum(s - 2.0, 0.0)), 1.0),
        lambda y: np.where(
            y > 2.0, 2.0 + np.square((y - 2.0) / (0.5 + np.sqrt(0.25 + np.maximum(y - 2.0, 0)))), y
        ),
    ),
    "unknown slope": (lambda s: s * s * s, lambda s: s * np.nan, np.cbrt),
    "power 100": (lambda s: s**100, lambda s: 100 * s**99, lambda y: y**0.01),
}
TARGETS = np.array([0.0, 1e-12, 0.3, 1.9999999, 2.0000001, 2.01, 7.0, 3e4])


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("start", [1e-9, 1.0, 2.0, 1e9])
@pytest.mark.parametrize("end", [np.inf, 1e13])
def test_inverse_from_any_start(name: str, start: float, end: float) -> None:
    function, slope, inverse = CASES[name]
    low, high = np.zeros(TARGETS.size), np.full(TARGETS.size, end)
    result = invert(
        lambda s: (function(s), s * slope(s) / function(s)),
        TARGETS,
        np.full(TARGETS.size, start),
        low,
        high,
        name,
    )
    root = inverse(TARGETS)
    condition = np.maximum(function(root) / (root * slope(root)), 1.0)
    # Without a slope, the last step may be as large as 1e-14.
    bound = np.where(np.isnan(condition), 1e-14, 4e-15 * condition)
    assert np.all(np.abs(result - root) <= bound * root)
    assert result[0] == 0


def test_bracket_encloses_the_root_for_wrong_slopes() -> None:
    """Wrong slopes send every step out of the bracket, which is then bisected."""
    seen: list[Array] = []

    def cube(s: Array) -> tuple[Array, Array]:
        seen.append(s)
        return s * s * s, np.full(1, 1e-3)

    one = np.ones(1)
    result = invert(cube, 8 * one, 3 * one, one / 8, 64 * one, "cube")
    # The last step, at most 1e-10, is a Newton step and is as wrong as the slope.
    assert result[0] == pytest.approx(2.0, rel=1e-10, abs=0)
    low, high = 1 / 8, 64.0
    for (s,) in seen:
        assert low * (1 - 1e-10) <= s <= high * (1 + 1e-10)
        low, high = (max(low, s), high) if s <= 2 else (low, min(high, s))


def test_unreachable_target_raises() -> None:
    one = np.ones(1)
    with pytest.raises(DefectError, match="a step did not converge"):
        invert(
            lambda s: (2 + np.sin(1e9 * s), one),
            5 * one,
            one,
            0 * one,
            2 * one + np.inf,
            "step",
        )


def test_root_below_the_range_of_doubles_is_zero() -> None:
    """Steps of limited length lead there: they do not halve the residual."""
    root = invert(
        lambda s: (s**0.125, np.full(s.shape, 0.125)),
        np.array([1e-50]),
        np.array([1.0]),
        np.zeros(1),
        np.full(1, np.inf),
        "power",
    )
    assert root == 0
