"""Incipient slip, c -> a: an annulus below the rounding error of a keeps its width."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Cone, Paraboloid, RoundedPunch
from tests.oracles.slip_reference import Material, Setting, setting, solve
from tests.stability.curves import (
    Curve,
    attempt,
    curve,
    references,
    steps,
)

FORCE, MU, BIG, SLOPE = 1.25, 0.375, 1.3, 0.3
LABEL = "F_x/(µF_N)"
RATIOS = steps(0.5, 1e-16, 40)


@cache
def hertz_contact() -> tangential.TangentialContact:
    """Hertz contacts at all load ratios, E* = G* = 1."""
    contact = normal.solve(Paraboloid(BIG), 1.0, normal_force=FORCE)
    return tangential.solve(contact, 1.0, MU, tangential_force=RATIOS * (MU * FORCE))


def exact_edges(force: mpf) -> tuple[mpf, mpf]:
    """a and c from Eqs. (5.14) and (5.16)."""
    a = mp.cbrt(3 * mpf(FORCE) * mpf(BIG) / 4)
    return a, a * mp.cbrt(1 - force / (mpf(MU) * mpf(FORCE)))


def naive_edges(force: float) -> tuple[float, float]:
    a = np.cbrt(3 * FORCE * BIG / 4)
    return a, a * np.cbrt(1 - force / (MU * FORCE))


def of_hertz(name: str, title: str, answer: str, exact: Any, naive: tuple[str, Any]) -> Curve:
    forces = hertz_contact().tangential_force
    return curve(
        f"first-slip-{name}",
        title,
        LABEL,
        naive[0],
        RATIOS,
        (getattr(hertz_contact(), answer), attempt(naive[1], forces), references(exact, forces)),
    )


def width() -> Curve:
    return of_hertz(
        "width",
        "Hertz contact: width of the slip annulus",
        "slip_width",
        lambda force: exact_edges(force)[0] - exact_edges(force)[1],
        ("a − c", lambda force: naive_edges(force)[0] - naive_edges(force)[1]),
    )


def displacement() -> Curve:
    """Mindlin's u = (mu/R) (a^2 - c^2), E* = G*."""

    def naive(force: float) -> float:
        a = naive_edges(force)[0]
        return float(MU * a**2 / BIG * (1 - (1 - force / (MU * FORCE)) ** (2 / 3)))

    return of_hertz(
        "displacement",
        "Mindlin: tangential displacement",
        "tangential_displacement",
        lambda force: mpf(MU) / BIG * (exact_edges(force)[0] ** 2 - exact_edges(force)[1] ** 2),
        ("1 − (1 − F_x/µF_N)^(2/3)", naive),
    )


def energy() -> Curve:
    """Mindlin and Deresiewicz: a quarter of a cycle's dissipated energy, with two cancellations."""

    def naive(force: float) -> float:
        rest, a = 1 - force / (MU * FORCE), naive_edges(force)[0]
        braces = 1 - rest ** (5 / 3) - 5 / 6 * (1 - rest) * (1 + rest ** (2 / 3))
        return float(9 * (MU * FORCE) ** 2 / (10 * a) * braces)

    formula = "1 − q^(5/3) − (5/6)(1 − q)(1 + q^(2/3)), q = 1 − F_x/µF_N"
    title = "dissipated energy (Mindlin–Deresiewicz)"
    return of_hertz("energy", title, "dissipated_energy", exact_dissipated_energy, (formula, naive))


def exact_dissipated_energy(force: mpf) -> mpf:
    """(4 mu^2/(15 R^2)) (a - c)^3 (a^2 + 3 a c + c^2): a quarter of the cycle's, E* = G* = 1."""
    a, c = exact_edges(force)
    return 4 * mpf(MU) ** 2 / (15 * mpf(BIG) ** 2) * (a - c) ** 3 * (a * a + 3 * a * c + c * c)


def traction() -> Curve:
    """Traction of a cone well inside the stick zone; the naive form subtracts two pressures."""
    widths = steps(0.5, 1e-16, 40)
    contact = normal.solve(Cone(SLOPE), 1.0, indentation_depth=np.pi / 2 * SLOPE)
    moved = widths * (np.pi / 2 * SLOPE)
    result = tangential.solve(contact, 1.0, 1.0, tangential_displacement=moved)
    full = np.pi / 2 * SLOPE
    a, r = float(contact.contact_radius), 0.3

    def exact(u: mpf) -> mpf:
        slope = mpf(SLOPE)
        top = contact.indentation_depth / (mp.pi / 2 * slope)
        inner = top - u / (mp.pi / 2 * slope)
        return slope / 2 * (mp.acosh(top / r) - mp.acosh(inner / r))

    return curve(
        "first-slip-traction",
        "traction of a cone at r = 0.3 a",
        "u_x/u_x,max",
        "p(r; a) − p(r; c)",
        widths,
        (
            np.ravel(fields.shear_stress(result, [r])),
            attempt(
                lambda u: SLOPE / 2 * (np.arccosh(a / r) - np.arccosh((a - u / full) / r)),
                moved,
            ),
            references(exact, moved),
        ),
    )


PUNCH = {"kind": "rounded_punch", "flat_radius": 0.8, "rounding_radius": 2.0}


def rounded_punch() -> Curve:
    """No closed-form inverse: the annulus width is the unknown; the naive method solves for c."""
    contact = normal.solve(RoundedPunch(0.8, 2.0), 1.0, contact_radius=1.0)
    force = float(contact.normal_force)
    given = RATIOS * (MU * force)
    result = tangential.solve(contact, 1.0, MU, tangential_force=given)
    at = setting(PUNCH, "contact_radius", 1.0, Material(mpf(1), mpf(1), mpf(MU)))
    truth = [annulus(at, value) for value in given]

    def naive(value: float) -> float:
        c = brentq(lambda c: MU * (force - punch_force(c)) - value, 0.8, 1.0)
        return float(1.0 - c)

    return curve(
        "first-slip-rounded-punch",
        "width of the slip annulus of a rounded punch",
        LABEL,
        "a − c, c by brentq from F(c)",
        RATIOS,
        (result.slip_width, attempt(naive, given), truth),
    )


def punch_force(c: float) -> float:
    s = np.sqrt(c * c - 0.64)
    return float((s**3 + 3 * c * c * (s - 0.8 * np.arccos(0.8 / c))) / 6)


def annulus(at: Setting, value: float) -> mpf:
    answer = solve(at, "tangential_force", value, energy=False)
    return answer.values["slip_width"]


CURVES = {
    "width": width,
    "displacement": displacement,
    "energy": energy,
    "traction": traction,
    "rounded punch": rounded_punch,
}


@pytest.mark.parametrize("name", CURVES)
def test_incipient_slip(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-4)


def test_error_within_estimate() -> None:
    result = hertz_contact()
    assert result.error_estimate >= max(float(width().ours.max()), float(energy().ours.max()))
