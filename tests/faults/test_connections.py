"""What a client's connection survives."""

import http.client
import threading
import time
from collections.abc import Iterator

import pytest
import uvicorn

from mdr_service import solve
from mdr_service.app import create_app
from mdr_service.problems import MEDIA_TYPE
from mdr_service.settings import SETTINGS
from tests.conftest import JSON
from tests.faults.server import PATIENCE, free_port, wait_until_ready

BODY = (
    b'{"profile": {"kind": "cone", "slope": 0.1}, "material": {"e_star": 1}, '
    b'"load": {"normal_force": 1}}'
)


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    """Serve from a thread of this process, where a test can plant a bug."""
    number = free_port()
    config = uvicorn.Config(
        create_app(), port=number, loop="uvloop", http="httptools", lifespan="off", ws="none"
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
    answer = connection.getresponse()
    return answer.status, answer.getheader("content-type"), answer.read()


def test_a_bug_is_answered_and_the_connection_stays(
    connection: http.client.HTTPConnection, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_arguments: object, **_options: object) -> None:
        raise RuntimeError("a secret of the implementation")

    socket = connection.sock
    with monkeypatch.context() as patch:
        patch.setattr(solve.normal_contact, "solve", broken)
        status, media_type, body = ask(connection, BODY)
    assert (status, media_type) == (500, MEDIA_TYPE)
    assert b"secret" not in body
    assert b"Traceback" not in body
    assert ask(connection, BODY)[0] == 200
    assert connection.sock is socket


def test_wrong_input_leaves_the_connection_alone(connection: http.client.HTTPConnection) -> None:
    socket = connection.sock
    for body in (b"{", b"{}", BODY.replace(b"cone", b"pyramid"), b"[" * 10_000):
        assert ask(connection, body)[0] in {400, 422}
    assert ask(connection, BODY)[0] == 200
    assert connection.sock is socket


def test_a_long_body_is_refused_before_it_is_sent(connection: http.client.HTTPConnection) -> None:
    connection.putrequest("POST", "/v1/normal")
    connection.putheader("Content-Type", "application/json")
    connection.putheader("Content-Length", str(SETTINGS.max_body_bytes + 1))
    connection.endheaders()
    answer = connection.getresponse()
    assert (answer.status, answer.getheader("content-type")) == (413, MEDIA_TYPE)


def test_a_long_body_in_chunks_is_refused(connection: http.client.HTTPConnection) -> None:
    megabyte = b" " * 2**20
    count = SETTINGS.max_body_bytes // len(megabyte) + 1
    chunks = iter([megabyte] * count)
    connection.request("POST", "/v1/normal", chunks, JSON, encode_chunked=True)
    answer = connection.getresponse()
    assert (answer.status, answer.getheader("content-type")) == (413, MEDIA_TYPE)


def test_a_client_that_leaves_is_no_defect(port: int, caplog: pytest.LogCaptureFixture) -> None:
    leaving = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    leaving.putrequest("POST", "/v1/normal")
    leaving.putheader("Content-Type", "application/json")
    leaving.putheader("Content-Length", "100")
    leaving.endheaders(b"{")
    time.sleep(0.1)
    leaving.close()
    time.sleep(0.2)
    assert not [record for record in caplog.records if record.name.startswith("mdr_service")]
