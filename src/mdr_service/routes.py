"""The endpoints: what is asked is read, answered by the one that knows how, and sent."""

from collections.abc import Awaitable, Callable, Mapping
from importlib.resources import files
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.routing import APIRoute
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import request_response

from mdr_service import asking, catalogue, health, parameters, problems, watch, wire
from mdr_service.described import BATCH, QUERIES
from mdr_service.openapi import answers, answers_text
from mdr_service.schemas.answers import Catalogue, Health
from mdr_service.settings import SETTINGS, Settings


class DirectRoute(APIRoute):
    """A route whose endpoint takes the request and returns the response itself.

    The framework resolves parameters, dependencies and response models for every request, also
    where there are none; that takes longer than solving a contact.
    """

    def __init__(self, path: str, endpoint: Callable[..., Any], **options: Any) -> None:
        super().__init__(path, endpoint, **options)
        self.app = request_response(endpoint)
        # What may be read may be asked about; the server leaves the body out.
        if self.methods and "GET" in self.methods:
            self.methods = self.methods | {"HEAD"}


router = APIRouter(route_class=DirectRoute)

_CATALOGUE: Final = catalogue.listed().model_dump()
_LIMITS: Final = SETTINGS.model_dump()
_HEALTH: Final = Health(status="ok").model_dump()
_DOCS_PAGE: Final = files("mdr_service").joinpath("page/docs.html").read_text("utf-8")
# Whatever a document shown there says, the browser asks no other host.
_DOCS_HEADERS: Final = {
    "Content-Security-Policy": (
        "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:"
    )
}


@router.post(
    "/v1/normal",
    operation_id="normal",
    tags=["contact"],
    summary="Depth, force and radius of a normal contact: give one, get the others",
    openapi_extra=QUERIES["normal"].by_body,
)
async def normal_contact(request: Request) -> Response:
    """Answer the contact of a profile with an elastic half-space, without friction.

    Every list of the answer has one entry per load. `method` names the dearest route that was
    taken, `error_estimate` bounds the relative error of every number.
    """
    return await asking.posted(request, "normal")


@router.post(
    "/v1/tangential",
    operation_id="tangential",
    tags=["contact"],
    summary="Stick and slip under a tangential load: give force, displacement or stick radius",
    openapi_extra=QUERIES["tangential"].by_body,
)
async def tangential_contact(request: Request) -> Response:
    """Answer a contact with friction, pressed first and then loaded tangentially once.

    Every list of the answer has one entry per pair of loads. A tangential force beyond µ F_N has
    no equilibrium and is refused; a displacement beyond full slip is answered as `full_slip`.
    """
    return await asking.posted(request, "tangential")


@router.post(
    "/v1/tangential/history",
    operation_id="history",
    tags=["contact"],
    summary="Loads that come and go: any way of normal and tangential load, or equal cycles",
    openapi_extra=QUERIES["history"].by_body,
)
async def loading_history(request: Request) -> Response:
    """Follow the loads from the first touch on, and answer at samples on the way.

    The loads go straight, in the quantities that are given, from one point to the next. Depths
    with displacements, and normal with tangential forces, are followed exactly. A depth with a
    tangential force, or a normal force with a displacement, is followed to `rtol` where both
    change. A depth below zero is a gap, after which nothing is remembered. A tangential force
    beyond µ F_N, at a point or on the way to it, has no equilibrium and is refused.

    The answers over the samples are exact to `error_estimate`, relative to the largest on the
    way. `slip_fronts` may be less exact where both loads change on a way that is not straight; a
    warning `accuracy` says so. `energy_per_cycle` and `secant_stiffness` answer `cycles`.
    """
    return await asking.posted(request, "history")


@router.post(
    "/v1/stress",
    operation_id="stress",
    tags=["contact"],
    summary="Stresses, slip and displacement over the radius",
    openapi_extra=QUERIES["stress"].by_body,
)
async def stress_fields(request: Request) -> Response:
    """Answer the fields named in `quantities`, and nothing else, by load and radius.

    `error_estimate` bounds the error of each field relative to its largest value.
    """
    return await asking.posted(request, "stress")


@router.post(
    "/v1/wear",
    operation_id="wear",
    tags=["wear"],
    summary="Fretting wear in the end: the shape that a small oscillation wears no further",
    openapi_extra=QUERIES["wear"].by_body,
)
async def wear_limit(request: Request) -> Response:
    """Answer the limit of fretting: the rim outside the stick zone wears until it bears nothing.

    What is given is held: the depth or the normal force, and the amplitude. Held depth and
    displacement, and held forces, have one limit, whatever the law of wear. Under a held normal
    force with a displacement the depth grows, and the limit depends on the path: the book's is
    answered with a warning `path_dependent`; `/v1/wear/evolution` follows the path itself.

    Where everything slips, a held force wears without end (`endless_wear`), a held depth until
    nothing touches (`contact_lost`); where nothing slips nothing wears (`no_wear`).
    """
    return await asking.posted(request, "wear")


@router.post(
    "/v1/wear/evolution",
    operation_id="evolution",
    tags=["wear"],
    summary="Fretting wear over the cycles: the shape and the pressure on the way to the limit",
    openapi_extra=QUERIES["evolution"].by_body,
)
async def wear_evolution(request: Request) -> Response:
    """Follow the wear over the cycles, by dV/dN = K W at each place: W is a cycle's friction work.

    What is given is held, as of `/v1/wear`. A single load is followed to all listed numbers of
    cycles; it takes a second or so, more with the resolution, and what takes too long is refused
    beforehand. A warning `limit_reached` says from when on nothing wears any more.
    """
    return await asking.posted(request, "evolution")


@router.post(
    "/v1/batch",
    operation_id="batch",
    tags=["batch"],
    summary="Queries of any kind in one request, each with its own answer or problem",
    openapi_extra=BATCH,
)
async def batch(request: Request) -> Response:
    """Answer each query as it would be answered on its own, in the same order.

    The status is 200 as soon as the list itself is understood: each entry has its own `status`,
    and with it the `answer` or else the `problem`, whose pointers are into its own `request`.
    """
    return await asking.batched(request)


def _ask_by_address(name: str) -> Callable[[Request], Awaitable[Response]]:
    """Return the endpoint of a query that is asked by parameters."""

    async def endpoint(request: Request) -> Response:
        return await asking.got(request, name)

    return endpoint


_BY_ADDRESS = """Answer the same as `POST`, asked by parameters: numbers, and at most one range.

A range, `..._from`, `..._to` and `n`, stands for a list of `n` numbers, evenly or by equal ratios
(`scale=log`). A `+` is read as it stands, also where it is not written `%2B`.
"""

for _name in parameters.KNOWN:
    router.get(
        f"/v1/{_name}",
        operation_id=f"{_name}_by_address",
        tags=["wear" if _name == "wear" else "contact"],
        summary=f"The query `{_name}` in an address, for spreadsheets and browsers",
        description=_BY_ADDRESS,
        openapi_extra=QUERIES[_name].by_address,
    )(_ask_by_address(_name))


def _said(document: Mapping[str, Any]) -> Response:
    return Response(wire.write(document), media_type=wire.MEDIA_TYPE)


@router.get(
    "/v1/profiles",
    operation_id="profiles",
    tags=["catalogue"],
    summary="The kinds of profile, their formulas and their fields",
    openapi_extra=answers(Catalogue),
)
async def profile_catalogue(_request: Request) -> Response:
    """List every kind that a request may name, with what is closed form for it."""
    return _said(_CATALOGUE)


@router.get(
    "/health",
    operation_id="health",
    tags=["operation"],
    summary="Whether the service is ready",
    openapi_extra=answers(Health),
)
async def served(_request: Request) -> Response:
    """Answer 200 as soon as requests are served."""
    return _said(_HEALTH)


@router.get(
    "/health/live",
    operation_id="live",
    tags=["operation"],
    summary="Whether the service answers at all",
    openapi_extra=answers(Health),
)
async def live(_request: Request) -> Response:
    """Answer 200 without any work: what does not answer this is to be started again."""
    return _said(_HEALTH)


@router.get(
    "/health/ready",
    operation_id="ready",
    tags=["operation"],
    summary="Whether the service answers, and answers right",
    openapi_extra=answers(Health, (problems.BUSY, *health.FAILURES)),
)
async def ready(_request: Request) -> Response:
    """Have a compute process answer a Hertzian contact, and compare it with the closed form.

    A service that is ready but has too much to do is not, for the moment.
    """
    await health.check()
    return _said(_HEALTH)


@router.get(
    "/metrics",
    operation_id="metrics",
    tags=["operation"],
    summary="Counts and times of this process, for Prometheus",
    openapi_extra=answers_text("Prometheus' text format."),
)
async def metrics(_request: Request) -> Response:
    """Answer requests and latencies by route, problems by kind, the queue and the processes."""
    return Response(watch.metrics(), media_type=watch.METRICS_MEDIA_TYPE)


@router.get(
    "/v1/limits",
    operation_id="limits",
    tags=["operation"],
    summary="What one request may ask for, and how long it may take",
    openapi_extra=answers(Settings),
)
async def limits(_request: Request) -> Response:
    """Answer the limits of this process, so that a client can send what fits."""
    return _said(_LIMITS)


@router.get("/", include_in_schema=False)
async def root(_request: Request) -> Response:
    """Lead a visitor to the documentation."""
    return RedirectResponse("docs")


@router.get("/docs", include_in_schema=False)
async def docs(_request: Request) -> Response:
    """Show the documentation, from files of this host alone."""
    return HTMLResponse(_DOCS_PAGE, headers=_DOCS_HEADERS)


@router.get("/openapi.json", include_in_schema=False)
async def openapi_document(request: Request) -> Response:
    """Answer the description of this service."""
    return _said(request.app.state.openapi)


ENDPOINTS: Final = {
    (method, route.path): route.endpoint
    for route in router.routes
    if isinstance(route, DirectRoute)
    for method in route.methods or ()
}
