"""Cases of a sweep, from a grid or a file, and files of results."""

import json
from collections.abc import Collection, Iterable, Iterator, Mapping
from hashlib import file_digest
from itertools import chain
from math import isfinite, prod
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
import pyarrow as pa
import pyarrow.csv as pv
import pyarrow.dataset as ds
import pyarrow.parquet as pq
from pyarrow.lib import concat_batches  # `pa.concat_batches`, which the type stubs lack.

from mdr_sweep.request_columns import Values
from mdr_sweep.spec import UsageError

# Number of rows in a row group of a Parquet file, and maximum number in a chunk: about 10 MB.
# Arrays of this many cases fit in the processor's cache; larger arrays take up to twice as long per
# case.
ROW_GROUP: Final = 65_536
# Maximum number of values of an axis, which take 80 MB of memory.
_MAX_VALUES: Final = 10_000_000
# Number of places from which a sample is taken, so that it represents a sorted input.
_PARTS: Final = 8
SUFFIXES: Final = (".parquet", ".csv")


class Grid:
    """All combinations of the values of some axes, by field; the last axis varies fastest."""

    def __init__(self, axes: Mapping[str, str]) -> None:
        self.identity = dict(axes)
        self.values = [axis(name, text) for name, text in axes.items()]
        self.shape = [values.size for values in self.values]
        self.rows = prod(self.shape)
        self.schema = pa.schema([(name, pa.float64()) for name in axes])

    def batches(self, rows: int, indices: Collection[int]) -> Iterator[pa.RecordBatch]:
        """Yield the batches of `rows` cases with the given indices, ascending."""
        for index in indices:
            numbers = np.arange(index * rows, min((index + 1) * rows, self.rows))
            places = np.unravel_index(numbers, self.shape)
            columns = [values[place] for values, place in zip(self.values, places, strict=True)]
            yield pa.record_batch(columns, schema=self.schema)


class Table:
    """Cases in a file: Parquet, or CSV, whose cells are all read as text."""

    def __init__(self, path: Path) -> None:
        is_parquet = path.suffix == ".parquet"
        try:
            read = pv.ReadOptions(use_threads=False)
            names = (pq.read_schema(path) if is_parquet else pv.open_csv(path, read).schema).names
            if len(set(names)) < len(names):
                raise UsageError(f"{path} has two columns {max(names, key=names.count)}")
            if is_parquet:
                # Read-ahead would hold all data read so far in memory until the end.
                options = ds.ParquetFragmentScanOptions(pre_buffer=False)
                form: ds.FileFormat = ds.ParquetFileFormat(default_fragment_scan_options=options)
                self._data = ds.dataset(path, format=form)
                self.rows = self._data.count_rows()
            else:
                convert = pv.ConvertOptions(strings_can_be_null=True, null_values=[""])
                schema = pa.schema([(name, pa.string()) for name in names])
                form = ds.CsvFileFormat(convert_options=convert)
                self._data = ds.dataset(path, schema, format=form)
                # Conversion finds text that is not UTF-8.
                self.rows = sum(batch.num_rows for batch in self._data.to_batches())
            self.schema = self._data.schema
            with path.open("rb") as binary:
                self.identity = file_digest(binary, "sha256").hexdigest()
        except (OSError, pa.ArrowException) as error:
            raise UsageError(f"cannot read {path}: {error}") from None

    def batches(self, rows: int, indices: Collection[int]) -> Iterator[pa.RecordBatch]:
        """Yield the batches of `rows` cases with the given indices, ascending."""
        wanted = frozenset(indices)
        read = self._data.to_batches(
            batch_size=ROW_GROUP, use_threads=False, batch_readahead=0, fragment_readahead=0
        )
        for index, batch in enumerate(regrouped(read, rows)):
            if index in wanted:
                yield batch


Source: TypeAlias = Grid | Table


def axis(name: str, text: str) -> Values:
    """Return the values of an axis, both ends included.

    Raises UsageError unless the text is ``start:stop:n``, ``start:stop:n:lin`` or
    ``start:stop:n:log``.
    """
    try:
        first, last, number, *spacing = text.split(":")
        start, stop, count = float(first), float(last), int(number)
    except ValueError:
        spacing = [""]
    if spacing not in ([], ["lin"], ["log"]):
        raise UsageError(f"{name}: {text!r} is not an axis; use START:STOP:N or START:STOP:N:log")
    if not (isfinite(start) and isfinite(stop) and 1 <= count <= _MAX_VALUES):
        raise UsageError(f"{name}: an axis needs finite ends and 1 to {_MAX_VALUES} values")
    if count == 1 and start != stop:
        raise UsageError(f"{name}: an axis of one value needs equal ends")
    if spacing != ["log"]:
        return np.linspace(start, stop, count)
    if min(start, stop) <= 0:
        raise UsageError(f"{name}: a logarithmic axis needs positive ends")
    return np.geomspace(start, stop, count)


def sample(source: Source) -> pa.RecordBatch:
    """Return up to `ROW_GROUP` cases, sampled from several places of the input."""
    rows = ROW_GROUP // _PARTS
    count = -(-source.rows // rows)
    places = sorted({count * part // _PARTS for part in range(_PARTS)})
    return concat_batches(list(source.batches(rows, places)))


def regrouped(batches: Iterable[pa.RecordBatch], rows: int) -> Iterator[pa.RecordBatch]:
    """Yield the rows of batches in batches of `rows`; the last one can be shorter."""
    held: list[pa.RecordBatch] = []
    size = 0
    for batch in batches:
        held.append(batch)
        size += batch.num_rows
        if size >= rows:
            whole = concat_batches(held)
            end = size // rows * rows
            yield from (whole.slice(start, rows) for start in range(0, end, rows))
            held, size = [whole.slice(end)], size - end
    if size:
        yield concat_batches(held)


def to_bytes(batch: pa.RecordBatch) -> bytes:
    """Return a batch as an Arrow stream; pickling a slice would store the whole array."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, batch.schema) as writer:
        writer.write_batch(batch)
    return sink.getvalue().to_pybytes()


def from_bytes(content: bytes) -> pa.RecordBatch:
    """Return the batch of an Arrow stream."""
    with pa.ipc.open_stream(content) as reader:
        return reader.read_next_batch()


def write(
    sink: Any, suffix: str, batches: Iterable[pa.RecordBatch], provenance: Mapping[str, Any]
) -> None:
    """Write rows to a file. Equal rows give equal bytes, independent of chunks and of the time.

    Parameters
    ----------
    sink : path or binary file.
    suffix : ``.parquet`` or ``.csv``.
    batches : the rows, in at least one batch.
    provenance : stored in JSON as the metadata `mdr` of a Parquet file.
    """
    rows = regrouped(batches, ROW_GROUP)
    first = next(rows)
    # Doubles seldom repeat: only text is stored with a dictionary.
    texts: Any = [field.name for field in first.schema if pa.types.is_string(field.type)]
    options: dict[str, Any] = {"compression": "zstd", "compression_level": 1, "store_schema": False}
    writer: Any = (
        pv.CSVWriter(sink, first.schema)
        if suffix == ".csv"
        else pq.ParquetWriter(sink, first.schema, use_dictionary=texts, **options)
    )
    with writer:
        for batch in chain([first], rows):
            writer.write_batch(batch)
        if suffix != ".csv":
            writer.add_key_value_metadata({"mdr": json.dumps(dict(provenance), sort_keys=True)})
