"""Every failure as one document, ``application/problem+json`` (RFC 9457).

A document never repeats what the caller sent (but for the names of fields, in pointers) and
never grows past four kilobytes. Nothing here knows of HTTP but the numbers of its statuses.
"""

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import orjson
from pydantic import ValidationError
from pydantic_core import ErrorDetails

from mdr_core.errors import AccuracyError, InputError
from mdr_service.schemas.queries import UNION_FIELDS, UNION_ITEMS

MEDIA_TYPE: Final = "application/problem+json"
MAX_ERRORS: Final = 20
# All errors together; what surrounds them fits well into the rest of 4 kB.
_MAX_ERROR_BYTES: Final = 3000
MAX_NAME: Final = 64


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
BODY_TOO_SLOW = Kind("body-too-slow", 408, "The body did not arrive in time")
BODY_TOO_LARGE = Kind("body-too-large", 413, "The body is too long")
UNSUPPORTED_MEDIA_TYPE = Kind("unsupported-media-type", 415, "The body must be JSON")
INVALID_REQUEST = Kind("invalid-request", 422, "The request cannot be answered as it stands")
TOO_COSTLY = Kind("too-costly", 422, "The answer takes longer than is given to one request")
ACCURACY = Kind("accuracy-not-reachable", 422, "The tolerance cannot be reached")
INTERNAL = Kind("internal-error", 500, "The service is at fault")
BUSY = Kind("busy", 503, "The service has more to do than it can answer soon")
LOST = Kind("process-lost", 503, "The process that worked on the answer has ended")
NOT_READY = Kind("not-ready", 503, "The service does not get a known answer right")
TIME_EXCEEDED = Kind("time-exceeded", 504, "The answer took longer than is given to one request")

KINDS: Final = (
    MALFORMED_JSON,
    NOT_FOUND,
    METHOD_NOT_ALLOWED,
    NOT_ACCEPTABLE,
    BODY_TOO_SLOW,
    BODY_TOO_LARGE,
    UNSUPPORTED_MEDIA_TYPE,
    INVALID_REQUEST,
    TOO_COSTLY,
    ACCURACY,
    INTERNAL,
    BUSY,
    LOST,
    NOT_READY,
    TIME_EXCEEDED,
)

Error = tuple[str, str]


class ServiceError(Exception):
    """A failure that the service itself found; `errors` are pairs of pointer and detail.

    Where the same request may be answered later, `retry_after` says in how many seconds.
    """

    def __init__(
        self, kind: Kind, detail: str, errors: Iterable[Error] = (), retry_after: int | None = None
    ) -> None:
        super().__init__(detail)
        self.kind = kind
        self.detail = detail
        self.errors = tuple(errors)
        self.retry_after = retry_after


DEFECT: Final = ServiceError(INTERNAL, "the request met a defect of the service")
# What a query may fail by, besides a defect: all of it has a document.
FAILURES: Final = (ServiceError, InputError, AccuracyError)


def told(error: Exception) -> ServiceError:
    """Return one of the `FAILURES` as the service tells it."""
    if isinstance(error, InputError):
        return ServiceError(INVALID_REQUEST, error.detail, [(pointer(error.path), error.detail)])
    if isinstance(error, AccuracyError):
        return ServiceError(ACCURACY, str(error), [(pointer(error.path), str(error))])
    if isinstance(error, ServiceError):
        return error
    raise error


def document(error: ServiceError) -> dict[str, Any]:
    """Return the document of one failure."""
    found: dict[str, Any] = {
        "type": error.kind.type,
        "title": error.kind.title,
        "status": error.kind.status,
        "detail": error.detail,
    }
    if listed := _bounded(error.errors):
        found["errors"] = listed
    return found


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
    steps = itertools.takewhile(lambda step: len(step) <= MAX_NAME, map(str, path))
    return "".join("/" + step.replace("~", "~0").replace("/", "~1") for step in steps)


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
