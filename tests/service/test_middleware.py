"""Long bodies, errors and shutdown get a response from the middleware."""

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

import pytest
from fastapi import FastAPI, Request
from starlette.responses import Response
from uvicorn.protocols.http.flow_control import HIGH_WATER_LIMIT

from mdr_service import middleware
from mdr_service.middleware import Transfers, hold, read_body

TEXT = bytes(range(256)) * (HIGH_WATER_LIMIT // 100)


class Connection:
    """One request to an application with a single endpoint, and its response messages."""

    def __init__(
        self, app: FastAPI, method: str = "GET", body: bytes = b"", **headers: str
    ) -> None:
        self.app = app
        self.scope: dict[str, Any] = {
            "type": "http",
            "method": method,
            "path": "/",
            "query_string": b"",
            "headers": [
                (name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()
            ],
        }
        self.incoming: list[dict[str, Any]] = [{"type": "http.request", "body": body}]
        self.sent: list[dict[str, Any]] = []
        self.reading = asyncio.Event()
        self.reading.set()

    async def receive(self) -> dict[str, Any]:
        return self.incoming.pop(0) if self.incoming else {"type": "http.disconnect"}

    async def send(self, message: dict[str, Any]) -> None:
        self.sent.append(message)
        await self.reading.wait()

    async def run(self) -> "Connection":
        await self.app(self.scope, self.receive, self.send)
        return self

    @property
    def status(self) -> int:
        return int(self.sent[0]["status"])

    @property
    def body(self) -> bytes:
        return b"".join(message.get("body", b"") for message in self.sent[1:])

    @property
    def problem(self) -> str:
        return str(json.loads(self.body)["type"]).removeprefix("urn:mdr:problem:")


def application(endpoint: Callable[[Request], Awaitable[Response]], limit: int = 2**20) -> FastAPI:
    app = FastAPI(openapi_url=None)
    app.add_route("/", endpoint, methods=["GET", "HEAD", "POST"])
    app.state.transfers = Transfers(limit)
    middleware.install(app)
    return app


async def long_response(request: Request) -> Response:
    hold(request, len(TEXT))
    return Response(TEXT)


async def echo(request: Request) -> Response:
    return Response(await read_body(request))


def test_long_response_is_sent_in_chunks() -> None:
    async def test() -> None:
        app = application(long_response)
        result = await Connection(app).run()
        assert result.body == TEXT
        pieces = [len(message["body"]) for message in result.sent[1:]]
        assert max(pieces) == HIGH_WATER_LIMIT
        assert [message.get("more_body", False) for message in result.sent[1:]][-2:] == [
            True,
            False,
        ]
        assert app.state.transfers._total == 0

    asyncio.run(test())


def test_long_response_is_rejected_while_others_are_sent() -> None:
    async def test() -> None:
        app = application(long_response, len(TEXT))
        slow = Connection(app)
        slow.reading.clear()
        sending = asyncio.create_task(slow.run())
        await asyncio.sleep(0)
        result = await Connection(app).run()
        assert (result.status, result.problem) == (503, "busy")
        assert (b"retry-after", b"1") in result.sent[0]["headers"]
        slow.reading.set()
        await sending
        assert slow.body == TEXT
        assert (await Connection(app).run()).status == 200

    asyncio.run(test())


def test_long_body_is_rejected_while_others_are_received() -> None:
    async def test() -> None:
        app = application(echo, 4 * HIGH_WATER_LIMIT)
        json_type = {"content_type": "application/json"}
        first = Connection(app, "POST", TEXT, **json_type)
        first.incoming[0]["more_body"] = True
        arrived = asyncio.Event()

        async def wait() -> dict[str, Any]:
            if first.incoming:
                return first.incoming.pop(0)
            await arrived.wait()
            return {"type": "http.request", "body": TEXT}

        first.receive = wait  # type: ignore[method-assign]
        receiving = asyncio.create_task(first.run())
        await asyncio.sleep(0)
        result = await Connection(app, "POST", TEXT, **json_type).run()
        assert (result.status, result.problem) == (503, "busy")
        # Short bodies are not counted.
        assert (await Connection(app, "POST", b"{}", **json_type).run()).body == b"{}"
        arrived.set()
        await receiving
        assert first.body == TEXT * 2

    asyncio.run(test())


def test_client_that_disconnects_gets_no_response() -> None:
    connection = Connection(application(echo), "POST", content_type="application/json")
    connection.incoming.clear()
    assert not asyncio.run(connection.run()).sent


@pytest.mark.parametrize("responding", [False, True])
def test_request_in_flight_at_the_end_of_shutdown_is_rejected(*, responding: bool) -> None:
    async def wait(_request: Request) -> Response:
        await asyncio.sleep(60)
        return Response()

    async def test() -> None:
        result = Connection(application(long_response if responding else wait))
        if responding:
            result.reading.clear()
        task = asyncio.create_task(result.run())
        await asyncio.sleep(0.01)
        result.reading.set()
        task.cancel()
        if responding:
            # The server then closes the connection.
            with pytest.raises(asyncio.CancelledError):
                await task
        else:
            await task
            assert (result.status, result.problem) == (503, "stopping")

    asyncio.run(test())


def test_internal_error_is_a_problem_unless_the_response_has_begun() -> None:
    async def broken(_request: Request) -> Response:
        raise RuntimeError("a secret")

    class Interrupted(Response):
        async def __call__(self, scope: object, receive: object, send: Any) -> None:
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": b"a", "more_body": True})
            raise RuntimeError

    async def interrupted(_request: Request) -> Response:
        return Interrupted()

    result = asyncio.run(Connection(application(broken)).run())
    assert (result.status, result.problem) == (500, "internal-error")
    assert b"secret" not in result.body
    with pytest.raises(RuntimeError):
        asyncio.run(Connection(application(interrupted)).run())
