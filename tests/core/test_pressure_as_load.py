"""A prescribed largest pressure gives the contact that has it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_core import normal
from mdr_core.errors import InputError
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    FlatPunch,
    Hyperboloid,
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
    TwoSpheres,
)

if TYPE_CHECKING:
    from collections.abc import Callable

R = np.linspace(0.0, 1.0, 11)
FINITE: list[tuple[Profile, list[float]]] = [
    (Power(0.7, 1.5), [1e-9, 0.3, 2.0]),
    (Power(0.7, 4.0), [1e-9, 0.3, 2.0]),
    (Sphere(1.0), [1e-9, 0.5, 0.7, 0.99]),
    (TwoSpheres((1.0, -1.01)), [1e-9, 0.3, 0.6, 0.84]),
    (Hyperboloid(0.4, 1.3), [1e-9, 0.5, 30.0]),
    (RoundedPunch(0.5, 2.0), [0.5001, 0.6, 2.0]),
    (RoundedCone(0.3, 1.0), [0.1, 0.31, 2.0]),
    (CappedParaboloid(0.5, 3.0, 1.1), [0.1, 0.45]),
]


@pytest.mark.parametrize(("profile", "radii"), FINITE, ids=lambda each: getattr(each, "kind", ""))
@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e30])
def test_pressure_of_a_contact_leads_back_to_it(
    profile: Profile, radii: list[float], scale: float
) -> None:
    known = normal.solve(profile, scale, contact_radius=radii)
    found = normal.solve(profile, scale, maximum_pressure=known.maximum_pressure)
    assert found.maximum_pressure.tolist() == known.maximum_pressure.tolist()
    for name in ("contact_radius", "indentation_depth", "normal_force"):
        error = np.abs(getattr(found, name) / getattr(known, name) - 1).max()
        assert error <= found.error_estimate < 1e-10, name


@pytest.mark.parametrize(
    "kind",
    [
        lambda size: RoundedPunch(size, 2 * size),
        lambda size: RoundedCone(0.3, size),
        lambda size: SphericalTipCone(1.0, size),
        lambda size: Hyperboloid(0.4, size),
        lambda size: Series((PowerTerm(1 / size, 2.0), PowerTerm(1 / size**3, 4.0))),
        Paraboloid,
        lambda size: CappedParaboloid(size, 3 * size, 2 * size),
    ],
)
@pytest.mark.parametrize("size", [1e-9, 5e-8, 1.0, 5e4])
def test_unit_of_length_does_not_matter(kind: Any, size: float) -> None:
    p = np.array([0.0, 1e-16, 1e-6, 0.05, 0.1])
    expected = normal.solve(kind(1.0), 1.0, maximum_pressure=p).contact_radius
    found = normal.solve(kind(size), 1.0, maximum_pressure=p).contact_radius
    assert found == pytest.approx(size * expected, rel=1e-11, abs=0)
    assert normal.solve(kind(size), 1.0, maximum_pressure=1e-16).contact_radius == found[1]


def test_hertz() -> None:
    """F_N = pi^3 R^2 p^3/(6 E*^2), a = pi R p/(2 E*)."""
    p = np.array([0.0, 1e-9, 0.05])
    contact = normal.solve(Paraboloid(2.0), 3.0, maximum_pressure=p)
    assert contact.contact_radius == pytest.approx(np.pi * 2 * p / 6, rel=1e-14, abs=0)
    assert contact.normal_force == pytest.approx(np.pi**3 * 4 * p**3 / 54, rel=1e-13, abs=0)


@pytest.mark.parametrize(
    "profile",
    [lambda size: Power(size, 3.0), lambda size: RoundedPunch(0.5, size)],
    ids=["power", "rounded_punch"],
)
def test_cases_of_a_sweep_are_contacts_alone(profile: Callable[[Any], Profile]) -> None:
    """The first contact coordinate of a search does not depend on these parameters."""
    sizes, pressures = np.array([1.0, 2.0, 4.0]), np.array([0.01, 0.02, 0.03])
    many = normal.solve(profile(sizes), 2.0, maximum_pressure=pressures)
    alone = [
        normal.solve(profile(size), 2.0, maximum_pressure=pressure).contact_radius
        for size, pressure in zip(sizes.tolist(), pressures.tolist(), strict=True)
    ]
    np.testing.assert_allclose(many.contact_radius, alone, rtol=1e-13)


def test_pressure_of_a_blunt_cone_grows_with_the_logarithm_of_the_radius() -> None:
    """p = (E*/pi) int_0^a dg/x, by the antiderivative of the cone beyond its tip."""
    slope, tip, a = 0.1, 1.0, 1.3131993827466e7
    b = slope * tip
    # g' = slope arccos(b/x) + (2/R)(x - sqrt(x^2 - b^2)), and the integral of g'/x is elementary.
    u = np.linspace(0.0, 1.0, 200_001)[1:] * np.log(a / b)
    x = b * np.exp(u)
    inner = 2 * b / tip
    beyond = slope * np.arccos(b / x) + 2 * (x - np.sqrt((x - b) * (x + b))) / tip
    start = 2 * b / tip
    outer = (beyond.sum() - beyond[-1] / 2 + start / 2) * (u[1] - u[0])
    found = normal.solve(RoundedCone(slope, tip), 1.0, maximum_pressure=(inner + outer) / np.pi)
    assert found.contact_radius == pytest.approx(a, rel=1e-3, abs=0)


@pytest.mark.parametrize("slope", [0.3, 2.0, 30.0])
def test_cone_far_beyond_its_spherical_tip_adds_a_logarithm(slope: float) -> None:
    """The largest pressure grows by E* (slope/2) ln(a_2/a_1), with a relative error of b/a."""
    radii = [1e7, 1e9, 1e30]
    contact = normal.solve(SphericalTipCone(slope, 1.0), 1.0, contact_radius=radii)
    expected = slope / 2 * np.diff(np.log(radii))
    assert np.diff(contact.maximum_pressure) == pytest.approx(expected, rel=1e-6, abs=0)
    back = normal.solve(contact.profile, 1.0, maximum_pressure=contact.maximum_pressure)
    assert np.abs(back.contact_radius / radii - 1).max() <= back.error_estimate < 1e-10


@pytest.mark.parametrize(
    ("profile", "pressure", "reason"),
    [
        (Cone(0.1), 1.0, "infinite under any load"),
        (FlatPunch(1.0), 1.0, "infinite under any load"),
        (TruncatedCone(0.5, 0.1), 1.0, "infinite under any load"),
        (Power(1.0, 0.8), 1.0, "infinite under any load"),
        (Tabulated(R, R * R), 0.1, "points of a table"),
        (CappedParaboloid(0.5, 3.0, 1.1), [0.01, 0.2], "at radius 0.5 it is infinite"),
        (TwoSpheres((1.0, -1.01)), 1.0, "60 degrees of the ball"),
        (Sphere(1.0), 1e9, "beyond radius"),
        # slope/2 ln(2e150/b) and a constant of the tip are the pressure at radius 1e150.
        (RoundedCone(0.1, 1.0), 1e3, r"at most 17\.4 E\*: check the units"),
        (Hyperboloid(0.1, 1.0), 1e3, r"at most 17\.4 E\*: check the units"),
        (SphericalTipCone(2.0, 1.0), [10.0, 1e3], r"at most 347 E\*: check the units"),
        (RoundedCone(0.1, 1.0), 15.0, "leaves the range of double precision"),
        (Paraboloid(1.0), -1.0, "must not be negative"),
        (Paraboloid(1.0), np.inf, "must be finite"),
    ],
)
def test_pressures_that_no_contact_has(profile: Profile, pressure: Any, reason: str) -> None:
    with pytest.raises(InputError, match=reason) as caught:
        normal.solve(profile, 1.0, maximum_pressure=pressure)
    assert caught.value.path[:2] == ("load", "maximum_pressure")
