"""The limit of fretting wear agrees with the stored references for every kind and control."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from mdr_core.elementwise import number
from mdr_core.wear import limit
from tests.core.batches import batched
from tests.core.comparison import (
    INPUT,
    allowance,
    assert_each,
    bound_of,
    contact_of,
    overstated,
    profile_from,
    relative_error,
    wrong,
)
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Iterator

BOUND = 1e-12
#: Relative error limit of the fields.
FIELD = 1e-11
#: The same, of the largest value, where the stick radius is that of a cap but for rounding.
NEXT_TO_CAP = 1e-9
#: The same for scalars where the contact ends next to a flat's edge b, and the stick radius up to
#: 100 times nearer: their distance from b is a difference of radii.
NEXT_TO_FLAT = {"b(1+1e-3)": 1e-11, "b(1+1e-6)": 1e-8}
#: Exponent from which on fields are compared with their largest value: others may underflow.
STEEP = 50
#: Kinds whose radii carry the rounding error of a real exponent times a logarithm; their edges are
#: accurate to the rounding error of the profile only.
EXPONENTS = frozenset({"power", "series"})
#: Largest ratio of estimate to largest admissible error.
OVERSTATED = 45.0
CASES = bank.load("wear_limit")


def sticks_up_to_cap(case: dict[str, Any]) -> bool:
    cap = case["profile"].get("cap_radius", inf)
    return any(abs(float(c) / cap - 1) < NEXT_TO_CAP for c in case["expected"]["stick_radius"])


def solved(case: dict[str, Any], given: Any = None) -> limit.LimitingWear:
    return limit.solve(
        contact_of(case),
        case["g_star"],
        case["friction_coefficient"],
        **{case["amplitude"]: case["given"] if given is None else given},
    )


def failures_of(case: dict[str, Any]) -> list[str]:
    result = solved(case)
    near = NEXT_TO_FLAT.get(case["tags"]["regime"], BOUND)
    bound = NEXT_TO_CAP if sticks_up_to_cap(case) else bound_of(case, near)
    failures, allowed = [], [bound]
    for name, row in case["expected"].items():
        values = getattr(result, name)
        assert values.shape == (len(row),)
        for index, expected in enumerate(row):
            by_inputs = allowance(case["condition"][name][index])
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
    assert set(result.regime) == {"partial_slip"}
    depends = "path_dependent" in {notice.code for notice in result.warnings}
    assert depends == (case["equation"] == "(5.90)")
    return failures


@batched(CASES)
def test_results_and_error_estimates(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of)


def field_failures(case: dict[str, Any]) -> Iterator[str]:
    real = case["profile"]["kind"] in EXPONENTS
    doubt = INPUT + (profile_from(case["profile"]).rounding_at(number(0.0)) if real else 0.0)
    for fields in case["fields"]:
        result = solved(case, case["given"][fields["index"]])
        for name, row in fields["expected"].items():
            values = getattr(result, name)(fields["radius"])
            assert values.shape == (len(row),)
            for index, expected in enumerate(row):
                error = relative_error(float(values[index]), expected)
                bound = FIELD + allowance(fields["condition"][name][index], rounding=doubt)
                steep = case["profile"].get("exponent", 0) >= STEEP
                if (steep or sticks_up_to_cap(case)) and isfinite(values[index]):
                    largest = max(each for each in map(float, row) if isfinite(each))
                    error = abs(values[index] - float(expected)) / largest
                    bound = max(bound, NEXT_TO_CAP)
                if not error <= bound:
                    at = f"{name} at {fields['radius'][index]!r}"
                    yield f"{at}: {values[index]!r}, {error:.2e} > {bound:.2e}"


@batched(CASES)
def test_fields(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, field_failures)
