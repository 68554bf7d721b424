"""A query computes no more than its results need.

A looser tolerance never costs more, closed forms are used wherever they exist, and results that are
not requested are not computed.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

from mdr_core import equivalent_1d, history, normal, tangential
from mdr_core.fields.traction import Traction
from mdr_core.history import slip_memory, tractions
from mdr_core.interval_moments import IntervalMoments
from mdr_core.profiles import KINDS, Paraboloid, Profile, Sphere, SphericalTipCone
from mdr_core.profiles import base as profiles
from mdr_service.queries.fields import solve_stress, stress_result
from mdr_service.schemas.fields import StressQuery
from tests.core.evaluations import FIELDS, PROFILES, cost, counted, field, profile_of, solved

QUERY: dict[str, Any] = {
    "profile": {"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 2.0},
    "material": {"e_star": 1.0, "g_star": 0.8},
    "load": {"normal_force": 0.3},
    "radius": [0.0, 0.3, 0.6],
}
PATHS = ("forces", "displacements")
LOADED = {"friction_coefficient": 0.3, "tangential": {"tangential_force": 0.05}}


def never(*_: Any, **__: Any) -> Any:
    raise AssertionError("not requested")


def test_every_kind_is_covered() -> None:
    assert set(PROFILES) == set(KINDS)


@pytest.mark.parametrize(
    ("kind", "name"),
    [(kind, name) for kind in PROFILES for name in FIELDS if name in KINDS[kind].closed_forms],
)
def test_closed_form_fields_need_no_quadrature(kind: str, name: str) -> None:
    assert cost(kind, name) == 0


@pytest.mark.parametrize("kind", PROFILES)
def test_closed_form_results_need_no_quadrature_or_iteration(kind: str) -> None:
    profile = profile_of(kind)
    otherwise = {
        "contact_radius": (Profile, "_root"),
        "elastic_energy": (profiles, "power_law_integral"),
    }
    with ExitStack() as stack:
        for name, place in otherwise.items():
            if name in profile.closed_forms:
                stack.enter_context(patch.object(*place, never))
        count = stack.enter_context(counted())
        contact = normal.solve(profile, 1.0, normal_force=0.1)
        # A table is resolved before its pressure maximum is searched.
        quantities = set(profiles.NORMAL_QUANTITIES) - {"maximum_pressure"}
        for name in quantities | (quantities & set(profile.closed_forms)):
            getattr(contact, name)
    assert count.integrand == 0


@pytest.mark.parametrize("given", ["indentation_depth", "contact_radius"])
@pytest.mark.parametrize("kind", ["paraboloid", "cone", "power"])
def test_power_law_needs_no_iteration(kind: str, given: str) -> None:
    with (
        patch.object(Profile, "_root", never),
        patch.object(equivalent_1d, "invert", never),
    ):
        contact = normal.solve(profile_of(kind), 1.0, **{given: 0.1})
        tangential_contact = tangential.solve(
            contact, 0.8, 0.3, tangential_force=0.1 * contact.normal_force
        )
        assert tangential_contact.stick_radius > 0
        assert tangential_contact.tangential_displacement > 0


@pytest.mark.parametrize("kind", PROFILES)
def test_normal_results_are_lazy(kind: str) -> None:
    contact = normal.solve(profile_of(kind), 1.0, normal_force=0.1)
    assert set(vars(contact)) & set(profiles.NORMAL_QUANTITIES) == {"normal_force"}
    with patch.object(type(contact.profile), "reduced_energy", never):
        assert contact.contact_radius > 0
        assert contact.mean_pressure > 0
    assert "elastic_energy" not in vars(contact)


@pytest.mark.parametrize("kind", [kind for kind in PROFILES if kind != "flat_punch"])
def test_stick_radius_needs_no_dissipated_energy(kind: str) -> None:
    tangential_contact = solved(profile_of(kind))
    with patch.object(tangential, "slip_moment", never):
        assert tangential_contact.stick_radius > 0
        assert tangential_contact.slip_width > 0
    assert "dissipated_energy" not in vars(tangential_contact)


@pytest.mark.parametrize("kind", PROFILES)
def test_field_computes_no_other_field(kind: str) -> None:
    tangential_contact = solved(profile_of(kind))
    with (
        patch.object(type(tangential_contact.normal.profile), "slip_integral", never),
        patch.object(type(tangential_contact.normal.profile), "outer_displacement", never),
        patch.object(type(tangential_contact.normal.profile), "reduced_energy", never),
    ):
        field("pressure", tangential_contact)
        field("shear_stress", tangential_contact)
    with (
        patch.object(Traction, "stress", never),
        patch.object(type(tangential_contact.normal.profile), "reduced_energy", never),
    ):
        field("slip", tangential_contact)
        field("normal_displacement", tangential_contact)


@pytest.mark.parametrize("controls", PATHS)
def test_slip_memory_is_followed_once_for_all_results(controls: str) -> None:
    steps: list[int] = []
    follow = slip_memory.follow

    def counted_follow(start: Any, path: Any, continues: Any) -> Any:
        steps.append(continues.size)
        return follow(start, path, continues)

    path = load_path(controls, 100_000)
    with patch.object(slip_memory, "follow", counted_follow):
        result = history.solve(Paraboloid(1.3), 3.7, 2.9, 0.37, **path)
        for name in result.quantities:
            getattr(result, name)
        assert result.error_estimate > 0
        assert result.warnings is not None
        assert result.state.in_contact
    assert sum(steps) == 100_000


@pytest.mark.parametrize("controls", PATHS)
def test_tangential_force_of_a_history_needs_nothing_else(controls: str) -> None:
    """A history of any length computes neither energies nor the normal contact of each sample."""
    for steps in (10, 100_000):
        with (
            patch.object(tractions, "dissipation", never),
            patch.object(tractions, "variance_growth", never),
            patch.object(Sphere, "reduced_energy", never),
            patch.object(IntervalMoments, "over", never),
            patch.object(history.LoadHistory, "normal", property(never)),
        ):
            result = history.solve(Sphere(1.5), 3.7, 2.9, 0.37, **load_path(controls, steps))
            assert np.any(result.tangential_force != 0)
            assert np.any(result.tangential_displacement != 0)


def test_a_step_computes_only_what_is_requested() -> None:
    state = history.unloaded(Sphere(1.5), 3.7, 2.9, 0.37)
    for depth, displacement in ((0.2, 0.01), (0.25, 0.03), (0.22, -0.01), (0.23, 0.02)):
        with (
            patch.object(tractions, "dissipation", never),
            patch.object(tractions, "variance_growth", never),
            patch.object(Sphere, "reduced_energy", never),
        ):
            with patch.object(equivalent_1d, "invert", never):
                state = history.advance(state, depth, displacement)
            assert state.tangential_force != 0
        kept = state.known_edges[:]
        with patch.object(equivalent_1d, "invert", never):
            assert state.normal_force > 0
        assert state.known_edges == kept


def load_path(controls: str, steps: int) -> dict[str, Any]:
    """Random load path of points that are not in full slip."""
    random = np.random.default_rng(8)
    normal = random.uniform(0.2, 0.3, steps)
    tangential = random.uniform(-0.1, 0.1, steps)
    if controls == "forces":
        return {"normal_force": normal, "tangential_force": 0.3 * tangential}
    return {"indentation_depth": normal, "tangential_displacement": tangential}


def run_stress(**more: Any) -> dict[str, Any]:
    """Run the stress query of the service."""
    query = StressQuery.model_validate(QUERY | more)
    return stress_result(query, solve_stress(query))


def test_pressure_needs_no_friction_slip_or_energy() -> None:
    with (
        patch.object(tangential, "solve", never),
        patch.object(Profile, "slip_integral", never),
        patch.object(Profile, "outer_displacement", never),
        patch.object(Profile, "reduced_energy", never),
    ):
        answer = run_stress(quantities=["pressure"])
    assert "slip" not in answer
    assert "shear_stress" not in answer
    assert np.all(np.asarray(answer["pressure"]) > 0)


@pytest.mark.parametrize("quantities", [["pressure"], ["pressure", "shear_stress"]])
def test_shear_stress_needs_no_slip(quantities: list[str]) -> None:
    with (
        patch.object(Profile, "slip_integral", never),
        patch.object(tangential, "slip_moment", never),
    ):
        answer = run_stress(quantities=quantities, **LOADED)
    assert set(quantities) <= set(answer)
    assert "slip" not in answer


def test_slip_needs_no_stress() -> None:
    with (
        patch.object(Traction, "stress", never),
    ):
        answer = run_stress(quantities=["slip"], **LOADED)
    assert "pressure" not in answer


def test_largest_pressure_of_a_steep_cone_takes_little_longer() -> None:
    costs = []
    for slope in (1.0, 1e5):
        contact = normal.solve(SphericalTipCone(slope, 1.0), 1.0, contact_radius=10.0)
        with counted() as count:
            assert contact.maximum_pressure > 0
        costs.append(count.integrand)
    assert 0 < costs[1] < 20 * costs[0]
