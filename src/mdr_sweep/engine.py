"""Chunks to workers and back, on this machine or on a cluster, by Dask."""

import asyncio
from collections.abc import Iterable, Iterator
from concurrent import futures
from contextlib import contextmanager
from typing import Final

import dask
import pyarrow as pa
from distributed import Client, Future, KilledWorker, LocalCluster, wait

from mdr_sweep import chunk
from mdr_sweep.errors import SweepError
from mdr_sweep.study import Study, versions

# Chunks on their way for each worker: one that is computed, and one that waits for it.
_AHEAD: Final = 2
_SETTINGS: Final = {
    # A chunk that ends so many workers would end all of them.
    "distributed.scheduler.allowed-failures": 3,
    # The memory is bounded by the number of chunks on their way.
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.worker.memory.terminate": False,
    "distributed.comm.timeouts.connect": "60s",
    # Dask's own ones give every array back to the system as soon as it is free, and workers would
    # spend most of their time on having them again.
    "distributed.nanny.pre-spawn-environ": {
        "OMP_NUM_THREADS": 1,
        "MKL_NUM_THREADS": 1,
        "OPENBLAS_NUM_THREADS": 1,
    },
}


@contextmanager
def local(workers: int) -> Iterator[Client]:
    """Yield a client of so many workers of its own, each a process with one thread."""
    with (
        dask.config.set(_SETTINGS),
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            # Any free port: the usual one may be taken by another sweep.
            dashboard_address="127.0.0.1:0",
            silence_logs=50,
        ) as cluster,
        Client(cluster, direct_to_workers=True) as client,
    ):
        yield client


@contextmanager
def remote(address: str) -> Iterator[Client]:
    """Yield a client of the cluster whose scheduler is at the address."""
    try:
        client = Client(address)
    except OSError as error:
        raise SweepError(f"no scheduler answers at {address}: {error}") from None
    with client:
        yield client


def workers(client: Client) -> int:
    """Return how many chunks can be computed at the same time."""
    threads: dict[str, int] = client.nthreads()
    return max(sum(threads.values()), 1)


def answered(
    client: Client, study: Study, batches: Iterable[tuple[int, pa.RecordBatch]]
) -> Iterator[tuple[int, pa.RecordBatch, pa.RecordBatch]]:
    """Yield the index of each batch, the batch and its answers, as they are done.

    Never more batches are on their way than keep all workers busy, however many there are.
    """
    most = _AHEAD * workers(client)
    way: dict[Future, tuple[int, pa.RecordBatch]] = {}
    for index, batch in batches:
        sent = client.submit(answer, study, packed(batch), pure=False)
        way[sent] = index, batch
        while len(way) >= most:
            yield from _done(way)
    while way:
        yield from _done(way)


def _done(
    way: dict[Future, tuple[int, pa.RecordBatch]],
) -> Iterator[tuple[int, pa.RecordBatch, pa.RecordBatch]]:
    for future in wait(list(way), return_when="FIRST_COMPLETED").done:
        index, batch = way.pop(future)
        try:
            found = unpacked(future.result())
        except KilledWorker:
            raise SweepError(
                f"chunk {index} ended worker after worker: they may have too little memory"
            ) from None
        except ImportError as error:
            raise SweepError(f"the workers have not all that they need: {error}") from None
        except (asyncio.CancelledError, futures.CancelledError):
            raise SweepError("the scheduler is gone; what is done is kept") from None
        yield index, batch, found


def answer(study: Study, batch: bytes) -> bytes:
    """Return the answers to a batch: what a worker does."""
    if study.versions != versions():
        raise SweepError(f"the workers run {versions()}, the client {study.versions}")
    return packed(chunk.answer(study, unpacked(batch)))


def packed(batch: pa.RecordBatch) -> bytes:
    """Return a batch as bytes."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, batch.schema) as writer:
        writer.write_batch(batch)
    return bytes(sink.getvalue())


def unpacked(data: bytes) -> pa.RecordBatch:
    """Return the batch of `packed` bytes."""
    with pa.ipc.open_stream(data) as reader:
        return reader.read_next_batch()
