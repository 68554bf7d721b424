"""Many queries in one request, each answered as it would be on its own."""

import itertools
import logging
from bisect import bisect
from collections.abc import Sequence
from typing import Final

from pydantic_core import to_json

from mdr_service import cost, problems, questions, sizes, wire
from mdr_service.problems import ServiceError
from mdr_service.schemas.batch import BatchItem, BatchQuery
from mdr_service.schemas.queries import Query
from mdr_service.settings import SETTINGS

# A query with the question that it asks, or the text of the entry that says why it is none.
Asked = tuple[str, Query] | bytes

_logger: Final = logging.getLogger(__name__)


def read(batch: BatchQuery) -> list[Asked]:
    """Return the queries of a batch; what is wrong with one of them is its own problem.

    Raises ServiceError where they ask together for more numbers than one request may.
    """
    asked = [_read(item) for item in batch.queries]
    numbers = 0
    for index, each in enumerate(asked):
        own = 0 if isinstance(each, bytes) else _numbers(*each)
        # What is too much alone is refused alone.
        numbers += own if own <= SETTINGS.max_numbers else 0
        if numbers > SETTINGS.max_numbers:
            detail = f"at most {SETTINGS.max_numbers} loads times radii are answered at once"
            place = problems.pointer(("queries", index))
            raise ServiceError(problems.INVALID_REQUEST, detail, [(place, detail)])
    return asked


def priced(asked: Sequence[Asked], most: float, slowness: float) -> tuple[list[Asked], float]:
    """Return the queries, of which none takes more than `most` seconds, and what they take.

    Raises ServiceError where that is too much for all of them together.
    """
    found = [_priced(each, most, slowness) for each in asked]
    together = list(itertools.accumulate(seconds for _, seconds in found))
    if together[-1] > most:
        fitting = bisect(together, most)
        told = [(f"/queries/{fitting}", f"the first {fitting} queries would fit")]
        raise cost.beyond(together[-1] * slowness, most * slowness, told)
    return [each for each, _ in found], together[-1]


def answer(asked: Sequence[Asked]) -> bytes:
    """Return the text of all answers, in their order."""
    entries = [each if isinstance(each, bytes) else _entry(*each) for each in asked]
    return b'{"answers":[' + b",".join(entries) + b"]}"


def _priced(asked: Asked, most: float, slowness: float) -> tuple[Asked, float]:
    """Return the query and its seconds, or the text of its refusal if it alone is too much."""
    if isinstance(asked, bytes):
        return asked, 0.0
    seconds = cost.seconds(*asked, wire.MEDIA_TYPE)
    if seconds <= most:
        return asked, seconds
    return _problem(cost.too_costly(*asked, wire.MEDIA_TYPE, most, slowness)), 0.0


def _numbers(question: str, query: Query) -> int:
    """Return how many loads, or numbers of cycles, times radii, or else samples it is about."""
    found = sizes.of(question, query, wire.MEDIA_TYPE)
    return max(found.loads * max(found.radii, 1), found.samples)


def _read(item: BatchItem) -> Asked:
    # Read from a text like a request on its own, so that it is refused in the same words.
    text = to_json(item.request, inf_nan_mode="constants")
    try:
        return item.ask, wire.read(questions.QUESTIONS[item.ask].model, text)
    except ServiceError as error:
        return _problem(error)


def _entry(name: str, query: Query) -> bytes:
    try:
        found = questions.answer(name, query, wire.MEDIA_TYPE)
    except problems.FAILURES as error:
        return _problem(problems.told(error))
    except Exception:
        _logger.exception("a defect, told in its place in a batch")
        return _problem(problems.DEFECT)
    return b'{"status":200,"answer":' + found.content + b"}"


def _problem(error: ServiceError) -> bytes:
    return wire.write({"status": error.kind.status, "problem": problems.document(error)})
