"""The event loop leaves long work to compute processes, and does its own work once."""

import json

import pytest

from mdr_service import problems
from mdr_service.query_parameters import Parameters
from tests.conftest import Client

CONE = {"profile": {"kind": "cone", "slope": 0.1}, "material": {"e_star": 1.0}}
FORCES = "/v1/normal?kind=cone&slope=0.1&e_star=1&normal_force_from=1&normal_force_to=2"


def never(*_arguments: object, **_options: object) -> None:
    raise AssertionError("the event loop computes it")


@pytest.mark.parametrize("options", ["&answers=method", "&format=csv", ""])
def test_long_range_is_expanded_in_a_compute_process(
    client: Client, monkeypatch: pytest.MonkeyPatch, options: str
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(Parameters, "query", never)
        response = client.get(f"{FORCES}&n=2000{options}")
    assert response.status_code == 200
    if not options:
        short = client.get(f"{FORCES}&n=1000").json()
        assert response.json()["normal_force"][::1999] == short["normal_force"][::999]
        assert response.headers["cache-control"] == "max-age=3600"


def test_errors_of_a_long_range_point_at_parameters(client: Client) -> None:
    for count in ("1000", "2000", "10&format=svg"):
        problem = client.get(f"{FORCES.replace('slope=0.1', 'slope=-1')}&n={count}").json()
        assert [each["pointer"] for each in problem["errors"]] == ["/slope"]
        assert problem["detail"].startswith("slope: ")
    for count in (1000, 2000):
        problem = client.get(f"{FORCES}&n={count}&answers=nothing").json()
        assert [each["pointer"] for each in problem["errors"]] == ["/answers"]


def test_batch_of_invalid_queries_is_answered_by_a_compute_process(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    queries = [{"ask": "normal", "request": {}}] * 100
    with monkeypatch.context() as patch:
        patch.setattr(problems, "from_validation", never)
        response = client.post("/v1/batch", {"queries": queries})
    assert [each["status"] for each in response.json()["answers"]] == [422] * 100


def test_documents_are_written_once(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    first = client.get("/openapi.json")
    monkeypatch.setattr(client.app, "openapi", never)
    assert client.get("/openapi.json").content == first.content
    assert json.loads(first.content)["openapi"].startswith("3.1")
    assert client.get("/readme").text.startswith("# MDR")
