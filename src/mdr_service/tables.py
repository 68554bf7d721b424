"""Tables and curves in files, as their columns and lists."""

from typing import Any, Final

import numpy as np

from mdr_core import curve_segments
from mdr_core.profiles.table_points import axis_of
from mdr_core.table_headings import CURVE, PROFILE
from mdr_core.table_reader import ParsedFile, parse
from mdr_service.serializers import write_json

KINDS: Final = {"profile": PROFILE, "curve": CURVE}
"""Quantities of the two columns of a kind of file."""
_LISTS: Final = {"profile": ("r", "f"), "curve": ("indentation_depth", "normal_force")}


def read(content: bytes, kind: str, columns: list[int] | None) -> bytes:
    """Return the response to a file, or raise InputError."""
    table = parse(content, KINDS[kind], columns)
    quantities = {i: quantity for quantity, columns in table.taken.items() for i in columns}
    units = [each.unit or ("", None, None) for each in table.titles]
    written = [f"{unit}²" if measure == "area" else unit for measure, unit, _ in units]
    result: dict[str, Any] = {
        "columns": [
            {"name": each.name, "unit": written[i], "quantity": quantities.get(i)}
            for i, each in enumerate(table.titles)
        ],
        **dict(zip(_LISTS[kind], table.values, strict=True)),
        "units": [units[i][1] for i, *_ in table.taken.values()],
        "scales": [units[i][2] for i, *_ in table.taken.values()],
        "lines": table.lines,
        "notes": _notes(table),
    }
    if kind == "curve":
        result |= _in_time(table)
    else:
        result["axis"] = axis_of(*table.values)[0]
    return write_json(result)


def _notes(table: ParsedFile) -> list[str]:
    """Return which columns are taken, and what is done to their numbers."""
    done = {"area": ", with r = √(A/π)"}
    if table.is_reversed:
        done["depth"] = ", with its sign reversed: it falls towards the sample"
    names = [f", “{each.name}”," if each.name else "" for each in table.titles]
    return [
        f"Column {i + 1}{names[i]} is taken as the {quantity}{done.get(quantity, '')}."
        for quantity, columns in table.taken.items()
        for i in columns
    ]


def _in_time(table: ParsedFile) -> dict[str, Any]:
    """Return the times and segments of a curve, and the drift that a hold shows."""
    depth, force = table.values
    kinds = np.array(table.segments or curve_segments.phases(depth, force, table.time))
    result: dict[str, Any] = {
        "segments": [each._asdict() for each in curve_segments.segments(kinds)]
    }
    if table.time is None:
        return result
    drift = curve_segments.drift(depth, force, table.time, kinds)
    measured = {"drift_rate": [drift.rate], "drift_rate_error": [drift.error]} if drift else {}
    return result | {"time": table.time} | measured
