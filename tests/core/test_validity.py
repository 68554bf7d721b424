"""What is said where the model ends, against the literature's figures."""

from __future__ import annotations

import numpy as np
import pytest

from mdr_core import normal, tangential, validity
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    FlatPunch,
    Hyperboloid,
    Paraboloid,
    Power,
    RoundedPunch,
    Sphere,
    Tabulated,
    TruncatedCone,
)

R = np.linspace(0.0, 1.0, 101)


def codes(contact: normal.NormalContact | tangential.TangentialContact) -> list[str]:
    return [notice.code for notice in contact.warnings]


@pytest.mark.parametrize(("poissons_ratio", "factor"), [(0.0, 0.385), (0.3, 0.310), (0.5, 0.266)])
def test_largest_shear_under_hertz(poissons_ratio: float, factor: float) -> None:
    """Johnson, section 4.3: 0.31 p0 for nu = 0.3; the others by the same Eq. (3.45)."""
    assert validity.largest_shear(poissons_ratio) == pytest.approx(factor, abs=5e-4)


def test_onset_of_yield_is_at_1_61_yield_strengths() -> None:
    """p0 = 2 E* a/(pi R); Johnson, section 6.1: p0 = 1.60 Y, here with three digits."""
    body, strength = Paraboloid(1.0), 1e-3
    onset = 1.613 * strength * np.pi / 2

    def found(radius: float) -> list[str]:
        notices = validity.yield_notices(
            body, 1.0, np.asarray(radius), strength, poissons_ratios=(0.3,)
        )
        return [notice.code for notice in notices]

    assert found(onset * 0.998) == []
    assert found(onset * 1.002) == ["yield"]


def test_surface_yields_first_in_full_sliding() -> None:
    """mu p0 = Y/2 comes before 0.31 p0 = Y/2 for mu > 0.31."""
    strength, peak = 1.0, 1.2
    radius = np.asarray(peak * np.pi / 2)

    def found(*, sliding: bool) -> int:
        return len(
            validity.yield_notices(
                Paraboloid(1.0),
                1.0,
                radius,
                strength,
                poissons_ratios=(0.3,),
                friction_coefficient=0.5,
                full_slip=np.asarray(sliding),
            )
        )

    assert (found(sliding=False), found(sliding=True)) == (0, 1)


def test_yield_of_other_shapes_is_not_guessed() -> None:
    for profile, code in ((RoundedPunch(0.5, 1.0), "yield_unknown"), (Cone(0.1), "yield")):
        (notice,) = validity.yield_notices(profile, 1.0, np.asarray(0.6), 1.0)
        assert notice.code == code


def test_steep_slopes_leave_the_half_space() -> None:
    """f' = a/R: the threshold is crossed at a = 0.3 R."""
    flat = normal.solve(Paraboloid(1.0), 1.0, contact_radius=0.299)
    steep = normal.solve(Paraboloid(1.0), 1.0, contact_radius=[0.1, 0.301])
    assert codes(flat) == []
    assert codes(steep) == ["half_space"]
    assert codes(normal.solve(Sphere(1.0), 1.0, contact_radius=0.6)) == ["half_space"]


@pytest.mark.parametrize(
    ("profile", "radius", "place"),
    [
        (FlatPunch(2.0), None, "2"),
        (Cone(0.1), 1.0, "0"),
        (Power(0.1, 0.5), 1.0, "0"),
        (TruncatedCone(0.5, 0.1), 0.6, "0.5"),
        (CappedParaboloid(0.5, 9.0, 5.0), 0.6, "0.5"),
        (Tabulated(R, 0.05 * R), 0.5, "0"),
    ],
)
def test_infinite_pressure_is_said_with_its_radius(
    profile: normal.Profile, radius: float | None, place: str
) -> None:
    load = {"normal_force": 1e-3} if radius is None else {"contact_radius": radius}
    contact = normal.solve(profile, 1.0, **load)
    (notice,) = contact.warnings
    assert notice.code == "plastic"
    assert f"radius {place}:" in notice.message


def test_smooth_tips_and_unreached_kinks_say_nothing() -> None:
    for profile in (
        Hyperboloid(0.1, 1.0),
        RoundedPunch(0.5, 9.0),
        Tabulated(R, R**2 / 20),
        CappedParaboloid(0.5, 9.0, 5.0),
    ):
        radius = 0.4 if isinstance(profile, CappedParaboloid) else 0.6
        assert codes(normal.solve(profile, 1.0, contact_radius=radius)) == []


def test_the_end_of_a_table_is_announced() -> None:
    table = Tabulated(R, R**2 / 20)
    assert codes(normal.solve(table, 1.0, contact_radius=0.94)) == []
    assert codes(normal.solve(table, 1.0, contact_radius=0.96)) == ["table_end"]


def test_large_friction_of_compressible_bodies() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, contact_radius=0.1)

    def said(g_star: float, friction: float) -> list[str]:
        return codes(tangential.solve(contact, g_star, friction, stick_radius=0.05))

    assert said(0.85, 1.0) == ["friction"]
    assert said(0.85, 0.5) == []
    # nu = 1/2: E*/G* = 3/2, and no transverse slip.
    assert said(1 / 1.5, 1.0) == []
