"""Run times of a sweep over rounded punches with one process and with two workers.

python benchmarks/sweep_scaling.py [cases] [rounds]

Every case has its own profile and all quantities of a tangential query. The times include the start
of the workers. The client and other load on the machine use part of both cores.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from sweep_ratio import swept

CASES = 1_000_000
ROUNDS = 3
TARGET = 1.7
TEMPLATE = """{"profile": {"kind": "rounded_punch"},
               "material": {"e_star": 1.15e11, "g_star": 9.5e10}}"""


def punches(cases: int) -> pa.Table:
    random = np.random.default_rng(1998)
    force = 10 ** random.uniform(-1, 3, cases)
    friction = random.uniform(0.1, 0.9, cases)
    return pa.table(
        {
            "profile.flat_radius": 10 ** random.uniform(-5, -2, cases),
            "profile.rounding_radius": 10 ** random.uniform(-3, 0, cases),
            "load.normal_force": force,
            "friction_coefficient": friction,
            "tangential.tangential_force": friction * force * random.uniform(0, 1, cases),
        }
    )


def main() -> None:
    cases = int(float(sys.argv[1])) if sys.argv[1:] else CASES
    rounds = int(sys.argv[2]) if sys.argv[2:] else ROUNDS
    with TemporaryDirectory() as name:
        folder = Path(name)
        pq.write_table(punches(cases), folder / "cases.parquet")
        (folder / "template.json").write_text(TEMPLATE)
        options = ["--table", str(folder / "cases.parquet"), "--out", str(folder / "out.parquet")]
        options += ["--template", str(folder / "template.json"), "--workers"]

        def seconds(workers: str) -> float:
            start = perf_counter()
            swept(*options, workers)
            return perf_counter() - start

        times = [(seconds("1"), seconds("2")) for _ in range(rounds)]
    ratios = [first / second for first, second in times]
    first, second = (median(column) for column in zip(*times, strict=True))
    print(f"{cases} cases: one process {first:.1f} s, two workers {second:.1f} s")
    print(f"ratio {median(ratios):.2f} (highest {max(ratios):.2f}), target >= {TARGET}")


if __name__ == "__main__":
    main()
