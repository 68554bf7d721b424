"""Several queries in one request, and their responses."""

from typing import Annotated, Any

from pydantic import Field, WrapValidator

from mdr_service.queries import QUERIES
from mdr_service.schemas.answers import Answer, Problem
from mdr_service.schemas.quantities import Strict, left_out
from mdr_service.settings import SETTINGS


class BatchItem(Strict):
    """Query of a batch."""

    ask: str = Field(
        description="Name of the query, the end of its path; `fit` means `/v1/normal/fit`, and "
        "`tangential_fit` means `/v1/tangential/fit`.",
        json_schema_extra={"enum": [*QUERIES]},
    )
    request: dict[str, Any] = Field(
        description="Request of the query, as for its own endpoint: `NormalQuery` for `normal`, "
        "and so on."
    )


class BatchQuery(Strict):
    """Queries of any kind, each with its own response."""

    # Each entry is validated for its own response.
    queries: list[Annotated[BatchItem, WrapValidator(lambda entry, _: entry)]] = Field(
        description="The queries.", min_length=1, max_length=SETTINGS.max_batch
    )


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
