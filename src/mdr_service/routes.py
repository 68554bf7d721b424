"""The endpoints: what is asked is read, answered by the one that knows how, and sent."""

from collections.abc import Callable, Mapping
from importlib.resources import files
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.routing import APIRoute
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import request_response

from mdr_service import (
    body,
    compute,
    convert,
    forms,
    pictures,
    problems,
    questions,
    table,
    wire,
)
from mdr_service.openapi import answers, asks
from mdr_service.schemas.answers import (
    Catalogue,
    EvolutionAnswer,
    Health,
    HistoryAnswer,
    NormalAnswer,
    StressAnswer,
    TangentialAnswer,
    WearAnswer,
)
from mdr_service.schemas.examples import (
    EVOLUTION_EXAMPLES,
    HISTORY_EXAMPLES,
    NORMAL_EXAMPLES,
    STRESS_EXAMPLES,
    TANGENTIAL_EXAMPLES,
    WEAR_EXAMPLES,
)
from mdr_service.schemas.queries import HistoryQuery, NormalQuery, StressQuery, TangentialQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery


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

_QUERY_FAILURES: Final = (
    problems.MALFORMED_JSON,
    problems.NOT_ACCEPTABLE,
    problems.BODY_TOO_LARGE,
    problems.UNSUPPORTED_MEDIA_TYPE,
    problems.INVALID_REQUEST,
    problems.ACCURACY,
)
_ROW_PER_LOAD: Final = {table.MEDIA_TYPE: "One column per list, one row per load."}
_CATALOGUE: Final = convert.catalogue().model_dump()
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
    openapi_extra=asks(NormalQuery, NORMAL_EXAMPLES)
    | answers(NormalAnswer, _QUERY_FAILURES, _ROW_PER_LOAD),
)
async def normal_contact(request: Request) -> Response:
    """Answer the contact of a profile with an elastic half-space, without friction.

    Every list of the answer has one entry per load. `method` names the dearest route that was
    taken, `error_estimate` bounds the relative error of every number.
    """
    return await _ask(request, "normal")


@router.post(
    "/v1/tangential",
    operation_id="tangential",
    tags=["contact"],
    summary="Stick and slip under a tangential load: give force, displacement or stick radius",
    openapi_extra=asks(TangentialQuery, TANGENTIAL_EXAMPLES)
    | answers(
        TangentialAnswer,
        _QUERY_FAILURES,
        _ROW_PER_LOAD
        | {pictures.MEDIA_TYPE: "Force over displacement up to full slip, first normal load."},
    ),
)
async def tangential_contact(request: Request) -> Response:
    """Answer a contact with friction, pressed first and then loaded tangentially once.

    Every list of the answer has one entry per pair of loads. A tangential force beyond µ F_N has
    no equilibrium and is refused; a displacement beyond full slip is answered as `full_slip`.
    """
    return await _ask(request, "tangential")


@router.post(
    "/v1/tangential/history",
    operation_id="history",
    tags=["contact"],
    summary="Loads that come and go: any way of normal and tangential load, or equal cycles",
    openapi_extra=asks(HistoryQuery, HISTORY_EXAMPLES)
    | answers(
        HistoryAnswer,
        _QUERY_FAILURES,
        {
            table.MEDIA_TYPE: "One column per list over the samples, one row per sample.",
            pictures.MEDIA_TYPE: "Force over displacement, with the points that were given.",
        },
    ),
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
    return await _ask(request, "history")


@router.post(
    "/v1/stress",
    operation_id="stress",
    tags=["contact"],
    summary="Stresses, slip and displacement over the radius",
    openapi_extra=asks(StressQuery, STRESS_EXAMPLES)
    | answers(
        StressAnswer,
        _QUERY_FAILURES,
        {
            table.MEDIA_TYPE: "One column per field, one row per radius; with several loads the "
            "index of the load in a first column, and one row per load and radius.",
            pictures.MEDIA_TYPE: "The fields over the radius, with a, c and the breaks b marked.",
        },
    ),
)
async def stress_fields(request: Request) -> Response:
    """Answer the fields named in `quantities`, and nothing else, by load and radius.

    `error_estimate` bounds the error of each field relative to its largest value.
    """
    return await _ask(request, "stress")


@router.post(
    "/v1/wear",
    operation_id="wear",
    tags=["wear"],
    summary="Fretting wear in the end: the shape that a small oscillation wears no further",
    openapi_extra=asks(WearQuery, WEAR_EXAMPLES)
    | answers(
        WearAnswer,
        _QUERY_FAILURES,
        {
            table.MEDIA_TYPE: "Without radii one column per list, one row per load; with them one "
            "column per field, one row per radius, and with several loads the index of the load "
            "in a first column, and one row per load and radius.",
            pictures.MEDIA_TYPE: "The profile before and in the limit, with c and ã marked.",
        },
    ),
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
    return await _ask(request, "wear")


@router.post(
    "/v1/wear/evolution",
    operation_id="evolution",
    tags=["wear"],
    summary="Fretting wear over the cycles: the shape and the pressure on the way to the limit",
    openapi_extra=asks(EvolutionQuery, EVOLUTION_EXAMPLES)
    | answers(
        EvolutionAnswer,
        _QUERY_FAILURES,
        {
            table.MEDIA_TYPE: "Without radii one column per list, one row per number of cycles; "
            "with them the cycles, the radius, and one column per field.",
            pictures.MEDIA_TYPE: "Profiles and pressures over the cycles, with the limiting "
            "profile where there is one.",
        },
    ),
)
async def wear_evolution(request: Request) -> Response:
    """Follow the wear over the cycles, by dV/dN = K W at each place: W is a cycle's friction work.

    What is given is held, as of `/v1/wear`. A single load is followed to all listed numbers of
    cycles; it takes a second or so, more with the resolution, and what takes too long is refused
    beforehand. A warning `limit_reached` says from when on nothing wears any more.
    """
    return await _ask(request, "evolution")


async def _ask(request: Request, name: str) -> Response:
    """Return the answer to the question `name` that the request holds."""
    question = questions.QUESTIONS[name]
    media_type = forms.chosen(request, question.media_types)
    query = wire.read(question.model, await body.read(request))
    effort = questions.effort(query, media_type)
    found = await compute.run(effort, questions.answer, name, query, media_type)
    return Response(found.content, media_type=found.media_type)


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
async def health(_request: Request) -> Response:
    """Answer 200 as soon as requests are served."""
    return _said(_HEALTH)


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
