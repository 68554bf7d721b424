"""Error estimates of bank cases are above the true error, and not far above.

A case is one query; the largest estimate and the largest true error of its results are compared.
True errors below half a unit in the last place are not resolved and count as half a unit.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

from mdr_core import history
from tests.core.comparison import EPS, contact_of, relative_error
from tests.core.test_history_bank import material, scaled_errors
from tests.core.test_tangential_bank import solved as pushed
from tests.core.test_wear_limit_bank import solved as worn
from tests.oracles import bank

#: Maximum ratio of estimate to true error, and the fraction of cases that must satisfy it.
FACTOR, FRACTION = 1e4, 0.95
FLOOR = EPS / 2


class Measured(NamedTuple):
    """Error estimate and true error of one case."""

    name: str
    estimate: float
    error: float

    @property
    def overestimation(self) -> float:
        return self.estimate / max(self.error, FLOOR)


def largest_error(computed: Any, expected: dict[str, list[str]]) -> float:
    return max(
        relative_error(float(value), truth)
        for name, row in expected.items()
        for value, truth in zip(np.ravel(getattr(computed, name)), row, strict=True)
    )


def measured(case: dict[str, Any], computed: Any, expected: dict[str, Any]) -> Measured:
    rows = {name: row if isinstance(row, list) else [row] for name, row in expected.items()}
    return Measured(str(case["id"]), computed.error_estimate, largest_error(computed, rows))


def of_normal() -> list[Measured]:
    return [measured(case, contact_of(case), case["expected"]) for case in bank.load("normal")]


def of_tangential() -> list[Measured]:
    cases = bank.load("tangential")
    return [measured(case, pushed(case), case["expected"]) for case in cases]


def of_wear_limits() -> list[Measured]:
    return [measured(case, worn(case), case["expected"]) for case in bank.load("wear_limit")]


def of_paths() -> list[Measured]:
    """Relative to the largest value on the load path, as defined for a history's estimate."""
    computed = []
    for case in bank.load("history_paths"):
        names = ("indentation_depth", "tangential_displacement")
        followed = history.solve(*material(case), **{name: case[name] for name in names})
        errors = scaled_errors(case, followed)
        computed.append(Measured(str(case["id"]), followed.error_estimate, max(errors.values())))
    return computed


def of_cycles() -> list[Measured]:
    """Dissipated energy and stiffness of the second of two identical cycles."""
    computed = []
    for case in bank.load("history_cycles"):
        estimate = error = 0.0
        for index, amplitude in enumerate(case["given"]):
            loads = {case["control"]: case["load"], case["tangential_control"]: amplitude}
            followed = history.cycles(*material(case), **loads, count=2)
            estimate = max(estimate, followed.error_estimate)
            for name in ("energy_per_cycle", "secant_stiffness"):
                found_there = float(getattr(followed, name)[1])
                error = max(error, relative_error(found_there, case["expected"][name][index]))
        computed.append(Measured(str(case["id"]), estimate, error))
    return computed


BANKS = {
    "normal": of_normal,
    "tangential": of_tangential,
    "wear limits": of_wear_limits,
    "paths": of_paths,
    "cycles": of_cycles,
}


@cache
def all_of(name: str) -> tuple[Measured, ...]:
    return tuple(BANKS[name]())


@pytest.mark.parametrize("name", BANKS)
def test_no_estimate_is_below_the_true_error(name: str) -> None:
    below = [case for case in all_of(name) if not case.estimate >= case.error]
    assert not below, below


def test_estimates_are_sharp() -> None:
    cases = [case for name in BANKS for case in all_of(name)]
    far = sorted(
        (case for case in cases if case.overestimation > FACTOR),
        key=lambda case: -case.overestimation,
    )
    assert len(far) <= (1 - FRACTION) * len(cases), far[:20]
