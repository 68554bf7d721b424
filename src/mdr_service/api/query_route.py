"""Route class of the queries, and the responder that their endpoints receive."""

from collections.abc import Awaitable, Callable
from hashlib import blake2b
from inspect import signature
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, get_args
from urllib.parse import parse_qsl

from fastapi import Depends, Query, Request
from fastapi.routing import APIRoute
from pydantic import BaseModel, ValidationError
from starlette.responses import Response

from mdr_service import cost, problems
from mdr_service.content_negotiation import FORMATS, media_type
from mdr_service.dispatch import parse, respond, respond_to_text
from mdr_service.middleware import header, read_body
from mdr_service.problems import INVALID_REQUEST, ServiceError
from mdr_service.serializers import json
from mdr_service.workers import AT_ONCE_BATCH_BYTES, AT_ONCE_BYTES, AT_ONCE_SECONDS

if TYPE_CHECKING:
    from mdr_service.api.parameters import Parameters

Format = Literal["json", "csv", "npz", "svg"]
Handler = Callable[[Request], Awaitable[Response]]

_ANY: Final = "*/*"
# A response depends on the query and on the version of the service alone.
_CACHE_CONTROL: Final = "max-age=3600"
# Bound; the longest query has about forty.
_MAX_PARAMETERS: Final = 100


class Responder:
    """Response to a query in the requested format.

    Parameters
    ----------
    request : the HTTP request.
    format_ : format of the response; if absent, the header ``Accept`` decides.
    """

    formats: ClassVar[tuple[str, ...]] = tuple(FORMATS)
    at_once_bytes: ClassVar[int] = AT_ONCE_BYTES
    """Length of the longest body that is parsed on the event loop."""

    def __init__(
        self,
        request: Request,
        format_: Annotated[
            Format | None,
            Query(alias="format", description="Format of the response; overrides `Accept`"),
        ] = None,
    ) -> None:
        accept = header(request.scope, b"accept", _ANY)
        # Most clients accept anything.
        if format_ is None and accept == _ANY:
            self.media_type = json.MEDIA_TYPE
        else:
            self.media_type = media_type(format_, accept, self.formats)
        self.workers = request.app.state.workers

    async def __call__(self, name: str, query: BaseModel) -> Response:
        """Compute on the event loop if that is short, else in a compute process."""
        seconds = cost.require_feasible(query, self.media_type)
        arguments = name, query, self.media_type
        if seconds <= AT_ONCE_SECONDS:
            content = respond(*arguments)
        else:
            content = await self.workers.run_in_process(respond, *arguments)
        return Response(content, media_type=self.media_type)

    async def to_text(self, name: str, text: bytes) -> Response:
        """Parse, compute and serialize in a compute process."""
        arguments = name, text, self.media_type
        content = await self.workers.run_in_process(respond_to_text, *arguments)
        return Response(content, media_type=self.media_type)


class BatchResponder(Responder):
    """Response to a batch, which is JSON only."""

    formats = ("json",)
    at_once_bytes = AT_ONCE_BATCH_BYTES


class QueryRoute(APIRoute):
    """Route of an endpoint that takes a query and a responder; POST routes are named as queries.

    The framework's own handler works as well, but parses a body to a dictionary first, solves
    dependencies and validates the response. This one parses the bytes straight into the model and
    calls the endpoint: 20 instead of 50 µs per request besides the computation. It hands long
    bodies to a compute process unparsed, so that they do not block the event loop. In URLs a plus
    sign is a plus sign, repeated parameters are rejected, and responses can be cached.
    """

    def get_route_handler(self) -> Callable[[Request], Any]:
        """Return the handler of a request."""
        query, responder = signature(self.endpoint).parameters.values()
        model, make = get_args(query.annotation)[0], get_args(responder.annotation)[0]
        name = str(self.operation_id)
        endpoint: Callable[..., Awaitable[Response]] = self.endpoint
        by_body = self.methods == {"POST"}

        async def from_body(request: Request) -> Response:
            given = _split(request)
            respond_: Responder = make(request, given.pop("format", None))
            if given:
                raise _invalid([(each, "there is no such parameter") for each in given])
            text = await read_body(request)
            if len(text) > respond_.at_once_bytes:
                return await respond_.to_text(name, text)
            return await endpoint(parse(model, text), respond_)

        async def from_parameters(request: Request) -> Response:
            given = _split(request)
            respond_: Responder = make(request, given.pop("format", None))
            try:
                parameters: Parameters = model.model_validate(given)
            except ValidationError as error:
                raise problems.from_validation(error) from None
            try:
                response = await endpoint(parameters, respond_)
            except ValidationError as error:
                raise parameters.pointed(problems.from_validation(error)) from None
            except problems.FAILURES as error:
                raise parameters.pointed(problems.to_problem(error)) from None
            return _cacheable(request, response)

        return from_body if by_body else from_parameters


Respond = Annotated[Responder, Depends()]
RespondToBatch = Annotated[BatchResponder, Depends()]


def _split(request: Request) -> dict[str, str]:
    """Return the parameters of the URL by name; a plus sign is not a space."""
    # The request's `url` would assemble the whole URL first.
    text = request.scope["query_string"].decode("latin-1").replace("+", "%2B")
    try:
        pairs = parse_qsl(text, keep_blank_values=True, max_num_fields=_MAX_PARAMETERS)
    except ValueError:
        raise _invalid([("", f"at most {_MAX_PARAMETERS} parameters are read")]) from None
    given = dict(pairs)
    if len(given) < len(pairs):
        names = [name for name, _ in pairs]
        repeated = [name for name in given if names.count(name) > 1]
        raise _invalid([(name, "is given twice") for name in repeated])
    return given


def _invalid(errors: list[tuple[str, str]]) -> ServiceError:
    pointers = [(problems.pointer([name]), detail) for name, detail in errors]
    return ServiceError(INVALID_REQUEST, "some parameters are invalid", pointers)


def _cacheable(request: Request, response: Response) -> Response:
    """Return the response with a validator, or 304 if the client has it already.

    The tag is weak, since a proxy may compress the same numbers.
    """
    digest = blake2b(response.body, digest_size=16).hexdigest()
    headers = {"ETag": f'W/"{digest}"', "Cache-Control": _CACHE_CONTROL, "Vary": "Accept"}
    known = header(request.scope, b"if-none-match")
    tags = {tag.strip().removeprefix("W/") for tag in known.split(",")}
    if tags & {f'"{digest}"', "*"}:
        return Response(status_code=304, headers=headers)
    response.headers.update(headers)
    return response
