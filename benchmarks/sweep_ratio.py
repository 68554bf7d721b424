"""A sweep over Mindlin scenes, Parquet to Parquet, against the bare core between two tables.

    python benchmarks/sweep_ratio.py [scenes]

Both read the same table, compute the same answers and write the same columns in the same form.
The bare one is a single call of the core in a single process. The workers are there before.
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

from mdr_core import normal, tangential
from mdr_core.profiles import Paraboloid
from mdr_sweep import command, engine
from mdr_sweep.plan import plan
from mdr_sweep.study import ANSWERS, Study, versions
from mdr_sweep.tables import PARQUET, ROW_GROUP, Table
from mdr_sweep.work import Work

if TYPE_CHECKING:
    from distributed import Client

SCENES = 1_000_000
ROUNDS = 5
TARGET = 3.0
WORKERS = 2
NAMES = ANSWERS["tangential"]


def mindlin(scenes: int) -> pa.Table:
    random = np.random.default_rng(1949)
    force = 10 ** random.uniform(-3, 1, scenes)
    friction = random.uniform(0.1, 0.9, scenes)
    e_star = 10 ** random.uniform(9, 12, scenes)
    return pa.table(
        {
            "profile.radius": 10 ** random.uniform(-3, 0, scenes),
            "material.e_star": e_star,
            "material.g_star": e_star * random.uniform(0.67, 1.0, scenes),
            "load.normal_force": force,
            "friction_coefficient": friction,
            "tangential.tangential_force": friction * force * random.uniform(0, 1, scenes),
        }
    )


def bare(source: Path, target: Path) -> None:
    table = pq.read_table(source)
    column = {name: table[name].to_numpy() for name in table.column_names}
    contact = normal.solve(
        Paraboloid(column["profile.radius"]),
        column["material.e_star"],
        normal_force=column["load.normal_force"],
    )
    pushed = tangential.solve(
        contact,
        column["material.g_star"],
        column["friction_coefficient"],
        tangential_force=column["tangential.tangential_force"],
    )
    for name in NAMES:
        own = pushed if hasattr(type(pushed), name) else contact
        table = table.append_column(name, pa.array(getattr(own, name)))
    for name in ("warning", "error"):
        table = table.append_column(name, pa.nulls(table.num_rows, pa.string()))
    words = ["regime", "warning", "error"]
    pq.write_table(table, target, row_group_size=ROW_GROUP, use_dictionary=words, **PARQUET)


def swept(client: Client, source: Path, target: Path) -> None:
    study = Study("tangential", {"profile.kind": "paraboloid"}, NAMES, (), versions())
    table = Table(source)
    cut = plan(study, ["paraboloid"], table.rows, len(NAMES) + 6, WORKERS)
    command.sweep(client, study, table, cut, Work(target))


def main() -> None:
    scenes = int(float(sys.argv[1])) if sys.argv[1:] else SCENES
    with TemporaryDirectory() as folder, engine.local(WORKERS) as client:
        source = Path(folder) / "scenes.parquet"
        pq.write_table(mindlin(scenes), source)
        ours, theirs = Path(folder) / "ours.parquet", Path(folder) / "bare.parquet"
        rounds = []
        for _ in range(ROUNDS + 1):
            start = perf_counter()
            swept(client, source, ours)
            middle = perf_counter()
            bare(source, theirs)
            rounds.append((middle - start, perf_counter() - middle))
        same = pq.read_table(ours).equals(pq.read_table(theirs))
    ratios = [one / other for one, other in rounds[1:]]
    seconds = [median(column) for column in zip(*rounds[1:], strict=True)]
    print(f"{scenes} scenes: sweep {seconds[0]:.2f} s, bare {seconds[1]:.2f} s, same table: {same}")
    print(f"ratio {median(ratios):.2f} (lowest {min(ratios):.2f}), target <= {TARGET:.0f}")


if __name__ == "__main__":
    main()
