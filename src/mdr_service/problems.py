"""Every failure as one document, ``application/problem+json`` (RFC 9457).

A document never repeats what the caller sent (but for the names of fields, in pointers) and
never grows past four kilobytes.
"""

import itertools
import logging
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import orjson
from fastapi import FastAPI, Request
from pydantic import ValidationError
from pydantic_core import ErrorDetails
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from mdr_core.errors import AccuracyError, InputError
from mdr_service.schemas.queries import UNION_FIELDS, UNION_ITEMS

MEDIA_TYPE: Final = "application/problem+json"
MAX_ERRORS: Final = 20
# All errors together; what surrounds them fits well into the rest of 4 kB.
_MAX_ERROR_BYTES: Final = 3000
_MAX_NAME: Final = 64

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Kind:
    """A kind of failure: what it is called, for machines and for people."""

    name: str
    status: int
    title: str

    @property
    def type(self) -> str:
        """The URI of this kind; it names and does not locate."""
        return f"urn:mdr:problem:{self.name}"


MALFORMED_JSON = Kind("malformed-json", 400, "The body is not JSON")
NOT_FOUND = Kind("not-found", 404, "There is nothing at this address")
METHOD_NOT_ALLOWED = Kind("method-not-allowed", 405, "This address knows other methods")
NOT_ACCEPTABLE = Kind("not-acceptable", 406, "The answer has no such form")
BODY_TOO_LARGE = Kind("body-too-large", 413, "The body is too long")
UNSUPPORTED_MEDIA_TYPE = Kind("unsupported-media-type", 415, "The body must be JSON")
INVALID_REQUEST = Kind("invalid-request", 422, "The request cannot be answered as it stands")
ACCURACY = Kind("accuracy-not-reachable", 422, "The tolerance cannot be reached")
INTERNAL = Kind("internal-error", 500, "The service is at fault")

KINDS: Final = (
    MALFORMED_JSON,
    NOT_FOUND,
    METHOD_NOT_ALLOWED,
    NOT_ACCEPTABLE,
    BODY_TOO_LARGE,
    UNSUPPORTED_MEDIA_TYPE,
    INVALID_REQUEST,
    ACCURACY,
    INTERNAL,
)

Error = tuple[str, str]


class ServiceError(Exception):
    """A failure that the service itself found; `errors` are pairs of pointer and detail."""

    def __init__(self, kind: Kind, detail: str, errors: Iterable[Error] = ()) -> None:
        super().__init__(detail)
        self.kind = kind
        self.detail = detail
        self.errors = tuple(errors)


def response(
    kind: Kind,
    detail: str,
    errors: Iterable[Error] = (),
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return the document of one failure."""
    document: dict[str, Any] = {
        "type": kind.type,
        "title": kind.title,
        "status": kind.status,
        "detail": detail,
    }
    if listed := _bounded(errors):
        document["errors"] = listed
    return Response(orjson.dumps(document), kind.status, headers, MEDIA_TYPE)


def invalid(error: ValidationError) -> ServiceError:
    """Return the failure that a request model found, without what was sent."""
    found = error.errors(include_url=False, include_input=False)
    if found[0]["type"] == "json_invalid":
        return ServiceError(MALFORMED_JSON, found[0]["msg"], [("", found[0]["msg"])])
    return ServiceError(
        INVALID_REQUEST,
        "some values of the request are not acceptable",
        [(pointer(_location(each)), _sentence(each)) for each in found[:MAX_ERRORS]],
    )


def pointer(path: Iterable[str | int]) -> str:
    """Return the JSON pointer (RFC 6901) to `path`.

    A name longer than any of ours is the caller's own text: the pointer ends above it.
    """
    steps = itertools.takewhile(lambda step: len(step) <= _MAX_NAME, map(str, path))
    return "".join("/" + step.replace("~", "~0").replace("/", "~1") for step in steps)


def install(app: FastAPI) -> None:
    """Make every failure of `app` answer with its document."""
    app.exception_handler(ServiceError)(_service_error)
    app.exception_handler(InputError)(_input_error)
    app.exception_handler(AccuracyError)(_accuracy_error)
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
            await response(INTERNAL, "the request met a defect of the service")(
                scope, receive, send
            )


def _service_error(_request: Request, error: ServiceError) -> Response:
    return response(error.kind, error.detail, error.errors)


def _input_error(_request: Request, error: InputError) -> Response:
    return response(INVALID_REQUEST, error.detail, [(pointer(error.path), error.detail)])


def _accuracy_error(_request: Request, error: AccuracyError) -> Response:
    detail = str(error)
    return response(ACCURACY, detail, [("/rtol", detail)])


def _http_exception(request: Request, error: HTTPException) -> Response:
    """Return the document of what the framework refuses: an address or a method."""
    if error.status_code == NOT_FOUND.status:
        return response(NOT_FOUND, "GET /docs shows the addresses that exist")
    if error.status_code == METHOD_NOT_ALLOWED.status:
        detail = f"{request.method[:_MAX_NAME]} is not answered here"
        return response(METHOD_NOT_ALLOWED, detail, headers=error.headers)
    raise error


def _bounded(errors: Iterable[Error]) -> list[dict[str, str]]:
    """Return as many of the errors as fit, the first ones first."""
    listed: list[dict[str, str]] = []
    size = 0
    for where, detail in itertools.islice(errors, MAX_ERRORS):
        error = {"pointer": where, "detail": detail}
        size += len(orjson.dumps(error))
        if size > _MAX_ERROR_BYTES:
            break
        listed.append(error)
    return listed


def _location(error: ErrorDetails) -> Iterator[str | int]:
    """Yield the path into the request: the location without the branches of unions."""
    steps = iter(error["loc"])
    for step in steps:
        yield step
        if step in UNION_FIELDS:
            next(steps, None)
        elif step in UNION_ITEMS:
            yield from itertools.islice(steps, 1)
            next(steps, None)
    if error["type"] in _ABOUT_KIND:
        yield "kind"


# Pydantic's own sentences repeat what was sent, or speak of tags.
_ABOUT_KIND: Final = {
    "union_tag_invalid": "there is no such kind of profile; GET /v1/profiles lists them",
    "union_tag_not_found": "the kind of profile is missing; GET /v1/profiles lists them",
}


def _sentence(error: ErrorDetails) -> str:
    return _ABOUT_KIND.get(error["type"], error["msg"])
