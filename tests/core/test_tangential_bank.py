"""Force, displacement, stick radius and slip width agree with the stored references."""

from __future__ import annotations

from typing import Any

from mdr_core import tangential
from tests.core.batches import batched
from tests.core.comparison import (
    LARGEST_ALLOWANCE,
    allowance,
    assert_each,
    bound_of,
    contact_of,
    overstated,
    wrong,
)
from tests.oracles import bank

BOUND = 1e-12
#: Largest ratio of estimate to largest admissible error: for powers up to 60.
OVERSTATED = 150.0
#: Largest allowance where F_N is computed before F_x is compared with mu F_N: three roundings, of
#: a(d), F_N(a) and their ratio, at the largest condition number, 1.2e13. Next to full slip, the
#: stick radius has no more digits than that, and which of them are right depends on the processor.
COMPUTED_FORCE = 8e-3


def solved(case: dict[str, Any]) -> tangential.TangentialContact:
    return tangential.solve(
        contact_of(case),
        case["g_star"],
        case["friction_coefficient"],
        **{case["tangential_control"]: case["given"]},
    )


def failures_of(case: dict[str, Any]) -> list[str]:
    result = solved(case)
    controls = (case["control"], case["tangential_control"])
    computed = controls[0] != "normal_force" and controls[1] == "tangential_force"
    largest = COMPUTED_FORCE if computed else LARGEST_ALLOWANCE
    bound = bound_of(case, BOUND)
    failures, allowed = [], [bound]
    for name, row in case["expected"].items():
        values = getattr(result, name)
        assert values.shape == (len(row),)
        for index, expected in enumerate(row):
            conditions = (case["condition"][name][index], case["condition_load"][name][index])
            by_inputs = allowance(*conditions, largest=largest)
            allowed.append(bound + by_inputs)
            failures += wrong(
                f"{name} at {case['given'][index]!r}",
                float(values[index]),
                expected,
                bound,
                by_inputs,
                result.error_estimate,
            )
    failures += overstated(result.error_estimate, allowed, OVERSTATED)
    if list(result.regime) != case["regime"]:
        failures.append(f"regime is {result.regime}")
    return failures


@batched(bank.load("tangential"))
def test_results_and_error_estimates(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of)
