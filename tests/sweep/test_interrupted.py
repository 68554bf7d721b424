"""Whatever ends a sweep, the next run goes on from there and gives the same bytes."""

import json
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

from tests.sweep import running

SCENES, CHUNK = 2000, 100
OPTIONS = ("tangential", "--table", "scenes.parquet", "--chunk", str(CHUNK), "--workers", "2")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sweep")
    running.write_scenes(folder / "scenes.parquet", SCENES)
    return folder


@pytest.fixture(scope="module")
def undisturbed(folder: Path) -> bytes:
    status, said = running.swept(folder, *OPTIONS, "--out", "undisturbed.parquet")
    assert status == 0, said
    assert "2,000 of 2,000 scenes" in said
    return (folder / "undisturbed.parquet").read_bytes()


def test_a_killed_worker_and_a_killed_client_lose_nothing(folder: Path, undisturbed: bytes) -> None:
    options = (*OPTIONS, "--out", "killed.parquet")
    first = running.sweep(folder, *options)
    running.until(lambda: running.chunks(folder, "killed.parquet") >= 2)
    running.kill(running.workers(first.pid)[0])
    before = running.chunks(folder, "killed.parquet")
    running.until(lambda: running.chunks(folder, "killed.parquet") >= before + 3)
    assert first.poll() is None
    running.kill(first.pid)
    running.finished(first)
    left = running.chunks(folder, "killed.parquet")
    assert 0 < left < SCENES // CHUNK
    assert not (folder / "killed.parquet").exists()

    status, said = running.swept(folder, *options)
    assert status == 0, said
    assert (folder / "killed.parquet").read_bytes() == undisturbed
    assert not (folder / "killed.parquet.work").exists()


def test_an_interrupted_sweep_goes_on(folder: Path, undisturbed: bytes) -> None:
    options = (*OPTIONS, "--out", "interrupted.parquet")
    first = running.sweep(folder, *options)
    running.until(lambda: running.chunks(folder, "interrupted.parquet") >= 1)
    first.send_signal(signal.SIGINT)
    status, _said = running.finished(first)
    assert status != 0
    assert running.swept(folder, *options)[0] == 0
    assert (folder / "interrupted.parquet").read_bytes() == undisturbed


@pytest.mark.parametrize("room", [10_000, 100_000])
def test_a_full_disk_leaves_nothing_half_written(
    folder: Path, undisturbed: bytes, room: int
) -> None:
    # A chunk takes some twenty thousand bytes, the result some hundred thousands.
    name = f"full{room}.parquet"
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (room, room))
    status, said = running.swept(folder, *OPTIONS, "--out", name, preexec_fn=limit)
    assert status == 1
    assert "run the same again to go on" in said
    assert not (folder / name).exists()
    assert not list((folder / f"{name}.work").glob("*.unfinished"))
    assert running.chunks(folder, name) == (0 if room == 10_000 else SCENES // CHUNK)

    assert running.swept(folder, *OPTIONS, "--out", name)[0] == 0
    assert (folder / name).read_bytes() == undisturbed


def test_a_cluster_gives_the_same_bytes(folder: Path, undisturbed: bytes) -> None:
    with cluster(folder) as address:
        options = (*OPTIONS, "--out", "cluster.parquet", "--scheduler", address)
        status, said = running.swept(folder, *options)
    assert status == 0, said
    assert (folder / "cluster.parquet").read_bytes() == undisturbed


@contextmanager
def cluster(folder: Path) -> Iterator[str]:
    """A scheduler and a worker, started as on a cluster."""
    file = folder / "scheduler.json"
    at_home = ("--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file))
    processes = [
        subprocess.Popen(
            [sys.executable, "-m", "dask", *command],
            cwd=folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for command in (
            ("scheduler", "--port", "0", *at_home),
            ("worker", "--nthreads", "1", "--no-nanny", *at_home),
        )
    ]
    try:
        running.until(file.exists)
        yield json.loads(file.read_text())["address"]
    finally:
        for process in processes:
            process.kill()
            process.wait()
