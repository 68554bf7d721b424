"""A path in single steps has the results of the path as a whole, at every step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from mdr_core import history
from mdr_core.history.slip_layout import STEP
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
    """Slow cycles, whose steps are far smaller than what they add to."""
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
    assert np.array_equal(
        state.polyline.vertices[:, :STEP], whole.state.polyline.vertices[:, :STEP]
    )


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
