"""Holds are distinguished from branches, and the drift in a hold is subtracted."""

from typing import Any

import numpy as np
import pytest

import mdr_core as mdr
from mdr_core import fit
from mdr_core.curve_segments import drift, phases, segments

Array = np.ndarray


def drawn(random: np.random.Generator, *, hold: bool) -> tuple[Array, Array, Array]:
    """Return depths, forces, and True for points of a hold, of loading, hold and unloading."""
    count, power = int(random.integers(100, 800)), random.choice([1.0, 1.5, 2.0])
    parts = np.array([random.uniform(0.2, 0.5), 0.0, random.uniform(0.2, 0.5)])
    parts[1] = random.uniform(0.12, 0.5) if hold else 0
    up, held, down = (parts / parts.sum() * count).astype(int)
    rise, fall = np.linspace(0, 1, up, endpoint=False), np.linspace(1, 0, down)
    if not hold and random.random() < 0.5:
        rise, fall = (1 - np.cos(np.pi * rise)) / 2, (1 - np.cos(np.pi * fall)) / 2
    creep = random.uniform(0, 0.1) * (1 - np.exp(-4 * np.linspace(0, 1, held)))
    last, left = creep[-1] if hold else 0.0, random.uniform(0, 0.5)
    if random.random() < 0.5:
        force = np.r_[rise, np.ones(held), fall]
        unloading = (1 + last) * (left + (1 - left) * fall ** (1 / power))
        depth = np.r_[rise ** (1 / power), 1 + creep, unloading]
    else:
        depth = np.r_[rise, np.ones(held), fall]
        relaxed = (1 - last) * (np.maximum(fall - left, 0) / (1 - left)) ** power
        force = np.r_[rise**power, 1 - creep, relaxed]
    force = force + random.choice([0, 1e-3, 1e-2]) * random.standard_normal(depth.size)
    return depth, force, np.repeat([False, True, False], [up, held, down])


@pytest.mark.parametrize("is_timed", [False, True])
def test_only_holds_are_reported_as_holds(*, is_timed: bool) -> None:
    random, found, missed = np.random.default_rng(201), [], []
    for _ in range(200):
        depth, force, held = drawn(random, hold=True)
        time = np.arange(depth.size) * 0.1 if is_timed else None
        is_hold = phases(depth, force, time) == "hold"
        found.append(is_hold[held].mean() > 0.9)
        missed.append(np.mean(held & ~is_hold))
        depth, force, _ = drawn(random, hold=False)
        time = np.arange(depth.size) * 0.1 if is_timed else None
        assert "hold" not in phases(depth, force, time)
    assert np.mean(found) >= 0.95
    assert np.mean(missed) <= 0.01


def test_slow_approach_or_crest_is_not_a_hold() -> None:
    depth = np.r_[np.linspace(-0.1, 0, 100), np.linspace(0, 1, 50), np.linspace(1, 0, 50)]
    assert "hold" not in phases(depth, np.maximum(depth, 0) ** 1.5)
    crest = np.sin(np.linspace(0, np.pi, 500))
    assert "hold" not in phases(crest, crest**1.5)


@pytest.mark.parametrize("noise", [0.0, 3e-3])
@pytest.mark.parametrize("count", [40, 200])
@pytest.mark.parametrize("direction", [1, -1])
def test_baseline_of_one_adhesive_branch_is_not_a_hold(
    direction: int, count: int, noise: float
) -> None:
    """Before snap-in, or after pull-off, the force is constant and above the least one."""
    depth = np.linspace(-1, 1, count)
    jump = 0.0 if direction > 0 else -0.2
    force = np.where(depth > jump, 4 / 3 * depth.clip(0) ** 1.5 - 0.3, 0)
    force = force + noise * np.random.default_rng(4).standard_normal(count)
    kinds = phases(depth[::direction], force[::direction])
    assert set(kinds.tolist()) == {"loading" if direction > 0 else "unloading"}


def test_depth_that_is_controlled_shows_no_drift() -> None:
    random = np.random.default_rng(0)
    parts = [(0, 1, 60), (1, 0.25, 50), (0.25, 0.25, 40), (0.25, -0.1, 30)]
    depth = np.concatenate([np.linspace(*part) for part in parts])
    force = 4 / 3 * depth.clip(0) ** 1.5 + 1e-3 * random.standard_normal(depth.size)
    kinds = phases(depth, force)
    assert "hold" in kinds
    assert drift(depth, force, np.arange(float(depth.size)), kinds) is None


def indented(random: np.random.Generator, rate: float) -> dict[str, Array]:
    """Return a curve of E* = 1 and a ball of radius 1 with a hold at 10 % of the force, in time.

    The depths drift at the rate from time 0 on; the forces have errors of 0.1 %.
    """
    low = 0.1 ** (2 / 3)
    parts = [np.linspace(-0.2, 1, 80), np.ones(20), np.linspace(1, low, 60), np.full(40, low)]
    depth = np.concatenate([*parts, np.linspace(low, -0.1, 30)])
    force = 4 / 3 * np.maximum(depth, 0) ** 1.5
    time = np.arange(float(depth.size))
    return {
        "indentation_depth": depth + rate * time + 1e-4 * random.standard_normal(depth.size),
        "normal_force": force + 1e-3 * random.standard_normal(depth.size),
        "time": time,
    }


def solved(curve: dict[str, Array], **given: Any) -> fit.Fit:
    return fit.solve(mdr.Paraboloid(1.0), **curve, segment="loading", **given)


def test_drift_of_a_hold_is_subtracted() -> None:
    random, off = np.random.default_rng(202), []
    for _ in range(40):
        curve = indented(random, 2e-4)
        found, left = solved(curve, drift="hold"), solved(curve)
        assert found.drift_rate is not None
        assert found.drift_rate_error is not None
        off.append(
            [
                (found.drift_rate - 2e-4) / found.drift_rate_error,
                (found.e_star - 1) / found.standard_errors[0],
                found.contact_point / found.standard_errors[1],
            ]
        )
        assert abs(left.e_star - 1) > 3 * left.standard_errors[0]
    assert np.abs(off).max() < 4
    assert np.mean(np.abs(off) < 3, axis=0).min() >= 0.95


def test_error_of_the_rate_is_part_of_all_standard_errors() -> None:
    curve = indented(np.random.default_rng(203), 2e-4)
    exact = solved(curve, drift_rate=2e-4)
    error = 1e-5
    found = solved(curve, drift_rate=2e-4, drift_rate_error=error)
    high, low = (solved(curve, drift_rate=2e-4 + step) for step in (error, -error))
    for i, name in enumerate(found.fit):
        change = (getattr(high, name) - getattr(low, name)) / 2
        expected = np.hypot(exact.standard_errors[i], change)
        assert found.standard_errors[i] == pytest.approx(expected, rel=1e-3, abs=0)
    assert np.linalg.eigvalsh(found.correlation).min() >= 0


def test_loading_segment_excludes_hold_points() -> None:
    curve = indented(np.random.default_rng(204), 0.0)
    assert 78 <= solved(curve).indentation_depth.size <= 81
    kinds = phases(curve["indentation_depth"], curve["normal_force"])
    found = segments(kinds)
    assert [each.kind for each in found] == ["loading", "hold", "unloading", "hold", "unloading"]
    assert [each.last + 1 for each in found] == pytest.approx([80, 100, 160, 200, 230], abs=2)


def test_hold_at_the_largest_force_shows_creep_and_no_drift() -> None:
    curve = {name: values[:155] for name, values in indented(np.random.default_rng(5), 0).items()}
    depth, force, time = curve.values()
    kinds = phases(depth, force, time)
    assert "hold" in kinds
    assert drift(depth, force, time, kinds) is None
    with pytest.raises(mdr.InputError, match="the curve must have a hold") as refused:
        solved(curve, drift="hold")
    assert refused.value.path == ("drift",)


@pytest.mark.parametrize(
    ("changed", "path"),
    [
        ({"time": None, "drift": "hold"}, ("time",)),
        ({"time": [0.0, 1.0]}, ("time",)),
        ({"time": np.arange(230.0)[::-1]}, ("time", 1)),
        ({"drift": "hold", "drift_rate": 1.0}, ("drift_rate",)),
        ({"drift_rate_error": 1.0}, ("drift_rate_error",)),
        ({"drift_rate": 1.0, "drift_rate_error": -1.0}, ("drift_rate_error",)),
        ({"drift_rate": np.nan}, ("drift_rate",)),
        ({"drift": "rest"}, ("drift",)),
    ],
)
def test_invalid_drift_is_rejected(changed: dict[str, Any], path: tuple[str | int, ...]) -> None:
    curve = indented(np.random.default_rng(206), 0.0) | changed
    with pytest.raises(mdr.InputError) as refused:
        solved(curve)
    assert refused.value.path == path
