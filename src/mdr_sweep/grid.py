"""Grids of scenes: every combination of the values of some axes, the last one fastest."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite, prod
from typing import Any, Final

import numpy as np
import pyarrow as pa

from mdr_sweep.columns import Values
from mdr_sweep.errors import UsageError

# An axis is held in memory; so many values are a few megabytes.
_MOST: Final = 10_000_000
_PARTS: Final = 3


@dataclass(frozen=True)
class Axis:
    """``start:stop:n``, evenly, or with ``:log`` evenly in the logarithm; both ends included."""

    start: float
    stop: float
    count: int
    logarithmic: bool = False

    @property
    def values(self) -> Values:
        """All of them."""
        spaced = np.geomspace if self.logarithmic else np.linspace
        return np.asarray(spaced(self.start, self.stop, self.count))


def is_axis(value: object) -> bool:
    """Whether a constant of a template is meant as an axis."""
    return isinstance(value, str) and value.count(":") + 1 >= _PARTS


def axis(name: str, text: str) -> Axis:
    """Return the axis that a text describes.

    Raises UsageError where it describes none.
    """
    start, stop, count, *spacing = text.split(":")[:4] if text.count(":") >= 2 else ("", "", "")
    known = spacing in ([], ["lin"], ["log"]) and text.count(":") <= _PARTS
    try:
        found = Axis(float(start), float(stop), int(count), spacing == ["log"])
    except ValueError:
        known = False
    if not known:
        raise UsageError(f"{name}: {text!r} is no axis: start:stop:n or start:stop:n:log is needed")
    if not (isfinite(found.start) and isfinite(found.stop) and 1 <= found.count <= _MOST):
        raise UsageError(f"{name}: an axis has finite ends and 1 to {_MOST} values")
    if found.logarithmic and not (found.start > 0 and found.stop > 0):
        raise UsageError(f"{name}: a logarithmic axis has positive ends")
    if found.count == 1 and found.start != found.stop:
        raise UsageError(f"{name}: one value cannot be at both ends")
    return found


@dataclass(frozen=True)
class Grid:
    """All combinations of the axes, by their dotted names."""

    axes: Mapping[str, Axis]

    @property
    def rows(self) -> int:
        """How many scenes it has."""
        return prod(axis.count for axis in self.axes.values())

    @property
    def schema(self) -> pa.Schema:
        """Every axis is a column of doubles."""
        return pa.schema([(name, pa.float64()) for name in self.axes])

    @property
    def identity(self) -> Any:
        """What tells this input from others."""
        return {
            name: [axis.start, axis.stop, axis.count, axis.logarithmic]
            for name, axis in self.axes.items()
        }

    def kinds(self, _name: str) -> list[str] | None:
        """Words have no axes."""
        return None

    def batches(self, rows: int, skip: set[int]) -> Iterator[tuple[int, pa.RecordBatch]]:
        """Yield the scenes in batches of that many rows, those with an index in `skip` left out."""
        values = [axis.values for axis in self.axes.values()]
        shape = tuple(len(each) for each in values)
        for index, start in enumerate(range(0, self.rows, rows)):
            if index in skip:
                continue
            places = np.unravel_index(np.arange(start, min(start + rows, self.rows)), shape)
            columns = [each[place] for each, place in zip(values, places, strict=True)]
            yield index, pa.record_batch(columns, schema=self.schema)
