"""Impacts over HTTP have the results of the core, and errors point into the request."""

import csv
import io
from typing import Any

import numpy as np
import pytest

from mdr_core import impact
from mdr_core.profiles import Paraboloid
from mdr_service.schemas.answers import ImpactAnswer
from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import Client

PATH = "/v1/tangential/impact"
MOTION: dict[str, Any] = {
    "normal_mass": 2.0,
    "tangential_mass": 0.5,
    "normal_velocity": [0.3, 0.4],
    "tangential_velocity": [0.1, -0.9],
}


def query(**changed: Any) -> dict[str, Any]:
    return {
        "profile": {"kind": "paraboloid", "radius": 50.0},
        "material": {"e_star": 100.0, "g_star": 80.0},
        "friction_coefficient": 0.2,
        **MOTION,
        **changed,
    }


def test_response_equals_the_core(client: Client) -> None:
    document = client.post(PATH, query()).json()
    ImpactAnswer.model_validate(document)
    hit = impact.solve(Paraboloid(50.0), 100.0, 80.0, 0.2, **MOTION)
    for name in hit.quantities:
        assert document[name] == getattr(hit, name).tolist(), name
    assert document["error_estimate"] == hit.error_estimate
    # Free balls of this radius are not half-spaces.
    assert [warning["code"] for warning in document["warnings"]] == ["half_space"]


def test_accuracy_that_is_missed_is_a_warning(client: Client) -> None:
    document = client.post(PATH, query(rtol=1e-13)).json()
    codes = {warning["code"] for warning in document["warnings"]}
    assert codes == {"accuracy", "half_space"}


def test_accuracy_that_cannot_be_reached_names_its_member(client: Client) -> None:
    document = client.post(PATH, query(tangential_mass=1e-4)).json()
    assert document["type"] == "urn:mdr:problem:accuracy-not-reachable"
    (error,) = document["errors"]
    assert document["detail"] == f"tangential_mass: {error['detail']}"
    assert error["pointer"] == "/tangential_mass"
    assert error["detail"].startswith("is so small that")


def test_one_velocity_serves_all(client: Client) -> None:
    one = client.post(PATH, query(normal_velocity=0.3)).json()
    assert one["normal_velocity"] == [0.3, 0.3]
    both = client.post(PATH, query(normal_velocity=[0.3, 0.3])).json()
    assert one == both


def test_sliding_example_has_its_closed_form(client: Client) -> None:
    # w - 2 mu m v/m_t.
    document = client.post(PATH, EXAMPLES["impact"]["cylinder"]["value"]).json()
    assert document["tangential_rebound_velocity"] == pytest.approx([1.8], rel=1e-12, abs=0)
    assert document["regime"] == ["full_slip"]


def test_table_and_picture(client: Client) -> None:
    table = client.post(f"{PATH}?format=csv", query()).text
    rows = list(csv.DictReader(io.StringIO(table)))
    document = client.post(PATH, query()).json()
    for name in ("tangential_rebound_velocity", "duration"):
        assert [float(row[name]) for row in rows] == document[name]
    many = query(normal_velocity=0.3, tangential_velocity=np.linspace(0, 1, 9).tolist())
    assert "Tangential velocity after" in client.post(f"{PATH}?format=svg", many).text
