"""A layer in the material is computed with where its contact is exact, and rejected elsewhere."""

from typing import Any

import pytest

from tests.conftest import Client

BALL = {"kind": "paraboloid", "radius": 5e-6}
LAYER = {"thickness": 4e-6, "base": "bonded"}
GEL = {"youngs_modulus": 2e3, "poissons_ratio": 0.5}
MATERIAL = {"bodies": ["rigid", GEL], "layer": LAYER}
REQUEST = {"profile": BALL, "material": MATERIAL, "load": {"indentation_depth": 1e-6}}


def _answer(client: Client, path: str, request: dict[str, Any]) -> Any:
    response = client.post(path, request)
    assert response.status_code == 200, response.text
    return response.json()


def test_gel_on_glass(client: Client) -> None:
    # By 30 digits of the integral equation.
    moduli = {"e_star": 8000 / 3, "poissons_ratio": 0.5, "layer": LAYER}
    alone = {"e_star": 8000 / 3, "layer": LAYER | {"poissons_ratio": 0.5}}
    for material in (MATERIAL, moduli, alone):
        found = _answer(client, "/v1/normal", REQUEST | {"material": material})
        assert found["contact_radius"] == pytest.approx([2.82794292798e-06], rel=1e-10, abs=0)
        assert found["normal_force"] == pytest.approx([1.90928206748e-08], rel=1e-10, abs=0)
        assert found["method"] == "quadrature"
        codes = [warning["code"] for warning in found["warnings"]]
        assert codes == ["half_space", "large_strain", "layer_strain"]


def test_normal_fields_and_adhesion(client: Client) -> None:
    names = ["pressure", "normal_displacement", "foundation_load"]
    request = REQUEST | {"radius": [0.0, 1e-6, 9e-6], "quantities": names}
    found = _answer(client, "/v1/stress", request)
    peak = _answer(client, "/v1/normal", REQUEST)["maximum_pressure"][0]
    assert found["pressure"][0][0] == pytest.approx(peak, rel=1e-12, abs=0)
    inside = [1e-6, 1e-6 - 1e-12 / 1e-5]
    assert found["normal_displacement"][0][:2] == pytest.approx(inside, rel=1e-12, abs=0)
    sticky = MATERIAL | {"work_of_adhesion": 1e-4}
    adhesive = _answer(client, "/v1/normal", REQUEST | {"material": sticky})
    assert adhesive["pull_off_force"][0] < 0 < adhesive["normal_force"][0]


def test_fit_of_a_curve(client: Client) -> None:
    depths = [k * 2e-8 for k in range(51)]
    force = _answer(client, "/v1/normal", REQUEST | {"load": {"indentation_depth": depths}})
    curve = {"indentation_depth": depths, "normal_force": force["normal_force"]}
    # Poisson's ratio of the sample is that of the layer.
    for sample in (
        {"layer": LAYER | {"poissons_ratio": 0.5}},
        {"layer": LAYER, "poissons_ratio": 0.5},
    ):
        found = _answer(client, "/v1/normal/fit", {"profile": BALL} | curve | sample)
        assert found["e_star"] == pytest.approx([8000 / 3], rel=1e-8, abs=0)


@pytest.mark.parametrize(
    ("path", "more", "pointer"),
    [
        (
            "/v1/tangential",
            {"friction_coefficient": 0.3, "tangential": {"stick_radius": 1e-7}},
            "/material/layer",
        ),
        ("/v1/subsurface", {"x": [0.0], "z": [1e-6], "body": 2}, "/material/layer"),
        (
            "/v1/wear",
            {"friction_coefficient": 0.3, "oscillation": {"tangential_displacement": 1e-9}},
            "/material/layer",
        ),
        ("/v1/normal", {"material": MATERIAL | {"body_thickness": 1e-6}}, "/material/layer"),
        ("/v1/normal", {"material": MATERIAL | {"yield_strength": 1e3}}, "/material/layer"),
        (
            "/v1/normal",
            {"material": {"e_star": 1e3, "layer": LAYER}},
            "/material/poissons_ratio",
        ),
        ("/v1/normal", {"load": {"contact_radius": 5e-5}}, "/load/contact_radius"),
    ],
)
def test_rejected_with_the_reason(
    client: Client, path: str, more: dict[str, Any], pointer: str
) -> None:
    response = client.post(path, REQUEST | more)
    assert response.status_code == 422
    (error,) = response.json()["errors"]
    assert error["pointer"] == pointer
