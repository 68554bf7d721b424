"""A damaged checkpoint is reported with its remedy, and never reaches a result."""

import shutil
from collections.abc import Callable
from pathlib import Path
from random import Random

import pyarrow as pa
import pytest

from mdr_sweep.checkpoint import Checkpoint
from mdr_sweep.spec import UsageError

COUNT = 10
MANIFEST = {"chunk": 4}
PLACES = range(COUNT)


def flip(path: Path, place: int) -> None:
    content = bytearray(path.read_bytes())
    content[Random(place).randrange(len(content))] ^= 1 << place % 8
    path.write_bytes(content)


def truncate(path: Path, place: int) -> None:
    path.write_bytes(path.read_bytes()[: -1 - place])


def copy(path: Path, place: int) -> None:
    others = sorted(path.parent.glob("*.arrow"))
    shutil.copy(others[(place + 1) % COUNT], path)


def add(path: Path, place: int) -> None:
    shutil.copy(path, path.with_name(f"{COUNT + place:012d}{path.name[12:]}"))


def empty(path: Path, _place: int) -> None:
    path.write_bytes(b"")


@pytest.fixture
def stored(tmp_path: Path) -> Checkpoint:
    checkpoint = Checkpoint(tmp_path / "result.parquet")
    with checkpoint.opened(MANIFEST, restart=False):
        for index in PLACES:
            checkpoint.put(index, pa.record_batch({"x": [float(index)] * 4}))
    return checkpoint


def chunk(checkpoint: Checkpoint, index: int) -> Path:
    return next(checkpoint.folder.glob(f"{index:012d}-*.arrow"))


@pytest.mark.parametrize("damage", [flip, truncate, copy, add, empty])
@pytest.mark.parametrize("place", PLACES)
def test_damaged_chunk_is_found_before_the_sweep_resumes(
    stored: Checkpoint, damage: Callable[[Path, int], None], place: int
) -> None:
    damage(chunk(stored, place), place)
    with (
        pytest.raises(UsageError, match=r"is damaged or incomplete; use --restart"),
        stored.opened(MANIFEST, restart=False),
    ):
        pass
    with stored.opened(MANIFEST, restart=True) as done:
        assert done == set()


@pytest.mark.parametrize("damage", [flip, truncate, copy, empty, lambda path, _: path.unlink()])
def test_chunk_damaged_during_the_sweep_is_found_before_the_result(
    stored: Checkpoint, damage: Callable[[Path, int], None]
) -> None:
    with stored.opened(MANIFEST, restart=False) as done:
        assert done == set(PLACES)
        assert [batch.column("x")[0].as_py() for batch in stored.chunks(COUNT)] == [*PLACES]
        damage(chunk(stored, 7), 7)
        with pytest.raises(UsageError, match="--restart"):
            list(stored.chunks(COUNT))


@pytest.mark.parametrize("text", ["", "[1]", "{}", '{"chunk": "4"}', "\xff\xfe"])
def test_damaged_manifest_is_reported(stored: Checkpoint, text: str) -> None:
    (stored.folder / "manifest.json").write_text(text, "latin-1")
    with pytest.raises(UsageError, match="--restart"):
        _ = stored.manifest
