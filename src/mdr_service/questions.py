"""What may be asked, and the way from each question to its answer.

Nothing here knows of HTTP: the endpoints, a compute process and the command line ask alike, and
get the same bytes.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from mdr_service import arrays, documents, pictures, solve, table, wire, worn
from mdr_service.schemas.queries import (
    HistoryQuery,
    NormalQuery,
    Query,
    StressQuery,
    TangentialQuery,
)
from mdr_service.schemas.wear import EvolutionQuery, WearQuery


class Answer(NamedTuple):
    """What is sent: bytes, and what they are."""

    content: bytes
    media_type: str


@dataclass(frozen=True)
class Question:
    """One kind of query: its model, what solves it, and what writes down what was found."""

    model: type[Query]
    solve: Callable[..., Any]
    document: Callable[[Any, Any], dict[str, Any]]
    draw: Callable[[Any], bytes] | None = None

    @property
    def media_types(self) -> tuple[str, ...]:
        """The forms of its answer, the usual one first."""
        return (*_WRITERS, pictures.MEDIA_TYPE) if self.draw else tuple(_WRITERS)


_WRITERS: Final[Mapping[str, Callable[[Mapping[str, Any]], bytes]]] = {
    wire.MEDIA_TYPE: wire.write,
    table.MEDIA_TYPE: table.write,
    arrays.MEDIA_TYPE: arrays.write,
}

QUESTIONS: Final = {
    "normal": Question(NormalQuery, solve.normal, documents.normal),
    "tangential": Question(
        TangentialQuery, solve.tangential, documents.tangential, pictures.tangential
    ),
    "history": Question(HistoryQuery, solve.history, documents.history, pictures.history),
    "stress": Question(StressQuery, solve.stress, documents.stress, pictures.stress),
    "wear": Question(WearQuery, worn.limit, documents.wear, pictures.wear),
    "evolution": Question(EvolutionQuery, worn.evolution, documents.wear, pictures.evolution),
}


def answer(name: str, query: Query, media_type: str, **watched: Callable[[int], None]) -> Answer:
    """Return the answer to the question `name`, in one of its forms.

    What solves it may be `watched`, as of `worn.evolution`.
    """
    question = QUESTIONS[name]
    # What is not finite is looked for in the documents, once, instead of at every operation.
    with np.errstate(all="ignore"):
        found = question.solve(query, **watched)
        if question.draw and media_type == pictures.MEDIA_TYPE:
            return Answer(question.draw(found), media_type)
        document = question.document(query, found)
    return Answer(_WRITERS[media_type](document), media_type)
