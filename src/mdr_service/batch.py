"""Several queries in one request, and their responses."""

from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import BaseModel, Field, WithJsonSchema, WrapValidator

from mdr_service.queries import QUERIES
from mdr_service.schemas.answers import Answer, Problem
from mdr_service.schemas.quantities import ABSENT, Strict
from mdr_service.settings import SETTINGS


def _any_of(models: Iterable[type[BaseModel]]) -> WithJsonSchema:
    """Return the schema of an object of several models, each documented by its own endpoint."""
    references = [{"$ref": f"#/components/schemas/{model.__name__}"} for model in models]
    return WithJsonSchema({"anyOf": references})


# A request is validated with the model of its query, apart from the others.
_Request = Annotated[dict[str, Any], _any_of(kind.request for kind in QUERIES.values())]
_Answer = Annotated[dict[str, Any], _any_of(kind.response for kind in QUERIES.values())]


class BatchItem(Strict):
    """Query of a batch."""

    ask: Annotated[str, Field(json_schema_extra={"enum": [*QUERIES]})]
    """Name of the query, the end of its path; `fit` means `/v1/normal/fit`, and `tangential_fit`
    means `/v1/tangential/fit`."""
    request: _Request
    """Request of the query, as for its own endpoint: `NormalQuery` for `normal`, and so on."""


# Each entry is validated for its own response.
_Entry = Annotated[BatchItem, WrapValidator(lambda entry, _: entry)]


class BatchQuery(Strict):
    """Queries of any kind, each with its own response."""

    queries: Annotated[list[_Entry], Field(min_length=1, max_length=SETTINGS.max_batch)]
    """The queries."""


class BatchItemAnswer(Answer):
    """Response to one query: its result or its problem."""

    status: int
    """HTTP status that the query has at its own endpoint."""
    answer: _Answer = ABSENT
    """Response of the query at its own endpoint."""
    problem: Problem = ABSENT
    """Problem of the query at its own endpoint; pointers are into its own `request`."""


class BatchAnswer(Answer):
    """Responses to the queries, in the order of the request."""

    answers: list[BatchItemAnswer]
    """One entry for each query."""
