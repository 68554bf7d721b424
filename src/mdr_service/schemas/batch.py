"""Several queries in one request, and their responses."""

from functools import cached_property
from typing import Any, Literal

from pydantic import Field, ValidationError

from mdr_service.schemas.answers import Answer, Problem
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.quantities import Strict, left_out
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.settings import SETTINGS


class BatchItem(Strict):
    """Query of a batch."""

    ask: Literal[
        "normal",
        "fit",
        "tangential",
        "history",
        "impact",
        "stress",
        "subsurface",
        "wear",
        "evolution",
    ] = Field(
        description="Name of the query, as its path ends: `fit` belongs to `/v1/normal`, `history` "
        "and `impact` to `/v1/tangential`, `evolution` to `/v1/wear`."
    )
    request: dict[str, Any] = Field(
        description="Request of the query, as for its own endpoint: `NormalQuery` for `normal`, "
        "and so on."
    )

    @cached_property
    def query(self) -> Query | ValidationError:
        """Query, or the reason why the request is invalid."""
        try:
            return SCHEMAS[self.ask].model.model_validate(self.request)
        except ValidationError as error:
            return error


class BatchQuery(Strict):
    """Queries of any kind, each with its own response."""

    queries: list[BatchItem] = Field(
        description="The queries.", min_length=1, max_length=SETTINGS.max_batch
    )


class BatchItemAnswer(Answer):
    """Response to one query: its answer or its problem."""

    status: int = Field(description="HTTP status that the query has at its own endpoint.")
    answer: dict[str, Any] = left_out("Response of the query at its own endpoint.")
    problem: Problem = left_out(
        "Problem of the query at its own endpoint; pointers are into its own `request`."
    )


class BatchAnswer(Answer):
    """Responses to the queries, in their order."""

    answers: list[BatchItemAnswer] = Field(description="One entry for each query.")
