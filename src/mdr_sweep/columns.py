"""Columns of a table, as numbers wherever they are numbers."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from mdr_sweep.requests import is_word

Values = NDArray[np.float64]
Flags = NDArray[np.bool_]
Cells: TypeAlias = "pa.Array[Any]"


@dataclass(frozen=True)
class Column:
    """One field of all scenes: numbers, and in some rows something else, or nothing."""

    values: Values
    given: Flags
    """False where the cell is empty: the field is left out."""
    odd: Mapping[int, Any] = field(default_factory=dict)
    """By row what is no number: words, lists, and what should not be there."""

    def value(self, row: int) -> Any:
        """Return what a row holds, as Python's own."""
        return self.odd[row] if row in self.odd else float(self.values[row])


def columns(batch: pa.RecordBatch) -> dict[str, Column]:
    """Return the fields of a batch by their names."""
    return {
        name: _column(name, array)
        for name, array in zip(batch.schema.names, batch.columns, strict=True)
    }


def written(name: str, kind: pa.DataType) -> pa.DataType:
    """Return the type in which a field of the input is answered: numbers are doubles."""
    if pa.types.is_dictionary(kind):
        return written(name, kind.value_type)
    texts = pa.types.is_string(kind) or pa.types.is_large_string(kind)
    if _is_number(kind) or pa.types.is_null(kind) or (texts and not is_word(name)):
        return pa.float64()
    return pa.string() if texts else kind


def copied(name: str, array: Cells) -> Cells:
    """Return a column of the input as it is answered; what should be a number and is none is null.

    The error of its row says so.
    """
    kind = written(name, array.type)
    if array.type.equals(kind) and not pa.types.is_floating(kind):
        return array
    if not pa.types.is_float64(kind):
        return pc.cast(array, kind)
    column = _column(name, array)
    missing = ~column.given
    missing[list(column.odd)] = True
    return pa.array(column.values, mask=missing if missing.any() else None)


def _column(name: str, array: Cells) -> Column:
    given = np.asarray(array.is_valid()) if array.null_count else np.ones(len(array), dtype=bool)
    kind = array.type
    if pa.types.is_dictionary(kind):
        array = pc.cast(array, kind.value_type)
        kind = array.type
    if _is_number(kind):
        return Column(_doubles(array), given)
    if pa.types.is_null(kind):
        return Column(np.zeros(len(array)), given)
    texts = pa.types.is_string(kind) or pa.types.is_large_string(kind)
    if texts and not is_word(name):
        try:
            return Column(_doubles(pc.cast(array, pa.float64())), given)
        except pa.ArrowInvalid:
            return _mixed(array.to_pylist(), given)
    return Column(
        np.zeros(len(array)),
        given,
        {row: value for row, value in enumerate(array.to_pylist()) if value is not None},
    )


def _is_number(kind: pa.DataType) -> bool:
    return pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_decimal(kind)


def _doubles(array: Cells) -> Values:
    doubles = pc.cast(array, pa.float64(), safe=False)
    return np.asarray(doubles.fill_null(0.0).to_numpy(zero_copy_only=False))


def _mixed(cells: list[str | None], given: Flags) -> Column:
    """A column of texts of which some are no numbers."""
    values, odd = np.zeros(len(cells)), {}
    for row, cell in enumerate(cells):
        if cell is None:
            continue
        try:
            values[row] = float(cell)
        except ValueError:
            odd[row] = cell
    return Column(values, given, odd)
