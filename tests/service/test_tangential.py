"""Tangential contact over HTTP has the core's results, one entry per pair of loads."""

import pytest

from mdr_core import normal, tangential
from tests.conftest import Client
from tests.service.test_normal import E_STAR, NAMES, PROFILES

G_STAR, FRICTION = 1.9e9, 0.4
TANGENTIAL_NAMES = (
    "tangential_force",
    "tangential_displacement",
    "stick_radius",
    "slip_width",
    "tangential_stiffness",
    "regime",
    "dissipated_energy",
)


def query(kind: str, load: object, **control: object) -> dict[str, object]:
    return {
        "profile": {"kind": kind, **PROFILES[kind][0]},
        "material": {"e_star": E_STAR, "g_star": G_STAR},
        "load": {"normal_force": load},
        "friction_coefficient": FRICTION,
        "tangential": control,
    }


@pytest.mark.parametrize("kind", PROFILES)
def test_response_equals_the_core(client: Client, kind: str) -> None:
    forces, pushes = [1e3, 1e5, 2.5e7], [0.0, -3e4, 1e7]
    response = client.post("/v1/tangential", query(kind, forces, tangential_force=pushes)).json()
    contact = normal.solve(PROFILES[kind][1], E_STAR, normal_force=forces)
    pushed = tangential.solve(contact, G_STAR, FRICTION, tangential_force=pushes)
    for name in NAMES:
        assert response[name] == getattr(contact, name).tolist()
    for name in TANGENTIAL_NAMES:
        assert response[name] == getattr(pushed, name).tolist()
    assert response["regime"][:2] == ["stick", "stick" if kind == "flat_punch" else "partial_slip"]
    assert response["method"] == pushed.method
    assert response["error_estimate"] == pushed.error_estimate


@pytest.mark.parametrize(
    ("load", "control", "count"),
    [(1e5, 1e4, 1), ([1e5], 1e4, 1), (1e5, [1e4, 2e4], 2), ([1e5, 2e5], 1e4, 2)],
)
def test_scalar_loads_broadcast(client: Client, load: object, control: object, count: int) -> None:
    response = client.post("/v1/tangential", query("cone", load, tangential_force=control)).json()
    for name in (*NAMES, *TANGENTIAL_NAMES):
        assert len(response[name]) == count


def test_bodies_give_the_shear_modulus(client: Client) -> None:
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
    request = query("cone", 1e5, tangential_force=1e4)
    request["material"] = {"bodies": [steel, steel]}
    (stiffness,), (c,) = (
        client.post("/v1/tangential", request).json()[name]
        for name in ("tangential_stiffness", "stick_radius")
    )
    shear_modulus = 210e9 / (2 * 1.3)
    assert stiffness == pytest.approx(2 * c * 2 * shear_modulus / (2 - 0.3), rel=1e-14, abs=0)


STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
RUBBER = {"youngs_modulus": 5e6, "poissons_ratio": 0.4}


@pytest.mark.parametrize(
    ("path", "material", "codes"),
    [
        ("normal", {"bodies": ["rigid", RUBBER]}, set()),
        ("tangential", {"bodies": ["rigid", RUBBER]}, {"elastic_similarity"}),
        ("tangential", {"bodies": [STEEL, STEEL]}, set()),
        ("normal", {"bodies": [STEEL, STEEL], "yield_strength": 1e6}, {"yield"}),
        ("tangential", {"bodies": [STEEL, STEEL], "yield_strength": 1e6}, {"yield"}),
        ("normal", {"bodies": [STEEL, STEEL], "yield_strength": 1e12}, set()),
        ("tangential", {"bodies": [STEEL, STEEL], "yield_strength": 1e12}, set()),
        ("tangential", {"e_star": 1e9, "g_star": 1e9}, set()),
        ("tangential", {"e_star": 1e9, "g_star": 1e8}, {"impossible_moduli"}),
        ("normal", {"e_star": 1e9, "yield_strength": 1e4}, {"yield"}),
        ("normal", {"e_star": 1e9, "body_thickness": 1e-3}, {"thin_body"}),
        ("tangential", {"bodies": [STEEL, STEEL], "body_thickness": 1e-3}, {"thin_body"}),
        ("tangential", {"bodies": [STEEL, STEEL], "body_thickness": 1.0}, set()),
    ],
)
def test_validity_warnings(client: Client, path: str, material: object, codes: set[str]) -> None:
    request = query("paraboloid", 1e3, tangential_force=1.0) | {"material": material}
    if path == "normal":
        del request["friction_coefficient"], request["tangential"]
    response = client.post(f"/v1/{path}", request)
    assert {warning["code"] for warning in response.json()["warnings"]} == codes
