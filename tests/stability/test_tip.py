"""The axis, r -> 0: unbounded logarithms and powers keep their accuracy."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Cone, Power, Profile, RoundedCone
from tests.stability.curves import (
    DIGITS,
    Curve,
    attempt,
    curve,
    plain_quad,
    references,
    steps,
)

if TYPE_CHECKING:
    from collections.abc import Callable

A, SLOPE = 1.0, 0.3
LABEL = "r/a"


def normal_contact(profile: Profile) -> normal.NormalContact:
    return normal.solve(profile, 1.0, contact_radius=A)


def cone_pressure() -> Curve:
    """(t/2) arccosh(a/r): the textbook form overflows for small r."""
    r = steps(0.9, 1e-300)
    return curve(
        "tip-cone-pressure",
        "pressure of a cone near its tip",
        LABEL,
        "∫ g′/√(x²−r²) dx by quad",
        r,
        (
            fields.pressure(normal_contact(Cone(SLOPE)), r),
            attempt(lambda x: SLOPE / 2 * plain_quad(abel_kernel(x), x, A), r),
            references(lambda x: mpf(SLOPE) / 2 * mp.acosh(A / x), r),
        ),
    )


def cone_traction() -> Curve:
    """Traction (mu t/2) [arccosh(a/r) - arccosh(c/r)] of a thin annulus, with cancellation."""
    r, c = steps(0.9, 1e-300), 1 - 2.0**-20
    contact = tangential.solve(normal_contact(Cone(SLOPE)), 1.0, 1.0, stick_radius=c)
    return curve(
        "tip-cone-traction",
        "traction of a cone near its tip, c = (1 − 10⁻⁶)a",
        LABEL,
        "arccosh(a/r) − arccosh(c/r)",
        r,
        (
            fields.shear_stress(contact, r),
            attempt(lambda x: SLOPE / 2 * (np.arccosh(A / x) - np.arccosh(c / x)), r),
            references(lambda x: mpf(SLOPE) / 2 * (mp.acosh(A / x) - mp.acosh(c / x)), r),
        ),
    )


def power_pressure(exponent: float) -> Curve:
    """C r^n by the hypergeometric form; the pressure is infinite at the tip for n < 1."""
    r = steps(0.9, 1e-30)

    def slope(x: float) -> float:
        return exponent * x ** (exponent - 1)

    def exact(x: mpf) -> mpf:
        # For arguments close to 1, the radius enters through the last digits only.
        with mp.workdps(3 * DIGITS):
            n, root_squared = mpf(exponent), (1 - x) * (1 + x)
            kappa = mp.sqrt(mp.pi) * mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2)
            return (
                n
                * kappa
                / mp.pi
                * mp.sqrt(root_squared)
                * mp.hyp2f1(1, 1 - n / 2, mpf(3) / 2, root_squared)
            )

    factor = float(references(lambda n: mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2), [exponent])[0])
    return curve(
        f"tip-power-{exponent}",
        f"pressure of r^{exponent} near its tip",
        LABEL,
        "∫ g′/√(x²−r²) dx by quad",
        r,
        (
            fields.pressure(normal_contact(Power(1.0, exponent)), r),
            attempt(
                lambda x: (
                    factor * pi**-0.5 * plain_quad(lambda y: slope(y) * abel_kernel(x)(y), x, A)
                ),
                r,
            ),
            references(exact, r),
        ),
    )


def abel_kernel(r: float) -> Callable[[float], float]:
    """The kernel 1/sqrt(x^2 - r^2)."""
    return lambda x: 1 / np.sqrt(x * x - r * r) if x > r else 0.0


def rounded_cone() -> Curve:
    """A cone whose tip is rounded over 1e-6 a; the logarithm ends at the break."""
    r, b = steps(0.9, 1e-20), 1e-6
    profile = RoundedCone(SLOPE, b / SLOPE)
    b = float(profile.breaks[0])

    def exact(x: mpf) -> mpf:
        # g' = 2 x/R up to b, t [2 b/(x + s) + arctan(s/b)] beyond, both integrated by parts from
        # f'.
        t, e = mpf(SLOPE), mpf(b)
        inner = 2 * t / e * mp.sqrt((e - x) * (e + x)) if x < e else mpf(0)

        def density(y: mpf) -> mpf:
            # y^2 = x^2 + u^2 removes the singularity at r; u = sinh resolves many decades.
            z = mp.sqrt(x * x + mp.sinh(y) ** 2 * low**2)
            s = mp.sqrt(max((z - e) * (z + e), mpf(0)))
            return t * (2 * e / (z + s) + mp.atan2(s, e)) * low * mp.cosh(y) / z

        start = max(x, e)
        low = e
        ends = [mp.asinh(mp.sqrt((end - x) * (end + x)) / low) for end in (start, mpf(A))]
        pieces = mp.linspace(ends[0], ends[1], 8)
        return (inner + mp.quad(density, [ends[0], *(ends[0] + mpf(10) ** -k for k in (8, 4, 2)),
                                          *pieces[1:]])) / mp.pi  # fmt: skip

    def naive(x: float) -> float:
        def slope(y: float) -> float:
            if y <= b:
                return 2 * SLOPE * y / b
            s = np.sqrt(y * y - b * b)
            return SLOPE * (2 * b / (y + s) + np.arctan2(s, b))

        return plain_quad(lambda y: slope(y) * abel_kernel(x)(y), x, A) / pi

    with mp.workdps(20):
        truth = [exact(mpf(float(x))) for x in r]
    return curve(
        "tip-rounded-cone",
        "pressure of a cone rounded over 10⁻⁶ a, near the axis",
        LABEL,
        "∫ g′/√(x²−r²) dx by quad without break point",
        r,
        (fields.pressure(normal_contact(profile), r), attempt(naive, r), truth),
        1e-12,
    )


CURVES = {
    "cone's pressure": cone_pressure,
    "cone's traction": cone_traction,
    "power 0.5": partial(power_pressure, 0.5),
    "power 1.5": partial(power_pressure, 1.5),
    "rounded cone": rounded_cone,
}


@pytest.mark.every(2)
@pytest.mark.parametrize("name", CURVES)
def test_near_the_tip(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-11)


def test_on_the_axis() -> None:
    """The limit at r = 0, infinite where it diverges."""
    assert np.isposinf(fields.pressure(normal_contact(Cone(SLOPE)), [0.0]))[0]
    assert np.isposinf(fields.pressure(normal_contact(Power(1.0, 0.5)), [0.0]))[0]
    contact = tangential.solve(normal_contact(Cone(SLOPE)), 1.0, 1.0, stick_radius=0.5)
    assert fields.shear_stress(contact, [0.0])[0] == pytest.approx(
        SLOPE / 2 * np.log(2.0), rel=1e-14, abs=0
    )
