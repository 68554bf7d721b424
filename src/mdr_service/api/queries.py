"""Endpoints of the queries, by POST and by URL parameters, and of batches of them."""

from inspect import getdoc
from typing import Annotated, Any, Final

from fastapi import APIRouter, Body, Query
from fastapi.routing import APIRoute

from mdr_service.api.documentation import GET_FAILURES, POST_FAILURES, RESULT
from mdr_service.api.query_route import QueryRoute, handler
from mdr_service.batch import BatchAnswer, BatchQuery
from mdr_service.content_negotiation import ResponseParameters
from mdr_service.queries import QUERIES, QueryType
from mdr_service.query_parameters import PARAMETERS
from mdr_service.schemas.examples import EXAMPLES

_BATCH: Final = """\
Compute each query as at its own endpoint, in the given order.

The status is 200 if the list itself is valid. Each entry has its own `status`, with the
`answer` or the `problem`, whose pointers are into its own `request`."""
_GET: Final = """\
Return the response of `POST` for numbers and at most one range.

A range `..._from`, `..._to` and `n` stands for a list of `n` numbers."""


# These functions declare endpoints for OpenAPI; `handler` handles the requests.


def _post(name: str, path: str, model: Any, **described: Any) -> APIRoute:
    content = Body(openapi_examples=EXAMPLES[name])

    async def endpoint(
        query: Annotated[model, content], form: Annotated[ResponseParameters, Query()]
    ) -> None: ...

    handle = handler(name, model)
    return QueryRoute(path, endpoint, handle, methods=["POST"], operation_id=name, **described)


def _get(kind: QueryType, model: Any) -> APIRoute:
    async def get(parameters: Annotated[model, Query()]) -> None: ...

    return QueryRoute(
        kind.path,
        get,
        handler(kind.name, model),
        methods=["GET"],
        operation_id=f"get_{kind.name}",
        tags=[kind.tag],
        summary=f"{kind.by_parameters} by parameters, for spreadsheets and browsers",
        description=_GET,
        response_model=kind.response,
        responses=GET_FAILURES | RESULT,
    )


router: Final = APIRouter(
    routes=[
        *(
            _post(
                kind.name,
                kind.path,
                kind.request,
                tags=[kind.tag],
                summary=kind.summary,
                description=getdoc(kind.solve),
                response_model=kind.response,
                responses=POST_FAILURES | RESULT,
            )
            for kind in QUERIES.values()
        ),
        _post(
            "batch",
            "/v1/batch",
            BatchQuery,
            tags=["batch"],
            summary="Queries of any kind, each with its own answer or problem",
            description=_BATCH,
            response_model=BatchAnswer,
            responses=POST_FAILURES,
        ),
        *(_get(QUERIES[name], model) for name, model in PARAMETERS.items()),
    ]
)
