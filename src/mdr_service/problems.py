"""Problem documents of failed requests (RFC 9457)."""

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from pydantic import BaseModel, ValidationError

from mdr_core.errors import AccuracyError, InputError
from mdr_core.table_headings import ColumnsError
from mdr_service import sentences

MEDIA_TYPE: Final = "application/problem+json"
# Maximum number of errors in a document, enough to show a pattern.
MAX_ERRORS: Final = 20
# No field name of a request is this long; a longer name is text of the client.
MAX_NAME: Final = 64


@dataclass(frozen=True)
class ProblemType:
    """Name, HTTP status and title of a type of problem."""

    name: str
    status: int
    title: str

    @property
    def uri(self) -> str:
        """The `type` member: a name, not a location."""
        return f"urn:mdr:problem:{self.name}"


MALFORMED_HTTP = ProblemType("malformed-http", 400, "Request is not valid HTTP/1.1")
MALFORMED_JSON = ProblemType("malformed-json", 400, "Body is not valid JSON")
NOT_FOUND = ProblemType("not-found", 404, "Unknown URL")
METHOD_NOT_ALLOWED = ProblemType("method-not-allowed", 405, "Method not allowed")
NOT_ACCEPTABLE = ProblemType("not-acceptable", 406, "Format not available")
HEADERS_TOO_SLOW = ProblemType("headers-too-slow", 408, "Headers not received in time")
BODY_TOO_SLOW = ProblemType("body-too-slow", 408, "Body not received in time")
BODY_TOO_LARGE = ProblemType("body-too-large", 413, "Body too large")
UNSUPPORTED_MEDIA_TYPE = ProblemType("unsupported-media-type", 415, "Body must be JSON")
INVALID_REQUEST = ProblemType("invalid-request", 422, "Invalid request")
ACCURACY = ProblemType("accuracy-not-reachable", 422, "Accuracy cannot be reached")
HEADERS_TOO_LARGE = ProblemType("headers-too-large", 431, "Headers too large")
INTERNAL = ProblemType("internal-error", 500, "Internal error")
BUSY = ProblemType("busy", 503, "Service is busy")
LOST = ProblemType("process-lost", 503, "Compute process lost")
NOT_READY = ProblemType("not-ready", 503, "Self-test failed")
STOPPING = ProblemType("stopping", 503, "Service is shutting down")
TIME_EXCEEDED = ProblemType("time-exceeded", 504, "Time limit exceeded")

Error = tuple[str, str]
"""JSON pointer into the request, and the reason."""


@dataclass(eq=False)
class ServiceError(Exception):
    """Failure of a request, with the members of its problem document."""

    type: ProblemType
    detail: str
    errors: Sequence[Error] = ()
    retry_after: int | None = None
    """Seconds after which the same request may succeed."""

    def __post_init__(self) -> None:
        # Compute processes pickle an exception by its arguments.
        super().__init__(self.type, self.detail, self.errors, self.retry_after)

    def __str__(self) -> str:
        return self.detail


INTERNAL_ERROR: Final = ServiceError(
    INTERNAL, "internal error: report it with the request, and with the instance if there is one"
)
FAILURES: Final = (ServiceError, InputError, AccuracyError, ValidationError)
"""Exceptions with a problem document of their own; any other is an internal error."""


def to_problem(error: Exception) -> ServiceError:
    """Return one of the `FAILURES` as a `ServiceError`."""
    if isinstance(error, InputError):
        columns = error.columns if isinstance(error, ColumnsError) else {}
        choices = [(pointer(("columns", number)), name) for number, name in columns.items()]
        return invalid([(pointer(error.path), error.detail), *choices])
    if isinstance(error, AccuracyError):
        return replace(invalid([(pointer(error.path), error.detail)]), type=ACCURACY)
    if isinstance(error, ValidationError):
        return from_validation(error)
    if isinstance(error, ServiceError):
        return error
    raise error


def document(error: ServiceError) -> dict[str, Any]:
    """Return the problem document."""
    found: dict[str, Any] = {
        "type": error.type.uri,
        "title": error.type.title,
        "status": error.type.status,
        "detail": error.detail,
    }
    if error.errors:
        listed = error.errors[:MAX_ERRORS]
        found["errors"] = [{"pointer": where, "detail": detail} for where, detail in listed]
    return found


def from_validation(error: ValidationError, model: type[BaseModel] | None = None) -> ServiceError:
    """Return the failure of a model, without the values sent; the default is a request model."""
    model = model or sentences.REQUESTS.get(error.title)
    found = error.errors(include_url=False, include_input=False)
    if found[0]["type"] == "json_invalid":
        detail = sentences.of_json(found[0]["msg"])
        return ServiceError(MALFORMED_JSON, detail, [("", detail)])
    errors = [
        (pointer(sentences.path(each)), sentences.sentence(each, model))
        for each in found[:MAX_ERRORS]
    ]
    return invalid(errors, len(found))


def invalid(errors: Sequence[Error], count: int | None = None) -> ServiceError:
    """Return the failure of a request with its errors, the first as its detail.

    Parameters
    ----------
    errors : pointers and reasons.
    count : number of the errors if some are left out.
    """
    (where, detail), *_ = errors
    if place := where[1:].replace("/", ".").replace("~1", "/").replace("~0", "~"):
        detail = f"{place}: {detail}"
    if others := (count or len(errors)) - 1:
        detail += f" (and {others} more)"
    return ServiceError(INVALID_REQUEST, detail, errors)


def pointer(path: Iterable[str | int]) -> str:
    """Return the JSON pointer (RFC 6901) to `path`.

    The pointer ends before a name that is longer than any field name, because that is text of the
    client.
    """
    steps = itertools.takewhile(lambda step: len(step) <= MAX_NAME, map(str, path))
    return "".join("/" + step.replace("~", "~0").replace("/", "~1") for step in steps)
