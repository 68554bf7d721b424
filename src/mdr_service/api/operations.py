"""Operation of the service, its documentation and the catalogue of profiles."""

from importlib.resources import files
from typing import Annotated, Final

from fastapi import APIRouter, Query, Request
from prometheus_client import generate_latest
from starlette.responses import HTMLResponse, PlainTextResponse, Response

from mdr_core import COMPILED, __version__, profiles
from mdr_service import health, observability, problems, tables
from mdr_service.api.documentation import FILE_FAILURES, PAGE_HEADERS, failures
from mdr_service.middleware import read_body
from mdr_service.schemas.answers import Catalogue, Health, ProfileField, ProfileKind, TableAnswer
from mdr_service.schemas.profiles import MODELS
from mdr_service.schemas.quantities import described
from mdr_service.serializers import JSON
from mdr_service.settings import SETTINGS, Settings

router = APIRouter(responses=failures(problems.HEADERS_TOO_LARGE))

_DOCS_PAGE: Final = files("mdr_service").joinpath("page/docs.html").read_text("utf-8")
# Media type of the text format of Prometheus.
_METRICS: Final = "text/plain; version=0.0.4; charset=utf-8"
_AS: Final = "`profile` (radius and height) or `curve` (depth and force)"
_COLUMNS: Final = "Numbers of the two columns, such as `2,3`, if the headings do not identify them"
_EXAMPLE: Final = {"schema": {"type": "string"}, "example": "r [mm];f [µm]\n0;0\n0,1;0,5"}
_FILE: Final = {"requestBody": {"required": True, "content": {"text/csv": _EXAMPLE}}}
_OK: Final = Health(status="ok", version=__version__, compiled=COMPILED)
_CATALOGUE: Final = Catalogue(
    profiles=[
        ProfileKind(
            kind=kind,
            formula=profiles.KINDS[kind].formula,
            fields=[
                ProfileField(
                    name=name,
                    dimension=dimension,
                    description=meaning,
                    required=field.is_required(),
                )
                for name, field in model.model_fields.items()
                for meaning, dimension in [described(field.description)]
                if dimension
            ],
            closed_forms=list(profiles.KINDS[kind].closed_forms),
        )
        for kind, model in MODELS.items()
    ]
)


@router.get("/v1/profiles", operation_id="profiles", tags=["catalogue"], summary="Profile kinds")
async def list_profiles() -> Catalogue:
    """List the kinds of profile with their formulas, fields and closed forms."""
    return _CATALOGUE


@router.post(
    "/v1/table",
    operation_id="table",
    tags=["contact"],
    summary="Columns of a profile or a curve in a file of an instrument",
    response_model=TableAnswer,
    responses=FILE_FAILURES,
    openapi_extra=_FILE,
)
async def read_table(
    request: Request,
    kind: Annotated[str, Query(alias="as", description=_AS)] = "profile",
    columns: Annotated[
        str | None, Query(pattern=r"^[1-9]\d{0,3},[1-9]\d{0,3}$", description=_COLUMNS)
    ] = None,
) -> Response:
    """Read a text file with headings, units, decimal commas and further columns.

    Nothing is guessed: a text that is not understood is rejected with its line and the remedy. If
    the headings do not identify the two columns, `errors` lists all columns.
    """
    if kind not in tables.KINDS:
        raise problems.invalid([("/as", f"must be one of {', '.join(tables.KINDS)}")])
    content = await read_body(request, any_type=True)
    places = [int(number) for number in columns.split(",")] if columns else None
    answer = await request.app.state.compute.run_in_process(tables.read, content, kind, places)
    return Response(answer, media_type=JSON)


@router.get("/v1/limits", operation_id="limits", tags=["operation"], summary="Limits of a request")
async def list_limits() -> Settings:
    """Return the limits of this process, so that clients can adapt their requests."""
    return SETTINGS


@router.get("/health/live", operation_id="live", tags=["operation"], summary="Liveness probe")
@router.get("/health", operation_id="health", tags=["operation"], summary="State of the service")
async def live() -> Health:
    """Return 200. Restart an instance that does not respond."""
    return _OK


@router.get(
    "/health/ready",
    operation_id="ready",
    tags=["operation"],
    summary="Readiness probe",
    responses=failures(problems.BUSY, problems.LOST, problems.NOT_READY, problems.TIME_EXCEEDED),
)
async def ready(request: Request) -> Health:
    """Return 200 if a compute process solves a Hertzian contact correctly.

    A busy instance is temporarily not ready.
    """
    await request.app.state.compute.run_in_process(health.self_test, seconds=health.SECONDS)
    return _OK


@router.get(
    "/metrics",
    operation_id="metrics",
    tags=["operation"],
    summary="Prometheus metrics",
    response_class=PlainTextResponse,
)
async def metrics() -> Response:
    """Return requests and latencies by route, problems by type, and the state of the queue."""
    return Response(generate_latest(observability.REGISTRY), media_type=_METRICS)


@router.get("/docs", include_in_schema=False)
async def docs() -> Response:
    """Return the documentation page, all files of which come from this host."""
    return HTMLResponse(_DOCS_PAGE, headers=PAGE_HEADERS)
