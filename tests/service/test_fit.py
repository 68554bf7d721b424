"""Fits over HTTP have the results of the core, and errors point into the request."""

import csv
import io
from typing import Any

import numpy as np
import pytest

from mdr_core import fit
from mdr_core.profiles import Paraboloid
from mdr_service.schemas.answers import FitAnswer
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
    for name in found.quantities[1:]:
        assert document[name] == np.atleast_1d(getattr(found, name)).tolist(), name
    assert document["fit"] == EXAMPLE["fit"]
    # The curve is that of 20 kPa, with contact at 37 nm and an offset of 0.3 nN.
    off = np.array([document[name][0] for name in EXAMPLE["fit"]]) - [2e-5, 37.0, 0.3]
    assert np.abs(off / document["standard_errors"]).max() < 2.5
    assert [warning["code"] for warning in document["warnings"]] == ["half_space"]


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
    # Only a depth holds the states up to the least force.
    assert len(document["residual"]) == a.size - 1 - np.argmin(curve["normal_force"])
