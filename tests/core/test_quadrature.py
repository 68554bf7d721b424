"""Stress integrals would miss their tolerance, or a looser one would cost more."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import quadrature
from mdr_core.fields import pressure
from mdr_core.normal import solve
from mdr_core.profiles import Hyperboloid, RoundedPunch, Sphere, TruncatedCone
from mdr_core.quadrature import integrate

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

LENGTHS = (0.05, 0.2, 0.7, 1.5, 3.0, 6.0, 11.0, 20.0)
DECADES = tuple(10.0**-k for k in range(3, 14))
#: Rounding error of a sum of about fifty positive terms.
ROUNDING = 1e-14

# Integrands with poles or branch points on the boundary of the strip, and their growth. Each is
# written once for arrays and mpmath.
FAMILY = {
    "sech": (lambda m, y: 1 / m.cosh(y), 2.0, True),
    "sech at 1": (lambda m, y: 1 / m.cosh(y - 1), 2.0, False),
    "sech at -4": (lambda m, y: 1 / m.cosh(y + 4), 2.0, False),
    "exp(2y) sech": (lambda m, y: m.exp(2 * y) / m.cosh(y), 2.0, False),
    "cosh^2": (lambda m, y: m.cosh(y) ** 2, 2.0, True),
    "cosh^2 + sech": (lambda m, y: m.cosh(y) ** 2 + 1 / m.cosh(y), 2.0, True),
    "y tanh": (lambda m, y: y * m.tanh(y), 2.0, True),
    "root": (lambda m, y: m.sqrt(m.cosh(y)), 2.0, True),
    "two roots": (lambda m, y: m.sinh(y) ** 2 / m.sqrt(1.2 + m.sinh(y) ** 2), 2.0, True),
    "cosh^6": (lambda m, y: m.cosh(y) ** 6, 6.0, True),
}


@cache
def exact(name: str, low: float, high: float) -> mpf:
    fn = FAMILY[name][0]
    with mp.workdps(30):
        # Subpanels a tenth of the strip's width are resolved safely.
        count = max(int((high - low) / 0.8), 1)
        ends = [mpf(low) + (mpf(high) - mpf(low)) * i / count for i in range(count + 1)]
        return mp.quad(lambda y: fn(mp, y), ends, method="gauss-legendre")


def relative_error(value: float, truth: mpf) -> float:
    return float(abs(mpf(value) / truth - 1))


@pytest.mark.parametrize("rtol", DECADES)
@pytest.mark.parametrize("name", [name for name, (_, _, even) in FAMILY.items() if even])
def test_even_integrals_meet_the_tolerance(name: str, rtol: float) -> None:
    fn, growth, _ = FAMILY[name]
    upper = np.array(LENGTHS)
    result = integrate(lambda y, _: fn(np, y), upper, rtol, growth=growth)
    errors = [relative_error(v, exact(name, 0.0, u)) for v, u in zip(result, LENGTHS, strict=True)]
    assert max(errors) <= rtol + ROUNDING


@pytest.mark.parametrize("rtol", DECADES)
@pytest.mark.parametrize("name", FAMILY)
def test_plain_integrals_meet_the_tolerance(name: str, rtol: float) -> None:
    fn, growth, _ = FAMILY[name]
    ends = [(low, low + length) for low in (0.0, 0.3, 2.0) for length in (1e-9, *LENGTHS)]
    lower, length = np.array(ends).T[0], np.array([high - low for low, high in ends])
    result = integrate(lambda y, _: fn(np, y), length, rtol, lower, growth=growth)
    for value, (low, high) in zip(result, ends, strict=True):
        assert relative_error(value, exact(name, low, high)) <= rtol + ROUNDING, (low, high)


@pytest.mark.parametrize("rtol", DECADES)
def test_double_zero_at_or_next_to_the_interval(rtol: float) -> None:
    """sinh^2 y/cosh y, whose integral is sinh y - arctan(sinh y): small throughout the interval."""

    def h(y: Array, _: object) -> Array:
        return np.sinh(y) ** 2 / np.cosh(y)

    def truth(y: float) -> mpf:
        return mp.sinh(y) - mp.atan(mp.sinh(y))

    lengths = np.geomspace(1e-4, 3.0, 40)
    with mp.workdps(50):
        for low in (0.0, 1e-4, 3e-3, 0.05, 0.4):
            result = integrate(h, lengths, rtol, np.full(40, low))
            for value, length in zip(result, lengths.tolist(), strict=True):
                exact_ = truth(mpf(low) + mpf(length)) - truth(mpf(low))
                assert relative_error(value, exact_) <= rtol + ROUNDING, (low, length)
        even = integrate(h, lengths, rtol)
        for value, length in zip(even, lengths.tolist(), strict=True):
            assert relative_error(value, truth(mpf(length))) <= rtol + ROUNDING, length


def test_vectorized_integrals_keep_their_order() -> None:
    """Each integrand has its own parameter; all rules and several blocks are mixed."""
    upper = np.tile(np.array([0.0, 0.01, 0.5, 2.0, 7.0, 25.0]), 3000)
    scale = np.linspace(1.0, 2.0, upper.size)

    def h(y: Array, index: NDArray[np.intp]) -> Array:
        return scale[index] / np.cosh(y)

    kept = upper.copy()
    result = integrate(h, upper, 1e-13)
    assert np.allclose(result, scale * np.arctan(np.sinh(upper)), rtol=1e-13, atol=0)
    plain = integrate(h, 2 * upper, 1e-13, -upper)
    assert np.allclose(plain, 2 * scale * np.arctan(np.sinh(upper)), rtol=1e-13, atol=0)
    assert np.array_equal(upper, kept)


def evaluations(run: Callable[[], object], monkeypatch: pytest.MonkeyPatch) -> int:
    """Number of integrand values used by a call."""
    count = 0
    original = quadrature._apply

    def counting(h: quadrature.Integrand, *arguments: object) -> Array:
        def counted(y: Array, index: NDArray[np.intp]) -> Array:
            nonlocal count
            count += y.size
            return h(y, index)

        return original(counted, *arguments)

    with monkeypatch.context() as patch:
        patch.setattr(quadrature, "_apply", counting)
        run()
    return count


KERNELS = {
    "rounded punch": (RoundedPunch(0.25, 2.0), 1.0),
    "truncated cone": (TruncatedCone(0.3, 0.2), 1.0),
    "sphere": (Sphere(1.1), 1.0),
    "hyperboloid": (Hyperboloid(0.4, 0.1), 1.0),
}


@pytest.mark.parametrize("name", KERNELS)
def test_looser_tolerance_never_costs_more(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    profile, a = KERNELS[name]
    contact = solve(profile, 1.0, contact_radius=a)
    r = np.linspace(0, a, 300, endpoint=False)
    costs = [
        evaluations(lambda rtol=rtol: pressure(contact, r, rtol=rtol), monkeypatch)
        for rtol in DECADES
    ]
    assert costs == sorted(costs)
    assert 0 < costs[0] < costs[-1]


@pytest.mark.parametrize("name", KERNELS)
def test_normal_query_needs_no_kernel(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    profile, a = KERNELS[name]

    def query() -> None:
        contact = solve(profile, 1.0, contact_radius=a)
        force = float(contact.normal_force)
        again = solve(profile, 1.0, normal_force=force)
        assert float(again.indentation_depth) > 0
        assert float(again.mean_pressure) > 0

    assert evaluations(query, monkeypatch) == 0
