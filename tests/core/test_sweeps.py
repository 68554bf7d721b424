"""A case in a sweep has the results that it has alone."""

from typing import Any

import numpy as np
import pytest

from mdr_core import fields, normal, tangential
from mdr_core.errors import InputError
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Ellipsoid,
    FlatPunch,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedCone,
    RoundedPunch,
    Sphere,
    SphericalTipCone,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr_core.typing import Array

MANY = 2055
PLACE = 1029
E_STAR = 1.1e11


def test_parameter_grid_equals_its_flattened_copy() -> None:
    R, force = np.linspace(0.01, 0.02, 300)[:, None], np.linspace(1.0, 2.0, 400)[None, :]
    grid = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    flat_R, flat_force = (part.ravel() for part in np.broadcast_arrays(R, force))
    flat = normal.solve(Paraboloid(flat_R), E_STAR, normal_force=flat_force)
    assert grid.contact_radius.shape == (300, 400)
    assert np.array_equal(grid.contact_radius.ravel(), flat.contact_radius)
    assert np.array_equal(grid.indentation_depth.ravel(), flat.indentation_depth)


@pytest.mark.parametrize("wrong", [-1.0, np.nan, np.inf])
@pytest.mark.parametrize("control", ["normal_force", "indentation_depth", "contact_radius"])
def test_invalid_load_is_rejected_with_its_index(control: str, wrong: float) -> None:
    loads = np.full(MANY, 1e-3)
    loads[PLACE] = wrong
    given: dict[str, Any] = {control: loads}
    with pytest.raises(InputError) as refused:
        normal.solve(Paraboloid(np.full(MANY, 0.01)), E_STAR, **given)
    assert refused.value.path == ("load", control, PLACE)


@pytest.mark.parametrize("load", [0.0, 1.0])
@pytest.mark.parametrize("wrong", [-1.0, 0.0, np.nan, np.inf])
@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
def test_invalid_modulus_is_rejected(control: str, wrong: float, load: float) -> None:
    moduli, loads = np.full(MANY, E_STAR), np.full(MANY, load)
    moduli[PLACE] = wrong
    given: dict[str, Any] = {control: loads}
    with pytest.raises(InputError) as refused:
        normal.solve(Paraboloid(0.01), moduli, **given)
    assert refused.value.path == ("material", "e_star")


# Parameters of a few cases for every kind that accepts arrays.
RANDOM = np.random.default_rng(7)
FEW = 40


def spread(low: float, high: float) -> Array:
    return 10 ** RANDOM.uniform(low, high, FEW)


KINDS: dict[str, tuple[type[Profile], dict[str, Array]]] = {
    "cone": (Cone, {"slope": spread(-2, 0)}),
    "paraboloid": (Paraboloid, {"radius": spread(-3, 0)}),
    "sphere": (Sphere, {"radius": spread(-2, 0)}),
    "ellipsoid": (Ellipsoid, {"radius": spread(-2, 0), "height": spread(-2, 0)}),
    "hyperboloid": (Hyperboloid, {"slope": spread(-2, 0), "tip_radius": spread(-3, 0)}),
    "flat_punch": (FlatPunch, {"radius": spread(-3, 0)}),
    "rounded_punch": (
        RoundedPunch,
        {"flat_radius": spread(-4, -2), "rounding_radius": spread(-3, 0)},
    ),
    "truncated_cone": (TruncatedCone, {"flat_radius": spread(-4, -2), "slope": spread(-2, 0)}),
    "truncated_paraboloid": (
        TruncatedParaboloid,
        {"flat_radius": spread(-4, -2), "radius": spread(-3, 0)},
    ),
    # Includes exponents for which NumPy does not use its power function.
    "power": (
        Power,
        {
            "coefficient": spread(-1, 1),
            "exponent": np.append([0.5, 1.0, 1.5, 2.0, 3.0], RANDOM.uniform(0.2, 8.0, FEW - 5)),
        },
    ),
    "rounded_cone": (RoundedCone, {"slope": spread(-2, 0), "tip_radius": spread(-3, 0)}),
    "spherical_tip_cone": (
        SphericalTipCone,
        {"slope": spread(-2, 0), "tip_radius": spread(-3, 0)},
    ),
    "capped_paraboloid": (
        CappedParaboloid,
        {"cap_radius": spread(-4, -2), "tip_radius": spread(-1, 1), "radius": spread(-3, -1)},
    ),
}
MODULI, SHEAR_MODULI, FRICTION = spread(9, 12), spread(9, 12), spread(-1, 0)
# Loads include zero, one at its limit and one beyond it.
LOADS = {
    "normal_force": np.append(0.0, spread(-3, 1)[1:]),
    "indentation_depth": np.append(0.0, spread(-9, -5)[1:]),
}
PART = np.concatenate([[0.0, 0.0, 0.5], RANDOM.uniform(0.001, 0.999, FEW - 4), [-0.7]])
NORMAL = (
    "contact_radius",
    "indentation_depth",
    "normal_force",
    "mean_pressure",
    "normal_stiffness",
    "elastic_energy",
)
TANGENTIAL = (
    "tangential_force",
    "tangential_displacement",
    "stick_radius",
    "slip_width",
    "tangential_stiffness",
)

# For other kinds the dissipated energy takes a fraction of a millisecond per case.
CLOSED_ENERGIES = {"cone", "paraboloid", "flat_punch"}


def repeated(values: Array) -> Array:
    """The few cases over and over."""
    return np.resize(values, MANY)


@pytest.mark.every(3)
@pytest.mark.parametrize("control", LOADS)
@pytest.mark.parametrize("kind", KINDS)
def test_sweep_is_bit_identical_to_single_cases(kind: str, control: str) -> None:
    profile, named = KINDS[kind]
    sweep = normal.solve(
        profile(**{name: repeated(values) for name, values in named.items()}),
        repeated(MODULI),
        **{control: repeated(LOADS[control])},  # type: ignore[arg-type]
    )
    singles = [
        normal.solve(
            profile(**{name: float(values[i]) for name, values in named.items()}),
            float(MODULI[i]),
            **{control: float(LOADS[control][i])},  # type: ignore[arg-type]
        )
        for i in range(FEW)
    ]
    for name in NORMAL:
        alone = np.array([getattr(single, name) for single in singles])
        assert np.array_equal(getattr(sweep, name), repeated(alone)), name
    for tangential_control, limit in (
        ("tangential_force", FRICTION * [one.normal_force for one in singles]),
        (
            "tangential_displacement",
            FRICTION * MODULI / SHEAR_MODULI * [one.indentation_depth for one in singles],
        ),
    ):
        loads = PART * limit
        tangential_load = tangential.solve(
            sweep,
            repeated(SHEAR_MODULI),
            repeated(FRICTION),
            **{tangential_control: repeated(loads)},  # type: ignore[arg-type]
        )
        alone_sideways = [
            tangential.solve(
                singles[i],
                float(SHEAR_MODULI[i]),
                float(FRICTION[i]),
                **{tangential_control: float(loads[i])},  # type: ignore[arg-type]
            )
            for i in range(FEW)
        ]
        for name in (*TANGENTIAL, *(["dissipated_energy"] if kind in CLOSED_ENERGIES else [])):
            alone = np.array([getattr(one, name) for one in alone_sideways])
            assert np.array_equal(getattr(tangential_load, name), repeated(alone)), name


@pytest.mark.parametrize("kind", sorted(KINDS.keys() - CLOSED_ENERGIES))
def test_dissipated_energy_of_a_sweep_is_bit_identical_to_single_cases(kind: str) -> None:
    profile, named = KINDS[kind]
    force = LOADS["normal_force"]
    sweep = normal.solve(profile(**named), MODULI, normal_force=force)
    tangential_contact = FRICTION * force * np.abs(PART)
    result = tangential.solve(sweep, SHEAR_MODULI, FRICTION, tangential_force=tangential_contact)
    for i in range(FEW):
        own = profile(**{name: float(values[i]) for name, values in named.items()})
        alone = tangential.solve(
            normal.solve(own, float(MODULI[i]), normal_force=float(force[i])),
            float(SHEAR_MODULI[i]),
            float(FRICTION[i]),
            tangential_force=float(tangential_contact[i]),
        )
        assert result.dissipated_energy[i] == alone.dissipated_energy, i


def test_sweep_over_all_regimes_equals_single_cases() -> None:
    contact = normal.solve(Paraboloid(0.01), E_STAR, normal_force=np.full(MANY, 10.0))
    loads = np.linspace(-2.0, 2.0, MANY)
    result = tangential.solve(contact, 0.9e11, 0.3, tangential_displacement=loads * 1e-6)
    one = normal.solve(Paraboloid(0.01), E_STAR, normal_force=10.0)
    for i in (0, MANY // 2, MANY - 1):
        alone = tangential.solve(one, 0.9e11, 0.3, tangential_displacement=loads[i] * 1e-6)
        assert result.regime[i] == alone.regime
        for name in (*TANGENTIAL, "dissipated_energy"):
            assert getattr(result, name)[i] == getattr(alone, name), name


@pytest.mark.parametrize("control", ["tangential_force", "tangential_displacement"])
@pytest.mark.parametrize("profile", [Paraboloid(0.01), Cone(0.1), FlatPunch(0.01)])
def test_each_case_has_its_own_error_estimate(profile: Any, control: str) -> None:
    contact = normal.solve(profile, 1e11, indentation_depth=1e-5)
    limits = tangential.solve(contact, 8e10, 0.3, tangential_displacement=1.0)
    limit = limits.limiting_force if control == "tangential_force" else 0.3 * 1e-5 * 1e11 / 8e10
    loads = float(limit) * np.array([0.0, 0.5, 0.95, 1 - 1e-6, 1 - 1e-10])
    together = tangential.solve(contact, 8e10, 0.3, **{control: loads})
    alone = [tangential.solve(contact, 8e10, 0.3, **{control: load}) for load in loads]
    estimates = np.broadcast_to(together.error_estimates, loads.shape)
    assert estimates.tolist() == [each.error_estimate for each in alone]
    assert together.error_estimate == max(each.error_estimate for each in alone)


@pytest.mark.parametrize("control", ["tangential_force", "tangential_displacement"])
def test_flags_hold_for_their_case_alone(control: str) -> None:
    """Sign and full slip are single values where no case differs."""
    contact = normal.solve(Paraboloid(0.01), E_STAR, normal_force=10.0)
    limit = tangential.solve(contact, 0.9e11, 0.3, stick_radius=0.0)
    loads = np.full(MANY, 0.5 * float(getattr(limit, control)))
    loads[PLACE] *= -2
    result = tangential.solve(contact, 0.9e11, 0.3, **{control: loads})
    beyond = np.arange(MANY) == PLACE
    assert np.array_equal(result.full_slip, beyond)
    assert np.array_equal(result.sign, np.where(beyond, -1.0, 1.0))
    assert np.array_equal(result.tangential_force < 0, beyond)


def test_prescribed_stick_radius_below_a_computed_edge() -> None:
    """There the width follows from the contact coordinate, which the radius does not resolve."""
    force = np.full(MANY, 2.2 * E_STAR)
    contact = normal.solve(Sphere(1.0), E_STAR, normal_force=force)
    few = normal.solve(Sphere(1.0), E_STAR, normal_force=force[:5])
    stick = np.nextafter(few.contact_radius, 0.0)
    whole = tangential.solve(contact, 0.8 * E_STAR, 0.3, stick_radius=np.resize(stick, MANY))
    part = tangential.solve(few, 0.8 * E_STAR, 0.3, stick_radius=stick)
    # By rounding error, the coordinate of the smaller radius may be the larger one.
    expected = np.maximum(few.coordinate - few.profile.coordinate_from_radius(stick), 0.0)
    assert np.array_equal(part.width, expected)
    assert np.array_equal(whole.width[:5], expected)
    assert np.array_equal(whole.tangential_force[:5], part.tangential_force)


@pytest.mark.parametrize("field", [fields.pressure, fields.foundation_load])
def test_fields_of_many_moduli(field: Any) -> None:
    """The field of each load has its own modulus, also where there are as many radii as loads."""
    moduli, forces, radii = np.array([1.0, 2.0]), np.array([0.1, 0.3]), [0.0, 0.1]
    many = field(normal.solve(Paraboloid(1.0), moduli, normal_force=forces), radii)
    for row, e_star, force in zip(many, moduli, forces, strict=True):
        depth = (9 * force**2 / (16 * e_star**2)) ** (1 / 3)
        if field is fields.pressure:
            expected = 2 * e_star / np.pi * np.sqrt(depth - np.square(radii))
        else:
            expected = e_star * (depth - np.square(radii))
        assert row == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.parametrize("profile", [TruncatedCone(0.05, 0.2), RoundedPunch(0.05, 2.0)])
def test_foundation_load_of_a_flat_at_the_onset_of_its_load(profile: Profile) -> None:
    """The springs of the flat carry the whole depth, whether a radius resolves the contact."""
    depths = np.array([0.0, float(profile.depth(np.float64(1e-30))), 1e-3])
    contact = normal.solve(profile, 3.0, indentation_depth=depths)
    load = fields.foundation_load(contact, [0.0, 0.03])
    assert load == pytest.approx(3.0 * depths[:, None] * np.ones(2), rel=1e-12, abs=0)
