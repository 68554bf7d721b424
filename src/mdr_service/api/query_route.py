"""Responses to queries: their format, where they are computed, and the route of their endpoints."""

from collections import Counter
from collections.abc import Callable, Sequence
from inspect import signature
from typing import Annotated, Any, ClassVar, Final, get_args

from fastapi import Query, Request
from fastapi.routing import APIRoute
from starlette.responses import Response

from mdr_service import problems
from mdr_service.content_negotiation import FORMAT, SIZE, UNITS, Format, appearance, media_type
from mdr_service.dispatch import is_short, respond
from mdr_service.middleware import header, read_body
from mdr_service.problems import ServiceError
from mdr_service.schemas import contacts
from mdr_service.schemas.batch import BatchQuery
from mdr_service.serializers import FORMATS, JSON, PICTURES
from mdr_service.serializers.picture import AS_USUAL
from mdr_service.workers import AT_ONCE_BYTES

# Bound; the longest query has about forty.
_MAX_PARAMETERS: Final = 100


class Responder:
    """Response to a query in the format that a parameter or the header ``Accept`` requests."""

    formats: ClassVar[tuple[str, ...]] = tuple(FORMATS)
    at_once_bytes: ClassVar[int] = AT_ONCE_BYTES
    """Length of the longest body that is parsed on the event loop."""

    def __init__(
        self,
        request: Request,
        format_: Annotated[Format | None, Query(alias="format", description=FORMAT)] = None,
        size: Annotated[str | None, Query(description=SIZE)] = None,
        units: Annotated[str | None, Query(description=UNITS)] = None,
    ) -> None:
        accept = header(request.scope, b"accept", "*/*")
        # Most clients accept anything, and take a picture as it is.
        is_json = format_ is None and accept == "*/*"
        self.media_type = JSON if is_json else media_type(format_, accept, self.formats)
        is_usual = size is None and units is None
        self.appearance = AS_USUAL if is_usual else appearance(self.media_type, size, units)
        self.workers = request.app.state.workers

    async def __call__(
        self,
        name: str,
        query: contacts.Query | BatchQuery | bytes | dict[str, str],
        members: Sequence[str] = (),
    ) -> Response:
        """Return the content, of a long query or an unparsed one from a compute process."""
        arguments = name, query, self.media_type, members, self.appearance
        is_drawn = self.media_type in PICTURES
        if isinstance(query, contacts.Query) and not is_drawn and is_short(query):
            content = respond(*arguments)
        else:
            content = await self.workers.run_in_process(respond, *arguments)
        return Response(content, media_type=self.media_type)


class BatchResponder(Responder):
    """Response to a batch, which is JSON only."""

    formats = ("json",)
    at_once_bytes = 0


class QueryRoute(APIRoute):
    """Route of an endpoint that takes a query and a responder, and is named as the query.

    The framework's own handler works as well, but parses a body to a dictionary first, solves
    dependencies and validates the response. This one parses the bytes straight into the model: 20
    instead of 50 µs per request, apart from the computation. It hands long bodies to a compute
    process unparsed, so that they do not block the event loop.
    """

    def get_route_handler(self) -> Callable[[Request], Any]:
        """Return the handler of a request."""
        parameters = signature(self.endpoint).parameters.values()
        model, responder_type = (get_args(each.annotation)[0] for each in parameters)
        name = str(self.operation_id)

        async def handle(request: Request) -> Response:
            given = await url_parameters(request)
            options = [given.pop(each, None) for each in ("format", "size", "units")]
            responder: Responder = responder_type(request, *options)
            if given:
                raise _invalid(dict.fromkeys(given, "there is no such parameter"))
            query: Any = await read_body(request)
            if len(query) <= responder.at_once_bytes:
                query = model.model_validate_json(query)
            return await responder(name, query)

        return handle


async def url_parameters(request: Request) -> dict[str, str]:
    """Return the parameters of the URL, each of which can be given once.

    A coroutine: the framework runs plain dependencies in a thread, which takes longer than a query.
    """
    text: bytes = request.scope["query_string"]
    if not text:
        return {}
    if text.count(b"&") >= _MAX_PARAMETERS:
        raise _invalid({"": f"at most {_MAX_PARAMETERS} parameters are allowed"})
    pairs = request.query_params.multi_items()
    numbers = Counter(name for name, _ in pairs)
    if len(numbers) < len(pairs):
        repeated = [name for name, number in numbers.items() if number > 1]
        raise _invalid(dict.fromkeys(repeated, "is given more than once"))
    return dict(pairs)


def _invalid(errors: dict[str, str]) -> ServiceError:
    found = [(problems.pointer([name]), detail) for name, detail in errors.items()]
    return problems.invalid(found, len(found))
