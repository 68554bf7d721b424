"""Every entry of a batch response has the bytes of the single response."""

import json
from collections.abc import Sequence

import httpx
import pytest

from mdr_service.batch import BatchAnswer
from mdr_service.dispatch import respond
from mdr_service.problems import MEDIA_TYPE
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.serializers import FORMATS
from mdr_service.settings import SETTINGS
from tests.conftest import Client
from tests.service.test_formats import BALL, CASES
from tests.service.test_wrong_input import WRONG, changed

NAMES = {kind.path: name for name, kind in QUERIES.items()}
LOADS = [1.0 + load for load in range(100)]
HISTORY = next(query for _, name, query in CASES if name == "mindlin_deresiewicz")
WRONG_QUERIES = [
    (f"/v1/{path}", changed(path, case.get("change", {}), tuple(case.get("without", ()))))
    for path, case in WRONG.values()
]


def batch(client: Client, queries: Sequence[tuple[str, bytes]]) -> httpx.Response:
    entries = [
        b'{"ask": "%s", "request": %s}' % (NAMES[path].encode(), body) for path, body in queries
    ]
    return client.post_text("/v1/batch", b'{"queries": [%s]}' % b",".join(entries))


def single_entry(client: Client, path: str, body: bytes) -> bytes:
    """Return the batch entry expected from the single response."""
    response = client.post_text(path, body)
    name = b"answer" if response.status_code == 200 else b"problem"
    return b'{"status":%d,"%s":%s}' % (response.status_code, name, response.content)


def test_batch_entries_equal_single_responses_in_order(client: Client) -> None:
    # One example of each query.
    examples = {path: query for path, _, query in CASES}
    queries = [(path, json.dumps(query).encode()) for path, query in examples.items()]
    response = batch(client, queries)
    assert response.status_code == 200
    assert response.headers["content-type"] == "application/json"
    expected = b",".join(single_entry(client, *query) for query in queries)
    assert response.content == b'{"answers":[%s]}' % expected
    BatchAnswer.model_validate_json(response.content)


@pytest.mark.parametrize(("path", "body"), WRONG_QUERIES)
def test_invalid_query_of_a_batch_has_its_own_problem(
    client: Client, path: str, body: bytes
) -> None:
    right = json.dumps(BALL).encode()
    response = batch(client, [("/v1/normal", right), (path, body), ("/v1/normal", right)])
    assert response.status_code == 200
    good, bad = single_entry(client, "/v1/normal", right), single_entry(client, path, body)
    assert bad.startswith(b'{"status":422')
    assert response.content == b'{"answers":[%s,%s,%s]}' % (good, bad, good)


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ({}, "/queries"),
        ({"queries": []}, "/queries"),
        ({"queries": {}}, "/queries"),
        ({"queries": [{"ask": "normal", "request": BALL}], "n": 1}, "/n"),
        ({"queries": [{"ask": "normal", "request": {}}] * (SETTINGS.max_batch + 1)}, "/queries"),
    ],
    ids=lambda value: str(value)[:60],
)
def test_invalid_batch_is_rejected_as_a_whole(client: Client, body: object, pointer: str) -> None:
    response = client.post("/v1/batch", body)
    assert response.status_code == 422
    assert response.headers["content-type"] == MEDIA_TYPE
    assert response.json()["errors"][0]["pointer"] == pointer


@pytest.mark.parametrize(
    ("entry", "pointer"),
    [
        (5, ""),
        ({"ask": "normal"}, "/request"),
        ({"request": BALL}, "/ask"),
        ({"ask": "x", "request": BALL}, "/ask"),
        ({"ask": "normal", "request": [BALL]}, "/request"),
        ({"ask": "normal", "request": None}, "/request"),
        ({"ask": "normal", "request": BALL, "id": 1}, "/id"),
    ],
    ids=lambda value: str(value)[:60],
)
def test_invalid_entry_has_a_problem_beside_the_answers(
    client: Client, entry: object, pointer: str
) -> None:
    right = {"ask": "normal", "request": BALL}
    response = client.post("/v1/batch", {"queries": [right, entry, right]})
    assert response.status_code == 200
    first, bad, last = response.json()["answers"]
    assert first == last
    assert first["status"] == 200
    assert bad["status"] == 422
    assert bad["problem"]["errors"][0]["pointer"] == pointer


def test_numbers_of_a_batch_are_limited_in_total(client: Client) -> None:
    half = SETTINGS.max_numbers // 2 // len(LOADS) + 1
    fields = BALL | {"load": {"normal_force": LOADS}, "quantities": ["foundation_load"]}
    few, many, too_many = (
        {"ask": "stress", "request": fields | {"points": n}} for n in (300, half, 3 * half)
    )
    many_samples = {
        "ask": "history",
        "request": HISTORY
        | {"cycles": HISTORY["cycles"] | {"count": SETTINGS.max_length // 4 - 1}},
    }
    # As many as one response may hold.
    assert SETTINGS.max_numbers % len(LOADS) == 0
    points = SETTINGS.max_numbers // len(LOADS)
    most = {"ask": "stress", "request": fields | {"points": points}}
    for queries, index in (
        ([few, many, few, many], 3),
        ([many_samples] * 11, 10),
        ([most, few], 1),
    ):
        response = client.post("/v1/batch", {"queries": queries})
        assert response.status_code == 422
        assert [error["pointer"] for error in response.json()["errors"]] == [f"/queries/{index}"]
    answers = client.post("/v1/batch", {"queries": [few, too_many]}).json()["answers"]
    assert [each["status"] for each in answers] == [200, 422]


def test_malformed_batch_is_malformed_json(client: Client) -> None:
    assert client.post_text("/v1/batch", b'{"queries": [').status_code == 400


@pytest.mark.parametrize("accept", ["text/csv", "image/svg+xml", "application/x-npz"])
def test_batch_is_available_as_json_only(client: Client, accept: str) -> None:
    example = EXAMPLES["batch"]["two"]["value"]
    headers = {"accept": accept}
    assert client.request("POST", "/v1/batch", json=example, headers=headers).status_code == 406
    assert client.request("POST", "/v1/batch?format=csv", json=example).status_code == 406
    assert client.request("POST", "/v1/batch?format=json", json=example).status_code == 200


def test_internal_error_of_one_query_leaves_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_query: object) -> object:
        raise ZeroDivisionError

    monkeypatch.setitem(QUERIES, "tangential", QUERIES["tangential"]._replace(solve=broken))
    pushed = {
        **BALL,
        "material": {"e_star": 1e11, "g_star": 1e11},
        "friction_coefficient": 0.3,
        "tangential": {"tangential_force": 1e-3},
    }
    queries = [{"ask": "normal", "request": BALL}, {"ask": "tangential", "request": pushed}]
    # In this process, where the function is replaced.
    text = respond("batch", json.dumps({"queries": queries}).encode(), FORMATS["json"])
    first, second = json.loads(text)["answers"]
    assert first["status"] == 200
    assert second["status"] == second["problem"]["status"] == 500
    assert set(second["problem"]) == {"type", "title", "status", "detail"}


def test_batch_example_has_a_result_and_a_problem(client: Client) -> None:
    answers = client.post("/v1/batch", EXAMPLES["batch"]["two"]["value"]).json()["answers"]
    assert [each["status"] for each in answers] == [200, 422]
