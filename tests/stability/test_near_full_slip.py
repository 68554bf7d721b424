"""Near full slip, c -> 0: the estimate covers an ill-conditioned stick radius."""

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
    Curve,
    attempt,
    curve,
    references,
    steps,
)

FORCE, MU, BIG, SLOPE = 1.25, 0.375, 1.3, 0.3
LABEL = "1 − F_x/(µF_N)"
#: Margins 1 - F_x/(mu F_N): mu F_N - F_x is not resolved below EPS mu F_N.
MARGINS = steps(0.5, 2e-16, 40)


def representable_loads(limit: float) -> Any:
    """Distinct representable loads next to full slip."""
    given = limit * (1 - MARGINS)
    return np.minimum(given, np.nextafter(limit, 0.0))


def hertz() -> Curve:
    """Hertz: c = a (1 - F_x/(mu F_N))^(1/3). The naive root finder uses an absolute tolerance."""
    limit = MU * FORCE
    given = representable_loads(limit)
    contact = normal.solve(Paraboloid(BIG), 1.0, normal_force=FORCE)
    result = tangential.solve(contact, 1.0, MU, tangential_force=given)

    def exact(force: mpf) -> mpf:
        return mp.cbrt(3 * mpf(BIG) / 4 * (mpf(FORCE) - force / mpf(MU)))

    def naive(force: float) -> float:
        a = np.cbrt(3 * FORCE * BIG / 4)
        return float(brentq(lambda c: limit - MU * 4 * c**3 / (3 * BIG) - force, 0.0, a))

    margin = 1 - given / limit
    return curve(
        "full-slip-hertz",
        "Hertz contact: stick radius near full slip",
        LABEL,
        "brentq of F_x(c) = F_x",
        margin,
        (result.stick_radius, attempt(naive, given), references(exact, given)),
        CLOSED + ROUNDING / (3 * margin),
    )


def displacement() -> Curve:
    """Cone: c = a (1 - u_x/u_max) for prescribed displacement and contact radius."""
    limit = MU * pi / 2 * SLOPE
    given = representable_loads(limit)
    contact = normal.solve(Cone(SLOPE), 1.0, contact_radius=1.0)
    result = tangential.solve(contact, 1.0, MU, tangential_displacement=given)

    def exact(u: mpf) -> mpf:
        return 1 - u / (mpf(MU) * mp.pi / 2 * mpf(SLOPE))

    margin = np.array([float(value) for value in references(exact, given)])
    return curve(
        "full-slip-cone",
        "cone: stick radius near full slip",
        "1 − u_x/u_x,max",
        "brentq of u_x(c) = u_x",
        margin,
        (
            result.stick_radius,
            attempt(lambda u: brentq(lambda c: limit * (1 - c) - u, 0.0, 1.0), given),
            references(exact, given),
        ),
        CLOSED + ROUNDING / margin,
    )


def dissipation_near_full_slip(
    name: str, profile: Profile, fields_: dict[str, Any], places: Any
) -> Curve:
    """Dissipated energy at a small prescribed stick radius; the load follows in closed form."""
    contact = normal.solve(profile, 1.0, contact_radius=1.0)
    first = fields_.get("flat_radius", 0.0)
    given = first + (1 - first) * places if first else places
    result = tangential.solve(contact, 1.0, MU, stick_radius=given)
    at = setting(fields_, "contact_radius", 1.0, Material(1.0, 1.0, MU))
    truth = [solve(at, "stick_radius", c).values["dissipated_energy"] for c in given]
    energy = np.vectorize(lambda c: midpoints(profile, c))
    return curve(
        f"full-slip-{name}",
        f"dissipated energy of a {name.replace('-', ' ')} near full slip",
        "c/a" if not first else "(c − b)/(a − b)",
        "midpoint rule over 1000 springs",
        places,
        (result.dissipated_energy, energy(given), truth),
        1e-12,
    )


def midpoints(profile: Profile, c: float) -> float:
    """(2 mu^2 E*^2/G*) int (g(a) - g)(g - g(c)) dx of a discrete foundation: midpoint rule."""
    x = c + (1 - c) * (np.arange(1000) + 0.5) / 1000
    g, ends = profile.g(x), profile.g(np.array([c, 1.0]))
    return float(2 * MU**2 * np.mean((ends[1] - g) * (g - ends[0])) * (1 - c))


def rounded_cone() -> Curve:
    shape = {"kind": "rounded_cone", "slope": SLOPE, "tip_radius": 0.5}
    return dissipation_near_full_slip(
        "rounded-cone", RoundedCone(SLOPE, 0.5), shape, steps(0.5, 1e-12)
    )


def rounded_punch() -> Curve:
    shape = {"kind": "rounded_punch", "flat_radius": 0.8, "rounding_radius": 2.0}
    return dissipation_near_full_slip(
        "rounded-punch", RoundedPunch(0.8, 2.0), shape, steps(0.5, 1e-14)
    )


CURVES = {
    "hertz": hertz,
    "cone": displacement,
    "rounded cone": rounded_cone,
    "rounded punch": rounded_punch,
}


@pytest.mark.every(4)
@pytest.mark.parametrize("name", CURVES)
def test_near_full_slip(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-8)


@pytest.mark.parametrize("margin", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_error_estimate_includes_load_rounding_near_full_slip(margin: float) -> None:
    """Near full slip, the estimate of a single load covers the rounding error of that load."""
    contact = normal.solve(Paraboloid(BIG), 1.0, normal_force=FORCE)
    force = MU * FORCE * (1 - margin)
    result = tangential.solve(contact, 1.0, MU, tangential_force=force)
    with mp.workdps(40):
        exact = mp.cbrt(3 * mpf(BIG) / 4 * (mpf(FORCE) - mpf(force) / mpf(MU)))
        error = float(abs(mpf(float(result.stick_radius)) / exact - 1))
    assert error <= result.error_estimate <= 1e-11 + 100 * ROUNDING / margin


def test_traction_with_vanishing_stick_zone() -> None:
    """sqrt(a^2 - r^2) - sqrt(c^2 - r^2) down to the smallest significant c."""
    contact = normal.solve(Paraboloid(BIG), 1.0, contact_radius=1.0)
    for c in steps(0.1, 1e-140, 30):
        result = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
        r = np.array([0.0, 0.5, 0.999999, 1.0, 1.5]) * c
        exact = references(_traction, r, np.full(r.shape, c))
        there = fields.shear_stress(result, r)
        assert there == pytest.approx([float(value) for value in exact], rel=CLOSED, abs=0)


def _traction(x: mpf, c: mpf) -> mpf:
    inner = mp.sqrt(max((c - x) * (c + x), mpf(0)))
    return 2 / (mp.pi * mpf(BIG)) * (mp.sqrt(1 - x * x) - inner)


@pytest.mark.parametrize("margin", [1e-8, 1e-11, 1e-14])
def test_traction_with_a_stick_edge_just_beyond_a_flat(margin: float) -> None:
    """The stick radius rounds away its distance from the flat, which its coordinate resolves."""
    b, a, r = 0.8, 0.801, np.array([0.0, 0.3, 0.6])
    contact = normal.solve(RoundedPunch(b, BIG), 1.0, contact_radius=a)
    force = float(contact.normal_force) * (1 - margin)
    result = tangential.solve(contact, 1.0, 1.0, tangential_force=force)
    with mp.workdps(30):
        beyond = mpf(float(result.stick_coordinate))
        low, high = mp.sqrt(beyond * (2 * mpf(b) + beyond)), mp.sqrt(mpf(a) ** 2 - mpf(b) ** 2)

        def exact(at: mpf) -> mpf:
            """(1/pi) int dg/ds / sqrt(x^2 - r^2) ds, Eq. (5.70)."""

            def integrand(s: mpf) -> mpf:
                x = mp.sqrt(mpf(b) ** 2 + s * s)
                slope = (2 * s - b * mp.atan(s / b)) / BIG
                return slope * s / x / mp.sqrt(x * x - at * at) / mp.pi

            return mp.quad(integrand, [low, high])

        expected = [float(exact(mpf(float(at)))) for at in r]
    found = fields.shear_stress(result, r)
    assert found == pytest.approx(expected, rel=1e-12, abs=0)
