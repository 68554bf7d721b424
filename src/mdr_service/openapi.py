"""The OpenAPI document: the request models, the answers, and every failure."""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from types import MappingProxyType
from typing import Any, Final

from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute
from pydantic import BaseModel
from pydantic.json_schema import models_json_schema
from starlette.routing import BaseRoute

from mdr_service import problems, wire
from mdr_service.problems import Kind
from mdr_service.schemas.answers import (
    Catalogue,
    EvolutionAnswer,
    Health,
    HistoryAnswer,
    NormalAnswer,
    Problem,
    StressAnswer,
    TangentialAnswer,
    WearAnswer,
)
from mdr_service.schemas.queries import HistoryQuery, NormalQuery, StressQuery, TangentialQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

_REF: Final = "#/components/schemas/{model}"
_QUERIES: Final[Sequence[type[BaseModel]]] = (
    NormalQuery,
    TangentialQuery,
    HistoryQuery,
    StressQuery,
    WearQuery,
    EvolutionQuery,
)
_ANSWERS: Final[Sequence[type[BaseModel]]] = (
    NormalAnswer,
    TangentialAnswer,
    HistoryAnswer,
    StressAnswer,
    WearAnswer,
    EvolutionAnswer,
    Catalogue,
    Health,
    Problem,
)
_NO_OTHERS: Final[Mapping[str, str]] = MappingProxyType({})

_DESCRIPTION: Final = """\
Contact mechanics of axisymmetric bodies by the method of dimensionality reduction.

**Units.** Use one consistent system of your choice (N, m, Pa; or N, mm, MPa). Nothing is
converted; each field names its dimension in brackets, `[1]` for a plain number.

**Arrays.** Where a load is given it may be a number or a list; answers are always lists over the
loads. `null` stands for a true infinity only, and a warning with the code `singular` says where
(of wear without an end, one with the code `endless_wear`).

**Forms.** `Accept: text/csv` asks for a table with a column per quantity, where infinities are
written `inf`; `Accept: image/svg+xml` for a picture, where there is one. JSON is the default.

**Errors** are `application/problem+json` (RFC 9457); `errors` points into the request.
"""


def asks(model: type[BaseModel], examples: Mapping[str, Any]) -> dict[str, Any]:
    """Return the part of an operation that describes its request."""
    content = {"schema": _reference(model), "examples": examples}
    return {"requestBody": {"required": True, "content": {wire.MEDIA_TYPE: content}}}


def answers(
    model: type[BaseModel], failures: Iterable[Kind] = (), others: Mapping[str, str] = _NO_OTHERS
) -> dict[str, Any]:
    """Return the part of an operation that describes its answer and its failures.

    `others` are the forms of the answer besides JSON: their media types, and what they hold.
    """
    content: dict[str, Any] = {wire.MEDIA_TYPE: {"schema": _reference(model)}}
    for media_type, meaning in others.items():
        content[media_type] = {"schema": {"type": "string", "description": meaning}}
    responses: dict[str, Any] = {"200": {"description": "The answer", "content": content}}
    by_status: dict[int, list[str]] = {}
    for kind in (*failures, problems.INTERNAL):
        by_status.setdefault(kind.status, []).append(f"`{kind.type}`: {kind.title}")
    for status, meanings in by_status.items():
        responses[str(status)] = {
            "description": "\n".join(meanings),
            "content": {problems.MEDIA_TYPE: {"schema": _reference(Problem)}},
        }
    return {"responses": responses}


def document(version: str, routes: Sequence[BaseRoute]) -> dict[str, Any]:
    """Return the whole document of these `routes`.

    Bodies are read and written by hand, for speed, so that their models are added here.
    """
    shown = [_shown(route) for route in routes]
    described = get_openapi(title="MDR", version=version, description=_DESCRIPTION, routes=shown)
    _, definitions = models_json_schema(
        [(model, "validation") for model in (*_QUERIES, *_ANSWERS)], ref_template=_REF
    )
    described["components"] = {"schemas": definitions["$defs"]}
    return described


def _shown(route: BaseRoute) -> BaseRoute:
    """Return the route as it is described: HEAD goes with GET and says nothing of its own."""
    if not isinstance(route, APIRoute) or not route.methods:
        return route
    described = copy(route)
    described.methods = route.methods - {"HEAD"}
    return described


def _reference(model: type[BaseModel]) -> dict[str, str]:
    return {"$ref": _REF.format(model=model.__name__)}
