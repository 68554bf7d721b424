"""An interrupted sweep resumes and gives the same bytes as an uninterrupted one."""

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

pytestmark = pytest.mark.long

CASES, CHUNK = 2000, 100
OPTIONS = ("tangential", "--table", "cases.parquet", "--chunk", str(CHUNK), "--workers", "2")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sweep")
    running.write_cases(folder / "cases.parquet", CASES)
    return folder


@pytest.fixture(scope="module")
def uninterrupted(folder: Path) -> bytes:
    status, stderr = running.swept(folder, *OPTIONS, "--out", "undisturbed.parquet")
    assert status == 0, stderr
    assert "2,000 cases: " in stderr
    return (folder / "undisturbed.parquet").read_bytes()


def test_killed_worker_and_killed_client_lose_nothing(folder: Path, uninterrupted: bytes) -> None:
    options = (*OPTIONS, "--out", "killed.parquet")
    first = running.sweep(folder, *options)
    running.until(lambda: running.chunks(folder, "killed.parquet") >= 2)
    running.kill(running.workers(first.pid)[0])
    before = running.chunks(folder, "killed.parquet")
    running.until(lambda: running.chunks(folder, "killed.parquet") >= before + 3)
    assert first.poll() is None
    orphans = running.workers(first.pid)
    running.kill(first.pid)
    running.finished(first)
    running.until(lambda: not any(Path(f"/proc/{one}/cmdline").exists() for one in orphans))
    left = running.chunks(folder, "killed.parquet")
    assert 0 < left < CASES // CHUNK
    assert not (folder / "killed.parquet").exists()

    status, stderr = running.swept(folder, *options)
    assert status == 0, stderr
    assert (folder / "killed.parquet").read_bytes() == uninterrupted
    assert not (folder / "killed.parquet.work").exists()


def test_interrupted_sweep_resumes(folder: Path, uninterrupted: bytes) -> None:
    options = (*OPTIONS, "--out", "interrupted.parquet")
    first = running.sweep(folder, *options)
    running.until(lambda: running.chunks(folder, "interrupted.parquet") >= 1)
    first.send_signal(signal.SIGINT)
    status, stderr = running.finished(first)
    assert status == 130
    assert "interrupted; completed chunks are kept; rerun the command to resume" in stderr
    assert "Traceback" not in stderr
    assert running.swept(folder, *options)[0] == 0
    assert (folder / "interrupted.parquet").read_bytes() == uninterrupted


def test_one_process_resumes_a_sweep_of_two(folder: Path, uninterrupted: bytes) -> None:
    options = (*OPTIONS, "--out", "alone.parquet")
    first = running.sweep(folder, *options)
    running.until(lambda: running.chunks(folder, "alone.parquet") >= 2)
    first.send_signal(signal.SIGINT)
    assert running.finished(first)[0] == 130
    assert running.swept(folder, *OPTIONS[:-1], "1", "--out", "alone.parquet")[0] == 0
    assert (folder / "alone.parquet").read_bytes() == uninterrupted


@pytest.mark.parametrize("room", [10_000, 100_000])
def test_full_disk_leaves_no_partial_result(folder: Path, uninterrupted: bytes, room: int) -> None:
    # A chunk takes about 20 kB, the result several hundred kB.
    name = f"full{room}.parquet"
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (room, room))
    status, stderr = running.swept(folder, *OPTIONS, "--out", name, prepare=limit)
    assert status == 1
    assert "rerun the command to resume" in stderr
    assert not (folder / name).exists()
    assert not list((folder / f"{name}.work").glob("*.unfinished"))
    assert running.chunks(folder, name) == (0 if room == 10_000 else CASES // CHUNK)

    assert running.swept(folder, *OPTIONS, "--out", name)[0] == 0
    assert (folder / name).read_bytes() == uninterrupted


def test_cluster_gives_identical_bytes(folder: Path, uninterrupted: bytes) -> None:
    with cluster(folder) as address:
        options = (*OPTIONS, "--out", "cluster.parquet", "--scheduler", address)
        status, stderr = running.swept(folder, *options)
    assert status == 0, stderr
    assert (folder / "cluster.parquet").read_bytes() == uninterrupted


@contextmanager
def cluster(folder: Path) -> Iterator[str]:
    """Start a scheduler and a worker as on a cluster, and yield the scheduler's address."""
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
        # The scheduler creates the file before it writes to it.
        running.until(lambda: file.exists() and file.read_text().rstrip().endswith("}"))
        yield json.loads(file.read_text())["address"]
    finally:
        for process in processes:
            process.kill()
            process.wait()
