"""Sweeps as processes of their own, as a user starts them."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from tests.sweep.scenes import scenes, table

WAIT = 120.0


def sweep(folder: Path, *options: str, **more: Any) -> "subprocess.Popen[str]":
    """Start a sweep in a folder."""
    command = [sys.executable, "-m", "mdr_command", "sweep", *options]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True, **more)


def finished(process: "subprocess.Popen[str]") -> tuple[int, str]:
    """The exit status of a sweep and what it said."""
    _, said = process.communicate(timeout=WAIT)
    return process.returncode, said


def swept(folder: Path, *options: str, **more: Any) -> tuple[int, str]:
    """What becomes of a sweep that runs to its end."""
    return finished(sweep(folder, *options, **more))


def until(reached: Callable[[], object]) -> None:
    """Wait for something to be so."""
    end = time.monotonic() + WAIT
    while not reached():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.01)


def workers(client: int) -> list[int]:
    """The processes in which a client has its scenes answered."""
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
    """How many chunks are done."""
    return len(list(folder.joinpath(f"{result}.work").glob("*.arrow")))


def write_scenes(path: Path, count: int, kind: str = "rounded_punch") -> None:
    """Write a table of scenes that each take a fraction of a millisecond."""
    rows = scenes(kind, "tangential", count)
    pq.write_table(pa.Table.from_batches([table(rows)]), path)
