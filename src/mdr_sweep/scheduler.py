"""Distribution of chunks over processes, or over a Dask cluster."""

import os
import signal
from collections.abc import Generator, Iterable, Iterator
from concurrent import futures
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from importlib import import_module
from itertools import chain
from multiprocessing import get_context, parent_process
from threading import Thread
from typing import Final

import pyarrow as pa

from mdr_sweep import vectorized
from mdr_sweep.spec import Spec, SweepError, versions

Chunk = tuple[int, pa.RecordBatch]
"""Index of a chunk, and its cases or the rows of the result."""
# Chunks in flight for each worker: one that is solved, and one that waits. Bounds the memory.
_AHEAD: Final = 2
# Pools lost one after the other, without a completed chunk, after which the sweep ends.
_MAX_LOST: Final = 3
_THREADS: Final = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


def in_processes(spec: Spec, chunks: Iterable[Chunk], workers: int) -> Generator[Chunk, None, None]:
    """Yield each chunk as it is completed by worker processes.

    If a worker is lost, all are replaced, and their chunks are solved again. After an interrupt
    the workers finish their chunks: one that is terminated while it returns a chunk would leave
    its pool waiting for the rest.
    """
    # More BLAS threads than cores slow each other down.
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    spawn = get_context("spawn")
    in_flight: dict[int, pa.RecordBatch] = {}
    remaining = iter(chunks)
    lost = 0
    while lost < _MAX_LOST:
        try:
            with futures.ProcessPoolExecutor(workers, spawn, _end_with_parent) as executor:
                for each in _solved(executor, workers, spec, remaining, in_flight):
                    lost = 0
                    yield each
                return
        except BrokenProcessPool:
            lost += 1
    listed = ", ".join(map(str, in_flight))
    raise SweepError(f"{lost} workers were lost in turn in chunks {listed}; memory may be short")


def on_cluster(spec: Spec, chunks: Iterable[Chunk], address: str) -> Generator[Chunk, None, None]:
    """Yield each chunk as it is completed by the workers of a Dask scheduler."""
    distributed = import_module("distributed")
    try:
        with distributed.Client(address) as client, client.get_executor(pure=False) as executor:
            workers = max(sum(client.nthreads().values()), 1)
            yield from _solved(executor, workers, spec, chunks, {})
    except distributed.KilledWorker as error:
        raise SweepError(f"several workers were lost on one chunk: {error}") from None
    except ImportError as error:
        raise SweepError(f"a worker lacks a package: {error}") from None
    except (OSError, futures.CancelledError) as error:
        raise SweepError(f"the Dask scheduler {address} does not respond: {error}") from None


def solve(spec: Spec, expected: dict[str, str], batch: bytes) -> bytes:
    """Return the solved rows of a batch, in a worker that has the expected versions."""
    if versions() != expected:
        raise SweepError(f"a worker has {versions()}, the client {expected}")
    return _to_bytes(vectorized.solve(spec, _from_bytes(batch)))


def _solved(
    executor: futures.Executor,
    workers: int,
    spec: Spec,
    chunks: Iterable[Chunk],
    in_flight: dict[int, pa.RecordBatch],
) -> Iterator[Chunk]:
    """Solve the chunks in flight, which a lost pool has left, and then the others."""
    pending: dict[futures.Future[bytes], int] = {}

    def completed() -> Iterator[Chunk]:
        for future in futures.wait(pending, return_when=futures.FIRST_COMPLETED).done:
            rows, index = _from_bytes(future.result()), pending.pop(future)
            del in_flight[index]
            yield index, rows

    expected = versions()
    for index, batch in chain(list(in_flight.items()), chunks):
        in_flight[index] = batch
        with _interrupts_blocked():
            pending[executor.submit(solve, spec, expected, _to_bytes(batch))] = index
        while len(pending) >= _AHEAD * workers:
            yield from completed()
    while pending:
        yield from completed()


def _to_bytes(batch: pa.RecordBatch) -> bytes:
    """Return a batch as an Arrow stream; the pickle of a slice would hold its whole origin."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, batch.schema) as writer:
        writer.write_batch(batch)
    return bytes(sink.getvalue())


def _from_bytes(data: bytes) -> pa.RecordBatch:
    with pa.ipc.open_stream(data) as reader:
        return reader.read_next_batch()


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block SIGINT for this process and those started here, which only this one then handles."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _end_with_parent() -> None:
    """End this worker when its parent is killed, which the queue of a pool does not detect."""

    def end() -> None:
        if parent := parent_process():
            parent.join()
        os._exit(1)

    Thread(target=end, daemon=True).start()
