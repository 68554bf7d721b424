"""Depth, force and radius agree with the stored references under each of the controls."""

from __future__ import annotations

from typing import Any

from tests.core.batches import batched
from tests.core.comparison import allowance, assert_each, bound_of, contact_of, overstated, wrong
from tests.oracles import bank

BOUND = 1e-13
#: Largest ratio of estimate to largest admissible error.
OVERSTATED = 5.0


def failures_of(case: dict[str, Any]) -> list[str]:
    contact = contact_of(case)
    allowances = {name: allowance(condition) for name, condition in case["condition"].items()}
    bound = bound_of(case, BOUND)
    failures = overstated(
        contact.error_estimate, (bound + each for each in allowances.values()), OVERSTATED
    )
    for name, expected in case["expected"].items():
        value = float(getattr(contact, name))
        failures += wrong(name, value, expected, bound, allowances[name], contact.error_estimate)
    return failures


@batched(bank.load("normal"))
def test_results_and_error_estimates(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of)
