"""Stresses beneath the surface agree with the stored references, mainly at edges."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mdr_core import normal, tangential
from mdr_core.subsurface import error_estimate, stress
from tests.core.comparison import profile_from
from tests.oracles import bank


@pytest.mark.parametrize(
    "case", bank.load("subsurface"), ids=lambda case: str(case["profile"]["kind"])
)
def test_stress_tensor(case: dict[str, Any]) -> None:
    pressed = normal.solve(
        profile_from(case["profile"]), 1.0, contact_radius=case["contact_radius"]
    )
    contact = tangential.solve(
        pressed, 0.9, case["friction_coefficient"], stick_radius=case["stick_radius"]
    )
    points = np.array(case["points"]).T
    expected = np.array([[float(value) for value in row] for row in case["expected"]]).T
    result = np.array(stress(contact, *points, poissons_ratio=case["poissons_ratio"], body=2))
    error = np.abs(result - expected).max() / np.abs(expected).max()
    assert error < min(error_estimate(contact, *points), 1e-12)
