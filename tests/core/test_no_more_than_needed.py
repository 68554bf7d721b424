"""No more is computed than a scene needs: counted, not timed.

A looser tolerance never costs more, closed forms are taken wherever there are any, and what was not
asked for is not computed.
"""

from __future__ import annotations

from contextlib import ExitStack
from itertools import pairwise
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

from mdr_core import equivalent_1d, normal, tangential
from mdr_core.fields import contact as contact_fields
from mdr_core.profiles import KINDS, Profile
from mdr_core.profiles import base as profiles
from mdr_service.queries.fields import solve_stress, stress_result
from mdr_service.schemas.fields import StressQuery
from tests.core.evaluations import FIELDS, PROFILES, cost, counted, field, made, solved

TOLERANCES = [10.0**-decade for decade in range(3, 14)]
#: Fields of which a kind may say that they are closed form.
CLOSED_FIELDS = ("pressure", "shear_stress", "slip", "normal_displacement")
#: A table is resolved once, not for each radius; nothing slips under a flat punch.
RESOLVED = ("tabulated", "flat_punch")
QUERY: dict[str, Any] = {
    "profile": {"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 2.0},
    "material": {"e_star": 1.0, "g_star": 0.8},
    "load": {"normal_force": 0.3},
    "radius": [0.0, 0.3, 0.6],
}
PUSHED = {"friction_coefficient": 0.3, "tangential": {"tangential_force": 0.05}}


def never(*_: Any, **__: Any) -> Any:
    raise AssertionError("nobody asked for this")


def test_every_kind_is_here() -> None:
    assert set(PROFILES) == set(KINDS)


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("kind", PROFILES)
def test_a_looser_tolerance_never_costs_more(kind: str, name: str) -> None:
    costs = [cost(kind, name, rtol) for rtol in TOLERANCES]
    assert all(loose <= tight for loose, tight in pairwise(costs)), costs


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (kind, name)
        for kind in PROFILES
        for name in ("pressure", "shear_stress")
        if kind not in RESOLVED and name not in KINDS[kind].closed_forms
    ],
)
def test_a_coarse_stress_costs_less_than_a_fine_one(kind: str, name: str) -> None:
    assert cost(kind, name, 1e-3) < cost(kind, name, 1e-13)


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (kind, name)
        for kind in PROFILES
        for name in CLOSED_FIELDS
        if name in KINDS[kind].closed_forms
    ],
)
def test_closed_fields_take_no_quadrature(kind: str, name: str) -> None:
    assert cost(kind, name, 1e-13) == 0


@pytest.mark.parametrize("kind", PROFILES)
def test_closed_answers_take_no_quadrature_and_no_iteration(kind: str) -> None:
    profile = made(kind)
    otherwise = {
        "contact_radius": (equivalent_1d, "_inverse"),
        "elastic_energy": (profiles, "energy_integral"),
    }
    with ExitStack() as stack:
        for name, place in otherwise.items():
            if name in profile.closed_forms:
                stack.enter_context(patch.object(*place, never))
        count = stack.enter_context(counted())
        contact = normal.solve(profile, 1.0, normal_force=0.1)
        # A table is resolved before its pressure is searched.
        wanted = set(profiles.NORMAL_QUANTITIES) - {"maximum_pressure"}
        for name in wanted | (wanted & set(profile.closed_forms)):
            getattr(contact, name)
    assert count.integrand == 0


@pytest.mark.parametrize("given", ["indentation_depth", "contact_radius"])
@pytest.mark.parametrize("kind", ["paraboloid", "cone", "power"])
def test_a_power_law_is_never_iterated(kind: str, given: str) -> None:
    with (
        patch.object(equivalent_1d, "_inverse", never),
        patch.object(equivalent_1d, "invert", never),
    ):
        contact = normal.solve(made(kind), 1.0, **{given: 0.1})
        pushed = tangential.solve(contact, 0.8, 0.3, tangential_force=0.1 * contact.normal_force)
        assert pushed.stick_radius > 0
        assert pushed.tangential_displacement > 0


@pytest.mark.parametrize("kind", PROFILES)
def test_answers_of_a_normal_contact_wait_until_they_are_asked_for(kind: str) -> None:
    contact = normal.solve(made(kind), 1.0, normal_force=0.1)
    assert set(vars(contact)) & set(profiles.NORMAL_QUANTITIES) == {"normal_force"}
    with patch.object(type(contact.profile), "reduced_energy", never):
        assert contact.contact_radius > 0
        assert contact.mean_pressure > 0
    assert "elastic_energy" not in vars(contact)


@pytest.mark.parametrize("kind", [kind for kind in PROFILES if kind != "flat_punch"])
def test_a_stick_radius_does_not_wait_for_what_is_dissipated(kind: str) -> None:
    pushed = solved(made(kind), 1e-10)
    with patch.object(tangential, "slip_moment", never):
        assert pushed.stick_radius > 0
        assert pushed.slip_width > 0
    assert "dissipated_energy" not in vars(pushed)


@pytest.mark.parametrize("kind", PROFILES)
def test_a_field_computes_no_other_field(kind: str) -> None:
    pushed = solved(made(kind), 1e-10)
    with (
        patch.object(contact_fields, "slip_kernel", never),
        patch.object(type(pushed.normal.profile), "outer_displacement", never),
        patch.object(type(pushed.normal.profile), "reduced_energy", never),
    ):
        field("pressure", pushed, 1e-10)
        field("shear_stress", pushed, 1e-10)
    with (
        patch.object(contact_fields, "stress", never),
        patch.object(type(pushed.normal.profile), "reduced_energy", never),
    ):
        field("slip", pushed, 1e-10)
        field("normal_displacement", pushed, 1e-10)


def asked(**more: Any) -> dict[str, Any]:
    """What the service answers to a query of stress."""
    query = StressQuery.model_validate(QUERY | more)
    return stress_result(query, solve_stress(query))


def test_pressure_alone_needs_no_friction_no_slip_and_no_energy() -> None:
    with (
        patch.object(tangential, "solve", never),
        patch.object(contact_fields, "slip_kernel", never),
        patch.object(Profile, "outer_displacement", never),
        patch.object(Profile, "reduced_energy", never),
    ):
        answer = asked(quantities=["pressure"])
    assert "slip" not in answer
    assert "shear_stress" not in answer
    assert np.all(np.asarray(answer["pressure"]) > 0)


@pytest.mark.parametrize("wanted", [["pressure"], ["pressure", "shear_stress"]])
def test_stresses_under_friction_need_no_slip(wanted: list[str]) -> None:
    with (
        patch.object(contact_fields, "slip_kernel", never),
        patch.object(tangential, "slip_moment", never),
    ):
        answer = asked(quantities=wanted, **PUSHED)
    assert set(wanted) <= set(answer)
    assert "slip" not in answer


def test_slip_alone_needs_no_stress() -> None:
    with patch.object(contact_fields, "stress", never):
        answer = asked(quantities=["slip"], **PUSHED)
    assert "pressure" not in answer
