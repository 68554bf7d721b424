"""What the documentation says of each query, by body and by address."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from mdr_service import arrays, openapi, pictures, problems, table
from mdr_service.questions import QUESTIONS
from mdr_service.schemas import answers, batch, examples

_WORK_FAILURES: Final = (
    problems.TOO_COSTLY,
    problems.BUSY,
    problems.LOST,
    problems.TIME_EXCEEDED,
)
_ADDRESS_FAILURES: Final = (
    problems.NOT_ACCEPTABLE,
    problems.INVALID_REQUEST,
    *_WORK_FAILURES,
    problems.ACCURACY,
)
_BODY_FAILURES: Final = (
    problems.MALFORMED_JSON,
    problems.BODY_TOO_SLOW,
    problems.BODY_TOO_LARGE,
    problems.UNSUPPORTED_MEDIA_TYPE,
)
_PER_LOAD: Final = "One column per list, one row per load."
_ARRAYS: Final = "An archive for `numpy.load`: one array per name of the JSON answer."


@dataclass(frozen=True)
class Described:
    """A query: its answer, its examples, and what its answer is in other forms."""

    name: str
    answer: type[answers.Known]
    examples: Mapping[str, Any]
    rows: str = _PER_LOAD
    """What is in a table."""
    picture: str | None = None
    in_address: Mapping[str, Any] | None = None
    """An example in parameters, where the query may be asked so."""

    @property
    def by_body(self) -> dict[str, Any]:
        """What describes the operation that takes a body."""
        return (
            openapi.asks(QUESTIONS[self.name].model, self.examples)
            | openapi.answers(self.answer, (*_BODY_FAILURES, *_ADDRESS_FAILURES), self._others)
            | {"parameters": [self._format]}
        )

    @property
    def by_address(self) -> dict[str, Any]:
        """What describes the operation that takes parameters."""
        parameters = openapi.parameters(self.name, self.in_address or {})
        described = openapi.answers(self.answer, _ADDRESS_FAILURES, self._others)
        described["responses"]["304"] = {"description": "The answer that `If-None-Match` names"}
        return described | {"parameters": [*parameters, self._format]}

    @property
    def _others(self) -> dict[str, str]:
        written = {table.MEDIA_TYPE: self.rows, arrays.MEDIA_TYPE: _ARRAYS}
        return written | ({pictures.MEDIA_TYPE: self.picture} if self.picture else {})

    @property
    def _format(self) -> dict[str, Any]:
        return openapi.format_parameter(QUESTIONS[self.name].media_types)


QUERIES: Final = {
    each.name: each
    for each in (
        Described(
            "normal",
            answers.NormalAnswer,
            examples.NORMAL_EXAMPLES,
            in_address=examples.NORMAL_IN_ADDRESS,
        ),
        Described(
            "tangential",
            answers.TangentialAnswer,
            examples.TANGENTIAL_EXAMPLES,
            picture="Force over displacement up to full slip, first normal load.",
            in_address=examples.TANGENTIAL_IN_ADDRESS,
        ),
        Described(
            "history",
            answers.HistoryAnswer,
            examples.HISTORY_EXAMPLES,
            rows="One column per list over the samples, one row per sample.",
            picture="Force over displacement, with the points that were given.",
        ),
        Described(
            "stress",
            answers.StressAnswer,
            examples.STRESS_EXAMPLES,
            rows="One column per field, one row per radius; with several loads the index of the "
            "load in a first column, and one row per load and radius.",
            picture="The fields over the radius, with a, c and the breaks b marked.",
            in_address=examples.STRESS_IN_ADDRESS,
        ),
        Described(
            "wear",
            answers.WearAnswer,
            examples.WEAR_EXAMPLES,
            rows="Without radii one column per list, one row per load; with them one column per "
            "field, one row per radius, and with several loads the index of the load in a first "
            "column, and one row per load and radius.",
            picture="The profile before and in the limit, with c and ã marked.",
            in_address=examples.WEAR_IN_ADDRESS,
        ),
        Described(
            "evolution",
            answers.EvolutionAnswer,
            examples.EVOLUTION_EXAMPLES,
            rows="Without radii one column per list, one row per number of cycles; with them the "
            "cycles, the radius, and one column per field.",
            picture="Profiles and pressures over the cycles, with the limiting profile where "
            "there is one.",
        ),
    )
}

BATCH: Final = openapi.asks(batch.BatchQuery, examples.BATCH_EXAMPLES) | openapi.answers(
    batch.BatchAnswer,
    (*_BODY_FAILURES, problems.NOT_ACCEPTABLE, problems.INVALID_REQUEST, *_WORK_FAILURES),
)
