"""Stick, full slip and unbounded wear are distinguished from a finite limiting state."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mdr_core import normal
from mdr_core.errors import InputError
from mdr_core.fields import pressure
from mdr_core.profiles import (
    Cone,
    Ellipsoid,
    FlatPunch,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    SphericalTipCone,
    Tabulated,
    TruncatedCone,
)
from mdr_core.wear import limit

R = 1.3


def worn(profile: Profile, load: dict[str, Any], amplitude: dict[str, Any]) -> limit.LimitingWear:
    return limit.solve(normal.solve(profile, 1.0, **load), 0.8, 0.5, **amplitude)


def codes(wear: limit.LimitingWear) -> set[str]:
    return {notice.code for notice in wear.warnings}


RESULTS = (
    "stick_radius",
    "wear_width",
    "wear_radius",
    "indentation_depth",
    "normal_force",
    "tangential_displacement",
    "tangential_force",
    "worn_volume",
)


def values(wear: limit.LimitingWear) -> dict[str, Any]:
    result = {name: getattr(wear, name) for name in RESULTS}
    assert not any(np.isnan(value).any() for value in result.values())
    return result


@pytest.mark.parametrize("load", [{"indentation_depth": 0.3}, {"normal_force": 0.3}])
@pytest.mark.parametrize("name", ["tangential_displacement", "tangential_force"])
@pytest.mark.parametrize("profile", [Paraboloid(R), RoundedPunch(0.5, 1.7), FlatPunch(0.7)])
def test_no_wear_without_slip(profile: Profile, load: dict[str, Any], name: str) -> None:
    # A flat punch is in full stick up to full slip.
    sizes = [0.0, 1e-3] if profile.kind == "flat_punch" else [0.0, 0.0]
    wear = worn(profile, load, {name: sizes})
    first, result = wear.tangential_contact.normal, values(wear)
    assert list(wear.regime) == ["stick", "stick"]
    assert codes(wear) - codes_of(first) == {"no_wear"}
    for edge in ("stick_radius", "wear_radius"):
        assert list(result[edge]) == [float(first.contact_radius)] * 2
    assert list(result["worn_volume"]) == [0.0, 0.0]
    assert wear.error_estimate < 1e-11
    assert list(result["normal_force"]) == pytest.approx(
        [float(first.normal_force)] * 2, rel=1e-14, abs=0
    )
    assert list(result[name]) == sizes
    r = [0.0, 0.3, 0.69]
    assert (wear.worn_depth(r) == 0).all()
    assert (wear.limiting_profile(r) == wear.initial_profile(r)).all()
    assert wear.pressure([0.1])[0] == pytest.approx(pressure(first, [0.1]), rel=1e-12, abs=0)


def codes_of(contact: normal.NormalContact) -> set[str]:
    return {notice.code for notice in contact.warnings}


def test_constant_depth_in_full_slip_wears_to_separation() -> None:
    """f = d at the outer radius: r^2 = 2 R d, V = pi R d^2."""
    d = 0.3
    wear = worn(Paraboloid(R), {"indentation_depth": d}, {"tangential_displacement": [0.1, 0.5]})
    result = values(wear)
    assert list(wear.regime) == ["partial_slip", "full_slip"]
    assert {"contact_lost", "singular"} <= codes(wear)
    assert result["stick_radius"][1] == 0
    assert result["wear_radius"][1] == pytest.approx((2 * R * d) ** 0.5, rel=1e-14, abs=0)
    assert result["worn_volume"][1] == pytest.approx(np.pi * R * d * d, rel=1e-14, abs=0)
    assert (result["normal_force"][1], result["tangential_force"][1]) == (0.0, 0.0)
    assert (result["indentation_depth"][1], result["tangential_displacement"][1]) == (d, 0.5)
    r = np.array([0.0, 1e-9, 0.5, 0.8])
    assert wear.limiting_profile(r)[1] == pytest.approx([d] * 4, rel=1e-15, abs=0)
    assert (wear.pressure(r)[1] == 0).all()


@pytest.mark.parametrize(
    ("profile", "radius", "volume"),
    [
        (Cone(0.4), 0.75, np.pi * 0.3 * 0.75**2 / 3),
        (TruncatedCone(0.5, 0.4), 1.25, np.pi * 0.3 * (1.25**2 + 1.25 * 0.5 + 0.25) / 3),
        (FlatPunch(0.7), 0.7, np.pi * 0.3 * 0.49),
    ],
)
def test_other_shapes_in_full_slip(profile: Profile, radius: float, volume: float) -> None:
    wear = worn(profile, {"indentation_depth": 0.3}, {"tangential_displacement": 9.0})
    assert float(wear.wear_radius) == pytest.approx(radius, rel=1e-14, abs=0)
    assert float(wear.worn_volume) == pytest.approx(volume, rel=1e-13, abs=0)
    r = np.array([0.0, 0.2, 0.69])
    assert wear.limiting_profile(r) == pytest.approx([0.3] * 3, rel=1e-14, abs=0)
    values(wear)


@pytest.mark.parametrize("profile", [Paraboloid(R), RoundedPunch(0.5, 1.7), FlatPunch(0.7)])
def test_wear_under_a_constant_force_in_full_slip_is_unbounded(profile: Profile) -> None:
    for amplitude in ({"tangential_force": [0.1, 0.15]}, {"tangential_displacement": [0.01, 9.0]}):
        wear = worn(profile, {"normal_force": 0.3}, amplitude)
        result = values(wear)
        assert wear.regime[1] == "full_slip"
        assert "endless_wear" in codes(wear)
        for name in ("wear_radius", "indentation_depth", "worn_volume"):
            assert np.isposinf(result[name][1])
            assert np.isfinite(result[name][0])
        assert (result["stick_radius"][1], result["normal_force"][1]) == (0.0, 0.3)
        assert result["tangential_force"][1] == pytest.approx(0.15, rel=1e-15, abs=0)
        r = [0.0, 0.3]
        assert np.isposinf(wear.limiting_profile(r)[1]).all()
        assert (wear.pressure(r)[1] == 0).all()
        assert np.isfinite(wear.grid(30)).all()


@pytest.mark.parametrize("profile", [Paraboloid(R), Cone(0.4), RoundedPunch(0.5, 1.7)])
@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
def test_no_wear_without_load(profile: Profile, control: str) -> None:
    wear = worn(profile, {control: [0.0, 0.2]}, {"tangential_displacement": 0.01})
    result = values(wear)
    assert wear.regime[0] == "stick"
    assert (result["worn_volume"][0], result["normal_force"][0]) == (0.0, 0.0)
    assert result["worn_volume"][1] > 0


def test_limit_at_constant_depth_and_force_is_the_largest_stick_zone() -> None:
    """c (d - g(c)) of a truncated cone rises, falls and rises again towards its flat.

    Of three stick zones that carry the force, wear reaches the outermost one first.
    """
    profile, d = TruncatedCone(0.2, 0.35), 1.0
    c = np.linspace(0.2000001, 1.9, 4001)
    carried = c * (d - profile.g(c))
    size = (carried[0] + carried[:400].min()) / 2
    assert np.count_nonzero(np.diff(np.sign(carried - size))) == 3
    wear = worn(profile, {"indentation_depth": d}, {"tangential_force": size})
    outermost = c[np.flatnonzero(carried >= size)[-1]]
    assert float(wear.stick_radius) == pytest.approx(outermost, rel=1e-3, abs=0)
    edge = np.atleast_1d(wear.stick_radius)
    share = edge * (d - profile.g(edge))
    assert share == pytest.approx(size, rel=1e-13, abs=0)


def test_force_beyond_the_capacity_of_the_worn_contact() -> None:
    """Partial slip initially, but c (d - g(c)) is at most (2/3) d a/sqrt(3) for a paraboloid."""
    d, a = 0.3, (R * 0.3) ** 0.5
    most = 2 * 0.5 * 2 / 3 * d * a / 3**0.5
    good = worn(Paraboloid(R), {"indentation_depth": d}, {"tangential_force": most * (1 - 1e-9)})
    assert float(good.stick_radius) == pytest.approx(a / 3**0.5, rel=1e-4, abs=0)
    slides = worn(
        Paraboloid(R), {"indentation_depth": d}, {"tangential_force": [0.01, most * 1.001]}
    )
    assert list(slides.regime) == ["partial_slip", "full_slip"]
    assert "contact_lost" in codes(slides)
    # As under a displacement beyond full slip.
    result = values(slides)
    assert result["wear_radius"][1] == pytest.approx((2 * R * d) ** 0.5, rel=1e-14, abs=0)
    assert result["worn_volume"][1] == pytest.approx(np.pi * R * d * d, rel=1e-14, abs=0)
    assert (result["stick_radius"][1], result["normal_force"][1]) == (0.0, 0.0)
    assert (result["tangential_force"][1], result["tangential_displacement"][1]) == (0.0, np.inf)


TABLE = Tabulated([0.0, 0.5, 0.9, 1.3], [0.0, 0.1, 0.35, 0.8])


@pytest.mark.parametrize(
    ("profile", "depth"), [(Sphere(1.0), 1.2), (Ellipsoid(1.0, 0.2), 0.3), (TABLE, 1.1)]
)
def test_worn_annulus_beyond_the_profile_is_rejected(profile: Profile, depth: float) -> None:
    largest = 0.5 / 0.8 * depth
    amplitudes = {"tangential_displacement": [largest * 1e-3, largest * 0.99]}
    with pytest.raises(InputError) as failure:
        worn(profile, {"indentation_depth": depth}, amplitudes)
    assert failure.value.path == ("load", "indentation_depth", 1)
    assert "profile ends" in failure.value.detail


def test_stick_zone_at_the_equator_leaves_no_room_for_wear() -> None:
    """R - a = 2R/(exp(2v) + 1) is 2e-15 R, v tanh(v) = d/R = 17."""
    with pytest.raises(InputError) as failure:
        worn(Sphere(1.0), {"indentation_depth": 17.0}, {"tangential_displacement": 0.01})
    assert failure.value.path == ("load", "indentation_depth")
    assert "profile ends" in failure.value.detail


def test_extreme_exponents() -> None:
    for exponent in (0.05, 0.2, 60.0, 200.0):
        profile = Power(1.0, exponent)
        depth = float(profile.g(np.array([0.7]))[0])
        largest = 0.5 / 0.8 * depth
        sizes = largest * np.array([1e-9, 0.1, 0.5, 0.9])
        wear = worn(profile, {"indentation_depth": depth}, {"tangential_displacement": sizes})
        values(wear)
        assert (np.diff(wear.wear_radius) >= 0).all()
        assert (wear.worn_volume > 0).all()


@pytest.mark.parametrize("slope", [1e-3, 1.0, 3.0])
def test_worn_annulus_beyond_the_sphere_of_a_tip(slope: float) -> None:
    """g' of the tip has a pole at the sphere's equator; the cone begins before it."""
    profile = SphericalTipCone(slope, 1.0)
    depth = float(profile.g(np.array([2.5]))[0])
    sizes = 0.5 / 0.8 * depth * np.array([0.1, 0.5, 0.9])
    wear = worn(profile, {"indentation_depth": depth}, {"tangential_displacement": sizes})
    assert (wear.wear_radius > 2.5).all()
    assert (np.diff(wear.wear_radius) > 0).all()
    # A stick edge on the tangent radius, or within rounding error of it.
    b = float(np.asarray(profile.flank_start))
    for c in (b, np.nextafter(b, 0.0), np.nextafter(b, 9.0)):
        size = 0.5 / 0.8 * (depth - float(profile.g(np.array([c]))[0]))
        wear = worn(profile, {"indentation_depth": depth}, {"tangential_displacement": size})
        assert float(wear.stick_radius) == pytest.approx(c, rel=1e-12, abs=0)
        assert float(wear.worn_volume) > 0


def test_loads_broadcast_with_moduli() -> None:
    contact = normal.solve(Paraboloid(R), np.array([1.0, 2.0]), normal_force=[0.3, 0.6])
    wear = limit.solve(
        contact, np.array([0.8, 1.6]), np.array([0.5, 0.5]), tangential_force=[0.05, 0.1]
    )
    assert wear.stick_radius[0] == pytest.approx(wear.stick_radius[1], rel=1e-14, abs=0)
    assert wear.pressure([0.1])[0] == pytest.approx(wear.pressure([0.1])[1] / 2, rel=1e-14, abs=0)
    square = normal.solve(Paraboloid(R), 1.0, normal_force=[[0.3], [0.6]])
    both = limit.solve(square, 0.8, 0.5, tangential_force=[[0.05, 0.1]])
    assert both.wear_radius.shape == (2, 2)
    assert both.worn_depth([0.1, 0.2, 0.3]).shape == (2, 2, 3)


@pytest.mark.parametrize("rounding", [1.0, 1e-6])
def test_inaccurate_limit_carries_the_warning(rounding: float) -> None:
    # The stick radius lies within the rounding error of its distance from the flat.
    wear = worn(RoundedPunch(1.0, rounding), {"normal_force": 1e-3}, {"tangential_force": 1e-4})
    assert ("accuracy" in codes(wear)) == (wear.error_estimate > 1e-9) == (rounding < 1e-3)
