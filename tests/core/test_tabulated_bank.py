"""Tables: exact for the interpolant, and close to the smooth body that it samples."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mdr_core import fields
from mdr_core.normal import solve
from tests.core.comparison import INPUT, profile_from, relative_error, wrong
from tests.oracles import bank

INTERPOLANT = 1e-11
#: Relative to the answer, and for a pressure to the largest one away from the breaks.
SMOOTH = 1e-7

CASES = bank.load("tabulated")
WITH_FIELDS = [case for case in CASES if "radius" in case]
#: Contacts of many panels: smaller ones see the interpolant alone.
LARGE = [case for case in CASES if "truth" in case and "radius" in case]


def name_of(case: dict[str, Any]) -> str:
    return str(case["id"])


def solved(case: dict[str, Any]) -> Any:
    load = {case["control"]: case["load"]}
    return solve(profile_from(case["profile"]), case["e_star"], rtol=1e-12, **load)


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_answers_are_those_of_the_interpolant(case: dict[str, Any]) -> None:
    contact = solved(case)
    failures = []
    for name, expected in case["expected"].items():
        value, allowance = float(getattr(contact, name)), INPUT * case["condition"][name]
        failures += wrong(name, value, expected, INTERPOLANT, allowance, contact.error_estimate)
    assert not failures, failures


@pytest.mark.parametrize("name", ["f", "df", "g", "dg", "pressure"])
@pytest.mark.parametrize("case", WITH_FIELDS, ids=name_of)
def test_fields_are_those_of_the_interpolant(case: dict[str, Any], name: str) -> None:
    radii = np.array(case["radius"])
    if name == "pressure":
        found = fields.pressure(solved(case), radii, rtol=1e-12)
    else:
        found = getattr(profile_from(case["profile"]), name)(radii)
    # Near the axis a table has no relative accuracy: its slope there is rounding.
    largest = max(abs(float(value)) for value in case[name])
    failures = []
    for r, value, expected in zip(radii, found, case[name], strict=True):
        error = abs(float(value) - float(expected)) / largest
        if not error <= INTERPOLANT:
            failures.append(f"r = {r!r}: {error:.2e}")
    assert not failures, failures


@pytest.mark.parametrize("case", LARGE, ids=name_of)
def test_answers_are_close_to_the_smooth_body(case: dict[str, Any]) -> None:
    contact = solved(case)
    for name, expected in case["truth"].items():
        if case["control"] == "contact_radius" and name in {"indentation_depth", "normal_force"}:
            assert relative_error(float(getattr(contact, name)), expected) <= SMOOTH, name


@pytest.mark.parametrize("case", LARGE, ids=name_of)
def test_pressure_is_close_to_the_smooth_body(case: dict[str, Any]) -> None:
    radii = np.array(case["radius"])
    found = fields.pressure(solved(case), radii, rtol=1e-12)
    truth = np.array([float(p) for p in case["truth_pressure"]])
    # Inside the first panel the interpolant's tip has a slope, and p a weak logarithm.
    seen = radii > case["profile"]["r"][1]
    assert np.max(np.abs(found - truth)[seen]) <= SMOOTH * np.max(truth)
