"""Stresses over HTTP have the results of the core, and errors point into the request."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_core import normal, subsurface, tangential
from mdr_core.profiles import Paraboloid
from mdr_service.schemas.examples import EXAMPLES

if TYPE_CHECKING:
    from tests.conftest import Client

PATH = "/v1/subsurface"
AXIS = EXAMPLES["subsurface"]["hertz_on_the_axis"]["value"]
MAP: dict[str, Any] = {
    "profile": {"kind": "paraboloid", "radius": 2.0},
    "material": {"e_star": 3.0, "g_star": 2.5, "poissons_ratio": 0.3},
    "load": {"contact_radius": [0.1, 0.2]},
    "friction_coefficient": 0.3,
    "tangential": {"stick_radius": 0.05},
    "body": 2,
    "x": [-0.1, 0.0, 0.05, 0.3],
    "z": [0.0, 0.04, 0.2],
    "y": 0.01,
}
NAMES = [
    *("stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz"),
    *("von_mises", "maximum_shear", "mean_stress"),
]


def result_of(client: Client, query: dict[str, Any]) -> dict[str, Any]:
    response = client.post(PATH, query)
    assert response.status_code == 200, response.content
    result: dict[str, Any] = response.json()
    return result


def pointers(client: Client, query: dict[str, Any]) -> list[str]:
    response = client.post(PATH, query)
    assert response.status_code == 422
    return [error["pointer"] for error in response.json()["errors"]]


@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_yield_warning_starts_at_the_onset(client: Client, factor: float) -> None:
    onset = result_of(client, AXIS)["yield_onset_force"]["tresca"][0]
    result = result_of(client, AXIS | {"load": {"normal_force": [factor * onset, 0.5 * onset]}})
    codes = [notice["code"] for notice in result["warnings"]]
    assert codes == (["yield"] if factor > 1 else [])


def test_response_equals_the_core(client: Client) -> None:
    principal = ["principal_1", "principal_2", "principal_3"]
    result = result_of(client, MAP | {"quantities": NAMES + principal})
    contact = tangential.solve(
        normal.solve(Paraboloid(2.0), 3.0, contact_radius=[0.1, 0.2]), 2.5, 0.3, stick_radius=0.05
    )
    x, z = np.array(MAP["x"]), np.array(MAP["z"])[:, None]
    tensor = subsurface.stress(contact, x, 0.01, z, poissons_ratio=0.3, body=2)
    for name in NAMES:
        expected = getattr(tensor, name.removeprefix("stress_"))
        assert np.array_equal(np.array(result[name]), expected)
    for name, expected in zip(principal, np.moveaxis(tensor.principal, -1, 0)[::-1], strict=True):
        assert np.array_equal(np.array(result[name]), expected)
    assert result["error_estimate"] < 1e-10
    assert "largest" not in result
    assert "yield_onset_force" not in result


def test_bodies_use_their_poissons_ratio(client: Client) -> None:
    steel = {"youngs_modulus": 2e11, "poissons_ratio": 0.3}
    rubber = {"youngs_modulus": 2e6, "poissons_ratio": 0.5}
    given = AXIS | {"material": {"bodies": [steel, rubber]}, "quantities": ["mean_stress"]}
    one, two = (result_of(client, given | {"body": body})["mean_stress"] for body in (1, 2))
    # The trace is proportional to 1 + nu.
    assert np.array(one) * 1.5 == pytest.approx(np.array(two) * 1.3, rel=1e-9, abs=0)


def test_default_points_cover_the_contact(client: Client) -> None:
    query = {key: value for key, value in MAP.items() if key not in ("x", "z")}
    result = result_of(client, query | {"points": 7})
    assert result["x"][0] == -result["x"][-1] == pytest.approx(-0.3, rel=1e-14, abs=0)
    assert (result["z"][0], result["z"][-1]) == (0.0, result["x"][-1])
    assert np.shape(result["von_mises"]) == (2, 7, 7)


def test_default_points_have_no_unit_without_a_load(client: Client) -> None:
    load = {"normal_force": 0.0}
    query = {key: MAP[key] for key in ("profile", "material")} | {"load": load, "points": 3}
    result = result_of(client, query)
    assert result["x"] == result["z"] == [0.0, 0.0, 0.0]
    assert not np.any(result["von_mises"])


def test_infinite_stress_is_null_with_a_warning(client: Client) -> None:
    cone = MAP | {"profile": {"kind": "cone", "slope": 0.05}, "y": 0.0, "largest": True}
    result = result_of(client, cone | {"quantities": ["stress_zz", "von_mises", "stress_xy"]})
    for name in ("stress_zz", "von_mises", "stress_xy"):
        assert result[name][0][0][1] is None
    assert result["largest"]["von_mises"]["value"] == [None, None]
    assert "singular" in {warning["code"] for warning in result["warnings"]}


def test_infinite_largest_stress_is_warned_about_where_no_point_shows_it(client: Client) -> None:
    punch = {"kind": "truncated_cone", "flat_radius": 0.1, "slope": 0.05}
    given = MAP | {"profile": punch, "x": [0.0], "z": [0.05], "largest": True}
    found = client.post(PATH, given | {"tangential": {"stick_radius": 0.1}}).json()
    assert found["von_mises"][1][0][0] > 0
    assert found["largest"]["von_mises"]["value"][1] is None
    assert "singular" in {warning["code"] for warning in found["warnings"]}


def test_formats(client: Client) -> None:
    given = MAP | {"quantities": ["von_mises", "stress_xy"], "largest": True}
    numbers = result_of(client, given)
    headers = {"accept": "text/csv"}
    rows = client.request("POST", PATH, json=given, headers=headers).text.splitlines()
    assert rows[0] == "load,z,x,von_mises,stress_xy"
    assert len(rows) == 1 + 2 * 3 * 4
    cells = np.array([[float(cell) for cell in row.split(",")] for row in rows[1:]])
    assert np.array_equal(cells[:, 3], np.ravel(numbers["von_mises"]))
    assert cells[5].tolist()[:3] == [0.0, 0.04, 0.0]
    headers = {"accept": "application/x-npz"}
    content = client.request("POST", PATH, json=given, headers=headers).content
    with np.load(io.BytesIO(content), allow_pickle=False) as archive:
        assert archive["von_mises"].shape == (2, 3, 4)
        assert archive["largest.von_mises.z"].shape == (2,)
    headers = {"accept": "image/svg+xml"}
    picture = client.request("POST", PATH, json=given, headers=headers).text
    assert "<svg" in picture
    assert picture.count('id="axes_') == 2 * len(given["quantities"])


def test_number_of_points_is_limited(client: Client) -> None:
    assert "/x" in pointers(client, MAP | {"x": [0.0] * 10_000, "z": [0.0] * 10_000})


@pytest.mark.parametrize(
    ("given", "detail"),
    [
        ({}, "x: is required: give x and z, or points"),
        ({"x": [0.0]}, "z: is required: give x and z, or points"),
        (
            {"x": [0.0], "z": [0.0], "points": 3},
            "x: cannot be combined with points: give x and z, or points",
        ),
    ],
)
def test_place_is_points_or_both_coordinates(
    client: Client, given: dict[str, Any], detail: str
) -> None:
    query = {key: value for key, value in MAP.items() if key not in ("x", "z")}
    response = client.post(PATH, query | given)
    assert response.status_code == 422
    assert response.json()["detail"] == detail
