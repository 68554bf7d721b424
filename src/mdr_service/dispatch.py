"""Response content of a query: parse, compute, serialize.

Endpoints, compute processes and the command line call these functions, and get identical bytes.
"""

import logging
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from pydantic import ValidationError

from mdr_core.errors import InputError
from mdr_service import problems
from mdr_service.batch import BatchItem, BatchQuery
from mdr_service.problems import ServiceError
from mdr_service.queries import QUERIES
from mdr_service.query_parameters import PARAMETERS
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.profiles import SeriesProfile
from mdr_service.serializers import JSON, PICTURES, WRITE, write_json
from mdr_service.serializers.picture import AS_USUAL, Appearance
from mdr_service.settings import SETTINGS

_Entry = tuple[str, Query] | ServiceError
"""Name of the query in an entry of a batch and the query, or the reason why it is invalid."""
_logger: Final = logging.getLogger(__name__)
# Maximum number of values in the response to a query that runs on the event loop; each load has
# about ten; a series has as many for each of its terms, and two spheres for each sphere. Fields at
# a thousand radii just meet the limit, and take a millisecond or two.
_MAX_NUMBERS_ON_LOOP, _PER_LOAD = 1_100, 10


def is_short(query: Query) -> bool:
    """Return True if a query runs on the event loop, where it delays all other requests.

    Any other query runs in a compute process, for at most `budget_seconds`.
    """
    is_slow = (
        query.is_long
        or query.profile.kind == "tabulated"
        or query.material.model_fields_set & {"yield_strength", "work_of_adhesion", "layer"}
        or any(each.control == "maximum_pressure" for each in query.controls.values())
    )
    size = query.numbers + _PER_LOAD * (query.path.samples if query.path else query.loads)
    if isinstance(query.profile, SeriesProfile):
        size *= len(query.profile.terms)
    elif query.profile.kind == "two_spheres":
        size *= 2
    return not is_slow and size <= _MAX_NUMBERS_ON_LOOP


def respond(
    name: str,
    query: Query | BatchQuery | bytes | dict[str, str],
    media_type: str,
    appearance: Appearance = AS_USUAL,
    members: Sequence[str] = (),
) -> bytes:
    """Return the response content of a query or a batch.

    Parameters
    ----------
    name : name of the query, a key of `QUERIES`, or ``batch``.
    query : the request, or its text or parameters, which are parsed first.
    media_type : media type of the content.
    appearance : size and units of a picture.
    members : members of the result to return, by default all; a picture shows all.

    Raises
    ------
    InputError, AccuracyError, ServiceError, ValidationError : the query has no result.
    """
    if isinstance(query, bytes):
        model: type[Query | BatchQuery] = BatchQuery if name == "batch" else QUERIES[name].request
        query = model.model_validate_json(query)
    elif isinstance(query, dict):
        query = PARAMETERS[name].model_validate(query).query()
    if isinstance(query, BatchQuery):
        entries = [_parsed(each) for each in query.queries]
        _require_few_numbers(entries)
        return b'{"answers":[' + b",".join(map(_entry, entries)) + b"]}"
    # The members are selected last, because complete results are checked for overflow.
    with np.errstate(all="ignore"):
        kind = QUERIES[name]
        source = kind.solve(query)
        result: Any = kind.result(query, source)
        if media_type in PICTURES:
            return WRITE[media_type](query, result, appearance)
        if not result.keys() >= set(members):
            detail = f"there is no such member; there are {', '.join(result)}"
            raise InputError(("answers",), detail)
        result = {member: result[member] for member in members or result}
    return WRITE[media_type](result)


def _parsed(entry: object) -> _Entry:
    try:
        item = BatchItem.model_validate(entry)
        if item.ask in QUERIES:
            return item.ask, QUERIES[item.ask].request.model_validate(item.request)
    except ValidationError as error:
        return problems.from_validation(error)
    return problems.invalid([("/ask", f"there is no such query; there are {', '.join(QUERIES)}")])


def _require_few_numbers(entries: list[_Entry]) -> None:
    """Raise ServiceError if the responses together exceed the limit of numbers in one response."""
    numbers, most = 0, SETTINGS.max_numbers
    for index, entry in enumerate(entries):
        if not isinstance(entry, ServiceError):
            own = max(entry[1].loads, entry[1].numbers)
            # A query that exceeds the limit by itself is rejected by itself.
            numbers += own if own <= most else 0
        if numbers > most:
            detail = f"the responses must not hold more than {most} numbers in total"
            place = problems.pointer(("queries", index))
            raise problems.invalid([(place, detail)])


def _entry(entry: _Entry) -> bytes:
    if isinstance(entry, ServiceError):
        return _problem(entry)
    try:
        content = respond(*entry, JSON)
    except problems.FAILURES as error:
        return _problem(problems.to_problem(error))
    except Exception:
        _logger.exception("internal error in an entry of a batch")
        return _problem(problems.INTERNAL_ERROR)
    return b'{"status":200,"answer":' + content + b"}"


def _problem(error: ServiceError) -> bytes:
    return write_json({"status": error.type.status, "problem": problems.document(error)})
