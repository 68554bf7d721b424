"""Force, displacement, stick radius and slip width of every stored case, by every control."""

from __future__ import annotations

from typing import Any

import pytest

from mdr_core import normal, tangential
from tests.core.comparison import INPUT, profile_from, wrong
from tests.oracles import slip_bank

BOUND = 1e-12
#: A table is a sum over its knots, and has the normal query's own bound.
TABLE = 1e-11


def name_of(case: dict[str, Any]) -> str:
    return str(case["id"])


def solved(case: dict[str, Any]) -> tangential.TangentialContact:
    contact = normal.solve(
        profile_from(case["profile"]), case["e_star"], rtol=1e-13, **slip_bank.normal_load(case)
    )
    return tangential.solve(
        contact,
        case["g_star"],
        case["friction_coefficient"],
        **{case["tangential_control"]: case["given"]},
    )


@pytest.mark.parametrize("case", slip_bank.load("tangential"), ids=name_of)
def test_answers_and_their_error_estimate(case: dict[str, Any]) -> None:
    found = solved(case)
    bound = TABLE if case["profile"]["kind"] == "tabulated" else BOUND
    failures = []
    for name, row in case["expected"].items():
        values = getattr(found, name)
        assert values.shape == (len(row),)
        for index, expected in enumerate(row):
            conditions = (case["condition"][name][index], case["condition_load"][name][index])
            failures += wrong(
                f"{name} at {case['given'][index]!r}",
                float(values[index]),
                expected,
                bound,
                INPUT * sum(conditions),
                found.error_estimate,
            )
    assert list(found.regime) == case["regime"]
    assert not failures, failures


@pytest.mark.parametrize("case", slip_bank.load("tangential")[::7], ids=name_of)
def test_a_single_load_is_answered_like_one_of_many(case: dict[str, Any]) -> None:
    found = solved(case)
    alone = solved({**case, "given": case["given"][0]})
    for name in case["expected"]:
        value = getattr(alone, name)
        assert value.shape == ()
        # The same steps, perhaps summed in another order.
        expected = pytest.approx(float(getattr(found, name)[0]), rel=1e-14, abs=0)
        assert float(value) == expected, name
