"""Results in other representations: GET, CSV, NumPy arrays and SVG."""

import csv
import io
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final
from urllib.parse import urlencode
from xml.etree import ElementTree as ET

import numpy as np

from tests.fuzz import laws


def _read_csv(result: Mapping[str, Any], content: bytes) -> Iterator[str]:
    rows = list(csv.DictReader(io.StringIO(content.decode(), newline="")))
    for name, expected in laws.numbers(result).items():
        if not rows or name not in rows[0]:
            continue
        column = np.array([float(row[name]) for row in rows])
        quantities = np.where(np.isnan(expected), np.inf, expected)
        has_rows = quantities.ndim > 1 or quantities.size == column.size
        if has_rows and not np.array_equal(np.abs(column), np.abs(np.ravel(quantities))):
            yield f"csv: {name} differs"


def _read_arrays(result: Mapping[str, Any], content: bytes) -> Iterator[str]:
    with np.load(io.BytesIO(content), allow_pickle=False) as archive:
        for name, expected in laws.numbers(result).items():
            quantities = np.where(np.isnan(expected), np.inf, expected)
            if not np.array_equal(np.abs(archive[name]), np.abs(quantities)):
                yield f"npz: {name} differs"


def _read_picture(_result: Mapping[str, Any], content: bytes) -> Iterator[str]:
    tree = ET.fromstring(content)  # noqa: S314 -- our own
    if not tree.tag.endswith("svg") or re.search(rb'[dxy]="[^"]*\b(nan|inf)\b', content):
        yield "svg: invalid document"


READERS: Final = {"csv": _read_csv, "npz": _read_arrays, "svg": _read_picture}


def get_parameters(name: str, body: Mapping[str, Any]) -> str:
    """Return the parameters of the equivalent GET request, or None if there is none."""
    if name in {"history", "evolution", "subsurface"} or "history" in body:
        return ""
    given: dict[str, Any] = {}
    for key, value in body.items():
        if key == "radius":
            given["r"] = value[0] if len(value) == 1 else value
        elif key == "quantities":
            given[key] = ",".join(value)
        elif key == "material" and "bodies" in value:
            for number, each in enumerate(value["bodies"], 1):
                if each != "rigid":
                    given |= {f"{field}_{number}": part for field, part in each.items()}
            given |= {key: part for key, part in value.items() if key != "bodies"}
        elif isinstance(value, Mapping):
            given |= value
        else:
            given[key] = value
    if any(isinstance(value, list | dict) for value in given.values()):
        return ""
    return urlencode(given)
