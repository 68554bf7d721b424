"""f, f', g and g' of every kind agree with the stored references at and beside breaks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tests.core.batches import batched
from tests.core.comparison import (
    DERIVED_BREAK,
    allowance,
    assert_each,
    profile_from,
    relative_error,
)
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Iterator

BOUND = 1e-13


def failures_of(case: dict[str, Any]) -> Iterator[str]:
    x = np.array(case["x"])
    profile = profile_from(case["profile"])
    derived = case["profile"]["kind"] in DERIVED_BREAK
    for name in ("f", "df", "g", "dg"):
        result = getattr(profile, name)(x)
        for index, expected in enumerate(case[name]):
            error = relative_error(float(result[index]), expected)
            bound = BOUND + (allowance(case[f"condition_{name}"][index]) if derived else 0.0)
            if not error <= bound:
                yield f"{name} at {x[index]!r}: {error:.2e} > {bound:.2e}"


@batched(bank.load("profile"))
def test_shape_and_equivalent_profile(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of)
