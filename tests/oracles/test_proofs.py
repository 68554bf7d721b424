"""Closed forms of the reference equal the quadrature of f', at and beside breaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mpmath import mp, mpf

from tests.oracles.cases import FAMILIES, Profile
from tests.oracles.reference import (
    QUAD_DIGITS,
    elasticities,
    energy,
    integral,
    pressure,
    quad_dg,
    quad_force,
    quad_g,
)
from tests.oracles.shapes import KINDS, Shape, shape_of

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.long

PROOF = mpf(10) ** -35
#: Points in units of the break, or of the shape's size if it has none.
AROUND = (0.01, 0.4, 1 - 1e-6, 1 + 1e-6, 1.07, 2.5, 1e3)
SMOOTH = (1e-4, 0.4, 0.93)
#: One family of each kind, and the powers that are hardest for the substitution.
CHOSEN = (
    "hertz", "cone0.3", "sphere", "ellipsoid-flat", "power0.2", "power0.5", "power1.5", "power7.3",
    "power60", "series-4", "series-negative", "rounded-punch", "truncated-cone",
    "truncated-paraboloid", "rounded-cone0.3", "spherical-tip-cone1", "hyperboloid0.4",
    "capped-paraboloid-blunted", "capped-paraboloid-same",
)  # fmt: skip


#: A kind without a bank: a ball on a larger one, and in a socket.
SPHERES: dict[str, Profile] = {
    "two-spheres": {"kind": "two_spheres", "radii": [1.0, 3.0]},
    "ball-in-socket": {"kind": "two_spheres", "radii": [1.0, -1.03]},
}


def chosen_profiles() -> dict[str, Profile]:
    return {family.name: family.make(1.0) for family in FAMILIES if family.name in CHOSEN} | SPHERES


PROFILES = chosen_profiles()
CHOSEN = (*CHOSEN, *SPHERES)


def points(shape: Shape) -> Iterator[mpf]:
    if shape.b > 0:
        yield from (shape.b * ratio for ratio in AROUND if not shape.blunt or ratio > 1)
    else:
        size = shape.limit if mp.isfinite(shape.limit) else mpf(1)
        yield from (size * ratio for ratio in SMOOTH)


def same(left: mpf, right: mpf) -> bool:
    return bool(abs(left - right) <= PROOF * abs(right))


def test_every_kind_has_proofs() -> None:
    # The flat punch has no transform: F_N = 2 E* a d by definition.
    assert {p["kind"] for p in PROFILES.values()} == set(KINDS) - {"flat_punch"}


@pytest.mark.parametrize("name", CHOSEN)
def test_slope_is_the_derivative_of_the_shape(name: str) -> None:
    with mp.workdps(QUAD_DIGITS + 10):
        shape = shape_of(PROFILES[name])
        for x in points(shape):
            assert same(mp.diff(shape.f, x), shape.df(x))


@pytest.mark.parametrize("name", CHOSEN)
def test_equivalent_profile_is_the_transform_of_the_shape(name: str) -> None:
    with mp.workdps(QUAD_DIGITS + 10):
        shape = shape_of(PROFILES[name])
        for x in points(shape):
            assert same(shape.g(x), quad_g(shape, x))
            assert same(shape.dg(x), quad_dg(shape, x))


@pytest.mark.parametrize("name", CHOSEN)
def test_force_is_the_integral_of_the_slope(name: str) -> None:
    with mp.workdps(QUAD_DIGITS + 10):
        shape = shape_of(PROFILES[name])
        for a in points(shape):
            assert same(shape.force(a), quad_force(shape, a))


@pytest.mark.parametrize("name", CHOSEN)
def test_energy_is_the_work_of_the_force(name: str) -> None:
    with mp.workdps(QUAD_DIGITS):
        shape = shape_of(PROFILES[name])
        a = list(points(shape))[-2]

        def work(x: mpf) -> mpf:
            return shape.force(x) * shape.dg(x)

        def work_beyond(s: mpf) -> mpf:
            x = mp.sqrt(shape.b**2 + s**2)
            return shape.outer_force(x, s) * shape.outer_dg(x, s) * s / x

        below = mpf(0) if shape.blunt else integral(work, [mpf(0), min(shape.b or a, a)])
        above = integral(work_beyond, [mpf(0), shape.beyond(a)]) if shape.b else mpf(0)
        total = below + above
        assert abs(total - energy(shape, a)) < mpf(10) ** -30 * total


@pytest.mark.parametrize("name", CHOSEN)
def test_condition_numbers_are_logarithmic_derivatives(name: str) -> None:
    with mp.workdps(QUAD_DIGITS):
        shape = shape_of(PROFILES[name])
        a = list(points(shape))[-2]
        rates = elasticities(shape, a, None, energy(shape, a))

        def rate(fn: object) -> mpf:
            return mp.diff(lambda w: mp.log(fn(mp.exp(w))), mp.log(a))

        assert mp.almosteq(rates["indentation_depth"], rate(shape.g), mpf(10) ** -15)
        assert mp.almosteq(rates["normal_force"], rate(shape.force), mpf(10) ** -15)
        narrow = mpf(10) ** -12
        work = (energy(shape, a * (1 + narrow)) - energy(shape, a)) / (narrow * energy(shape, a))
        assert mp.almosteq(rates["elastic_energy"], work, mpf(10) ** -9)


@pytest.mark.parametrize("name", CHOSEN)
def test_pressure_is_the_singular_integral_of_the_equivalent_profile(name: str) -> None:
    """The integral without the substitution in s, split at the break, with twice the digits."""
    with mp.workdps(100):
        shape = shape_of(PROFILES[name])
        a = shape.b * 2 if shape.b > 0 else mpf("0.5")
        for r in (a / 4, a * mpf("0.8")):
            knots = [r, shape.b, a] if r < shape.b < a else [r, a]
            direct = mp.quad(lambda x, r=r: shape.dg(x) / mp.sqrt((x - r) * (x + r)), knots)
            with mp.workdps(QUAD_DIGITS):
                value = pressure(shape, r, a)
            assert abs(direct / mp.pi - value) < mpf(10) ** -30 * value
