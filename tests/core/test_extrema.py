"""The largest pressure and shear stress of a contact."""

from math import inf, pi
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core.profiles import (
    Cone,
    FlatPunch,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    Tabulated,
)
from tests.core.comparison import profile_from
from tests.oracles import reference
from tests.oracles.shapes import Shape, shape_of

E_STAR, G_STAR, MU = 2.0, 1.7, 0.4


def test_under_a_paraboloid_it_is_that_of_hertz() -> None:
    R, force = 3.0, np.array([1e-6, 1e-3, 1.0])
    contact = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    # johnson, Eq. (4.24).
    expected = (6 * force * E_STAR**2 / (pi**3 * R**2)) ** (1 / 3)
    assert contact.maximum_pressure == pytest.approx(expected, rel=1e-14, abs=0)


@pytest.mark.parametrize("part", [0.0, 1e-9, 0.5, 0.999, 1.0])
def test_under_a_paraboloid_the_shear_is_largest_at_the_stick_edge(part: float) -> None:
    contact = normal.solve(Paraboloid(3.0), E_STAR, normal_force=1.0)
    pushed = tangential.solve(contact, G_STAR, MU, tangential_force=-part * MU * 1.0)
    # Eq. (5.16) in Eq. (5.38): 1 - (c/a)^2 with all its digits.
    with mp.workdps(40):
        leg = mp.sqrt(1 - (1 - mpf(part)) ** (mpf(2) / 3))
    expected = MU * float(contact.maximum_pressure) * float(leg)
    assert float(pushed.maximum_shear_stress) == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    "profile",
    [Sphere(1.0), Power(0.3, 6.0), RoundedPunch(0.3, 1.0), RoundedPunch(0.499, 10.0)],
    ids=lambda profile: profile.kind,
)
def test_no_radius_has_more(profile: Profile) -> None:
    contact = normal.solve(profile, E_STAR, contact_radius=0.5)
    pushed = tangential.solve(contact, G_STAR, MU, stick_radius=0.4995)
    edge = 0.5 * (1 - np.geomspace(1e-9, 1.0, 20_001))
    radii = np.concatenate([edge, 0.499 + 0.001 * np.linspace(0, 1, 20_001), [0.4995]])
    for largest, field in (
        (contact.maximum_pressure, fields.pressure(contact, radii)),
        (pushed.maximum_shear_stress, fields.shear_stress(pushed, radii)),
    ):
        assert float(largest) >= field.max() * (1 - 1e-12)
        # So dense, the radii come as near to any smooth top as this.
        assert float(largest) == pytest.approx(field.max(), rel=1e-6, abs=0)


#: Peaks on the axis, at the contact's edge, behind a flat and around a tangent point.
PEAKS = [
    ({"kind": "sphere", "radius": 1.0}, 0.3),
    ({"kind": "sphere", "radius": 1.0}, 0.95),
    ({"kind": "sphere", "radius": 1.0}, 1 - 2.0**-20),
    ({"kind": "ellipsoid", "radius": 1.0, "height": 3.0}, 0.999),
    ({"kind": "power", "coefficient": 1.0, "exponent": 1.3}, 0.5),
    ({"kind": "power", "coefficient": 1.0, "exponent": 2.01}, 0.5),
    ({"kind": "power", "coefficient": 1.0, "exponent": 100.0}, 0.5),
    ({"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 1.0}, 0.5001),
    ({"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 1.0}, 50.0),
    ({"kind": "rounded_cone", "slope": 0.2, "tip_radius": 1.0}, 0.7),
    ({"kind": "spherical_tip_cone", "slope": 3.0, "tip_radius": 1.0}, 1.7),
    ({"kind": "hyperboloid", "slope": 0.2, "tip_radius": 1.0}, 0.7),
]


def highest(shape: Shape, a: float, near: float, spacing: float) -> mpf:
    """The top of the reference pressure over E* next to a radius, by repeated parabolas."""

    def pressure(r: mpf) -> mpf:
        return reference.pressure(shape, r, mpf(a))

    with mp.workdps(40):
        r, step = mpf(near), mpf(spacing) / 8
        if near == 0:
            return pressure(r)
        for _ in range(6):
            low, mid, high = pressure(r - step), pressure(r), pressure(r + step)
            r += step * (high - low) / (2 * (2 * mid - low - high))
            step /= 16
        return pressure(r)


@pytest.mark.parametrize(("fields_of", "a"), PEAKS)
def test_the_largest_pressure_against_mpmath(fields_of: dict[str, Any], a: float) -> None:
    contact = normal.solve(profile_from(fields_of), E_STAR, contact_radius=a)
    radii = np.sort(
        np.append(np.linspace(0, a, 1001)[:-1], a * (1 - np.geomspace(1e-9, 0.1, 1000)))
    )
    place = int(np.argmax(fields.pressure(contact, radii, rtol=1e-13)))
    spacing = float(radii[place] - radii[place - 1])
    expected = E_STAR * highest(shape_of(fields_of), a, float(radii[place]), spacing)
    error = abs(mpf(float(contact.maximum_pressure)) / expected - 1)
    assert error <= contact.error_estimate


@pytest.mark.parametrize("seed", range(6))
def test_no_radius_of_a_noisy_table_has_more(seed: int) -> None:
    rng = np.random.default_rng(seed)
    r = np.linspace(0, 1, 40)
    height = (np.sqrt(1 + r * r) - 1) * (1 + 1e-4 * rng.standard_normal(40))
    contact = normal.solve(Tabulated(r, height, "pchip"), E_STAR, contact_radius=0.8)
    steps = np.outer([-1, 1], np.geomspace(1e-9, 1e-2, 12)).ravel()
    near = np.add.outer(r[r < 0.8], steps).ravel()
    radii = np.append(near[(near >= 0) & (near < 0.8)], np.linspace(0, 0.8, 5001)[:-1])
    assert float(contact.maximum_pressure) >= fields.pressure(contact, radii).max() * (1 - 1e-10)


@pytest.mark.parametrize("profile", [Sphere(1.0), RoundedPunch(0.3, 1.0)], ids=lambda p: p.kind)
def test_each_of_many_loads_has_the_peak_that_it_has_alone(profile: Profile) -> None:
    radii = np.linspace(0.31, 0.99, 30)
    together = normal.solve(profile, E_STAR, contact_radius=radii).maximum_pressure
    alone = [float(normal.solve(profile, E_STAR, contact_radius=a).maximum_pressure) for a in radii]
    # The nodes of many loads are summed in another order.
    assert together.tolist() == pytest.approx(alone, rel=2e-15, abs=0)


def test_each_profile_of_a_sweep_has_its_own_peak() -> None:
    b, a = np.array([0.1, 0.5]), np.array([0.7, 0.6])
    swept = normal.solve(RoundedPunch(b, 1.0), E_STAR, contact_radius=a).maximum_pressure
    for i in range(2):
        alone = normal.solve(RoundedPunch(float(b[i]), 1.0), E_STAR, contact_radius=a[i])
        assert swept[i] == pytest.approx(float(alone.maximum_pressure), rel=2e-15, abs=0)


def test_a_table_of_a_paraboloid_has_the_pressure_of_one() -> None:
    r = np.linspace(0.0, 1.0, 9)
    contact = normal.solve(Tabulated(r, r * r / 2), E_STAR, contact_radius=0.6)
    assert float(contact.maximum_pressure) == pytest.approx(2 * E_STAR * 0.6 / pi, rel=1e-9, abs=0)


def test_tips_and_edges_have_no_largest_pressure() -> None:
    for profile in (Cone(0.1), FlatPunch(1.0)):
        contact = normal.solve(profile, E_STAR, indentation_depth=[0.0, 0.1])
        assert contact.maximum_pressure.tolist() == [0.0, inf]


def test_the_shear_is_endless_where_slip_reaches_what_is_sharp() -> None:
    contact = normal.solve(Cone(0.1), E_STAR, contact_radius=1.0)
    pushed = tangential.solve(contact, G_STAR, MU, stick_radius=[0.5, 0.0])
    stress = pushed.maximum_shear_stress
    # Eq. (5.53) at the stick edge: (mu E* t/2) arccosh(a/c).
    assert stress[0] == pytest.approx(MU * E_STAR * 0.05 * np.arccosh(2.0), rel=1e-12, abs=0)
    assert stress[1] == inf
    flat = normal.solve(FlatPunch(1.0), E_STAR, normal_force=1.0)
    for force, expected in ((0.0, 0.0), (0.1, inf)):
        pushed = tangential.solve(flat, G_STAR, MU, tangential_force=force)
        assert float(pushed.maximum_shear_stress) == expected


def test_a_sweep_of_paraboloids_says_what_each_says() -> None:
    R, force = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.2, 0.3])
    swept = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    pushed = tangential.solve(swept, G_STAR, MU, tangential_force=force * MU / 2)
    for i in range(3):
        alone = normal.solve(Paraboloid(float(R[i])), E_STAR, normal_force=float(force[i]))
        sideways = tangential.solve(alone, G_STAR, MU, tangential_force=float(force[i] * MU / 2))
        assert swept.maximum_pressure[i] == alone.maximum_pressure
        assert pushed.maximum_shear_stress[i] == sideways.maximum_shear_stress
