"""The endpoints; each of the queries is three statements: convert, solve, convert."""

from collections.abc import Callable
from importlib.resources import files
from typing import Any, Final

import numpy as np
from fastapi import APIRouter, Request
from fastapi.routing import APIRoute
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import request_response

from mdr_core import normal
from mdr_service import compute, convert, problems, wire
from mdr_service.openapi import answers, asks
from mdr_service.schemas.answers import Catalogue, Health, NormalAnswer
from mdr_service.schemas.examples import NORMAL_EXAMPLES
from mdr_service.schemas.queries import NormalQuery


class DirectRoute(APIRoute):
    """A route whose endpoint takes the request and returns the response itself.

    The framework resolves parameters, dependencies and response models for every request, also
    where there are none; that takes longer than solving a contact.
    """

    def __init__(self, path: str, endpoint: Callable[..., Any], **options: Any) -> None:
        super().__init__(path, endpoint, **options)
        self.app = request_response(endpoint)


router = APIRouter(route_class=DirectRoute)

_QUERY_FAILURES: Final = (
    problems.MALFORMED_JSON,
    problems.BODY_TOO_LARGE,
    problems.UNSUPPORTED_MEDIA_TYPE,
    problems.INVALID_REQUEST,
    problems.ACCURACY,
)
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
    openapi_extra=asks(NormalQuery, NORMAL_EXAMPLES) | answers(NormalAnswer, _QUERY_FAILURES),
)
async def normal_contact(request: Request) -> Response:
    """Answer the contact of a profile with an elastic half-space, without friction.

    Every list of the answer has one entry per load. `method` names the dearest route that was
    taken, `error_estimate` bounds the relative error of every number.
    """
    query = await wire.read(request, NormalQuery)
    return await compute.run(query.size, _solve_normal, query)


def _solve_normal(query: NormalQuery) -> Response:
    # What is not finite is looked for in the answer, once, instead of at every operation.
    with np.errstate(all="ignore"):
        contact = normal.solve(**convert.normal_arguments(query))
        return wire.answer(convert.normal_answer(query, contact))


@router.get(
    "/v1/profiles",
    operation_id="profiles",
    tags=["catalogue"],
    summary="The kinds of profile, their formulas and their fields",
    openapi_extra=answers(Catalogue),
)
async def profile_catalogue(_request: Request) -> Response:
    """List every kind that a request may name, with what is closed form for it."""
    return wire.answer(_CATALOGUE)


@router.get(
    "/health",
    operation_id="health",
    tags=["operation"],
    summary="Whether the service is ready",
    openapi_extra=answers(Health),
)
async def health(_request: Request) -> Response:
    """Answer 200 as soon as requests are served."""
    return wire.answer(_HEALTH)


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
    return wire.answer(request.app.state.openapi)
