"""Depth, force and radius of every stored case, by every control."""

from __future__ import annotations

from typing import Any

import pytest

from mdr_core.normal import solve
from tests.core.comparison import INPUT, profile_from, wrong
from tests.oracles import bank

BOUND = 1e-13


@pytest.mark.parametrize("case", bank.load("normal"), ids=lambda case: str(case["id"]))
def test_answers_and_their_error_estimate(case: dict[str, Any]) -> None:
    load = {case["control"]: case["load"]}
    contact = solve(profile_from(case["profile"]), case["e_star"], rtol=1e-13, **load)
    failures = []
    for name, expected in case["expected"].items():
        value, allowance = float(getattr(contact, name)), INPUT * case["condition"][name]
        failures += wrong(name, value, expected, BOUND, allowance, contact.error_estimate)
    assert not failures, failures
