"""Two spheres and a ball in a socket follow the exact gap, at any clearance and in any unit."""

from __future__ import annotations

import random

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import KINDS, fields, layer, normal
from mdr_core.errors import InputError
from mdr_core.materials import Layer, Material
from mdr_core.profiles import Paraboloid, Sphere, TwoSpheres, slope_of_half_angle
from mdr_core.validity import sources_of
from tests.core import random_cases
from tests.core.comparison import profile_from
from tests.oracles.reference import energy
from tests.oracles.shapes import shape_of

PAIRS = [
    (1.0, 1.0),
    (1.0, 1.00002),
    (3.0, 1.0),
    (1.0, 1e9),
    (1.0, -1.0001),
    (1.0, -1 - 1e-8),
    (-1.3, 1.0),
]


@pytest.mark.parametrize("radii", PAIRS)
@pytest.mark.parametrize("a", [1e-9, 1e-4, 0.1, 0.44, 0.8, 0.849, 0.99, 1 - 1e-7])
@pytest.mark.parametrize("unit", [1e-40, 1.0, 1e40])
def test_quantities_of_the_exact_gap(radii: tuple[float, float], a: float, unit: float) -> None:
    if min(radii) < 0 and a > 0.85:
        return
    given = {"kind": "two_spheres", "radii": [unit * each for each in radii]}
    contact = normal.solve(profile_from(given), 1.0, contact_radius=unit * a)
    with mp.workdps(60):
        shape, edge = shape_of(given), mpf(unit * a)
        expected = {
            "indentation_depth": shape.g(edge),
            "normal_force": shape.force(edge),
            "elastic_energy": energy(shape, edge),
        }
        height = float(shape.f(edge))
    for name, value in expected.items():
        assert abs(getattr(contact, name) / float(value) - 1) <= contact.error_estimate, name
    assert contact.profile.f(unit * a) == pytest.approx(height, rel=2e-14, abs=0)
    for name in ("indentation_depth", "normal_force"):
        found = normal.solve(contact.profile, 1.0, **{name: getattr(contact, name)})
        assert abs(found.contact_radius / (unit * a) - 1) <= found.error_estimate


def test_hip_joint() -> None:
    """Closed forms with 30 digits; the paraboloid's contact is larger than the ball."""
    socket = TwoSpheres((14.0, -14.1))
    e_star = 1 / ((1 - 0.3**2) / 210e3 + (1 - 0.45**2) / 1e3)
    contact = normal.solve(socket, e_star, normal_force=2500.0)
    assert contact.contact_radius == pytest.approx(10.468965463235827, rel=1e-13, abs=0)
    assert contact.indentation_depth == pytest.approx(0.12483312171655953, rel=1e-13, abs=0)
    assert fields.pressure(contact, [0.0]) == pytest.approx(7.451488648116944, rel=1e-12, abs=0)
    hertz = normal.solve(Paraboloid(1974.0), e_star, normal_force=2500.0)
    assert hertz.contact_radius > 14


def test_one_sphere_beside_a_flat_is_the_sphere() -> None:
    found, known = (
        normal.solve(profile, 1.0, normal_force=[1e-6, 0.1, 1.0])
        for profile in (TwoSpheres((1.0, 1e40)), Sphere(1.0))
    )
    for name in known.quantities:
        assert getattr(found, name) == pytest.approx(getattr(known, name), rel=1e-12, abs=0), name


@pytest.mark.parametrize("radii", [(1, -1), (1, -0.9), (-1, -2), (0, 1), (1,), (1, np.nan), 3])
def test_no_gap(radii: object) -> None:
    with pytest.raises(InputError, match=r"^radii"):
        TwoSpheres(radii)  # type: ignore[arg-type]


def test_fields_of_random_pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pressure, shear stress, slip and displacement against the reference, c next to a and axis."""

    def pair(draw: random.Random) -> dict[str, object]:
        # The contact has the radius 1, up to 0.85 R in a socket.
        ball = 1.18 + 10 ** draw.uniform(-3, 3)
        other = draw.choice([10 ** draw.uniform(0, 3), -(1 + 10 ** draw.uniform(-6, 1))])
        return {"radii": draw.sample([ball, ball * other], 2)}

    monkeypatch.setattr(random_cases, "PROFILE_GENERATORS", {"two_spheres": pair})
    draw = random.Random(5)
    assert not [
        str(miss) for _ in range(12) for miss in random_cases.misses(random_cases.scene(draw))
    ]


def test_slope_of_a_half_angle() -> None:
    for angle, cot in ((45.0, 1.0), (30.0, 3**0.5), (60.0, 3**-0.5), (89.75, np.tan(np.pi / 720))):
        assert slope_of_half_angle(angle) == pytest.approx(cot, rel=1e-11, abs=0)


def test_sources_of_every_kind_and_result() -> None:
    assert all(sources_of(kind) for kind in KINDS)
    contact = normal.solve(Sphere(1.0), 1.0, normal_force=1e-3)
    assert contact.to_dict()["sources"] == (*sources_of("NormalContact"), *sources_of("sphere"))
    gel = Material(1.0, layer=Layer(0.1, "frictionless"))
    held = layer.solve(Sphere(1.0), gel, normal_force=1e-3, work_of_adhesion=1e-6)
    names = ("AdhesiveContact", "layer", "sphere")
    assert all(sources_of(name) for name in names)
    assert held.sources == sources_of(*names)
