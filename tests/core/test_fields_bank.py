"""Traction, slip, displacement and foundation loads agree with the stored references.

The radii come as close as 1e-9 to the axis, the break, the stick radius and the contact edge, on
both sides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mdr_core import fields
from tests.core.batches import batched
from tests.core.comparison import (
    allowance,
    assert_each,
    relative_error,
)
from tests.core.test_tangential_bank import solved
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mdr_core.typing import Array

BOUND = 1e-11
#: Largest allowance, for slip of 1e-18 of the largest, 1e-9 beyond a stick radius that is rounded.
NEXT_TO_STICK = 1.3e-2
#: Error limit of the cone's traction on the axis, where its pressure is infinite.
AXIS = 1e-12
CASES = bank.load("slip_fields")
OF_NORMAL = frozenset({"normal_displacement", "foundation_load"})
FIELDS = ("shear_stress", "slip", "normal_displacement", "foundation_load", "foundation_shear")


def computed(case: dict[str, Any], name: str) -> Any:
    contact = solved(case)
    source = contact.normal if name in OF_NORMAL else contact
    return getattr(fields, name)(source, case["radius"])


def misses(case: dict[str, Any], name: str, result: Array) -> Iterator[str]:
    """Values of a field at the radii of a case that exceed their bound."""
    for index, expected in enumerate(case["expected"][name]):
        error = relative_error(float(result[index]), expected)
        bound = BOUND + allowance(case["condition"][name][index], largest=NEXT_TO_STICK)
        if not error <= bound:
            radius = case["radius"][index]
            yield f"{name} at {radius!r}: {result[index]!r}, {error:.2e} > {bound:.2e}"


def failures_of(case: dict[str, Any]) -> Iterator[str]:
    for name in FIELDS:
        result = computed(case, name)
        assert result.shape == (len(case["radius"]),)
        yield from misses(case, name, result)


@batched(CASES)
def test_fields(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of)


CONES = [case for case in CASES if case["profile"]["kind"] == "cone" and 0.0 in case["radius"]]


@batched(CONES)
def test_traction_is_finite_on_the_axis_of_a_cone(cases: list[dict[str, Any]]) -> None:
    for case in cases:
        index = case["radius"].index(0.0)
        result = computed(case, "shear_stress")[index]
        bound = AXIS + allowance(case["condition"]["shear_stress"][index])
        assert relative_error(float(result), case["expected"]["shear_stress"][index]) <= bound
        assert np.isposinf(fields.pressure(solved(case).normal, [0.0]))
