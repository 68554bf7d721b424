"""Results keep their accuracy from nanometres to megametres and pascals to terapascals.

The core has no intrinsic scale, so results must not depend on units. The naive root finders stop at
an absolute tolerance, which introduces one.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mpf
from scipy.optimize import brentq

from mdr_core import fields, normal, tangential
from tests.core.comparison import profile_from
from tests.oracles.reference import state
from tests.oracles.shapes import shape_of
from tests.stability.curves import CLOSED, ROUNDING, Curve, attempt, curve, steps

if TYPE_CHECKING:
    from mdr_core.profiles import Profile

MODULUS, MU = 1.7, 0.35
#: Factors of the unit of length; the modulus scales inversely.
UNITS = steps(1e-24, 1e24, 37)
SHAPES: dict[str, tuple[dict[str, float], dict[str, float]]] = {
    "rounded_punch": ({"flat_radius": 0.8, "rounding_radius": 2.0}, {}),
    "sphere": ({"radius": 1.3}, {}),
    "rounded_cone": ({"tip_radius": 1.5}, {"slope": 0.4}),
    "capped_paraboloid": ({"cap_radius": 0.6, "tip_radius": 3.0, "radius": 1.1}, {}),
}
DEPTH = 0.37


def scaled(kind: str, unit: float) -> dict[str, Any]:
    lengths, numbers = SHAPES[kind]
    return {"kind": kind, **{name: value * unit for name, value in lengths.items()}, **numbers}


def force(kind: str) -> Curve:
    """F_N at prescribed depth."""
    result, truth, conditions = [], [], []
    for unit in UNITS:
        shape, load, e_star = scaled(kind, unit), DEPTH * unit, MODULUS / unit
        exact = state(shape, "indentation_depth", load, e_star)
        contact = normal.solve(profile_from(shape), e_star, indentation_depth=load)
        result.append(float(contact.normal_force))
        truth.append(exact.values["normal_force"])
        conditions.append(float(exact.condition["normal_force"]))

    def naive(unit: float) -> float:
        shape = profile_from(scaled(kind, unit))
        first = float(shape.first_radius)
        last = min(20 * unit, 0.999999 * float(shape.domain))
        a = brentq(lambda a: float(shape.g(np.array(a))) - DEPTH * unit, first, last)
        coordinate = shape.coordinate_from_radius(np.array(a))
        return MODULUS / unit * float(shape.reduced_force(coordinate))

    return curve(
        f"units-{kind.replace('_', '-')}",
        f"force of a {kind.replace('_', ' ')} at prescribed depth",
        "unit of length",
        "brentq of g(a) = d",
        UNITS,
        (result, attempt(naive, UNITS), truth),
        CLOSED + ROUNDING * np.array(conditions),
    )


CURVES = {kind: partial(force, kind) for kind in SHAPES}


@pytest.mark.parametrize("kind", CURVES)
def test_results_are_unit_independent(kind: str) -> None:
    sweep = CURVES[kind]()
    sweep.holds()
    # Stiff contacts hit the absolute tolerance of the naive root finder, xtol = 2e-12.
    sweep.naive_fails(1e-3)


def tangential_contact(profile: Profile, unit: float) -> tangential.TangentialContact:
    contact = normal.solve(profile, MODULUS / unit, indentation_depth=DEPTH * unit)
    return tangential.solve(
        contact, 0.8 * MODULUS / unit, MU, tangential_displacement=0.2 * DEPTH * unit
    )


@pytest.mark.parametrize("kind", SHAPES)
def test_scaling_by_powers_of_two(kind: str) -> None:
    """A power of two scales doubles exactly; only the order of operations can differ."""
    first = tangential_contact(profile_from(scaled(kind, 1.0)), 1.0)
    r = np.array([0.0, 0.3, 0.7, 0.9]) * float(first.normal.contact_radius)
    for power in (-80, -40, -20, 20, 40, 80):
        unit = 2.0**power
        other = tangential_contact(profile_from(scaled(kind, unit)), unit)
        # Lengths and forces scale with the unit, since the modulus scales with its inverse.
        for name in ("tangential_force", "stick_radius", "slip_width"):
            assert float(getattr(other, name)) / unit == pytest.approx(
                float(getattr(first, name)), rel=1e-14, abs=0
            ), (name, power)
        assert fields.shear_stress(other, r * unit) * unit == pytest.approx(
            fields.shear_stress(first, r), rel=1e-13, abs=0
        )
    assert shape_of(scaled(kind, 1.0)).f(mpf(0)) == 0
