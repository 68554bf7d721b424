"""Powers with exponents n -> 0 and n -> infinity keep their accuracy."""

from __future__ import annotations

from functools import partial
from math import gamma, pi
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Power
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

#: Contact radius, coefficient and an arbitrary radius; a^10000 is representable.
A, C, R = 0.97, 0.7, 0.75
SMALL, LARGE = steps(0.9, 1e-6), steps(2.0, 2e3)


def kappa(n: mpf) -> mpf:
    return mp.sqrt(mp.pi) * mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2)


def naive_kappa(n: float) -> float:
    return np.sqrt(pi) * gamma(n / 2 + 1) / gamma((n + 1) / 2)


def contacts(exponents: Array, **load: float) -> list[normal.NormalContact]:
    return [normal.solve(Power(C, float(n)), 1.0, **load) for n in exponents]


def distance_from_limit(name: str, exponents: Array) -> tuple[str, Array]:
    """Distance from the limit: n for small exponents, 1/n for large ones."""
    return ("n", exponents) if name == "small" else ("1/n", 1 / exponents)


def force(name: str, exponents: Array) -> Curve:
    """F/E* = (2n/(n+1)) kappa C a^(n+1)."""

    def exact(n: mpf) -> mpf:
        return 2 * n / (n + 1) * kappa(n) * mpf(C) * mpf(A) ** (n + 1)

    label, distances = distance_from_limit(name, exponents)
    return curve(
        f"exponents-force-{name}",
        f"force of r^n, n → {'0' if name == 'small' else '∞'}",
        label,
        "Γ(n/2+1)/Γ((n+1)/2), aⁿ⁺¹",
        distances,
        (
            [float(one.normal_force) for one in contacts(exponents, contact_radius=A)],
            attempt(lambda n: 2 * n / (n + 1) * naive_kappa(n) * C * A ** (n + 1), exponents),
            references(exact, exponents),
        ),
        CLOSED + ROUNDING * (exponents + 1),
    )


def stick(name: str, exponents: Array) -> Curve:
    """a - c at 1e-4 of full slip: 1 - (1 - rho)^(1/(n+1))."""
    rho = 1e-4
    result = [
        tangential.solve(one, 1.0, 1.0, tangential_force=rho * float(one.normal_force))
        for one in contacts(exponents, contact_radius=A)
    ]
    given = [float(one.tangential_force / one.normal.normal_force) for one in result]

    def exact(n: mpf, ratio: mpf) -> mpf:
        return -mpf(A) * mp.expm1(mp.log1p(-ratio) / (n + 1))

    label, distances = distance_from_limit(name, exponents)
    return curve(
        f"exponents-width-{name}",
        f"slip annulus of r^n, n → {'0' if name == 'small' else '∞'}",
        label,
        "a − a (1 − ρ)^(1/(n+1))",
        distances,
        (
            [float(one.slip_width) for one in result],
            attempt(lambda n, q: A - A * (1 - q) ** (1 / (n + 1)), exponents, given),
            references(exact, exponents, given),
        ),
        # The force, and therefore the ratio, is a product of rounded numbers.
        CLOSED + 4 * ROUNDING,
    )


def pressure(name: str, exponents: Array) -> Curve:
    """p at r = 0.77 a by the hypergeometric form; the naive method is Gauss-Chebyshev."""

    def exact(n: mpf) -> mpf:
        a, r = mpf(A), mpf(R)
        root_squared = (a - r) * (a + r)
        series = mp.hyp2f1(1, 1 - n / 2, mpf(3) / 2, root_squared / a**2)
        return n * kappa(n) * mpf(C) / mp.pi * a ** (n - 2) * mp.sqrt(root_squared) * series

    nodes, weights = np.polynomial.legendre.leggauss(40)

    def naive(n: float) -> float:
        top = np.sqrt(A * A - R * R)
        x = np.sqrt(R * R + (top * (1 + nodes) / 2) ** 2)
        values = naive_kappa(n) * n * C * x ** (n - 1) / x
        return float(top / 2 * (weights @ values) / pi)

    label, distances = distance_from_limit(name, exponents)
    return curve(
        f"exponents-pressure-{name}",
        f"pressure of r^n at r = 0.77 a, n → {'0' if name == 'small' else '∞'}",
        label,
        "40 Gauss points in √(x²−r²), Γ(n/2+1)/Γ((n+1)/2)",
        distances,
        (
            [float(fields.pressure(one, [R])[0]) for one in contacts(exponents, contact_radius=A)],
            attempt(naive, exponents),
            references(exact, exponents),
        ),
        CLOSED + ROUNDING * (exponents + 1),
    )


def slip(name: str, exponents: Array) -> Curve:
    """Full slip: slip C r^n at r = 0.77 a, for E* = G*."""
    pushed = [
        tangential.solve(one, 1.0, 1.0, tangential_displacement=float(one.indentation_depth))
        for one in contacts(exponents, contact_radius=A)
    ]

    def naive(n: float) -> float:
        def density(x: float) -> float:
            return float(naive_kappa(n) * C * x**n / np.sqrt(R * R - x * x))

        return 2 / pi * plain_quad(density, 0.0, R)

    label, distances = distance_from_limit(name, exponents)
    return curve(
        f"exponents-slip-{name}",
        f"slip of r^n in full slip at r = 0.77 a, n → {'0' if name == 'small' else '∞'}",
        label,
        "∫ g/√(r²−x²) dx by quad",
        distances,
        (
            [-float(fields.slip(one, [R])[0]) for one in pushed],
            attempt(naive, exponents),
            references(lambda n: mpf(C) * mpf(R) ** n, exponents),
        ),
        CLOSED + ROUNDING * (exponents + 1),
    )


def _pairs(make: Callable[..., Curve]) -> dict[str, Any]:
    word = make.__name__
    return {
        f"{word}, n -> 0": partial(make, "small", SMALL),
        f"{word}, n -> inf": partial(make, "large", LARGE),
    }


CURVES: dict[str, Callable[[], Curve]] = (
    _pairs(force) | _pairs(stick) | _pairs(pressure) | _pairs(slip)
)


@pytest.mark.parametrize("name", CURVES)
def test_extreme_exponents(name: str) -> None:
    CURVES[name]().holds()


@pytest.mark.parametrize("name", [name for name in CURVES if "inf" in name])
def test_naive_formula_overflows(name: str) -> None:
    CURVES[name]().naive_fails(1e-11)
