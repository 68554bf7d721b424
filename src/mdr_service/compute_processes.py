"""Compute processes of the server: their queue, their handles, and the loop that they run.

Computations that are longer than a round trip run in compute processes: a thread would hold the
global interpreter lock (GIL), and could not be terminated. They wait for up to `queue_seconds`,
then run for up to `budget_seconds`; a single limit would terminate computations that have mainly
waited. Computations of one client start in the order of arrival. Among several clients the next is
the one that occupies the fewest processes. A client that occupies several processes gives up the
last of them while another client waits.

Calls and outcomes are pickled, and preceded by their length.
"""

import logging
import os
import pickle
import signal
import struct
import sys
import threading
import traceback
from asyncio import (
    CancelledError,
    Event,
    Future,
    StreamReader,
    StreamWriter,
    create_subprocess_exec,
    create_task,
    gather,
    sleep,
    subprocess,
    timeout,
    wait,
)
from collections import Counter
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from math import ceil
from queue import SimpleQueue
from time import monotonic
from typing import Any, Final, Self, TypeVar, cast

from mdr_core.errors import DefectError
from mdr_service import observability, problems
from mdr_service.problems import ServiceError
from mdr_service.settings import Settings

_Result = TypeVar("_Result")

# A start takes a second or two, most of it for SciPy.
_START_SECONDS: Final = 30.0
# Part of `queue_seconds` for which a computation waits before it displaces another one.
_FAIR_SHARE: Final = 0.25
# Pause after a failure: short enough to recover soon, long enough not to use up a core.
_PAUSE: Final = 1.0
# Each message is preceded by its length.
_HEAD: Final = struct.Struct("Q")
# With fewer cores than processes, the event loop has priority.
_NICENESS: Final = 5

_logger: Final = logging.getLogger(__name__)


class ComputeProcess:
    """Handle of a compute process, which is killed if a call does not end properly."""

    def __init__(self, process: subprocess.Process) -> None:
        self._process = process
        self._calls = cast("StreamWriter", process.stdin)
        self._outcomes = cast("StreamReader", process.stdout)
        self.ended = create_task(process.wait())
        """Exit status, once the process has ended."""
        self.usable = True
        self.reason_if_ended = "start"
        """Reason to report if the process ends, unless another one is known."""

    @classmethod
    async def start(cls) -> Self:
        """Start a process; raise OSError if the system cannot."""
        # BLAS threads slow each other down if there are more threads than cores. The process finds
        # modules on the search path of the server.
        environment = {"OPENBLAS_NUM_THREADS": "1", **os.environ}
        environment["PYTHONPATH"] = os.pathsep.join(sys.path)
        command = (sys.executable, "-P", "-c", f"from {__name__} import serve; serve()")
        pipe = subprocess.PIPE
        return cls(await create_subprocess_exec(*command, env=environment, stdin=pipe, stdout=pipe))

    async def call(self, seconds: float, function: Callable[..., object], *arguments: Any) -> Any:
        """Return the result of a function of a module, or the exception that it raised.

        An exception raised here concerns the process, which is killed: TimeoutError if the function
        takes longer than `seconds`, others if the process ends.
        """
        message = pickle.dumps((function, arguments))
        try:
            async with timeout(seconds):
                self._calls.writelines((_HEAD.pack(len(message)), message))
                await self._calls.drain()
                (length,) = _HEAD.unpack(await self._outcomes.readexactly(_HEAD.size))
                # Unpickling is safe: the other end of the pipe is the server's own code.
                return pickle.loads(await self._outcomes.readexactly(length))  # noqa: S301
        except BaseException:
            self.kill()
            raise

    def kill(self) -> None:
        """Terminate the process at once."""
        self.usable = False
        with suppress(ProcessLookupError):
            self._process.kill()


@dataclass(eq=False)
class _Job:
    """A computation that waits or runs."""

    client: str
    """Address of the client."""
    since: float = field(default_factory=monotonic)
    """Time at which the computation began to wait."""


class ComputePool:
    """Compute processes of one server, and the queue before them."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._processes: set[ComputeProcess] = set()
        self._idle: list[ComputeProcess] = []
        # Each computation with the process in which it runs or will run, in the order of arrival.
        self._waiting: dict[_Job, Future[ComputeProcess]] = {}
        self._running: dict[_Job, ComputeProcess] = {}
        self._supervised = False
        # Set once every process has started, or one has ended or could not start.
        self._settled = Event()

    @asynccontextmanager
    async def started(self, self_test: Callable[[], object]) -> AsyncIterator[None]:
        """Start the processes, and replace those that end.

        A process first runs `self_test`, a function of a module, and is not used if the test fails.
        """
        observability.QUEUE.set_function(lambda: len(self._waiting))
        observability.PROCESSES.set_function(lambda: sum(each.usable for each in self._processes))
        self._supervised = True
        numbers = range(self._settings.compute_processes)
        keepers = [create_task(self._keep_process(self_test)) for _ in numbers]
        try:
            await self._settled.wait()
            yield
        finally:
            self._supervised = False
            for each in keepers:
                each.cancel()
            await gather(*keepers, return_exceptions=True)

    async def _keep_process(self, self_test: Callable[[], object]) -> None:
        """Start one process after the other."""
        while True:
            try:
                await self._lend_process(self_test)
                self._settled.set()
            except Exception:
                _logger.exception("compute process failed")
                self._settled.set()
                await sleep(_PAUSE)

    async def _lend_process(self, self_test: Callable[[], object]) -> None:
        """Start a process, assign it to computations, and count its end, for any reason."""
        process = await ComputeProcess.start()
        try:
            _raised(await process.call(_START_SECONDS, self_test))
            process.reason_if_ended = "lost"
            self._processes.add(process)
            self._offer(process)
            if len(self._processes) == self._settings.compute_processes:
                self._settled.set()
            await wait([process.ended])
        finally:
            self._processes.discard(process)
            if process in self._idle:
                self._idle.remove(process)
            process.kill()
            status = await process.ended
            if self._supervised:
                reason = process.reason_if_ended
                observability.RESTARTS.labels(reason).inc()
                _logger.warning("compute process ended with status %d: %s", status, reason)

    def _offer(self, process: ComputeProcess) -> None:
        """Give an idle process to the first computation of the client that occupies the fewest."""
        if not process.usable:
            return
        if not self._waiting:
            self._idle.append(process)
            return
        running = Counter(job.client for job in self._running)
        job = min(self._waiting, key=lambda each: running[each.client])
        self._waiting.pop(job).set_result(process)

    async def run_in_process(
        self, function: Callable[..., _Result], *arguments: Any, seconds: float | None = None
    ) -> _Result:
        """Return the result of a function of a module, computed in a process.

        `seconds` limits the time of the computation, by default to `budget_seconds`.

        Raises ServiceError if the queue is full, the wait or the computation takes too long, or the
        process is lost; and any exception that the function raises.
        """
        record = observability.CURRENT.get()
        job = _Job(record.client if record else "")
        try:
            process = await self._take_process(job)
        finally:
            if record:
                record.queued += monotonic() - job.since
        self._running[job] = process
        limit = seconds or self._settings.budget_seconds
        try:
            outcome = await process.call(limit, function, *arguments)
        except TimeoutError:
            process.reason_if_ended = "time"
            detail = f"the time limit is {limit:g} s"
            raise ServiceError(problems.TIME_EXCEEDED, detail) from None
        except Exception as error:
            # Every exception here means that the process is lost, and affects nothing else.
            process.kill()
            if process.reason_if_ended == "displaced":
                reason = "terminated: another client waited, and this one computed more"
                raise self._busy(reason) from None
            raise _lost("the compute process ended") from error
        finally:
            del self._running[job]
            self._offer(process)
        return cast("_Result", _raised(outcome))

    async def _take_process(self, job: _Job) -> ComputeProcess:
        if not self._supervised:
            raise _lost("compute processes are no longer replaced")
        if self._idle:
            # The process used last has kept its tables.
            return self._idle.pop()
        turn = self._waiting[job] = Future[ComputeProcess]()
        if len(self._waiting) > self._settings.queue_length:
            # The client with the most computations in the queue gives up its last one.
            counts = Counter(each.client for each in self._waiting)
            last = max(self._waiting, key=lambda each: (counts[each.client], each.since))
            self._waiting.pop(last).set_exception(self._busy("the queue is full"))
        share = _FAIR_SHARE * self._settings.queue_seconds
        try:
            await wait([turn], timeout=share)
            if not turn.done():
                self._displace(job)
            await wait([turn], timeout=self._settings.queue_seconds - share)
        except CancelledError:
            if turn.done() and not turn.exception():
                self._offer(turn.result())
            raise
        finally:
            self._waiting.pop(job, None)
        if turn.done():
            return turn.result()
        if len(self._processes) < self._settings.compute_processes:
            raise _lost("a compute process has ended and is not replaced yet")
        raise self._busy("no compute process became available")

    def _displace(self, waiting: _Job) -> None:
        """Terminate the last computation of a client that has two more than the waiting one."""
        running = Counter(job.client for job in self._running)
        last = max(self._running, key=lambda job: (running[job.client], job.since), default=None)
        if last and running[last.client] > running[waiting.client] + 1:
            self._running[last].reason_if_ended = "displaced"
            self._running[last].kill()

    def _busy(self, reason: str) -> ServiceError:
        """Return the problem of a rejected computation, to be retried after the longest wait."""
        after = max([1, *(ceil(monotonic() - job.since) for job in self._waiting)])
        return ServiceError(problems.BUSY, f"{reason}; try again in {after} s", retry_after=after)


def _raised(outcome: object) -> object:
    """Return a result; raise it if it is the exception of a function."""
    if isinstance(outcome, Exception):
        raise outcome
    return outcome


def _lost(detail: str) -> ServiceError:
    return ServiceError(problems.LOST, f"{detail}; try again", retry_after=1)


def serve() -> None:
    """Compute until the server ends or closes the pipe; then no client waits for a result."""
    # A signal to the process group is left to the server, which first completes its requests.
    for each in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN)
    os.nice(_NICENESS)
    calls = SimpleQueue[bytes]()
    threading.Thread(target=_receive, args=(calls,), daemon=True).start()
    outcomes = os.fdopen(os.dup(1), "wb")
    # The pipe is for outcomes alone: printed text goes to standard error.
    os.dup2(2, 1)
    observability.configure_logging()
    while True:
        content = pickle.dumps(_attempt(calls.get()))
        outcomes.writelines((_HEAD.pack(len(content)), content))
        outcomes.flush()


def _attempt(text: bytes) -> Any:
    """Return the result of a call, or an exception that can be pickled."""
    try:
        # Unpickling is safe: the other end of the pipe is the server's own code.
        function, arguments = pickle.loads(text)  # noqa: S301
        return function(*arguments)
    except problems.FAILURES as error:
        return problems.to_problem(error)
    except Exception:  # noqa: BLE001 -- the server logs it and responds
        return DefectError(f"in a compute process: {traceback.format_exc()}")


def _receive(calls: SimpleQueue[bytes]) -> None:
    """Receive calls; end the process, even during a computation, when the pipe closes."""
    pipe = sys.stdin.buffer
    while head := pipe.read(_HEAD.size):
        calls.put(pipe.read(*_HEAD.unpack(head)))
    os._exit(0)
