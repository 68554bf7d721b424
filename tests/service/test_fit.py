"""Fits over HTTP have the results of the core, and errors point into the request."""

import csv
import io
from typing import Any

import numpy as np
import pytest

from mdr_core import fit, hysteresis, normal
from mdr_core.profiles import Paraboloid
from mdr_service.schemas.answers import FitAnswer, LoopAnswer
from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import Client

PATH = "/v1/normal/fit"
EXAMPLE = EXAMPLES["fit"]["hydrogel"]["value"]


def query(**changed: Any) -> dict[str, Any]:
    return EXAMPLE | changed


def test_response_equals_the_core(client: Client) -> None:
    document = client.post(PATH, query()).json()
    FitAnswer.model_validate(document)
    curve = {name: EXAMPLE[name] for name in ("indentation_depth", "normal_force", "fit")}
    found = fit.solve(Paraboloid(5000.0), **curve)
    known = [name for name in found.quantities[1:] if getattr(found, name) is not None]
    for name in known:
        assert document[name] == np.atleast_1d(getattr(found, name)).tolist(), name
    assert document["fit"] == EXAMPLE["fit"]
    # The curve is that of 20 kPa, with contact at 37 nm and an offset of 0.3 nN.
    off = np.array([document[name][0] for name in EXAMPLE["fit"]]) - [2e-5, 37.0, 0.3]
    assert np.abs(off / document["standard_errors"]).max() < 2.5
    assert [warning["code"] for warning in document["warnings"]] == ["half_space", "large_strain"]


def test_young_s_modulus_of_the_sample(client: Client) -> None:
    # 1/E* = (1 - 0.5²)/E + (1 - 0.25²)/1e-4.
    silica = {"youngs_modulus": 1e-4, "poissons_ratio": 0.25}
    document = client.post(PATH, query(poissons_ratio=0.5, indenter=silica)).json()
    e_star, error = document["e_star"][0], document["standard_errors"][0]
    modulus = 0.75 / (1 / e_star - 0.9375 / 1e-4)
    assert document["youngs_modulus"] == pytest.approx([modulus], rel=1e-12, abs=0)
    step = 1e-6 * e_star
    slope = (0.75 / (1 / (e_star + step) - 0.9375 / 1e-4) - modulus) / step
    expected = pytest.approx([slope * error], rel=1e-4, abs=0)
    assert document["youngs_modulus_error"] == expected
    soft = silica | {"youngs_modulus": 1e-6}
    refused = client.post(PATH, query(poissons_ratio=0.5, indenter=soft))
    assert refused.status_code == 422
    assert refused.json()["errors"][0]["pointer"] == "/indenter"


def test_segment_of_a_curve_with_two_branches(client: Client) -> None:
    d = [i / 20 for i in range(21)]
    curve = {
        "profile": {"kind": "paraboloid", "radius": 1.0},
        "indentation_depth": d + d[::-1],
        "normal_force": [x**1.5 for x in d] + [max((x - 0.3) / 0.7, 0) ** 1.5 for x in d[::-1]],
    }
    codes = [each["code"] for each in client.post(PATH, curve).json()["warnings"]]
    assert "two_branches" in codes
    for segment, point, modulus in (("loading", 0.0, 0.75), ("unloading", 0.3, 0.75 / 0.7**1.5)):
        document = client.post(PATH, curve | {"segment": segment}).json()
        assert document["e_star"] == pytest.approx([modulus], rel=1e-9, abs=0)
        assert document["contact_point"] == pytest.approx([point], rel=1e-9, abs=1e-9)
        assert "two_branches" not in [each["code"] for each in document["warnings"]]


def test_drift_is_subtracted(client: Client) -> None:
    d = [i / 20 for i in range(21)]
    curve = {
        "profile": {"kind": "paraboloid", "radius": 1.0},
        "indentation_depth": [x + 1e-3 * i for i, x in enumerate(d)],
        "normal_force": [x**1.5 for x in d],
        "time": [float(i) for i in range(21)],
    }
    asked = curve | {"drift_rate": 1e-3, "drift_rate_error": 1e-5}
    document = client.post(PATH, asked).json()
    FitAnswer.model_validate(document)
    assert document["e_star"] == pytest.approx([0.75], rel=1e-9, abs=0)
    assert (document["drift_rate"], document["drift_rate_error"]) == ([1e-3], [1e-5])
    assert document["indentation_depth"] == pytest.approx(d, abs=1e-12)
    refused = client.post(PATH, curve | {"drift": "hold"})
    assert refused.json()["errors"][0]["pointer"] == "/drift"


def test_thickness_of_the_body(client: Client) -> None:
    body = {"body_thickness": 2000.0}
    known = {"fit": ["contact_point"], "material": {"e_star": 2e-5} | body}
    for asked in (body, known):
        document = client.post(PATH, query(**asked)).json()
        assert "thin_body" in [warning["code"] for warning in document["warnings"]]
        assert document["model_error"][0] > 0.1


def test_wrong_shape_is_a_warning(client: Client) -> None:
    punch = {"kind": "flat_punch", "radius": 300.0}
    document = client.post(PATH, query(profile=punch)).json()
    assert "misfit" in [warning["code"] for warning in document["warnings"]]


def test_known_material(client: Client) -> None:
    asked = query(fit=["contact_point", "force_offset"], material={"e_star": 2e-5})
    document = client.post(PATH, asked).json()
    assert document["e_star"] == [2e-5]
    assert document["contact_point"][0] == pytest.approx(37.0, abs=1.5)


def test_yield_strength_warns_at_the_largest_load(client: Client) -> None:
    # Under Hertz's contact the largest pressure is p = (2 E*/pi) (d/R)^(1/2).
    depth = np.linspace(0.0, 1e-6, 20)
    curve = {
        "profile": {"kind": "paraboloid", "radius": 0.01},
        "indentation_depth": depth.tolist(),
        "normal_force": (4 / 3 * 1e9 * np.sqrt(0.01) * depth**1.5).tolist(),
        "fit": ["contact_point"],
    }
    pressure = 2e9 * np.sqrt(1e-4) / np.pi

    def asked(ratio: float, **changed: Any) -> Any:
        known = {"e_star": 1e9, "poissons_ratio": 0.3, "yield_strength": pressure / ratio}
        return client.post(PATH, curve | {"material": known} | changed).json()

    # Yield begins at p = 1.61 Y for Poisson's ratio 0.3 by Tresca.
    for ratio in (1.55, 1.65):
        codes = [warning["code"] for warning in asked(ratio)["warnings"]]
        assert ("yield" in codes) == (ratio > 1.61)
    layer = {"thickness": 1e-3, "base": "frictionless"}
    for changed in ({"fit": ["contact_point", "work_of_adhesion"]}, {"layer": layer}):
        pointers = [each["pointer"] for each in asked(1.55, **changed)["errors"]]
        assert pointers == ["/material/yield_strength"]


def test_table_and_picture(client: Client) -> None:
    rows = list(csv.DictReader(io.StringIO(client.post(f"{PATH}?format=csv", query()).text)))
    assert [float(row["indentation_depth"]) for row in rows] == EXAMPLE["indentation_depth"]
    sums = [float(row["normal_force"]) + float(row["residual"]) for row in rows]
    assert sums == pytest.approx(EXAMPLE["normal_force"], abs=1e-12)
    assert "Measured less fitted" in client.post(f"{PATH}?format=svg", query()).text


def test_work_of_adhesion_from_a_curve_of_jkr(client: Client) -> None:
    # E* = 1, R = 1: d = a² - (2πwa)^(1/2), F = 4/3 a³ - (8πwa³)^(1/2), in another coordinate.
    a, w = np.geomspace(0.1, 0.4, 40), 1e-3
    curve = {
        "indentation_depth": (a**2 - np.sqrt(2 * np.pi * w * a) + 0.5).tolist(),
        "normal_force": (4 / 3 * a**3 - np.sqrt(8 * np.pi * w * a**3)).tolist(),
        "fit": ["e_star", "contact_point", "work_of_adhesion"],
    }
    ball = {"kind": "paraboloid", "radius": 1.0}
    document = client.post(PATH, {"profile": ball, **curve}).json()
    FitAnswer.model_validate(document)
    found = [document[name][0] for name in curve["fit"]]
    assert found == pytest.approx([1.0, 0.5, w], rel=1e-8, abs=0)
    assert document["force_offset"] == [0.0]
    # Only a depth holds the states before the least force, dF/da = 0.
    assert len(document["residual"]) == np.sum(a**1.5 >= 3 / 8 * np.sqrt(8 * np.pi * w))


def test_loop_equals_the_core(client: Client) -> None:
    loop = EXAMPLES["tangential_fit"]["ball_on_glass"]["value"]
    document = client.post("/v1/tangential/fit", loop).json()
    LoopAnswer.model_validate(document)
    contact = normal.solve(Paraboloid(5.0), 48e3, normal_force=2.0)
    lists = {name: loop[name] for name in ("tangential_displacement", "tangential_force")}
    found = hysteresis.solve(contact, **lists)
    for name in found.quantities[1:]:
        assert document[name] == np.atleast_1d(getattr(found, name)).tolist(), name
    # The loop is that of 40 GPa and a friction of 0.3, with a rig as stiff as the contact.
    off = np.array([document[name][0] for name in document["fit"]]) - [4e4, 0.3, 0.03, 2.4e-4]
    assert np.abs(off / document["standard_errors"]).max() < 2.5
    assert document["warnings"] == []
    # Taken as rigid, the rig halves the stiffness, and is a misfit.
    rigid = client.post("/v1/tangential/fit", loop | {"rig_compliance": 0}).json()
    assert rigid["g_star"][0] < 3e4
    assert "misfit" in [warning["code"] for warning in rigid["warnings"]]
    # Given parameters are not fitted, and two bodies have a shear modulus.
    names = ["rig_compliance", "force_offset", "displacement_offset"]
    fitted = client.post("/v1/tangential/fit", loop | {"fit": names}).json()
    assert fitted["errors"][0]["pointer"] == "/material/g_star"
    known = {"material": {"e_star": 48e3, "g_star": 4e4}, "friction_coefficient": 0.3}
    fitted = client.post("/v1/tangential/fit", loop | {"fit": names} | known).json()
    assert fitted["fit"] == names
    off = np.subtract([fitted[name][0] for name in names], [2.4e-4, 0.03, 0.0])
    assert np.abs(off / fitted["standard_errors"]).max() < 3
    depth = {"indentation_depth": float(contact.indentation_depth)}
    other = {name: value for name, value in loop.items() if name != "normal_force"} | depth
    by_depth = client.post("/v1/tangential/fit", other).json()
    assert by_depth["g_star"] == pytest.approx(document["g_star"], rel=1e-9, abs=0)
    soft = loop | {"material": {"e_star": 48e3, "poissons_ratio": 0.3, "yield_strength": 1.0}}
    codes = [each["code"] for each in client.post("/v1/tangential/fit", soft).json()["warnings"]]
    assert "yield" in codes
    rows = list(
        csv.DictReader(io.StringIO(client.post("/v1/tangential/fit?format=csv", loop).text))
    )
    assert [float(row["residual"]) for row in rows] == document["residual"]
