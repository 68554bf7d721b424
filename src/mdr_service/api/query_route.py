"""Responses to queries: their format, where they are computed, and the route of their endpoints."""

from collections import Counter
from collections.abc import Callable, Coroutine, Sequence
from typing import Any, Final

from fastapi import Request
from fastapi.routing import APIRoute
from pydantic import ValidationError
from starlette.responses import Response
from uvicorn.protocols.http.flow_control import HIGH_WATER_LIMIT

from mdr_service import problems
from mdr_service.batch import BatchQuery
from mdr_service.content_negotiation import ResponseParameters, appearance, media_type
from mdr_service.dispatch import is_short, respond
from mdr_service.middleware import header, hold, read_body
from mdr_service.query_parameters import Parameters
from mdr_service.schemas import contacts
from mdr_service.serializers import FORMATS, PICTURES
from mdr_service.serializers.picture import Appearance

Handler = Callable[[Request], Coroutine[Any, Any, Response]]
MAX_PARSED_ON_LOOP: Final = 16_384
"""Longest query that is parsed on the event loop [bytes]; the slowest one is rejected in 2 ms."""
# A response depends only on the query and on the version of the service.
_CACHED: Final = {"Cache-Control": "max-age=3600", "Vary": "Accept"}


async def _answer(
    request: Request,
    name: str,
    query: contacts.Query | BatchQuery | bytes | dict[str, str],
    form: tuple[str, Appearance],
    members: Sequence[str] = (),
) -> Response:
    """Return the response; a long or unparsed query runs in a compute process."""
    arguments = name, query, *form, members
    if isinstance(query, contacts.Query) and form[0] not in PICTURES and is_short(query):
        content = respond(*arguments)
    else:
        content = await request.app.state.compute.run_in_process(respond, *arguments)
        if len(content) > HIGH_WATER_LIMIT:
            hold(request, len(content))
    return Response(content, media_type=form[0])


class QueryRoute(APIRoute):
    """Route of the endpoint of a query.

    The framework's own handler parses a body to a dictionary first, resolves dependencies and
    validates the response. This route parses the bytes directly into the model, which takes 20
    instead of 50 µs per request, apart from the computation. It passes long bodies unparsed to a
    compute process, so that they do not block the event loop.
    """

    def __init__(self, handler: Handler, *declared: Any, **described: Any) -> None:
        """Create the route of a `handler`, with the arguments of `APIRoute`."""
        self.handler = handler
        super().__init__(*declared, **described)

    def get_route_handler(self) -> Handler:
        """Return the handler of a request."""
        return self.handler


def handler(name: str, model: type[contacts.Query | BatchQuery | Parameters]) -> Handler:
    """Return the handler of the requests of a query.

    Parameters
    ----------
    name : name of the query, or ``batch``.
    model : model of the request, or of the parameters of the URL that form it.
    """
    parameters = model if issubclass(model, Parameters) else ResponseParameters

    async def handle(request: Request) -> Response:
        texts = _url_parameters(request, parameters)
        try:
            given = parameters.model_validate(texts)
        except ValidationError as error:
            raise problems.from_validation(error, parameters) from None
        # A batch is JSON only.
        offered = ["json"] if name == "batch" else FORMATS
        found = media_type(given.format, header(request.scope, b"accept"), offered)
        form = found, appearance(found, given.size, given.units)
        if isinstance(given, Parameters):
            with given.pointing():
                # A compute process expands ranges, because they can be long.
                query: Any = texts if given.n else given.query()
                response = await _answer(request, name, query, form, given.members)
            response.headers.update(_CACHED)
            return response
        query = await read_body(request)
        if len(query) <= MAX_PARSED_ON_LOOP:
            query = model.model_validate_json(query)
        return await _answer(request, name, query, form)

    return handle


def _url_parameters(request: Request, parameters: type[ResponseParameters]) -> dict[str, str]:
    """Return the parameters of the URL, each of which may be given only once."""
    text: bytes = request.scope["query_string"]
    if not text:
        return {}
    if text.count(b"&") >= len(parameters.model_fields):
        # Thousands of unknown names would block the event loop.
        names = ", ".join(parameters.model_fields)
        raise problems.invalid([("", f"there are more parameters than may be given: {names}")])
    pairs = request.query_params.multi_items()
    numbers = Counter(name for name, _ in pairs)
    if len(numbers) < len(pairs):
        repeated = [problems.pointer([name]) for name, number in numbers.items() if number > 1]
        raise problems.invalid([(each, "is given more than once") for each in repeated])
    return dict(pairs)
