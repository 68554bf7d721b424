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

from mdr_service import address, arrays, forms, problems, wire
from mdr_service.parameters import KNOWN, Parameter
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
from mdr_service.schemas.batch import BatchAnswer, BatchQuery
from mdr_service.schemas.queries import HistoryQuery, NormalQuery, StressQuery, TangentialQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery
from mdr_service.settings import SETTINGS, Settings

_REF: Final = "#/components/schemas/{model}"
_QUERIES: Final[Sequence[type[BaseModel]]] = (
    NormalQuery,
    TangentialQuery,
    HistoryQuery,
    StressQuery,
    WearQuery,
    EvolutionQuery,
    BatchQuery,
)
_ANSWERS: Final[Sequence[type[BaseModel]]] = (
    NormalAnswer,
    TangentialAnswer,
    HistoryAnswer,
    StressAnswer,
    WearAnswer,
    EvolutionAnswer,
    BatchAnswer,
    Catalogue,
    Health,
    Settings,
    Problem,
)
_NO_OTHERS: Final[Mapping[str, str]] = MappingProxyType({})

_TEXT: Final[Mapping[str, str]] = MappingProxyType({"type": "string"})
_BINARY: Final[Mapping[str, str]] = MappingProxyType({"contentMediaType": arrays.MEDIA_TYPE})
_OF_RANGES: Final[Mapping[str, Mapping[str, Any]]] = {
    address.COUNT: {
        "type": "integer",
        "minimum": 2,
        "maximum": max(SETTINGS.max_loads, SETTINGS.max_radii),
        "description": "How many values a range has, both ends among them",
    },
    address.SCALE: {
        "type": "string",
        "enum": list(address.SCALES),
        "default": next(iter(address.SCALES)),
        "description": "Whether a range goes evenly or by equal ratios",
    },
}

_DESCRIPTION: Final = """\
Contact mechanics of axisymmetric bodies by the method of dimensionality reduction.

**Units.** Use one consistent system of your choice (N, m, Pa; or N, mm, MPa). Nothing is
converted; each field names its dimension in brackets, `[1]` for a plain number.

**Arrays.** Where a load is given it may be a number or a list; answers are always lists over the
loads. `null` stands for a true infinity only, and a warning with the code `singular` says where
(of wear without an end, one with the code `endless_wear`).

**Forms.** `?format=` or the header `Accept` asks for JSON (the default); `csv`, a table with a
column per quantity, where infinities are written `inf`; `npz`, an archive of arrays for
`numpy.load`; or `svg`, a picture, where there is one.

**Addresses.** `GET` asks the same of the four queries by parameters: numbers, and one range, for
spreadsheets and browsers.

**Errors** are `application/problem+json` (RFC 9457); `errors` points into the request.
"""


def asks(model: type[BaseModel], examples: Mapping[str, Any]) -> dict[str, Any]:
    """Return the part of an operation that describes its request."""
    content = {"schema": _reference(model), "examples": examples}
    return {"requestBody": {"required": True, "content": {wire.MEDIA_TYPE: content}}}


def parameters(question: str, example: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the descriptions of the parameters of a question, filled in with the `example`."""
    known = [each for one in KNOWN[question].by_name.values() for each in _described(one)]
    known += [_parameter(name, schema) for name, schema in _OF_RANGES.items()]
    return [
        each | ({"example": example[each["name"]]} if each["name"] in example else {})
        for each in known
    ]


def format_parameter(offered: Sequence[str]) -> dict[str, Any]:
    """Return the description of the parameter that names the form of the answer."""
    meaning = "The form of the answer; without it the header `Accept` says which"
    schema = {"type": "string", "enum": forms.names(offered), "description": meaning}
    return _parameter(address.FORMAT, schema)


def answers(
    model: type[BaseModel], failures: Iterable[Kind] = (), others: Mapping[str, str] = _NO_OTHERS
) -> dict[str, Any]:
    """Return the part of an operation that describes its answer and its failures.

    `others` are the forms of the answer besides JSON: their media types, and what they hold.
    """
    content: dict[str, Any] = {wire.MEDIA_TYPE: {"schema": _reference(model)}}
    for media_type, meaning in others.items():
        schema = _BINARY if media_type == arrays.MEDIA_TYPE else _TEXT
        content[media_type] = {"schema": {**schema, "description": meaning}}
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


def answers_text(meaning: str) -> dict[str, Any]:
    """Return what describes an operation that answers plain text."""
    described = answers(Health)
    content = {"text/plain": {"schema": {**_TEXT, "description": meaning}}}
    described["responses"]["200"]["content"] = content
    return described


def _described(parameter: Parameter) -> list[dict[str, Any]]:
    """Return a parameter, and those of the ends of its range."""
    found = [_parameter(parameter.name, parameter.schema)]
    if parameter.ranges:
        for end, which in zip(parameter.ends, ("first", "last"), strict=True):
            meaning = f"The {which} of `n` values of `{parameter.name}`, in its place"
            found.append(_parameter(end, {**parameter.schema, "description": meaning}))
    return found


def _parameter(name: str, schema: Mapping[str, Any]) -> dict[str, Any]:
    bare = {key: value for key, value in schema.items() if key != "description"}
    return {"name": name, "in": "query", "description": schema["description"], "schema": bare}


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
