"""Several queries of any kind in one request, and their answers."""

from typing import Any, Literal

from pydantic import Field

from mdr_service.schemas.answers import (
    Answer,
    EvolutionAnswer,
    HistoryAnswer,
    NormalAnswer,
    Problem,
    StressAnswer,
    TangentialAnswer,
    WearAnswer,
)
from mdr_service.schemas.quantities import Strict, drop_null_defaults
from mdr_service.schemas.queries import left_out
from mdr_service.settings import SETTINGS


class BatchItem(Strict):
    """One query of a batch."""

    ask: Literal["normal", "tangential", "history", "stress", "wear", "evolution"] = Field(
        description="Which query it is; `history` is that of `/v1/tangential/history`, "
        "`evolution` that of `/v1/wear/evolution`."
    )
    request: dict[str, Any] = Field(
        description="The request as it would be sent on its own: `NormalQuery` for `normal`, and "
        "so on."
    )


class BatchQuery(Strict):
    """Queries of any kind, each of which is answered on its own."""

    queries: list[BatchItem] = Field(
        description="The queries.", min_length=1, max_length=SETTINGS.max_batch
    )


class BatchItemAnswer(Answer, json_schema_extra=drop_null_defaults):
    """What became of one query: its answer, or else its problem."""

    status: int = Field(description="The HTTP status that it would have had on its own.")
    answer: (
        NormalAnswer
        | TangentialAnswer
        | HistoryAnswer
        | StressAnswer
        | WearAnswer
        | EvolutionAnswer
    ) = left_out("The answer that it would have had on its own.")
    problem: Problem = left_out(
        "Why there is none, as it would have been told; the pointers are into its own `request`."
    )


class BatchAnswer(Answer):
    """One entry per query, in their order."""

    answers: list[BatchItemAnswer] = Field(description="What became of each query.")
