"""Queries in the parameters of an address, for spreadsheets and browsers.

They are a short way to write a request: what they say is written as its text, and read and
answered like any other. What is wrong with it is told of the parameters.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final
from urllib.parse import parse_qsl

import numpy as np

from mdr_service import problems, wire
from mdr_service.parameters import KNOWN, Known, Parameter, RefusedError, number, whole
from mdr_service.settings import SETTINGS

Given = Mapping[str, str]

FORMAT: Final = "format"
# What goes with a range: how many numbers, and how they are spread.
COUNT: Final = "n"
SCALE: Final = "scale"
SCALES: Final[Mapping[str, Callable[[float, float, int], np.ndarray[Any, Any]]]] = {
    "linear": np.linspace,
    "log": np.geomspace,
}
_MOST_PARAMETERS: Final = 100
_UNKNOWN: Final = "there is no such parameter here"


def split(query_string: str) -> Given:
    """Return the parameters of an address by name, each of which occurs once.

    A plus is a plus, not a space: numbers have the one, and nothing here has the other.
    """
    text = query_string.replace("+", "%2B")
    try:
        pairs = parse_qsl(text, keep_blank_values=True, max_num_fields=_MOST_PARAMETERS)
    except ValueError:
        raise _failure(
            [RefusedError("", f"at most {_MOST_PARAMETERS} parameters are read")]
        ) from None
    given: dict[str, str] = {}
    repeated = []
    for name, value in pairs:
        if name in given:
            repeated.append(RefusedError(name, "is given twice"))
        given[name] = value
    if repeated:
        raise _failure(repeated)
    return given


def only_format(query_string: str) -> str | None:
    """Return the format that the address of a request with a body asks for, if it does."""
    given = split(query_string)
    if unknown := [RefusedError(name, _UNKNOWN) for name in given if name != FORMAT]:
        raise _failure(unknown)
    return given.get(FORMAT)


def request(question: str, given: Given) -> bytes:
    """Return the text of the request that the parameters stand for.

    Raises ServiceError with what is wrong with each of them.
    """
    known = KNOWN[question]
    ranged = [
        each for each in known.by_name.values() if each.ranges and given.keys() & {*each.ends}
    ]
    errors = [*_misplaced(known, ranged, given)]
    found: dict[str, object] = {}
    for name, parameter in known.by_name.items():
        try:
            if parameter in ranged:
                found[name] = _series(parameter, given)
            elif name in given:
                found[name] = parameter.read(name, given[name])
        except RefusedError as error:
            errors.append(error)
    if errors:
        raise _failure(errors)
    return wire.write(_document(known, found))


def pointed(failure: problems.ServiceError, question: str, given: Given) -> problems.ServiceError:
    """Return the failure of a request, pointing at the parameters that it was made from."""
    if not failure.errors:
        return failure
    errors = [(_pointer(where, question, given), detail) for where, detail in failure.errors]
    return problems.ServiceError(failure.kind, failure.detail, errors)


def _misplaced(known: Known, ranged: list[Parameter], given: Given) -> Iterator[RefusedError]:
    """Yield what is there but should not be."""
    ends = {end for each in known.by_name.values() if each.ranges for end in each.ends}
    names = {*known.by_name, *ends, COUNT, SCALE, FORMAT}
    yield from (RefusedError(name, _UNKNOWN) for name in given if name not in names)
    for each in ranged:
        if each.name in given:
            yield RefusedError(each.name, f"does not go with {' and '.join(each.ends)}")
    for each in ranged[1:]:
        end = next(end for end in each.ends if end in given)
        yield RefusedError(end, "one range can be asked for; POST takes any lists")
    if not ranged:
        yield from (
            RefusedError(name, "goes with a range") for name in (COUNT, SCALE) if name in given
        )


def _series(parameter: Parameter, given: Given) -> list[float]:
    """Return the numbers of a range, evenly or by equal ratios; both ends are among them."""
    for name in (*parameter.ends, COUNT):
        if name not in given:
            raise RefusedError(name, "is needed for a range")
    start, stop = (number(end, given[end]) for end in parameter.ends)
    most = SETTINGS.max_radii if parameter.name == "r" else SETTINGS.max_loads
    count = whole(COUNT, given[COUNT])
    if not 2 <= count <= most:
        raise RefusedError(COUNT, f"must be from 2 to {most}")
    scale = given.get(SCALE, "linear")
    if scale not in SCALES:
        raise RefusedError(SCALE, f"must be {' or '.join(SCALES)}")
    for end, value in zip(parameter.ends, (start, stop), strict=True):
        if scale == "log" and value <= 0:
            raise RefusedError(end, "must be greater than 0 on a logarithmic scale")
    # Between ends that no query takes numbers may overflow; they are refused with the ends.
    with np.errstate(all="ignore"):
        numbers: list[float] = SCALES[scale](start, stop, count).tolist()
    return numbers


def _document(known: Known, found: Mapping[str, object]) -> dict[str, Any]:
    document: dict[str, Any] = {group: {} for group in known.groups}
    for name, value in found.items():
        *way, last = known.by_name[name].path
        part = document
        for step in way:
            part = part.setdefault(step, {})
        part[last] = value
    material = document["material"]
    if "bodies" in material:
        material["bodies"] = [material["bodies"].get(which, "rigid") for which in "01"]
    return document


def _pointer(where: str, question: str, given: Given) -> str:
    """Return the pointer to the parameter that stands for a place in the request.

    For a part of the request that is to the first parameter of the part that is given, or could
    be; for an element of a range, to that of its ends which is at fault.
    """
    place = tuple(where.split("/")[1:])
    for name, parameter in KNOWN[question].by_name.items():
        inside = place[len(parameter.path) :]
        if place != parameter.path + inside:
            continue
        start, stop = parameter.ends
        if start in given:
            return f"/{start if inside in {(), ('0',)} else stop}"
        return f"/{name}"
    within = [
        name
        for name, parameter in KNOWN[question].by_name.items()
        if place and parameter.path[: len(place)] == place
    ]
    named = [name for name in within if name in given]
    return f"/{(named or within)[0]}" if within else ""


def _failure(errors: list[RefusedError]) -> problems.ServiceError:
    return problems.ServiceError(
        problems.INVALID_REQUEST,
        "some parameters of the address are not acceptable",
        [(problems.pointer([error.name]), error.detail) for error in errors],
    )
