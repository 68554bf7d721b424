"""Endpoints of the queries, by POST and by URL parameters, and of batches of them."""

from inspect import getdoc
from typing import Annotated, Any, Final

from fastapi import APIRouter, Body, Query

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


def _post(name: str, path: str, model: Any, **described: Any) -> QueryRoute:
    content = Body(openapi_examples=EXAMPLES[name])

    async def endpoint(
        query: Annotated[model, content], form: Annotated[ResponseParameters, Query()]
    ) -> None: ...

    return QueryRoute(
        handler(name, model),
        path,
        endpoint,
        methods=["POST"],
        operation_id=name,
        **described,
    )


def _get(name: str, kind: QueryType, model: Any) -> QueryRoute:
    async def get(parameters: Annotated[model, Query()]) -> None: ...

    return QueryRoute(
        handler(name, model),
        kind.path,
        get,
        methods=["GET"],
        operation_id=f"get_{name}",
        summary=f"{kind.request.by_parameters} by parameters, for spreadsheets and browsers",
        description=_GET,
        **_documented(kind, GET_FAILURES),
    )


def _documented(kind: QueryType, failures: dict[int | str, dict[str, Any]]) -> dict[str, Any]:
    tag = "wear" if kind.path.startswith("/v1/wear") else "contact"
    return {"tags": [tag], "response_model": kind.response, "responses": failures | RESULT}


_of_batch: Final[dict[str, Any]] = {
    "tags": ["batch"],
    "summary": "Queries of any kind, each with its own answer or problem",
    "description": _BATCH,
    "response_model": BatchAnswer,
    "responses": POST_FAILURES,
}
router: Final = APIRouter(
    routes=[
        *(
            _post(
                name,
                kind.path,
                kind.request,
                summary=kind.summary,
                description=getdoc(kind.solve),
                **_documented(kind, POST_FAILURES),
            )
            for name, kind in QUERIES.items()
        ),
        _post("batch", "/v1/batch", BatchQuery, **_of_batch),
        *(_get(name, QUERIES[name], model) for name, model in PARAMETERS.items()),
    ]
)
