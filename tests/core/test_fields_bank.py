"""Traction, slip, displacement and the foundation's loads at stored radii.

Within 1e-9 of the axis, the break, the stick radius and the contact's edge, on both sides.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mdr_core import fields
from tests.core.comparison import INPUT, relative_error
from tests.core.test_tangential_bank import name_of, solved
from tests.oracles import slip_bank

BOUND = 1e-11
#: What is promised of the cone's traction on the axis, where its pressure is infinite.
AXIS = 1e-12
CASES = slip_bank.load("slip_fields")
OF_NORMAL = frozenset({"normal_displacement", "foundation_load"})
FIELDS = ("shear_stress", "slip", "normal_displacement", "foundation_load", "foundation_shear")


def computed(case: dict[str, Any], name: str) -> Any:
    contact = solved(case)
    source = contact.normal if name in OF_NORMAL else contact
    options = {} if name.startswith("foundation") else {"rtol": 1e-13}
    return getattr(fields, name)(source, case["radius"], **options)


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_field(case: dict[str, Any], name: str) -> None:
    found = computed(case, name)
    assert found.shape == (len(case["radius"]),)
    failures = []
    for index, expected in enumerate(case["expected"][name]):
        error = relative_error(float(found[index]), expected)
        bound = BOUND + INPUT * (case["condition"][name][index] or 0.0)
        if not error <= bound:
            radius = case["radius"][index]
            failures.append(f"r = {radius!r}: {found[index]!r}, {error:.2e} > {bound:.2e}")
    assert not failures, failures


CONES = [case for case in CASES if case["profile"]["kind"] == "cone" and 0.0 in case["radius"]]


@pytest.mark.parametrize("case", CONES, ids=name_of)
def test_the_cone_s_axis_carries_a_finite_traction(case: dict[str, Any]) -> None:
    index = case["radius"].index(0.0)
    found = computed(case, "shear_stress")[index]
    bound = AXIS + INPUT * (case["condition"]["shear_stress"][index] or 0.0)
    assert relative_error(float(found), case["expected"]["shear_stress"][index]) <= bound
    assert np.isposinf(fields.pressure(solved(case).normal, [0.0]))
