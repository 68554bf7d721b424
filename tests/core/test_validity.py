"""Warnings and estimates of the model's error agree with published, more complete solutions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from verification import compressed_ball, transverse_slip

from mdr_core import adhesion, half_space, layer, normal, tangential, validity
from mdr_core.errors import InputError
from mdr_core.materials import RIGID, Body, Layer, Material, from_bodies
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
    TwoSpheres,
)

R = np.linspace(0.0, 1.0, 101)


def codes(contact: normal.NormalContact | tangential.TangentialContact) -> list[str]:
    return [notice.code for notice in contact.warnings]


def bodies(*poissons_ratios: float) -> Material:
    """Elastic bodies of equal Young's modulus; a single one is in contact with a rigid body."""
    elastic = [Body(1.0, nu) for nu in poissons_ratios]
    return from_bodies([*elastic, RIGID][:2])


def warnings_of(
    contact: normal.NormalContact | tangential.TangentialContact, material: Material
) -> dict[str, validity.Finding]:
    pressed = replace(contact.normal, material=material)
    given = pressed
    if isinstance(contact, tangential.TangentialContact):
        given = replace(contact, normal=pressed)
    return {f.code: f for f in validity.findings(given) if np.any(f.where)}


def message_of(finding: validity.Finding) -> str:
    """Return the message of the warning of a finding."""
    return validity.notices([finding])[0].message


def sticking(contact: normal.NormalContact, g_star: float) -> tangential.TangentialContact:
    return tangential.solve(contact, g_star, 0.3, tangential_displacement=0.0)


def test_infinite_deviatoric_stress() -> None:
    """At a tip or slope discontinuity of incompressible bodies it is finite where nothing slips."""
    rubber, steel = bodies(0.5), bodies(0.3)
    for profile in (Cone(0.01), TruncatedCone(0.5, 0.01)):
        contact = normal.solve(profile, rubber.e_star, contact_radius=1.0)
        assert warnings_of(contact, rubber) == {}
        for c, codes_ in ((0.8, set()), (0.0, {"plastic"})):
            slips = tangential.solve(contact, rubber.g_star, 0.3, stick_radius=c)
            assert set(warnings_of(slips, rubber)) == codes_
        assert set(warnings_of(contact, steel)) == {"plastic"}
    beneath_rigid = from_bodies([RIGID, Body(1.0, 0.5)])
    for profile in (Power(1e-3, 0.9), FlatPunch(1.0)):
        sharper = normal.solve(profile, rubber.e_star, normal_force=1e-3)
        assert set(warnings_of(sharper, beneath_rigid)) == {"plastic"}


def test_warning_lists_the_radii_of_infinite_deviatoric_stress_only() -> None:
    rubber, r = bodies(0.5), np.arange(6.0)
    table = Tabulated(r, 1e-3 * (r + np.maximum(r - 3, 0)), breaks=(3.0,))
    contact = normal.solve(table, rubber.e_star, contact_radius=3.5)
    slips = tangential.solve(contact, rubber.g_star, 0.3, stick_radius=2.5)
    message = message_of(warnings_of(slips, rubber)["plastic"])
    assert message.startswith("the elastic pressure is infinite at radius 3: ")


def test_flat_punch_slips_nowhere_or_everywhere() -> None:
    contact = normal.solve(FlatPunch(2.0), 1.0, normal_force=1.0)
    pushed = tangential.solve(contact, 1.0, 0.5, tangential_force=[0.0, 0.25, 0.5])
    assert pushed.stick_radius.tolist() == [2.0, 2.0, 0.0]
    assert pushed.method == "closed_form"


def first_order_error(slope: Any, pressure: Any, k: float) -> float:
    """Relative increase of the force at prescribed depth, because points move inwards.

    With M(r) = int_0^r p s ds, the surface moves by u_r = -(4 k/E*) M(r)/r. The profile appears
    lower by f'(r) |u_r|, and the force, stationary in a, increases by 2 E* int_0^a dg dx = 2 E*
    int_0^a df r/sqrt(a^2 - r^2) dr.
    """

    def moment(r: float) -> float:
        return float(quad(lambda s: pressure(s) * s, 0, r)[0])

    # E* = a = 1; r = sin(u) removes the singularity.
    rise = quad(lambda u: slope(np.sin(u)) * 4 * k * moment(np.sin(u)), 0, np.pi / 2)[0]
    return float(2 * rise / (2 * np.pi * moment(1.0)))


def test_half_space_error() -> None:
    """First order in the slope: Hay, Bolshakov and Pharr (1999), and the derivation above."""
    nu = 0.3
    k = (1 - 2 * nu) / (4 * (1 - nu))
    beta = bodies(nu).dundurs_beta
    assert beta == pytest.approx(2 * k, rel=1e-14, abs=0)

    def hay(t: float) -> float:
        return np.pi * (np.pi / 4 + 0.15483073 * k * t) / (np.pi / 2 - 0.83119312 * k * t) ** 2 - 1

    radial = half_space._RADIAL * beta
    assert radial == pytest.approx((hay(1e-6) - hay(-1e-6)) / 2e-6, rel=0.01, abs=0)
    # A cone of slope 1 and a paraboloid of that slope at the edge, for E* = 1 and a = 1.
    cone = first_order_error(lambda r: 1.0, lambda r: np.arccosh(1 / r) / 2, k)
    assert radial == pytest.approx(cone, rel=0.01, abs=0)
    ball = first_order_error(lambda r: r, lambda r: 2 / np.pi * np.sqrt(1 - r * r), k)
    assert ball < radial < 1.6 * ball
    assert half_space._RADIAL_ROUND * beta == pytest.approx(ball, rel=1e-3, abs=0)
    # Figures of the paper: 5.6 % at t = 0.3, 1.8 % at 0.1.
    assert hay(0.3) == pytest.approx(0.056, abs=5e-4)
    assert radial * 0.3 == pytest.approx(0.056, rel=0.05, abs=0)
    assert radial * 0.1 == pytest.approx(0.018, rel=0.02, abs=0)


def test_model_error_of_a_layer_on_a_rigid_base() -> None:
    """Dimitriadis et al. (2002): 1.133 chi + 1.283 chi^2 more force for nu = 1/2, chi = a/h."""
    a = np.array([0.0, 1e-3, 0.0999, 0.1001, 3.0])
    gel = from_bodies([RIGID, Body(1e3, 0.5)], body_thickness=1.0)
    contact = normal.solve(Paraboloid(1e4), gel, contact_radius=a)
    expected = np.minimum(1.133 * a + 1.283 * a**2, 1.0)
    assert contact.model_error == pytest.approx(expected, rel=2e-3, abs=1e-7)
    (thin,) = contact.warnings
    assert (thin.code, thin.limit, thin.instead) == ("thin_body", 0.1, "finite_elements")
    assert thin.value == pytest.approx(3.0, rel=1e-14, abs=0)
    assert "by over 100 %" in thin.message
    assert warnings_of(contact, gel)["thin_body"].where.tolist() == [False] * 3 + [True] * 2
    # Of unknown bodies, and with adhesion, under tension too.
    unknown = Material(1.0, body_thickness=0.1)
    punch = adhesion.solve(FlatPunch(0.05), unknown, 1e-9, indentation_depth=-1e-9)
    assert punch.model_error == pytest.approx(0.44 + 0.44**2, rel=0.01, abs=0)
    assert "thin_body" in {notice.code for notice in punch.warnings}


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_model_error_of_transverse_slip(nu: float) -> None:
    """It is not understated at any stick radius, nor thrice the largest change of the force."""
    pair = bodies(nu, nu)
    ball = normal.solve(Paraboloid(1.0), pair, contact_radius=1e-12)
    partial = tangential.solve(ball, pair.g_star, 0.3, tangential_force=0.0)
    sticks = (0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
    largest = max(abs(transverse_slip.force_ratio(nu, stick) - 1) for stick in sticks)
    assert largest <= partial.model_error <= 3 * largest + 1e-10


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45, 0.49])
@pytest.mark.parametrize("cap", [0.02, 0.05, 0.1, 0.2, 0.4])
def test_model_error_of_a_ball_between_plates_is_not_understated(nu: float, cap: float) -> None:
    """Factor of three, but where two errors of a ball of nu = 0 nearly cancel."""
    depth, ratio = compressed_ball.force_ratio(nu, cap)
    elastic = [Body(1.0, nu), RIGID]
    for profile, pair in (
        (Sphere(1.0), from_bodies(elastic)),
        (Sphere(1.0), from_bodies(elastic, body_thickness=2.0)),
        (Paraboloid(1.0), from_bodies(elastic, body_thickness=2.0)),
    ):
        contact = normal.solve(profile, pair, indentation_depth=depth)
        assert contact.model_error >= abs(ratio - 1)
        assert contact.model_error <= 3 * abs(ratio - 1) or (nu == 0 and cap < 0.2)
        thin = cap == 0.4 and pair.body_thickness is not None
        assert ("thin_body" in codes(contact)) == thin


def test_one_ball_has_one_certificate() -> None:
    """A ball has the error of its radius, its hold and its share, whatever the kind of profile."""
    soft = Body(1.0, 0.3)

    def error(profile: normal.Profile, *given: Body | str) -> float:
        return float(normal.solve(profile, from_bodies(given), contact_radius=0.02).model_error)

    same = Paraboloid(1.0), Sphere(1.0), TwoSpheres((1.0, 1e9))
    for pair in ((soft, soft), (soft, RIGID), (RIGID, soft)):
        assert len({round(error(profile, *pair), 9) for profile in same}) == 1
    # A rigid ball has no size, an elastic one half of it beside a flat of equal material, which two
    # equal balls have in full.
    alone = error(Sphere(1.0), soft, RIGID)
    assert error(Sphere(1.0), RIGID, soft) < 0.3 * alone
    assert error(Sphere(1.0), soft, soft) == pytest.approx(alone / 2, rel=0.01, abs=0)
    assert error(TwoSpheres((1.0, 1.0)), soft, soft) == pytest.approx(alone, rel=1e-12, abs=0)
    free = Body(1.0, 0.3, held="free")
    assert error(Sphere(1.0), free, RIGID) == pytest.approx(alone * 1.1 / 0.6, rel=0.02, abs=0)
    block = Body(1.0, 0.3, held="block")
    assert error(Sphere(1.0), block, RIGID) == 0
    # The socket in a block keeps its own, and unknown bodies have the larger error.
    socket = TwoSpheres((1.0, -1.03))
    assert error(socket, RIGID, block) == error(socket, RIGID, soft)
    unknown = normal.solve(socket, 1.0, contact_radius=0.02)
    assert unknown.model_error >= max(error(socket, soft, RIGID), error(socket, RIGID, soft))


# Of the series of ball and cavity (`verification/conforming_balls.py`): Poisson's ratios, the other
# radius, force; true over model of the half-space, less one: force at the depth, radius, pressure.
TRUE_BODIES = [
    ((None, 0.3), -1.03, 1.291e-3, 0.228, 0.001, 0.058),
    ((None, 0.3), -1.003, 6.160e-3, 0.454, 0.026, 0.312),
    ((None, 0.45), -1.03, 1.602e-2, 0.216, 0.021, 0.185),
    ((0.3, 0.3), -1.003, 2.215e-6, 0.060, 0.000, 0.004),
    ((0.45, 0.45), -1.03, 7.106e-4, 0.140, 0.010, 0.027),
    ((0.3, 0.3), -1.1, 2.024e-2, 0.377, 0.033, 0.129),
    ((0.3, None), -1.03, 1.233e-2, 0.371, 0.054, 0.069),
    ((0.3, 0.3), 1.0, 1.186e-2, 0.125, 0.001, 0.004),
    ((0.3, 0.3), 3.0, 2.691e-2, 0.126, 0.003, 0.001),
    ((None, 0.3), 3.0, 5.329e-2, 0.092, 0.006, 0.037),
]


@pytest.mark.parametrize(
    ("nu", "other", "force", "of_force", "of_radius", "of_pressure"), TRUE_BODIES
)
def test_errors_of_balls_and_sockets(
    nu: Any, other: float, force: float, of_force: float, of_radius: float, of_pressure: float
) -> None:
    pair = from_bodies([RIGID if each is None else Body(1.0, each) for each in nu])
    contact = normal.solve(TwoSpheres((1.0, other)), pair, normal_force=force)
    assert of_force / 1.2 <= contact.model_error <= 3 * of_force
    for estimate, true in (
        (contact.model_error_radius, of_radius),
        (contact.model_error_pressure, of_pressure),
    ):
        assert estimate >= true / 1.5
        # Below one per cent it may be too large.
        assert estimate <= max(3 * true, 0.04)
    known = contact.to_dict()
    assert known["model_error_pressure"] == contact.model_error_pressure
    assert "model_error_pressure" not in normal.solve(Cone(0.1), pair, normal_force=1.0).to_dict()


def test_contact_in_a_socket_beyond_0_85_of_the_ball_is_rejected() -> None:
    socket = TwoSpheres((14.0, -14.1))
    force = float(normal.solve(socket, 1.0, contact_radius=0.85 * 14).normal_force)
    assert codes(normal.solve(socket, 1.0, normal_force=force * (1 - 1e-9))) == ["half_space"]
    for name, load in (("normal_force", force * 1.01), ("contact_radius", 11.91)):
        with pytest.raises(InputError, match=r"60 degrees of the ball.*conforming contact"):
            normal.solve(socket, 1.0, **{name: load})
    (warning,) = normal.solve(socket, 1.0, contact_radius=5.0).warnings
    assert warning.instead == "conforming_contact"


def test_large_strain_of_round_bodies() -> None:
    """Hertz: p(0)/E* = 2 a/(pi R) is a tenth at a/R = 0.157."""
    for profile in (Paraboloid(1.0), TwoSpheres((2.0, 2.0))):
        found = warnings_of(normal.solve(profile, 1.0, contact_radius=[0.15, 0.165]), Material(1.0))
        assert found["large_strain"].where.tolist() == [False, True]
        assert "large_strain" in found
    tight = normal.solve(TwoSpheres((1.0, -1.003)), 1.0, contact_radius=0.8)
    assert "large_strain" not in codes(tight)


def test_warnings_name_their_size_limit_and_remedy() -> None:
    contact = normal.solve(Cone(0.2), 1.0, normal_force=[0.0, 1.0])
    found = {notice.code: notice for notice in contact.warnings}
    steep = found["half_space"]
    assert steep.value == contact.model_error.max()
    assert (steep.limit, steep.instead) == (0.01, "finite_elements")
    assert (found["plastic"].value, found["plastic"].instead) == (None, "rounded_tip")
    strange = sticking(normal.solve(Paraboloid(1.0), 2.0, contact_radius=1e-3), 1.0)
    notice = {each.code: each for each in strange.warnings}["impossible_moduli"]
    assert (notice.value, notice.limit) == (2.0, 1.5)
    r = np.linspace(0, 1, 11)
    near = normal.solve(Tabulated(r, r * r / 2e3), 1.0, contact_radius=0.99)
    end = {each.code: each for each in near.warnings}["table_end"]
    assert (end.value, end.limit, end.instead) == (0.99, 0.95, "longer_table")


@pytest.mark.parametrize(
    ("material", "slope"),
    [
        # 0.63 |beta| t + t^2 = 0.01, also for unknown bodies; similar or incompressible ones 0.1.
        (bodies(0.3), 0.0445),
        (Material(1.0), 0.0445),
        (bodies(0.3, 0.3), 0.1),
        (bodies(0.5), 0.1),
        # Dundurs' beta is negative here, but not the radial displacement that is neglected.
        (from_bodies([RIGID, Body(1.0, 0.3)]), 0.0445),
    ],
    ids=["steel on rigid", "unknown", "steel on steel", "rubber on rigid", "rigid on steel"],
)
def test_steep_slopes_exceed_the_half_space_limit(material: Material, slope: float) -> None:
    profile = Power(0.5, 2.0)
    contact = normal.solve(profile, material.e_star, contact_radius=[slope * 0.98, slope])
    assert "half_space" not in warnings_of(
        replace(contact, coordinate=contact.coordinate[:1]), material
    )
    steep = normal.solve(profile, material.e_star, contact_radius=[0.01, slope * 1.02])
    warning = warnings_of(steep, material)["half_space"]
    assert warning.where.tolist() == [False, True]
    message = message_of(warning)
    assert "error of 1" in message
    assert ("0.3 assumed" in message) == (material.dundurs_beta is None)


def test_contact_without_material_assumes_the_worst_case() -> None:
    steep = normal.solve(Sphere(1.0), 1.0, contact_radius=0.6)
    assert codes(steep) == ["half_space", "large_strain"]
    assert "0.3 assumed" in steep.warnings[0].message
    assert "the second counts as flat" in steep.warnings[0].message
    assert codes(normal.solve(FlatPunch(1.0), 1.0, normal_force=1.0)) == ["plastic", "singular"]


STEEL, POLYMER = Body(210e9, 0.3), Body(2.1e9, 0.3)


@pytest.mark.parametrize(
    ("given", "profile", "error"),
    [
        # 3 x the share of the punch; none if it is rigid, unknown, or far stiffer.
        ([STEEL, RIGID], FlatPunch(1e-3), "over 100 %"),
        ([STEEL, STEEL], FlatPunch(1e-3), "over 100 %"),
        ([STEEL, POLYMER], FlatPunch(1e-3), "3 %"),
        ([RIGID, STEEL], FlatPunch(1e-3), None),
        ([STEEL, Body(2.1e6, 0.3)], FlatPunch(1e-3), None),
        (None, FlatPunch(1e-3), None),
        ([STEEL, STEEL], RoundedPunch(1e-3, 1e-5), "over 100 %"),
        # The mean slope between a and 2a is a/(2R) = 1/10.
        ([STEEL, STEEL], RoundedPunch(1e-3, 5e-3), "1.5 %"),
        ([RIGID, STEEL], RoundedPunch(1e-3, 1e-5), None),
        ([STEEL, STEEL], RoundedPunch(1e-3, 1.0), None),
        ([STEEL, STEEL], TruncatedCone(1e-3, 0.09), None),
    ],
)
def test_side_wall_of_an_elastic_punch(
    given: Any, profile: normal.Profile, error: str | None
) -> None:
    material = from_bodies(given) if given else Material(115e9)
    contact = normal.solve(profile, material, normal_force=1e-3)
    found = [notice.message for notice in contact.warnings if notice.code == "half_space"]
    assert len(found) == (error is not None)
    assert not error or f"an estimated error of {error}" in found[0]
    assert not error or "rigid" in found[0]


def test_error_above_100_per_cent_is_no_number() -> None:
    steep = normal.solve(Cone(3.0), bodies(0.3), normal_force=1.0)
    (message,) = [each.message for each in steep.warnings if each.code == "half_space"]
    assert "error of over 100 %, mainly from the slope 3 at" in message


@pytest.mark.parametrize("nu", [-0.999, -0.5, 0.0, 0.3, 0.5])
@pytest.mark.parametrize("other", [-0.999, 0.2, 0.5, None])
def test_moduli_of_real_bodies_are_accepted(nu: float, other: float | None) -> None:
    real = bodies(nu) if other is None else bodies(nu, other)
    contact = normal.solve(Paraboloid(1.0), real.e_star, contact_radius=0.01)
    assert warnings_of(sticking(contact, real.g_star), Material(real.e_star, real.g_star)) == {}


@pytest.mark.parametrize(("ratio", "possible"), [(0.74, 0), (0.76, 1), (1.49, 1), (1.51, 0)])
def test_impossible_moduli_are_rejected(ratio: float, possible: int) -> None:
    contact = normal.solve(Paraboloid(1.0), ratio, contact_radius=0.01)
    warning = warnings_of(sticking(contact, 1.0), Material(ratio, 1.0))
    assert list(warning) == ([] if possible else ["impossible_moduli"])


def test_elastic_similarity_warning() -> None:
    alike, unlike = bodies(0.3, 0.3), bodies(0.2)
    contact = normal.solve(Paraboloid(1.0), alike.e_star, contact_radius=0.01)
    assert warnings_of(sticking(contact, alike.g_star), alike) == {}
    contact = normal.solve(Paraboloid(1.0), unlike.e_star, contact_radius=0.01)
    assert list(warnings_of(sticking(contact, unlike.g_star), unlike)) == ["elastic_similarity"]
    # Without friction there is no coupling.
    assert warnings_of(contact, unlike) == {}


@pytest.mark.parametrize(
    ("profile", "radius", "place"),
    [
        (FlatPunch(2.0), None, "2"),
        (Cone(0.01), 1.0, "0"),
        (Power(0.01, 0.5), 1.0, "0"),
        (TruncatedCone(0.5, 0.01), 0.6, "0.5"),
        (CappedParaboloid(0.5, 90.0, 50.0), 0.6, "0.5"),
        (Tabulated(R, 0.01 * R), 0.5, "0"),
    ],
)
def test_infinite_pressure_warning_states_its_radius(
    profile: normal.Profile, radius: float | None, place: str
) -> None:
    load = {"normal_force": 1e-3} if radius is None else {"contact_radius": radius}
    contact = normal.solve(profile, 1.0, **load)
    plastic, singular = contact.warnings
    assert plastic.code == "plastic"
    assert f"radius {place}:" in plastic.message
    assert singular.code == "singular"
    assert singular.message.endswith(f"radius {place}")


def test_no_pressure_warning_for_smooth_tips_and_kinks_outside() -> None:
    for profile in (
        Hyperboloid(0.01, 1.0),
        RoundedPunch(0.5, 90.0),
        Tabulated(R, R**2 / 200),
        CappedParaboloid(0.5, 90.0, 50.0),
    ):
        radius = 0.4 if isinstance(profile, CappedParaboloid) else 0.6
        assert codes(normal.solve(profile, 1.0, contact_radius=radius)) == []


def test_warning_near_the_end_of_a_table() -> None:
    table = Tabulated(R, R**2 / 200)
    assert codes(normal.solve(table, 1.0, contact_radius=0.94)) == []
    assert codes(normal.solve(table, 1.0, contact_radius=0.96)) == ["table_end"]


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_thickness_changes_radius_and_pressure_under_a_force_by_less_than_stated(nu: float) -> None:
    """The layer changes the radius by a third of the estimate to all of it."""
    bodies = [RIGID, Body(1.0, nu)]
    thin = normal.solve(
        Cone(1.0), from_bodies(bodies, body_thickness=10.0), contact_radius=[0.5, 1.0]
    )
    on_layer = layer.solve(
        Cone(1.0),
        from_bodies(bodies, layer=Layer(10.0, "bonded", nu)),
        normal_force=thin.normal_force,
    )
    radius = 1 - on_layer.contact_radius / thin.contact_radius
    assert thin.model_error_radius is not None
    assert thin.model_error_pressure is not None
    for estimate in (thin.model_error_radius, thin.model_error_pressure):
        assert np.all(estimate > radius)
        assert np.all(estimate < 3 * radius)
