"""Sphere, a -> R and a -> 0: digits are kept at the equator and in the paraboloid limit."""

from __future__ import annotations

from functools import cache, partial
from math import pi
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal
from mdr_core.profiles import Ellipsoid, Sphere
from tests.core.comparison import EPS
from tests.stability.curves import (
    CLOSED,
    Curve,
    attempt,
    curve,
    plain_quad,
    references,
    steps,
)

if TYPE_CHECKING:
    from collections.abc import Callable

BIG = 1.0
#: Contact radii next to R; the actual distance is that of the rounded radius.
EDGES = BIG - steps(0.5, 1.001e-8, 40)
#: Radii have rounding errors beside their distance from R; at most 1e-9 is admitted.
RADII = np.clip(EPS / (BIG - EDGES), CLOSED, 1e-9)
SMALL = steps(0.9, 1e-40, 40)


def depth(name: str) -> Curve:
    """d = a artanh(a/R)."""
    a = EDGES if name == "equator" else SMALL
    contact = normal.solve(Sphere(BIG), 1.0, contact_radius=a)
    return curve(
        f"sphere-depth-{name}",
        f"depth of a sphere, a → {'R' if name == 'equator' else '0'}",
        "1 − a/R" if name == "equator" else "a/R",
        "(a/2) ln((R+a)/(R−a))",
        BIG - a if name == "equator" else a,
        (
            contact.indentation_depth,
            attempt(lambda a: a / 2 * np.log((BIG + a) / (BIG - a)), a),
            references(lambda a: a * mp.atanh(a / BIG), a),
        ),
    )


def force(name: str) -> Curve:
    """F/E* = (R^2 + a^2) artanh(a/R) - a R (Segedin); cancellation of order (R/a)^2 as a -> 0."""
    a = EDGES if name == "equator" else SMALL
    contact = normal.solve(Sphere(BIG), 1.0, contact_radius=a)

    def exact(a: mpf) -> mpf:
        with mp.workdps(150):
            return (a * a + BIG) * mp.atanh(a / BIG) - a * BIG

    return curve(
        f"sphere-force-{name}",
        f"force on a sphere, a → {'R' if name == 'equator' else '0'}",
        "1 − a/R" if name == "equator" else "a/R",
        "(R²+a²) artanh(a/R) − aR",
        BIG - a if name == "equator" else a,
        (
            contact.normal_force,
            attempt(lambda a: (a**2 + BIG**2) * np.arctanh(a / BIG) - a * BIG, a),
            references(exact, a),
        ),
    )


@cache
def pressure(fraction: float) -> Curve:
    """p at a fraction of the contact radius; at the equator the pole of g' approaches the edge."""
    ours = [
        float(
            fields.pressure(
                normal.solve(Ellipsoid(BIG, 0.5), 1.0, contact_radius=a),
                [fraction * a],
            )[0]
        )
        for a in EDGES
    ]

    def slope(x: mpf, m: Callable[[mpf], mpf]) -> mpf:
        return (m(x) + x / ((1 - x) * (1 + x))) / 2

    def exact(a: mpf) -> mpf:
        r = mpf(float(fraction * float(a)))

        def density(v: mpf) -> mpf:
            # The substitution x = tanh v removes the pole, w^2 = v - v_r the square root.
            w = low + v * v
            x = mp.tanh(w)
            sech = mp.sech(w)
            # x^2 - r^2 = sinh(w - low) sinh(w + low) / (cosh^2 w cosh^2 low).
            root = mp.sqrt(mp.sinh(v * v) * mp.sinh(w + low)) * sech / mp.cosh(low)
            return (w + x * mp.cosh(w) ** 2) / 2 * sech**2 / root * 2 * v

        low, top = mp.atanh(r), mp.atanh(a)
        end = mp.sqrt(top - low)
        return mp.quad(density, mp.linspace(0, end, 3)) / mp.pi

    def naive(a: float) -> float:
        r = fraction * a

        def density(x: float) -> float:
            return float(slope(x, np.arctanh) / np.sqrt(x * x - r * r)) if x > r else 0.0

        return plain_quad(density, r, a) / pi

    with mp.workdps(20):
        truth = [exact(mpf(float(a))) for a in EDGES]
    return curve(
        f"sphere-pressure-{fraction}",
        f"pressure of an ellipsoid at r = {fraction} a, a → its radius",
        "1 − a/R",
        "∫ g′/√(x²−r²) dx by quad",
        BIG - EDGES,
        (ours, attempt(naive, EDGES), truth),
        RADII,
    )


def outside(fraction: float) -> Curve:
    """Displacement outside the contact, r = fraction R: the pole of g' is next to the edge."""
    r = fraction * BIG

    def ours(a: float) -> float:
        contact = normal.solve(Sphere(BIG), 1.0, contact_radius=a)
        return float(fields.normal_displacement(contact, [r])[0])

    def exact(a: float) -> mpf:
        # Eq. (5.75) integrated by parts, (2/pi) int g' arcsin(x/r) dx; x = tanh v removes the pole.
        def density(v: mpf) -> mpf:
            return (v * mp.sech(v) ** 2 + mp.tanh(v)) * mp.asin(mp.tanh(v) / mpf(r))

        with mp.workdps(25):
            return 2 / mp.pi * mp.quad(density, [0, mp.atanh(mpf(a))])

    def naive(a: float) -> float:
        def density(x: float) -> float:
            slope = np.arctanh(x / BIG) + x * BIG / (BIG**2 - x**2)
            return float(slope * np.arcsin(x / r))

        return 2 / pi * plain_quad(density, 0.0, a)

    edges = EDGES[::-1].tolist()
    return curve(
        f"sphere-beside-{fraction}",
        f"displacement outside a sphere at r = {fraction} R, a → R",
        "1 − a/R",
        "∫ g′ arcsin(x/r) dx by quad",
        BIG - EDGES[::-1],
        ([ours(a) for a in edges], attempt(naive, edges), [exact(a) for a in edges]),
        RADII[::-1],
    )


CURVES = {
    "depth, a -> R": partial(depth, "equator"),
    "depth, a -> 0": partial(depth, "tip"),
    "force, a -> R": partial(force, "equator"),
    "force, a -> 0": partial(force, "tip"),
    "pressure inside": partial(pressure, 0.3),
    "pressure outside": partial(pressure, 0.95),
    "beside, on the equator's circle": partial(outside, 1.0),
    "beside": partial(outside, 1.3),
}


@pytest.mark.every(3)
@pytest.mark.parametrize("name", CURVES)
def test_equator_and_small_contact_limits(name: str) -> None:
    CURVES[name]().holds()


@pytest.mark.long
@pytest.mark.parametrize("name", ["depth, a -> 0", "force, a -> 0"])
def test_naive_formula_fails(name: str) -> None:
    CURVES[name]().naive_fails(1e-6)


@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
def test_error_of_a_load_next_to_the_equator(control: str) -> None:
    """The rounding of the radius is within the estimate, and below 1e-9 up to the end."""
    size = 0.7321
    for gap in steps(0.1, 2e-8, 30):
        with mp.workdps(40):
            big = mpf(size)

            def loads(v: mpf, big: mpf = big) -> dict[str, mpf]:
                t = mp.tanh(v)
                return {
                    "indentation_depth": big * v * t,
                    "normal_force": big * big * ((1 + t * t) * v - t),
                }

            near = mp.atanh(1 - mpf(gap))
            given = float(loads(near)[control])
            exact = loads(mp.findroot(lambda v, given=given: loads(v)[control] - given, near))
            contact = normal.solve(Sphere(size), 1.0, **{control: given})
            for name, truth in exact.items():
                error = abs(mpf(float(getattr(contact, name))) / truth - 1)
                assert error <= min(contact.error_estimate, 1e-9)
