"""Vanishing load: every result keeps its full relative accuracy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core.profiles import FlatPunch, Hyperboloid, RoundedPunch, Series, SphericalTipCone
from mdr_core.profiles import PowerTerm as Term
from tests.core.comparison import profile_from
from tests.core.evaluations import PROFILES
from tests.stability.curves import (
    CLOSED,
    Curve,
    attempt,
    curve,
    references,
    steps,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from mdr_core.profiles import Profile

SLOPE, BIG, B = 0.4, 1.3, 0.6
#: Down to the smallest accepted load.
DEPTHS = steps(0.5, 1e-50, 40)


def by_depth(
    name: str,
    title: str,
    profile: Profile,
    force: Callable[[mpf], mpf],
    naive: tuple[str, Callable[[float], float]],
) -> Curve:
    """Force at prescribed depth; `force` evaluates it from the contact radius or from s."""
    contact = normal.solve(profile, 1.0, indentation_depth=DEPTHS)
    return curve(
        f"zero-load-{name}",
        title,
        "d",
        naive[0],
        DEPTHS,
        (contact.normal_force, attempt(naive[1], DEPTHS), references(force, DEPTHS)),
        CLOSED,
    )


def root(function: Callable[[mpf], mpf], goal: mpf, guess: mpf) -> mpf:
    """Solve function(x) = goal for x > 0 by Newton's method in log-log coordinates."""
    u = mp.log(guess)
    for _ in range(60):
        x = mp.exp(u)
        value = function(x)
        slope = mp.diff(lambda w: mp.log(function(mp.exp(w))), u, h=mpf(10) ** -30)
        step = mp.log(goal / value) / slope
        u += step
        if abs(step) < mpf(10) ** -45:
            return mp.exp(u)
    raise ArithmeticError("no root")


def bisected(function: Callable[[float], float], goal: float, high: float) -> float:
    """Solve by bisection in double precision, for the naive formula."""
    low = 0.0
    for _ in range(400):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < goal else (low, middle)
    return high


def hyperboloid() -> Curve:
    """d = t a arctan(a/h), F = t [(a^2 - h^2) arctan(a/h) + a h], h = R t."""
    h = mpf(BIG) * mpf(SLOPE)

    def exact(d: mpf) -> mpf:
        with mp.workdps(260):
            t, low = mpf(SLOPE), mpf(BIG) * mpf(SLOPE)
            a = mp.findroot(
                lambda a: t * a * mp.atan(a / low) - d, mp.sqrt(d * low / t), tol=mpf(10) ** -500,
                verify=False,
            )  # fmt: skip
            return t * ((a - low) * (a + low) * mp.atan(a / low) + a * low)

    def naive(d: float) -> float:
        low = float(h)
        a = bisected(lambda a: SLOPE * a * np.arctan(a / low), d, 10.0)
        return float(SLOPE * ((a**2 - low**2) * np.arctan(a / low) + a * low))

    return by_depth(
        "hyperboloid",
        "force on a hyperboloid, d → 0",
        Hyperboloid(SLOPE, BIG),
        exact,
        ("(a²−h²) arctan(a/h) + ah", naive),
    )


def rounded_punch() -> Curve:
    """F/E* = a d + s^3/(3R): of the order of d, with s = O(d^(1/3)) compared with b."""

    def exact(d: mpf) -> mpf:
        with mp.workdps(200):
            b, big = mpf(B), mpf(BIG)

            def depth(s: mpf) -> mpf:
                return mp.hypot(s, b) / big * (s - b * mp.atan(s / b))

            guess = mp.cbrt(3 * d * big * b)
            s = mp.findroot(lambda s: depth(s) - d, guess, tol=mpf(10) ** -390, verify=False)
            return mp.hypot(s, b) * d + s**3 / (3 * big)

    def naive(d: float) -> float:
        def depth(a: float) -> float:
            s = np.sqrt(max(a**2 - B**2, 0.0))
            return float(a / BIG * (s - B * np.arccos(min(B / a, 1.0)))) if a > B else 0.0

        a = bisected(depth, d, 10.0)
        s = np.sqrt(max(a**2 - B**2, 0.0))
        return float((s**3 + 3 * a**2 * (s - B * np.arccos(min(B / a, 1.0)))) / (3 * BIG))

    return by_depth(
        "rounded-punch",
        "force on a rounded punch, d → 0",
        RoundedPunch(B, BIG),
        exact,
        ("bisection for a; s³ + 3a²(s − b arccos(b/a))", naive),
    )


def series() -> Curve:
    """f = r^1.5 + r^4: the naive root finder uses an absolute tolerance."""
    profile = Series((Term(1.0, 1.5), Term(1.0, 4.0)))

    def equivalent_profile(a: Any, m: Any) -> Any:
        one = m.sqrt(m.pi) * m.gamma(m.mpf(1.75)) / m.gamma(m.mpf(1.25))
        return one * a ** m.mpf(1.5) + m.mpf(8) / 3 * a**4

    def exact(d: mpf) -> mpf:
        one = mp.sqrt(mp.pi) * mp.gamma(mpf(7) / 4) / mp.gamma(mpf(5) / 4)
        a = root(lambda a: equivalent_profile(a, mp), d, (d / one) ** (mpf(2) / 3))
        return mpf(6) / 5 * one * a ** mpf(2.5) + mpf(8) / 5 * mpf(8) / 3 * a**5

    one = float(mp.sqrt(mp.pi) * mp.gamma(mpf(7) / 4) / mp.gamma(mpf(5) / 4))

    def naive(d: float) -> float:
        low, high = 0.0, 10.0
        while high - low > 1e-12:
            middle = (low + high) / 2
            below = one * middle**1.5 + 8 / 3 * middle**4 < d
            low, high = (middle, high) if below else (low, middle)
        return 1.2 * one * high**2.5 + 64 / 15 * high**5

    return by_depth(
        "series",
        "force on r^1.5 + r^4, d → 0",
        profile,
        exact,
        ("bisection for a to 10⁻¹²", naive),
    )


def spherical_tip() -> Curve:
    """Contact within the spherical tip: F/E* = R^2 [(1 + t^2) v - t], v tanh v = d/R."""

    def exact(d: mpf) -> mpf:
        with mp.workdps(260):
            goal = d / mpf(BIG)
            v = mp.findroot(
                lambda v: v * mp.tanh(v) - goal, mp.sqrt(goal), tol=mpf(10) ** -500, verify=False
            )
            t = mp.tanh(v)
            return mpf(BIG) ** 2 * ((1 + t * t) * v - t)

    def naive(d: float) -> float:
        a = bisected(lambda a: a * np.arctanh(a / BIG), d, BIG * (1 - 1e-12))
        return float((a**2 + BIG**2) * np.arctanh(a / BIG) - a * BIG)

    # Tip radius b = R t/sqrt(1 + t^2).
    profile = SphericalTipCone(2.0, BIG)
    return by_depth(
        "spherical-tip",
        "force on a cone with a spherical tip, d → 0",
        profile,
        exact,
        ("(R²+a²) artanh(a/R) − aR", naive),
    )


CURVES = {
    "hyperboloid": hyperboloid,
    "rounded punch": rounded_punch,
    "series": series,
    "spherical tip": spherical_tip,
}


@pytest.mark.parametrize("name", CURVES)
def test_vanishing_load(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-2)


@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
@pytest.mark.parametrize("kind", PROFILES)
def test_zero_load_gives_zero(kind: str, control: str) -> None:
    contact = normal.solve(profile_from({"kind": kind, **PROFILES[kind]}), 1.0, **{control: 0.0})
    for name in ("indentation_depth", "normal_force", "elastic_energy"):
        assert getattr(contact, name) == 0, name
    flat = "radius" if kind == "flat_punch" else "flat_radius"
    assert contact.contact_radius == PROFILES[kind].get(flat, 0.0)
    assert np.isfinite(contact.normal_stiffness)


def test_zero_shear_at_flat_punch_edge_without_tangential_load() -> None:
    """The stress at the edge is infinite under any load but zero."""
    pressed = normal.solve(FlatPunch(1.0), 1.0, normal_force=[1.0, 2.0])
    pushed = tangential.solve(pressed, 0.8, 0.4, tangential_force=[0.0, 0.1])
    unpushed, loaded = fields.shear_stress(pushed, [0.0, 0.5, 1.0])
    assert not unpushed.any()
    assert loaded[2] == np.inf
