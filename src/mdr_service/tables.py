"""Tables and curves in files, as their columns and lists."""

from typing import Any, Final

import numpy as np

from mdr_core import residuals
from mdr_core.table_reader import CURVE, PROFILE, parse
from mdr_service.serializers import write_json

KINDS: Final = {"profile": PROFILE, "curve": CURVE}
"""Quantities of the two columns of a kind of file."""
_LISTS: Final = {"profile": ("r", "f"), "curve": ("indentation_depth", "normal_force")}


def read(content: bytes, kind: str) -> bytes:
    """Return the response to a file, or raise InputError."""
    table = parse(content, KINDS[kind])
    result: dict[str, Any] = {
        "columns": [
            {"name": each.name, "unit": each.unit, "quantity": each.quantity or None}
            for each in table.columns
        ],
        **dict(zip(_LISTS[kind], table.values, strict=True)),
        "units": [each.unit for each in table.taken],
        "scales": [each.scale for each in table.taken],
        "lines": table.lines,
        "notes": list(table.notes),
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
