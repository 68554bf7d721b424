"""Wear fields over the cycles err by no more than their estimate."""

from __future__ import annotations

import numpy as np
import pytest

from mdr_core import normal
from mdr_core.profiles import CappedParaboloid
from mdr_core.wear import evolution, limit
from tests.stability.fine_wear import (
    BREAKS,
    G_STAR,
    MU,
    PAIRS,
    RADII,
    fine,
    stored,
    worn,
    worn_over_break,
)


def require_error_within_estimate(
    result: evolution.WearEvolution, exact: dict[str, np.ndarray]
) -> None:
    for scalar in evolution.SCALARS:
        value = getattr(result, scalar)
        assert np.abs(value / exact[scalar] - 1).max() <= result.error_estimate, scalar
    radius = RADII * exact["contact_radius"].max()
    for field in evolution.FIELDS:
        value = getattr(result, field)(radius)
        error = np.abs(value - exact[field]).max() / np.abs(value).max()
        assert error <= result.field_error_estimate(radius, [field]), field


@pytest.mark.every(17)
@pytest.mark.parametrize("resolution", [16, 48])
@pytest.mark.parametrize(("kind", "name"), PAIRS)
def test_error_within_estimate(kind: str, name: str, resolution: int) -> None:
    result, exact = worn(kind, name, resolution), stored(kind, name)
    require_error_within_estimate(result, exact)


@pytest.mark.every(5)
@pytest.mark.parametrize("name", BREAKS)
def test_error_over_a_break_is_within_estimate(name: str) -> None:
    """The two runs of the estimate may err alike there."""
    result = worn_over_break(name)
    require_error_within_estimate(result, stored("break", name))
    assert result.error_estimate < 0.1


@pytest.mark.every(3)
@pytest.mark.parametrize(
    ("tip_radius", "radius", "part"), [(4.0, 1.1, 0.7), (1.2, 0.98, 0.7), (1.2, 1.5, 0.97)]
)
def test_fields_of_the_limiting_state_are_within_estimate(
    tip_radius: float, radius: float, part: float
) -> None:
    """Reference: the worn depth in the limit, a quadrature."""
    body = CappedParaboloid(1.0, tip_radius, 1.0)
    depth = float(normal.solve(body, 1.0, contact_radius=radius).indentation_depth)
    contact = normal.solve(body, 1.0, indentation_depth=depth)
    moved = {"tangential_displacement": part * MU / G_STAR * depth}
    result = evolution.solve(contact, G_STAR, MU, wear_coefficient=1.0, cycles=[1e9], **moved)
    exact = limit.solve(contact, G_STAR, MU, **moved)
    c, a = float(result.stick_radius[0]), float(result.contact_radius[0])
    r = c + (1.02 * a - c) * np.linspace(0.0, 1.0, 61)[1:]
    value, true = result.worn_depth(r)[0], exact.worn_depth(r)
    error = np.abs(value - true).max() / value.max()
    assert error <= result.field_error_estimate(r, ["worn_depth"])


@pytest.mark.every(13)
@pytest.mark.parametrize(("kind", "name"), PAIRS)
def test_pressure_does_not_ripple(kind: str, name: str) -> None:
    """Excludes 2 % of a at the edges; relative to the largest pressure of each cycle."""
    result, exact = worn(kind, name, 48), stored(kind, name)
    radius = RADII * exact["contact_radius"].max()
    pressure = result.pressure(radius)
    for cycle, (c, a) in enumerate(
        zip(exact["stick_radius"], exact["contact_radius"], strict=True)
    ):
        off = (np.abs(radius - c) > 0.02 * a) & (np.abs(radius - a) > 0.02 * a)
        true = exact["pressure"][cycle]
        assert np.abs(pressure[cycle] - true)[off].max() <= 1e-3 * true[off].max(), (cycle, c, a)


# Up to a hundred times the tolerance of the integration, whose steps depend on the last digits: a
# moving stick edge amplifies it in the peak of the pressure.
@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("paraboloid", "depth, displacement"),
        pytest.param("rounded_punch", "forces", marks=pytest.mark.long),
        pytest.param("power", "force, displacement", marks=pytest.mark.long),
    ],
)
def test_stored_reference_is_reproduced(kind: str, name: str) -> None:
    result, exact = fine(kind, name), stored(kind, name)
    for each, values in exact.items():
        assert np.abs(result[each] - values).max() <= 1e-6 * np.abs(values).max(), each
