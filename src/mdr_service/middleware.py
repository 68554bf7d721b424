"""ASGI middleware: request log, problem documents, request bodies and large responses."""

import logging
import os
import re
from asyncio import CancelledError
from collections.abc import Mapping
from time import perf_counter
from typing import Final

import orjson
from anyio import move_on_after
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.middleware.cors import CORSMiddleware
from starlette.requests import ClientDisconnect
from starlette.responses import Response
from starlette.routing import Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.flow_control import HIGH_WATER_LIMIT

from mdr_core import __version__
from mdr_service import observability, problems, sentences
from mdr_service.observability import RequestRecord
from mdr_service.problems import ServiceError
from mdr_service.protocol import LINGER_SECONDS
from mdr_service.serializers import JSON
from mdr_service.settings import SETTINGS

# Request ids that a client may send.
_ID: Final = re.compile(r"[A-Za-z0-9._~+/=-]{1,64}")
# Scheme and authority of a target in absolute form.
_ABSOLUTE: Final = re.compile(r"https?://[^/]*", re.IGNORECASE)
# Status in the log for a client that disconnected before the response, as in nginx.
_CLIENT_CLOSED_REQUEST: Final = 499
_ALWAYS: Final = (
    (b"x-content-type-options", b"nosniff"),
    (b"mdr-version", __version__.encode("ascii")),
)

_OTHER: Final = "other"
_METHODS: Final = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})
_requests: Final = logging.getLogger("mdr_service.requests")
_logger: Final = logging.getLogger(__name__)


def install(app: FastAPI) -> None:
    """Add the middleware and the exception handlers to `app`."""
    for failure in problems.FAILURES:
        app.exception_handler(failure)(_failure)
    app.exception_handler(RequestValidationError)(_invalid_parameters)
    app.exception_handler(HTTPException)(_http_exception)
    app.add_middleware(ServiceMiddleware, transfers=app.state.transfers)
    if SETTINGS.cors_origins:
        # CORS is the outermost layer, so that pages can read problem documents as well.
        app.add_middleware(
            CORSMiddleware,
            allow_origins=SETTINGS.cors_origins,
            allow_methods=("GET", "POST"),
            allow_headers=("Content-Type", "X-Request-Id"),
            expose_headers=("MDR-Version", "Retry-After", "X-Request-Id"),
        )


class Transfers:
    """Total length of large bodies, at most `limit` bytes; a single request may exceed the limit.

    A body is large if it exceeds the server's buffer of a connection.
    """

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._total = 0

    def add(self, record: RequestRecord, size: int) -> None:
        """Add a body, or a part of one, of a request; raise ServiceError beyond the limit."""
        if self._total > record.held and self._total + size > self._limit:
            detail = "other large bodies are being transferred; try again in 1 s"
            raise ServiceError(problems.BUSY, detail, retry_after=1)
        self._total += size
        record.held += size

    def remove(self, record: RequestRecord) -> None:
        """Remove the bodies of a request."""
        self._total -= record.held


class ServiceMiddleware:
    """Outermost layer of the application, except for CORS.

    An exception that reaches the server closes the connection, so that a client that reuses it
    loses the next request. This layer therefore handles every exception.
    """

    def __init__(self, app: ASGIApp, transfers: Transfers) -> None:
        self.app = app
        self.transfers = transfers

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request; respond with a problem document if it fails."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        given = header(scope, b"x-request-id")
        name = given if _ID.fullmatch(given) else os.urandom(8).hex()
        client, _ = scope.get("client") or ("", 0)
        record = RequestRecord(name, scope["method"], client)
        observability.CURRENT.set(record)
        sender = _sender(record, send)
        if scope["method"] == "HEAD":
            # The server omits the body of a response to HEAD.
            scope = {**scope, "method": "GET"}
        if found := _ABSOLUTE.match(scope["path"]):
            # A server accepts the absolute form, which is used for proxies, as well (RFC 9112,
            # 3.2.2).
            scope = {**scope, "path": scope["path"][found.end() :] or "/"}
        try:
            await self.app(scope, receive, sender)
        except ClientDisconnect:
            record.status = _CLIENT_CLOSED_REQUEST
        except CancelledError:
            # The server is shutting down, and its time limit for this request has passed.
            if record.status:
                raise
            stopping = ServiceError(problems.STOPPING, "send the request again", retry_after=1)
            await problem_response(stopping)(scope, receive, sender)
        except Exception:
            if record.status:
                raise
            _logger.exception("internal error, response 500")
            await problem_response(problems.INTERNAL_ERROR)(scope, receive, sender)
        finally:
            self.transfers.remove(record)
            _log(record, scope.get("route"))


def _log(record: RequestRecord, route: object) -> None:
    """Count a finished request and log it."""
    seconds = perf_counter() - record.start
    path = route.path if isinstance(route, Route) else _OTHER
    observability.LATENCIES.labels(path, str(record.status)).observe(seconds)
    members = {
        "method": record.method if record.method in _METHODS else _OTHER,
        "route": path,
        "status": record.status,
        "ms": round(1e3 * seconds, 3),
        "queue_ms": round(1e3 * record.queued, 3),
    }
    _requests.info("request", extra={"members": members})


def _sender(record: RequestRecord, send: Send) -> Send:
    """Return a `send` that adds the common headers, and sends a large body in pieces.

    The server buffers data that the client does not read, so a piece waits until the previous piece
    is written.
    """

    async def send_pieces(message: Message) -> None:
        if message["type"] == "http.response.start":
            record.status = message["status"]
            own = (b"x-request-id", record.id.encode("ascii")), *_ALWAYS
            await send({**message, "headers": [*message["headers"], *own]})
            return
        body = memoryview(message.get("body", b""))
        while len(body) > HIGH_WATER_LIMIT:
            piece, body = body[:HIGH_WATER_LIMIT], body[HIGH_WATER_LIMIT:]
            await send({"type": message["type"], "body": piece, "more_body": True})
        await send({**message, "body": body})

    return send_pieces


def hold(request: Request, size: int) -> None:
    """Count a large body of a request, or a part of one, until its response is sent."""
    request.app.state.transfers.add(observability.CURRENT.get(), size)


def problem_response(error: ServiceError, headers: Mapping[str, str] | None = None) -> Response:
    """Return the response to a request that failed."""
    observability.PROBLEMS.labels(error.type.name).inc()
    document = problems.document(error)
    record = observability.CURRENT.get()
    if record and error.type.status >= problems.INTERNAL.status:
        # The log of the service has the details of an internal error under this id.
        document["instance"] = f"urn:mdr:request:{record.id}"
    # A failure can be transient, so it must not be cached.
    headers = {"Cache-Control": "no-store", **(headers or {})}
    if error.retry_after is not None:
        headers["Retry-After"] = str(error.retry_after)
    return Response(orjson.dumps(document), error.type.status, headers, problems.MEDIA_TYPE)


def header(scope: Scope, name: bytes) -> str:
    """Return the header of a lower-case name, several lines as one list (RFC 9110, 5.3).

    The framework's mapping of all headers takes longer to build than this search.
    """
    lines = [value for each, value in scope["headers"] if each == name]
    return b", ".join(lines).decode("latin-1")


async def read_body(request: Request, *, any_type: bool = False) -> bytes:
    """Return the body; reject it early if it is too large, or not JSON unless it may be a file.

    The server's protocol bounds the time in which it arrives.
    """
    media_type = header(request.scope, b"content-type").partition(";")[0].strip().lower()
    if media_type != JSON and not any_type:
        detail = f"the Content-Type must be {JSON}"
        raise ServiceError(problems.UNSUPPORTED_MEDIA_TYPE, detail)
    announced = header(request.scope, b"content-length")
    if announced.isdecimal() and int(announced) > SETTINGS.max_body_bytes:
        raise await _too_large(request)
    chunks: list[bytes] = []
    size = 0
    async for chunk in request.stream():
        size += len(chunk)
        if size > SETTINGS.max_body_bytes:
            raise await _too_large(request)
        if size > HIGH_WATER_LIMIT:
            hold(request, len(chunk))
        chunks.append(chunk)
    return b"".join(chunks)


async def _too_large(request: Request) -> ServiceError:
    # A connection closed with unread data is reset, and its response may be lost: read the rest.
    with move_on_after(LINGER_SECONDS):
        while (await request.receive()).get("more_body"):
            pass
    detail = f"the limit is {SETTINGS.max_body_bytes} bytes"
    return ServiceError(problems.BODY_TOO_LARGE, detail)


# The handlers are coroutines, because the framework runs plain functions in a thread, which takes
# five times as long as the rest of a rejected request.
async def _failure(_request: Request, error: Exception) -> Response:
    return problem_response(problems.to_problem(error))


async def _invalid_parameters(_request: Request, error: RequestValidationError) -> Response:
    """Return the problem document of parameters that the framework validates."""
    found = error.errors()
    # Each location begins with the part of the request.
    places = [problems.pointer(each["loc"][1:]) for each in found]
    details = [sentences.sentence(each, None) for each in found]
    return problem_response(problems.invalid([*zip(places, details, strict=True)]))


async def _http_exception(request: Request, error: HTTPException) -> Response:
    """Return the problem document of an unknown path or method, found by the framework."""
    if error.status_code == problems.NOT_FOUND.status:
        return problem_response(ServiceError(problems.NOT_FOUND, "GET /docs lists the endpoints"))
    if error.status_code == problems.METHOD_NOT_ALLOWED.status:
        # Static files have no route; the framework returns their methods.
        allowed = _allowed(request) or (error.headers or {})["Allow"]
        detail = f"the method {request.method[: problems.MAX_NAME]} is not allowed: use {allowed}"
        failure = ServiceError(problems.METHOD_NOT_ALLOWED, detail)
        return problem_response(failure, {"Allow": allowed})
    raise error


def _allowed(request: Request) -> str:
    """Return the methods of all routes of a path; the framework lists one route only."""
    path = getattr(request.scope.get("route"), "path", "")
    routes = [each for each in request.app.routes if isinstance(each, Route) and each.path == path]
    allowed = {method for route in routes for method in route.methods or ()}
    return ", ".join(sorted(allowed | ({"HEAD"} if "GET" in allowed else set())))
