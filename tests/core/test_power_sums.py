"""Series with extreme exponents or cancelling terms are as accurate as their estimates."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from mdr_core import fields, normal, tangential
from mdr_core.elementwise import number
from mdr_core.errors import InputError
from mdr_core.profiles import PowerTerm, Series
from tests.core.evaluations import counted

NEXT = float(np.nextafter(200.0, 0.0))
#: Small, fractional and large exponents together.
MIXED = ((1.0, 0.05), (0.5, 2.0), (0.25, NEXT), (0.25, 200.0))
DIGITS = 60


def series(*terms: tuple[float, float]) -> Series:
    return Series(tuple(PowerTerm(*term) for term in terms))


@pytest.mark.parametrize(
    "terms",
    [
        ((1.0, 0.05), (1.0, float(np.nextafter(0.05, 1.0))), (-1e-3, 2.0)),
        ((1.0, 0.05), (1.0, 37.0), (1.0, NEXT), (-2.0, 200.0)),
        ((5e-324, 0.05), (-5e-324, 2.0)),
        ((1e300, 200.0), (-1e300, 201.0)),
    ],
)
def test_domain_of_a_series(terms: tuple[tuple[float, float], ...]) -> None:
    """Regression: equal exponents after subtracting one, and coefficients that underflow."""
    end = mpmath.log(series(*terms).domain)
    with mpmath.workdps(DIGITS):
        nearest = mpmath.mpf(10) ** -9
        signs = [
            [mpmath.sign(slope(terms, end + away, of_g=of_g)) for of_g in (False, True)]
            for away in (-nearest, nearest)
        ]
    assert min(signs[0]) > 0
    assert min(signs[1]) < 0


def slope(terms: tuple[tuple[float, float], ...], u: mpmath.mpf, *, of_g: bool) -> mpmath.mpf:
    """f' or g' times r at r = exp(u)."""
    return mpmath.fsum(
        mpmath.mpf(c) * n * (kappa(n) if of_g else 1) * mpmath.exp(n * u) for c, n in terms
    )


def kappa(n: float) -> mpmath.mpf:
    half = mpmath.mpf(n) / 2
    return mpmath.sqrt(mpmath.pi) / 2 * n * mpmath.gamma(half) / mpmath.gamma(half + 0.5)


def test_cancelling_terms_are_rejected() -> None:
    with pytest.raises(InputError, match="cancel to zero"):
        series((1.0, 2.0), (-1.0, 2.0))


def test_nearly_equal_exponents_that_fall_are_rejected() -> None:
    with pytest.raises(InputError, match="falls"):
        series((2.8, 1.0), (-2.9, 1 + 1e-15), (0.2, 3.0))


def test_root_below_the_range_of_doubles_is_named() -> None:
    """a = 1e-1000: the inverse ends at zero instead of not converging."""
    with pytest.raises(InputError, match="leaves the range of double precision") as raised:
        normal.solve(series((1.0, 0.05), (1.0, 2.0)), 1.0, indentation_depth=[1.0, 1e-50])
    assert raised.value.path == ("load", "indentation_depth", 1)


def test_nearly_equal_exponents_that_cancel() -> None:
    """The inverse of such a series is dominated by rounding error and once did not converge."""
    terms = ((1.0, 1.0), (-1 + 1e-9, 1 + 1e-12))
    contact = normal.solve(series(*terms), 1.0, indentation_depth=[1e-12, 1e-9, 1e-6])
    with mpmath.workdps(DIGITS):
        for d, a, error in zip(
            contact.indentation_depth,
            contact.contact_radius,
            contact.error_estimates,
            strict=True,
        ):
            edge = mpmath.mpf(float(a))
            exact = mpmath.fsum(kappa(n) * c * edge ** mpmath.mpf(n) for c, n in terms)
            assert abs(d / exact - 1) <= error <= 1e-5


@pytest.mark.parametrize("terms", [((1.0, 0.05),), ((3.0, 1.5), (0.2, 8.0)), MIXED])
def test_slip_moment_of_a_narrow_and_of_a_wide_annulus(
    terms: tuple[tuple[float, float], ...],
) -> None:
    """int_c^a (g(a) - g)(g - g(c)) dx, term by term with 60 digits; notes, §6."""
    a = 0.9
    for ratio in (0.0, 1e-9, 1e-3, 0.5, 0.99, 1 - 1e-5, 1 - 2.0**-40):
        c = a * ratio
        with mpmath.workdps(DIGITS):
            exact = slip_moment(terms, mpmath.mpf(a), mpmath.mpf(c))
        profile, ends = series(*terms), [number(one) for one in (a, a - c, c)]
        result = float(tangential.slip_moment(profile, *ends))
        # A rule in log(x) does not resolve the exponent 200, whose term is 1e-10 of the depth.
        bound = 1e-11 if terms is MIXED else 1e-13
        assert result == pytest.approx(float(exact), rel=bound, abs=0)


def slip_moment(terms: tuple[tuple[float, float], ...], a: mpmath.mpf, c: mpmath.mpf) -> mpmath.mpf:
    y = c / a
    depths = [(kappa(n) * mpmath.mpf(k) * a**n, mpmath.mpf(n)) for k, n in terms]

    def area(n: mpmath.mpf) -> mpmath.mpf:
        return (1 - y ** (n + 1)) / (n + 1)

    return a * mpmath.fsum(
        d * e * (area(m) - area(n + m) - y**m * (1 - y - area(n)))
        for d, n in depths
        for e, m in depths
    )


@pytest.mark.parametrize(
    "exponents", [(2, 4, 6), (10, 11, 12), (100, 101, 102), (199, 199.1, 199.2)]
)
def test_error_of_cancelling_terms(exponents: tuple[float, float, float]) -> None:
    """The flattest increasing cubic: its slope is zero at r = 1."""
    n, m, k = map(mpmath.mpf, exponents)
    with mpmath.workdps(DIGITS):
        # n + m p + k q = 0 and n^2 + m^2 p + k^2 q = 0, with slightly less of the middle term.
        p = float(-n * (k - n) / (m * (k - m)) * (1 - mpmath.mpf(10) ** -6))
        q = float(n * (m - n) / (k * (k - m)))
        terms = list(zip((1.0, p, q), exponents, strict=True))
        profile = series(*terms)
        radii = min(profile.domain, 1.0) * np.linspace(0.5, 1.0, 101)
        exact = [
            mpmath.fsum(kappa(e) * c * mpmath.mpf(r) ** mpmath.mpf(e) for c, e in terms)
            for r in radii
        ]
    contact = normal.solve(profile, 1.0, contact_radius=radii)
    for depth, truth, bound in zip(
        contact.indentation_depth, exact, contact.error_estimates, strict=True
    ):
        assert abs(mpmath.mpf(float(depth)) / truth - 1) <= bound
    assert contact.error_estimate <= 1e-7


@pytest.mark.every(3)
def test_displacement_outside_a_series_of_small_and_large_powers() -> None:
    """The result is exact, and takes no more evaluations than its terms."""
    a, radii = 1.0, np.array([1.0, 1.001, 1.5, 4.0])
    contact = normal.solve(series(*MIXED), 1.0, contact_radius=a)
    with counted() as count:
        result = fields.normal_displacement(contact, radii)
    with mpmath.workdps(30):
        exact = [
            2 / mpmath.pi * mpmath.fsum(c * kappa(n) * outer(n, mpmath.mpf(r)) for c, n in MIXED)
            for r in radii
        ]
    np.testing.assert_allclose(result, [float(value) for value in exact], rtol=1e-10)
    assert count.integrand < 10_000 * radii.size


def outer(n: float, r: mpmath.mpf) -> mpmath.mpf:
    """int_0^1 n x^(n-1) arcsin(x/r) dx by the series of the arcsine."""
    n = mpmath.mpf(n)
    half = mpmath.mpf(1) / 2
    if r == 1:
        # By parts: pi/2 - int x^n/sqrt(1 - x^2) dx.
        return mpmath.pi / 2 - mpmath.beta((n + 1) / 2, half) / 2
    value = mpmath.hyp3f2(half, half, (n + 1) / 2, 3 * half, (n + 3) / 2, 1 / r**2)
    return n / (n + 1) * value / r
