"""Stick edge, r -> c: traction and slip keep the accuracy of their powers 1/2 and 3/2."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Cone, Paraboloid, Power, Profile, Sphere
from tests.stability.curves import (
    CLOSED,
    ROUNDING,
    Array,
    Curve,
    attempt,
    curve,
    plain_quad,
    references,
    steps,
)

if TYPE_CHECKING:
    from collections.abc import Callable

A, C, SLOPE, BIG = 1.0, 0.625, 0.3, 1.3


def tangential_contact(profile: Profile) -> tangential.TangentialContact:
    contact = normal.solve(profile, 1.0, contact_radius=A)
    return tangential.solve(contact, 1.0, 1.0, stick_radius=C)


def traction(side: str, radii: Array) -> Curve:
    """(2 mu E*/(pi R)) [sqrt(a^2 - r^2) - sqrt(c^2 - r^2)]."""

    def exact(r: mpf) -> mpf:
        inner = mp.sqrt((C - r) * (C + r)) if r < C else mpf(0)
        return 2 / (mp.pi * mpf(BIG)) * (mp.sqrt((A - r) * (A + r)) - inner)

    def naive(r: float) -> float:
        def density(x: float) -> float:
            return float(2 * x / BIG / np.sqrt(x * x - r * r)) if x > r else 0.0

        return plain_quad(density, max(r, C), A) / pi

    return curve(
        f"stick-edge-traction-{side}",
        f"traction of a paraboloid near c, from {side}",
        "|r/c − 1|",
        "∫ over the annulus by quad",
        np.abs(radii - C) / C,
        (
            fields.shear_stress(tangential_contact(Paraboloid(BIG)), radii),
            attempt(naive, radii),
            references(exact, radii),
        ),
    )


def slip(
    name: str,
    profile: Profile,
    exact: Callable[[mpf], mpf],
    naive: tuple[str, Callable[[float], float]],
    bound: float = CLOSED,
) -> Curve:
    r = C * (1 + DISTANCES)
    return curve(
        f"stick-edge-slip-{name}",
        f"slip of a {name} near c",
        "r/c − 1",
        naive[0],
        r / C - 1,
        (
            -fields.slip(tangential_contact(profile), r),
            attempt(naive[1], r),
            references(exact, r),
        ),
        bound,
    )


def cone_slip() -> Curve:
    """t [sqrt(r^2 - c^2) - c arccos(c/r)]."""
    return slip(
        "cone",
        Cone(SLOPE),
        lambda r: mpf(SLOPE) * (mp.sqrt((r - C) * (r + C)) - C * mp.acos(C / r)),
        (
            "√(r²−c²) − c arccos(c/r)",
            lambda r: SLOPE * (np.sqrt(r**2 - C**2) - C * np.arccos(C / r)),
        ),
    )


def paraboloid_slip() -> Curve:
    """Johnson's form, Eq. (5.41): [(r^2 - 2c^2) arccos(c/r) + c sqrt(r^2 - c^2)]/(pi R)."""
    return slip(
        "paraboloid",
        Paraboloid(BIG),
        lambda r: (
            ((r**2 - 2 * mpf(C) ** 2) * mp.acos(C / r) + C * mp.sqrt((r - C) * (r + C)))
            / (mp.pi * mpf(BIG))
        ),
        (
            "(r²−2c²) arccos(c/r) + c √(r²−c²)",
            lambda r: (
                ((r**2 - 2 * C**2) * np.arccos(C / r) + C * np.sqrt(r**2 - C**2)) / (pi * BIG)
            ),
        ),
    )


def sphere_slip() -> Curve:
    """Integration by parts: (2/pi) int_c^r g' arccos(x/r) dx."""

    def exact(r: mpf) -> mpf:
        big, width = mpf(BIG), r - C

        def density(v: mpf) -> mpf:
            x = r - width * v * v
            angle = mp.atan2(mp.sqrt((r - x) * (r + x)), x)
            return (mp.atanh(x / big) + x * big / (big**2 - x**2)) * angle * 2 * v * width

        return 2 / mp.pi * mp.quad(density, [0, 1])

    def naive(r: float) -> float:
        def equivalent_profile(x: float) -> float:
            return float(x * np.arctanh(x / BIG))

        def density(x: float) -> float:
            return (
                (equivalent_profile(x) - equivalent_profile(C)) / float(np.sqrt(r**2 - x**2))
                if x < r
                else 0.0
            )

        return 2 / pi * plain_quad(density, C, r)

    return slip(
        "sphere",
        Sphere(BIG),
        exact,
        ("∫ (g − g(c))/√(r²−x²) dx by quad", naive),
    )


DISTANCES = steps(0.5, 1e-15, 40)
CURVES = {
    "traction inside": partial(traction, "inside", C * (1 - DISTANCES)),
    "traction outside": partial(traction, "outside", C * (1 + DISTANCES)),
    "cone": cone_slip,
    "paraboloid": paraboloid_slip,
    "sphere": sphere_slip,
}


@pytest.mark.parametrize("name", CURVES)
def test_near_the_stick_edge(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-12)


def test_at_the_stick_edge() -> None:
    for profile in (Paraboloid(BIG), Cone(SLOPE), Sphere(BIG)):
        result = tangential_contact(profile)
        assert fields.slip(result, [C])[0] == 0
        beside = fields.shear_stress(result, [C * (1 - ROUNDING), C, C * (1 + ROUNDING)])
        assert beside == pytest.approx(np.full(3, beside[1]), rel=1e-6, abs=0)


@pytest.mark.parametrize("gap", [1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("profile", [Paraboloid(1.0), Power(0.5, 4.0)])
def test_slip_next_to_the_stick_edge_alone_is_within_its_estimate(
    profile: Profile, gap: float
) -> None:
    """The references have stick radii at both ends of the rounding error."""
    contact = normal.solve(profile, 1.0, normal_force=1.0)
    pushed = tangential.solve(contact, 1.0, 0.3, tangential_force=0.15)
    c, error = float(pushed.stick_radius), float(pushed.stick_error)
    radius = c * (1 + gap * np.array([0.3, 1.0]))
    slip = fields.slip(pushed, radius)
    estimate = fields.own_error(pushed) + fields.edge_error(pushed, "slip", radius)
    for side in (-1, 1):
        other = tangential.solve(contact, 1.0, 0.3, stick_radius=c + side * error)
        change = np.abs(fields.slip(other, radius) - slip).max() / np.abs(slip).max()
        # The end is rounded itself.
        assert change <= estimate * max(1.0, abs(float(other.stick_radius) - c) / error)
