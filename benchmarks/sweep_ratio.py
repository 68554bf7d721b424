"""CPU time of a sweep over Mindlin cases, Parquet to Parquet, relative to the bare core.

python benchmarks/sweep_ratio.py [cases]

Both read the same table, compute the same quantities and write the same columns. The bare version
is one call of the core. The sweep runs as `mdr sweep` in this process, and its time includes the
estimate.
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from mdr_core import normal, tangential
from mdr_core.profiles import Paraboloid
from mdr_sweep import command, tables
from mdr_sweep.spec import QUANTITIES

CASES = 1_000_000
ROUNDS = 5
TARGET = 1.8
NAMES = QUANTITIES["tangential"]


def mindlin(cases: int) -> pa.Table:
    random = np.random.default_rng(1949)
    force = 10 ** random.uniform(-3, 1, cases)
    friction = random.uniform(0.1, 0.9, cases)
    e_star = 10 ** random.uniform(9, 12, cases)
    return pa.table(
        {
            "profile.radius": 10 ** random.uniform(-3, 0, cases),
            "material.e_star": e_star,
            "material.g_star": e_star * random.uniform(0.67, 1.0, cases),
            "load.normal_force": force,
            "friction_coefficient": friction,
            "tangential.tangential_force": friction * force * random.uniform(0, 1, cases),
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
    partial = tangential.solve(
        contact,
        column["material.g_star"],
        column["friction_coefficient"],
        tangential_force=column["tangential.tangential_force"],
    )
    for name in NAMES:
        own = partial if hasattr(type(partial), name) else contact
        table = table.append_column(name, pa.array(getattr(own, name)))
    for name in ("warning", "error"):
        table = table.append_column(name, pa.nulls(table.num_rows, pa.string()))
    tables.write(target, ".parquet", table.to_batches(), {})


def swept(*options: str) -> None:
    parser = ArgumentParser()
    command.declare(parser)
    if command.run(parser.parse_args(["tangential", "--overwrite", *options])):
        sys.exit("the sweep failed")


def main() -> None:
    cases = int(float(sys.argv[1])) if sys.argv[1:] else CASES
    with TemporaryDirectory() as name:
        folder = Path(name)
        source, template = folder / "cases.parquet", folder / "template.json"
        pq.write_table(mindlin(cases), source)
        template.write_text('{"profile": {"kind": "paraboloid"}}')
        swept_table, bare_table = folder / "ours.parquet", folder / "bare.parquet"
        options = ("--table", str(source), "--template", str(template), "--out", str(swept_table))
        options += ("--workers", "1")
        rounds = []
        for _ in range(ROUNDS + 1):
            start = process_time()
            swept(*options)
            middle = process_time()
            bare(source, bare_table)
            rounds.append((middle - start, process_time() - middle))
        columns = [*mindlin(1).column_names, *NAMES]
        same = pq.read_table(swept_table, columns=columns).equals(
            pq.read_table(bare_table, columns=columns)
        )
    ratios = [one / other for one, other in rounds[1:]]
    seconds = [median(column) for column in zip(*rounds[1:], strict=True)]
    print(f"{cases} cases: sweep {seconds[0]:.2f} s, bare {seconds[1]:.2f} s, same numbers: {same}")
    print(f"ratio {median(ratios):.2f} (lowest {min(ratios):.2f}), target <= {TARGET}")


if __name__ == "__main__":
    main()
