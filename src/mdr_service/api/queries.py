"""Endpoints of the queries by POST, and the route class that they share."""

from collections import Counter
from collections.abc import Awaitable, Callable, Sequence, Sized
from inspect import signature
from typing import Annotated, Any, ClassVar, Final, get_args

from fastapi import APIRouter, Body, Depends, Query, Request
from fastapi.routing import APIRoute
from starlette.responses import Response

from mdr_service import cost, problems
from mdr_service.api.documentation import BATCH_RESPONSES, POST_RESPONSES
from mdr_service.content_negotiation import FORMAT, SIZE, Format, media_type, picture_size
from mdr_service.dispatch import respond, respond_to_body
from mdr_service.middleware import header, read_body
from mdr_service.problems import INVALID_REQUEST, ServiceError
from mdr_service.schemas import contacts
from mdr_service.schemas.batch import BatchAnswer, BatchQuery
from mdr_service.schemas.contacts import NormalQuery, TangentialQuery
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery
from mdr_service.serializers import FORMATS, json
from mdr_service.workers import AT_ONCE_BATCH_BYTES, AT_ONCE_BYTES

_Endpoint = Callable[..., Awaitable[Response]]
_ANY: Final = "*/*"
# Bound; the longest query has about forty.
_MAX_PARAMETERS: Final = 100


class Responder:
    """Response to a query in the requested format.

    Parameters
    ----------
    request : the HTTP request.
    format_ : format of the response; if absent, the header ``Accept`` decides.
    size : width and height of a picture.
    """

    formats: ClassVar[tuple[str, ...]] = tuple(FORMATS)
    at_once_bytes: ClassVar[int] = AT_ONCE_BYTES
    """Length of the longest body that is parsed on the event loop."""

    def __init__(
        self,
        request: Request,
        format_: Annotated[Format | None, Query(alias="format", description=FORMAT)] = None,
        size: Annotated[str | None, Query(description=SIZE)] = None,
    ) -> None:
        accept = header(request.scope, b"accept", _ANY)
        # Most clients accept anything.
        if format_ is None and accept == _ANY:
            self.media_type = json.MEDIA_TYPE
        else:
            self.media_type = media_type(format_, accept, self.formats)
        self.size = None if size is None else picture_size(size, self.media_type)
        self.workers = request.app.state.workers
        self.tasks: Sized = request.scope.get("state", {}).get("tasks", ())

    async def __call__(
        self, name: str, query: contacts.Query | BatchQuery, members: Sequence[str] = ()
    ) -> Response:
        """Compute on the event loop if that is short, else in a compute process."""
        seconds = cost.require_feasible(query, self.media_type)
        arguments = name, query, self.media_type, members, self.size
        if cost.is_short(seconds, len(self.tasks)):
            content = respond(*arguments)
        else:
            content = await self.workers.run_in_process(respond, *arguments)
        return Response(content, media_type=self.media_type)

    async def respond_to_body(self, name: str, text: bytes) -> Response:
        """Parse, compute and serialize in a compute process."""
        arguments = name, text, self.media_type, self.size
        content = await self.workers.run_in_process(respond_to_body, *arguments)
        return Response(content, media_type=self.media_type)


class BatchResponder(Responder):
    """Response to a batch, which is JSON only."""

    formats = ("json",)
    at_once_bytes = AT_ONCE_BATCH_BYTES


class QueryRoute(APIRoute):
    """Route of an endpoint that takes a query and a responder, and is named as the query.

    The framework's own handler works as well, but parses a body to a dictionary first, solves
    dependencies and validates the response. This one parses the bytes straight into the model and
    calls the endpoint: 20 instead of 50 µs per request, apart from the computation. It hands long
    bodies to a compute process unparsed, so that they do not block the event loop.
    """

    def get_route_handler(self) -> Callable[[Request], Any]:
        """Return the handler of a request."""
        query, responder = signature(self.endpoint).parameters.values()
        model, make = get_args(query.annotation)[0], get_args(responder.annotation)[0]
        name = str(self.operation_id)
        endpoint: _Endpoint = self.endpoint

        async def handle(request: Request) -> Response:
            given = url_parameters(request)
            respond_: Responder = make(request, given.pop("format", None), given.pop("size", None))
            if given:
                raise _invalid(dict.fromkeys(given, "there is no such parameter"))
            text = await read_body(request)
            if len(text) > respond_.at_once_bytes:
                return await respond_.respond_to_body(name, text)
            return await endpoint(model.model_validate_json(text), respond_)

        return handle


def url_parameters(request: Request) -> dict[str, str]:
    """Return the parameters of the URL, each of which can be given once."""
    text: bytes = request.scope["query_string"]
    if not text:
        return {}
    if text.count(b"&") >= _MAX_PARAMETERS:
        raise _invalid({"": f"at most {_MAX_PARAMETERS} parameters are read"})
    pairs = request.query_params.multi_items()
    numbers = Counter(name for name, _ in pairs)
    if len(numbers) < len(pairs):
        repeated = [name for name, number in numbers.items() if number > 1]
        raise _invalid(dict.fromkeys(repeated, "is given twice"))
    return dict(pairs)


def _invalid(errors: dict[str, str]) -> ServiceError:
    pointers = [(problems.pointer([name]), detail) for name, detail in errors.items()]
    return ServiceError(INVALID_REQUEST, "some parameters are invalid", pointers)


Respond = Annotated[Responder, Depends()]
RespondToBatch = Annotated[BatchResponder, Depends()]
router = APIRouter(route_class=QueryRoute)


def _post(name: str, summary: str) -> Callable[[_Endpoint], _Endpoint]:
    """Declare the endpoint of a query, as its schema describes it."""
    path, _, answer, tag = SCHEMAS[name]
    return router.post(
        path,
        operation_id=name,
        tags=[tag],
        summary=summary,
        response_model=answer,
        responses=POST_RESPONSES,
    )


@_post("normal", "Normal contact under a depth, a force or a contact radius")
async def post_normal(
    query: Annotated[NormalQuery, Body(openapi_examples=EXAMPLES["normal"])],
    respond: Respond,
) -> Response:
    """Compute the frictionless contact of a profile with an elastic half-space.

    Every list of the response has one entry per load. `method` names the most expensive method
    used, `error_estimate` is an upper bound on the relative error of every number.
    """
    return await respond("normal", query)


@_post("tangential", "Partial slip under a tangential force or displacement, or a stick radius")
async def post_tangential(
    query: Annotated[TangentialQuery, Body(openapi_examples=EXAMPLES["tangential"])],
    respond: Respond,
) -> Response:
    """Compute a contact with friction, loaded normally first and then tangentially once.

    Every list of the response has one entry per pair of loads. A tangential force beyond µ F_N has
    no equilibrium and is rejected; a displacement beyond full slip has the regime `full_slip`.
    """
    return await respond("tangential", query)


@_post("history", "Load history: an arbitrary load path or identical cycles")
async def post_history(
    query: Annotated[HistoryQuery, Body(openapi_examples=EXAMPLES["history"])],
    respond: Respond,
) -> Response:
    """Follow a load path from first contact, and return samples along it.

    The controls vary linearly from point to point. Paths of depths and displacements, and of
    normal and tangential forces, are solved exactly. Where a depth changes with a tangential force,
    or a normal force with a displacement, the path is replaced by chords: the error is mostly 1e-9
    to 1e-7 and within `error_estimate`. A negative depth is a separation, which erases the slip
    memory. A tangential force beyond µ F_N, at a point or between points, has no equilibrium and is
    rejected.

    `error_estimate` is relative to the largest value on the path. A warning `accuracy` reports
    where `slip_fronts` is less accurate. `energy_per_cycle` and `secant_stiffness` belong to
    `cycles`.
    """
    return await respond("history", query)


@_post("stress", "Surface stresses, slip and displacement over the radius")
async def post_stress(
    query: Annotated[StressQuery, Body(openapi_examples=EXAMPLES["stress"])],
    respond: Respond,
) -> Response:
    """Compute the fields named in `quantities`, and nothing else, by load and radius.

    `error_estimate` bounds the error of each field relative to its largest value. A rounding error
    of a requested radius near a, c or a break is not included.
    """
    return await respond("stress", query)


@_post(
    "subsurface", "Stresses beneath the surface of either body, their peaks and the onset of yield"
)
async def post_subsurface(
    query: Annotated[SubsurfaceQuery, Body(openapi_examples=EXAMPLES["subsurface"])],
    respond: Respond,
) -> Response:
    """Compute the stresses named in `quantities` by load, depth z and x, in the plane of one y.

    `error_estimate` is relative to the largest stress of the response. With a `yield_strength` of
    the material, and without `history`, the response holds the normal force at the onset of yield,
    at the same ratio of tangential to normal force. The tangential force acts on body 1 along x,
    its reaction on body 2.
    """
    return await respond("subsurface", query)


@_post("wear", "Limiting state of fretting wear under a small oscillation")
async def post_wear(
    query: Annotated[WearQuery, Body(openapi_examples=EXAMPLES["wear"])], respond: Respond
) -> Response:
    """Compute the limiting profile: the annulus outside the stick zone wears until it is unloaded.

    The given controls are held constant. With a constant depth and displacement amplitude, and with
    constant forces, the limiting state is unique and does not depend on the wear law. With a
    constant normal force and displacement amplitude it depends on the path: the response is
    Eq. (5.90) with a warning `path_dependent`; `/v1/wear/evolution` computes the path itself.

    In full slip, wear is unbounded under a constant force (`endless_wear`), and ends in separation
    at a constant depth (`contact_lost`). Without slip there is no wear (`no_wear`).
    """
    return await respond("wear", query)


@_post("evolution", "Fretting wear over the cycles: profile and pressure up to the limiting state")
async def post_evolution(
    query: Annotated[EvolutionQuery, Body(openapi_examples=EXAMPLES["evolution"])],
    respond: Respond,
) -> Response:
    """Integrate the wear law dh/dN = K µ p S over the cycles.

    h is the worn depth at a radius, and S the sliding distance of a cycle there. The given controls
    are held constant. A query takes about a second, more with the `resolution` and the numbers of
    cycles. A warning `limit_reached` reports after how many cycles wear stops.
    """
    return await respond("evolution", query)


@router.post(
    "/v1/batch",
    operation_id="batch",
    tags=["batch"],
    summary="Queries of any kind, each with its own answer or problem",
    response_model=BatchAnswer,
    responses=BATCH_RESPONSES,
)
async def post_batch(
    query: Annotated[BatchQuery, Body(openapi_examples=EXAMPLES["batch"])],
    respond: RespondToBatch,
) -> Response:
    """Compute each query as at its own endpoint, in the given order.

    The status is 200 if the list itself is valid. Each entry has its own `status`, with the
    `answer` or the `problem`, whose pointers are into its own `request`.
    """
    return await respond("batch", query)
