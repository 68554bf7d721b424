"""Adhesion over HTTP has the results of the core, and errors point into the request."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from urllib.parse import urlencode

import numpy as np
import pytest

if TYPE_CHECKING:
    from tests.conftest import Client

R, E_STAR, W = 2e-6, 1e6, 0.05
PULL_OFF = -1.5 * np.pi * W * R
BALL = {
    "profile": {"kind": "paraboloid", "radius": R},
    "material": {"e_star": E_STAR, "g_star": E_STAR, "work_of_adhesion": W},
}
FRICTION = {"friction_coefficient": 0.3}
LOADED = {"load": {"normal_force": 0.0}}


def answer(client: Client, path: str, query: dict[str, Any]) -> dict[str, Any]:
    response = client.post(f"/v1/{path}", BALL | query)
    assert response.status_code == 200, response.text
    body: dict[str, Any] = response.json()
    return body


def problems(client: Client, path: str, query: dict[str, Any]) -> dict[str, str]:
    response = client.post(f"/v1/{path}", BALL | query)
    assert response.status_code == 422
    return {each["pointer"]: each["detail"] for each in response.json()["errors"]}


def test_negative_loads_reach_the_pull_off(client: Client) -> None:
    found = answer(client, "normal", {"load": {"normal_force": [PULL_OFF, 0.0, 1e-6]}})
    assert found["pull_off_force"] == pytest.approx([PULL_OFF] * 3, rel=1e-12, abs=0)
    size = np.cbrt(9 * np.pi * W * R**2 / (8 * E_STAR))
    assert found["contact_radius"][:2] == pytest.approx([size, np.cbrt(4) * size], rel=1e-6, abs=0)
    assert found["retraction"] == pytest.approx(
        np.sqrt(2 * np.pi * np.array(found["contact_radius"]) * W / E_STAR), rel=1e-12, abs=0
    )


def test_table_whose_largest_pressure_is_a_tension(client: Client) -> None:
    """Near the pull-off of r^4 the whole contact is in tension."""
    r = np.linspace(0.0, R, 40)
    table = {"kind": "tabulated", "r": r.tolist(), "f": (r**4 / R**3).tolist()}
    least = answer(client, "normal", LOADED | {"profile": table})["pull_off_force"][0]
    load = {"normal_force": [0.9 * least, -1e-3 * least]}
    found = answer(client, "normal", {"profile": table, "load": load})
    tension, pressure = found["maximum_pressure"]
    assert tension < 0 < pressure
    # The two errors of the pressure are of one size.
    errors = np.array(found["pressure_data_error"]) * [-tension, pressure]
    assert 0 < errors[0] == pytest.approx(errors[1], rel=0.3, abs=0)


def test_pull_off_depth_has_an_infinite_stiffness(client: Client) -> None:
    depth = answer(client, "normal", LOADED)["pull_off_depth"][0]
    found = answer(client, "normal", {"load": {"indentation_depth": depth}})
    assert found["normal_stiffness"] == [None]
    assert "singular" in [warning["code"] for warning in found["warnings"]]


@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
def test_loads_below_the_pull_off_are_rejected_with_it(client: Client, control: str) -> None:
    least = answer(client, "normal", LOADED)[f"pull_off_{control.partition('_')[2]}"][0]
    found = problems(client, "normal", {"load": {control: [0.0, 1.01 * least]}})
    assert f"{least:.9g}" in found[f"/load/{control}/1"]
    plain = BALL["material"] | {"work_of_adhesion": 1e-50}
    found = problems(client, "normal", {"load": {control: -1e-6}, "material": plain})
    assert list(found) == [f"/load/{control}"]


def test_range_needs_a_work_and_warns(client: Client) -> None:
    alone = {"e_star": E_STAR, "range_of_adhesion": 1e-9}
    assert "/material/work_of_adhesion" in problems(client, "normal", LOADED | {"material": alone})
    material = BALL["material"] | {"range_of_adhesion": 1e-6}
    found = answer(client, "normal", LOADED | {"material": material})
    assert "jkr_range" in [warning["code"] for warning in found["warnings"]]


def test_fields_carry_the_step_of_the_edge(client: Client) -> None:
    a = 1.2e-6
    radii = {"radius": [0.0, a / 2, a], "quantities": ["pressure", "foundation_load"]}
    found = answer(client, "stress", {"load": {"contact_radius": a}} | radii)
    step = np.sqrt(2 * np.pi * a * W / E_STAR)
    inner, half, edge = found["pressure"][0]
    assert edge is None
    assert inner == pytest.approx(E_STAR * (2 * a / R - step / a) / np.pi, rel=1e-11, abs=0)
    root = a * np.sqrt(0.75)
    assert half == pytest.approx(E_STAR * (2 * root / R - step / root) / np.pi, rel=1e-11, abs=0)
    assert found["foundation_load"][0][2] == pytest.approx(-E_STAR * step, rel=1e-11, abs=0)
    material = BALL["material"] | {"poissons_ratio": 0.3}
    query = {"load": {"contact_radius": a}, "material": material, "quantities": ["stress_zz"]}
    beneath = answer(client, "subsurface", query | {"x": [0.0, a / 2], "z": [0.0]})
    assert beneath["stress_zz"][0][0] == pytest.approx([-inner, -half], rel=1e-9, abs=0)


def test_get_takes_the_work_of_adhesion(client: Client) -> None:
    given = {"kind": "paraboloid", "radius": R, "e_star": E_STAR, "work_of_adhesion": W}
    response = client.get(f"/v1/normal?{urlencode(given)}&normal_force=-1e-7")
    assert response.status_code == 200, response.text
    assert response.json()["pull_off_force"] == pytest.approx([PULL_OFF], rel=1e-12, abs=0)
