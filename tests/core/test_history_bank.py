"""Cycles and random paths agree with the stored references, under either kind of control."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_core import history
from tests.core.batches import batched
from tests.core.comparison import (
    EPS,
    INPUT,
    allowance,
    assert_each,
    overstated,
    profile_from,
    relative_error,
)
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Iterable

ENERGY = 1e-10
BOUND = 1e-12
#: Relative to mu F_N at full slip: the depth is rounded, and so are the points of first contact and
#: of separation on an oblique path.
TOUCH = 8 * EPS
#: Relative to a small amplitude over that of full slip: normal coordinates are rounded.
SMALL = 4 * EPS
#: Largest ratio of estimate to largest admissible error.
OVERSTATED = 45.0


def each(cases: Iterable[dict[str, Any]]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("case", cases, ids=lambda case: str(case["id"]))


def material(case: dict[str, Any]) -> tuple[Any, ...]:
    return (
        profile_from(case["profile"]),
        case["e_star"],
        case["g_star"],
        case["friction_coefficient"],
    )


def bound_of(case: dict[str, Any]) -> float:
    return BOUND


def input_error(case: dict[str, Any], name: str, index: int) -> float:
    return allowance(*(case[kind][name][index] for kind in ("condition", "condition_load")))


def full_slip_error(case: dict[str, Any], index: int, result: history.LoadHistory) -> float:
    """Error of the dissipated energy where rounding may move the amplitude past full slip.

    Beyond the onset of full slip the energy grows by 4 mu F_N du. This growth is steep next to a
    flat, where the slip annulus before the onset is narrow and dissipates little. The stored
    condition number is for partial slip.
    """
    limit = case["friction_coefficient"] * float(np.max(result.normal_force))
    if case["tangential_control"] == "tangential_force" or not (
        float(np.max(np.abs(result.tangential_force))) >= limit * (1 - TOUCH)
    ):
        return 0.0
    energy = float(case["expected"]["energy_per_cycle"][index])
    return INPUT * 4 * limit * case["given"][index] / energy


def amplitude_error(case: dict[str, Any], index: int, result: history.LoadHistory) -> float:
    full = case["friction_coefficient"] * float(np.max(result.normal_force))
    if case["tangential_control"] == "tangential_displacement":
        ratio = case["friction_coefficient"] * case["e_star"] / case["g_star"]
        full = ratio * float(np.max(result.indentation_depth))
    return SMALL * full / float(case["given"][index])


def cycle_failures(
    case: dict[str, Any], index: int, rounding: float, result: Iterable[float]
) -> list[str]:
    """Failures of one amplitude's energy and stiffness, for each method that computes them."""
    failures = []
    names = ("energy_per_cycle", "secant_stiffness")
    for name, bound, value in zip(names, (ENERGY, bound_of(case)), result, strict=True):
        error = relative_error(value, case["expected"][name][index])
        allowed = bound + input_error(case, name, index) + rounding
        if not error <= allowed:
            failures.append(f"{name} at {case['given'][index]!r}: {error:.2e} > {allowed:.2e}")
    return failures


def failures_of_a_cycle(case: dict[str, Any]) -> list[str]:
    failures = []
    factor = OVERSTATED
    for index, amplitude in enumerate(case["given"]):
        control = {case["control"]: case["load"], case["tangential_control"]: amplitude}
        result = history.cycles(*material(case), **control, count=2)
        assert result.energy_per_cycle.shape == result.secant_stiffness.shape == (2,)
        rounding = amplitude_error(case, index, result)
        for cycle in range(2):
            pair = (result.energy_per_cycle[cycle], result.secant_stiffness[cycle])
            failures += cycle_failures(case, index, rounding, map(float, pair))
        names = ("energy_per_cycle", "secant_stiffness")
        allowed = [bound_of(case) + input_error(case, name, index) for name in names]
        allowed += [full_slip_error(case, index, result), rounding]
        failures += overstated(result.error_estimate, allowed, factor)
    return failures


@pytest.mark.every(3)
@batched(bank.load("history_cycles"))
def test_dissipated_energy_and_stiffness_of_a_cycle(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of_a_cycle)


def failures_of_sampled_cycle(case: dict[str, Any]) -> list[str]:
    """Return the failures of a cycle whose energy is summed over samples within the load steps."""
    failures = []
    for index, amplitude in enumerate(case["given"]):
        path = {
            case["control"]: case["load"],
            case["tangential_control"]: [0.0, amplitude, -amplitude, amplitude],
        }
        result = history.solve(*material(case), **path, samples_per_step=3)
        assert result.step.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3]
        dissipated = float(np.sum(result.dissipation[6:]))
        u, force = result.tangential_displacement, result.tangential_force
        secant = float((force[11] - force[8]) / (u[11] - u[8]))
        rounding = amplitude_error(case, index, result)
        failures += cycle_failures(case, index, rounding, (dissipated, secant))
    return failures


@batched(bank.load("history_cycles")[::3])
def test_energy_of_a_sampled_path_equals_that_of_the_cycle(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_of_sampled_cycle)


def failures_in_phase(case: dict[str, Any]) -> list[str]:
    result = history.cycles(
        *material(case),
        indentation_depth=case["mean"],
        normal_amplitude=case["swing"],
        tangential_displacement=case["amplitude"],
        count=3,
    )
    expected = case["expected"]
    failures = overstated(result.error_estimate, [bound_of(case)], 50.0)
    top = case["mean"] + case["swing"]
    limit = case["friction_coefficient"] * float(np.max(result.normal_force))
    whole = limit * case["friction_coefficient"] * case["e_star"] / case["g_star"] * top
    for cycle in range(3):
        stiffness = expected["secant_stiffness"][cycle]
        error = relative_error(float(result.secant_stiffness[cycle]), stiffness)
        if not error <= bound_of(case):
            failures.append(f"stiffness of cycle {cycle}: {error:.2e}")
        energy, exact = float(result.energy_per_cycle[cycle]), expected["energy_per_cycle"][cycle]
        bound = (ENERGY + INPUT * case["condition"][cycle]) * float(exact) + TOUCH * whole
        miss = abs(Decimal(energy) - Decimal(exact))
        if not miss <= bound:
            failures.append(f"dissipated energy of cycle {cycle}: {miss:.2e} > {bound:.2e}")
    return failures


@batched(bank.load("history_inphase"))
def test_normal_load_in_phase(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, failures_in_phase)


def scaled_errors(case: dict[str, Any], result: history.LoadHistory) -> dict[str, float]:
    """Largest errors, each relative to the scale of its quantity."""
    expected = {
        name: np.array([float(value) for value in row]) for name, row in case["expected"].items()
    }
    most = np.max(expected["normal_force"])
    energy = expected["tangential_energy"] + expected["dissipated_energy"]
    scales = {
        "normal_force": most,
        "tangential_force": case["friction_coefficient"] * most,
        # The sum accumulates; the last value includes all errors before it.
        "tangential_energy": np.maximum.accumulate(energy),
        "dissipated_energy": np.maximum.accumulate(energy),
    }
    errors = {}
    for name, scale in scales.items():
        difference = np.abs(getattr(result, name) - expected[name])
        # Before the first contact both are zero.
        errors[name] = float(
            np.max(np.where(difference == 0, 0.0, difference) / np.maximum(scale, 1e-300))
        )
    return errors


@each(bank.load("history_paths"))
def test_random_path(case: dict[str, Any]) -> None:
    controls = {
        name: np.array(case[name]) for name in ("indentation_depth", "tangential_displacement")
    }
    result = history.solve(*material(case), **controls)
    errors = scaled_errors(case, result)
    assert max(errors.values()) <= bound_of(case), errors
    assert result.error_estimate >= errors["tangential_force"]
    assert not overstated(result.error_estimate, [bound_of(case)], 50.0)
    touching = controls["indentation_depth"] > 0
    assert np.array_equal(result.regime == "no_contact", ~touching)
    expected = [float(value) for value in case["expected"]["tangential_force"]]
    limit = case["friction_coefficient"] * result.normal_force
    sliding = touching & (np.abs(expected) >= limit * (1 - 1e-13))
    assert np.array_equal(result.regime == "full_slip", sliding)
