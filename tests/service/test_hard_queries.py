"""Hard queries have finite results in a short time, or an error with a pointer."""

import json
from pathlib import Path
from typing import Any

import pytest

from mdr_service import queries
from mdr_service.problems import MEDIA_TYPE
from tests.conftest import Client
from tests.contract import strict_json

QUERIES: dict[str, Any] = json.loads(
    Path(__file__).with_name("data").joinpath("hard_queries.json").read_text("utf-8")
)
ENDPOINTS = {name: kind.path for name, kind in queries.QUERIES.items()}


@pytest.mark.parametrize(
    "name",
    # Extreme ratio of moduli: it takes seconds until the tolerance proves unreachable.
    [
        pytest.param(name, marks=[pytest.mark.long] if name == "evolution_gstar1" else [])
        for name in QUERIES
    ],
)
def test_hard_query_returns_finite_numbers_or_a_pointer(client: Client, name: str) -> None:
    query = QUERIES[name]
    response = client.post(ENDPOINTS[query["ask"]], query["request"])
    # This parser rejects NaN and Infinity.
    document = strict_json.loads(response.content)
    if response.status_code == 200:
        assert 0 < document["error_estimate"] < 1
        assert min(document.get("dissipated_energy", [0.0])) >= 0
    else:
        assert response.status_code == 422
        assert response.headers["content-type"] == MEDIA_TYPE
        assert all(error["pointer"] for error in document["errors"])


@pytest.mark.parametrize("ask", ENDPOINTS)
def test_every_query_type_is_covered(ask: str) -> None:
    assert any(query["ask"] == ask for query in QUERIES.values())
