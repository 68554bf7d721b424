"""Fields over HTTP: the core's digits, by load and radius, with a warning for every null."""

import numpy as np
import pytest

from mdr_core import fields, normal, tangential
from mdr_core.validity import ACCURACY
from mdr_service.queries.contacts import singular
from mdr_service.settings import SETTINGS
from tests.conftest import Client
from tests.service.test_normal import E_STAR, PROFILES

G_STAR, FRICTION = 1.9e9, 0.4
OF_NORMAL = ("pressure", "normal_displacement", "foundation_load")
OF_SHEAR = ("shear_stress", "slip", "foundation_shear")
RADII = [0.0, 0.1, 0.3, 1.2, 0.02]


def query(kind: str, load: object, **more: object) -> dict[str, object]:
    return {
        "profile": {"kind": kind, **PROFILES[kind][0]},
        "material": {"e_star": E_STAR, "g_star": G_STAR},
        "load": {"normal_force": load},
        "radius": RADII,
        "quantities": ["pressure"],
        **more,
    }


def friction(**control: object) -> dict[str, object]:
    return {"friction_coefficient": FRICTION, "tangential": control}


def as_json(field: object) -> list[list[float | None]]:
    """Return a field of the core in its JSON representation."""
    return [[value if abs(value) < float("inf") else None for value in row] for row in field]


@pytest.mark.parametrize("kind", PROFILES)
def test_response_equals_the_core(client: Client, kind: str) -> None:
    forces, pushes = [1e5, 2.5e7], [-3e4, 1e7]
    request = query(kind, forces, quantities=[*OF_NORMAL, *OF_SHEAR])
    response = client.post("/v1/stress", request | friction(tangential_force=pushes)).json()
    contact = normal.solve(PROFILES[kind][1], E_STAR, normal_force=forces)
    pushed = tangential.solve(contact, G_STAR, FRICTION, tangential_force=pushes)
    assert response["radius"] == RADII
    for name in (*OF_NORMAL, *OF_SHEAR):
        source = contact if name in OF_NORMAL else pushed
        assert response[name] == as_json(getattr(fields, name)(source, RADII)), name


@pytest.mark.parametrize("name", OF_NORMAL)
def test_only_requested_quantities_are_returned(client: Client, name: str) -> None:
    response = client.post("/v1/stress", query("sphere", 1e5, quantities=[name])).json()
    errors = ["error_estimate", "model_error", "model_error_radius", "model_error_pressure"]
    assert list(response) == ["radius", name, "method", "sources", *errors, "warnings"]
    assert len(response[name]) == 1


def test_normal_fields_repeat_for_every_tangential_load(client: Client) -> None:
    request = query("cone", 1e8, quantities=["pressure", "slip"])
    response = client.post("/v1/stress", request | friction(tangential_force=[1e6, 2e7])).json()
    assert len(response["pressure"]) == len(response["slip"]) == 2
    assert response["pressure"][0] == response["pressure"][1]
    assert response["slip"][0] != response["slip"][1]


@pytest.mark.parametrize("points", [4, 50, 1000])
def test_grid_extends_from_the_axis_beyond_the_edge(client: Client, points: int) -> None:
    request = query("rounded_punch", 1e5, points=points)
    del request["radius"]
    response = client.post("/v1/stress", request).json()
    assert len(response["radius"]) == len(response["pressure"][0]) == points
    assert response["radius"] == sorted(set(response["radius"]))
    assert response["radius"][0] == 0.0
    assert response["pressure"][0][-1] == 0.0


@pytest.mark.parametrize(
    ("kind", "load", "radius", "nulls"),
    [
        ("cone", [1e5, 0.0], [0.0, 0.01], [[True, False], [False, False]]),
        ("flat_punch", [1e5, 0.0], [1.0, 0.2], [[True, False], [False, False]]),
        ("truncated_cone", [1e5], [0.5, 0.2], [[True, False]]),
        ("paraboloid", [1e5], [0.0, 0.01], [[False, False]]),
    ],
)
def test_every_null_has_a_warning(
    client: Client, kind: str, load: object, radius: list[float], nulls: object
) -> None:
    response = client.post("/v1/stress", query(kind, load, radius=radius)).json()
    assert [[value is None for value in row] for row in response["pressure"]] == nulls
    warnings = [each["message"] for each in response["warnings"] if each["code"] == "singular"]
    if any(map(any, nulls)):
        assert warnings == [f"pressure is infinite at radius {radius[0]:g}"]
    else:
        assert warnings == []


def test_many_radii_equal_few(client: Client) -> None:
    radii = [index / 500 for index in range(2000)]
    many = client.post("/v1/stress", query("sphere", 1e8, radius=radii)).json()
    few = client.post("/v1/stress", query("sphere", 1e8, radius=radii[:100])).json()
    assert many["pressure"][0][:100] == pytest.approx(few["pressure"][0], rel=1e-14, abs=0)


def test_loads_times_radii_are_limited(client: Client) -> None:
    loads = [1.0] * 20
    points = SETTINGS.max_numbers // len(loads)
    request = query("paraboloid", loads, points=points + 1)
    del request["radius"]
    response = client.post("/v1/stress", request)
    assert response.status_code == 422
    assert [error["pointer"] for error in response.json()["errors"]] == ["/points"]


def test_estimate_above_the_limit_has_a_warning(client: Client) -> None:
    """Near the contact radius its rounding error adds to the error of the integrals."""
    a = client.post(
        "/v1/normal",
        {k: v for k, v in query("sphere", 1e5).items() if k in ("profile", "material", "load")},
    ).json()["contact_radius"][0]
    for gap in 10.0 ** -np.arange(3, 15):
        document = client.post("/v1/stress", query("sphere", 1e5, radius=[a * (1 - gap)])).json()
        warned = [each for each in document["warnings"] if each["code"] == "accuracy"]
        assert len(warned) == (document["error_estimate"] > ACCURACY), gap


def test_loss_of_accuracy_is_warned_of_once(client: Client) -> None:
    """Both the table and the rounding of the edge next to a radius reduce the accuracy."""
    table = {"kind": "tabulated", "r": [0.0, 0.5, 1.0, 2.0], "f": [0.0, 0.125, 0.5, 2.0]}
    query = {"profile": table, "material": {"e_star": 1.0}, "load": {"normal_force": 0.5}}
    (a,) = client.post("/v1/normal", query).json()["contact_radius"]
    query |= {"radius": [a * (1 - 1e-12)], "quantities": ["pressure"]}
    answer = client.post("/v1/stress", query).json()
    codes = [warning["code"] for warning in answer["warnings"]]
    assert codes.count("accuracy") == 1
    assert answer["error_estimate"] > ACCURACY


@pytest.mark.parametrize(
    ("radii", "listed"), [(5, "0.1, 0.2, 0.3, 0.4, 0.5"), (6, "0.1 to 0.6 (6 radii)")]
)
def test_warning_lists_five_singular_radii(radii: int, listed: str) -> None:
    radius = np.arange(1, radii + 1) / 10
    infinite = np.full((1, radii), np.inf)
    (notice,) = singular(radius, {"pressure": infinite}, {"pressure": True})
    assert notice.message == f"pressure is infinite at radius {listed}"


def test_pressure_is_infinite_at_the_breaks_of_a_table(client: Client) -> None:
    r = [0.0, 0.25, 0.5, 1.0]
    heights = [max(x - 0.25, 0) + max(x - 0.5, 0) for x in np.linspace(0, 1, 17)]
    table = {"r": np.linspace(0, 1, 17).tolist(), "f": heights, "breaks": [0.25, 0.5]}
    body = {
        "profile": {"kind": "tabulated", **table},
        "material": {"e_star": 1},
        "load": {"contact_radius": 0.7},
        "radius": r,
        "quantities": ["pressure"],
    }
    document = client.post("/v1/stress", body).json()
    assert [p is None for p in document["pressure"][0]] == [False, True, True, False]
    messages = [each["message"] for each in document["warnings"]]
    assert "pressure is infinite at radius 0.25, 0.5" in messages


@pytest.mark.parametrize("unit", [1.0, 1e-3, 7e5])
def test_force_one_unit_in_the_last_place_below_full_slip(client: Client, unit: float) -> None:
    """The stress beyond the tiny stick zone is that of full slip, µp of Hertz' contact."""
    force, modulus, curvature = 10.0 * unit, 115e3 * unit, 10.0
    a = float(np.cbrt(3 * force * curvature / (4 * modulus)))
    request: dict[str, object] = {
        "profile": {"kind": "paraboloid", "radius": curvature},
        "material": {"e_star": modulus, "g_star": 95e3 * unit, "poissons_ratio": 0.3},
        "load": {"normal_force": force},
        "friction_coefficient": 0.3,
        "tangential": {"tangential_force": float(np.nextafter(0.3 * force, 0.0))},
    }
    fields_there = {"radius": [0.5 * a], "quantities": ["shear_stress"]}
    surface = client.post("/v1/stress", request | fields_there).json()
    hertz = 0.3 * 1.5 * force / (np.pi * a * a) * np.sqrt(0.75)
    assert surface["shear_stress"][0] == pytest.approx(
        [hertz], rel=surface["error_estimate"], abs=0
    )
    assert surface["error_estimate"] <= 1e-9
    places = {"x": [0.0, 0.5 * a], "z": [0.0, 0.3 * a]}
    beneath = client.post("/v1/subsurface", request | places).json()
    assert beneath["error_estimate"] <= 1e-5
    codes = [warning["code"] for warning in surface["warnings"]]
    assert "accuracy" not in codes
