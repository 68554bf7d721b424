"""Contact edge, r -> a: the pressure keeps the digits of its square root."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal
from mdr_core.profiles import Cone, FlatPunch, Paraboloid, Profile, RoundedPunch, Sphere
from tests.stability.curves import (
    Curve,
    attempt,
    curve,
    plain_quad,
    references,
    steps,
)

if TYPE_CHECKING:
    from collections.abc import Callable

A, SLOPE, BIG, FLAT = 1.0, 0.3, 1.3, 0.6
LABEL = "1 − r/a"


def radii() -> Any:
    """Radii next to a; the actual distance is from the rounded radius."""
    return A - steps(0.5, 2.3e-16, 40)


def against(
    name: str,
    title: str,
    profile: Profile,
    exact: Callable[[mpf], mpf],
    naive: tuple[str, Callable[[float], float]],
    **load: float,
) -> Curve:
    r = radii()
    contact = normal.solve(profile, 1.0, **(load or {"contact_radius": A}))
    return curve(
        name,
        title,
        LABEL,
        naive[0],
        A - r,
        (fields.pressure(contact, r), attempt(naive[1], r), references(exact, r)),
    )


def paraboloid() -> Curve:
    return against(
        "edge-paraboloid",
        "Hertz pressure near the edge",
        Paraboloid(BIG),
        lambda r: 2 / (mp.pi * mpf(BIG)) * mp.sqrt((A - r) * (A + r)),
        ("p₀ √(1 − r²/a²)", lambda r: 2 * A / (pi * BIG) * np.sqrt(1 - r**2 / A**2)),
    )


def cone() -> Curve:
    return against(
        "edge-cone",
        "pressure of a cone near the edge",
        Cone(SLOPE),
        lambda r: mpf(SLOPE) / 2 * mp.acosh(A / r),
        ("arccosh(a/r)", lambda r: SLOPE / 2 * np.arccosh(A / r)),
    )


def flat_punch() -> Curve:
    return against(
        "edge-flat-punch",
        "pressure of a flat punch near its edge",
        FlatPunch(A),
        lambda r: 1 / (mp.pi * mp.sqrt((A - r) * (A + r))),
        ("1/√(a² − r²)", lambda r: 1 / (pi * np.sqrt(A**2 - r**2))),
        indentation_depth=1.0,
    )


def sphere() -> Curve:
    def naive(r: float) -> float:
        def density(x: float) -> float:
            slope = np.arctanh(x / BIG) + x * BIG / (BIG**2 - x**2)
            return float(slope / np.sqrt(x**2 - r**2)) if x > r else 0.0

        return plain_quad(density, r, A) / pi

    def exact(r: mpf) -> mpf:
        big, top = mpf(BIG), mp.sqrt((A - r) * (A + r))

        def density(u: mpf) -> mpf:
            # The substitution x^2 = r^2 + u^2 removes the square-root singularity.
            x = mp.sqrt(r**2 + u**2)
            return (mp.atanh(x / big) + x * big / (big**2 - x**2)) / x

        return mp.quad(density, [0, top]) / mp.pi

    return against(
        "edge-sphere",
        "pressure of a sphere near the edge",
        Sphere(BIG),
        exact,
        ("∫ g′/√(x²−r²) dx by quad", naive),
    )


def rounded_punch() -> Curve:
    def naive(r: float) -> float:
        def density(x: float) -> float:
            slope = 2 * np.sqrt(x**2 - FLAT**2) - FLAT * np.arccos(FLAT / x)
            return float(slope / np.sqrt(x**2 - r**2)) if x > r else 0.0

        return plain_quad(density, r, A) / pi

    def exact(r: mpf) -> mpf:
        b, top = mpf(FLAT), mp.sqrt((A - r) * (A + r))

        def density(u: mpf) -> mpf:
            x = mp.sqrt(r**2 + u**2)
            s = mp.sqrt(max(x**2 - b**2, mpf(0)))
            return (2 * s - b * mp.atan2(s, b)) / x

        low = mp.sqrt(max((b - r) * (b + r), mpf(0)))
        return mp.quad(density, [low, top]) / mp.pi

    return against(
        "edge-rounded-punch",
        "pressure of a rounded punch near the edge, b = 0.6 a",
        RoundedPunch(FLAT, 1.0),
        exact,
        ("∫ g′/√(x²−r²) dx by quad", naive),
    )


CURVES = {
    "paraboloid": paraboloid,
    "cone": cone,
    "flat punch": flat_punch,
    "sphere": sphere,
    "rounded punch": rounded_punch,
}


@pytest.mark.parametrize("name", CURVES)
def test_pressure_near_the_edge(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-9)


def test_pressure_at_the_edge() -> None:
    for profile in (Paraboloid(BIG), Cone(SLOPE), Sphere(BIG), RoundedPunch(FLAT, 1.0)):
        contact = normal.solve(profile, 1.0, contact_radius=A)
        assert fields.pressure(contact, [A])[0] == 0
    rim = normal.solve(FlatPunch(A), 1.0, indentation_depth=1.0)
    assert np.isposinf(fields.pressure(rim, [A]))[0]
