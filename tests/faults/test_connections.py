"""Every connection is accepted, and closed after a request that leaves it unusable."""

import asyncio
import http.client
import logging
import re
import socket as sockets
import threading
from collections.abc import Iterator
from contextlib import ExitStack

import pytest
import uvicorn
from fastapi import FastAPI

from mdr_service import observability
from mdr_service.app import create_app
from mdr_service.problems import MEDIA_TYPE
from mdr_service.protocol import BoundedProtocol
from mdr_service.queries import contacts
from mdr_service.settings import SETTINGS
from tests.conftest import JSON
from tests.faults.server import PATIENCE, free_port, wait_until_ready

pytestmark = pytest.mark.long

BODY = (
    b'{"profile": {"kind": "cone", "slope": 0.1}, "material": {"e_star": 1}, '
    b'"load": {"normal_force": 1}}'
)


@pytest.fixture(scope="module")
def app() -> FastAPI:
    return create_app()


@pytest.fixture(scope="module")
def port(app: FastAPI) -> Iterator[int]:
    """Serve from a thread of this process, where a test can inject an error."""
    number = free_port()
    config = uvicorn.Config(
        app, port=number, loop="asyncio", http=BoundedProtocol, lifespan="on", ws="none"
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run)
    thread.start()
    wait_until_ready(number)
    yield number
    server.should_exit = True
    thread.join(PATIENCE)


@pytest.fixture
def connection(port: int) -> Iterator[http.client.HTTPConnection]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    connection.connect()
    yield connection
    connection.close()


def ask(connection: http.client.HTTPConnection, body: bytes) -> tuple[int, str | None, bytes]:
    connection.request("POST", "/v1/normal", body, JSON)
    response = connection.getresponse()
    return response.status, response.getheader("content-type"), response.read()


@pytest.mark.parametrize(
    ("target", "status"),
    [
        ("http://service.example/health", 200),
        ("HTTPS://service.example:8000/health?x=http://y/", 200),
        ("http://service.example", 200),
        ("http://service.example/nowhere", 404),
    ],
)
def test_target_in_absolute_form_is_accepted(
    connection: http.client.HTTPConnection, target: str, status: int
) -> None:
    connection.request("GET", target)
    response = connection.getresponse()
    assert response.status == status
    response.read()


def test_internal_error_is_reported_and_keeps_the_connection(
    connection: http.client.HTTPConnection,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    lines: list[str] = []
    formatter = observability.JsonLines()
    # Raised where the request is handled, and formatted by the service's error handler.
    monkeypatch.setattr(
        logging.getLogger("mdr_service.middleware"),
        "handle",
        lambda record: (lines.append(formatter.format(record)), caplog.handler.handle(record)),
    )

    def broken(*_arguments: object, **_options: object) -> None:
        raise RuntimeError("a secret of the implementation")

    socket = connection.sock
    with monkeypatch.context() as patch:
        patch.setattr(contacts.normal_contact, "solve", broken)
        status, media_type, body = ask(connection, BODY)
    assert (status, media_type) == (500, MEDIA_TYPE)
    assert b"secret" not in body
    assert b"Traceback" not in body
    # The id in the body identifies the log record, which has the traceback.
    (instance,) = re.findall(rb'"urn:mdr:request:([0-9a-f]+)"', body)
    (record,) = [each for each in caplog.records if each.exc_info]
    assert record.name == "mdr_service.middleware"
    assert f'"id":"{instance.decode()}"' in lines[-1]
    assert "a secret of the implementation" in lines[-1]
    assert ask(connection, BODY)[0] == 200
    assert connection.sock is socket


def test_invalid_request_keeps_the_connection(connection: http.client.HTTPConnection) -> None:
    socket = connection.sock
    for wrong in (b"{", b"{}", BODY.replace(b"cone", b"pyramid"), b"[" * 10_000):
        assert ask(connection, wrong)[0] in {400, 422}
    assert ask(connection, BODY)[0] == 200
    assert connection.sock is socket


def test_client_that_sends_a_rejected_long_body_receives_the_response(port: int) -> None:
    length = 8 * SETTINGS.max_body_bytes
    head = (
        "POST /v1/normal HTTP/1.1\r\nHost: service\r\nContent-Type: application/json\r\n"
        f"Content-Length: {length}\r\nConnection: close\r\n\r\n"
    )
    with sockets.create_connection(("127.0.0.1", port), timeout=PATIENCE) as client:
        client.sendall(head.encode())
        client.sendall(b" " * length)
        response = b""
        while piece := client.recv(65_536):
            response += piece
    assert response.startswith(b"HTTP/1.1 413 ")
    assert b"urn:mdr:problem:body-too-large" in response


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("abc-123_~.+/=", True),
        ("x" * 64, True),
        ("x" * 65, False),
        ("two words", False),
        ('"quoted"', False),
        ("\xe9", False),
        ("", False),
    ],
)
def test_valid_request_id_is_returned(
    connection: http.client.HTTPConnection, given: str, *, kept: bool
) -> None:
    for path in ("/health", "/nowhere"):
        connection.request("GET", path, headers={"X-Request-Id": given})
        response = connection.getresponse()
        response.read()
        result = response.getheader("x-request-id")
        assert result is not None
        assert (result == given) == kept
        assert kept or re.fullmatch("[0-9a-f]{16}", result)
        assert response.getheader("x-content-type-options") == "nosniff"
        assert response.getheader("access-control-allow-origin") is None


def test_long_chunked_body_is_rejected(connection: http.client.HTTPConnection) -> None:
    megabyte = b" " * 2**20
    count = SETTINGS.max_body_bytes // len(megabyte) + 1
    chunks = iter([megabyte] * count)
    connection.request("POST", "/v1/normal", chunks, JSON, encode_chunked=True)
    response = connection.getresponse()
    assert (response.status, response.getheader("content-type")) == (413, MEDIA_TYPE)


def test_waiting_connections_are_accepted_together_and_before_other_work(
    app: FastAPI, port: int
) -> None:
    """A loop that accepts one connection per turn lets the last one wait for as many turns."""
    turns = 0
    connected = threading.Event()
    served: list[int] = []

    async def busy() -> None:
        nonlocal turns
        started.set()
        connected.wait(PATIENCE)
        while len(served) < len(clients):
            turns += 1
            await asyncio.sleep(0)

    async def turn() -> None:
        served.append(turns)

    started = threading.Event()
    app.add_api_route("/busy", busy)
    app.add_api_route("/turn", turn)
    with ExitStack() as stack:

        def connect(path: str) -> sockets.socket:
            client = stack.enter_context(sockets.create_connection(("127.0.0.1", port), PATIENCE))
            client.sendall(f"GET {path} HTTP/1.1\r\nHost: x\r\n\r\n".encode())
            return client

        clients: list[sockets.socket] = [connect("/busy")]
        assert started.wait(PATIENCE)
        clients = [connect("/turn") for _ in range(100)]
        connected.set()
        for client in clients:
            assert client.recv(100).startswith(b"HTTP/1.1 200 ")
    assert max(served) < 20
