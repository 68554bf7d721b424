"""Pressure agrees with the stored references on the axis, at the edge and at breaks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdr_core import fields
from tests.core.batches import batched
from tests.core.comparison import (
    DERIVED_BREAK,
    allowance,
    assert_each,
    contact_of,
    relative_error,
)
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mdr_core.typing import Array

BOUND = 1e-12


def allowed(case: dict[str, Any], index: int) -> float:
    """Return the error due to rounding of a computed contact radius or break; others are exact."""
    names = []
    if case["control"] != "contact_radius":
        names += ["condition_load", "condition_edge"]
    if case["profile"]["kind"] in DERIVED_BREAK:
        names += ["condition_radius"]
    return allowance(*(case[name][index] for name in names))


def misses(case: dict[str, Any], result: Array) -> Iterator[str]:
    """Pressures at the radii of a case that exceed their bound."""
    for index, (radius, expected) in enumerate(zip(case["radius"], case["expected"], strict=True)):
        error = relative_error(float(result[index]), expected)
        bound = BOUND + allowed(case, index)
        if not error <= bound:
            yield f"r = {radius!r}: {error:.2e} > {bound:.2e}"


def failures_of(case: dict[str, Any]) -> Iterator[str]:
    return misses(case, fields.pressure(contact_of(case), case["radius"]))


@batched(bank.load("pressure"))
def test_pressure(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of)
