"""Tables and pictures are well-formed, and unknown media types are rejected."""

import csv
import io
import json
from math import inf
from pathlib import Path
from xml.etree import ElementTree as ET

import httpx
import numpy as np
import orjson
import pytest

from mdr_service.schemas.examples import EXAMPLES
from mdr_service.serializers import csv as table_of
from tests.conftest import Client
from tests.core.comparison import stored

CASES = [
    (path, name, example["value"])
    for path, examples in (
        ("/v1/normal", EXAMPLES["normal"]),
        ("/v1/tangential", EXAMPLES["tangential"]),
        ("/v1/tangential/history", EXAMPLES["history"]),
        ("/v1/stress", EXAMPLES["stress"]),
        ("/v1/wear", EXAMPLES["wear"]),
        ("/v1/wear/evolution", EXAMPLES["evolution"]),
    )
    for name, example in examples.items()
]
EVERY_EXAMPLE = pytest.mark.parametrize(
    ("path", "query"),
    [case[::2] for case in CASES],
    ids=[f"{path} {name}" for path, name, _ in CASES],
)
BALL = EXAMPLES["normal"]["hertz"]["value"]
WITHOUT_ROWS = {
    *("method", "sources", "error_estimate", "field_error_estimate", "warnings"),
    *("slip_fronts", "energy_per_cycle", "secant_stiffness", "final_state"),
}
SVG = "{http://www.w3.org/2000/svg}"


def ask(client: Client, path: str, query: object, accept: str) -> httpx.Response:
    return client.request("POST", path, json=query, headers={"accept": accept})


def table(response: httpx.Response) -> list[dict[str, str]]:
    assert response.status_code == 200
    assert response.headers["content-type"] == "text/csv; charset=utf-8"
    return list(csv.DictReader(io.StringIO(response.text, newline="")))


def cell(value: object) -> str:
    """Return a JSON value as it appears in a table."""
    return repr(inf) if value is None else value if isinstance(value, str) else written(value)


def written(value: object) -> str:
    return orjson.dumps(value).decode()


LOAD_INDEPENDENT = "initial_profile"


def has_radii(name: str, values: list[object]) -> bool:
    return name == LOAD_INDEPENDENT or isinstance(values[0], list)


@EVERY_EXAMPLE
def test_csv_has_the_digits_of_json(client: Client, path: str, query: dict[str, object]) -> None:
    rows = table(ask(client, path, query, "text/csv"))
    document = client.post(path, query).json()
    columns = {name: values for name, values in document.items() if name not in WITHOUT_ROWS}
    if "radius" not in document:
        for name, values in columns.items():
            assert [row[name] for row in rows] == [cell(value) for value in values]
        return
    radius = columns.pop("radius")
    cycles = columns.get("cycles")
    columns = {name: values for name, values in columns.items() if has_radii(name, values)}
    loads = range(max(len(field) for name, field in columns.items() if name != LOAD_INDEPENDENT))
    if LOAD_INDEPENDENT in columns:
        columns[LOAD_INDEPENDENT] = [columns[LOAD_INDEPENDENT]] * len(loads)
    assert ("load" in rows[0]) == (len(loads) > 1 and cycles is None)
    assert ("cycles" in rows[0]) == (cycles is not None)
    expected = [
        ({"cycles": written(cycles[load])} if cycles else {"load": str(load)} if loads[1:] else {})
        | {"radius": written(r)}
        | {name: cell(field[load][at]) for name, field in columns.items()}
        for load in loads
        for at, r in enumerate(radius)
    ]
    assert rows == expected


def test_columns_have_the_requested_order(client: Client) -> None:
    query = {**BALL, "radius": [0.0], "quantities": ["foundation_load", "pressure"]}
    response = ask(client, "/v1/stress", query, "text/csv")
    assert response.text.splitlines()[0] == "radius,foundation_load,pressure"


def test_infinity_is_inf_in_csv(client: Client) -> None:
    query = {
        "profile": {"kind": "power", "coefficient": 1.0, "exponent": 0.5},
        "material": {"e_star": 1.0},
        "load": {"normal_force": 0.0},
    }
    (row,) = table(ask(client, "/v1/normal", query, "text/csv"))
    assert row["mean_pressure"] == "inf"


def test_numbers_have_sign_and_all_digits() -> None:
    numbers = np.array([inf, -inf, -0.0, 1e-300, 0.1 + 0.2])
    text = table_of.write({"number": numbers, "regime": ["a", "b", "c", "d", "e"]}).decode()
    assert text.split("\r\n") == [
        "number,regime",
        *("inf,a", "-inf,b", "-0.0,c", "1e-300,d", "0.30000000000000004,e"),
        "",
    ]


@pytest.mark.parametrize(("accept", "media_type"), stored("accepted_formats"))
def test_accept_header_selects_the_format(client: Client, accept: str, media_type: str) -> None:
    query = {**BALL, "radius": [0.0, 1e-5], "quantities": ["pressure"]}
    response = ask(client, "/v1/stress", query, accept)
    assert response.status_code == 200
    assert response.headers["content-type"].partition(";")[0] == media_type


def test_accept_header_may_be_absent_or_have_two_lines(client: Client) -> None:
    request = httpx.Request("POST", "http://service/v1/normal", json=BALL)
    assert "accept" not in request.headers
    assert client.send(request).headers["content-type"] == "application/json"
    lines = [("accept", "text/html;q=0.9"), ("accept", "text/csv")]
    response = client.request("POST", "/v1/normal", json=BALL, headers=lines)
    assert response.headers["content-type"].startswith("text/csv")


@pytest.mark.parametrize("accept", ["text/html", "application/xml", "image/gif", "rubbish", ";;,"])
@pytest.mark.parametrize(
    "path",
    [
        *("/v1/normal", "/v1/tangential", "/v1/tangential/history", "/v1/stress"),
        *("/v1/wear", "/v1/wear/evolution"),
    ],
)
def test_unknown_media_type_is_rejected(client: Client, path: str, accept: str) -> None:
    response = ask(client, path, BALL, accept)
    assert response.status_code == 406
    assert response.headers["content-type"] == "application/problem+json"
    assert "text/csv" in response.json()["detail"]


@pytest.mark.parametrize(
    ("format_name", "media_type", "start"),
    [
        ("svg", "image/svg+xml", b"<?xml"),
        ("png", "image/png", b"\x89PNG\r\n"),
        ("pdf", "application/pdf", b"%PDF-1.4"),
    ],
)
def test_identical_queries_give_identical_plots(
    client: Client, format_name: str, media_type: str, start: bytes
) -> None:
    responses = [client.post(f"/v1/normal?format={format_name}", BALL) for _ in range(2)]
    assert responses[0].headers["content-type"] == media_type
    assert responses[0].content.startswith(start)
    assert responses[0].content == responses[1].content


def parse_svg(response: httpx.Response) -> ET.Element:
    assert response.status_code == 200
    assert response.headers["content-type"] == "image/svg+xml"
    root = ET.fromstring(response.content)  # noqa: S314 -- our own
    assert root.tag == f"{SVG}svg"
    return root


# Requests whose pictures have nothing, a point, gaps or very much to draw.
DEGENERATE = json.loads(
    (Path(__file__).parents[1] / "data" / "degenerate_requests.json").read_text("utf-8")
)


@pytest.mark.long
@pytest.mark.parametrize(
    ("path", "change"),
    [(path, change) for path, case in DEGENERATE.items() for change in case["changes"]],
    ids=str,
)
def test_degenerate_request_has_a_plot(
    client: Client, path: str, change: dict[str, object]
) -> None:
    name, example = DEGENERATE[path]["example"]
    query = EXAMPLES[name][example]["value"] | change
    if path == "/v1/tangential":
        query = {name: query[name] for name in query if name not in {"radius", "quantities"}}
    parse_svg(ask(client, path, query, "image/svg+xml"))


@pytest.mark.long
def test_history_of_many_points_has_a_plot(client: Client) -> None:
    example = EXAMPLES["history"]["residual"]["value"]
    forces = {"tangential_force": [2.0, -1.0] * 5_000}
    many = example["history"] | {"tangential": forces, "samples_per_step": 2}
    parse_svg(ask(client, "/v1/tangential/history", example | {"history": many}, "image/svg+xml"))


def test_problems_are_json_for_any_accept_header(client: Client) -> None:
    response = ask(client, "/v1/stress", {**BALL, "quantities": []}, "image/svg+xml")
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    json.loads(response.content)
