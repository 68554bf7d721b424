"""Many queries in one request, each answered as it would be on its own."""

import logging
from collections.abc import Sequence
from typing import Final

from pydantic_core import to_json

from mdr_service import problems, questions, wire
from mdr_service.problems import ServiceError
from mdr_service.schemas.batch import BatchItem, BatchQuery
from mdr_service.schemas.queries import Query

# A query with the question that it asks, or the text of the entry that says why it is none.
Asked = tuple[str, Query] | bytes

_logger: Final = logging.getLogger(__name__)


def read(batch: BatchQuery) -> list[Asked]:
    """Return the queries of a batch; what is wrong with one of them is its own problem."""
    return [_read(item) for item in batch.queries]


def effort(asked: Sequence[Asked]) -> int:
    """Return what the answers cost together, as of `questions.effort`."""
    queries = [each[1] for each in asked if not isinstance(each, bytes)]
    return sum(questions.effort(query, wire.MEDIA_TYPE) for query in queries)


def answer(asked: Sequence[Asked]) -> bytes:
    """Return the text of all answers, in their order."""
    entries = [each if isinstance(each, bytes) else _entry(*each) for each in asked]
    return b'{"answers":[' + b",".join(entries) + b"]}"


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
