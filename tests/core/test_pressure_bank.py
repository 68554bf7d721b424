"""Pressure at stored radii: the axis, the edge and both sides of each break."""

from __future__ import annotations

from typing import Any

import pytest

from mdr_core import fields
from mdr_core.normal import solve
from tests.core.comparison import DERIVED_BREAK, INPUT, profile_from, relative_error
from tests.oracles import bank

BOUND = 1e-12


def allowance(case: dict[str, Any], index: int) -> float:
    """Nothing for a radius given exactly: only a depth or force, or a derived break, is uncertain.

    Where p is infinite there is no condition number, and none is needed.
    """
    total = 0.0
    if case["control"] != "contact_radius":
        # The contact radius is then an answer, rounded as such.
        total += INPUT * (case["condition_load"][index] or 0.0)
        total += INPUT * (case["condition_edge"][index] or 0.0)
    if case["profile"]["kind"] in DERIVED_BREAK:
        total += INPUT * (case["condition_radius"][index] or 0.0)
    return total


@pytest.mark.parametrize("case", bank.load("pressure"), ids=lambda case: str(case["id"]))
def test_pressure(case: dict[str, Any]) -> None:
    load = {case["control"]: case["load"]}
    contact = solve(profile_from(case["profile"]), case["e_star"], rtol=1e-13, **load)
    found = fields.pressure(contact, case["radius"], rtol=1e-13)
    failures = []
    for index, (radius, expected) in enumerate(zip(case["radius"], case["expected"], strict=True)):
        error = relative_error(float(found[index]), expected)
        bound = BOUND + allowance(case, index)
        if error > bound:
            failures.append(f"r = {radius!r}: {error:.2e} > {bound:.2e}")
    assert not failures, failures
