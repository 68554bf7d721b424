"""Where a query runs, so that a long one does not keep the short ones waiting.

A short one is answered at once: that takes less time than to hand it to a process and back. A
longer one runs in a process of its own. In a thread it would share the interpreter's lock with all
the others, and could not be stopped.

There are two clocks. One runs while a query waits for a process: what would wait too long is
refused, soonest before it waits at all. The other runs from the moment it has one: what takes
longer than its budget is ended with its process. One clock for both would end, half-way, work
that had only been kept waiting.
"""

import logging
import os
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from math import ceil
from time import monotonic
from typing import TYPE_CHECKING, Any, Final, TypeVar, TypeVarTuple, Unpack

from anyio import (
    BrokenWorkerProcess,
    CapacityLimiter,
    WouldBlock,
    create_task_group,
    fail_after,
    move_on_after,
    sleep,
    to_process,
)

from mdr_core.errors import DefectError
from mdr_service import apart, problems, watch
from mdr_service.problems import ServiceError
from mdr_service.settings import SETTINGS, Settings

if TYPE_CHECKING:
    from anyio.abc import TaskGroup

_Arguments = TypeVarTuple("_Arguments")
_Result = TypeVar("_Result")

# What takes less is answered at once, on the loop that serves all clients.
AT_ONCE_SECONDS: Final = 2e-3
# Estimates are good to a factor: this much of a clock is kept for those that are too low.
_MARGIN: Final = 2
# Of the last one, beside those before.
_FORGETTING: Final = 0.2
# A process without work for some minutes would be ended, and be missed later.
_WARM_SECONDS: Final = 60

_logger: Final = logging.getLogger(__name__)


class Compute:
    """The compute processes of one server, and the queue before them."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._slots = CapacityLimiter(settings.compute_processes)
        # Whoever holds a slot has a process to itself: here nobody waits.
        self._processes = CapacityLimiter(settings.compute_processes)
        self._waiting: dict[object, float] = {}
        """Seconds of work, by who waits."""
        self._ends: dict[object, float] = {}
        """When work is expected to end, by who has a slot."""
        self._pace = 1.0
        """How many times as long as estimated the slowest of the last took: others may use the
        machine."""
        self._tasks: TaskGroup | None = None
        self.slowness = 1.0
        """How many times as long this machine takes as that of the rates."""

    @property
    def most_seconds(self) -> float:
        """The longest work that is tried, in seconds of the machine of the rates."""
        return self._settings.budget_seconds / _MARGIN / self.slowness

    @asynccontextmanager
    async def ready(self) -> AsyncIterator[None]:
        """Have the processes ready, and keep them so."""
        # They inherit it: more threads than cores would wait for each other.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        self.slowness = apart.slowness()
        async with create_task_group() as tasks:
            async with create_task_group() as first:
                for _ in range(self._settings.compute_processes):
                    first.start_soon(self._warm)
            watch.PROCESSES.set(self._settings.compute_processes)
            self._tasks = tasks
            tasks.start_soon(self._keep_warm)
            try:
                yield
            finally:
                self._tasks = None
                tasks.cancel_scope.cancel()

    async def run(
        self,
        seconds: float,
        work: Callable[[Unpack[_Arguments]], _Result],
        *arguments: *_Arguments,
    ) -> _Result:
        """Return what `work` returns; it takes so many seconds on the machine of the rates.

        Raises ServiceError where it would have to wait too long, takes too long, or is lost with
        its process. `work` is a function of a module: it may run in another process.
        """
        expected = seconds * self.slowness
        if watched := watch.current():
            watched.cost += expected
        if expected <= AT_ONCE_SECONDS:
            return work(*arguments)
        return await self.run_apart(expected, work, *arguments)

    def require_room(self) -> None:
        """Raise ServiceError where no process and no place in the queue is free.

        What is certain to need one is refused before anything is done about it.
        """
        if not self._slots.available_tokens and len(self._waiting) >= self._settings.queue_length:
            raise _busy(self._expected_wait())

    async def run_apart(
        self,
        expected: float,
        work: Callable[[Unpack[_Arguments]], _Result],
        *arguments: *_Arguments,
    ) -> _Result:
        """Return what `work` returns from a process, however short it is."""
        holder = object()
        await self._enter(holder, expected)
        lost = True
        try:
            found = await self._outcome(expected, work, arguments)
            lost = False
        finally:
            self._leave(holder, lost=lost)
        if found.refusal:
            raise ServiceError(*found.refusal)
        if found.defect:
            raise DefectError(f"in a compute process: {found.defect}")
        result: _Result = found.value
        return result

    async def _outcome(
        self, expected: float, work: Callable[..., Any], arguments: tuple[Any, ...]
    ) -> apart.Outcome:
        start = monotonic()
        try:
            with fail_after(self._settings.budget_seconds):
                found = await self._apart(apart.outcome, work, arguments)
        except TimeoutError:
            watch.RESTARTS.labels("time").inc()
            raise ServiceError(
                problems.TIME_EXCEEDED,
                f"at most {self._settings.budget_seconds:g} s are given to one request",
            ) from None
        except BrokenWorkerProcess:
            watch.RESTARTS.labels("ended").inc()
            raise ServiceError(problems.LOST, "try again", retry_after=1) from None
        ratio = (monotonic() - start) / expected
        watch.ESTIMATES.observe(ratio)
        self._pace = max(ratio, self._pace + _FORGETTING * (ratio - self._pace))
        return found

    async def _apart(
        self, work: Callable[[Unpack[_Arguments]], _Result], *arguments: *_Arguments
    ) -> _Result:
        return await to_process.run_sync(
            work, *arguments, cancellable=True, limiter=self._processes
        )

    async def _enter(self, holder: object, expected: float) -> None:
        """Wait for a slot, unless that would take too long."""
        try:
            self._slots.acquire_on_behalf_of_nowait(holder)
        except WouldBlock:
            await self._wait(holder, expected)
        self._ends[holder] = monotonic() + expected

    async def _wait(self, holder: object, expected: float) -> None:
        most = self._settings.queue_seconds
        wait = self._expected_wait()
        if len(self._waiting) >= self._settings.queue_length or wait > most / _MARGIN:
            raise _busy(wait)
        self._waiting[holder] = expected
        watch.QUEUE.set(len(self._waiting))
        start = monotonic()
        try:
            with move_on_after(most) as waited:
                await self._slots.acquire_on_behalf_of(holder)
        finally:
            del self._waiting[holder]
            watch.QUEUE.set(len(self._waiting))
            if watched := watch.current():
                watched.queued += monotonic() - start
        if waited.cancelled_caught:
            raise _busy(self._expected_wait())

    def _expected_wait(self) -> float:
        """Return how long the work ahead is expected to take."""
        now = monotonic()
        running = sum(max(end - now, 0.0) for end in self._ends.values())
        ahead = running + sum(self._waiting.values())
        return ahead * max(self._pace, 1.0) / self._settings.compute_processes

    def _leave(self, holder: object, *, lost: bool) -> None:
        """Give the slot to the next, with a process that is ready."""
        del self._ends[holder]
        if lost and self._tasks:
            watch.PROCESSES.dec()
            self._tasks.start_soon(self._replace, holder)
        else:
            self._slots.release_on_behalf_of(holder)

    async def _replace(self, holder: object) -> None:
        try:
            await self._warm()
            watch.PROCESSES.inc()
        except BrokenWorkerProcess:
            # The next that has the slot starts one.
            _logger.exception("a compute process did not start")
        finally:
            self._slots.release_on_behalf_of(holder)

    async def _warm(self) -> None:
        """Have one process load what it needs."""
        await self._apart(apart.prepare)

    async def _keep_warm(self) -> None:
        while True:
            await sleep(_WARM_SECONDS)
            async with create_task_group() as tasks:
                for _ in range(int(self._slots.available_tokens)):
                    holder = object()
                    self._slots.acquire_on_behalf_of_nowait(holder)
                    self._ends[holder] = monotonic()
                    tasks.start_soon(self._touch, holder)

    async def _touch(self, holder: object) -> None:
        try:
            await self._warm()
        except BrokenWorkerProcess:
            watch.RESTARTS.labels("ended").inc()
        finally:
            self._leave(holder, lost=False)


def _busy(wait: float) -> ServiceError:
    after = max(1, ceil(wait))
    return ServiceError(problems.BUSY, f"try again in {after} s", retry_after=after)


COMPUTE: Final = Compute(SETTINGS)
