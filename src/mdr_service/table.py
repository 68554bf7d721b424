"""Answers as tables, for programs that read no JSON: one column per quantity."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import orjson

MEDIA_TYPE: Final = "text/csv"
# What an answer says as a whole, of its cycles or of its end, has no row.
_WHOLE: Final = frozenset({"method", "error_estimate", "warnings"}) | {
    "slip_fronts",
    "energy_per_cycle",
    "secant_stiffness",
}


# Over the radius the same for all loads.
_OF_NO_LOAD: Final = frozenset({"initial_profile"})


def write(document: Mapping[str, Any]) -> bytes:
    """Return the table of a document (RFC 4180), its numbers written as in the document.

    Infinities are written inf.
    """
    answers = {name: values for name, values in document.items() if name not in _WHOLE}
    if "radius" in answers:
        columns = _over_radii(answers)
    else:
        columns = {name: _cells(values) for name, values in answers.items()}
    rows = map(b",".join, zip(*columns.values(), strict=True))
    return b"\r\n".join([",".join(columns).encode(), *rows, b""])


def _over_radii(answers: dict[str, Any]) -> dict[str, list[bytes]]:
    """Return one cell per load, or number of cycles, and radius in each column.

    One load needs no index. What has no radius has no row here.
    """
    radius = _cells(answers["radius"])
    fields = {name: field for name, field in answers.items() if _has_radii(name, field)}
    loads = next((len(field) for name, field in fields.items() if name not in _OF_NO_LOAD), 1)
    columns = {"radius": radius * loads} | {
        name: _cells(field) * (loads if name in _OF_NO_LOAD else 1)
        for name, field in fields.items()
    }
    if loads == 1 and "cycles" not in answers:
        return columns
    name = "cycles" if "cycles" in answers else "load"
    indices = _cells(answers.get(name, range(loads)))
    return {name: [index for index in indices for _ in radius]} | columns


def _has_radii(name: str, values: Any) -> bool:
    return name in _OF_NO_LOAD or np.ndim(values[0]) == 1


def _cells(values: Any) -> list[bytes]:
    """Return the texts of values; of fields, row by row.

    Numbers are written all at once, which takes a tenth of the time that Python takes for each.
    """
    if isinstance(values[0], str):
        return [word.encode() for word in values]
    numbers = np.ravel(values)
    cells = orjson.dumps(numbers, option=orjson.OPT_SERIALIZE_NUMPY)[1:-1].split(b",")
    for index in np.flatnonzero(~np.isfinite(numbers)):
        cells[index] = repr(float(numbers[index])).encode()
    return cells
