"""The wear reference obeys the book's equations and equals direct quadrature."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mpmath import mp, mpf

from tests.oracles import wear_reference as reference
from tests.oracles.shapes import KINDS
from tests.oracles.slip_reference import WORK_DIGITS, Material
from tests.oracles.test_proofs import CHOSEN, PROFILES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.oracles.wear_reference import Limit

pytestmark = pytest.mark.long

PROOF = mpf(10) ** -33
#: The direct integrals have endpoint singularities, where tanh-sinh keeps half of its digits.
DIRECT = mpf(10) ** -30
MATERIAL = Material(2.1, 1.7, 0.3)
# A flat punch has no worn annulus. The reference of two spheres has no expansion at the axis.
LEFT_OUT = {"flat_punch", "two_spheres"}
SOME = [name for name in CHOSEN if PROFILES[name]["kind"] not in LEFT_OUT]
DEPTH, DISPLACEMENT = "indentation_depth", "tangential_displacement"


@pytest.fixture(autouse=True)
def _digits() -> Iterator[None]:
    """Literals of a test must not be rounded to fifteen digits."""
    with mp.workdps(WORK_DIGITS):
        yield


def same(left: mpf, right: mpf, bound: mpf = PROOF) -> bool:
    return bool(abs(left - right) <= bound * abs(right))


def chosen(name: str) -> Limit:
    """Half of the depth remains at the stick edge; the contact extends beyond any break."""
    profile = PROFILES[name]
    at = reference.setting(profile, "contact_radius", 1.0, MATERIAL)
    b = at.body.b
    if b:
        at = reference.setting(profile, "contact_radius", float(b * mpf("1.4")), MATERIAL)
    depth = float(at.depth)
    amplitude = mpf(float(at.shift * at.depth / 2))
    return reference.solve(profile, DEPTH, mpf(depth), MATERIAL, DISPLACEMENT, amplitude)


def test_every_kind_has_proofs() -> None:
    assert {PROFILES[name]["kind"] for name in SOME} == set(KINDS) - LEFT_OUT


@pytest.mark.parametrize("name", SOME)
def test_equation_5_83(name: str) -> None:
    """f = (2/pi) int_0^c g/sqrt(r^2 - x^2) dx + (2/pi) d arccos(c/r) in the worn annulus."""
    limit = chosen(name)
    body, c = limit.at.body, limit.c
    for part in (mpf("0.1"), mpf("0.7")):
        r = c + limit.width * part
        inside = mpf(0)
        for panel in body.panels(body.b if body.blunt else mpf(0), c):
            inside += body.integrate(
                lambda s, panel=panel, r=r: (
                    panel.equivalent_profile(s) * panel.ratio(s) / mp.sqrt(r**2 - panel.x(s) ** 2)
                ),
                panel.s(panel.low),
                panel.s(panel.high),
            )
        book = 2 / mp.pi * (inside + limit.depth * mp.acos(c / r))
        assert same(reference.field(limit, "limiting_profile", r), book, DIRECT)


@pytest.mark.parametrize("name", SOME)
def test_worn_profile_meets_the_initial_one_by_equation_5_88(name: str) -> None:
    limit = chosen(name)
    edge = limit.c + limit.width
    near = limit.width * mpf(10) ** -30
    before = reference.worn_depth(limit, edge - near)
    assert 0 < before < limit.step * mpf(10) ** -28
    # Bracket of the root: beyond the contact edge, where f is still below the depth.
    assert limit.at.a < edge
    assert limit.at.body.f(edge) < limit.depth


@pytest.mark.parametrize("name", ["paraboloid", "cone", "rounded_punch"])
def test_worn_volume_is_the_integral_of_the_worn_depth(name: str) -> None:
    chosen_name = next(n for n in SOME if PROFILES[n]["kind"] == name)
    limit = chosen(chosen_name)
    c, width = limit.c, limit.width
    with mp.workdps(25):
        # r = c + width u^2: the worn depth starts linearly in u.
        total = mp.quad(
            lambda u: (
                reference.worn_depth(limit, c + width * u**2) * (c + width * u**2) * 2 * width * u
            ),
            [0, 1],
        )
    volume = reference.answers(limit)["worn_volume"]
    assert same(2 * mp.pi * total, volume, mpf(10) ** -20)


def test_equation_5_85() -> None:
    profile = {"kind": "paraboloid", "radius": 1.3}
    limit = reference.solve(profile, DEPTH, mpf(0.4), MATERIAL, DISPLACEMENT, mpf(0.05))
    c, d, R = limit.c, limit.depth, mpf(1.3)
    assert same(c, mp.sqrt(R * (d - mpf(0.05) / limit.at.shift)))
    for part in (mpf("0.01"), mpf("0.5"), mpf("0.99")):
        r = c + limit.width * part
        f = d - 2 / mp.pi * (d - r**2 / (2 * R)) * mp.asin(c / r)
        f -= c * r / (mp.pi * R) * mp.sqrt(1 - c**2 / r**2)
        assert same(reference.field(limit, "limiting_profile", r), f)


def test_equation_5_90() -> None:
    profile = {"kind": "paraboloid", "radius": 1.3}
    force = mpf(0.2)
    limit = reference.solve(profile, "normal_force", force, MATERIAL, DISPLACEMENT, mpf(0.05))
    d, w = limit.depth, limit.step
    book = mpf(4) / 3 * limit.at.e_star * mp.sqrt(mpf(1.3)) * mp.sqrt(d - w) * (d + w / 2)
    assert same(book, force)


def test_largest_stick_zone_at_constant_depth_and_force() -> None:
    """c (d - g(c)) = F_x/(2 mu E*) is a cubic for the paraboloid; the limit is its middle root."""
    profile = {"kind": "paraboloid", "radius": 1.3}
    force, d = mpf(0.05), mpf(0.4)
    limit = reference.solve(profile, DEPTH, d, MATERIAL, "tangential_force", force)
    share = force / (2 * limit.at.mu * limit.at.e_star)
    roots = mp.polyroots([1 / mpf(1.3), 0, -d, share], maxsteps=500, extraprec=400, asc=False)
    assert same(limit.c, max(mp.re(root) for root in roots))
