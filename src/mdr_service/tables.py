"""Tables and curves in files, as their columns and lists."""

from typing import Any, Final

import numpy as np

from mdr_core import residuals
from mdr_core.table_headings import CURVE, PROFILE
from mdr_core.table_reader import parse
from mdr_service.serializers import write_json

KINDS: Final = {"profile": PROFILE, "curve": CURVE}
"""Quantities of the two columns of a kind of file."""
_LISTS: Final = {"profile": ("r", "f"), "curve": ("indentation_depth", "normal_force")}


def read(content: bytes, kind: str, columns: list[int] | None) -> bytes:
    """Return the response to a file, or raise InputError."""
    table = parse(content, KINDS[kind], columns)
    units = [each.unit or (None, None, None) for each in table.titles]
    result: dict[str, Any] = {
        "columns": [
            {"name": each.name, "unit": unit[1], "quantity": table.taken.get(i)}
            for i, (each, unit) in enumerate(zip(table.titles, units, strict=True))
        ],
        **dict(zip(_LISTS[kind], table.values, strict=True)),
        "units": [units[i][1] for i in table.taken],
        "scales": [units[i][2] for i in table.taken],
        "lines": table.lines,
        "notes": [
            f"Column {i + 1}, “{table.titles[i].name}”, is taken as the {quantity}."
            for i, quantity in table.taken.items()
        ],
    }
    if kind == "curve":
        result["segments"] = _segments(np.array(table.values[0]))
    return write_json(result)


def _segments(depth: np.ndarray) -> list[dict[str, Any]]:
    """Return the branches between the turning points of the depth."""
    signs = residuals.directions(depth)
    begins = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist()]
    return [
        {"kind": "loading" if signs[begin] > 0 else "unloading", "first": begin, "last": end - 1}
        for begin, end in zip(begins, [*begins[1:], depth.size], strict=True)
    ]
