"""A contact with an elastic layer solves Lebedev and Ufliand's equation, with adhesion and fits."""

from collections.abc import Sequence
from math import sqrt
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mdr_core import (
    Body,
    Cone,
    FlatPunch,
    InputError,
    Layer,
    Material,
    Paraboloid,
    Power,
    PowerTerm,
    Profile,
    RoundedCone,
    RoundedPunch,
    Series,
    Sphere,
    SphericalTipCone,
    Tabulated,
    TruncatedCone,
    fields,
    fit,
    from_bodies,
    layer,
    normal,
    tangential,
)
from tests.core import random_layers
from tests.oracles.shapes import KINDS

Array = NDArray[np.float64]
BONDED, SLIDING = "bonded", "frictionless"


def _material(part: float, base: Any, nu: float | None, share: float = 1.0) -> Material:
    """E* = 1, and a layer of thickness 1/part."""
    return Material(1.0, layer=Layer(1 / part, base, nu, share))


# Depth, force, stiffness, energy and pressure at the axis for E* = a = 1, by finite elements and by
# 30 digits of the equation.
VALUES: Sequence[tuple[Profile, str, float | None, float, tuple[float, ...]]] = (
    (
        Paraboloid(1.0),
        BONDED,
        0.3,
        0.1,
        (0.9421665312728, 1.334034453629, 2.19088138586, 0.4950379511348, 0.63695553266),
    ),
    (
        Paraboloid(1.0),
        BONDED,
        0.5,
        1,
        (0.5594154855629, 1.880666899171, 7.23747169792, 0.3424096925934, 0.95167355151),
    ),
    (
        Paraboloid(1.0),
        SLIDING,
        None,
        1,
        (0.6739806449888, 1.578122747287, 4.397242731332, 0.3755169905647, 0.77162098553),
    ),
    (
        Cone(1.0),
        SLIDING,
        None,
        2,
        (1.090376860121, 2.740077120663, 7.455212959892, 0.7669904959457, np.inf),
    ),
    (
        Sphere(2.0),
        BONDED,
        0.45,
        1,
        (0.3225880500949, 1.006367115626, 6.182816134901, 0.1102196806787, 0.48743170755),
    ),
    (
        Power(1.0, 4.0),
        BONDED,
        0.3,
        2,
        (1.289936345906, 7.538294004405, 8.706488580605, 3.911763705294, 3.0094006456),
    ),
    (
        RoundedPunch(0.5, 1.0),
        BONDED,
        0.3,
        1,
        (0.1954581244336, 0.6927973368536, 4.967049258285, 0.05791446653107, 0.21154842786),
    ),
)


@pytest.mark.parametrize(("profile", "base", "nu", "part", "values"), VALUES)
def test_values_at_a_contact_radius(
    profile: Profile, base: str, nu: float | None, part: float, values: tuple[float, ...]
) -> None:
    contact = layer.solve(profile, _material(part, base, nu), contact_radius=1.0)
    names = "indentation_depth", "normal_force", "normal_stiffness", "elastic_energy"
    found = [getattr(contact, name) for name in names]
    assert found == pytest.approx(values[:4], rel=1e-10, abs=0)
    assert fields.pressure(contact, 0.0)[0] == pytest.approx(values[4], rel=1e-9, abs=0)
    # A prescribed depth or force leads back to the radius.
    for name in names[:2]:
        again = layer.solve(profile, contact.material, **{name: getattr(contact, name)})
        assert again.contact_radius == pytest.approx(1, rel=1e-11, abs=0)


@pytest.mark.parametrize(
    ("base", "nu", "part", "stiffness"),
    [
        (BONDED, 0.3, 0.5, 3.248050826427),
        (BONDED, 0.5, 10, 505.796282957),
        (SLIDING, None, 1, 4.397242731332),
    ],
)
def test_stiffness_of_a_flat_punch(
    base: str, nu: float | None, part: float, stiffness: float
) -> None:
    contact = layer.solve(FlatPunch(1.0), _material(part, base, nu), indentation_depth=0.2)
    assert contact.normal_force == pytest.approx(0.2 * stiffness, rel=1e-10, abs=0)
    assert contact.elastic_energy == pytest.approx(0.02 * stiffness, rel=1e-10, abs=0)


def test_two_equal_bodies_and_units_of_micrometres() -> None:
    half = layer.solve(Paraboloid(1.0), _material(1, BONDED, 0.5, 0.5), contact_radius=1.0)
    values = half.indentation_depth, half.normal_force
    assert values == pytest.approx((0.817143800865, 1.559069932818), rel=1e-10, abs=0)
    gel = from_bodies(["rigid", Body(2e3, 0.5)], layer=Layer(4e-6))
    contact = layer.solve(Paraboloid(5e-6), gel, indentation_depth=1e-6)
    values = contact.contact_radius, contact.normal_force
    assert values == pytest.approx((2.82794292798e-06, 1.90928206748e-08), rel=1e-10, abs=0)


@pytest.mark.every(8)
@pytest.mark.parametrize("number", range(len(KINDS)))
def test_random_cases_with_thirty_digits(number: int) -> None:
    error, scene = random_layers.worst(54 + number, KINDS[number])
    assert error.error <= min(error.stated, random_layers.BOUND), (error, scene)


@pytest.mark.parametrize(
    "profile",
    [
        RoundedCone(0.5, 0.6),
        TruncatedCone(0.4, 0.3),
        Power(1.0, 0.4),
        Power(1.0, 40.0),
        Series((PowerTerm(1.0, 2.0), PowerTerm(0.3, 3.3))),
        Sphere(1.0),
    ],
)
@pytest.mark.parametrize("part", [0.05, 1.0, 8.0])
def test_stiffness_is_the_slope_of_the_force(profile: Profile, part: float) -> None:
    """dF_N = S dd and dU = F_N dd, by differences of sixth order."""
    material = _material(part, BONDED, 0.5)
    step = 1e-3
    radii = 0.8 * (1 + step * np.array([-3, -2, -1, 0, 1, 2, 3]))
    contact = layer.solve(profile, material, contact_radius=radii)
    rates = np.array([-1, 9, -45, 0, 45, -9, 1]) / (60 * step)
    depth, force, energy = (
        rates @ values
        for values in (contact.indentation_depth, contact.normal_force, contact.elastic_energy)
    )
    assert force / depth == pytest.approx(contact.normal_stiffness[3], rel=1e-8, abs=0)
    assert energy / depth == pytest.approx(contact.normal_force[3], rel=1e-8, abs=0)


def test_thick_layer_is_a_half_space() -> None:
    contact = layer.solve(Cone(0.2), _material(1e-30, BONDED, 0.3), normal_force=[0.0, 1e-3, 2.0])
    plain = normal.solve(Cone(0.2), 1.0, normal_force=[0.0, 1e-3, 2.0])
    for name in ("contact_radius", "indentation_depth", "normal_stiffness", "elastic_energy"):
        assert getattr(contact, name) == pytest.approx(getattr(plain, name), rel=1e-12, abs=0)


@pytest.mark.parametrize("unit", [1e-40, 1e40])
def test_results_in_any_unit_of_length(unit: float) -> None:
    one = layer.solve(Paraboloid(1.0), _material(2, BONDED, 0.4), indentation_depth=0.3)
    other = Material(1.0, layer=Layer(0.5 * unit, "bonded", 0.4))
    scaled = layer.solve(Paraboloid(unit), other, indentation_depth=0.3 * unit)
    assert scaled.contact_radius == pytest.approx(one.contact_radius * unit, rel=1e-12, abs=0)
    assert scaled.normal_force == pytest.approx(one.normal_force * unit**2, rel=1e-12, abs=0)


def test_adhesive_contact_and_its_pull_off() -> None:
    material = _material(1, BONDED, 0.5)
    contact = layer.solve(Paraboloid(1.0), material, contact_radius=1.0, work_of_adhesion=0.05)
    values = contact.indentation_depth, contact.normal_force
    assert values == pytest.approx((0.357222620316, 0.417301759423), rel=1e-10, abs=0)
    pull_off = float(contact.pull_off_force)
    # The pull-off is the least force of all contacts.
    radii = np.linspace(0.3, 1.2, 181)
    stable = layer.solve(
        Paraboloid(1.0), material, contact_radius=radii, work_of_adhesion=0.05
    ).normal_force
    assert pull_off <= stable.min()
    assert pull_off == pytest.approx(stable.min(), rel=1e-4, abs=0)
    with pytest.raises(InputError, match="pull-off"):
        layer.solve(Paraboloid(1.0), material, normal_force=1.001 * pull_off, work_of_adhesion=0.05)
    # On a thick layer the pull-off is that of a half-space, -(3/2) pi w R.
    thick = layer.solve(
        Paraboloid(1.0), _material(1e-9, BONDED, 0.5), normal_force=0.0, work_of_adhesion=0.05
    )
    assert thick.pull_off_force == pytest.approx(-1.5 * np.pi * 0.05, rel=1e-8, abs=0)


def test_many_adhesive_contacts_at_once_are_those_of_one_at_a_time() -> None:
    """Radii on both sides of h, and more of them than one block holds."""
    material = _material(1, BONDED, 0.5)
    radii = np.geomspace(0.4, 4.0, 61)
    many = layer.solve(Paraboloid(1.0), material, contact_radius=radii, work_of_adhesion=0.05)
    for i in range(0, radii.size, 12):
        one = layer.solve(Paraboloid(1.0), material, contact_radius=radii[i], work_of_adhesion=0.05)
        for name in ("normal_force", "indentation_depth", "maximum_pressure"):
            expected = float(getattr(one, name))
            assert getattr(many, name)[i] == pytest.approx(expected, rel=1e-11, abs=0)


@pytest.mark.parametrize("work", [None, 0.02])
def test_fields_carry_the_force(work: float | None) -> None:
    material = _material(2, BONDED, 0.4, 0.7)
    contact = layer.solve(Paraboloid(1.0), material, indentation_depth=[0.3], work_of_adhesion=work)
    a = float(contact.contact_radius[0])
    nodes, weights = np.polynomial.legendre.leggauss(400)
    angle = np.pi / 4 * (nodes + 1)
    r, rule = a * np.sin(angle), np.pi / 4 * weights * a * np.cos(angle)
    force = 2 * np.pi * rule @ (r * fields.pressure(contact, r)[0])
    assert force == pytest.approx(contact.normal_force[0], rel=1e-7, abs=0)
    line = 2 * rule @ fields.foundation_load(contact, r)[0]
    assert line == pytest.approx(contact.normal_force[0], rel=1e-7, abs=0)
    # The surface is continuous at the edge, and far away the other body's.
    near = fields.normal_displacement(contact, a * np.array([1 - 1e-12, 1 + 1e-12, 200.0]))[0]
    # With adhesion like a root.
    assert near[0] == pytest.approx(near[1], rel=1e-4, abs=0)
    point = 0.3 * contact.normal_force[0] / (np.pi * 200 * a)
    assert near[2] == pytest.approx(point, rel=1e-4, abs=0)


def test_largest_pressure_of_a_rounded_punch() -> None:
    contact = layer.solve(RoundedPunch(0.5, 1.0), _material(1, BONDED, 0.3), contact_radius=1.0)
    radii = np.linspace(0.3, 0.9, 40_001)
    highest = fields.pressure(contact, radii).max()
    assert contact.maximum_pressure == pytest.approx(highest, rel=1e-8, abs=0)
    assert contact.maximum_pressure > fields.pressure(contact, 0.0)[0]


@pytest.mark.long
def test_modulus_from_curves_with_noise() -> None:
    rng = np.random.default_rng(19)
    sample, ball = Layer(4e-6, "bonded", 0.5), Paraboloid(5e-6)
    depth = np.linspace(-0.5e-6, 1e-6, 300)
    exact = layer.solve(
        ball, Material(2.5e3, layer=sample), indentation_depth=np.maximum(depth - 1e-7, 0.0)
    ).normal_force
    clean = fit.solve(ball, indentation_depth=depth, normal_force=exact, layer=sample)
    assert clean.e_star == pytest.approx(2.5e3, rel=1e-9, abs=0)
    deviations = []
    for _ in range(20):
        force = exact + 1e-10 * rng.standard_normal(depth.size)
        found = fit.solve(ball, indentation_depth=depth, normal_force=force, layer=sample)
        deviations.append((found.e_star - 2.5e3) / found.standard_errors[0])
    assert np.abs(deviations).max() < 3.5
    assert abs(np.mean(deviations)) < 3.5 / sqrt(20)


@pytest.mark.parametrize(
    "profile", [Paraboloid(1.0), RoundedPunch(0.1, 1.0), FlatPunch(0.3), Cone(1.0)]
)
def test_interpolated_curve_agrees_with_the_equation(profile: Profile) -> None:
    sample = Layer(0.3, "bonded", 0.5)
    curve = layer.DepthCurve.up_to(profile, sample, 0.3)
    depth = np.linspace(1e-4, 0.3, 40)
    force, stiffness = curve(depth)
    exact = layer.solve(profile, Material(1.0, layer=sample), indentation_depth=depth)
    bound = max(curve.error, 1e-12)
    assert bound < 2e-8
    # A fit compares forces with the largest one.
    largest = exact.normal_force[-1], exact.normal_stiffness[-1]
    assert force == pytest.approx(exact.normal_force, rel=0, abs=bound * largest[0])
    assert stiffness == pytest.approx(exact.normal_stiffness, rel=0, abs=1e-7 * largest[1])


@pytest.mark.parametrize("exponent", [0.05, 0.1, 0.2, 0.5, 2.0, 20.0, 40.0, 60.0, 100.0])
def test_error_of_the_interpolated_curve_covers_all_powers(exponent: float) -> None:
    profile, sample = Power(1.0, exponent), Layer(0.3, "bonded", 0.5)
    end = float(normal.solve(profile, 1.0, contact_radius=0.6).indentation_depth)
    curve = layer.DepthCurve.up_to(profile, sample, end)
    depth = end * np.append(np.linspace(0.02, 1.0, 50), np.geomspace(1e-6, 0.01, 10))
    exact = layer.solve(profile, Material(1.0, layer=sample), indentation_depth=depth)
    missed = curve(depth)[0] - exact.normal_force
    assert np.abs(missed).max() <= curve.error * exact.normal_force.max()
    assert curve.error < 1e-4


@pytest.mark.parametrize("part", [1e-2, 1e-5, 1e-9])
def test_curve_may_end_just_beyond_a_break(part: float) -> None:
    profile, sample = SphericalTipCone(1e-3, 1.0), Layer(1e-3, BONDED, 0.3)
    curve = layer.DepthCurve(profile, sample, profile.breaks[0] * (1 + part))
    force, _ = curve(np.array([curve.deepest / 2, curve.deepest]))
    material = Material(1.0, layer=sample)
    exact = layer.solve(profile, material, indentation_depth=[curve.deepest / 2, curve.deepest])
    assert force == pytest.approx(exact.normal_force, rel=1e-8, abs=0)


def test_contact_of_a_needle_is_that_of_a_half_space() -> None:
    # Its radius is 1e-120 of the thickness.
    needle, sample = Power(1.0, 0.05), Layer(1.0, "bonded", 0.4)
    contact = layer.solve(needle, Material(1.0, layer=sample), indentation_depth=1e-6)
    thick = normal.solve(needle, 1.0, indentation_depth=1e-6)
    for name in ("contact_radius", "normal_force", "normal_stiffness"):
        assert getattr(contact, name) == pytest.approx(getattr(thick, name), rel=1e-12, abs=0)


def test_layers_are_rejected_where_they_do_not_combine() -> None:
    material = _material(1, BONDED, 0.3)
    for solve in (normal.solve,):
        with pytest.raises(InputError, match="computed with in normal"):
            solve(Paraboloid(1.0), material, indentation_depth=0.1)
    contact = layer.solve(Paraboloid(1.0), material, indentation_depth=0.1)
    with pytest.raises(InputError, match="half-space"):
        tangential.solve(contact, 1.0, 0.3, stick_radius=0.1)
    with pytest.raises(InputError, match="poissons_ratio"):
        layer.solve(Paraboloid(1.0), _material(1, BONDED, None), indentation_depth=0.1)
    with pytest.raises(InputError, match="10 times the thickness"):
        layer.solve(Paraboloid(1.0), _material(20, BONDED, 0.3), contact_radius=1.0)
    with pytest.raises(InputError, match="10 times the thickness"):
        layer.solve(Paraboloid(1.0), _material(20, BONDED, 0.3), normal_force=100.0)
    for work in (0.5, 10.0):
        for load in ({"contact_radius": 0.6}, {"normal_force": 0.0}):
            with pytest.raises(
                InputError, match=r"radius 0\.5, where it exceeds 10 times the thickness"
            ):
                layer.solve(Cone(1.0), _material(20, BONDED, 0.3), work_of_adhesion=work, **load)
    # The flat alone is too large.
    with pytest.raises(InputError, match="1/10 of the radius of the flat face"):
        layer.solve(RoundedPunch(2.0, 1.0), _material(20, BONDED, 0.3), normal_force=1.0)
    with pytest.raises(InputError, match="exclude each other"):
        Material(1.0, body_thickness=1.0, layer=Layer(1.0, "frictionless"))


def test_strain_and_radial_error_on_a_thin_incompressible_layer() -> None:
    """Finite elements give the force -0.32 a/R and -0.88 a/R at a/h = 1 and 2."""
    gel = from_bodies(["rigid", Body(1.0, 0.5)], layer=Layer(1.0))
    contact = layer.solve(Paraboloid(1e3), gel, contact_radius=[1.0, 2.0])
    assert contact.model_error == pytest.approx([0.32e-3, 2 * 0.88e-3], rel=0.15, abs=0)
    assert contact.warnings == ()
    (steep,) = layer.solve(Cone(0.05), gel, contact_radius=[1.0, 2.0]).warnings[:1]
    # 0.32 x 4/(1 + 0.114 x 4) times the slope, and its square.
    assert steep.value == pytest.approx(0.05 * 0.32 * 4 / 1.456 + 0.05**2, rel=1e-12, abs=0)
    assert "flat layer has an estimated error of 4.6 %, mainly from the neglected radial" in (
        steep.message
    )
    deep = layer.solve(Paraboloid(1.0), _material(1, BONDED, 0.5), indentation_depth=0.2)
    assert "layer_strain" in {notice.code for notice in deep.warnings}


def test_table_at_zero_load_on_a_layer_has_no_invalid_numbers() -> None:
    r = np.linspace(0, 1, 41)
    contact = layer.solve(
        Tabulated(r, r * r / 2), _material(1, BONDED, 0.3), indentation_depth=[0.0, 0.01]
    )
    # NumPy reports 0/0 as a warning, which is an error in tests.
    assert contact.warnings
    assert contact.normal_force[0] == 0
