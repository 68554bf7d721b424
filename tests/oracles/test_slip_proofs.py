"""The slip reference has the closed forms of the chapter and equals direct quadrature."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mpmath import mp, mpf

from tests.oracles import slip_reference as reference
from tests.oracles.shapes import KINDS
from tests.oracles.slip_reference import Material, Setting
from tests.oracles.test_proofs import CHOSEN, PROFILES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.oracles.cases import Profile

pytestmark = pytest.mark.long

PROOF = mpf(10) ** -33
#: The direct integrals have endpoint singularities, where tanh-sinh keeps half of its digits.
DIRECT_DIGITS = 100
DIRECT = mpf(10) ** -30
MATERIAL = Material(2.1, 1.7, 0.3)

HERTZ: Profile = {"kind": "paraboloid", "radius": 1.3}
CONE: Profile = {"kind": "cone", "slope": 0.3}


@pytest.fixture(autouse=True)
def _digits() -> Iterator[None]:
    """Work at full precision: literals of a test must not be rounded to fifteen digits."""
    with mp.workdps(reference.WORK_DIGITS):
        yield


def same(left: mpf, right: mpf, bound: mpf = PROOF) -> bool:
    return bool(abs(left - right) <= bound * abs(right))


def setting_of(profile: Profile, radius: float) -> Setting:
    return reference.setting(profile, "contact_radius", radius, MATERIAL)


def chosen(name: str) -> Setting:
    """Return a contact that extends beyond the break of the profile, if it has one."""
    profile = PROFILES[name]
    b = float(reference.ShapeBody(profile).b)
    return setting_of(profile, 1.7 * b if b else 0.5)


def sticks(at: Setting) -> list[mpf]:
    """Return stick radii on both sides of the break, or beyond a flat."""
    b = at.body.b
    ratios = (mpf("1.001"), mpf("1.3")) if at.body.blunt else (mpf("0.4"), mpf("1.3"))
    return [b * ratio for ratio in ratios] if b else [at.a / 10, at.a * mpf("0.9")]


def test_every_kind_has_proofs() -> None:
    assert {PROFILES[name]["kind"] for name in CHOSEN} == set(KINDS) - {"flat_punch"}


@pytest.mark.parametrize("rho", ["1e-14", "1e-6", "0.5", "0.999999999999"])
@pytest.mark.parametrize("profile", [HERTZ, CONE, PROFILES["power0.2"], PROFILES["power60"]])
def test_stick_radius_of_a_power(profile: Profile, rho: str) -> None:
    """Eqs. (5.16), (5.31), (5.32), (5.49), with the increments by expm1."""
    at = setting_of(profile, 0.7)
    with mp.workdps(60):
        n = at.body.shape.equivalent_terms[0][1]
        power = mp.log1p(-mpf(rho)) / (n + 1)
    force = mpf(rho) * at.mu * at.e_star * at.n
    result = reference.values(at, reference.stick_radius(at, "tangential_force", force))
    with mp.workdps(60):
        assert same(result["stick_radius"], at.a * mp.exp(power))
        assert same(result["slip_width"], -at.a * mp.expm1(power))
        most = (n + 1) * at.mu * at.e_star * at.n / (2 * n * at.g_star * at.a)
        assert same(result["tangential_displacement"], -most * mp.expm1(n * power))


@pytest.mark.parametrize("name", CHOSEN)
@pytest.mark.parametrize("rho", ["1e-14", "0.3", "0.999999"])
def test_controls_agree(name: str, rho: str) -> None:
    at = chosen(name)
    with mp.workdps(reference.WORK_DIGITS):
        force = mpf(rho) * at.mu * at.e_star * at.n
        c = reference.stick_radius(at, "tangential_force", force)
        moved = reference.values(at, c, energy=False)["tangential_displacement"]
        again = reference.stick_radius(at, "tangential_displacement", moved)
        assert same(at.a - again, at.a - c)


@pytest.mark.parametrize("name", CHOSEN)
def test_energy_equals_direct_quadrature(name: str) -> None:
    at = chosen(name)
    for c in sticks(at):
        with mp.workdps(50):
            body, base = at.body, at.body.g(c)
            knots = [c, body.b, at.a] if c < body.b else [c, at.a]
            plain = mp.quad(lambda x: (at.depth - body.g(x)) * (body.g(x) - base), knots)  # noqa: B023 -- used up
            assert same(reference.overlap(at, c), plain, DIRECT)


@pytest.mark.parametrize("name", ["power0.2", "power60", "series-4"])
def test_energy_of_monomials_is_free_of_cancellation(name: str) -> None:
    at = setting_of(PROFILES[name], 0.5)
    for c in (at.a * (1 - mpf(10) ** -16), at.a / 1000):
        result = reference.overlap(at, c)
        with mp.workdps(reference.WORK_DIGITS):
            base, width = at.body.g(c), at.a - c

            def density(u: mpf) -> mpf:
                g = at.body.g(c + width * u)  # noqa: B023 -- used up within the round
                return (at.depth - g) * (g - base) / at.depth**2  # noqa: B023 -- as above

            plain = width * at.depth**2 * at.body.integrate(density, mpf(0), mpf(1))
            assert same(result, plain)


@pytest.mark.parametrize("name", CHOSEN)
def test_gradients_are_the_derivatives(name: str) -> None:
    at = chosen(name)
    c = sticks(at)[1]
    exact = reference.gradients(at, c)
    step = mpf(10) ** -12
    with mp.workdps(60):
        a = at.a * (1 + step)
        wider = Setting(
            at.body, a, at.body.g(a), at.body.force(a), at.e_star, at.g_star, at.mu, mpf(1), a
        )
        base, inner, outer = (
            reference.values(*pair) for pair in ((at, c), (at, c * (1 + step)), (wider, c))
        )
        for name_, (to_a, to_c) in exact.items():
            for moved, rate, size in ((outer, to_a, at.a), (inner, to_c, c)):
                slope = (moved[name_] - base[name_]) / (size * step)
                assert abs(slope - rate) <= mpf(10) ** -7 * abs(rate), name_


@pytest.mark.parametrize("name", CHOSEN)
def test_traction_equals_direct_quadrature(name: str) -> None:
    at = chosen(name)
    for c in sticks(at):
        for r in (c / 3, (c + at.a) / 2):
            with mp.workdps(DIRECT_DIGITS):
                low, b = max(r, c), at.body.b
                knots = [low, b, at.a] if low < b < at.a else [low, at.a]
                plain = mp.quad(lambda x, r=r: at.body.dg(x) / mp.sqrt((x - r) * (x + r)), knots)
                plain *= at.e_star / mp.pi
                assert same(reference.traction(at, c, r), plain, DIRECT)


@pytest.mark.parametrize("name", CHOSEN)
def test_slip_equals_direct_quadrature(name: str) -> None:
    at = chosen(name)
    for c in sticks(at):
        r = (c + 2 * at.a) / 3
        with mp.workdps(DIRECT_DIGITS):
            base, b = at.body.g(c), at.body.b
            knots = [c, b, r] if c < b < r else [c, r]
            plain = mp.quad(
                lambda x, r=r, base=base: (at.body.g(x) - base) / mp.sqrt((r - x) * (r + x)), knots
            )
            assert same(reference.slip(at, c, r), -at.shift * 2 / mp.pi * plain, DIRECT)


@pytest.mark.parametrize("name", CHOSEN)
def test_slip_with_zero_stick_radius_is_the_shape(name: str) -> None:
    """For c = 0 the inverse transform of g is f (Eq. 5.75)."""
    at = chosen(name)
    r = at.a * mpf("0.9")
    with mp.workdps(50):
        assert same(reference.slip(at, mpf(0), r), -at.shift * at.body.f(r))


@pytest.mark.parametrize("name", CHOSEN)
def test_displacement_outside_equals_direct_quadrature(name: str) -> None:
    at = chosen(name)
    for r in (at.a * mpf("1.1"), at.a * 50):
        with mp.workdps(DIRECT_DIGITS):
            b = at.body.b
            knots = [mpf(0), b, at.a] if b else [mpf(0), at.a]
            plain = mp.quad(lambda x, r=r: at.body.dg(x) * mp.asin(x / r), knots) * 2 / mp.pi
            assert same(reference.displacement(at, r), plain, DIRECT)
        far = reference.displacement(at, at.a * mpf(10) ** 20)
        assert same(far, at.n / (mp.pi * at.a * mpf(10) ** 20), DIRECT)
