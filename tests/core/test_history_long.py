"""100,000 steps: errors do not accumulate, and erased slip memory has no effect."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp

from mdr_core import history
from tests.core.comparison import profile_from
from tests.core.test_history_paths import DEPTH, FULL_SLIP, MATERIAL, PROFILES, solve
from tests.oracles import slip_reference as slip

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

STEPS = 100_000
#: Number of steps between two erasing steps.
BATCH = 1000
#: Displacement of the erasing step, as a fraction of full slip.
TOP = 0.8
SIZE = MATERIAL.mu * MATERIAL.e_star * DEPTH
chosen = pytest.mark.parametrize("name", ["paraboloid", "truncated-cone"])


def random_path(seed: int, steps: int = STEPS) -> tuple[Array, Array]:
    """Pure normal loading, random points, and (DEPTH, TOP) after each batch of them.

    At (DEPTH, TOP) the springs with g > (1 - TOP) DEPTH slip forward whatever their history,
    provided that the others have stuck since the last batch. They have, if d - |u| in the path's
    units stays above its value there.
    """
    random = np.random.default_rng(seed)
    spare = 1.001 * (1 - TOP)
    d = random.uniform(0.25, 1.15, steps)
    u = random.uniform(-1.0, 1.0, steps) * (d - spare)
    d[0], u[0] = 1.0, 0.0
    d[BATCH - 1 :: BATCH], u[BATCH - 1 :: BATCH] = 1.0, TOP
    return d * DEPTH, u * FULL_SLIP


@chosen
def test_erasing_step_ends_on_the_curve_of_first_loading(name: str) -> None:
    d, u = random_path(3)
    result = solve(name, indentation_depth=d, tangential_displacement=u)
    with mp.workdps(slip.WORK_DIGITS):
        at = slip.setting(PROFILES[name], "indentation_depth", DEPTH, MATERIAL)
    # The path's own rounded double.
    exact = slip.solve(at, "tangential_displacement", float(u[BATCH - 1]), energy=False)
    expected = float(exact.values["tangential_force"])
    returned = result.tangential_force[BATCH - 1 :: BATCH]
    assert returned.size == STEPS // BATCH
    assert returned == pytest.approx(np.full(returned.size, expected), rel=1e-12, abs=0)


@chosen
def test_results_after_an_erasing_step_are_independent_of_the_past(name: str) -> None:
    d, u = random_path(4, STEPS // 5)
    result = solve(name, indentation_depth=d, tangential_displacement=u)
    for batch in (1, 10, 19):
        part = slice(batch * BATCH, (batch + 1) * BATCH)
        fresh = solve(
            name,
            indentation_depth=np.concatenate([[DEPTH, DEPTH], d[part]]),
            tangential_displacement=np.concatenate([[0.0, u[BATCH - 1]], u[part]]),
        )
        most = MATERIAL.mu * np.max(fresh.normal_force)
        expected = pytest.approx(fresh.tangential_force[2:], rel=0, abs=1e-12 * most)
        assert result.tangential_force[part] == expected
        dissipated = pytest.approx(fresh.dissipation[2:], rel=1e-9, abs=1e-12 * most * FULL_SLIP)
        assert result.dissipation[part] == dissipated


def spring_shear(d: Array, u: Array, first_contact_depth: Array) -> Array:
    """q_x of springs stored by zero-force displacement, without accumulation and without drift."""
    compliance = MATERIAL.mu * MATERIAL.e_star / MATERIAL.g_star
    zero_force = np.zeros_like(first_contact_depth)
    last_d = last_u = 0.0
    for new_d, new_u in zip(d.tolist(), u.tolist(), strict=True):
        if new_d > last_d:
            entering = (first_contact_depth >= last_d) & (first_contact_depth < new_d)
            share = (first_contact_depth - last_d) / (new_d - last_d)
            zero_force = np.where(entering, last_u + share * (new_u - last_u), zero_force)
        reach = compliance * np.maximum(new_d - first_contact_depth, 0.0)
        zero_force = np.clip(zero_force, new_u - reach, new_u + reach)
        last_d, last_u = new_d, new_u
    return np.where(first_contact_depth < last_d, MATERIAL.g_star * (last_u - zero_force), 0.0)


@pytest.mark.parametrize("name", ["paraboloid", "flat-punch"])
def test_final_state_equals_that_of_drift_free_springs(name: str) -> None:
    """Without erasing steps; the contact separates occasionally."""
    random = np.random.default_rng(5)
    d = random.uniform(-0.002, 1.0, STEPS // 4) * DEPTH
    u = random.uniform(-0.3, 0.3, STEPS // 4) * FULL_SLIP
    d[-1] = DEPTH / 2
    state = solve(name, indentation_depth=d, tangential_displacement=u).state
    first_contact_depth = (
        np.linspace(0.0, 0.999 * d[-1], 97) if name != "flat-punch" else np.zeros(1)
    )
    result = np.interp(first_contact_depth, state.depth, state.load)
    assert result == pytest.approx(spring_shear(d, u, first_contact_depth), rel=0, abs=1e-12 * SIZE)
    assert state.depth.size <= 64


def test_slip_memory_stays_short() -> None:
    d, u = random_path(6, 3000)
    fields = PROFILES["paraboloid"]
    state = history.unloaded(profile_from(fields), MATERIAL.e_star, MATERIAL.g_star, MATERIAL.mu)
    longest = 0
    for point in zip(d.tolist(), u.tolist(), strict=True):
        state = history.advance(state, *point)
        longest = max(longest, state.depth.size)
    assert longest <= 64
    whole = solve("paraboloid", indentation_depth=d, tangential_displacement=u)
    assert state.depth == pytest.approx(whole.state.depth, rel=1e-12, abs=0)
