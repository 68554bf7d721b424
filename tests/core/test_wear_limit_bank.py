"""The limit of fretting wear against the stored bank, for every kind and pair of controls."""

from __future__ import annotations

from typing import Any

import pytest

from mdr_core import normal
from mdr_core.wear import limit
from tests.core.comparison import INPUT, profile_from, relative_error, wrong
from tests.oracles import wear_bank

BOUND = 1e-12
#: A table is a sum over its knots, and has the normal query's own bound.
TABLE = 1e-11
#: What is promised of the fields.
FIELD = 1e-11
#: Kinds whose radii carry the rounding of a real exponent, times a logarithm: their edges are
#: known to the profile's own rounding alone.
EXPONENTS = frozenset({"power", "series"})
CASES = wear_bank.load()


def name_of(case: dict[str, Any]) -> str:
    return str(case["id"])


def solved(case: dict[str, Any], given: Any = None) -> limit.LimitingWear:
    contact = normal.solve(
        profile_from(case["profile"]), case["e_star"], rtol=1e-13, **{case["control"]: case["load"]}
    )
    return limit.solve(
        contact,
        case["g_star"],
        case["friction_coefficient"],
        **{case["amplitude"]: case["given"] if given is None else given},
    )


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_answers_and_their_error_estimate(case: dict[str, Any]) -> None:
    found = solved(case)
    bound = TABLE if case["profile"]["kind"] == "tabulated" else BOUND
    failures = []
    for name, row in case["expected"].items():
        values = getattr(found, name)
        assert values.shape == (len(row),)
        for index, expected in enumerate(row):
            failures += wrong(
                f"{name} at {case['given'][index]!r}",
                float(values[index]),
                expected,
                bound,
                INPUT * case["condition"][name][index],
                found.error_estimate,
            )
    assert set(found.regime) == {"partial_slip"}
    depends = "path_dependent" in {notice.code for notice in found.warnings}
    assert depends == (case["equation"] == "(5.90)")
    assert not failures, failures


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_fields(case: dict[str, Any]) -> None:
    failures = []
    real = case["profile"]["kind"] in EXPONENTS
    doubt = INPUT + (profile_from(case["profile"]).rounding if real else 0.0)
    for fields in case["fields"]:
        found = solved(case, case["given"][fields["index"]])
        for name, row in fields["expected"].items():
            values = getattr(found, name)(fields["radius"])
            assert values.shape == (len(row),)
            for index, expected in enumerate(row):
                error = relative_error(float(values[index]), expected)
                bound = FIELD + doubt * (fields["condition"][name][index] or 0.0)
                if not error <= bound:
                    at = f"{name} at {fields['radius'][index]!r}"
                    failures.append(f"{at}: {values[index]!r}, {error:.2e} > {bound:.2e}")
    assert not failures, failures


@pytest.mark.parametrize("case", CASES[::5], ids=name_of)
def test_a_single_amplitude_is_answered_like_one_of_many(case: dict[str, Any]) -> None:
    found, alone = solved(case), solved(case, case["given"][0])
    for name in case["expected"]:
        value = getattr(alone, name)
        assert value.shape == ()
        # The same steps, perhaps summed in another order.
        expected = pytest.approx(float(getattr(found, name)[0]), rel=1e-13, abs=0)
        assert float(value) == expected, name
