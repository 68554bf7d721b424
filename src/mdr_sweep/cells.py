"""Columns of a table as fields of requests."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan
from typing import Any, Final, TypeAlias

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from mdr_sweep import request_fields
from mdr_sweep.request_fields import Field, generic
from mdr_sweep.spec import Spec

Values = NDArray[np.float64]
Cells: TypeAlias = "pa.Array[Any]"
# Decimal numbers, which Arrow converts to the nearest double.
_NUMBER: Final = r"^-?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$"


@dataclass(frozen=True)
class Column:
    """A field of all cases of a batch."""

    field: Field
    cells: Cells
    given: NDArray[np.bool_]
    """False where the cell is empty: the field is absent from the request."""
    values: Values
    """Numbers; NaN where the cell is empty or is not a number."""

    def value(self, row: int) -> Any:
        """Return the value of a row, as it stands in the request."""
        number = float(self.values[row])
        return self.cells[row].as_py() if isnan(number) else number

    @property
    def output(self) -> Cells:
        """The column as it stands in the result: numbers are doubles, and NaN is empty."""
        if self.field.type == "number":
            return pa.array(self.values, mask=np.isnan(self.values))
        return pc.cast(self.cells, pa.string()) if self.field.type == "string" else self.cells


def columns(spec: Spec, batch: pa.RecordBatch) -> Mapping[str, Column]:
    """Return the fields of a batch by their dotted names, without the columns that are kept."""
    names = (name for name in batch.schema.names if name not in spec.kept)
    fields = request_fields.fields(spec.query)
    return {name: _column(fields[generic(name)], batch.column(name)) for name in names}


def fits(field: Field, kind: pa.DataType) -> bool:
    """Return True if a column of an Arrow type can hold a field."""
    if field.type == "array":
        return pa.types.is_null(kind) or (pa.types.is_list(kind) and _is_number(kind.value_type))
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    is_number = field.type == "number" and _is_number(kind)
    return is_number or _is_text(kind) or pa.types.is_null(kind)


def _column(field: Field, cells: Cells) -> Column:
    if pa.types.is_dictionary(cells.type):
        cells = pc.cast(cells, cells.type.value_type)
    values = _numbers(cells) if field.type == "number" else np.full(len(cells), np.nan)
    return Column(field, cells, np.asarray(cells.is_valid()), values)


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
