"""The brink of sliding, c -> 0: what still sticks hangs on the last digits of the load."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Cone, Paraboloid, Profile, RoundedCone, RoundedPunch
from tests.oracles.slip_reference import Material, setting, solve
from tests.stability.curves import (
    CLOSED,
    ROUNDING,
    RTOL,
    Curve,
    attempt,
    curve,
    references,
    steps,
)

FORCE, MU, BIG, SLOPE = 1.25, 0.375, 1.3, 0.3
LABEL = "1 − F_x/(µF_N)"
#: Of a force near mu F_N a double keeps no smaller part than this.
RESTS = steps(0.5, 2e-16, 40)


def doubles(limit: float) -> Any:
    """Loads next to full slip, all different from it."""
    given = limit * (1 - RESTS)
    return np.minimum(given, np.nextafter(limit, 0.0))


def hertz() -> Curve:
    """c = a (1 - F_x/(mu F_N))^(1/3); the naive root finder has an absolute tolerance."""
    limit = MU * FORCE
    given = doubles(limit)
    contact = normal.solve(Paraboloid(BIG), 1.0, normal_force=FORCE, rtol=RTOL)
    found = tangential.solve(contact, 1.0, MU, tangential_force=given)

    def exact(force: mpf) -> mpf:
        return mp.cbrt(3 * mpf(BIG) / 4 * (mpf(FORCE) - force / mpf(MU)))

    def naive(force: float) -> float:
        a = np.cbrt(3 * FORCE * BIG / 4)
        return float(brentq(lambda c: limit - MU * 4 * c**3 / (3 * BIG) - force, 0.0, a))

    rest = 1 - given / limit
    return curve(
        "brink-hertz",
        "Hertz's stick radius towards full slip",
        LABEL,
        "brentq of F_x(c) = F_x, as it comes",
        rest,
        (found.stick_radius, attempt(naive, given), references(exact, given)),
        CLOSED + ROUNDING / (3 * rest),
    )


def displacement() -> Curve:
    """A cone's c = a (1 - u_x/u_max) at given displacements of a contact at given radius."""
    limit = MU * pi / 2 * SLOPE
    given = doubles(limit)
    contact = normal.solve(Cone(SLOPE), 1.0, contact_radius=1.0, rtol=RTOL)
    found = tangential.solve(contact, 1.0, MU, tangential_displacement=given)

    def exact(u: mpf) -> mpf:
        return 1 - u / (mpf(MU) * mp.pi / 2 * mpf(SLOPE))

    rest = np.array([float(value) for value in references(exact, given)])
    return curve(
        "brink-cone",
        "stick radius of a cone towards full slip",
        "1 − u_x/u_x,max",
        "brentq of u_x(c) = u_x, as it comes",
        rest,
        (
            found.stick_radius,
            attempt(lambda u: brentq(lambda c: limit * (1 - c) - u, 0.0, 1.0), given),
            references(exact, given),
        ),
        CLOSED + ROUNDING / rest,
    )


def by_rest(name: str, profile: Profile, fields_: dict[str, Any], places: Any) -> Curve:
    """The force at a given small stick radius: mu F_N less next to nothing, and exactly that."""
    contact = normal.solve(profile, 1.0, contact_radius=1.0, rtol=RTOL)
    first = fields_.get("flat_radius", 0.0)
    given = first + (1 - first) * places if first else places
    found = tangential.solve(contact, 1.0, MU, stick_radius=given)
    at = setting(fields_, "contact_radius", 1.0, Material(1.0, 1.0, MU))
    truth = [solve(at, "stick_radius", c).values["dissipated_energy"] for c in given]
    energy = np.vectorize(lambda c: midpoints(profile, c))
    return curve(
        f"brink-{name}",
        f"energy lost by a {name.replace('-', ' ')} on the way to the brink",
        "c/a" if not first else "(c − b)/(a − b)",
        "midpoint rule over 1000 springs",
        places,
        (found.dissipated_energy, energy(given), truth),
        1e-12,
    )


def midpoints(profile: Profile, c: float) -> float:
    """(2 mu^2 E*^2/G*) int (g(a) - g)(g - g(c)) dx, as a bed of springs would have it."""
    x = c + (1 - c) * (np.arange(1000) + 0.5) / 1000
    g, ends = profile.g(x), profile.g(np.array([c, 1.0]))
    return float(2 * MU**2 * np.mean((ends[1] - g) * (g - ends[0])) * (1 - c))


def rounded_cone() -> Curve:
    shape = {"kind": "rounded_cone", "slope": SLOPE, "tip_radius": 0.5}
    return by_rest("rounded-cone", RoundedCone(SLOPE, 0.5), shape, steps(0.5, 1e-12))


def rounded_punch() -> Curve:
    shape = {"kind": "rounded_punch", "flat_radius": 0.8, "rounding_radius": 2.0}
    return by_rest("rounded-punch", RoundedPunch(0.8, 2.0), shape, steps(0.5, 1e-14))


CURVES = {
    "hertz": hertz,
    "cone": displacement,
    "rounded cone": rounded_cone,
    "rounded punch": rounded_punch,
}


@pytest.mark.parametrize("name", CURVES)
def test_towards_the_brink(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_dies(1e-8)


@pytest.mark.parametrize("rest", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_the_estimate_grows_with_what_is_lost(rest: float) -> None:
    """Each load alone: what the rounding of a load near full slip does is in its estimate."""
    contact = normal.solve(Paraboloid(BIG), 1.0, normal_force=FORCE, rtol=RTOL)
    force = MU * FORCE * (1 - rest)
    found = tangential.solve(contact, 1.0, MU, tangential_force=force)
    with mp.workdps(40):
        exact = mp.cbrt(3 * mpf(BIG) / 4 * (mpf(FORCE) - mpf(force) / mpf(MU)))
        error = float(abs(mpf(float(found.stick_radius)) / exact - 1))
    assert error <= found.error_estimate <= 1e-11 + 100 * ROUNDING / rest


def test_the_field_inside_a_vanishing_stick_zone() -> None:
    """sqrt(a^2 - r^2) - sqrt(c^2 - r^2) with c down to the smallest that counts."""
    contact = normal.solve(Paraboloid(BIG), 1.0, contact_radius=1.0, rtol=RTOL)
    for c in steps(0.1, 1e-140, 30):
        found = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
        r = np.array([0.0, 0.5, 0.999999, 1.0, 1.5]) * c
        exact = references(_traction, r, np.full(r.shape, c))
        there = fields.shear_stress(found, r, rtol=RTOL)
        assert there == pytest.approx([float(value) for value in exact], rel=CLOSED, abs=0)


def _traction(x: mpf, c: mpf) -> mpf:
    inner = mp.sqrt(max((c - x) * (c + x), mpf(0)))
    return 2 / (mp.pi * mpf(BIG)) * (mp.sqrt(1 - x * x) - inner)
