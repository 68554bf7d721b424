"""Checkpoint of a sweep: a directory beside the result with the completed chunks.

Files in the directory are always complete: each is written under another name, forced to the disk,
and renamed. The name of a chunk contains a digest of sweep, index and content, which reveals a
chunk that is damaged, copied or of another sweep. The directory is deleted once the result is
written.
"""

import fcntl
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import pyarrow as pa

from mdr_sweep.spec import UsageError
from mdr_sweep.tables import from_bytes, to_bytes

_UNFINISHED: Final = ".unfinished"
_DIGITS: Final = 12
"""Digits of the index of a chunk in its name."""


class Checkpoint:
    """Completed chunks of a sweep, beside the path of its result."""

    def __init__(self, target: Path) -> None:
        # The target of a symbolic link is written, and the link is preserved.
        self.target = target.resolve()
        self.folder = self.target.with_name(self.target.name + ".work")
        self._manifest = self.folder / "manifest.json"
        self._sweep = ""

    @property
    def manifest(self) -> dict[str, Any]:
        """Manifest of the sweep of the stored chunks; empty if there are none.

        Raises UsageError if it is damaged.
        """
        if not self._manifest.exists():
            return {}
        with suppress(ValueError, TypeError, KeyError):
            found = dict(json.loads(self._manifest.read_bytes()))
            if isinstance(found["chunk"], int) and found["chunk"] > 0:
                return found
        raise _damaged(self._manifest)

    @contextmanager
    def opened(self, manifest: Mapping[str, Any], *, restart: bool) -> Iterator[set[int]]:
        """Lock the directory, create it if necessary, and yield the indices of completed chunks.

        Raises UsageError if another process uses it, if it belongs to another sweep, or if a chunk
        is damaged.
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
            # Chunks without a manifest are left by a sweep that was killed while deleting them.
            for path in self.folder.glob(f"*{_UNFINISHED}" if known else "*.*"):
                path.unlink()
            with self._whole(self._manifest) as path:
                path.write_text(text)
            self._sweep = text
            yield {index for index, _ in self._stored()}

    def put(self, index: int, batch: pa.RecordBatch) -> None:
        """Store a completed chunk."""
        content = to_bytes(batch)
        with self._whole(self.folder / self._name(f"{index:0{_DIGITS}}", content)) as path:
            path.write_bytes(content)

    def chunks(self, count: int) -> Iterator[pa.RecordBatch]:
        """Yield all chunks in their order; raise UsageError unless `count` of them are intact."""
        stored = self._stored()
        for expected in range(count):
            index, content = next(stored, (count, b""))
            if index != expected:
                raise _damaged(self.folder)
            yield from_bytes(content)

    def _stored(self) -> Iterator[tuple[int, bytes]]:
        """Yield index and content of the stored chunks in their order."""
        for path in sorted(self.folder.glob("*.arrow*")):
            index, content = path.name[:_DIGITS], path.read_bytes()
            if path.name != self._name(index, content):
                raise _damaged(path)
            yield int(index), content

    def _name(self, index: str, content: bytes) -> str:
        """Return the name of a chunk, with a digest of sweep, index and content."""
        known = f"{self._sweep} {index} ".encode()
        return f"{index}-{sha256(known + content).hexdigest()[:16]}.arrow"

    @contextmanager
    def result(self) -> Iterator[Path]:
        """Yield the path under which to write the result, then rename it and delete the rest."""
        with self._whole(self.target) as path:
            yield path
        shutil.rmtree(self.folder)

    @contextmanager
    def _whole(self, target: Path) -> Iterator[Path]:
        """Yield a temporary path to write; the file gets its final name once it is on the disk."""
        path = self.folder / (target.name + _UNFINISHED)
        try:
            yield path
            with path.open("rb") as file:
                os.fsync(file.fileno())
            path.replace(target)
        finally:
            path.unlink(missing_ok=True)


def _damaged(path: Path) -> UsageError:
    return UsageError(f"{path} is damaged or incomplete; use --restart to discard all chunks")
