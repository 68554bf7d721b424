"""Fields over the wire: the core's digits, by load and radius, and every null explained."""

import pytest

from mdr_core import fields, normal, tangential
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


def told(field: object) -> list[list[float | None]]:
    """Return a field of the core as the wire has it."""
    return [[value if abs(value) < float("inf") else None for value in row] for row in field]


@pytest.mark.parametrize("kind", PROFILES)
def test_wire_and_core_agree_digit_for_digit(client: Client, kind: str) -> None:
    forces, pushes = [1e5, 2.5e7], [-3e4, 1e7]
    question = query(kind, forces, quantities=[*OF_NORMAL, *OF_SHEAR])
    answer = client.post("/v1/stress", question | friction(tangential_force=pushes)).json()
    contact = normal.solve(PROFILES[kind][1], E_STAR, normal_force=forces)
    pushed = tangential.solve(contact, G_STAR, FRICTION, tangential_force=pushes)
    assert answer["radius"] == RADII
    for name in OF_NORMAL:
        assert answer[name] == told(getattr(fields, name)(contact, RADII)), name
    for name in OF_SHEAR:
        assert answer[name] == told(getattr(fields, name)(pushed, RADII)), name


@pytest.mark.parametrize("name", OF_NORMAL)
def test_only_what_is_asked_for_is_answered(client: Client, name: str) -> None:
    answer = client.post("/v1/stress", query("sphere", 1e5, quantities=[name])).json()
    assert list(answer) == ["radius", name, "method", "error_estimate", "warnings"]
    assert len(answer[name]) == 1


def test_fields_of_the_pressing_alone_repeat_for_every_push(client: Client) -> None:
    question = query("cone", 1e8, quantities=["pressure", "slip"])
    answer = client.post("/v1/stress", question | friction(tangential_force=[1e6, 2e7])).json()
    assert len(answer["pressure"]) == len(answer["slip"]) == 2
    assert answer["pressure"][0] == answer["pressure"][1]
    assert answer["slip"][0] != answer["slip"][1]


@pytest.mark.parametrize("points", [4, 50, 1000])
def test_a_grid_reaches_from_the_middle_past_the_edge(client: Client, points: int) -> None:
    question = query("rounded_punch", 1e5, points=points)
    del question["radius"]
    answer = client.post("/v1/stress", question).json()
    assert len(answer["radius"]) == len(answer["pressure"][0]) == points
    assert answer["radius"] == sorted(set(answer["radius"]))
    assert answer["radius"][0] == 0.0
    assert answer["pressure"][0][-1] == 0.0


@pytest.mark.parametrize(
    ("kind", "load", "radius", "nulls"),
    [
        ("cone", [1e5, 0.0], [0.0, 0.01], [[True, False], [False, False]]),
        ("flat_punch", [1e5, 0.0], [0.3, 0.2], [[True, False], [False, False]]),
        ("truncated_cone", [1e5], [0.3, 0.2], [[True, False]]),
        ("paraboloid", [1e5], [0.0, 0.01], [[False, False]]),
    ],
)
def test_every_null_is_explained(
    client: Client, kind: str, load: object, radius: list[float], nulls: object
) -> None:
    answer = client.post("/v1/stress", query(kind, load, radius=radius)).json()
    assert [[value is None for value in row] for row in answer["pressure"]] == nulls
    warnings = [each["message"] for each in answer["warnings"] if each["code"] == "singular"]
    if any(map(any, nulls)):
        assert warnings == [f"pressure is infinite at radius {radius[0]:g}"]
    else:
        assert warnings == []


def test_many_radii_are_answered_as_few_are(client: Client) -> None:
    radii = [index / 500 for index in range(2000)]
    many = client.post("/v1/stress", query("sphere", 1e8, radius=radii)).json()
    few = client.post("/v1/stress", query("sphere", 1e8, radius=radii[:100])).json()
    assert many["pressure"][0][:100] == few["pressure"][0]


def test_loads_times_radii_are_limited(client: Client) -> None:
    loads = [1.0] * 20
    points = SETTINGS.max_numbers // len(loads)
    question = query("paraboloid", loads, points=points + 1)
    del question["radius"]
    answer = client.post("/v1/stress", question)
    assert answer.status_code == 422
    assert [error["pointer"] for error in answer.json()["errors"]] == ["/points"]
