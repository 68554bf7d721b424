"""Tables: exact for the interpolant, and close to the smooth body that it samples."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mdr_core import fields
from mdr_core.normal import solve
from tests.core.batches import batched
from tests.core.comparison import (
    INPUT,
    assert_each,
    overstated,
    profile_from,
    relative_error,
    wrong,
)
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Iterator

INTERPOLANT = 1e-12
#: Relative to the result; for a pressure, to the largest one away from the breaks.
SMOOTH = 1e-7

CASES = bank.load("tabulated")
WITH_FIELDS = [case for case in CASES if "radius" in case]
#: Contacts over many panels; smaller ones depend on the interpolant only.
LARGE = [case for case in CASES if "truth" in case and "radius" in case]


def solved(case: dict[str, Any]) -> Any:
    load = {case["control"]: case["load"]}
    return solve(profile_from(case["profile"]), case["e_star"], rtol=1e-12, **load)


def result_failures(case: dict[str, Any]) -> list[str]:
    contact = solved(case)
    allowances = {name: INPUT * condition for name, condition in case["condition"].items()}
    failures = overstated(
        contact.error_estimate, (INTERPOLANT + each for each in allowances.values()), 1.0
    )
    for name, expected in case["expected"].items():
        value, allowance = float(getattr(contact, name)), allowances[name]
        failures += wrong(name, value, expected, INTERPOLANT, allowance, contact.error_estimate)
    return failures


@batched(CASES)
def test_results_are_those_of_the_interpolant(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, result_failures)


def field_failures(case: dict[str, Any]) -> Iterator[str]:
    radii, profile = np.array(case["radius"]), profile_from(case["profile"])
    result = {name: getattr(profile, name)(radii) for name in ("f", "df", "g", "dg")}
    result["pressure"] = fields.pressure(solved(case), radii, rtol=1e-12)
    for name, values in result.items():
        # Near the axis a table has no relative accuracy, since its slope there is rounding error.
        largest = max(abs(float(value)) for value in case[name])
        for r, value, expected in zip(radii, values, case[name], strict=True):
            error = abs(float(value) - float(expected)) / largest
            if not error <= INTERPOLANT:
                yield f"{name} at {r!r}: {error:.2e}"


@batched(WITH_FIELDS)
def test_fields_are_those_of_the_interpolant(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, field_failures)


def smooth_failures(case: dict[str, Any]) -> Iterator[str]:
    contact, radii = solved(case), np.array(case["radius"])
    for name, expected in case["truth"].items():
        if case["control"] == "contact_radius" and name in {"indentation_depth", "normal_force"}:
            error = relative_error(float(getattr(contact, name)), expected)
            if not error <= SMOOTH:
                yield f"{name}: {error:.2e}"
    result = fields.pressure(contact, radii, rtol=1e-12)
    truth = np.array([float(p) for p in case["truth_pressure"]])
    # Inside the first panel the interpolant's tip has a nonzero slope, and p a weak logarithm.
    seen = radii > case["profile"]["r"][1]
    error = np.max(np.abs(result - truth)[seen]) / np.max(truth)
    if not error <= SMOOTH:
        yield f"pressure: {error:.2e}"


@batched(LARGE)
def test_results_are_close_to_the_smooth_body(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, smooth_failures)
