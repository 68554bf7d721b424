"""Answers as tables, for programs that read no JSON: one column per quantity."""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from itertools import repeat
from typing import Any, Final

import numpy as np
from starlette.responses import Response

MEDIA_TYPE: Final = "text/csv"
# What an answer says as a whole, of its cycles or of its end, has no row.
_WHOLE: Final = frozenset({"method", "error_estimate", "warnings"}) | {
    "slip_fronts",
    "energy_per_cycle",
    "secant_stiffness",
}


def answer(document: Mapping[str, Any]) -> Response:
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
    return Response(text.getvalue(), media_type=MEDIA_TYPE)


def _over_radii(columns: dict[str, Any]) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
    """Return the header and one row per load and radius; one load needs no index."""
    radius = _numbers(columns.pop("radius"))
    fields = [_numbers(field) for field in columns.values()]
    header = ["radius", *columns]
    if len(fields[0]) == 1:
        return header, zip(radius, *(field[0] for field in fields), strict=True)
    rows = (
        row
        for load, lines in enumerate(zip(*fields, strict=True))
        for row in zip(repeat(load, len(radius)), radius, *lines, strict=True)
    )
    return ["load", *header], rows


def _numbers(values: Sequence[Any] | np.ndarray[Any, Any]) -> Sequence[Any]:
    # The numbers of NumPy would be written with the name of their type.
    return values.tolist() if isinstance(values, np.ndarray) else values
