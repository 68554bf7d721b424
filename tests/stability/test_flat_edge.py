"""Edge of a flat, b -> a and b -> 0: annuli below the rounding error of a keep their width."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal
from mdr_core.profiles import RoundedPunch, TruncatedCone, TruncatedParaboloid
from tests.stability.curves import (
    CLOSED,
    ROUNDING,
    Curve,
    attempt,
    curve,
    plain_quad,
    references,
    steps,
)

B, BIG, SLOPE = 1.0, 2.0, 0.3
#: Contact radii next to b; the actual distance is that of the rounded radius.
EDGES = B + steps(0.5, 2.3e-16, 40)
LABEL = "a/b − 1"


def root(a: mpf) -> mpf:
    return mp.sqrt((a - B) * (a + B))


def depth() -> Curve:
    """d = (a/R) (s - b arccos(b/a)), Eq. (5.59)."""
    contact = normal.solve(RoundedPunch(B, BIG), 1.0, contact_radius=EDGES)
    return curve(
        "flat-edge-depth",
        "depth of a rounded punch, b → a",
        LABEL,
        "√(a²−b²) − b arccos(b/a)",
        EDGES - B,
        (
            contact.indentation_depth,
            attempt(lambda a: a / BIG * (np.sqrt(a**2 - B**2) - B * np.arccos(B / a)), EDGES),
            references(lambda a: a / mpf(BIG) * (root(a) - mp.acos(B / a)), EDGES),
        ),
    )


def force() -> Curve:
    """F/E* = [s^3 + 3 a^2 (s - b arccos(b/a))]/(3R), Eq. (5.61)."""
    contact = normal.solve(RoundedPunch(B, BIG), 1.0, contact_radius=EDGES)

    def naive(a: float) -> float:
        s = np.sqrt(a**2 - B**2)
        return float((s**3 + 3 * a**2 * (s - B * np.arccos(B / a))) / (3 * BIG))

    def exact(a: mpf) -> mpf:
        return (root(a) ** 3 + 3 * a**2 * (root(a) - mp.acos(B / a))) / (3 * mpf(BIG))

    return curve(
        "flat-edge-force",
        "force on a rounded punch, b → a",
        LABEL,
        "s³ + 3a²(s − b arccos(b/a)), s = √(a²−b²)",
        EDGES - B,
        (contact.normal_force, attempt(naive, EDGES), references(exact, EDGES)),
    )


def truncated_cone() -> Curve:
    """d = t a arccos(b/a), with an argument close to one."""
    contact = normal.solve(TruncatedCone(B, SLOPE), 1.0, contact_radius=EDGES)
    return curve(
        "flat-edge-truncated-cone",
        "depth of a truncated cone, b → a",
        LABEL,
        "arccos(b/a)",
        EDGES - B,
        (
            contact.indentation_depth,
            attempt(lambda a: SLOPE * a * np.arccos(B / a), EDGES),
            references(lambda a: mpf(SLOPE) * a * mp.acos(B / a), EDGES),
        ),
    )


def stiffness_by_depth() -> Curve:
    """a - b at prescribed depth; a cannot resolve it, but the mean pressure beyond the flat can.

    Force at that depth: 2 b d to first order, plus the contribution of the rounding from s.
    """
    depths = steps(0.5, 1e-24, 40)
    contact = normal.solve(RoundedPunch(B, BIG), 1.0, indentation_depth=depths)

    def exact(d: mpf) -> mpf:
        guess = mp.cbrt(3 * d * mpf(BIG))
        s = mp.findroot(
            lambda s: mp.hypot(s, B) * (s - mp.atan(s)) - d * mpf(BIG), guess, tol=mpf(10) ** -75
        )
        return (s**3 + 3 * (s * s + 1) * (s - mp.atan(s))) / (3 * mpf(BIG))

    def naive(d: float) -> float:
        from_a = partial(_naive_depth)
        low, high = B, 10 * B
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if from_a(middle) < d else (low, middle)
        s = np.sqrt(high**2 - B**2)
        return float((s**3 + 3 * high**2 * (s - B * np.arccos(B / high))) / (3 * BIG))

    return curve(
        "flat-edge-inverse",
        "force of a rounded punch at prescribed depth, b → a",
        "d/b",
        "bisection for a, then the formula in a",
        depths,
        (contact.normal_force, attempt(naive, depths), references(exact, depths)),
    )


def _naive_depth(a: float) -> float:
    return float(a / BIG * (np.sqrt(a**2 - B**2) - B * np.arccos(B / a)))


def pressure(kind: str, limit: Any) -> Curve:
    """p at r = 0.3 a beyond a vanishing flat, or next to the edge of a finite one."""
    profiles = {
        "rounded punch": (lambda b: RoundedPunch(b, BIG)),
        "truncated paraboloid": (lambda b: TruncatedParaboloid(b, BIG)),
    }
    slopes: dict[str, Any] = {
        "rounded punch": lambda x, s, b, m: (2 * s - b * m.atan2(s, b)) / m.mpf(BIG),
        "truncated paraboloid": lambda x, s, b, m: (s + x * x / s) / m.mpf(BIG),
    }
    r = 0.3
    ours = [
        float(fields.pressure(normal.solve(profiles[kind](b), 1.0, contact_radius=1.0), [r])[0])
        for b in limit
    ]

    def exact(b: mpf) -> mpf:
        # x^2 = r^2 + u^2; b < r.
        top = mp.sqrt((1 - mpf(r)) * (1 + mpf(r)))

        def density(u: mpf) -> mpf:
            x = mp.sqrt(mpf(r) ** 2 + u * u)
            return slopes[kind](x, mp.sqrt((x - b) * (x + b)), b, mp) / x

        near = mp.sqrt((mpf(r) - b) * (mpf(r) + b))
        return mp.quad(density, [0, near, top] if near < top else [0, top]) / mp.pi

    def naive(b: float) -> float:
        def density(x: float) -> float:
            s = np.sqrt(x * x - b * b)
            part = 2 * s - b * np.arccos(b / x) if kind == "rounded punch" else s + x * x / s
            return float(part / BIG / np.sqrt(x * x - r * r)) if x > r else 0.0

        return plain_quad(density, r, 1.0) / pi

    return curve(
        f"flat-edge-{kind.replace(' ', '-')}-pressure",
        f"pressure of a {kind} at r = 0.3 a, b → 0",
        "b/a",
        "∫ g′/√(x²−r²) dx by quad",
        limit,
        (ours, attempt(naive, limit), references(exact, limit)),
        CLOSED + ROUNDING,
    )


CURVES = {
    "depth": depth,
    "force": force,
    "truncated cone": truncated_cone,
    "inverse": stiffness_by_depth,
    "rounded punch": partial(pressure, "rounded punch", steps(0.29, 1e-100)),
    "truncated paraboloid": partial(pressure, "truncated paraboloid", steps(0.29, 1e-100)),
}


@pytest.mark.parametrize("name", CURVES)
def test_near_the_flat_edge(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-13 if "pressure" in sweep.name else 1e-9)
