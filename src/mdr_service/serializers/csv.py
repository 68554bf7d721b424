"""CSV: one column per quantity, one row per load (and radius), sample or number of cycles.

Plain text has the same cells without the heading, so that a single value is a bare number.
"""

from collections.abc import Mapping
from itertools import zip_longest
from math import prod
from typing import Any, Final

import numpy as np
import orjson

MEDIA_TYPE: Final = "text/csv"
PLAIN_TEXT: Final = "text/plain"
# Lists of objects and of keys of the literature.
_LISTS: Final = frozenset({"warnings", "holds_while", "sources"})
# Lists over the cycles of a history, or at its end: their entries belong to no row.
_NOT_IN_ROWS: Final = frozenset(
    {*_LISTS, "slip_fronts", "energy_per_cycle", "secant_stiffness", "correlation"}
)
# Given over the radius only, and repeated for each load.
_BY_RADIUS: Final = frozenset({"initial_profile"})


def write(result: Mapping[str, Any]) -> bytes:
    """Return the table of a result (RFC 4180); infinities are written ``inf``."""
    lists = {name: v for name, v in result.items() if isinstance(v, list | np.ndarray)}
    values = {name: v for name, v in lists.items() if name not in _NOT_IN_ROWS}
    if not values:
        # None of the chosen members has rows: each is a column of its own length.
        values = {
            name: np.atleast_1d(value)
            for name, value in result.items()
            if name not in _LISTS and not isinstance(value, Mapping)
        }
    if "radius" in values:
        columns = _by_position(values, "radius")
    elif "x" in values:
        columns = _by_position(values, "z", "x")
    else:
        columns = {name: _cells(value) for name, value in values.items()}
    rows = map(b",".join, zip_longest(*columns.values(), fillvalue=b""))
    return b"\r\n".join([",".join(columns).encode(), *rows, b""])


def write_cells(result: Mapping[str, Any]) -> bytes:
    """Return one line per row, its cells separated by commas, without a line end after the last."""
    _, *rows, _ = write(result).split(b"\r\n")
    return b"\n".join(rows)


def _by_position(values: dict[str, Any], *axes: str) -> dict[str, list[bytes]]:
    """Return one cell per load, or number of cycles, and position in each column.

    A single load has no index column. Members without a position have no column.
    """
    fields = {
        name: np.array(_cells(value), dtype=object)
        for name, value in values.items()
        if name in _BY_RADIUS or np.ndim(value[0]) == len(axes)
    }
    positions = [np.array(_cells(values[axis]), dtype=object) for axis in axes]
    shape = [each.size for each in positions]
    loads = max((field.size // prod(shape) for field in fields.values()), default=1)
    rows = "cycles" if "cycles" in values else "load"
    indices = np.array(_cells(values.get(rows, range(loads))), dtype=object)
    columns = dict(zip((rows, *axes), np.ix_(indices, *positions), strict=True))
    if rows == "load" and loads == 1:
        del columns["load"]
    columns |= {name: field.reshape(-1, *shape) for name, field in fields.items()}
    whole = (indices.size, *shape)
    return {name: np.broadcast_to(cells, whole).ravel().tolist() for name, cells in columns.items()}


def _cells(values: Any) -> list[bytes]:
    """Return the texts of values, row by row."""
    if isinstance(values[0], str):
        return [word.encode() for word in values]
    numbers = np.ravel(values)
    # Written at once: a tenth of the time of a call for each number.
    cells = orjson.dumps(numbers, option=orjson.OPT_SERIALIZE_NUMPY)[1:-1].split(b",")
    for index in np.flatnonzero(~np.isfinite(numbers)):
        cells[index] = repr(float(numbers[index])).encode()
    return cells
