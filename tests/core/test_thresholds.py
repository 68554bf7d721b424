"""At each limit of a model the full solver finds the stated relative change of the result."""

from typing import Any

import pytest

from mdr_core import (
    CappedParaboloid,
    Cone,
    FlatPunch,
    InputError,
    Layer,
    Material,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    TruncatedCone,
    adhesion,
    layer,
    normal,
    subsurface,
    tangential,
    thresholds,
)

PROFILES = (
    (Paraboloid(1.0), 0.1),
    (Sphere(1.0), 0.5),
    (Cone(0.1), 0.1),
    (Power(1.0, 4.0), 0.3),
    (RoundedPunch(0.08, 1.0), 0.1),
)
# Just beyond the flat g' changes much within the tolerance.
BESIDE_A_FLAT = (
    (RoundedPunch(0.08, 1.0), 0.0801),
    (TruncatedCone(0.08, 0.1), 0.0801),
    (CappedParaboloid(0.08, 10.0, 1.0), 0.0801),
)
# The limits of slip and thickness are of first order in the tolerance.
ROOM = {1e-3: (0.9, 1.1), 1e-2: (0.9, 1.1), 0.1: (0.5, 1.6)}


def _limits(contact: normal.NormalContact, tolerance: float) -> dict[str, Any]:
    return {limit.effect: limit.value for limit in thresholds.of_contact(contact, tolerance)}


@pytest.mark.parametrize(("profile", "radius"), PROFILES)
@pytest.mark.parametrize("tolerance", ROOM)
def test_adhesion_and_slip(profile: Profile, radius: float, tolerance: float) -> None:
    contact = normal.solve(profile, 1.0, contact_radius=radius)
    limits = _limits(contact, tolerance)
    low, high = (tolerance * room for room in ROOM[tolerance])
    force = contact.normal_force
    sticky = adhesion.solve(profile, 1.0, float(limits["adhesion"]), normal_force=force)
    assert sticky.contact_radius / radius - 1 == pytest.approx(tolerance, rel=1e-9, abs=0)
    shear = 0.3 * limits["slip"]
    slipping = tangential.solve(contact, 0.8, 0.3, tangential_force=shear)
    stick = shear / (2 * 0.8 * radius)
    assert low < slipping.tangential_displacement / stick - 1 < high


@pytest.mark.parametrize(("profile", "radius"), BESIDE_A_FLAT)
@pytest.mark.parametrize("tolerance", ROOM)
def test_no_more_than_the_tolerance_beside_a_flat(
    profile: Profile, radius: float, tolerance: float
) -> None:
    contact = normal.solve(profile, 1.0, contact_radius=radius)
    limits, force = _limits(contact, tolerance), contact.normal_force
    sticky = adhesion.solve(profile, 1.0, float(limits["adhesion"]), normal_force=force)
    assert sticky.contact_radius / radius - 1 == pytest.approx(tolerance, rel=1e-6, abs=0)
    slipping = tangential.solve(contact, 0.8, 0.3, tangential_force=0.3 * limits["slip"])
    stick = 0.3 * limits["slip"] / (2 * 0.8 * radius)
    assert slipping.tangential_displacement / stick - 1 < tolerance


def test_flat_punch_sticks_up_to_full_slip_and_pulls_off_at_the_tolerance() -> None:
    contact = normal.solve(FlatPunch(1.0), 1.0, indentation_depth=0.1)
    limits = _limits(contact, 0.01)
    assert limits["slip"] == pytest.approx(contact.normal_force, rel=1e-15, abs=0)
    sticky = adhesion.solve(FlatPunch(1.0), 1.0, float(limits["adhesion"]), normal_force=0.0)
    assert -sticky.pull_off_depth == pytest.approx(1e-3, rel=1e-12, abs=0)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_thickness_by_the_layer(nu: float) -> None:
    material = Material(1.0, poissons_ratios=(nu,))
    contact = normal.solve(Paraboloid(1.0), material, indentation_depth=0.01)
    thickness = float(_limits(contact, 0.01)["thickness"])
    sample = Material(1.0, layer=Layer(thickness, "bonded", nu))
    stiff = layer.solve(Paraboloid(1.0), sample, indentation_depth=0.01)
    assert 0.007 < stiff.normal_force / contact.normal_force - 1 < 0.013


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.5])
@pytest.mark.parametrize("load", [{"contact_radius": 0.1}, {"normal_force": 1e-5}])
def test_yield_by_the_largest_shear_stress(nu: float, load: dict[str, float]) -> None:
    material = Material(1.0, poissons_ratios=(nu,))
    contact = normal.solve(Paraboloid(1.0), material, **load)
    shear = subsurface.largest(contact, "maximum_shear", poissons_ratio=nu)
    # A strength has no tolerance: the stress that it bears is the largest one.
    for tolerance in ROOM:
        strength = _limits(contact, tolerance)["yield"]
        assert strength == pytest.approx(2 * shear.value, rel=1e-4, abs=0)


@pytest.mark.parametrize("size", [1e-3, 2.0])
@pytest.mark.parametrize("tolerance", [1e-4, *ROOM])
def test_shape_by_a_paraboloid_under_the_same_force(tolerance: float, size: float) -> None:
    ball = normal.solve(Sphere(size), 1.0, contact_radius=0.1 * size)
    radius = _limits(ball, tolerance)["shape"]
    at_limit = normal.solve(Sphere(size), 1.0, contact_radius=radius)
    like = normal.solve(Paraboloid(size), 1.0, normal_force=at_limit.normal_force)
    change = at_limit.indentation_depth / like.indentation_depth - 1
    assert change == pytest.approx(tolerance, rel=1e-9, abs=0)


def test_several_loads_and_none() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, contact_radius=[0.0, 0.1])
    for limit in thresholds.of_contact(contact, 0.01):
        assert limit.value[0] == 0 < limit.value[1]


def test_other_contacts_and_tolerances_are_rejected() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, contact_radius=0.1)
    for tolerance in (0.0, 0.2):
        with pytest.raises(InputError, match="must lie from"):
            thresholds.of_contact(contact, tolerance)
    sticky = adhesion.solve(Paraboloid(1.0), 1.0, 1e-5, contact_radius=0.1)
    with pytest.raises(InputError, match="without adhesion"):
        thresholds.of_contact(sticky, 0.01)
