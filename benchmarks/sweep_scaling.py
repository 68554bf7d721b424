"""Scenes of rounded punches on one worker and on two.

    python benchmarks/sweep_scaling.py [scenes] [rounds]

Every scene has a profile of its own and all answers of a tangential query. The workers are there
before. What else the machine does, and the process that hands out the chunks, takes its share of
the second worker's processor.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from mdr_sweep import command, engine
from mdr_sweep.plan import plan
from mdr_sweep.study import ANSWERS, Study, versions
from mdr_sweep.tables import Table
from mdr_sweep.work import Work

if TYPE_CHECKING:
    from distributed import Client

SCENES = 1_000_000
ROUNDS = 3
TARGET = 1.7
NAMES = ANSWERS["tangential"]


def punches(scenes: int) -> pa.Table:
    random = np.random.default_rng(1998)
    force = 10 ** random.uniform(-1, 3, scenes)
    friction = random.uniform(0.1, 0.9, scenes)
    return pa.table(
        {
            "profile.flat_radius": 10 ** random.uniform(-5, -2, scenes),
            "profile.rounding_radius": 10 ** random.uniform(-3, 0, scenes),
            "load.normal_force": force,
            "friction_coefficient": friction,
            "tangential.tangential_force": friction * force * random.uniform(0, 1, scenes),
        }
    )


def seconds(client: Client, source: Path, target: Path) -> float:
    constants = {
        "profile.kind": "rounded_punch",
        "material.e_star": 1.15e11,
        "material.g_star": 9.5e10,
    }
    study = Study("tangential", constants, NAMES, (), versions())
    table = Table(source)
    cut = plan(study, ["rounded_punch"], table.rows, len(NAMES) + 5, 1)
    start = perf_counter()
    command.sweep(client, study, table, cut, Work(target))
    return perf_counter() - start


def main() -> None:
    scenes = int(float(sys.argv[1])) if sys.argv[1:] else SCENES
    rounds = int(sys.argv[2]) if sys.argv[2:] else ROUNDS
    with TemporaryDirectory() as name, engine.local(1) as one, engine.local(2) as two:
        source, target = Path(name) / "scenes.parquet", Path(name) / "answers.parquet"
        warm = Path(name) / "few.parquet"
        pq.write_table(punches(scenes), source)
        pq.write_table(punches(10_000), warm)
        for client in (one, two):
            seconds(client, warm, target)
        times = [
            (seconds(one, source, target), seconds(two, source, target)) for _ in range(rounds)
        ]
    ratios = [first / second for first, second in times]
    first, second = (median(column) for column in zip(*times, strict=True))
    print(f"{scenes} scenes: one worker {first:.1f} s, two workers {second:.1f} s")
    print(f"ratio {median(ratios):.2f} (highest {max(ratios):.2f}), target >= {TARGET}")


if __name__ == "__main__":
    main()
