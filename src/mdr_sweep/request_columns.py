"""Columns of a table as fields of requests, by dotted names such as ``load.normal_force``."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import inf, isnan
from typing import Any, Final, TypeAlias

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from mdr_service.queries import QUERIES
from mdr_service.schemas.flat import Schema, leaves
from mdr_service.schemas.quantities import SMALLEST
from mdr_sweep.spec import Spec

Rows = NDArray[np.intp]
Values = NDArray[np.float64]
Cells: TypeAlias = "pa.Array[Any]"
# Decimal numbers, which Arrow converts to the nearest double.
_NUMBER: Final = r"^-?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$"
# Members of a list are named by their index; `#` stands for any of them.
_INDEX: Final = re.compile(r"(?<=\.)(0|[1-9][0-9]*)(?=\.|$)")
# Fields that belong to results over the radius, which no sweep computes.
_OVER_RADIUS: Final = frozenset({"radius", "points", "quantities.#"})


@dataclass(frozen=True)
class Column:
    """A field of all cases of a batch."""

    schema: Schema
    cells: Cells
    given: NDArray[np.bool_]
    """False where the cell is empty, so that the field is absent from the request."""
    values: Values
    """Numbers; NaN where the cell is empty or is not a number."""

    def value(self, row: int) -> Any:
        """Return the value of a row in the form of the request."""
        number = float(self.values[row])
        return self.cells[row].as_py() if isnan(number) else number

    def accepts(self, rows: Rows) -> NDArray[np.bool_]:
        """Return True for the rows whose number is within the bounds of the field."""
        values = self.values[rows]
        is_significant = (np.abs(values) >= SMALLEST) | (values == 0)
        low, high = self.schema.get("minimum", -inf), self.schema.get("maximum", inf)
        return np.asarray(is_significant & (values >= low) & (values <= high))

    def is_unreadable(self, row: int) -> bool:
        """Return True if the cell of a number contains text that is not a number."""
        is_text = self.schema["type"] == "number" and _is_text(self.cells.type)
        return bool(is_text and self.given[row] and isnan(self.values[row]))

    @property
    def output(self) -> Cells:
        """Column of the result: numbers are doubles, and NaN becomes an empty cell."""
        if self.schema["type"] == "number":
            return pa.array(self.values, mask=np.isnan(self.values))
        is_text = self.schema["type"] == "string"
        return pc.cast(self.cells, pa.string()) if is_text else self.cells


def field(query: str, name: str) -> Schema | None:
    """Return the JSON schema of a field of a query with a dotted name; None if there is none.

    Its `type` is `number`, `integer`, `string`, or `array` of numbers.
    """
    return _fields(query).get(_INDEX.sub("#", name))


@cache
def _fields(query: str) -> Mapping[str, Schema]:
    found: dict[str, Schema] = {}
    for name, leaf in leaves(QUERIES[query].request.model_json_schema()):
        if leaf.get("items", {}).get("type") == "string":
            # Names have a column each, because `flat` gives each of them a name.
            found[f"{name}.#"] = leaf["items"]
        elif not (name in found and leaf["type"] == "array"):
            # A load takes a number or a list; a case of a sweep has one number.
            found[name] = leaf
    return {name: leaf for name, leaf in found.items() if name not in _OVER_RADIUS}


def fits(own: Schema, kind: pa.DataType) -> bool:
    """Return True if a column of an Arrow type can contain the field."""
    if own["type"] == "array":
        is_numbers = pa.types.is_list(kind) and _is_number(kind.value_type)
        return pa.types.is_null(kind) or is_numbers
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    is_number = own["type"] == "number" and _is_number(kind)
    return is_number or _is_text(kind) or pa.types.is_null(kind)


def read_columns(spec: Spec, batch: pa.RecordBatch) -> dict[str, Column]:
    """Return the fields of a batch by their dotted names, without the copied columns."""
    found = {}
    for name, given in zip(batch.schema.names, batch.columns, strict=True):
        own = None if name in spec.kept else field(spec.query, name)
        if own:
            cells = given
            if pa.types.is_dictionary(cells.type):
                cells = pc.cast(cells, cells.type.value_type)
            is_number = own["type"] == "number"
            values = _numbers(cells) if is_number else np.full(len(cells), np.nan)
            found[name] = Column(own, cells, np.asarray(cells.is_valid()), values)
    return found


def _numbers(cells: Cells) -> Values:
    if _is_text(cells.type):
        text = pc.utf8_trim_whitespace(cells)
        cells = pc.if_else(pc.match_substring_regex(text, _NUMBER), text, None)
    doubles = pc.cast(cells, pa.float64(), safe=False)
    return np.asarray(doubles.fill_null(np.nan).to_numpy(zero_copy_only=False))


def _is_number(kind: pa.DataType) -> bool:
    return pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_decimal(kind)


def _is_text(kind: pa.DataType) -> bool:
    return pa.types.is_string(kind) or pa.types.is_large_string(kind)
