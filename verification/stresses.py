"""Stresses on and beneath the surface: Huber, Hamilton, Johnson."""

from collections.abc import Iterator
from typing import Any

from mpmath import asin, atan, atan2, mpf, pi, sqrt

from verification.case import QUADRATURE, Case, at, fields, normal

PATH = "/v1/subsurface"
# E* = 1, R = 2, a = 1: p0 = 2 E* a/(pi R) = 1/pi.
P0 = 1 / pi
BALL = {"kind": "paraboloid", "radius": 2.0}


def _request(x: float, z: float, quantity: str, nu: float, **more: Any) -> dict[str, Any]:
    material = {"e_star": 1.0, "g_star": 1.0, "poissons_ratio": nu}
    place = {"x": [x], "z": [z], "quantities": [quantity]}
    return {"profile": BALL, "material": material, "load": {"contact_radius": 1.0}} | place | more


def huber_stress(r: Any, z: Any, nu: Any) -> dict[str, Any]:
    """Return the stresses of a Hertzian contact over p0, in cylindrical coordinates."""
    half = (r**2 + z**2 - 1) / 2
    u = half + sqrt(half**2 + z**2)
    root, w = sqrt(u), z / sqrt(u)
    mix = (1 - 2 * nu) / 3 * (1 - w**3) / r**2
    bend = root * atan(1 / root)
    axial = w**3 * u / (u**2 + z**2)
    return {
        "stress_zz": -axial,
        "stress_xx": mix + w * ((1 - nu) * u / (1 + u) + (1 + nu) * bend - 2) + axial,
        "stress_yy": -(mix + w * (2 * nu + (1 - nu) * u / (1 + u) - (1 + nu) * bend)),
        "stress_xz": -r * z**2 / (u**2 + z**2) * root / (1 + u),
    }


def huber() -> Iterator[Case]:
    """Hertzian contact: the four components at points off the axis."""
    for x, z, nu in ((0.5, 0.25, 0.3), (0.9, 0.1, 0.3), (1.5, 0.5, 0.3), (0.3, 2.0, 0.5)):
        for name, value in huber_stress(mpf(x), mpf(z), mpf(nu)).items():
            yield Case(
                "huber",
                "interior",
                f"x/a = {x}, z/a = {z}, nu = {nu}: {name}",
                PATH,
                _request(x, z, name, nu),
                at(name, 0, 0, 0),
                value * P0,
                bound=QUADRATURE,
                scale=P0,
            )


def hamilton_stress(x: Any, z: Any, nu: Any) -> dict[str, Any]:
    """Return the stresses by the traction mu p of a sliding sphere over mu p0, in y = 0."""
    r2 = x**2
    a = r2 + z**2 - 1
    s = sqrt(a**2 + 4 * z**2)
    m, n = sqrt((s + a) / 2), sqrt((s - a) / 2)
    phi, mixed = atan2(1, m), (1 - 2 * nu) * (s / 6 + a / 3)
    xx = (
        -x * (nu / 4 + 1) * phi
        + x * m / r2**2 * (-(s * nu - 2 * a * nu + z**2) / 2 + r2 * z**2 / s + (1 - nu / 4) * r2)
        + x * z * n / r2**2 * ((mixed + (z**2 + 3) / 2) / 2 + r2 / s - (nu + 7) * r2 / 4)
        - 2 * x * z / (3 * r2**2) * (1 - 2 * nu)
    )
    yy = (
        -3 * nu * x * phi / 4
        + x * m / r2**2 * ((nu * (s - 2 * a + r2) + z**2) / 2 + 3 * nu * r2 / 4)
        - x * z * n / r2**2 * ((mixed + (z**2 + 3) / 2) / 2 + (3 * nu + 1) * r2 / 4)
        + 2 * x * z / (3 * r2**2) * (1 - 2 * nu)
    )
    xz = (
        3 * z * phi / 2
        + z * m / r2 * (2 - r2 / s)
        + n / r2 * (-3 * (s + 2 * a) / 4 + z**2 / 4 - mpf(3) / 4 - r2 / 4)
    )
    zz = x * z * n / (2 * r2) * (1 - (r2 + z**2 + 1) / s)
    return {"stress_xx": xx, "stress_yy": yy, "stress_zz": zz, "stress_xz": xz}


def hamilton() -> Iterator[Case]:
    """Sliding sphere: pressure (Huber) and traction (Hamilton) together, mu = 0.3."""
    slides = {
        "friction_coefficient": 0.3,
        "tangential": {"tangential_displacement": 10.0},
        "body": 2,
    }
    for x, z, nu in ((0.5, 0.25, 0.3), (-0.9, 0.1, 0.3), (1.5, 0.5, 0.3), (-0.3, 2.0, 0.5)):
        pressed = huber_stress(abs(mpf(x)), mpf(z), mpf(nu))
        sign = 1 if x > 0 else -1
        for name, traction in hamilton_stress(mpf(x), mpf(z), mpf(nu)).items():
            part = pressed[name] * (sign if name == "stress_xz" else 1)
            yield Case(
                "hamilton",
                "plane y = 0",
                f"x/a = {x}, z/a = {z}, nu = {nu}: {name}",
                PATH,
                _request(x, z, name, nu, **slides),
                at(name, 0, 0, 0),
                (part + mpf(0.3) * traction) * P0,
                bound=QUADRATURE,
                scale=P0,
            )


def johnson() -> Iterator[Case]:
    """Printed and closed values of chapter 3, 4 and 6."""
    for z, nu in ((0.48, 0.3), (1.0, 0.3), (0.01, 0.0)):
        depth = mpf(z)
        values = {
            "stress_zz": -1 / (1 + depth**2),
            "stress_xx": -(1 + mpf(nu)) * (1 - depth * atan(1 / depth)) + 1 / (2 * (1 + depth**2)),
        }
        for name, value in values.items():
            yield Case(
                "johnson",
                "(3.45)",
                f"axis, z/a = {z}, nu = {nu}: {name}",
                PATH,
                _request(0.0, z, name, nu),
                at(name, 0, 0, 0),
                value * P0,
                bound=QUADRATURE,
                scale=P0,
            )
    yield Case(
        "johnson",
        "section 3.4",
        "edge of the contact, nu = 0.3: radial tension",
        PATH,
        _request(1.0, 0.0, "stress_xx", 0.3),
        at("stress_xx", 0, 0, 0),
        (1 - 2 * mpf(0.3)) / 3 * P0,
        bound=QUADRATURE,
    )
    peak = _request(0.0, 0.48, "von_mises", 0.3, largest=True)
    yield Case(
        "johnson",
        "section 4.2",
        "largest shear stress 0.31 p0, nu = 0.3",
        PATH,
        peak,
        ("largest", "maximum_shear", "value", 0),
        mpf("0.31") * P0,
        bound=0.005 / 0.31,
        uncertainty=0.005 / 0.31,
    )
    yield Case(
        "johnson",
        "section 4.2",
        "its depth 0.48 a",
        PATH,
        peak,
        ("largest", "maximum_shear", "z", 0),
        mpf("0.48"),
        bound=0.005 / 0.48,
        uncertainty=0.005 / 0.48,
    )
    bodies = {"material": {"e_star": 1.0, "poissons_ratio": 0.3, "yield_strength": 1e-3}}
    onset = pi**3 * 4 * mpf(1.60e-3) ** 3 / 6
    for criterion in ("tresca", "von_mises"):
        # F = pi^3 R^2 p0^3/(6 E*^2) with p0 = 1.60 Y, which follows from the printed 0.31 p0.
        yield Case(
            "johnson",
            "section 6.1",
            f"first yield at p0 = 1.60 Y, {criterion}",
            PATH,
            _request(0.0, 0.48, "von_mises", 0.3) | bodies,
            ("yield_onset_force", criterion, 0),
            onset,
            bound=3 * 0.005 / 0.31,
            uncertainty=3 * 0.005 / 0.31,
        )
    radii = (0.5, 1.2, 3.0, 50.0)
    request = fields(normal(BALL, {"contact_radius": 1.0}), "normal_displacement", radii)
    for i, r in enumerate(map(mpf, radii)):
        inside, root = pi * (2 - r**2) / 4, sqrt(abs(1 - 1 / r**2))
        outside = ((2 - r**2) * asin(min(1, 1 / r)) + r * root) / 2
        yield Case(
            "johnson",
            "(3.42)",
            f"sphere: surface displacement at r/a = {radii[i]}",
            "/v1/stress",
            request,
            at("normal_displacement", 0, i),
            P0 * (inside if r < 1 else outside),
            bound=1e-11,
        )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    for part in (huber, hamilton, johnson):
        yield from part()
