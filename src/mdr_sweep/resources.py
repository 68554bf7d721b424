"""Time and disk space of a sweep, extrapolated from a sample of its cases."""

from importlib import import_module
from math import log2
from time import process_time
from typing import Final, NamedTuple

import numpy as np
import pyarrow as pa

from mdr_sweep import tables, vectorized
from mdr_sweep.spec import Spec

# Time of the last sample, much longer than the overhead of a call [s].
_SAMPLE_SECONDS: Final = 0.1
# Measured time in which worker processes start and import this package [s]. A chunk takes as long,
# so that a lost worker costs little, and transfer is a small part.
START_SECONDS: Final = 2.0


class Estimate(NamedTuple):
    """Estimated resources of a sweep."""

    rows: int
    chunk: int
    """Cases in a chunk."""
    processes: int
    """Number of processes; 1 means this process, if further processes cost more time than they
    save."""
    seconds: float
    """Time on an idle machine, including the start of the workers and the writing of the result."""
    disk: float
    """Size of the chunks and the result together, which both exist at the end [bytes]."""

    def __str__(self) -> str:
        place = f"{self.processes} worker processes" if self.processes > 1 else "this process"
        return (
            f"cases    {self.rows:,}\n"
            f"chunks   {-(-self.rows // self.chunk):,} of {self.chunk:,} cases\n"
            f"time     about {self.seconds:,.1f} s ({self.seconds / 3600:,.1f} h) on an idle "
            f"machine, in {place}\n"
            f"disk     at most {self.disk / 1024**2:,.0f} MiB during the sweep\n"
        )


def estimate(spec: Spec, source: tables.Source, workers: int | None) -> Estimate:
    """Return the estimated resources of a sweep by solving samples of increasing size.

    If the number of workers is not given, all cores are used where that saves more time than the
    start of the processes takes.
    """
    cases = tables.sample(source)
    # The time of the first case includes everything that is built on first use.
    vectorized.solve(spec, cases.slice(0, 1))
    size, solving = 1, 0.0
    while solving < _SAMPLE_SECONDS:
        part = cases.take(np.arange(0, cases.num_rows, max(cases.num_rows // size, 1)))
        start = process_time()
        rows = vectorized.solve(spec, part)
        solving = process_time() - start
        if part.num_rows == cases.num_rows:
            break
        size *= 4
    start = process_time()
    tables.write(pa.BufferOutputStream(), ".parquet", [rows], {})
    writing = (process_time() - start) / part.num_rows
    solving /= part.num_rows
    processes = workers or 1
    if workers is None and source.rows * solving > 2 * START_SECONDS:
        processes = import_module("dask.system").CPU_COUNT
    start_up = START_SECONDS if processes > 1 else 0.0
    return Estimate(
        rows=source.rows,
        chunk=min(2 ** int(log2(max(START_SECONDS / solving, 1.0))), tables.ROW_GROUP),
        processes=processes,
        seconds=start_up + source.rows * (solving / processes + writing),
        disk=2 * source.rows * rows.nbytes / part.num_rows,
    )
