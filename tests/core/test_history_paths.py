"""Each spring carries what the slip memory determines, under displacements and under forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import history, normal
from tests.core.comparison import profile_from, stored
from tests.oracles import history_reference
from tests.oracles.slip_reference import WORK_DIGITS, Material

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MATERIAL = Material(3.7, 2.9, 0.37)
DEPTH = 0.25
#: Tangential displacement at the onset of full slip.
FULL_SLIP = MATERIAL.mu * MATERIAL.e_star / MATERIAL.g_star * DEPTH
PROFILES: dict[str, dict[str, Any]] = stored("profiles")["histories"]
every_profile = pytest.mark.parametrize("name", PROFILES)


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


@every_profile
def test_state_matches_each_spring(name: str) -> None:
    """q_x of springs that are followed one by one, including corners."""
    for steps in (1, 2, 7, 50):
        d, u = random_path(4, steps)
        d[-1] = abs(d[-1])
        state = solve(name, indentation_depth=d, tangential_displacement=u).state
        path = list(zip(d.tolist(), u.tolist(), strict=True))
        first_contact = np.linspace(0.0, 0.999 * d[-1], 40)
        with mp.workdps(WORK_DIGITS):
            followed = [history_reference.follow(mpf(w), path, MATERIAL) for w in first_contact]
        load = np.array([float(spring.load[-1]) for spring in followed])
        result = np.interp(first_contact, state.depth, state.load)
        size = MATERIAL.mu * MATERIAL.e_star * DEPTH
        assert result == pytest.approx(load, rel=1e-12, abs=1e-13 * size)
        assert state.depth[0] == 0
        assert state.depth[-1] == state.indentation_depth
        assert state.indentation_depth == pytest.approx(d[-1], rel=1e-14, abs=0)
        assert np.all(np.diff(state.depth) > 0)


@pytest.mark.parametrize("name", ["sphere", "paraboloid", "truncated-cone"])
def test_springs_bear_the_prescribed_forces(name: str) -> None:
    """The exact history for the computed depths and displacements has the prescribed forces."""
    random, profile = np.random.default_rng(8), profile_from(PROFILES[name])
    d = DEPTH * random.uniform(0.05, 1.0, 6)
    force = normal.solve(profile, MATERIAL.e_star, indentation_depth=d).normal_force
    along = random.uniform(-0.95, 0.95, 6) * MATERIAL.mu * force
    result = solve(name, normal_force=force, tangential_force=along)
    path = zip(result.indentation_depth, result.tangential_displacement, strict=True)
    borne = history_reference.history(PROFILES[name], list(path), MATERIAL)
    exact = np.array([float(sample.tangential_force) for sample in borne])
    assert exact == pytest.approx(along, rel=0, abs=1e-12 * np.max(np.abs(along)))
    assert result.tangential_force == pytest.approx(along, rel=1e-12, abs=0)
    assert result.normal_force == pytest.approx(force, rel=1e-12, abs=0)
