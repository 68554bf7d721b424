"""Stresses meet their tolerance next to singularities."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from tests.core.comparison import profile_from
from tests.oracles import reference
from tests.oracles.shapes import shape_of

Profile = dict[str, Any]


def rounded(b: float) -> Profile:
    return {"kind": "rounded_punch", "flat_radius": b, "rounding_radius": 2.0}


def power(n: float) -> Profile:
    return {"kind": "power", "coefficient": 0.3, "exponent": n}


#: For a contact of radius 1.
PROFILES: dict[str, Profile] = {
    "rounded 0.33": rounded(0.33),
    "rounded 0.95": rounded(0.95),
    "rounded 0.99999": rounded(0.99999),
    "truncated cone": {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.3},
    "truncated paraboloid": {"kind": "truncated_paraboloid", "flat_radius": 0.6, "radius": 3.0},
    "sphere 1.27": {"kind": "sphere", "radius": 1.27},
    "sphere 1e6": {"kind": "sphere", "radius": 1e6},
    "ellipsoid": {"kind": "ellipsoid", "radius": 3.0, "height": 0.7},
    "hyperboloid 0.6": {"kind": "hyperboloid", "slope": 0.4, "tip_radius": 1.5},
}
#: For annuli only; full contacts are in the pressure bank.
POWERS = {f"power {n}": power(n) for n in (0.4, 1.5, 6.0)}
RTOL = 1e-12


def check_radii(name: str, c: float) -> np.ndarray:
    """Radii next to the axis, the break, the stick edge and the contact edge, and in between."""
    b = (PROFILES | POWERS)[name].get("flat_radius", 0.0)
    near = [x * (1 + side) for x in (b, c) if x for side in (-1e-3, -1e-9, 1e-9, 1e-3)]
    # The reference is a difference of two values that are infinite on the axis of a power.
    axis = [] if name in POWERS else [0.0]
    r = np.array([*axis, 1e-6, 0.2, 0.45, 0.8, 0.97, 1 - 1e-6, 1 - 1e-12, *near])
    return np.unique(r[(r >= 0) & (r < 1)])


@cache
def reference_kernel(name: str, stick: float | None) -> tuple[mpf, ...]:
    """(1/pi) int g'/sqrt(x^2 - r^2) dx over max(r, c) < x < 1 at the checked radii."""
    shape, c = shape_of((PROFILES | POWERS)[name]), mpf(stick or 0.0)
    with mp.workdps(reference.QUAD_DIGITS):
        result = []
        for r in check_radii(name, stick or 0.0).tolist():
            whole = reference.pressure(shape, mpf(r), mpf(1))
            result.append(whole - reference.pressure(shape, mpf(r), c) if r < c else whole)
        return tuple(result)


def largest_error(name: str, stick: float | None) -> float:
    given = (PROFILES | POWERS)[name]
    contact = normal.solve(profile_from(given), 1.0, contact_radius=1.0)
    r = check_radii(name, stick or 0.0)
    if stick is None:
        values = fields.pressure(contact, r)
    else:
        pushed = tangential.solve(contact, 1.0, 1.0, stick_radius=stick)
        values = fields.shear_stress(pushed, r)
    pairs = zip(values.tolist(), reference_kernel(name, stick), strict=True)
    return max(float(abs(mpf(value) / exact - 1)) for value, exact in pairs)


@pytest.mark.parametrize("name", PROFILES)
def test_pressure_meets_the_tolerance(name: str) -> None:
    assert largest_error(name, None) <= RTOL


@pytest.mark.every(7)
@pytest.mark.parametrize("fraction", [0.02, 0.5, 1 - 1e-9])
@pytest.mark.parametrize("name", [*PROFILES, *POWERS])
def test_shear_stress_meets_the_tolerance(name: str, fraction: float) -> None:
    """Annuli from wide ones to ones for which a difference of pressures is rounding error."""
    low = max((PROFILES | POWERS)[name].get("flat_radius", 0.0), 0.19 if name in POWERS else 0.0)
    stick = low + fraction * (1 - low)
    assert largest_error(name, stick) <= RTOL


def test_radii_beyond_one_block_have_the_values_of_few() -> None:
    contact = normal.solve(profile_from(PROFILES["rounded 0.33"]), 1.0, contact_radius=1.0)
    r = np.random.default_rng(1).uniform(0.0, 1.0, 5000)
    few = fields.pressure(contact, r[::50])
    assert fields.pressure(contact, r)[::50] == pytest.approx(few, rel=1e-13, abs=0)
