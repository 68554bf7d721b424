"""Every failure of a request, answered with its document."""

import logging
from collections.abc import Mapping

import orjson
from fastapi import FastAPI, Request
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response
from starlette.routing import Match, Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from mdr_service import problems
from mdr_service.problems import METHOD_NOT_ALLOWED, NOT_FOUND, ServiceError

_log = logging.getLogger(__name__)


def response(error: ServiceError, headers: Mapping[str, str] | None = None) -> Response:
    """Return the answer to a request that failed."""
    text = orjson.dumps(problems.document(error))
    # What is wrong today may be mended tomorrow.
    told = {"Cache-Control": "no-store", **(headers or {})}
    return Response(text, error.kind.status, told, problems.MEDIA_TYPE)


def install(app: FastAPI) -> None:
    """Make every failure of `app` answer with its document."""
    for kind in problems.FAILURES:
        app.exception_handler(kind)(_failure)
    app.exception_handler(HTTPException)(_http_exception)
    app.add_middleware(CatchAll)


class CatchAll:
    """Answers a bug from inside the application.

    An exception that reaches the server makes it drop the connection, and with it the next
    request of a client that reuses connections.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on; answer 500 where nothing has been answered yet."""
        started = False

        async def watched_send(message: Message) -> None:
            nonlocal started
            started = True
            await send(message)

        try:
            await self.app(scope, receive, watched_send)
        except ClientDisconnect:
            # Nobody is left to answer.
            return
        except Exception:
            if started or scope["type"] != "http":
                raise
            _log.exception("a defect, answered with 500")
            await response(problems.DEFECT)(scope, receive, send)


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
