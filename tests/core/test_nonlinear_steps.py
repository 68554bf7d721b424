"""A nonlinear load step would differ from many straight steps."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest

from mdr_core import history, normal
from mdr_core.profiles import Cone, Paraboloid, RoundedPunch, Sphere, Tabulated, TruncatedCone

if TYPE_CHECKING:
    from mdr_core.profiles import Profile
    from mdr_core.typing import Array

MU = 0.3


def by_straight_steps(
    profile: Profile, force: Array, displacement: Array, number: int
) -> dict[str, Array]:
    """Results of steps in force and displacement, by many straight ones in depth and displacement.

    Their points lie on the same path and cluster at the ends of each step.
    """
    share = np.sin(np.linspace(0.0, np.pi / 2, number + 1)[1:]) ** 2
    edges = [0.0, *normal.solve(profile, 1.0, normal_force=force).coordinate]
    place = np.concatenate([a + (b - a) * share for a, b in pairwise(edges)])
    begin = np.repeat([0.0, *force[:-1]], number)
    rise = np.repeat(np.diff([0.0, *force]), number)
    time = np.repeat(np.arange(force.size), number) + (profile.reduced_force(place) - begin) / rise
    exact = history.solve(
        profile,
        1.0,
        1.0,
        MU,
        indentation_depth=profile.depth(place),
        tangential_displacement=np.interp(time, np.arange(force.size + 1), [0.0, *displacement]),
    )
    names = "tangential_force", "tangential_energy", "dissipated_energy"
    return {name: getattr(exact, name)[number - 1 :: number] for name in names}


@pytest.mark.every(4)
@pytest.mark.parametrize("seed", [8, 13, 22, 52])
def test_estimate_of_nonlinear_steps_on_a_rough_table(seed: int) -> None:
    random = np.random.default_rng(seed)
    r = np.linspace(0.0, 1.0, 60)
    f = np.maximum.accumulate(r * r / 2 * (1 + 0.03 * random.standard_normal(r.size)))
    profile = Tabulated(r, f)
    most = float(profile.reduced_force(np.array(profile.domain)))
    force = most * random.uniform(0.2, 0.9, 4)
    displacement = float(np.max(profile.domain)) ** 2 * random.uniform(-0.1, 0.1, 4)
    found = history.solve(
        profile, 1.0, 1.0, MU, normal_force=force, tangential_displacement=displacement
    )
    assert found.error_estimate < 1e-3
    for name, expected in by_straight_steps(profile, force, displacement, 8_192).items():
        # The straight steps leave an error below 1e-8.
        bound = (found.error_estimate + 1e-8) * np.max(np.abs(expected))
        assert getattr(found, name) == pytest.approx(expected, rel=0, abs=bound)


@pytest.mark.every(3)
@pytest.mark.parametrize("profile", [Paraboloid(1.0), Cone(0.5)])
@pytest.mark.parametrize("seed", range(3))
def test_nonlinear_steps_are_extrapolated(profile: Profile, seed: int) -> None:
    """Chords alone leave more than 1e-7."""
    random = np.random.default_rng(seed)
    force = random.uniform(0.3, 1.0, 4)
    depth = profile.depth(profile.coordinate_from_reduced_force(force))
    displacement = MU * depth * random.uniform(-0.8, 0.8, 4)
    found = history.solve(
        profile, 1.0, 1.0, MU, normal_force=force, tangential_displacement=displacement
    )
    assert found.error_estimate < 1e-7
    for name, expected in by_straight_steps(profile, force, displacement, 16_384).items():
        bound = 1e-8 * np.max(np.abs(expected))
        assert getattr(found, name) == pytest.approx(expected, rel=0, abs=bound)


@pytest.mark.parametrize(
    ("profile", "force", "displacement"),
    [
        (RoundedPunch(0.1612653, 3.0808771), (0.07528385, 0.02148123), -0.11708062),
        (Sphere(1.74840936), (0.01861400606, 0.00629701709), -0.04838392),
        (TruncatedCone(0.43572878, 0.44140809), (0.0382279085, 0.1244092), 0.3194804),
    ],
)
def test_estimate_of_a_nonlinear_step_into_full_slip(
    profile: Profile, force: tuple[float, float], displacement: float
) -> None:
    """Full slip begins anywhere on a chord, with an irregular error."""
    moved = np.array([0.0, MU * displacement])
    found = history.solve(profile, 1.0, 1.0, MU, normal_force=force, tangential_displacement=moved)
    assert found.regime[-1] == "full_slip"
    assert found.error_estimate < 1e-4
    for name, expected in by_straight_steps(profile, np.array(force), moved, 8_192).items():
        # The straight steps leave an error below 1e-8.
        bound = (found.error_estimate + 1e-8) * np.max(np.abs(expected))
        assert getattr(found, name) == pytest.approx(expected, rel=0, abs=bound)


@pytest.mark.parametrize("before", [1, 10_001])
def test_chords_of_a_short_load_step_do_not_depend_on_straight_ones(before: int) -> None:
    profile, force, moved = Paraboloid(1.0), np.array([1.0, 1.01]), np.array([0.0, 0.003])
    loads = np.append(1.0 - 0.1 * (np.arange(before) % 2), 1.01)
    slid = np.append(np.zeros(before), 0.003)
    found = history.solve(profile, 1.0, 1.0, MU, normal_force=loads, tangential_displacement=slid)
    assert found.error_estimate < 1e-5
    for name, expected in by_straight_steps(profile, force, moved, 4_096).items():
        assert getattr(found, name)[-1] == pytest.approx(expected[-1], rel=1e-6, abs=0)
