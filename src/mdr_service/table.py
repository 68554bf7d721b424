"""Answers as tables, for programs that read no JSON: one column per quantity."""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from itertools import repeat
from typing import Any, Final

import numpy as np

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
    """Return the table of a document; numbers keep all digits, infinities are written inf."""
    columns = {name: values for name, values in document.items() if name not in _WHOLE}
    text = io.StringIO()
    writer = csv.writer(text)
    if "radius" in columns:
        header, rows = _over_radii(columns)
    else:
        header, rows = [*columns], zip(*map(_numbers, columns.values()), strict=True)
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue().encode()


def _over_radii(columns: dict[str, Any]) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
    """Return the header and one row per load, or number of cycles, and radius.

    One load needs no index. What has no radius has no row here.
    """
    radius = _numbers(columns["radius"])
    fields = {name: _numbers(field) for name, field in columns.items() if _has_radii(name, field)}
    loads = next((len(field) for name, field in fields.items() if name not in _OF_NO_LOAD), 1)
    lines = [
        repeat(field, loads) if name in _OF_NO_LOAD else field for name, field in fields.items()
    ]
    header = ["radius", *fields]
    if loads == 1 and "cycles" not in columns:
        return header, zip(radius, *(next(iter(line)) for line in lines), strict=True)
    name = "cycles" if "cycles" in columns else "load"
    indices = _numbers(columns.get(name, range(loads)))
    rows = (
        row
        for index, *line in zip(indices, *lines, strict=True)
        for row in zip(repeat(index, len(radius)), radius, *line, strict=True)
    )
    return [name, *header], rows


def _has_radii(name: str, values: Any) -> bool:
    return name in _OF_NO_LOAD or np.ndim(values[0]) == 1


def _numbers(values: Sequence[Any] | np.ndarray[Any, Any]) -> Sequence[Any]:
    # The numbers of NumPy would be written with the name of their type.
    return values.tolist() if isinstance(values, np.ndarray) else values
