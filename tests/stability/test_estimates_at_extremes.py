"""Error estimates in partial slip for bodies with two very different length scales.

The bodies have very flat caps, tips with steep flanks, or contact edges within a few rounding
errors of a flat. The estimate must cover the rounding error of the loads under any control.
"""

from __future__ import annotations

from typing import Any

import pytest
from mpmath import mpf

from mdr_core import normal, tangential
from tests.core.comparison import profile_from
from tests.oracles.slip_reference import Material, setting, solve

MU = 0.4
MATERIAL = Material(1.0, 1.0, MU)
#: Fractions of full slip, from incipient slip to the onset of full slip.
FRACTIONS = (1e-12, 0.3, 1 - 1e-4, 1 - 1e-8, 1 - 1e-12)
CAP: dict[str, Any] = {"kind": "capped_paraboloid", "cap_radius": 1.0, "radius": 1.0}
TIP: dict[str, Any] = {
    "kind": "spherical_tip_cone",
    "slope": 30.0,
    "tip_radius": 1.0005554013202422,
}
PUNCH: dict[str, Any] = {"kind": "rounded_punch", "flat_radius": 1.0, "rounding_radius": 2.0}
TRUNCATED: dict[str, Any] = {"kind": "truncated_cone", "flat_radius": 1.0, "slope": 0.3}
CASES = {
    "cap 1e8, outside": (CAP | {"tip_radius": 1e8}, 1.5),
    "cap 1e8, next to the edge": (CAP | {"tip_radius": 1e8}, 1 + 1e-14),
    "cap 1e12": (CAP | {"tip_radius": 1e12}, 10.0),
    "steep flank": (TIP, 1 + 1e-14),
    "rounded edge": (PUNCH, 1 + 4.5e-16),
    "edge": (PUNCH, 1 + 1e-12),
    "sharp edge": (TRUNCATED, 1 + 1e-14),
}


@pytest.mark.parametrize("control", ["contact_radius", "indentation_depth", "normal_force"])
@pytest.mark.parametrize("name", CASES)
def test_error_within_estimate(name: str, control: str) -> None:
    shape, radius = CASES[name]
    profile = profile_from(shape)
    load = float(getattr(normal.solve(profile, 1.0, contact_radius=radius), control))
    contact = normal.solve(profile, 1.0, rtol=1e-13, **{control: load})
    at = setting(shape, control, load, MATERIAL)
    limits = {
        "tangential_force": MU * float(contact.normal_force),
        "tangential_displacement": MU * float(contact.indentation_depth),
    }
    for push, limit in limits.items():
        for part in FRACTIONS:
            result = tangential.solve(contact, 1.0, MU, **{push: limit * part})
            exact = solve(at, push, limit * part, energy=False).values
            for answer, truth in exact.items():
                error = abs(mpf(float(getattr(result, answer))) / truth - 1)
                assert error <= result.error_estimate, (push, part, answer)
