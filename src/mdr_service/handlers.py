"""Every failure of a request, answered with its document."""

import logging
from collections.abc import Awaitable, Callable, Mapping
from typing import Final

import orjson
from anyio import move_on_after
from fastapi import FastAPI, Request
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response
from starlette.routing import Match, Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from mdr_service import headers, problems, watch
from mdr_service.problems import METHOD_NOT_ALLOWED, NOT_FOUND, ServiceError

# Of the service, not of the request.
_OURS: Final = 500
# What a client that went before it was answered is logged as.
_GONE: Final = 499
# Answers to bodies that were not read to their end.
_UNREAD: Final = frozenset({problems.BODY_TOO_SLOW.status, problems.BODY_TOO_LARGE.status})
_LINGER_SECONDS: Final = 1.0
_CLOSE: Final = ((b"connection", b"close"),)
_ALWAYS: Final = ((b"x-content-type-options", b"nosniff"),)

Endpoint = Callable[[Request], Awaitable[Response]]
Endpoints = Mapping[tuple[str, str], Endpoint]
"""What answers, by method and path."""

_log = logging.getLogger(__name__)


def response(error: ServiceError, more: Mapping[str, str] | None = None) -> Response:
    """Return the answer to a request that failed."""
    watch.PROBLEMS.labels(error.kind.name).inc()
    document = problems.document(error)
    watched = watch.current()
    if watched and error.kind.status >= _OURS:
        # A fault of the request is found again by asking again; one of the service in its log.
        document["instance"] = f"urn:mdr:request:{watched.id}"
    # What is wrong today may be mended tomorrow.
    told = {"Cache-Control": "no-store", **(more or {})}
    if error.retry_after is not None:
        told["Retry-After"] = str(error.retry_after)
    return Response(orjson.dumps(document), error.kind.status, told, problems.MEDIA_TYPE)


def install(app: FastAPI, endpoints: Endpoints) -> None:
    """Make every failure of `app` answer with its document; ask the `endpoints` directly."""
    for kind in problems.FAILURES:
        app.exception_handler(kind)(_failure)
    app.exception_handler(HTTPException)(_http_exception)
    app.add_middleware(Watching, endpoints=endpoints)


class Watching:
    """Watches every request, and answers a bug from inside the application.

    An exception that reaches the server makes it drop the connection, and with it the next
    request of a client that reuses connections.

    All addresses are fixed, so that one look finds the endpoint. The framework's layers and its
    search through the routes take as long as a small contact; what has no endpoint goes there.
    """

    def __init__(self, app: ASGIApp, endpoints: Endpoints) -> None:
        self.app = app
        self.endpoints = endpoints

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have the request answered; answer 500 where nothing has been answered yet."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        watched = watch.begin(scope["method"], headers.first(scope, b"x-request-id"))
        marks = [(b"x-request-id", watched.id.encode("ascii")), *_ALWAYS]

        async def told(message: Message) -> None:
            if message["type"] == "http.response.start":
                watched.status = message["status"]
                closing = _CLOSE if watched.status in _UNREAD else ()
                message["headers"] = [*message["headers"], *marks, *closing]
            elif watched.status in _UNREAD and not message.get("more_body"):
                await _linger(message, receive, send)
                message = {"type": "http.response.body"}
            await send(message)

        path = scope["path"]
        # Below a root path the framework knows which part of the path is the address.
        endpoint = None if scope.get("root_path") else self.endpoints.get((scope["method"], path))
        try:
            if endpoint:
                await _ask(endpoint, scope, receive, told)
            else:
                await self.app(scope, receive, told)
        except ClientDisconnect:
            # Nobody is left to answer.
            watched.status = _GONE
        except Exception:
            if watched.status:
                raise
            _log.exception("a defect, answered with 500")
            await response(problems.DEFECT)(scope, receive, told)
        finally:
            watch.end(watched, path if endpoint else _routed(scope))


async def _ask(endpoint: Endpoint, scope: Scope, receive: Receive, send: Send) -> None:
    try:
        answer = await endpoint(Request(scope, receive))
    except problems.FAILURES as error:
        answer = response(problems.told(error))
    await answer(scope, receive, send)


def _routed(scope: Scope) -> str | None:
    route = scope.get("route")
    return route.path if isinstance(route, Route) else None


async def _linger(message: Message, receive: Receive, send: Send) -> None:
    """Send the whole answer, then read on for a while.

    A connection that is closed with something unread is reset, and what was sent last is lost on
    its way.
    """
    await send({**message, "more_body": True})
    with move_on_after(_LINGER_SECONDS):
        while (await receive()).get("more_body"):
            pass


def _failure(_request: Request, error: Exception) -> Response:
    return response(problems.told(error))


def _http_exception(request: Request, error: HTTPException) -> Response:
    """Return the document of what the framework refuses: an address or a method."""
    if error.status_code == NOT_FOUND.status:
        return response(ServiceError(NOT_FOUND, "GET /docs shows the addresses that exist"))
    if error.status_code == METHOD_NOT_ALLOWED.status:
        detail = f"{request.method[: problems.MAX_NAME]} is not answered here"
        return response(ServiceError(METHOD_NOT_ALLOWED, detail), {"Allow": _allowed(request)})
    raise error


def _allowed(request: Request) -> str:
    """Return the methods of all routes at an address; the framework names those of one."""
    scope = {**request.scope, "method": ""}
    routes = [route for route in request.app.routes if isinstance(route, Route)]
    methods = [
        route.methods or set() for route in routes if route.matches(scope)[0] is not Match.NONE
    ]
    return ", ".join(sorted(set().union(*methods)))
