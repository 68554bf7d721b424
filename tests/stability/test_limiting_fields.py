"""Fields of the limiting wear err within their estimate beside the stick edge."""

from __future__ import annotations

from typing import Any

import pytest
from mpmath import mp, mpf

from mdr_core import normal
from mdr_core.wear import limit
from tests.core.comparison import profile_from
from tests.oracles import wear_reference
from tests.oracles.slip_reference import WORK_DIGITS, Material

MU = 0.4
MATERIAL = Material(1.0, 0.9, MU)
SHAPES: dict[str, dict[str, Any]] = {
    "paraboloid": {"kind": "paraboloid", "radius": 2.0},
    "power": {"kind": "power", "coefficient": 0.1, "exponent": 3.0},
    "sphere": {"kind": "sphere", "radius": 1000.0},
    "rounded punch": {"kind": "rounded_punch", "flat_radius": 0.99, "rounding_radius": 2.0},
    "truncated cone": {"kind": "truncated_cone", "flat_radius": 0.9, "slope": 0.2},
}
#: Amplitude over that of full slip: slip annuli from 1e-11 a to all of the contact.
PARTS = (1e-11, 1e-5, 0.3, 1 - 1e-9)
CONTROLS = [
    ("indentation_depth", "tangential_displacement"),
    ("normal_force", "tangential_force"),
    ("normal_force", "tangential_displacement"),
]


@pytest.mark.every(8)
@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize(("control", "name"), CONTROLS)
@pytest.mark.parametrize("kind", SHAPES)
def test_error_within_estimate(kind: str, control: str, name: str, part: float) -> None:
    shape = SHAPES[kind]
    profile = profile_from(shape)
    load = float(getattr(normal.solve(profile, 1.0, contact_radius=1.0), control))
    contact = normal.solve(profile, 1.0, **{control: load})
    most = MU * float(
        contact.normal_force if name == "tangential_force" else contact.indentation_depth / 0.9
    )
    worn = limit.solve(contact, 0.9, MU, **{name: part * most})
    exact = wear_reference.solve(shape, control, mpf(load), MATERIAL, name, mpf(part * most))
    c, width = float(exact.c), float(exact.width)

    def field(name: str, place: float) -> mpf:
        return wear_reference.field(exact, name, mpf(place))

    for gap in (0.3, 1e-3, 1e-6, 1e-9, 1e-12):
        r = c * (1 - gap)
        found = float(worn.pressure([r])[0])
        bound = worn.error_estimate + worn.field_error_estimate([r], ["pressure"])
        assert abs(found / field("pressure", r) - 1) <= bound, gap
    with mp.workdps(WORK_DIGITS):
        # Next to its largest value, to which errors are relative.
        highest = max(field("worn_depth", exact.c + exact.width * mpf(x)) for x in (0.25, 0.4, 0.6))
    for share in (1e-6, 0.01, 0.3, 0.99, 1 - 1e-6):
        r = c + share * width
        if r - c > 1e-15 * c:
            found = float(worn.worn_depth([r])[0])
            bound = worn.error_estimate + worn.field_error_estimate([r], ["worn_depth"])
            assert abs(found - field("worn_depth", r)) <= bound * highest, share


def test_estimates_are_sharp_away_from_the_edge() -> None:
    contact = normal.solve(profile_from(SHAPES["paraboloid"]), 1.0, indentation_depth=0.5)
    worn = limit.solve(contact, 0.9, MU, tangential_displacement=0.1)
    c = float(worn.stick_radius)
    radii = [0.0, 0.9 * c, c, c * (1 + 1e-3)]
    assert worn.field_error_estimate(radii, ["pressure", "worn_depth"]) < 1e-11
    assert worn.field_error_estimate([c * (1 - 1e-9)], ["pressure"]) < 1e-5
    assert worn.field_error_estimate([c * (1 - 1e-9)], ["worn_depth", "initial_profile"]) == 0
