"""A wrong query gets a pointer, a remedy and a short response without its input."""

import json
import re
from pathlib import Path
from typing import Any

import httpx
import pytest

from mdr_service import problems
from mdr_service.problems import MAX_ERRORS, MEDIA_TYPE
from mdr_service.schemas.quantities import BRANCHES
from mdr_service.settings import SETTINGS
from tests.conftest import Client

# Words of the tools behind the service, which mean nothing to its users.
JARGON = re.compile(
    r"Input should|Field required|validation|pydantic|discriminator|\btag\b|NoneType|ndarray|loc\b"
)
BALL = '{"kind": "paraboloid", "radius": 0.01}'
MODULUS = '{"e_star": 1e9}'
FORCE = '{"normal_force": 1}'
# By endpoint: a request, and wrong changes of its members, each with the pointer of the error and,
# for the mistakes of newcomers, what a reader has to be told to continue.
STORED = json.loads((Path(__file__).parents[1] / "data" / "wrong_queries.json").read_text("utf-8"))
WRONG = {
    f"{path}: {name}": (path, case)
    for path, cases in STORED.items()
    for name, case in cases["wrong"].items()
}


def query(profile: str = BALL, material: str = MODULUS, load: str = FORCE, more: str = "") -> bytes:
    return f'{{"profile": {profile}, "material": {material}, "load": {load}{more}}}'.encode()


def changed(path: str, changes: dict[str, Any], without: tuple[str, ...] = ()) -> bytes:
    """Return the request of an endpoint with other members; numbers that JSON lacks are allowed."""
    request = STORED[path]["request"] | changes
    return json.dumps({name: request[name] for name in request if name not in without}).encode()


def problem(response: httpx.Response) -> dict[str, Any]:
    assert response.headers["content-type"] == MEDIA_TYPE
    assert len(response.content) <= 4096
    document: dict[str, Any] = response.json()
    assert document["status"] == response.status_code
    assert document["type"].startswith("urn:mdr:problem:")
    assert document["title"]
    assert document["detail"]
    assert not JARGON.search(response.text), response.text
    return document


def pointers(response: httpx.Response) -> list[str]:
    return [error["pointer"] for error in problem(response)["errors"]]


@pytest.mark.parametrize("name", WRONG)
def test_wrong_query_gets_a_pointer_and_a_remedy(client: Client, name: str) -> None:
    path, case = WRONG[name]
    body = changed(path, case.get("change", {}), tuple(case.get("without", ())))
    response = client.post_text(f"/v1/{path}", body)
    assert response.status_code == 422
    assert pointers(response) == [case["pointer"], *case.get("others", ())]
    if "said" in case:
        detail = response.json()["detail"]
        assert detail.startswith(f"{case['pointer'][1:].replace('/', '.')}: ")
        assert all(part in detail for part in case["said"]), detail


PUSHED = {"tangential_force": [0, 0.1]}
HUGE = json.loads("1e999")
NAN = float("nan")
TOO_MANY = [1.0] * (SETTINGS.max_length + 1)
# Text that no JSON file may hold, or that is too long for one.
WRONG_NUMBERS: list[tuple[str, bytes, str]] = [
    *(
        (path, changed(path, change), pointer)
        for path, change, pointer in (
            ("normal", {"load": {"normal_force": NAN}}, "/load/normal_force"),
            ("normal", {"load": {"normal_force": -HUGE}}, "/load/normal_force"),
            ("normal", {"load": {"normal_force": [1, NAN]}}, "/load/normal_force/1"),
            ("normal", {"load": {"normal_force": int("7" * 1000)}}, "/load/normal_force"),
            ("normal", {"load": {"normal_force": [1, -int("7" * 1000)]}}, "/load/normal_force/1"),
            ("tangential", {"friction_coefficient": NAN}, "/friction_coefficient"),
            (
                "tangential/history",
                {"history": {"normal": {"normal_force": [1, NAN]}, "tangential": PUSHED}},
                "/history/normal/normal_force/1",
            ),
            (
                "tangential/history",
                {"history": {"normal": {"normal_force": TOO_MANY}, "tangential": PUSHED}},
                "/history/normal/normal_force",
            ),
            (
                "wear",
                {"oscillation": {"tangential_displacement": [0, NAN]}},
                "/oscillation/tangential_displacement/1",
            ),
            ("wear/evolution", {"cycles": [1, NAN]}, "/cycles/1"),
            ("wear/evolution", {"cycles": TOO_MANY}, "/cycles"),
            ("stress", {"radius": [0, NAN]}, "/radius/1"),
            ("stress", {"radius": TOO_MANY}, "/radius"),
        )
    ),
    ("normal", query(BALL.replace("0.01", "1e999")), "/profile/radius"),
    ("normal", query(load='{"normal_force": Infinity}'), "/load/normal_force"),
    ("normal", query(load="[" * 100 + "]" * 100), "/load"),
    ("normal", b"[1]", ""),
]


@pytest.mark.parametrize(("path", "body", "pointer"), WRONG_NUMBERS)
def test_wrong_number_or_length_gets_a_pointer(
    client: Client, path: str, body: bytes, pointer: str
) -> None:
    response = client.post_text(f"/v1/{path}", body)
    assert response.status_code == 422
    assert pointers(response) == [pointer]


@pytest.mark.parametrize("load", [{}, {"normal_force": 1, "contact_radius": 1}])
def test_missing_control_is_named(client: Client, load: dict[str, float]) -> None:
    response = client.post_text("/v1/normal", changed("normal", {"load": load}))
    (error,) = response.json()["errors"]
    controls = "indentation_depth, normal_force, contact_radius, maximum_pressure"
    assert error["detail"] == f"exactly one of {controls} is needed"


def test_amplitude_is_no_control(client: Client) -> None:
    cycles = {"normal": {"amplitude": 1}, "tangential": {"tangential_force": 0.1}}
    body = changed("tangential/history", {"cycles": cycles}, ("history",))
    (error,) = client.post_text("/v1/tangential/history", body).json()["errors"]
    assert error["detail"] == "exactly one of indentation_depth, normal_force is needed"


@pytest.mark.parametrize("path", ["tangential", "stress"])
@pytest.mark.parametrize("name", ["a string in a list", "two controls", "no kind"])
def test_shared_members_are_validated_by_every_query(client: Client, path: str, name: str) -> None:
    case = STORED["normal"]["wrong"][name]
    response = client.post_text(f"/v1/{path}", changed(path, case["change"]))
    assert response.status_code == 422
    assert case["pointer"] in pointers(response)


@pytest.mark.parametrize(
    ("r", "f"),
    [("[0, 1, 2]", "[0, 2, 1]"), ("[0, 2, 1]", "[0, 1, 2]"), ("[0, 1, 2]", "[0, 1]")],
    ids=["falling", "radii not in order", "lengths that differ"],
)
def test_invalid_table_is_rejected(client: Client, r: str, f: str) -> None:
    table = f'{{"kind": "tabulated", "r": {r}, "f": {f}}}'
    response = client.post_text("/v1/normal", query(table))
    assert response.status_code == 422
    assert all(pointer.startswith("/profile") for pointer in pointers(response))


NOT_JSON = {
    "words": b"hello",
    "nothing": b"",
    "a trailing comma": b'{"load": {},}',
    "a byte order mark": "\ufeff{}".encode(),
    "a dictionary of Python": b"{'load': {}}",
    "a number without its zero": query(load='{"normal_force": .5}'),
    "half": query()[:-1],
    "nested 100000 deep": b"[" * 100_000,
    "nested 100000 deep in a field": query(load="[" * 100_000 + "]" * 100_000),
    "half a surrogate": query(BALL.replace("paraboloid", "\\ud800")),
    "half a surrogate in a name": query(more=', "\\ud800": 1'),
    "not UTF-8": query(more=', "') + b'\xff": 1}',
    "more digits than the parser takes": query(load=f'{{"normal_force": {"7" * 5000}}}'),
}
REMEDIES = {
    "nothing": ["empty"],
    "a trailing comma": ["trailing comma", "line 1"],
    "a byte order mark": ["UTF-8", "byte order mark"],
    "a dictionary of Python": ["double quotes"],
    "a number without its zero": ["; write numbers as 0.5"],
}


@pytest.mark.parametrize("name", NOT_JSON)
def test_malformed_json_is_rejected(client: Client, name: str) -> None:
    response = client.post_text("/v1/normal", NOT_JSON[name])
    assert response.status_code == 400
    assert pointers(response) == [""]
    assert all(part in response.json()["detail"] for part in REMEDIES.get(name, []))


def test_problem_does_not_repeat_the_input(client: Client) -> None:
    secret = "s3cret" * 20
    bodies = [
        query(f'{{"kind": "{secret}"}}'),
        query(load=f'{{"normal_force": "{secret}"}}'),
        query(more=f', "{secret}": 1'),
        secret.encode(),
    ]
    for body in bodies:
        assert b"s3cret" not in client.post_text("/v1/normal", body).content


@pytest.mark.parametrize("name", [*sorted(BRANCHES), "cone", "0"])
@pytest.mark.parametrize("place", ["", "/profile", "/material", "/material/bodies/1", "/load"])
def test_unknown_member_with_a_name_of_the_parser_is_found(
    client: Client, place: str, name: str
) -> None:
    """Pydantic inserts names of its own into the location of an error."""
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
    request: dict[str, Any] = {
        "profile": {"kind": "cone", "slope": 0.1},
        "material": {"bodies": ["rigid", steel]} if "bodies" in place else {"e_star": 1.0},
        "load": {"normal_force": 1.0},
    }
    member: Any = request
    for step in place.split("/")[1:]:
        member = member[int(step) if step.isdecimal() else step]
    member[name] = 1
    (error,) = client.post("/v1/normal", request).json()["errors"]
    assert error["pointer"] == f"{place}/{name}"
    assert error["detail"].startswith("there is no such member; there are ")


@pytest.mark.parametrize(
    ("radius", "detail"),
    [
        (-1.0, "must be positive, at least 1e-50"),
        (1e60, "must be at most 1e+50"),
    ],
)
def test_bounds_are_stated_in_short(client: Client, radius: float, detail: str) -> None:
    query = {
        "profile": {"kind": "paraboloid", "radius": radius},
        "material": {"e_star": 1.0},
        "load": {"normal_force": 1.0},
    }
    errors = client.post("/v1/normal", query).json()["errors"]
    assert errors == [{"pointer": "/profile/radius", "detail": detail}]


def test_unknown_parameter_lists_those_that_there_are(client: Client) -> None:
    response = client.get("/v1/normal?kind=paraboloid&radius=1&e_star=1&normal_force=1&force=1")
    (error,) = response.json()["errors"]
    assert error["pointer"] == "/force"
    listed = error["detail"].removeprefix("there is no such member; there are ").split(", ")
    assert set(listed) >= {"kind", "radius", "e_star", "youngs_modulus_1", "normal_force", "n"}


def test_pointer_ends_before_a_name_longer_than_any_field() -> None:
    longest = "x" * problems.MAX_NAME
    assert problems.pointer(["profile", longest]) == f"/profile/{longest}"
    assert problems.pointer(["profile", f"{longest}x", "kind"]) == "/profile"


def test_missing_list_is_described_as_a_list(client: Client) -> None:
    response = client.post_text("/v1/normal", query('{"kind": "series"}'))
    detail = "is required, a list of objects of coefficient, exponent"
    assert response.json()["errors"] == [{"pointer": "/profile/terms", "detail": detail}]


def test_number_of_errors_is_limited(client: Client) -> None:
    many = "".join(f', "{"unknown" * 8}{i}": 1' for i in range(10_000))
    response = client.post_text("/v1/normal", query(more=many))
    assert 1 <= len(pointers(response)) <= MAX_ERRORS
    exactly = "".join(f', "u{i}": 1' for i in range(30))
    assert len(pointers(client.post_text("/v1/normal", query(more=exactly)))) == MAX_ERRORS


def test_problem_of_ten_thousand_errors_is_short(client: Client) -> None:
    bad = json.dumps({"normal_force": ["x"] * 10_000})
    assert pointers(client.post_text("/v1/normal", query(load=bad))) == ["/load/normal_force/0"]


def test_list_at_the_limit_is_accepted(client: Client) -> None:
    def loads(count: int) -> bytes:
        return query(load=json.dumps({"normal_force": [1.0] * count}))

    response = client.post_text("/v1/normal", loads(SETTINGS.max_length))
    assert len(response.json()["contact_radius"]) == SETTINGS.max_length
    response = client.post_text("/v1/normal", loads(SETTINGS.max_length + 1))
    assert pointers(response) == ["/load/normal_force"]


def test_long_body_is_rejected(client: Client) -> None:
    response = client.post_text("/v1/normal", b" " * (SETTINGS.max_body_bytes + 1))
    assert response.status_code == 413
    problem(response)


def test_body_at_the_limit_is_accepted(client: Client) -> None:
    text = f'{{"profile": {BALL}, "material": {{"e_star": 1}}, "load": {{"normal_force": 1}}}}'
    body = text.encode().ljust(SETTINGS.max_body_bytes)
    assert client.post_text("/v1/normal", body).status_code == 200


@pytest.mark.parametrize("media_type", ["text/plain", "application/x-www-form-urlencoded", ""])
def test_other_content_types_are_rejected(client: Client, media_type: str) -> None:
    headers = {"content-type": media_type}
    response = client.request("POST", "/v1/normal", content=query(), headers=headers)
    assert response.status_code == 415
    problem(response)


@pytest.mark.parametrize("media_type", ["application/json; charset=utf-8", "Application/JSON"])
def test_variants_of_the_json_content_type_are_accepted(client: Client, media_type: str) -> None:
    headers = {"content-type": media_type}
    response = client.request("POST", "/v1/normal", content=query(), headers=headers)
    assert response.status_code == 200


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nothing", 404),
        ("GET", "/docs/swagger/nothing.js", 404),
        ("GET", "/v1/wear/evolution", 405),
        ("PUT", "/v1/normal", 405),
        ("DELETE", "/health", 405),
        ("POST", "/docs/swagger/swagger-ui.css", 405),
    ],
)
def test_unknown_endpoint_is_a_problem(client: Client, method: str, path: str, status: int) -> None:
    response = client.request(method, path)
    assert response.status_code == status
    assert ("allow" in response.headers) == (status == 405)
    problem(response)


@pytest.mark.parametrize(
    ("path", "methods"),
    [
        ("/v1/normal", "GET, HEAD, POST"),
        ("/v1/wear/evolution", "POST"),
        ("/health", "GET, HEAD"),
        ("/explorer/main.js", "GET, HEAD"),
        ("/docs/page/docs.css", "GET, HEAD"),
    ],
)
def test_allow_header_lists_the_methods(client: Client, path: str, methods: str) -> None:
    assert client.request("PUT", path).headers["allow"] == methods


@pytest.mark.parametrize("path", ["/", "/health", "/docs", "/openapi.json", "/v1/profiles"])
def test_head_is_allowed_where_get_is(client: Client, path: str) -> None:
    get, head = client.request("GET", path), client.request("HEAD", path)
    assert head.status_code == get.status_code
    assert head.headers["content-type" if get.content else "location"]
