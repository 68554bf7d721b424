"""A twist over HTTP has the digits of the core, with the shear stress where radii are given."""

from typing import Any

import numpy as np
import pytest

from mdr_core import fields, normal, torsion
from mdr_core.profiles import Paraboloid
from tests.conftest import Client

PATH = "/v1/torsion"
E_STAR, SHEAR, MU = 1.1e11, 4e10, 0.3
BALL = Paraboloid(0.01)


def query(**members: Any) -> dict[str, Any]:
    request: dict[str, Any] = {
        "profile": {"kind": "paraboloid", "radius": 0.01},
        "material": {"e_star": E_STAR, "shear_modulus": SHEAR},
        "load": {"normal_force": [5.0, 10.0]},
        "friction_coefficient": MU,
        "torsion": {"rotation": [1e-3, -2e-3]},
    }
    return request | members


def test_response_equals_the_core(client: Client) -> None:
    response = client.post(PATH, query(points=9, quantities=["pressure", "shear_stress"])).json()
    contact = normal.solve(BALL, E_STAR, normal_force=[5.0, 10.0])
    twist = torsion.solve(contact, SHEAR, MU, rotation=[1e-3, -2e-3])
    for name in ("contact_radius", "normal_stiffness"):
        assert response[name] == getattr(contact, name).tolist()
    for name in torsion.TorsionalContact.quantities:
        assert response[name] == np.broadcast_to(getattr(twist, name), 2).tolist()
    radius = np.array(response["radius"])
    assert response["pressure"] == fields.pressure(contact, radius).tolist()
    assert response["shear_stress"] == fields.torsional_stress(twist, radius).tolist()
    assert twist.error_estimate <= response["error_estimate"] < 1e-9


@pytest.mark.parametrize("control", ["torque", "rotation", "stick_radius"])
def test_every_control_returns_to_the_same_twist(client: Client, control: str) -> None:
    one = client.post(PATH, query(load={"normal_force": 10.0})).json()
    other = query(load={"normal_force": 10.0}, torsion={control: one[control]})
    again = client.post(PATH, other).json()
    for name in ("torque", "rotation", "stick_radius"):
        # A stick radius does not tell the direction of the twist.
        assert np.abs(again[name]) == pytest.approx(np.abs(one[name]), rel=1e-11, abs=0)


def test_stress_of_a_full_slip_balances_the_largest_torque(client: Client) -> None:
    """2 pi int mu p r^2 dr = mu F 3 pi a/16 under a ball, whose stress is mu p everywhere."""
    response = client.post(
        PATH, query(load={"normal_force": 10.0}, torsion={"rotation": 1e3}, points=4)
    ).json()
    (force,), (a,), (arm,) = (
        response[name] for name in ("normal_force", "contact_radius", "torsion_arm")
    )
    assert response["regime"] == ["full_slip"]
    assert response["torque"][0] == pytest.approx(MU * force * arm, rel=1e-12, abs=0)
    assert arm == pytest.approx(3 * np.pi * a / 16, rel=1e-12, abs=0)
    r, tau = np.array(response["radius"]), np.array(response["shear_stress"][0])
    hertz = 3 * force / (2 * np.pi * a * a) * np.sqrt(np.maximum(1 - (r / a) ** 2, 0.0))
    assert tau == pytest.approx(MU * hertz, rel=1e-9, abs=1e-6 * MU * hertz[0])


@pytest.mark.parametrize(
    ("members", "pointer", "words"),
    [
        ({"tangential": {"tangential_force": 1.0}}, "/tangential", "without a tangential load"),
        ({"history": {}}, "/history", "constant normal load"),
        ({"material": {"e_star": 1e9, "g_star": 1e9}}, "/material/shear_modulus", "1/G = 1/G1"),
        ({"torsion": {"torque": [1.0, 1e-5]}}, "/torsion/torque/0", "torsion_arm"),
        ({"torsion": {"stick_radius": 1.0}}, "/torsion/stick_radius", ""),
        ({"torsion": {}}, "/torsion", "exactly one of torque, rotation, stick_radius"),
        ({"torsion": {"torque": [1.0, 2.0, 3.0]}}, "/torsion/torque", "give one, or as many"),
        ({"quantities": ["pressure"]}, "/radius", "need radius or points"),
        (
            {"material": {"e_star": 1e9, "shear_modulus": 1e9, "work_of_adhesion": 1.0}},
            "/material/work_of_adhesion",
            "adhesion with friction",
        ),
        (
            {"material": {"e_star": 1e9, "shear_modulus": 1e9, "yield_strength": 1e6}},
            "/material/yield_strength",
            "is not checked under a twist",
        ),
    ],
)
def test_what_is_not_exact_is_refused_with_the_reason(
    client: Client, members: dict[str, Any], pointer: str, words: str
) -> None:
    response = client.post(PATH, query(**members))
    assert response.status_code == 422
    (error,) = response.json()["errors"]
    assert error["pointer"] == pointer
    assert words in error["detail"]


def test_parameters_give_the_same_response(client: Client) -> None:
    request = query(load={"normal_force": 10.0}, torsion={"torque": [1e-5, 2e-5, 3e-5]})
    words = "kind=paraboloid&radius=0.01&e_star=1.1e11&shear_modulus=4e10&friction_coefficient=0.3"
    ends = "normal_force=10&torque_from=1e-5&torque_to=3e-5&n=3"
    by_url = client.get(f"{PATH}?{words}&{ends}").json()
    by_body = client.post(PATH, request).json()
    assert by_url.keys() == by_body.keys()
    assert by_url["rotation"] == pytest.approx(by_body["rotation"], rel=1e-14, abs=0)


@pytest.mark.parametrize("scale", [1e-16, 1.0, 1e16])
def test_results_follow_the_units(client: Client, scale: float) -> None:
    """With lengths by `scale` and pressures by its inverse, torques are by its square."""
    material = {"e_star": E_STAR / scale, "shear_modulus": SHEAR / scale}
    scaled = query(
        profile={"kind": "paraboloid", "radius": 0.01 * scale},
        material=material,
        load={"normal_force": 10.0 * scale},
    )
    plain = query(load={"normal_force": 10.0})
    found, expected = (client.post(PATH, each).json() for each in (scaled, plain))
    for name, factor in (("torque", scale**2), ("stick_radius", scale), ("rotation", 1.0)):
        assert np.array(found[name]) == pytest.approx(
            factor * np.array(expected[name]), rel=1e-12, abs=0
        )
