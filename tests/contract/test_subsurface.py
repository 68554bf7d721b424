"""Every format of `/v1/subsurface`, and every request of its page, has a response."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_service.schemas.answers import SubsurfaceAnswer
from mdr_service.schemas.examples import EXAMPLES
from tests.contract import strict_json

if TYPE_CHECKING:
    from tests.conftest import Client

PATH = "/v1/subsurface"
PAGE = (Path(__file__).parents[2] / "docs" / "yield.md").read_text(encoding="utf-8")
REQUESTS = [json.loads(block) for block in re.findall(r"```json\n(.*?)```", PAGE, re.DOTALL)]
HISTORY = EXAMPLES["subsurface"]["end_of_a_cycle"]["value"]
LOADS = EXAMPLES["subsurface"]["partial_slip"]["value"]


def content(client: Client, query: dict[str, Any], media_type: str) -> bytes:
    response = client.request("POST", PATH, json=query, headers={"accept": media_type})
    assert response.status_code == 200, response.content
    assert response.headers["content-type"].partition(";")[0] == media_type
    return bytes(response.content)


@pytest.mark.parametrize("query", [LOADS, HISTORY], ids=["loads", "history"])
def test_every_format_holds_the_same_numbers(client: Client, query: dict[str, Any]) -> None:
    body = content(client, query, "application/json")
    SubsurfaceAnswer.model_validate_json(body)
    answer = strict_json.loads(body)
    names = query.get("quantities", ["von_mises"])
    rows = content(client, query, "text/csv").decode().splitlines()
    assert rows[0] == ",".join(["z", "x", *names])
    cells = np.array([[float(cell) for cell in row.split(",")] for row in rows[1:]])
    with np.load(io.BytesIO(content(client, query, "application/x-npz"))) as archive:
        for column, name in enumerate(names, start=2):
            expected = np.array(answer[name])
            assert np.array_equal(archive[name], expected)
            assert np.array_equal(cells[:, column], expected.ravel())
        for name in ("x", "z"):
            assert np.array_equal(archive[name], np.array(answer[name]))
    picture = content(client, query, "image/svg+xml").decode()
    # A title is broken into lines; its first word is whole.
    titles = (SubsurfaceAnswer.model_fields[name].description or "" for name in names)
    assert all(title.split()[0] in picture for title in titles)


def test_history_excludes_loads(client: Client) -> None:
    for change in ({"load": {"normal_force": 1.0}}, {"tangential": {"tangential_force": 1.0}}):
        response = client.post(PATH, HISTORY | change)
        assert response.status_code == 422
    bare = {name: value for name, value in HISTORY.items() if name != "friction_coefficient"}
    (error,) = client.post(PATH, bare).json()["errors"]
    assert error["pointer"] == "/friction_coefficient"
    strength = HISTORY["material"] | {"yield_strength": 1e9}
    answer = client.post(PATH, HISTORY | {"material": strength}).json()
    # After unloading the ratio of the forces is meaningless.
    assert "yield_onset_force" not in answer
    assert [warning["code"] for warning in answer["warnings"]] == ["yield"]


def test_requests_of_the_page(client: Client) -> None:
    """The results equal the numbers in docs/yield.md."""
    ball, punch, fretting = (client.post(PATH, query).json() for query in REQUESTS)
    p0 = 1.370879e9
    assert ball["yield_onset_force"]["tresca"][0] == pytest.approx(122.3, rel=1e-3, abs=0)
    peak = ball["largest"]["maximum_shear"]
    assert peak["value"][0] / p0 == pytest.approx(0.341, abs=5e-4)
    assert peak["z"] == [0.0]
    query = {name: REQUESTS[1][name] for name in ("profile", "material", "load")}
    mean = client.post("/v1/normal", query).json()["mean_pressure"][0]
    shear = punch["largest"]["maximum_shear"]["value"][0]
    assert mean / (2 * shear) == pytest.approx(1.25, abs=5e-3)
    shear = fretting["largest"]["maximum_shear"]["value"][0]
    assert shear / p0 == pytest.approx(0.455, abs=5e-4)
