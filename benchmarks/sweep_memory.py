"""Peak memory of all processes of a sweep; shared pages count once per process.

python benchmarks/sweep_memory.py [cases]
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, sleep

import psutil
import pyarrow.parquet as pq
from sweep_ratio import mindlin

CASES = 10_000_000
PART = 1_000_000
TARGET = 1024.0
MIB = 1024**2


def resident_memory(process: psutil.Process) -> float:
    """Return the resident memory of a process and all its children [MiB]."""
    total = 0.0
    for one in (process, *process.children(recursive=True)):
        try:
            total += one.memory_info().rss / MIB
        except psutil.NoSuchProcess:
            continue
    return total


def write_cases(path: Path, cases: int) -> None:
    part = mindlin(min(cases, PART))
    with pq.ParquetWriter(path, part.schema) as writer:
        for start in range(0, cases, PART):
            writer.write_table(part.slice(0, min(PART, cases - start)))


def main() -> None:
    cases = int(float(sys.argv[1])) if sys.argv[1:] else CASES
    with TemporaryDirectory() as name:
        folder = Path(name)
        write_cases(folder / "cases.parquet", cases)
        (folder / "template.json").write_text('{"profile": {"kind": "paraboloid"}}')
        command = [sys.executable, "-m", "mdr_command", "sweep", "tangential"]
        command += ["--workers", "2", "--table", "cases.parquet", "--template", "template.json"]
        start = perf_counter()
        process = psutil.Popen([*command, "--out", "answers.parquet"], cwd=folder)
        most = 0.0
        while process.poll() is None:
            most = max(most, resident_memory(process))
            sleep(0.05)
        seconds = perf_counter() - start
        size = (folder / "answers.parquet").stat().st_size / MIB
    print(f"{cases} cases in {seconds:.0f} s, {size:.0f} MiB of results")
    print(f"at most {most:.0f} MiB in all processes, target <= {TARGET:.0f}")


if __name__ == "__main__":
    main()
