"""Headers, pipelining, upgrades and slow clients stay within the limits of the protocol."""

import http.client
import json
import random
import socket
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise

import pytest
import uvicorn
from fastapi import FastAPI
from uvicorn.protocols.http.h11_impl import H11Protocol

from mdr_service import observability, protocol
from mdr_service.app import create_app
from mdr_service.protocol import MAX_HEADER_BYTES, BoundedProtocol
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.settings import SETTINGS
from tests.faults.server import PATIENCE, free_port, wait_until_ready

pytestmark = pytest.mark.long

CONE = {"profile": {"kind": "cone", "slope": 0.1}, "material": {"e_star": 1}}
BODY = json.dumps(CONE | {"load": {"normal_force": 1}}).encode()
UPGRADE = (
    b"Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAEAAEAAAAIAAAAA\r\n"
)
GET = b"GET /health HTTP/1.1\r\nHost: x\r\n\r\n"


def post(body: bytes = BODY, headers: bytes = b"") -> bytes:
    return (
        b"POST /v1/normal HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
        b"%sContent-Length: %d\r\n\r\n%s" % (headers, len(body), body)
    )


def chunked(body: bytes = BODY, headers: bytes = b"", trailers: bytes = b"") -> bytes:
    middle = len(body) // 2
    chunks = b"".join(
        b"%x\r\n%s\r\n" % (len(each), each) for each in (body[:middle], body[middle:])
    )
    return (
        b"POST /v1/normal HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n%s"
        b"Transfer-Encoding: chunked\r\n\r\n%s0\r\n%s\r\n" % (headers, chunks, trailers)
    )


@dataclass
class Served:
    app: FastAPI
    port: int

    def connect(self) -> socket.socket:
        return socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE)

    def responses(self, *pieces: bytes, number: int = 1) -> list[tuple[int, bytes]]:
        """Send the pieces; return up to this many responses, fewer if the connection is closed."""
        with self.connect() as client:
            sender = threading.Thread(target=send_all, args=(client, pieces))
            sender.start()
            result = read(client, number)
            sender.join()
        return result


def send_all(client: socket.socket, pieces: tuple[bytes, ...]) -> bool:
    """Send the pieces; return True if the connection is closed."""
    try:
        for piece in pieces:
            client.sendall(piece)
    except ConnectionError:
        return True
    return False


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


class Received:
    """The part of the socket interface that `http.client` needs."""

    def __init__(self, stream: BytesIO) -> None:
        self._stream = stream

    def makefile(self, _mode: str) -> BytesIO:
        return self._stream


def read(client: socket.socket, number: int) -> list[tuple[int, bytes]]:
    result = []
    stream = client.makefile("rb")
    stream.close = lambda: None  # type: ignore[method-assign]  # for the next response
    for _ in range(number):
        try:
            response = http.client.HTTPResponse(Received(stream), method="POST")  # type: ignore[arg-type]
            response.begin()
            result.append((response.status, response.read()))
        except (ConnectionError, http.client.HTTPException):
            break
    return result


def is_closed(client: socket.socket) -> bool:
    try:
        return client.recv(2**16) == b""
    except ConnectionError:
        return True


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    number = free_port()
    app = create_app()
    config = uvicorn.Config(app, port=number, loop="asyncio", http=BoundedProtocol, ws="none")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run)
    thread.start()
    wait_until_ready(number)
    yield Served(app, number)
    server.should_exit = True
    thread.join(PATIENCE)


@pytest.fixture
def short_timeouts(monkeypatch: pytest.MonkeyPatch) -> None:
    limit(monkeypatch, 0.5)


def limit(monkeypatch: pytest.MonkeyPatch, seconds: float) -> None:
    """Limit the arrival of requests, and the time in which nothing of a response is read."""
    settings = SETTINGS.model_copy(update={"request_seconds": seconds})
    monkeypatch.setattr(protocol, "SETTINGS", settings)


def test_every_overridden_method_exists_in_uvicorn() -> None:
    own = {name for name, each in vars(BoundedProtocol).items() if callable(each)}
    overriding = {name for name in own if not name.startswith("_")}
    assert overriding >= {"data_received", "handle_events", "send_400_response", "connection_made"}
    for name in overriding:
        assert callable(getattr(H11Protocol, name)), name


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        (b"X: %s\r\n" % (b"a" * (MAX_HEADER_BYTES - 1000)), 200),
        (b"X: %s\r\n" % (b"a" * MAX_HEADER_BYTES), 431),
        (b"X: a\r\n" * (MAX_HEADER_BYTES // 8), 200),
        (b"X: a\r\n" * (MAX_HEADER_BYTES // 2), 431),
    ],
    ids=["long value", "too long value", "many fields", "too many fields"],
)
def test_headers_are_limited(served: Served, headers: bytes, status: int) -> None:
    before = served.responses(post())
    text = post(headers=headers)
    # At once, and in pieces that end inside names and values.
    for pieces in ([text], [text[n : n + 1021] for n in range(0, len(text), 1021)]):
        ((result, body),) = served.responses(*pieces)
        assert result == status
        if status == 431:
            document = json.loads(body)
            assert document["type"] == "urn:mdr:problem:headers-too-large"
            assert str(MAX_HEADER_BYTES) in document["detail"]
        else:
            assert body == before[0][1]


def test_rejected_connection_is_counted_and_closed_after_the_response(served: Served) -> None:
    counter = observability.PROBLEMS.labels("headers-too-large")
    before = counter._value.get()
    with served.connect() as client:
        client.sendall(post(headers=b"X: %s\r\n" % (b"a" * MAX_HEADER_BYTES)))
        assert [status for status, _ in read(client, 2)] == [431]
        assert is_closed(client)
    assert counter._value.get() == before + 1


def test_long_url_is_rejected(served: Served) -> None:
    for size, status in ((MAX_HEADER_BYTES, 200), (MAX_HEADER_BYTES + 1, 431)):
        text = GET.replace(b"health", b"health?" + b"a" * (size - len(GET) - 1))
        for pieces in ([text], [text[:-1], text[-1:]], [text[:9], text[9:]]):
            assert served.responses(*pieces)[0][0] == status


@pytest.mark.parametrize(
    "head",
    [b"GET / HTTP/1.1\r\nX: ", b"GET /", b"GET / HTTP/1.1\r\nX", chunked()[:-2] + b"X: "],
    ids=["value", "URL", "name", "trailer"],
)
def test_unterminated_header_is_rejected_once_it_is_too_long(served: Served, head: bytes) -> None:
    result = served.responses(head, *[b"a" * 2**19] * 100, number=2)
    assert [status for status, _ in result] == [431]


def test_trailers_within_the_limits_are_ignored(served: Served) -> None:
    trailers = b"X-Request-Id: trailer\r\nContent-Type: text/plain\r\n"
    result = served.responses(chunked(trailers=trailers) + GET, number=2)
    assert [status for status, _ in result] == [200, 200]
    assert result[0] == served.responses(post())[0]
    result = served.responses(chunked(trailers=b"X: a\r\n" * 20_000) + GET, number=2)
    assert 200 not in [status for status, _ in result[1:]]


@pytest.mark.parametrize(
    "text",
    [
        b"NONSENSE\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
        b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        b"\r\n",
        b"GET /\xff HTTP/1.1\r\nHost: x\r\n\r\n",
        b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n",
        b"POST /v1/normal HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nno length\r\n",
        b"GET /health HTTP/1.1\r\n\r\n",
        b"GET /health HTTP/1.1\r\nHost: x\r\nHost: x\r\n\r\n",
        b"GET /health HTTP/1.0\r\nHost: x\r\nHost: y\r\n\r\n",
        b"GET /health\r\n\r\n",
        b"GET /health HTTP/2.0\r\nHost: x\r\n\r\n",
        chunked().replace(b": chunked", b": gzip, chunked"),
        chunked().replace(b": chunked", b": xchunked"),
        chunked().replace(b": chunked", b": chunked\r\nTransfer-Encoding: chunked"),
        chunked(headers=b"Content-Length: 3\r\n"),
        chunked().replace(b"HTTP/1.1", b"HTTP/1.0"),
        b"GET /" + b"\xff" * 20_000 + b" HTTP/1.1\r\nHost: x\r\n\r\n",
    ],
    ids=[
        *("words", "TLS", "HTTP/2", "empty line", "not ASCII", "two lengths", "chunk", "no host"),
        *("two hosts", "two hosts of 1.0", "HTTP/0.9", "HTTP/2.0", "gzip"),
        *("unknown coding", "two codings", "coding and length", "chunks of 1.0"),
        "long and not ASCII",
    ],
)
def test_malformed_request_is_rejected_with_a_problem(served: Served, text: bytes) -> None:
    result = served.responses(text, number=2)
    assert [status for status, _ in result] == [400]
    problem = json.loads(result[0][1])
    assert problem["type"] == "urn:mdr:problem:malformed-http"
    # It says what is wrong, without what was sent.
    assert 10 < len(problem["detail"]) < 100


def test_valid_framing_is_served(served: Served) -> None:
    assert served.responses(b"GET /health HTTP/1.0\r\n\r\n")[0][0] == 200
    assert served.responses(chunked().replace(b": chunked", b": Chunked"))[0][0] == 200
    for host in (b"x:80", b"[::1]:8000", b"", b"a_b.example"):
        text = GET.replace(b"Host: x", b"Host: " + host)
        assert served.responses(text)[0][0] == 200


def test_pipelined_requests_are_answered_in_order(served: Served) -> None:
    result = served.responses((post() + GET) * 8, number=16)
    single = served.responses(post())[0]
    assert result[::2] == [single] * 8
    assert [status for status, _ in result[1::2]] == [200] * 8


def test_flood_of_pipelined_requests_is_answered_one_by_one(served: Served) -> None:
    """The next request is read after the response to the previous one is written."""
    assert [status for status, _ in served.responses(GET * 3_000, number=3_000)] == [200] * 3_000


def test_malformed_request_after_another_gets_its_own_response(served: Served) -> None:
    result = served.responses(GET + b"NONSENSE\r\n\r\n", number=2)
    assert [status for status, _ in result] == [200, 400]


@pytest.mark.parametrize("offer", [UPGRADE, b"Connection: upgrade\r\nUpgrade: websocket\r\n"])
@pytest.mark.parametrize("make", [post, chunked])
def test_upgrade_is_ignored_and_the_request_is_served(
    served: Served, make: object, offer: bytes
) -> None:
    assert callable(make)
    text = make(headers=offer)
    assert served.responses(text) == served.responses(post())
    assert served.responses(text * 3, number=3) == served.responses(post()) * 3


@pytest.mark.alone
def test_body_after_an_upgrade_is_not_read_as_a_request(served: Served) -> None:
    """Behind a proxy, this would let one client answer the next client's request (smuggling)."""
    with served.connect() as client:
        client.sendall(post(GET, UPGRADE))
        assert [status for status, _ in read(client, 1)] == [400]
        client.settimeout(0.3)
        with pytest.raises(TimeoutError):
            client.recv(1)


def test_responses_are_independent_of_request_fragmentation(served: Served) -> None:
    rng = random.Random(1)
    kinds = {
        post(): 200,
        post(headers=UPGRADE): 200,
        chunked(): 200,
        chunked(headers=UPGRADE, trailers=b"X: y\r\n"): 200,
        GET: 200,
        post(b"{"): 400,
        b"GET /nowhere HTTP/1.1\r\nHost: x\r\n\r\n": 404,
    }
    for _ in range(60):
        texts = rng.choices(list(kinds), k=6)
        whole = b"".join(texts)
        cuts = sorted(rng.sample(range(1, len(whole)), rng.choice([0, 1, 5, 40])))
        pieces = [whole[begin:end] for begin, end in pairwise([0, *cuts, len(whole)])]
        result = served.responses(*pieces, number=6)
        assert [status for status, _ in result] == [kinds[text] for text in texts]


def test_100_continue_is_sent(served: Served) -> None:
    with served.connect() as client:
        head, _, body = post(headers=b"Expect: 100-continue\r\n").partition(b"\r\n\r\n")
        client.sendall(head + b"\r\n\r\n")
        assert client.recv(1000).startswith(b"HTTP/1.1 100 ")
        client.sendall(body)
        assert read(client, 1)[0][0] == 200


@pytest.mark.alone
@pytest.mark.usefixtures("short_timeouts")
@pytest.mark.parametrize(
    ("pieces", "name"),
    [
        ([b""], "headers-too-slow"),
        ([b"G", b"E", b"T", b" ", b"/"], "headers-too-slow"),
        ([post()[:-1]], "body-too-slow"),
        ([post()[:-2], b"}"], "body-too-slow"),
        ([post(), post()[:40]], "headers-too-slow"),
    ],
    ids=["nothing", "a byte at a time", "no end of body", "dribbled body", "second"],
)
def test_slow_request_is_rejected(served: Served, pieces: list[bytes], name: str) -> None:
    with served.connect() as client:
        began = time.monotonic()
        for piece in pieces:
            client.sendall(piece)
            time.sleep(0.05)
        result = read(client, 3)
        assert time.monotonic() - began < PATIENCE / 2
        assert is_closed(client)
    status, body = result[-1]
    assert status == 408
    assert json.loads(body)["type"] == f"urn:mdr:problem:{name}"


@pytest.mark.alone
@pytest.mark.usefixtures("short_timeouts")
@pytest.mark.parametrize("rest", [b"a", b"a" * 100], ids=["endless", "late end"])
def test_nothing_follows_an_early_response(served: Served, rest: bytes) -> None:
    with served.connect() as client:
        client.sendall(b"POST /nowhere HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\n")
        assert read(client, 1)[0][0] == 404
        client.sendall(rest)
        assert not read(client, 1)
        wait_for(lambda: send_all(client, (b"a",)))


@pytest.mark.alone
@pytest.mark.usefixtures("short_timeouts")
def test_slow_response_is_not_a_request_timeout(served: Served) -> None:
    query = next(iter(EXAMPLES["evolution"].values()))["value"] | {"resolution": 96}
    body = json.dumps(query).encode()
    text = post(body).replace(b"/v1/normal", b"/v1/wear/evolution")
    # The second request is incomplete, but the first response is still pending.
    with served.connect() as client:
        client.sendall(text + GET[:20])
        assert read(client, 1)[0][0] == 200


def large_request() -> bytes:
    query = CONE | {"load": {"normal_force": [1.0 + 1e-3 * n for n in range(100)]}}
    query |= {"points": 2_000, "quantities": ["pressure"]}
    return post(json.dumps(query).encode()).replace(b"/v1/normal", b"/v1/stress")


def reader(served: Served, buffer: int) -> socket.socket:
    """Return a connection with a receive buffer of the given length."""
    client = socket.socket()
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
    client.settimeout(PATIENCE)
    client.connect(("127.0.0.1", served.port))
    return client


@pytest.mark.alone
def test_client_that_does_not_read_is_disconnected(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    limit(monkeypatch, 3.0)
    with reader(served, 4_096) as client:
        client.sendall(large_request())
        assert client.recv(12).startswith(b"HTTP/1.1 200")
        assert served.app.state.transfers._total > 2**20
        wait_for(lambda: served.app.state.transfers._total == 0)
        # The kernel's buffers are read first.
        wait_for(lambda: is_closed(client))


@pytest.mark.alone
def test_slow_reader_receives_the_whole_response(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    limit(monkeypatch, 1.0)
    expected = served.responses(large_request())[0][1]
    with reader(served, 65_536) as client:
        client.sendall(large_request())
        began = time.monotonic()
        text = b""
        while not text.endswith(expected[-100:]):
            text += client.recv(2**17)
            time.sleep(0.1)
    assert text.endswith(b"\r\n\r\n" + expected)
    assert time.monotonic() - began > 2.0
