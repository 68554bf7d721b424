"""Histories obey the laws of friction, energy, symmetry and units."""

from __future__ import annotations

import contextlib
import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial.legendre import Legendre

from mdr_core import history, normal
from mdr_core.profiles import Paraboloid
from tests.core.comparison import profile_from
from tests.core.test_history_paths import PROFILES
from tests.core.test_laws import E_STAR, at_radius, cases, rescaled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Case = tuple[dict[str, Any], float]

G_STAR = 2.9
MU = 0.37
SHIFT = MU * E_STAR / G_STAR
#: Gauss-Lobatto rule: it includes the panel ends, so that no kink hides between two panels.
#: Newer versions of NumPy return real roots as complex numbers.
NODES = np.concatenate([[-1.0], Legendre.basis(6).deriv().roots().real, [1.0]])
WEIGHTS = 2 / (42 * Legendre.basis(6)(NODES) ** 2)
LAST = np.stack([Legendre.basis(n)(NODES) * WEIGHTS for n in (4, 5)], axis=1)

repeatable = settings(derandomize=True, deadline=None, max_examples=50)
few = settings(derandomize=True, deadline=None, max_examples=8)

#: Fractions of the largest depth, separations included, and of the full-slip displacement. They are
#: multiples of a step, so that depths and displacements often repeat.
push = st.integers(-26, 26).map(lambda n: n / 20)
point = st.tuples(st.integers(-5, 32).map(lambda n: n / 32), push)
contact = st.tuples(st.integers(2, 32).map(lambda n: n / 32), push)
paths = st.lists(point, min_size=1, max_size=9)
loops = st.lists(contact, min_size=2, max_size=6)


def near(value: Any, absolute: float = 0.0, rel: float = 1e-12) -> Any:
    return pytest.approx(value, rel=rel, abs=absolute)


def controls(case: Case, path: list[tuple[float, float]]) -> tuple[Array, Array, float]:
    """Depths, displacements, and the depth to which both are scaled."""
    depth = float(at_radius(*case).indentation_depth)
    d, u = np.array(path).T
    return d * depth, u * SHIFT * depth, depth


def solve(case: Case, d: Array, u: Array, **options: Any) -> history.LoadHistory:
    return history.solve(
        profile_from(case[0]),
        E_STAR,
        G_STAR,
        MU,
        indentation_depth=d,
        tangential_displacement=u,
        **options,
    )


@repeatable
@given(cases(), paths)
def test_friction_limit_and_slip_regime(case: Case, path: list[tuple[float, float]]) -> None:
    d, u, _ = controls(case, path)
    result = solve(case, d, u, samples_per_step=5)
    limit = MU * result.normal_force
    size = np.max(limit, initial=0.0)
    assert np.all(np.abs(result.tangential_force) <= limit + 1e-13 * size)
    sliding = result.regime == "full_slip"
    assert np.abs(result.tangential_force[sliding]) == near(limit[sliding], 1e-13 * size)
    assert np.array_equal(result.regime == "no_contact", result.indentation_depth <= 0)
    for name in ("normal_force", "tangential_force", "tangential_energy", "elastic_energy"):
        assert not getattr(result, name)[result.regime == "no_contact"].any(), name


@repeatable
@given(cases(), paths)
def test_normal_problem_is_independent_of_tangential_loading(
    case: Case, path: list[tuple[float, float]]
) -> None:
    d, u, _ = controls(case, path)
    result = solve(case, d, u)
    alone = normal.solve(profile_from(case[0]), E_STAR, indentation_depth=np.maximum(d, 0.0))
    touching = d > 0
    for name in ("normal_force", "contact_radius", "elastic_energy"):
        assert getattr(result, name)[touching] == near(getattr(alone, name)[touching]), name


@repeatable
@given(cases(), paths)
def test_dissipated_energy_never_decreases(case: Case, path: list[tuple[float, float]]) -> None:
    result = solve(case, *controls(case, path)[:2], samples_per_step=5)
    assert np.all(result.dissipation >= 0)
    assert np.all(np.diff(result.dissipated_energy) >= 0)
    assert np.all(result.tangential_energy >= 0)
    total = result.dissipated_energy[-1]
    assert np.cumsum(result.dissipation) == near(result.dissipated_energy, 1e-14 * total)


@repeatable
@given(cases(), loops)
def test_repeated_loop_closes_and_dissipates(case: Case, loop: list[tuple[float, float]]) -> None:
    """Each load step clips the springs' loads. Clipping is idempotent: the second round repeats."""
    d, u, depth = controls(case, loop * 3)
    result = solve(case, d, u)
    count = len(loop)
    size = MU * np.max(result.normal_force)
    force, stored = result.tangential_force, result.tangential_energy
    assert force[count : 2 * count] == near(force[2 * count :], 1e-12 * size)
    energy = size * SHIFT * depth
    assert stored[count : 2 * count] == near(stored[2 * count :], 1e-12 * energy)
    dissipated = result.dissipation
    assert dissipated[count : 2 * count] == near(dissipated[2 * count :], 1e-12 * energy)
    # All work is dissipated, since the stored energy returns to its value.
    assert np.sum(dissipated[count : 2 * count]) >= 0


def work(case: Case, d: Array, u: Array) -> tuple[Array, history.LoadHistory]:
    """int F_x du up to each point, by Gauss-Lobatto on panels that cluster at slope jumps of F_x.

    Additional points on a straight load step change nothing, so the rule's nodes are path points.
    """
    panels = [np.linspace(step, step + 1, 65) for step in range(len(d))]
    edges = np.unique(np.concatenate(panels))
    knots = np.arange(len(d) + 1)
    all_d, all_u = np.append(0.0, d), np.append(0.0, u)
    for last in (False, False, True):
        low, width = edges[:-1], np.diff(edges)
        at = (low[:, None] + width[:, None] * (NODES + 1) / 2).ravel()
        times = np.unique(np.concatenate([at, knots[1:]]))
        result = solve(case, np.interp(times, knots, all_d), np.interp(times, knots, all_u))
        force = result.tangential_force[np.searchsorted(times, at)].reshape(-1, NODES.size)
        step = np.minimum(low.astype(int), len(d) - 1)
        part = force @ WEIGHTS / 2 * width * (all_u[step + 1] - all_u[step])
        if last:
            total = np.append(0.0, np.cumsum(part))
            return total[np.searchsorted(edges, knots[1:])], result
        # The last coefficients of a smooth function are small; a kink leaves several large ones.
        rough = np.sum(np.abs(force @ LAST), axis=1) * width
        chosen = np.flatnonzero(rough > 1e-13 * np.max(np.abs(force)))
        inner = low[chosen, None] + width[chosen, None] * np.arange(1, 64) / 64
        edges = np.unique(np.concatenate([edges, inner.ravel()]))
    raise AssertionError


@few
@given(cases(), st.lists(point, min_size=2, max_size=4))
def test_work_is_stored_or_dissipated(case: Case, path: list[tuple[float, float]]) -> None:
    d, u, _ = controls(case, path)
    done, _ = work(case, d, u)
    result = solve(case, d, u)
    balance = result.tangential_energy + result.dissipated_energy
    assert balance == near(done, 1e-10 * np.max(np.abs(balance)), rel=0)


@repeatable
@given(cases(), paths, st.integers(2, 9))
def test_samples_do_not_change_the_points(
    case: Case, path: list[tuple[float, float]], count: int
) -> None:
    d, u, depth = controls(case, path)
    one, many = (solve(case, d, u, samples_per_step=number) for number in (1, count))
    assert many.step.tolist() == np.repeat(np.arange(len(d)), count).tolist()
    size = MU * np.max(one.normal_force, initial=0.0)
    for name, scale in (
        ("tangential_force", size),
        ("tangential_energy", size * SHIFT * depth),
        ("dissipated_energy", size * SHIFT * depth),
    ):
        sampled = getattr(many, name)[count - 1 :: count]
        assert sampled == near(getattr(one, name), 1e-13 * scale), name
    if d[-1] <= 0:
        assert many.state.depth.size == one.state.depth.size == 0
        return
    # Rounding can leave a corner with an angle of zero.
    for first, second in ((one.state, many.state), (many.state, one.state)):
        load = np.interp(first.depth, second.depth, second.load)
        assert load == near(first.load, 1e-13 * MU * E_STAR * depth)


def test_state_is_immutable() -> None:
    state = history.unloaded(profile_from(PROFILES["sphere"]), E_STAR, G_STAR, MU)
    assert state.indentation_depth == state.tangential_displacement == 0
    state = history.advance(history.advance(state, 0.2, 0.0), 0.2, 0.05)
    with pytest.raises(dataclasses.FrozenInstanceError):
        state.indentation_depth = 0.3
    require_unchangeable(state)
    loads = np.full(3, 0.2), np.array([0.0, 0.05, 0.0])
    require_unchangeable(solve((PROFILES["sphere"], 0.2), *loads).state)


def require_unchangeable(state: history.ContactState) -> None:
    for name in ("depth", "load", "coordinate", "slope", "slip_fronts"):
        kept, array = getattr(state, name).copy(), getattr(state, name)
        with contextlib.suppress(ValueError):
            array[:] = 1.0
        # The array is either read-only or a copy.
        assert np.array_equal(getattr(state, name), kept)


@repeatable
@given(cases(), paths, st.floats(-9.0, 3.0), st.floats(-6.0, 6.0))
def test_results_scale_with_units(
    case: Case, path: list[tuple[float, float]], length_power: float, modulus_power: float
) -> None:
    fields, radius = case
    unit, modulus = 10.0**length_power, 10.0**modulus_power
    d, u, depth = controls(case, path)
    old = solve(case, d, u)
    new = history.solve(
        profile_from(rescaled(fields, unit)),
        E_STAR * modulus,
        G_STAR * modulus,
        MU,
        indentation_depth=d * unit,
        tangential_displacement=u * unit,
    )
    force = modulus * unit**2
    size = MU * np.max(old.normal_force, initial=0.0)
    for name, factor, scale in (
        ("contact_radius", unit, radius),
        ("normal_force", force, size),
        ("tangential_force", force, size),
        ("tangential_energy", force * unit, size * SHIFT * depth),
        ("dissipated_energy", force * unit, size * SHIFT * depth),
    ):
        expected = getattr(old, name) * factor
        # The rounding error of a power's coefficient is amplified by its exponent.
        assert getattr(new, name) == near(expected, 1e-12 * scale * factor, rel=1e-11), name
    assert np.array_equal(new.step, old.step)


@repeatable
@given(cases(), paths)
def test_reversed_direction_is_the_mirror_image(
    case: Case, path: list[tuple[float, float]]
) -> None:
    d, u, _ = controls(case, path)
    right, left = solve(case, d, u), solve(case, d, -u)
    assert np.array_equal(left.tangential_force, -right.tangential_force)
    assert np.array_equal(left.state.load, -right.state.load)
    for name in ("normal_force", "dissipated_energy", "tangential_energy"):
        assert np.array_equal(getattr(left, name), getattr(right, name)), name


@pytest.mark.parametrize("samples", [1, 3, 7])
def test_samples_of_a_step_into_full_slip_share_its_work(samples: int) -> None:
    """Springs on the axis, to which rounding leaves a segment of 1e-17, are counted once."""
    depth, radius, mu, e_star, g_star = 1.17e-4, 1.3e-3, 0.3, 3.3e6, 2.2e6
    moved = 1.5 * mu * e_star / g_star * depth
    path = history.solve(
        Paraboloid(radius),
        e_star,
        g_star,
        mu,
        indentation_depth=depth,
        tangential_displacement=[0.0, moved, -moved, moved],
        samples_per_step=samples,
    )
    # Of springs that slip by 2 u - 2 (d - w) mu E*/G* under the friction mu E* (d - w).
    a = np.sqrt(radius * depth)
    work = 2 * moved * mu * e_star * 4 / 3 * a * depth
    work -= 2 * (mu * e_star) ** 2 / g_star * 16 / 15 * a * depth**2
    halves = path.dissipation.reshape(4, samples).sum(axis=1)[2:]
    np.testing.assert_allclose(halves, work, rtol=1e-13, atol=0)
