"""Wear over HTTP has the results of the core, and only the quantities requested."""

from typing import Any

import numpy as np
import pytest

from mdr_core import normal
from mdr_core.wear import evolution, limit
from mdr_service.settings import SETTINGS
from tests.conftest import Client
from tests.service.test_normal import E_STAR, PROFILES

G_STAR, FRICTION = 1.9e9, 0.4
LIMIT, EVOLUTION = "/v1/wear", "/v1/wear/evolution"
LIMITS = ("stick_radius", "wear_radius", "indentation_depth", "normal_force", "worn_volume")
OVER_CYCLES = (
    "cycles",
    "worn_volume",
    "indentation_depth",
    "normal_force",
    "stick_radius",
    "contact_radius",
    "dissipated_energy",
)
RADII = [0.0, 0.001, 0.01, 0.05, 0.3]
CONTROLS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "depth and displacement": (
        {"indentation_depth": 1e-3},
        {"tangential_displacement": 3e-4},
    ),
    "forces": ({"normal_force": 1e5}, {"tangential_force": 3e4}),
    "force and displacement": ({"normal_force": 1e5}, {"tangential_displacement": 1e-5}),
    "depth and force": ({"indentation_depth": 1e-3}, {"tangential_force": 1e2}),
}
KINDS = ["paraboloid", "cone", "truncated_paraboloid", "tabulated"]


def query(kind: str, load: object, oscillation: object, **more: object) -> dict[str, object]:
    return {
        "profile": {"kind": kind, **PROFILES[kind][0]},
        "material": {"e_star": E_STAR, "g_star": G_STAR},
        "friction_coefficient": FRICTION,
        "load": load,
        "oscillation": oscillation,
        **more,
    }


def evolution_query(
    kind: str = "paraboloid", control: str = "forces", **more: object
) -> dict[str, object]:
    return query(
        kind, *CONTROLS[control], **({"wear_coefficient": 1e-13, "cycles": [1.0, 1e6]} | more)
    )


def worn(kind: str, load: dict[str, Any], oscillation: dict[str, Any]) -> limit.LimitingWear:
    contact = normal.solve(PROFILES[kind][1], E_STAR, **load)
    return limit.solve(contact, G_STAR, FRICTION, **oscillation)


def as_json(values: Any) -> Any:
    return np.where(np.isfinite(values), values, None).tolist()


def codes(document: dict[str, Any]) -> set[str]:
    return {each["code"] for each in document["warnings"]}


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("kind", KINDS)
def test_limit_equals_the_core(client: Client, kind: str, control: str) -> None:
    names = ["initial_profile", "limiting_profile", "worn_depth", "pressure"]
    body = query(kind, *CONTROLS[control], radius=RADII, quantities=names)
    document = client.post(LIMIT, body).json()
    expected = worn(kind, *CONTROLS[control])
    for name in LIMITS:
        assert document[name] == [float(getattr(expected, name))], name
    assert document["regime"] == [str(expected.regime)]
    assert document["radius"] == RADII
    assert document["initial_profile"] == expected.initial_profile(RADII).tolist()
    for name in names[1:]:
        assert document[name] == [as_json(getattr(expected, name)(RADII))], name
    of_fields = expected.field_error_estimate(RADII, names)
    assert document["error_estimate"] == expected.error_estimate + of_fields
    assert ("path_dependent" in codes(document)) == (control == "force and displacement")


def test_radius_next_to_the_stick_edge_is_in_the_estimate(client: Client) -> None:
    body = query("paraboloid", *CONTROLS["forces"], quantities=["pressure"])
    c = client.post(LIMIT, body | {"points": 9}).json()["stick_radius"][0]
    for gap, expected in ((1e-2, set()), (1e-8, {"accuracy"})):
        document = client.post(LIMIT, body | {"radius": [c * (1 - gap)]}).json()
        assert codes(document) - {"half_space"} == expected
        # c has an error of a few units in the last place, the pressure the root of its distance.
        assert document["error_estimate"] < 1e-11 + 1e-14 / gap


@pytest.mark.every(9)
@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("kind", KINDS)
def test_evolution_equals_the_core(client: Client, kind: str, control: str) -> None:
    names = ["profile", "worn_depth", "pressure"]
    body = evolution_query(kind, control, radius=RADII, quantities=names, resolution=8)
    response = client.post(EVOLUTION, body)
    document = response.json()
    contact = normal.solve(PROFILES[kind][1], E_STAR, **CONTROLS[control][0])
    expected = evolution.solve(
        contact,
        G_STAR,
        FRICTION,
        wear_coefficient=1e-13,
        cycles=[1.0, 1e6],
        resolution=8,
        **CONTROLS[control][1],
    )
    for name in OVER_CYCLES:
        assert document[name] == getattr(expected, name).tolist(), name
    for name in names:
        assert document[name] == as_json(getattr(expected, name)(RADII)), name
    assert document["error_estimate"] == expected.error_estimate
    assert document["field_error_estimate"] == expected.field_error_estimate(RADII, names)


def test_full_slip_wears_the_whole_contact(client: Client) -> None:
    """Force and depth held; a force amplitude at the limit of friction has no stroke."""
    moved = {"tangential_displacement": 0.1}
    for load, code in (
        ({"normal_force": 1e5}, "endless_wear"),
        ({"indentation_depth": 1e-3}, "contact_lost"),
    ):
        more = {"wear_coefficient": 1e-13, "cycles": [1.0, 1e4], "radius": [0.0, 0.01]}
        body = query("paraboloid", load, moved, **more)
        document = client.post(EVOLUTION, body).json()
        assert code in codes(document)
        assert document["stick_radius"] == [0.0, 0.0]
        assert 0 < document["worn_volume"][0] < document["worn_volume"][1]
        assert document["profile"][1][0] > 0
    at_limit = {"tangential_force": FRICTION * 1e5}
    pointer, detail = rejection(client, EVOLUTION, body | {"load": {"normal_force": 1e5}} | {
        "oscillation": at_limit
    })  # fmt: skip
    assert pointer == "/oscillation/tangential_force"
    assert "prescribe the displacement" in detail


def test_limits_of_many_loads(client: Client) -> None:
    loads, pushes = {"normal_force": [1e5, 2e5, 0.0]}, {"tangential_force": [1e4, 8e4, 0.0]}
    document = client.post(LIMIT, query("paraboloid", loads, pushes, radius=RADII)).json()
    expected = worn("paraboloid", loads, pushes)
    for name in LIMITS:
        assert document[name] == as_json(getattr(expected, name)), name
    assert document["limiting_profile"] == as_json(expected.limiting_profile(RADII))
    assert document["initial_profile"] == expected.initial_profile(RADII).tolist()
    # 0.4 x 2e5 N is the friction limit.
    assert document["worn_volume"][1] is None
    assert {"endless_wear", "no_wear"} <= codes(document)
    pushes = {"tangential_force": [1e4, 2e4, 3e4]}
    one = client.post(LIMIT, query("paraboloid", {"normal_force": 1e5}, pushes)).json()
    assert len(one["stick_radius"]) == 3


def test_only_requested_quantities_are_returned(client: Client) -> None:
    for path, body, of_radii, default in (
        (
            LIMIT,
            query("cone", *CONTROLS["forces"]),
            {"radius"},
            {"initial_profile", "limiting_profile"},
        ),
        (
            EVOLUTION,
            evolution_query("cone", resolution=8),
            {"radius", "field_error_estimate"},
            {"profile", "pressure"},
        ),
    ):
        plain = set(client.post(path, body).json())
        assert not plain & {"radius", "pressure", "profile", "worn_depth", "initial_profile"}
        assert set(client.post(path, body | {"radius": RADII}).json()) - plain == (
            default | of_radii
        )
        chosen = client.post(path, body | {"radius": RADII, "quantities": ["worn_depth"]}).json()
        assert set(chosen) - plain == of_radii | {"worn_depth"}


def test_default_radii_include_the_edges(client: Client) -> None:
    document = client.post(LIMIT, query("cone", *CONTROLS["forces"], points=50)).json()
    assert {*document["stick_radius"], *document["wear_radius"]} <= set(document["radius"])
    document = client.post(EVOLUTION, evolution_query("cone", points=50, resolution=8)).json()
    assert {*document["stick_radius"], *document["contact_radius"]} <= set(document["radius"])
    assert len(document["radius"]) == len(document["profile"][1]) == 50


def test_pressure_at_the_stick_edge_is_infinite(client: Client) -> None:
    body = query("paraboloid", *CONTROLS["forces"], points=50, quantities=["pressure"])
    document = client.post(LIMIT, body).json()
    at = document["radius"].index(document["stick_radius"][0])
    assert [where for where, p in enumerate(document["pressure"][0]) if p is None] == [at]
    assert "singular" in codes(document)


def test_profile_outside_a_flat_punch_is_infinite(client: Client) -> None:
    radii = [0.1, 1.0, 1.1]
    control = {"normal_force": 1e5}, {"tangential_force": 1e4}
    for path, names, more in (
        (LIMIT, ("initial_profile", "limiting_profile"), {}),
        (EVOLUTION, ("profile",), {"wear_coefficient": 1e-13, "cycles": [1.0]}),
    ):
        response = client.post(path, query("flat_punch", *control, radius=radii, **more))
        document = response.json()
        for name in names:
            assert np.ravel(document[name]).tolist() == [0.0, 0.0, None]
        # In the same order in every process.
        messages = [each["message"] for each in document["warnings"][-len(names) :]]
        assert messages == [f"{name} is infinite at radius 1.1" for name in names]


def test_many_radii_equal_few(client: Client) -> None:
    body = evolution_query(control="force and displacement", resolution=8, cycles=[1e6])
    many = client.post(EVOLUTION, body | {"points": 5_000}).json()
    few = many["radius"][1_990:2_010]
    assert client.post(EVOLUTION, body | {"radius": few}).json()["profile"] == [
        many["profile"][0][1_990:2_010]
    ]


def rejection(client: Client, path: str, body: object) -> tuple[str, str]:
    response = client.post(path, body)
    assert response.status_code == 422
    ((error),) = response.json()["errors"]
    return error["pointer"], error["detail"]


def test_too_many_numbers_are_rejected(client: Client) -> None:
    radii = {"points": 1 + SETTINGS.max_numbers // 100}
    loads = {"normal_force": [1e5] * 100}
    body = query("paraboloid", loads, {"tangential_force": 1e4}, **radii)
    assert rejection(client, LIMIT, body)[0] == "/points"
    response = client.post(EVOLUTION, evolution_query(cycles=[1.0] * 100, **radii))
    # The estimated time exceeds its limit, too, and is reported together with the feasible size.
    assert response.status_code == 422
    assert "/points" in {error["pointer"] for error in response.json()["errors"]}


def test_yield_and_material_warnings(client: Client) -> None:
    bodies = ["rigid", {"youngs_modulus": 5e6, "poissons_ratio": 0.4}]
    material = {"material": {"bodies": bodies, "yield_strength": 1.0}}
    load, push = {"normal_force": 1.0}, {"tangential_force": 0.1}
    limits = query("paraboloid", load, push) | material
    for path, body in (
        (LIMIT, limits),
        (EVOLUTION, limits | {"wear_coefficient": 1e-13, "cycles": [1.0], "resolution": 8}),
    ):
        assert {"elastic_similarity", "yield"} <= codes(client.post(path, body).json())


def test_radius_beyond_the_profile_is_rejected(client: Client) -> None:
    sphere = {"profile": {"kind": "sphere", "radius": 0.5}, "resolution": 8}
    body = evolution_query(control="forces", radius=[0.0, 0.49, 0.51]) | sphere
    pointer, detail = rejection(client, EVOLUTION, body)
    assert pointer == "/radius/2"
    assert "the profile ends at radius 0.49999" in detail
    assert client.post(EVOLUTION, body | {"radius": [0.0, 0.49]}).status_code == 200
