"""Every error estimate of the whole bank against the true error: never below, and not far above.

A case is one query; its estimate holds for the worst of its answers, and so does its error. The
true error is not known better than to half a unit in the last place, so that an estimate is
measured by no less: an exact answer does not make an estimate of 3e-14 too large by infinity.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

from mdr_core import history, normal
from tests.core.comparison import EPS, profile_from, relative_error
from tests.core.test_history_bank import material, misses
from tests.core.test_tangential_bank import solved as pushed
from tests.core.test_wear_limit_bank import solved as worn
from tests.oracles import bank

#: How far above the true error an estimate may lie, and for which part of the cases.
FACTOR, PART = 1e4, 0.95
FLOOR = EPS / 2


class Measured(NamedTuple):
    """One case: what was estimated, and what was found."""

    name: str
    estimate: float
    error: float

    @property
    def above(self) -> float:
        return self.estimate / max(self.error, FLOOR)


def largest_error(found: Any, expected: dict[str, list[str]]) -> float:
    return max(
        relative_error(float(value), truth)
        for name, row in expected.items()
        for value, truth in zip(np.ravel(getattr(found, name)), row, strict=True)
    )


def measured(case: dict[str, Any], found: Any, expected: dict[str, Any]) -> Measured:
    rows = {name: row if isinstance(row, list) else [row] for name, row in expected.items()}
    return Measured(str(case["id"]), found.error_estimate, largest_error(found, rows))


def of_normal() -> list[Measured]:
    def solved(case: dict[str, Any]) -> normal.NormalContact:
        load = {case["control"]: case["load"]}
        return normal.solve(profile_from(case["profile"]), case["e_star"], rtol=1e-13, **load)

    return [measured(case, solved(case), case["expected"]) for case in bank.load("normal")]


def of_tangential() -> list[Measured]:
    cases = bank.load("tangential")
    return [measured(case, pushed(case), case["expected"]) for case in cases]


def of_wear_limits() -> list[Measured]:
    return [measured(case, worn(case), case["expected"]) for case in bank.load("wear_limit")]


def of_paths() -> list[Measured]:
    """Relative to the largest value on the way, as a history's estimate is meant."""
    found = []
    for case in bank.load("history_paths"):
        names = ("indentation_depth", "tangential_displacement")
        followed = history.solve(*material(case), **{name: case[name] for name in names})
        errors = misses(case, followed)
        found.append(Measured(str(case["id"]), followed.error_estimate, max(errors.values())))
    return found


def of_cycles() -> list[Measured]:
    """Of a cycle's loss and stiffness, the second of two equal cycles."""
    found = []
    for case in bank.load("history_cycles"):
        estimate = error = 0.0
        for index, amplitude in enumerate(case["given"]):
            loads = {case["control"]: case["load"], case["tangential_control"]: amplitude}
            followed = history.cycles(*material(case), **loads, count=2)
            estimate = max(estimate, followed.history.error_estimate)
            for name in ("energy_per_cycle", "secant_stiffness"):
                found_there = float(getattr(followed, name)[1])
                error = max(error, relative_error(found_there, case["expected"][name][index]))
        found.append(Measured(str(case["id"]), estimate, error))
    return found


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


def test_estimates_are_near_the_true_error() -> None:
    cases = [case for name in BANKS for case in all_of(name)]
    far = sorted((case for case in cases if case.above > FACTOR), key=lambda case: -case.above)
    assert len(far) <= (1 - PART) * len(cases), far[:20]
