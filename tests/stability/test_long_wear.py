"""Wear from the narrowest annulus to full slip, up to 1e12 cycles, reaches its limit."""

from __future__ import annotations

from functools import cache, partial
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import normal
from mdr_core.profiles import Paraboloid
from mdr_core.wear import evolution, limit
from tests.stability.curves import (
    CLOSED,
    ROUNDING,
    Array,
    Curve,
    attempt,
    curve,
    references,
    steps,
)

DEPTH, BIG, MU, WEAR = 1.0, 1.3, 0.4, 1e-4
FULL = MU * DEPTH
#: Fractions of full slip for E* = G*: incipient slip and onset of full slip.
INCIPIENT_SLIP = steps(0.5, 1e-12, 40)
NEAR_FULL_SLIP = steps(0.5, 1e-12, 40)


def amplitudes(end: str) -> Array:
    return FULL * INCIPIENT_SLIP if end == "thin" else FULL * (1 - NEAR_FULL_SLIP)


@cache
def limits(end: str) -> limit.LimitingWear:
    contact = normal.solve(Paraboloid(BIG), 1.0, indentation_depth=DEPTH)
    return limit.solve(contact, 1.0, MU, tangential_displacement=amplitudes(end))


def annulus(u: mpf) -> tuple[mpf, mpf]:
    """c and A: int_c^A (d - x^2/R)/sqrt(A^2 - x^2) dx = 0, Eq. (5.88) with d = 1."""
    big, depth = mpf(BIG), mpf(DEPTH)
    c = mp.sqrt(big * (depth - u / mpf(MU)))
    a = mp.sqrt(big * depth)

    def carried(outer: mpf) -> mpf:
        w = mp.sqrt((outer - c) * (outer + c))
        phi = mp.atan2(w, c)
        return (depth * phi - (outer**2 * phi + c * w) / (2 * big)) / w

    thin = a + (a - c) / 2
    return c, mp.findroot(carried, (a + (a - c) / 8, thin + (a - c)), solver="anderson",
                          tol=mpf(10) ** -110, maxsteps=200)  # fmt: skip


def volume(c: Any, outer: Any, m: Any) -> Any:
    """4 int_c^A (d - x^2/R) sqrt(A^2 - x^2) dx in closed form."""
    w = m.sqrt((outer - c) * (outer + c))
    phi = m.atan2(w, c)
    first = (outer**2 * phi - c * w) / 2
    second = (outer**4 * phi + c * (outer**2 - 2 * c**2) * w) / 8
    return 4 * DEPTH * first - 4 * second / BIG


class _Doubles:
    sqrt, atan2 = staticmethod(np.sqrt), staticmethod(np.arctan2)


def naive_annulus(u: float) -> tuple[float, float]:
    """The annulus in double precision, by bisection for A."""
    c = float(np.sqrt(BIG * (DEPTH - u / MU)))
    low, high = float(np.sqrt(BIG * DEPTH)), 2 * float(np.sqrt(BIG * DEPTH))
    for _ in range(100):
        middle = (low + high) / 2
        w = np.sqrt(middle**2 - c**2)
        phi = np.arccos(c / middle)
        rises = DEPTH * phi - (middle**2 * phi + c * w) / (2 * BIG) > 0
        low, high = (middle, high) if rises else (low, middle)
    return c, high


def of_limit(end: str, answer: str) -> Curve:
    given = amplitudes(end)
    result = limits(end)

    def exact(u: mpf) -> mpf:
        with mp.workdps(120):
            c, outer = annulus(u)
            return outer - c if answer == "wear_width" else volume(c, outer, mp)

    def naive(u: float) -> float:
        c, outer = naive_annulus(u)
        return outer - c if answer == "wear_width" else float(volume(c, outer, _Doubles))

    title = {"wear_width": "width of the worn annulus", "worn_volume": "worn volume"}[answer]
    formula = {"wear_width": "A − c, A by bisection", "worn_volume": "4d I₀ − 4 I₂/R"}[answer]
    rest = np.ones_like(given) if end == "thin" else NEAR_FULL_SLIP
    return curve(
        f"long-wear-{answer.replace('_', '-')}-{end}",
        f"{title}, {'c → a' if end == 'thin' else 'c → 0'}",
        "u_x/u_x,max" if end == "thin" else "1 − u_x/u_x,max",
        formula,
        INCIPIENT_SLIP if end == "thin" else NEAR_FULL_SLIP,
        (getattr(result, answer), attempt(naive, given), references(exact, given)),
        # Near full slip the stick radius is ill-conditioned with respect to the amplitude.
        10 * CLOSED + ROUNDING / rest,
    )


@cache
def worn() -> evolution.WearEvolution:
    contact = normal.solve(Paraboloid(BIG), 1.0, indentation_depth=DEPTH)
    cycles = [0.0, *np.geomspace(1.0, 1e12, 36)]
    return evolution.solve(
        contact,
        1.0,
        MU,
        wear_coefficient=WEAR,
        cycles=cycles,
        tangential_displacement=0.5 * FULL,
    )


def to_the_limit() -> Curve:
    """Worn volume against the number of cycles, up to the limiting state."""
    result = worn()
    number = result.cycles[1:]
    with mp.workdps(60):
        c, outer = annulus(mpf(0.5 * FULL))
        last = volume(c, outer, mp)
        a = mp.sqrt(mpf(BIG))
        each = 16 * mpf(MU) ** 2 / (15 * mpf(BIG) ** 2) * (a - c) ** 3
        each *= a * a + 3 * a * c + c * c
    settled = number > 1e9
    return curve(
        "long-wear-cycles",
        "worn volume relative to its limit",
        "1/cycles",
        "N times the wear of the first cycle",
        1 / number,
        (result.worn_volume[1:], float(each) * WEAR * number, [last] * number.size),
        np.where(settled, 1e-3, 1.0),
    )


CURVES = {
    "width, thin": partial(of_limit, "thin", "wear_width"),
    "width, onset": partial(of_limit, "onset", "wear_width"),
    "volume, thin": partial(of_limit, "thin", "worn_volume"),
    "volume, onset": partial(of_limit, "onset", "worn_volume"),
    "cycles": to_the_limit,
}


@pytest.mark.parametrize("name", CURVES)
def test_limiting_state(name: str) -> None:
    CURVES[name]().holds()


@pytest.mark.parametrize("name", ["width, thin", "volume, thin", "cycles"])
def test_naive_formula_fails(name: str) -> None:
    CURVES[name]().naive_fails(1e-3)


def test_error_of_the_limit_within_estimate() -> None:
    for end in ("thin", "onset"):
        worst = max(of_limit(end, name).ours.max() for name in ("wear_width", "worn_volume"))
        assert limits(end).error_estimate >= worst, end
