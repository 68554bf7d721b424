"""Compute processes of the server, and the queue before them.

Computations that are longer than a round trip run in a process of their own: a thread would hold
the global interpreter lock (GIL), and could not be terminated. They wait in the order of arrival
for up to `queue_seconds`, then run for up to `budget_seconds`; a single limit would terminate
computations half-way that had mainly waited. While others wait, one that takes far longer than
usual is terminated, so that a few expensive queries cannot starve the rest.
"""

import logging
from asyncio import Lock
from collections import deque
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from math import ceil
from statistics import median
from time import monotonic
from typing import TYPE_CHECKING, Any, Final, TypeVar

from anyio import CancelScope, Semaphore, create_task_group, fail_after, sleep

from mdr_core.errors import DefectError
from mdr_service import observability, problems
from mdr_service.compute_process import ComputeProcess, ProcessLostError
from mdr_service.problems import ServiceError
from mdr_service.settings import Settings
from mdr_service.transfers import Transfers

if TYPE_CHECKING:
    from anyio.abc import TaskGroup

_Result = TypeVar("_Result")

AT_ONCE_BYTES: Final = 16_384
"""Longest query that is parsed on the event loop; the worst one is rejected in 2 ms."""
AT_ONCE_BATCH_BYTES: Final = 4_096
"""Longest batch that is parsed on the event loop; the worst one is rejected in 1 ms."""
# A beat takes 75 microseconds; a process that gets no core for this time is unusable as well.
_BEAT_SECONDS: Final = 1.0
# Interval at which idle processes are checked.
_BEAT_INTERVAL: Final = 5.0
# A start takes a second or two, most of it for SciPy.
_START_SECONDS: Final = 30.0
# Pause after a failed start: short enough to recover soon, long enough not to use up a core.
_START_PAUSE: Final = 1.0
# Interval at which running computations are compared with waiting ones.
_FAIR_INTERVAL: Final = 0.25
# Part of `queue_seconds` for which a computation waits before it may displace another, and runs
# before it may be displaced.
_FAIR_SHARE: Final = 0.25
# Ratio to the usual time of a computation from which one may be displaced.
_FAIR_RATIO: Final = 3.0
# Number of completed computations whose median is the usual time: a few outliers do not matter.
_FAIR_COUNT: Final = 16

_logger: Final = logging.getLogger(__name__)


@dataclass(eq=False)
class _Job:
    """A computation that waits or runs."""

    is_query: bool = True
    """True for a query, False for a self-test."""
    since: float = field(default_factory=monotonic)
    """Time at which it began to wait or to run."""
    scope: CancelScope = field(default_factory=CancelScope)
    """Cancelled if the computation has to make room."""

    @property
    def age(self) -> float:
        """Time for which it has waited or run."""
        return monotonic() - self.since


class WorkerPool:
    """Compute processes of one server, and the queue before them."""

    def __init__(self, settings: Settings, transfers: Transfers) -> None:
        self._settings = settings
        self._transfers = transfers
        self._idle: deque[ComputeProcess] = deque()
        # One token per idle process, handed over in the order of arrival.
        self._available = Semaphore(0, fast_acquire=True)
        self._waiting: list[_Job] = []
        self._running: list[_Job] = []
        self._times: deque[float] = deque(maxlen=_FAIR_COUNT)
        self._reading = Lock()
        self._start_failed = False
        self._tasks: TaskGroup | None = None
        self._self_test: Callable[[], object] = int

    @asynccontextmanager
    async def started(self, self_test: Callable[[], object]) -> AsyncIterator[None]:
        """Start the processes, and replace those that are lost.

        A process first runs `self_test`, a function of a module, and is not used if that fails.
        """
        self._self_test = self_test
        observability.QUEUE.set_function(lambda: len(self._waiting))
        observability.PROCESSES.set_function(lambda: len(self._idle) + len(self._running))
        try:
            async with create_task_group() as tasks:
                self._tasks = tasks
                async with create_task_group() as starts:
                    for _ in range(self._settings.compute_processes):
                        starts.start_soon(self._start)
                tasks.start_soon(self._check_idle)
                tasks.start_soon(self._keep_fair)
                yield
                tasks.cancel_scope.cancel()
        finally:
            self._tasks = None
            with CancelScope(shield=True):
                for process in self._idle:
                    await process.close()

    @property
    def is_computing(self) -> bool:
        """True while a process computes."""
        return bool(self._running)

    async def run_in_process(self, function: Callable[..., _Result], *arguments: Any) -> _Result:
        """Return the result of a function of a module, computed in a process.

        Raises ServiceError if the queue is full, the wait or the computation takes too long, or
        the process is lost; besides all that the function raises.
        """
        return await self._run(_Job(), function, *arguments)

    async def check(self) -> None:
        """Run the self-test in a process; raise ServiceError if it fails or does not run soon."""
        await self._run(_Job(is_query=False), self._self_test)

    async def _run(self, job: _Job, function: Callable[..., _Result], *arguments: Any) -> _Result:
        process = await self._take_process(job)
        job.since = monotonic()
        self._running.append(job)
        try:
            with job.scope:
                result = await self._compute(process, function, *arguments)
                if job.is_query:
                    self._times.append(job.age)
                return result
        finally:
            self._running.remove(job)
            if process.usable:
                self._put_process(process)
            else:
                with CancelScope(shield=True):
                    await process.close()
                if self._tasks:
                    self._tasks.start_soon(self._start)
        observability.RESTARTS.labels("displaced").inc()
        raise self._busy("terminated: it took far longer than usual while other queries waited")

    async def _take_process(self, job: _Job) -> ComputeProcess:
        if self._start_failed and not (self._idle or self._running):
            raise _lost("no compute process could be started")
        if not self._idle and len(self._waiting) >= self._settings.queue_length:
            raise self._busy("the queue is full")
        self._waiting.append(job)
        try:
            with fail_after(self._settings.queue_seconds):
                await self._available.acquire()
        except TimeoutError:
            raise self._busy("no compute process became available") from None
        finally:
            self._waiting.remove(job)
            if record := observability.CURRENT.get():
                record.queued += job.age
        # Queries take the process used last, which has kept its tables; self-tests take turns.
        return self._idle.pop() if job.is_query else self._idle.popleft()

    def _busy(self, reason: str) -> ServiceError:
        """Return the problem of a rejected computation, to be repeated after the longest wait."""
        after = max([1, *(ceil(job.age) for job in self._waiting)])
        return ServiceError(problems.BUSY, f"{reason}; try again in {after} s", retry_after=after)

    async def _compute(
        self, process: ComputeProcess, function: Callable[..., _Result], *arguments: Any
    ) -> _Result:
        budget = self._settings.budget_seconds
        try:
            # Detects a stopped process before the computation is sent to it.
            await process.call(_BEAT_SECONDS, int)
            return await process.call(budget, function, *arguments)
        except TimeoutError:
            observability.RESTARTS.labels("time").inc()
            detail = f"the time limit of a query is {budget:g} s"
            raise ServiceError(problems.TIME_EXCEEDED, detail) from None
        except ProcessLostError:
            observability.RESTARTS.labels("lost").inc()
            raise _lost("the compute process ended or did not respond") from None

    @asynccontextmanager
    async def _room(self, size: int) -> AsyncIterator[None]:
        """Count a large result, and read one at a time, because that takes its memory twice."""
        async with self._reading:
            if record := observability.CURRENT.get():
                self._transfers.add_response(record, size)
            yield

    def _put_process(self, process: ComputeProcess) -> None:
        self._idle.append(process)
        self._available.release()

    async def _start(self, pause: float = 0.0) -> None:
        """Start a process after a pause; if that fails, try again in the background."""
        await sleep(pause)
        try:
            process = await ComputeProcess.start(_START_SECONDS, self._self_test, self._room)
        except (DefectError, OSError, ProcessLostError, ServiceError):
            _logger.exception("a compute process did not start")
            self._start_failed = True
            if self._tasks:
                self._tasks.start_soon(self._start, _START_PAUSE)
        else:
            self._start_failed = False
            self._put_process(process)

    async def _check_idle(self) -> None:
        """Find idle processes that are stopped or have ended, before a query does."""
        while True:
            await sleep(_BEAT_INTERVAL)
            for _ in range(len(self._idle)):
                with suppress(ServiceError):
                    await self.check()

    async def _keep_fair(self) -> None:
        """Terminate the youngest computation if all take far longer than usual and others wait."""
        share = _FAIR_SHARE * self._settings.queue_seconds
        while True:
            await sleep(_FAIR_INTERVAL)
            waiting = any(job.is_query and job.age > share for job in self._waiting)
            if waiting and len(self._running) == self._settings.compute_processes > 1:
                youngest = min(self._running, key=lambda job: job.age)
                if youngest.age > max(share, _FAIR_RATIO * median(self._times or [share])):
                    youngest.scope.cancel()


def _lost(detail: str) -> ServiceError:
    return ServiceError(problems.LOST, f"{detail}; try again", retry_after=1)
