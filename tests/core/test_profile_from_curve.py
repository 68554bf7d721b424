"""The profile behind a curve of force over depth is found from the curve."""

import numpy as np
import pytest

import mdr_core as mdr
from mdr_core.profiles import Profile

#: Profiles with their largest depth, and the error that 200 points leave.
SHAPES: dict[str, tuple[Profile, float, float]] = {
    "sphere": (mdr.Sphere(1.0), 0.5, 1e-6),
    "hyperboloid": (mdr.Hyperboloid(0.4, 0.3), 0.5, 1e-6),
    "paraboloid": (mdr.Paraboloid(1.0), 0.3, 1e-11),
    "cone": (mdr.Cone(0.3), 0.3, 1e-11),
    "power": (mdr.Power(0.5, 3.3), 0.3, 1e-6),
    "rounded cone": (mdr.RoundedCone(0.4, 0.3), 0.3, 1e-6),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_force_of_the_profile_is_that_of_the_curve(shape: str) -> None:
    profile, end, error = SHAPES[shape]
    depth = end * np.linspace(0.0, 1.0, 201)[1:]
    force = mdr.normal.solve(profile, 2.0, indentation_depth=depth).normal_force
    found = mdr.Tabulated.from_force_depth(depth, force, 2.0)
    loads = end * np.array([0.1, 0.3, 0.7, 0.99])
    curves = [mdr.normal.solve(each, 2.0, indentation_depth=loads) for each in (found, profile)]
    assert curves[0].normal_force == pytest.approx(curves[1].normal_force, rel=error, abs=0)
    radii = found.domain * np.array([0.2, 0.5, 0.9])
    assert found.f(radii) == pytest.approx(profile.f(radii), rel=error, abs=0)


@pytest.mark.parametrize("unit", [1e-9, 1e6])
def test_change_of_units(unit: float) -> None:
    depth = 0.3 * np.linspace(0.0, 1.0, 51)[1:]
    force = mdr.normal.solve(mdr.Hyperboloid(0.4, 0.3), 2.0, indentation_depth=depth).normal_force
    one = mdr.Tabulated.from_force_depth(depth, force, 2.0)
    other = mdr.Tabulated.from_force_depth(unit * depth, unit**2 * force, 2.0)
    assert other.r == pytest.approx(unit * one.r, rel=1e-10, abs=0)
    assert other.values == pytest.approx(unit * one.values, rel=1e-9, abs=0)


@pytest.mark.parametrize(
    ("depth", "force", "name"),
    [
        ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 3.0, 6.0, 9.0], "depth"),
        ([1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 3.0, 2.0, 6.0, 9.0], "force"),
        ([1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 3.0, 6.0], "force"),
        # The slope falls.
        ([1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 3.0, 6.0, 7.0, 7.5], "force"),
    ],
)
def test_curves_of_no_profile_are_refused(
    depth: list[float], force: list[float], name: str
) -> None:
    with pytest.raises(mdr.InputError) as error:
        mdr.Tabulated.from_force_depth(depth, force, 1.0)
    assert error.value.path[0] == name
