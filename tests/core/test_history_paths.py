"""Random paths of fifty load steps against 100,000 springs, under every control."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_core import history
from tests.core.comparison import profile_from
from tests.oracles import springs
from tests.oracles.slip_reference import Material

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MATERIAL = Material(3.7, 2.9, 0.37)
DEPTH = 0.25
#: Tangential displacement at the onset of full slip.
FULL_SLIP = MATERIAL.mu * MATERIAL.e_star / MATERIAL.g_star * DEPTH
SPRINGS = 100_000
#: Error limit with `SPRINGS` springs; ten times fewer have at most a hundred times the error.
SPRING_ERROR = 1e-9
PROFILES: dict[str, dict[str, Any]] = {
    "paraboloid": {"kind": "paraboloid", "radius": 1.3},
    "cone": {"kind": "cone", "slope": 0.3},
    "power0.7": {"kind": "power", "coefficient": 0.7, "exponent": 0.7},
    "power4": {"kind": "power", "coefficient": 0.4, "exponent": 4.0},
    "series": {
        "kind": "series",
        "terms": [{"coefficient": 0.2, "exponent": 1.0}, {"coefficient": 0.3, "exponent": 3.0}],
    },
    "sphere": {"kind": "sphere", "radius": 1.5},
    "rounded-punch": {"kind": "rounded_punch", "flat_radius": 0.6, "rounding_radius": 2.0},
    "truncated-cone": {"kind": "truncated_cone", "flat_radius": 0.6, "slope": 0.3},
    "rounded-cone": {"kind": "rounded_cone", "slope": 0.3, "tip_radius": 1.7},
    "capped-paraboloid": {
        "kind": "capped_paraboloid",
        "cap_radius": 0.4,
        "tip_radius": 3.0,
        "radius": 1.1,
    },
    "flat-punch": {"kind": "flat_punch", "radius": 0.5},
}
every_profile = pytest.mark.parametrize("name", PROFILES)
NAMES = ("normal_force", "tangential_force", "tangential_energy", "dissipated_energy")


def solve(name: str, **controls: Any) -> history.LoadHistory:
    profile = profile_from(PROFILES[name])
    return history.solve(profile, MATERIAL.e_star, MATERIAL.g_star, MATERIAL.mu, **controls)


def random_path(seed: int, steps: int = 50) -> tuple[Array, Array]:
    """Includes separations and some purely normal or purely tangential load steps."""
    random = np.random.default_rng(seed)
    d, u = random.uniform(-0.15, 1.0, steps) * DEPTH, random.uniform(-1.2, 1.2, steps) * FULL_SLIP
    for step, kind in enumerate(random.integers(0, 6, steps)):
        if step and kind == 0:
            d[step] = d[step - 1]
        elif step and kind == 1:
            u[step] = u[step - 1]
    return d, u


def largest_difference(result: Any, reference: Any) -> float:
    """Largest difference, each relative to the largest value of its kind."""
    return max(
        float(
            np.max(np.abs(getattr(result, name) - getattr(reference, name)))
            / np.max(np.abs(getattr(reference, name)))
        )
        for name in NAMES
    )


@pytest.mark.every(4)
@every_profile
def test_fifty_load_steps_match_the_springs(name: str) -> None:
    d, u = random_path(1)
    assert np.any(d[5:-5] <= 0)
    result = solve(name, indentation_depth=d, tangential_displacement=u)
    errors = []
    for count in (SPRINGS // 100, SPRINGS // 10, SPRINGS):
        foundation = springs.foundation(PROFILES[name], float(np.max(d)), count)
        errors.append(largest_difference(result, springs.simulate(foundation, MATERIAL, d, u)))
    assert errors[-1] <= SPRING_ERROR, errors
    if name != "flat-punch":
        # The difference is the error of the springs and converges accordingly, by up to a hundred.
        assert errors[1] < errors[0] / 25, errors
        assert errors[2] < errors[1] / 25, errors


@pytest.mark.parametrize("name", ["paraboloid", "truncated-cone"])
def test_samples_within_a_load_step_match_the_springs(name: str) -> None:
    d, u = random_path(3, 20)
    result = solve(name, indentation_depth=d, tangential_displacement=u, samples_per_step=4)
    at = np.arange(1, 81) / 4
    fine_d = np.interp(at, np.arange(21), np.append(0.0, d))
    fine_u = np.interp(at, np.arange(21), np.append(0.0, u))
    assert result.indentation_depth == pytest.approx(fine_d, rel=1e-13, abs=1e-15)
    assert result.tangential_displacement == pytest.approx(fine_u, rel=1e-13, abs=1e-15)
    foundation = springs.foundation(PROFILES[name], float(np.max(d)), SPRINGS)
    assert (
        largest_difference(result, springs.simulate(foundation, MATERIAL, fine_d, fine_u))
        <= SPRING_ERROR
    )


@every_profile
def test_state_matches_each_spring(name: str) -> None:
    """q_x spring by spring, including corners."""
    for steps in (1, 2, 7, 50):
        d, u = random_path(4, steps)
        d[-1] = abs(d[-1])
        state = solve(name, indentation_depth=d, tangential_displacement=u).state
        foundation = springs.foundation(PROFILES[name], float(np.max(d)), 2000)
        load = springs.simulate(foundation, MATERIAL, d, u).load
        inside = foundation.first_contact_depth < d[-1]
        result = np.interp(foundation.first_contact_depth[inside], state.depth, state.load)
        size = MATERIAL.mu * MATERIAL.e_star * DEPTH
        assert result == pytest.approx(load[inside], rel=1e-12, abs=1e-13 * size)
        assert state.depth[0] == 0
        assert state.depth[-1] == state.indentation_depth
        assert state.indentation_depth == pytest.approx(d[-1], rel=1e-14, abs=0)
        assert np.all(np.diff(state.depth) > 0)


def force_path(name: str, steps: int, normal: str, tangential: str) -> dict[str, Array]:
    """A path under given controls; forces stay within the friction limit on every load step."""
    random = np.random.default_rng(8)
    d = random.uniform(0.05, 1.0, steps) * DEPTH
    foundation = springs.foundation(PROFILES[name], DEPTH, 20_000)
    force = springs.simulate(foundation, MATERIAL, d, np.zeros(steps)).normal_force
    # With linear depth, the force stays below its linear interpolation.
    part = 0.95 if normal == "normal_force" else 0.3
    least = force if normal == "normal_force" else np.minimum(force, np.append(0, force[:-1]))
    loads = {
        "tangential_force": random.uniform(-part, part, steps) * MATERIAL.mu * least,
        "tangential_displacement": random.uniform(-1.0, 1.0, steps) * FULL_SLIP,
    }
    for load in loads.values():
        # Pure normal loading first: depth grows like a root of the force, which chords resolve
        # poorly.
        load[0] = 0.0
    forward = {"normal_force": force, "indentation_depth": d}
    return {normal: forward[normal], tangential: loads[tangential]}


@pytest.mark.every(6)
@pytest.mark.parametrize(
    ("name", "normal", "tangential"),
    [
        ("paraboloid", "normal_force", "tangential_force"),
        ("paraboloid", "normal_force", "tangential_displacement"),
        ("paraboloid", "indentation_depth", "tangential_force"),
        ("truncated-cone", "normal_force", "tangential_force"),
        ("truncated-cone", "normal_force", "tangential_displacement"),
        ("sphere", "normal_force", "tangential_force"),
    ],
)
def test_springs_reproduce_the_prescribed_forces(name: str, normal: str, tangential: str) -> None:
    """The springs follow nonlinear load paths in (d, u) as ever shorter chords."""
    controls = force_path(name, 4, normal, tangential)
    foundation = springs.foundation(PROFILES[name], DEPTH, 20_000)
    errors = []
    for samples in (8, 32):
        result = solve(name, **controls, samples_per_step=samples)
        ends = slice(samples - 1, None, samples)
        for control, given in controls.items():
            assert getattr(result, control)[ends] == pytest.approx(given, rel=1e-12, abs=0), control
        reference = springs.simulate(
            foundation, MATERIAL, result.indentation_depth, result.tangential_displacement
        )
        errors.append(largest_difference(result, reference))
        line = np.arange(1, 4 * samples + 1) / samples
        for control, given in controls.items():
            straight = np.interp(line, np.arange(5), np.append(0.0, given))
            size = np.max(np.abs(straight))
            assert getattr(result, control) == pytest.approx(straight, rel=1e-11, abs=1e-12 * size)
            borne = getattr(reference, control, straight)
            assert borne == pytest.approx(straight, rel=0, abs=size / samples)
    # The error of a chord is of second order in its length.
    assert errors[1] < errors[0] / 6 or errors[1] < 1e-7, errors
    assert errors[1] < 1e-3, errors
