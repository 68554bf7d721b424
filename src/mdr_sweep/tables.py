"""Tables of scenes, read in batches, whatever their length, and written so that bytes repeat."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from hashlib import file_digest
from pathlib import Path
from typing import Any, Final, Protocol

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pv
import pyarrow.parquet as pq

from mdr_sweep.columns import copied
from mdr_sweep.errors import UsageError

# Rows of a group of the Parquet file that is written: some tens of megabytes.
ROW_GROUP: Final = 65_536
# Bytes of text that are parsed at once.
_BLOCK: Final = 4 * 1024**2
SUFFIXES: Final = (".parquet", ".csv")
# Doubles of answers hardly repeat: only words have a dictionary.
PARQUET: Final[Mapping[str, Any]] = {
    "compression": "zstd",
    "compression_level": 1,
    "store_schema": False,
}


class Source(Protocol):
    """Where scenes come from."""

    @property
    def rows(self) -> int:
        """How many scenes there are."""

    @property
    def schema(self) -> pa.Schema:
        """The columns as they are read."""

    @property
    def identity(self) -> Any:
        """What tells this input from others."""

    def kinds(self, name: str) -> list[str] | None:
        """Return the different words of a column, None where there is no such column."""

    def batches(self, rows: int, skip: set[int]) -> Iterator[tuple[int, pa.RecordBatch]]:
        """Yield the scenes in batches of that many rows, those with an index in `skip` left out."""


class Table:
    """A table in a file: Parquet, or CSV, of which every cell is read as text."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            if path.suffix == ".parquet":
                with pq.ParquetFile(path) as file:
                    self.schema = file.schema_arrow
                    self.rows = file.metadata.num_rows
            else:
                with self._csv() as reader:
                    self.schema = reader.schema
                    self.rows = sum(batch.num_rows for batch in reader)
        except (OSError, pa.ArrowException) as error:
            raise UsageError(f"{path} cannot be read: {error}") from None
        twice = {name for name in self.schema.names if self.schema.names.count(name) > 1}
        if twice:
            raise UsageError(f"{path} has more than one column {min(twice)}")

    @property
    def identity(self) -> Any:
        """A digest of all of the file."""
        with self.path.open("rb") as file:
            return file_digest(file, "sha256").hexdigest()

    def kinds(self, name: str) -> list[str] | None:
        """Return the different words of a column, None where there is no such column."""
        if name not in self.schema.names:
            return None
        found: set[str] = set()
        for batch in self._read([name]):
            words = batch.column(0)
            if pa.types.is_dictionary(words.type):
                words = pc.cast(words, words.type.value_type)
            found |= {str(word) for word in words.unique().to_pylist()}
        return sorted(found)

    def batches(self, rows: int, skip: set[int]) -> Iterator[tuple[int, pa.RecordBatch]]:
        """Yield the scenes in batches of that many rows, those with an index in `skip` left out."""
        for index, batch in enumerate(regrouped(self._read(), rows)):
            if index not in skip:
                yield index, batch

    def _read(self, names: list[str] | None = None) -> Iterator[pa.RecordBatch]:
        if self.path.suffix == ".parquet":
            # Buffered ahead, all that was read would be held to the end.
            with pq.ParquetFile(self.path, pre_buffer=False) as file:
                yield from file.iter_batches(batch_size=ROW_GROUP, columns=names, use_threads=False)
        else:
            with self._csv(names) as reader:
                yield from reader

    def _csv(self, names: list[str] | None = None) -> pv.CSVStreamingReader:
        read = pv.ReadOptions(block_size=_BLOCK, use_threads=False)
        with pv.open_csv(self.path, read_options=read) as head:
            kinds = dict.fromkeys(head.schema.names, pa.string())
        convert = pv.ConvertOptions(
            column_types=kinds, strings_can_be_null=True, null_values=[""], include_columns=names
        )
        return pv.open_csv(self.path, read_options=read, convert_options=convert)


def regrouped(batches: Iterable[pa.RecordBatch], rows: int) -> Iterator[pa.RecordBatch]:
    """Yield the same rows in batches of another size, the last one shorter."""
    held: list[pa.RecordBatch] = []
    size = 0
    for batch in batches:
        rest = batch
        while size + rest.num_rows >= rows:
            held.append(rest.slice(0, rows - size))
            rest = rest.slice(rows - size)
            yield _one(held)
            held, size = [], 0
        if rest.num_rows:
            held.append(rest)
            size += rest.num_rows
    if held:
        yield _one(held)


def _one(batches: list[pa.RecordBatch]) -> pa.RecordBatch:
    if len(batches) == 1:
        return batches[0]
    (whole,) = pa.Table.from_batches(batches).combine_chunks().to_batches()
    return whole


def joined(
    batch: pa.RecordBatch, answers: pa.RecordBatch, kept: Collection[str] = ()
) -> pa.RecordBatch:
    """Return the rows of the result: the inputs, some kept as they are, and the answers."""
    arrays = {
        name: array if name in kept else copied(name, array)
        for name, array in zip(batch.schema.names, batch.columns, strict=True)
    }
    return pa.record_batch(arrays | dict(zip(answers.schema.names, answers.columns, strict=True)))


def write(path: Path, target: Path, schema: pa.Schema, batches: Iterable[pa.RecordBatch]) -> None:
    """Write the rows to `path` in the form that the name of `target` says.

    The same rows give the same bytes: row groups, encodings and compression are fixed, and
    nothing tells the time.
    """
    rows = regrouped(batches, ROW_GROUP)
    if target.suffix == ".csv":
        with pv.CSVWriter(path, schema) as writer:
            for batch in rows:
                writer.write_batch(batch)
        return
    words = [field.name for field in schema if pa.types.is_string(field.type)]
    options: dict[str, Any] = {**PARQUET, "use_dictionary": words}
    with pq.ParquetWriter(path, schema, **options) as writer:
        for batch in rows:
            writer.write_batch(batch, row_group_size=ROW_GROUP)
