"""Depth and force of a body of the tables are integrals of its slope."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from tests.oracles.bodies import BODIES, B, Body
from tests.oracles.reference import QUAD_DIGITS, quad_force, quad_g

#: Digits that depth and force keep from `bodies.DIGITS`.
PROOF = mpf(10) ** -20
every_body = pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)


def radii(body: Body) -> list[mpf]:
    return [mpf(body.end) * part for part in (mpf("0.41"), mpf("0.7"), mpf("0.95"))]


@every_body
def test_slope_is_that_of_the_heights(body: Body) -> None:
    with mp.workdps(QUAD_DIGITS):
        for part in body.parts:
            for r in radii(body):
                assert abs(mp.diff(part.f, r) / part.df(r) - 1) < PROOF


@pytest.mark.every(5)
@every_body
def test_depth_and_force_are_integrals_of_the_slope(body: Body) -> None:
    with mp.workdps(QUAD_DIGITS):
        for part in body.parts:
            for a in radii(body):
                assert abs(part.g(a) / quad_g(part, a) - 1) < PROOF
                assert abs(part.force(a) / quad_force(part, a) - 1) < PROOF
                assert abs(mp.diff(part.g, a) / part.dg(a) - 1) < mpf(10) ** -12
                assert abs(mp.diff(part.force, a) / (2 * a * part.dg(a)) - 1) < mpf(10) ** -12


def test_closed_forms_of_quadratures() -> None:
    """log(1 + r²): g = 2x asinh(x)/√(1+x²); 1 − exp(−r²): g = 2x D(x), Dawson's integral."""
    a = mpf("0.55")
    with mp.workdps(QUAD_DIGITS):
        logarithm, gaussian = (BODIES[name].parts[0] for name in ("logarithm", "gaussian"))
        root = mp.hypot(1, a)
        depth = 2 * a * mp.asinh(a) / root
        assert abs(logarithm.g(a) / depth - 1) < PROOF
        force = 2 * a * depth - 4 * (root * mp.asinh(a) - a)
        assert abs(logarithm.force(a) / force - 1) < PROOF
        dawson = mp.sqrt(mp.pi) / 2 * mp.exp(-a * a) * mp.erfi(a)
        assert abs(gaussian.g(a) / (2 * a * dawson) - 1) < PROOF
        assert abs(gaussian.force(a) / (4 * a * a * dawson - 2 * a + 2 * dawson) - 1) < PROOF


def test_pressure_of_a_sum_carries_its_force() -> None:
    """2π ∫ p r dr on either side of the slope jump: Gauss's rule leaves 1e-4 at its logarithms."""
    body, a = BODIES["double cone"], 0.55
    nodes, weights = np.polynomial.legendre.leggauss(24)
    carried = 0.0
    for low, high in ((0.0, B), (B, a)):
        r = (high + low + (high - low) * nodes) / 2
        carried += (high - low) / 2 * weights @ [body.pressure(x, a) * x for x in r]
    assert 2 * np.pi * carried == pytest.approx(body.force(a), rel=1e-3, abs=0)


@every_body
def test_radius_is_the_inverse(body: Body) -> None:
    a = 0.6 * body.end
    assert body.radius("g", body.depth(a)) == pytest.approx(a, rel=1e-14, abs=0)
    assert body.radius("force", body.force(a)) == pytest.approx(a, rel=1e-14, abs=0)
