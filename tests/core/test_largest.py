"""The largest pressure and shear stress of a contact."""

from math import inf, pi

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

E_STAR, G_STAR, MU = 2.0, 1.7, 0.4


def test_under_a_paraboloid_it_is_that_of_hertz() -> None:
    R, force = 3.0, np.array([1e-6, 1e-3, 1.0])
    contact = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    # johnson, Eq. (4.24).
    expected = (6 * force * E_STAR**2 / (pi**3 * R**2)) ** (1 / 3)
    assert fields.largest_pressure(contact) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("part", [0.0, 1e-9, 0.5, 0.999, 1.0])
def test_under_a_paraboloid_the_shear_is_largest_at_the_stick_edge(part: float) -> None:
    contact = normal.solve(Paraboloid(3.0), E_STAR, normal_force=1.0)
    pushed = tangential.solve(contact, G_STAR, MU, tangential_force=-part * MU * 1.0)
    # Eq. (5.16) in Eq. (5.38): 1 - (c/a)^2 with all its digits.
    with mp.workdps(40):
        leg = mp.sqrt(1 - (1 - mpf(part)) ** (mpf(2) / 3))
    expected = MU * float(fields.largest_pressure(contact)) * float(leg)
    assert float(fields.largest_shear_stress(pushed)) == pytest.approx(expected, rel=1e-12)


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
        (fields.largest_pressure(contact), fields.pressure(contact, radii)),
        (fields.largest_shear_stress(pushed), fields.shear_stress(pushed, radii)),
    ):
        assert float(largest) >= field.max() * (1 - 1e-12)
        # So dense, the radii come as near to any smooth top as this.
        assert float(largest) == pytest.approx(field.max(), rel=1e-6)


def test_a_table_of_a_paraboloid_has_the_pressure_of_one() -> None:
    r = np.linspace(0.0, 1.0, 9)
    contact = normal.solve(Tabulated(r, r * r / 2), E_STAR, contact_radius=0.6)
    assert float(fields.largest_pressure(contact)) == pytest.approx(2 * E_STAR * 0.6 / pi, rel=1e-9)


def test_tips_and_edges_have_no_largest_pressure() -> None:
    for profile in (Cone(0.1), FlatPunch(1.0)):
        contact = normal.solve(profile, E_STAR, indentation_depth=[0.0, 0.1])
        assert fields.largest_pressure(contact).tolist() == [0.0, inf]


def test_the_shear_is_endless_where_slip_reaches_what_is_sharp() -> None:
    contact = normal.solve(Cone(0.1), E_STAR, contact_radius=1.0)
    pushed = tangential.solve(contact, G_STAR, MU, stick_radius=[0.5, 0.0])
    stress = fields.largest_shear_stress(pushed)
    # Eq. (5.53) at the stick edge: (mu E* t/2) arccosh(a/c).
    assert stress[0] == pytest.approx(MU * E_STAR * 0.05 * np.arccosh(2.0), rel=1e-12)
    assert stress[1] == inf
    flat = normal.solve(FlatPunch(1.0), E_STAR, normal_force=1.0)
    for force, expected in ((0.0, 0.0), (0.1, inf)):
        pushed = tangential.solve(flat, G_STAR, MU, tangential_force=force)
        assert float(fields.largest_shear_stress(pushed)) == expected


def test_a_sweep_of_paraboloids_says_what_each_says() -> None:
    R, force = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.2, 0.3])
    swept = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    pushed = tangential.solve(swept, G_STAR, MU, tangential_force=force * MU / 2)
    for i in range(3):
        alone = normal.solve(Paraboloid(float(R[i])), E_STAR, normal_force=float(force[i]))
        sideways = tangential.solve(alone, G_STAR, MU, tangential_force=float(force[i] * MU / 2))
        assert fields.largest_pressure(swept)[i] == fields.largest_pressure(alone)
        assert fields.largest_shear_stress(pushed)[i] == fields.largest_shear_stress(sideways)
