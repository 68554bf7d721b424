"""Distribution of chunks over the workers of a Dask scheduler, on this machine or a cluster."""

import logging
from collections.abc import Generator, Iterable
from concurrent.futures import CancelledError
from importlib import import_module
from typing import Final

import pyarrow as pa

from mdr_sweep import vectorized
from mdr_sweep.spec import Spec, SweepError, versions
from mdr_sweep.tables import from_bytes, to_bytes

Chunk = tuple[int, pa.RecordBatch]
"""Index of a chunk, and its cases or the rows of the result."""
# Number of chunks in flight for each worker: one that is solved, and one that waits. It bounds the
# memory.
_AHEAD: Final = 2
# Environment of the workers on this machine. BLAS threads slow each other down if there are more
# threads than cores. Dask's default memory trimming is left out, because it makes allocation slower
# than the computation.
_ENVIRONMENT: Final = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), 1
)
_SETTINGS: Final = {
    "distributed.nanny.pre-spawn-environ": _ENVIRONMENT,
    # Workers ignore an interrupt from the terminal; the client handles it and closes its workers.
    "distributed.worker.preload": ["import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"],
    # Dask's warning about large chunks is suppressed, because each chunk is sent only once.
    "distributed.admin.large-graph-warning-threshold": "1 GB",
}


def in_workers(
    spec: Spec, chunks: Iterable[Chunk], address: str | None, processes: int
) -> Generator[Chunk, None, None]:
    """Yield each chunk as workers complete it; Dask repeats the chunks of lost workers.

    Parameters
    ----------
    spec : the sweep.
    chunks : index and cases of each chunk.
    address : address of a Dask scheduler; None to start workers on this machine.
    processes : number of workers to start.
    """
    distributed = import_module("distributed")
    import_module("dask").config.set(_SETTINGS)
    # Workers that are closed while they report write tracebacks; relevant errors are raised here.
    local = {
        "n_workers": processes,
        "threads_per_worker": 1,
        "dashboard_address": None,
        "silence_logs": logging.CRITICAL,
    }
    try:
        with distributed.Client(**({"address": address} if address else local)) as client:
            limit = _AHEAD * max(sum(client.nthreads().values()), 1)
            solved = distributed.as_completed(with_results=True)
            for index, batch in chunks:
                work = spec, versions(), index, to_bytes(batch)
                solved.add(client.submit(solve, *work, pure=False))
                if solved.count() >= limit:
                    yield next(solved)[1]
            for _, chunk in solved:
                yield chunk
    except distributed.KilledWorker as error:
        raise SweepError(f"several workers were lost on one chunk: {error}") from None
    except ImportError as error:
        raise SweepError(f"a worker lacks a package: {error}") from None
    except (OSError, CancelledError) as error:
        place = address or "of this machine"
        raise SweepError(f"the Dask scheduler {place} does not respond: {error}") from None


def solve(spec: Spec, expected: dict[str, str], index: int, batch: bytes) -> Chunk:
    """Return a solved chunk, in a worker.

    Parameters
    ----------
    spec : the sweep.
    expected : versions of the packages, which the worker must have.
    index : number of the chunk.
    batch : cases of the chunk as an Arrow stream.
    """
    if versions() != expected:
        raise SweepError(f"a worker has {versions()}, the client {expected}")
    return index, vectorized.solve(spec, from_bytes(batch))
