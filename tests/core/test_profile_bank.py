"""f, f', g and g' of every kind at stored radii, both sides of each break."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.core.comparison import DERIVED_BREAK, INPUT, profile_from, relative_error
from tests.oracles import bank

BOUND = 1e-13


@pytest.mark.parametrize("name", ["f", "df", "g", "dg"])
@pytest.mark.parametrize("case", bank.load("profile"), ids=lambda case: str(case["id"]))
def test_shape_and_image(case: dict[str, Any], name: str) -> None:
    x = np.array(case["x"])
    profile = profile_from(case["profile"])
    found = getattr(profile, name)(x)
    derived = case["profile"]["kind"] in DERIVED_BREAK
    failures = []
    for index, expected in enumerate(case[name]):
        error = relative_error(float(found[index]), expected)
        bound = BOUND + (INPUT * case[f"condition_{name}"][index] if derived else 0.0)
        if error > bound:
            failures.append(f"x = {x[index]!r}: {error:.2e} > {bound:.2e}")
    assert not failures, failures
