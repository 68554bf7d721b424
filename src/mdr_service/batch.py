"""Several queries in one request, and their responses."""

from collections.abc import Callable
from functools import cached_property
from typing import Annotated, Any

from pydantic import Field, ValidationError, WrapValidator

from mdr_core.errors import InputError
from mdr_service.queries import QUERIES
from mdr_service.schemas.answers import Answer, Problem
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.quantities import Strict, left_out
from mdr_service.settings import SETTINGS


class BatchItem(Strict):
    """Query of a batch."""

    ask: str = Field(
        description="Name of the query, as its path ends: `fit` is that of `/v1/normal/fit`, "
        "`tangential_fit` of `/v1/tangential/fit`.",
        json_schema_extra={"enum": [*QUERIES]},
    )
    request: dict[str, Any] = Field(
        description="Request of the query, as for its own endpoint: `NormalQuery` for `normal`, "
        "and so on."
    )

    @cached_property
    def query(self) -> Query | ValidationError | InputError:
        """Query, or the reason why the request is invalid."""
        if self.ask not in QUERIES:
            return InputError((), f"there is no such query; there are {', '.join(QUERIES)}")
        try:
            return QUERIES[self.ask].request.model_validate(self.request)
        except ValidationError as error:
            return error


def _or_error(
    value: object, validate: Callable[[object], BatchItem]
) -> BatchItem | ValidationError:
    """Return the entry of a batch, or the reason why it is invalid, for its own response."""
    try:
        return validate(value)
    except ValidationError as error:
        return error


class BatchQuery(Strict):
    """Queries of any kind, each with its own response."""

    queries: list[Annotated[BatchItem, WrapValidator(_or_error)]] = Field(
        description="The queries.", min_length=1, max_length=SETTINGS.max_batch
    )

    @property
    def entries(self) -> list[BatchItem | ValidationError]:
        """The queries; an invalid entry is replaced by the reason why it is invalid."""
        return [*self.queries]


class BatchItemAnswer(Answer):
    """Response to one query: its result or its problem."""

    status: int = Field(description="HTTP status that the query has at its own endpoint.")
    answer: dict[str, Any] = left_out("Response of the query at its own endpoint.")
    problem: Problem = left_out(
        "Problem of the query at its own endpoint; pointers are into its own `request`."
    )


class BatchAnswer(Answer):
    """Responses to the queries, in the order of the request."""

    answers: list[BatchItemAnswer] = Field(description="One entry for each query.")
