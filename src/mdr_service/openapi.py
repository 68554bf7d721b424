"""The OpenAPI document: the request models, the answers, and every failure."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from fastapi.openapi.utils import get_openapi
from pydantic import BaseModel
from pydantic.json_schema import models_json_schema
from starlette.routing import BaseRoute

from mdr_service import problems, wire
from mdr_service.problems import Kind
from mdr_service.schemas.answers import Catalogue, Health, NormalAnswer, Problem
from mdr_service.schemas.queries import NormalQuery

_REF: Final = "#/components/schemas/{model}"
_QUERIES: Final[Sequence[type[BaseModel]]] = (NormalQuery,)
_ANSWERS: Final[Sequence[type[BaseModel]]] = (NormalAnswer, Catalogue, Health, Problem)

_DESCRIPTION: Final = """\
Contact mechanics of axisymmetric bodies by the method of dimensionality reduction.

**Units.** Use one consistent system of your choice (N, m, Pa; or N, mm, MPa). Nothing is
converted; each field names its dimension in brackets, `[1]` for a plain number.

**Arrays.** Where a load is given it may be a number or a list; answers are always lists over the
loads. `null` stands for a true infinity only, and a warning with the code `singular` says where.

**Errors** are `application/problem+json` (RFC 9457); `errors` points into the request.
"""


def asks(model: type[BaseModel], examples: Mapping[str, Any]) -> dict[str, Any]:
    """Return the part of an operation that describes its request."""
    content = {"schema": _reference(model), "examples": examples}
    return {"requestBody": {"required": True, "content": {wire.MEDIA_TYPE: content}}}


def answers(model: type[BaseModel], failures: Iterable[Kind] = ()) -> dict[str, Any]:
    """Return the part of an operation that describes its answer and its failures."""
    responses: dict[str, Any] = {
        "200": {
            "description": "The answer",
            "content": {wire.MEDIA_TYPE: {"schema": _reference(model)}},
        }
    }
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
    described = get_openapi(title="MDR", version=version, description=_DESCRIPTION, routes=routes)
    _, definitions = models_json_schema(
        [(model, "validation") for model in (*_QUERIES, *_ANSWERS)], ref_template=_REF
    )
    described["components"] = {"schemas": definitions["$defs"]}
    return described


def _reference(model: type[BaseModel]) -> dict[str, str]:
    return {"$ref": _REF.format(model=model.__name__)}
