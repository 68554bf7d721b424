"""Sweeps in subprocesses."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from tests.sweep.cases import random_cases, table

WAIT = 120.0


def sweep(
    folder: Path, *options: str, prepare: Callable[[], object] = int
) -> "subprocess.Popen[str]":
    """Start a sweep in a folder, with the default SIGINT handler."""
    command = [sys.executable, "-m", "mdr_command", "sweep", *options]

    def before() -> None:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        prepare()

    return subprocess.Popen(
        command,
        cwd=folder,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=before,  # noqa: PLW1509 -- no other thread holds a lock
    )


def finished(process: "subprocess.Popen[str]") -> tuple[int, str]:
    """Return the exit status of a sweep and its standard error."""
    _, stderr = process.communicate(timeout=WAIT)
    return process.returncode, stderr


def swept(folder: Path, *options: str, prepare: Callable[[], object] = int) -> tuple[int, str]:
    """Run a sweep and return its exit status and its standard error."""
    return finished(sweep(folder, *options, prepare=prepare))


def until(condition: Callable[[], object]) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + WAIT
    while not condition():
        assert time.monotonic() < end, "timeout"
        time.sleep(0.01)


def workers(client: int) -> list[int]:
    """Return the worker processes of a sweep."""
    threads = Path(f"/proc/{client}/task").iterdir()
    children = [child for one in threads for child in (one / "children").read_text().split()]
    return [
        int(child)
        for child in children
        if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()
    ]


def kill(process: int) -> None:
    os.kill(process, signal.SIGKILL)


def chunks(folder: Path, result: str) -> int:
    """Return the number of completed chunks."""
    return len(list(folder.joinpath(f"{result}.work").glob("*.arrow")))


def write_cases(path: Path, count: int, kind: str = "rounded_punch") -> None:
    """Write a table of cases."""
    rows = random_cases(kind, "tangential", count)
    pq.write_table(pa.Table.from_batches([table(rows)]), path)
