"""A path under controls of different pairs equals the path of one pair through its samples."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mdr_core import history, normal
from mdr_core.controls import default_samples
from mdr_core.errors import InputError
from mdr_core.profiles import FlatPunch, Paraboloid, Sphere, Tabulated
from tests.core.comparison import EPS, profile_from
from tests.core.test_history_paths import MATERIAL, PROFILES, every_profile
from tests.core.test_laws import cases

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mdr_core.profiles import Profile

    Array = NDArray[np.float64]

E, G, MU = MATERIAL.e_star, MATERIAL.g_star, MATERIAL.mu
DEPTH = 0.25
SHIFT = MU * E / G
#: Results that both paths have, with those that are prescribed in one of them alone.
QUANTITIES = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "tangential_displacement",
    "tangential_force",
    "tangential_energy",
    "dissipated_energy",
)
MIXED = [
    ("indentation_depth", "tangential_force"),
    ("normal_force", "tangential_displacement"),
]
every_pair = pytest.mark.parametrize("controls", MIXED, ids=["depth, force", "force, displacement"])
every_number = pytest.mark.parametrize("samples", [1, 2, 7, 20])


def solve(profile: Profile, **controls: Any) -> history.LoadHistory:
    return history.solve(profile, E, G, MU, **controls)


def force_of(profile: Profile, depth: Any) -> Array:
    return np.asarray(normal.solve(profile, E, indentation_depth=depth).normal_force)


def random_points(
    profile: Profile, controls: tuple[str, str], seed: int, deepest: float = DEPTH
) -> dict[str, Array]:
    """Points within friction, some of equal normal load; the first one carries a load."""
    rng, (pressed, pushed) = np.random.default_rng(seed), controls
    depth = rng.uniform(0.35, 1.0, 9) * deepest
    depth[4], depth[7] = depth[3], depth[6]
    if pushed == "tangential_displacement":
        moved = rng.uniform(-1.2, 1.2, 9) * SHIFT * deepest
        return {pressed: force_of(profile, depth), pushed: moved}
    # At no depth on the way to a point does the force exceed friction.
    limit = MU * float(force_of(profile, 0.35 * deepest))
    return {pressed: depth, pushed: rng.uniform(-1.0, 1.0, 9) * limit}


def of_one_pair(path: history.LoadHistory, per_step: int) -> dict[str, Array]:
    """Points of the same path under depths and displacements, or under both forces.

    The first step is one straight line, whatever its samples.
    """
    pair = ("indentation_depth", "tangential_displacement")
    if path.path.over_forces:
        pair = ("normal_force", "tangential_force")
    return {name: getattr(path, name)[per_step - 1 :] for name in pair}


def require_path_through_samples(profile: Profile, points: dict[str, Array], samples: int) -> None:
    mixed = solve(profile, **points, samples_per_step=samples)
    pair = solve(profile, **of_one_pair(mixed, samples))
    for quantity in QUANTITIES:
        found, expected = getattr(mixed, quantity)[samples - 1 :], getattr(pair, quantity)
        bound = 1e-9 * np.max(np.abs(expected))
        assert found == pytest.approx(expected, rel=0, abs=bound), quantity
    assert mixed.regime[samples - 1 :].tolist() == pair.regime.tolist()
    for quantity in ("depth", "load"):
        found, expected = (getattr(each.state, quantity) for each in (mixed, pair))
        assert found == pytest.approx(expected, rel=0, abs=1e-9 * np.max(np.abs(expected)))


@every_pair
@every_profile
@pytest.mark.parametrize("samples", [1, 2, 3, 8])
def test_samples_decide_the_path(name: str, controls: tuple[str, str], samples: int) -> None:
    """Forces, displacements and energies are equal, the work of friction included."""
    profile = profile_from(PROFILES[name])
    require_path_through_samples(profile, random_points(profile, controls, samples), samples)


@every_pair
@settings(derandomize=True, deadline=None, max_examples=60)
@given(case=cases(), seed=st.integers(0, 2**32 - 1), samples=st.integers(1, 6))
def test_samples_decide_the_path_of_a_random_contact(
    controls: tuple[str, str], case: tuple[dict[str, Any], float], seed: int, samples: int
) -> None:
    profile, radius = profile_from(case[0]), case[1]
    deepest = float(normal.solve(profile, E, contact_radius=radius).indentation_depth)
    points = random_points(profile, controls, seed, deepest)
    require_path_through_samples(profile, points, samples)


@every_pair
@pytest.mark.parametrize("seed", range(4))
def test_samples_decide_the_path_on_a_rough_table(controls: tuple[str, str], seed: int) -> None:
    rng, r = np.random.default_rng(seed), np.linspace(0.0, 1.0, 60)
    heights = np.maximum.accumulate(r * r / 2 * (1 + 0.03 * rng.standard_normal(r.size)))
    profile = Tabulated(r, heights)
    points = random_points(profile, controls, seed, 0.9 * float(profile.depth(profile.domain)))
    require_path_through_samples(profile, points, 1 + seed)


@every_pair
@every_number
def test_samples_are_even_in_the_controls(controls: tuple[str, str], samples: int) -> None:
    """This holds also if only one control changes; the first step is straight."""
    profile = Paraboloid(1.3)
    points = random_points(profile, controls, 5)
    path = solve(profile, **points, samples_per_step=samples)
    share = np.arange(1, samples + 1) / samples
    for name, values in points.items():
        found = getattr(path, name).reshape(-1, samples)
        even = values[:-1, None] + np.diff(values)[:, None] * share
        assert found[1:] == pytest.approx(even, rel=1e-14, abs=1e-15 * np.max(np.abs(values)))


@every_number
@pytest.mark.parametrize("ratio", [1.0, 0.5, 1e-2, 1e-6, -0.5])
@every_profile
def test_first_point_carries_a_tangential_force(name: str, ratio: float, samples: int) -> None:
    """Proportional forces stick: u_x = (F_x/F_N) (E*/G*) d, Eq. (5.71)."""
    profile = profile_from(PROFILES[name])
    limit = MU * float(force_of(profile, DEPTH))
    path = solve(
        profile,
        indentation_depth=DEPTH,
        tangential_force=[ratio * limit],
        samples_per_step=samples,
    )
    depth = DEPTH * np.arange(1, samples + 1) / samples
    # The slope of the polyline has the rounding error of its sums.
    rel = 1e-12 + 4 * EPS / abs(ratio)
    assert path.tangential_displacement == pytest.approx(ratio * SHIFT * depth, rel=rel, abs=0)
    expected = ratio * MU * force_of(profile, depth)
    assert path.tangential_force == pytest.approx(expected, rel=1e-12, abs=0)
    assert set(path.regime) == {"stick"}
    assert path.dissipation == pytest.approx(0, abs=1e-15 * limit * DEPTH)
    load = ratio * MU * E * (DEPTH - path.state.depth)
    assert path.state.load == pytest.approx(load, rel=0, abs=rel * abs(load[0]))
    assert path.slip_fronts.size == 0


@every_pair
def test_state_after_the_first_point_does_not_depend_on_samples(controls: tuple[str, str]) -> None:
    """The first step is the straight line from zero load to its point."""
    profile = Paraboloid(1.3)
    first = {name: row[:1] for name, row in random_points(profile, controls, 6).items()}
    one, many = (solve(profile, **first, samples_per_step=number) for number in (1, 9))
    for quantity in QUANTITIES:
        expected = getattr(one, quantity)[-1]
        assert getattr(many, quantity)[-1] == pytest.approx(expected, rel=1e-13, abs=0), quantity
    for quantity in ("depth", "load"):
        expected = getattr(one.state, quantity)
        found = getattr(many.state, quantity)
        assert found == pytest.approx(expected, rel=0, abs=1e-15 * np.max(np.abs(expected)))


@pytest.mark.parametrize("samples", [1, 2, 3, 4, 5, 20])
@pytest.mark.parametrize("profile", [FlatPunch(1.0), Paraboloid(1.0)])
@pytest.mark.parametrize(
    ("depth", "force", "at"),
    [
        ([-0.3, 1.0], [0.0, -0.01], 1),
        ([1.0, -0.3], [0.01, 0.0], 1),
        ([-0.3], [0.01], 0),
        ([1.0, -1e-9, 1.0], [0.0, 0.0, 1e-9], 2),
    ],
)
def test_force_at_a_gap_is_refused(
    profile: Profile, samples: int, depth: list[float], force: list[float], at: int
) -> None:
    """There is no equilibrium at the moment of contact, for any number of samples."""
    with pytest.raises(InputError, match="add a point in contact without the force") as error:
        solve(profile, indentation_depth=depth, tangential_force=force, samples_per_step=samples)
    assert error.value.path == ("history", "tangential", "tangential_force", at)


@every_number
@every_pair
@pytest.mark.parametrize(("points", "at"), [([2e3, 1e3], 0), ([1e-3, 2e3], 1)])
def test_load_beyond_the_profile_is_refused_at_its_point(
    points: list[float], at: int, controls: tuple[str, str], samples: int
) -> None:
    """A sphere of radius 1 has no contact beyond its equator."""
    pressed, pushed = controls
    scale = 1.0 if pressed == "indentation_depth" else E
    loads = {pressed: np.multiply(points, scale), pushed: np.zeros(2)}
    with pytest.raises(InputError, match="would extend beyond radius") as error:
        solve(Sphere(1.0), **loads, samples_per_step=samples)
    assert error.value.path == ("history", "normal", pressed, at)


@every_number
def test_point_in_contact_without_the_force_makes_it_possible(samples: int) -> None:
    """The gap closes first: u_x = F_x/(2 G* a) of a punch that sticks, Eq. (5.1)."""
    path = solve(
        FlatPunch(1.0),
        indentation_depth=[-0.3, 1.0, 1.0, 1.0, -0.3],
        tangential_force=[0.0, 0.0, -0.01, 0.0, 0.0],
        samples_per_step=samples,
    )
    found = path.tangential_displacement[samples - 1 :: samples]
    assert found == pytest.approx(
        [0.0, 0.0, -0.01 / (2 * G), 0.0, 0.0], rel=1e-13, abs=4 * EPS * SHIFT
    )
    assert path.regime[-1] == "no_contact"


def test_force_above_friction_between_points_is_refused_on_the_curve() -> None:
    """Halfway to zero load a paraboloid has lost 65 % of F_N, and half of F_x."""
    points = {"indentation_depth": [1.0, 0.0], "tangential_force": [0.9 * MU * 4 / 3 * E, 0.0]}
    assert solve(Paraboloid(1.0), **points).regime.tolist() == ["stick", "no_contact"]
    with pytest.raises(InputError, match="change the two loads in turn") as error:
        solve(Paraboloid(1.0), **points, samples_per_step=2)
    assert error.value.path == ("history", "tangential", "tangential_force", 1)


@pytest.mark.parametrize("name", ["flat-punch"])
@every_pair
def test_every_path_of_a_flat_punch_is_straight(name: str, controls: tuple[str, str]) -> None:
    """Depth and normal force are in proportion: the number of samples changes nothing."""
    profile = profile_from(PROFILES[name])
    points = random_points(profile, controls, 7)
    one, many = (solve(profile, **points, samples_per_step=number) for number in (1, 6))
    for quantity in ("tangential_displacement", "tangential_force", "dissipated_energy"):
        expected = getattr(one, quantity)
        found = getattr(many, quantity)[5::6]
        assert found == pytest.approx(expected, rel=0, abs=1e-13 * np.max(np.abs(expected)))


@pytest.mark.parametrize("tangential", ["tangential_force", "tangential_displacement"])
@pytest.mark.parametrize("pressed", ["normal_force", "indentation_depth"])
@pytest.mark.parametrize("amplitude", [0.0, 0.2])
def test_default_samples_of_cycles(tangential: str, pressed: str, amplitude: float) -> None:
    """Energy and stiffness are exact on straight steps, and within 1 % on curves."""
    profile, load = Paraboloid(1.0), {"normal_force": 4 / 3 * E, "indentation_depth": 1.0}[pressed]
    small = 0.4 * MU * (4 / 3 * E if tangential == "tangential_force" else E / G)
    given: dict[str, Any] = {pressed: load, tangential: small, "normal_amplitude": amplitude * load}
    loop = history.cycles(profile, E, G, MU, **given, count=2)
    fine = history.cycles(profile, E, G, MU, **given, count=2, samples_per_step=400)
    curved = amplitude > 0 and (pressed, tangential) in MIXED
    assert default_samples(pressed, tangential) == (20 if (pressed, tangential) in MIXED else 1)
    assert loop.step.size == 6 * (20 if curved else 1)
    bound = 1e-2 if curved else 1e-11
    for name in ("energy_per_cycle", "secant_stiffness"):
        assert getattr(loop, name) == pytest.approx(getattr(fine, name), rel=bound, abs=0), name
