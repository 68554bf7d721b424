"""Every endpoint serves clients that offer HTTP/2, as curl --http2 and Java's HttpClient do."""

import http.client
import json
import shutil
import subprocess
from collections.abc import Iterator
from typing import Any

import pytest

from mdr_service.app import create_app
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.queries import SCHEMAS
from tests.faults.server import PATIENCE, free_port, running, service

pytestmark = pytest.mark.long

BODIES: dict[str, Any] = {schema.path: EXAMPLES[name] for name, schema in SCHEMAS.items()}
BODIES["/v1/batch"] = EXAMPLES["batch"]
LOADED = "kind=cone&slope=0.1&e_star=1&g_star=1&normal_force=1"
PARAMETERS = {
    "/v1/normal": LOADED,
    "/v1/tangential": f"{LOADED}&friction_coefficient=0.3&tangential_force=0.1",
    "/v1/tangential/history": f"{LOADED}&friction_coefficient=0.3&tangential_force=0.1",
    "/v1/stress": f"{LOADED}&points=20&quantities=pressure",
    "/v1/wear": f"{LOADED}&friction_coefficient=0.3&tangential_force=0.1",
}
OPERATIONS = [
    *(
        (method.upper(), path)
        for path, operations in create_app().openapi()["paths"].items()
        for method in operations
    ),
    *(("GET", path) for path in ("/", "/docs", "/openapi.json")),
]
JSON = {"Content-Type": "application/json"}
UPGRADE = {
    "Connection": "Upgrade, HTTP2-Settings",
    "Upgrade": "h2c",
    "HTTP2-Settings": "AAEAAEAAAAIAAAAA",
}
# Response headers that contain times.
CHANGES = {"/metrics"}


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    number = free_port()
    with running(service(number), number):
        yield number


def target_and_body(method: str, path: str) -> tuple[str, bytes]:
    """Return the request target and body of an operation that succeeds."""
    if method == "POST":
        example = next(iter(BODIES[path].values()))
        return path, json.dumps(example["value"]).encode()
    return (f"{path}?{PARAMETERS[path]}" if path in PARAMETERS else path), b""


@pytest.mark.parametrize(("method", "path"), OPERATIONS)
def test_offered_upgrade_is_declined(port: int, method: str, path: str) -> None:
    """The response is that of HTTP/1.1, and the body is not read as a second request."""
    target, body = target_and_body(method, path)
    client = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    answers = []
    for headers in (JSON | UPGRADE, JSON):
        client.request(method, target, body or None, headers)
        answer = client.getresponse()
        assert (answer.status, answer.version) == (200, 11)
        answers.append(answer.read())
    assert answers[0] == answers[1] or path in CHANGES
    client.close()


@pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl")
@pytest.mark.parametrize(("method", "path"), OPERATIONS)
def test_curl_with_http2(port: int, method: str, path: str) -> None:
    target, body = target_and_body(method, path)
    command = [
        "curl",
        "--http2",
        "--silent",
        "--output",
        "/dev/null",
        "--write-out",
        "%{http_code}",
    ]
    if body:
        command += ["--header", "Content-Type: application/json", "--data", body.decode()]
    done = subprocess.run(
        [*command, f"http://127.0.0.1:{port}{target}"], capture_output=True, check=True
    )
    assert done.stdout == b"200"
