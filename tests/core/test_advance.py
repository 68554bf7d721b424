"""A path in single steps has the results of the path as a whole, at every step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from mdr_core import history
from tests.core.comparison import profile_from
from tests.core.test_history_paths import (
    DEPTH,
    FULL_SLIP,
    MATERIAL,
    PROFILES,
    every_profile,
    random_path,
    solve,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

NAMES = (
    "normal_force",
    "tangential_force",
    "elastic_energy",
    "tangential_energy",
    "dissipation",
    "contact_radius",
)


def in_turn(order: int) -> tuple[Array, Array]:
    """Slow cycles, whose steps are far smaller than the loads that they change."""
    phase = np.linspace(0.0, 9.0, 200)
    d = DEPTH * (0.7 + 0.25 * np.sin(phase * order))
    return d, 0.4 * FULL_SLIP * np.sin(2 * phase)


PATHS = {"random": random_path(17), "slow": in_turn(1), "crossing": in_turn(3)}


@pytest.mark.parametrize("path", PATHS)
@every_profile
def test_single_steps_equal_the_whole_path_at_every_step(name: str, path: str) -> None:
    d, u = PATHS[path]
    whole = solve(name, indentation_depth=d, tangential_displacement=u)
    state = history.unloaded(
        profile_from(PROFILES[name]), MATERIAL.e_star, MATERIAL.g_star, MATERIAL.mu
    )
    for i, end in enumerate(zip(d.tolist(), u.tolist(), strict=True)):
        state = history.advance(state, *end)
        for quantity in NAMES:
            values = getattr(whole, quantity)
            near = pytest.approx(values[i], rel=1e-12, abs=1e-13 * np.max(np.abs(values)))
            assert getattr(state, quantity) == near, (i, quantity)
    assert np.array_equal(state.polyline.vertices, whole.state.polyline.vertices)


@every_profile
def test_many_contacts_have_the_states_of_each(name: str) -> None:
    paths = [random_path(seed, 12) for seed in range(6)]
    start = history.unloaded(
        profile_from(PROFILES[name]), MATERIAL.e_star, MATERIAL.g_star, MATERIAL.mu
    )
    states = history.advance_many(start, np.full(6, -1.0), 0.0)
    single = [history.advance(start, -1.0, 0.0)] * 6
    assert not states.normal_force.any()
    for d, u in zip(*(np.transpose(each) for each in zip(*paths, strict=True)), strict=True):
        states = history.advance_many(states, d, u)
        single = list(map(history.advance, single, d.tolist(), u.tolist()))
        for quantity in ("normal_force", "tangential_force"):
            values = np.array([getattr(each, quantity) for each in single])
            near = pytest.approx(values, rel=1e-12, abs=1e-13 * np.max(np.abs(values)))
            assert getattr(states, quantity) == near, quantity
    for one, other in zip(states, single, strict=True):
        assert np.array_equal(one.polyline.vertices, other.polyline.vertices)
        assert one.dissipation == pytest.approx(other.dissipation, rel=1e-12, abs=0)
    assert states[-1].tangential_displacement == single[-1].tangential_displacement
    again = history.advance_many(single[0], d[1:3], u[1:3])
    assert again.tangential_force[1] == pytest.approx(
        history.advance(single[0], d[2], u[2]).tangential_force, rel=1e-12, abs=0
    )


@pytest.mark.parametrize(
    ("depth", "displacement"),
    [([0.1, np.nan], 0.0), ([0.1, 0.1], np.inf), ([0.1, 0.1, 0.1], 0.0), ([0.1, 3.0], 0.0)],
)
def test_many_contacts_take_finite_depths_up_to_the_end(depth: object, displacement: float) -> None:
    table = {"kind": "tabulated", "r": [0.0, 0.5, 1.0, 1.5], "f": [0.0, 0.125, 0.5, 1.125]}
    start = history.unloaded(profile_from(table), 1.0, 1.0, 0.3)
    states = history.advance_many(start, [0.1, 0.1], 0.0)
    with pytest.raises(ValueError, match=r"finite|beyond radius 1\.5|one for each of 2"):
        history.advance_many(states, depth, displacement)
    assert not history.advance_many(start, [], 0.0).normal_force.size


@pytest.mark.parametrize("asked", ["always", "at the end"])
def test_results_do_not_depend_on_what_earlier_states_were_asked(asked: str) -> None:
    d, u = random_path(4)
    first = state = history.unloaded(
        profile_from(PROFILES["sphere"]), MATERIAL.e_star, MATERIAL.g_star, MATERIAL.mu
    )
    for end in zip(d.tolist(), u.tolist(), strict=True):
        first, state = history.advance(first, *end), history.advance(state, *end)
        if asked == "always":
            state.values()
    for name, value in first.values().items():
        assert np.array_equal(state.values()[name], value), name
