"""The work directory of a sweep: every chunk that is done, whole, and what the sweep is.

It lies next to the result and is removed with the last step. Nothing in it is ever half-written:
a file is written under another name, forced to the disk, and renamed.
"""

import fcntl
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import pyarrow as pa

from mdr_sweep.errors import UsageError

_MANIFEST: Final = "manifest.json"
_LOCK: Final = "lock"
_UNFINISHED: Final = ".unfinished"


class Work:
    """What is done of one sweep."""

    def __init__(self, target: Path) -> None:
        self.target = target
        self.folder = target.with_name(target.name + ".work")

    @contextmanager
    def opened(self, manifest: Mapping[str, Any], *, restart: bool) -> Iterator[set[int]]:
        """Hold the directory, made if need be, and yield the chunks that are done.

        Raises UsageError where another process holds it, or it is that of another sweep.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        with (self.folder / _LOCK).open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise UsageError(f"another process works in {self.folder}") from None
            for stray in self.folder.glob(f"*{_UNFINISHED}"):
                stray.unlink()
            self._begin(json.dumps(manifest, indent=1, sort_keys=True), restart=restart)
            yield {int(path.stem) for path in self.folder.glob("*.arrow")}

    def _begin(self, manifest: str, *, restart: bool) -> None:
        known = self.folder / _MANIFEST
        of_this = known.exists() and known.read_text() == manifest
        if known.exists() and not (of_this or restart):
            raise UsageError(
                f"{self.folder} holds chunks of another sweep, or of another version: "
                "--restart begins anew"
            )
        # Without a manifest they are of a sweep that was ended while it was tidied up.
        if restart or not of_this:
            for path in self.folder.glob("*.arrow"):
                path.unlink()
        with self._whole(known) as path:
            path.write_text(manifest)

    def put(self, index: int, batch: pa.RecordBatch) -> None:
        """Keep a chunk that is done."""
        with (
            self._whole(self._chunk(index)) as path,
            pa.OSFile(str(path), "wb") as file,
            pa.ipc.new_file(file, batch.schema) as writer,
        ):
            writer.write_batch(batch)

    def chunks(self, count: int) -> Iterator[pa.RecordBatch]:
        """Yield all chunks in their order."""
        for index in range(count):
            with pa.memory_map(str(self._chunk(index))) as file:
                yield pa.ipc.open_file(file).get_batch(0)

    @contextmanager
    def result(self) -> Iterator[Path]:
        """Yield where to write the result; it is there all at once, and then the work is gone."""
        with self._whole(self.target) as path:
            yield path
        shutil.rmtree(self.folder)

    def _chunk(self, index: int) -> Path:
        return self.folder / f"{index:09d}.arrow"

    @contextmanager
    def _whole(self, target: Path) -> Iterator[Path]:
        """Yield a name to write under; the file has its own name when it is on the disk."""
        path = self.folder / (target.name + _UNFINISHED)
        try:
            yield path
            with path.open("rb+") as file:
                os.fsync(file.fileno())
            path.replace(target)
        finally:
            path.unlink(missing_ok=True)
        for folder in {self.folder, target.parent}:
            descriptor = os.open(folder, os.O_RDONLY)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)
