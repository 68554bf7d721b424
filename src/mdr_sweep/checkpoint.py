"""Checkpoint of a sweep: a directory beside the result with the completed chunks.

No file in it is ever incomplete: a file is written under another name, forced to the disk, and
renamed. The directory is deleted once the result is written.
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

from mdr_sweep.spec import UsageError

_UNFINISHED: Final = ".unfinished"


class Checkpoint:
    """Completed chunks of a sweep, beside the path of its result."""

    def __init__(self, target: Path) -> None:
        # A symbolic link stays, and the file that it names is written.
        self.target = target.resolve()
        self.folder = self.target.with_name(self.target.name + ".work")
        self._manifest = self.folder / "manifest.json"

    @property
    def manifest(self) -> dict[str, Any]:
        """Manifest of the sweep of the stored chunks; empty if there are none."""
        if not self._manifest.exists():
            return {}
        return dict(json.loads(self._manifest.read_text()))

    @contextmanager
    def opened(self, manifest: Mapping[str, Any], *, restart: bool) -> Iterator[set[int]]:
        """Lock the directory, create it if necessary, and yield the indices of completed chunks.

        Raises UsageError if another process uses it, or if it belongs to another sweep.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        with (self.folder / "lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise UsageError(f"another process uses {self.folder}") from None
            text = json.dumps(manifest, indent=1, sort_keys=True)
            known = self._manifest.exists() and not restart
            if known and self._manifest.read_text() != text:
                raise UsageError(
                    f"{self.folder} holds chunks of another sweep or of another version; "
                    "use --restart to discard them"
                )
            # Chunks without a manifest remain of a sweep that was killed while it deleted them.
            for path in self.folder.glob(f"*{_UNFINISHED}" if known else "*.*"):
                path.unlink()
            with self._whole(self._manifest) as path:
                path.write_text(text)
            yield {int(path.stem) for path in self.folder.glob("*.arrow")}

    def put(self, index: int, batch: pa.RecordBatch) -> None:
        """Store a completed chunk."""
        with (
            self._whole(self.folder / f"{index:012d}.arrow") as path,
            pa.ipc.new_file(str(path), batch.schema) as writer,
        ):
            writer.write_batch(batch)

    def chunks(self) -> Iterator[pa.RecordBatch]:
        """Yield all chunks in their order."""
        for path in sorted(self.folder.glob("*.arrow")):
            with pa.memory_map(str(path)) as file:
                yield pa.ipc.open_file(file).get_batch(0)

    @contextmanager
    def result(self) -> Iterator[Path]:
        """Yield the path under which to write the result, then rename it and delete the rest."""
        with self._whole(self.target) as path:
            yield path
        shutil.rmtree(self.folder)

    @contextmanager
    def _whole(self, target: Path) -> Iterator[Path]:
        """Yield a path to write; the file gets its own name when it is on the disk."""
        path = self.folder / (target.name + _UNFINISHED)
        try:
            yield path
            with path.open("rb") as file:
                os.fsync(file.fileno())
            path.replace(target)
        finally:
            path.unlink(missing_ok=True)
