"""Time limits, the queue and ends of compute processes do not affect other requests."""

import os
import signal
import struct
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from functools import partial
from math import ceil
from pathlib import Path

import anyio
import pytest
from anyio.from_thread import start_blocking_portal

from mdr_core.errors import AccuracyError, DefectError, InputError
from mdr_service import observability, problems
from mdr_service.compute_processes import ComputePool, ComputeProcess
from mdr_service.problems import ServiceError
from mdr_service.settings import Settings

pytestmark = [pytest.mark.long, pytest.mark.alone]

ONE = Settings(
    compute_processes=1,
    queue_length=1,
    queue_seconds=60.0,
    budget_seconds=60.0,
)
HASTY = ONE.model_copy(update={"queue_seconds": 0.2})
PATIENCE = 30.0

Test = Callable[[ComputePool], Awaitable[None]]
Shared = Callable[[Test], None]


def start_record(client: str = "") -> observability.RequestRecord:
    """Start the record of a request."""
    record = observability.RequestRecord("id", "GET", client)
    observability.CURRENT.set(record)
    return record


def process_exists(number: int) -> bool:
    return Path(f"/proc/{number}").exists()


def own_process() -> int:
    return os.getpid()


def sleep_for(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


def until(path: Path) -> int:
    """Return once the file exists."""
    while not path.exists():
        time.sleep(0.01)
    return os.getpid()


def kill_itself() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def release(path: Path) -> None:
    path.touch()


def die_unless(path: Path) -> None:
    if not path.exists():
        kill_itself()


def print_something() -> int:
    os.write(1, b"on standard output")
    return os.getpid()


def wrong() -> None:
    raise InputError(("load", "normal_force", 3), "is wrong")


def inaccurate() -> None:
    raise AccuracyError("not so exact", ("rtol",))


def refused() -> None:
    raise ServiceError(problems.NOT_ACCEPTABLE, "not so", [("/load", "why")])


def broken() -> None:
    raise RuntimeError("a bug")


def run(
    test: Test,
    settings: Settings = ONE,
    warm_up: Callable[[], object] = own_process,
) -> None:
    async def main() -> None:
        pool = ComputePool(settings)
        async with pool.started(warm_up):
            await test(pool)

    anyio.run(main)


@pytest.fixture(scope="module")
def shared() -> Iterator[Shared]:
    """Run a test in the pool of one process that several tests share."""
    pool = ComputePool(ONE)
    started = pool.started(own_process)
    with start_blocking_portal() as portal, portal.wrap_async_context_manager(started):
        yield lambda test: portal.call(test, pool)


@asynccontextmanager
async def occupied(pool: ComputePool, path: Path) -> AsyncIterator[None]:
    """Keep the only process busy within the context."""
    async with anyio.create_task_group() as tasks:
        tasks.start_soon(pool.run_in_process, until, path)
        await anyio.sleep(0.05)
        yield
        release(path)


async def error_of(awaited: Awaitable[object]) -> ServiceError:
    with pytest.raises(ServiceError) as caught:
        await awaited
    return caught.value


def lost_processes() -> float:
    (metric,) = observability.RESTARTS.collect()
    return sum(
        sample.value
        for sample in metric.samples
        if sample.name.endswith("_total") and sample.labels["reason"] == "lost"
    )


def ready_processes() -> float:
    (metric,) = observability.PROCESSES.collect()
    return metric.samples[0].value


async def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < deadline:  # noqa: ASYNC110 -- no event available
        await anyio.sleep(0.02)
    assert condition()


# The metrics describe the pool that was started last: tests of the shared pool come first.


def test_process_is_reused_whatever_it_prints(shared: Shared) -> None:
    async def test(pool: ComputePool) -> None:
        first = await pool.run_in_process(own_process)
        assert first != os.getpid()
        # On its standard output, which is not mistaken for a result.
        assert await pool.run_in_process(print_something) == first
        assert await pool.run_in_process(own_process) == first

    shared(test)


def test_errors_return_from_the_process(shared: Shared) -> None:
    async def test(pool: ComputePool) -> None:
        result = await error_of(pool.run_in_process(wrong))
        assert result.type == problems.INVALID_REQUEST
        assert list(result.errors) == [("/load/normal_force/3", "is wrong")]
        assert (await error_of(pool.run_in_process(inaccurate))).type == problems.ACCURACY
        result = await error_of(pool.run_in_process(refused))
        assert result.type == problems.NOT_ACCEPTABLE
        assert list(result.errors) == [("/load", "why")]
        with pytest.raises(DefectError, match="a bug"):
            await pool.run_in_process(broken)
        assert ready_processes() == 1

    shared(test)


def test_query_is_rejected_when_the_queue_is_full(shared: Shared, tmp_path: Path) -> None:
    async def test(pool: ComputePool) -> None:
        async with occupied(pool, tmp_path / "go"), anyio.create_task_group() as tasks:
            began = time.monotonic()
            tasks.start_soon(pool.run_in_process, own_process)
            await anyio.sleep(1.1)
            result = await error_of(pool.run_in_process(own_process))
            assert result.type == problems.BUSY
            # The first query in the queue has waited this long.
            assert 2 <= result.retry_after <= ceil(time.monotonic() - began)
            release(tmp_path / "go")

    shared(test)


def test_time_in_the_queue_is_recorded(shared: Shared, tmp_path: Path) -> None:
    async def test(pool: ComputePool) -> None:
        record = start_record()
        async with occupied(pool, tmp_path / "go"), anyio.create_task_group() as tasks:
            tasks.start_soon(pool.run_in_process, own_process)
            await anyio.sleep(0.1)
            (length,) = observability.QUEUE.collect()
            assert length.samples[0].value == 1
            release(tmp_path / "go")
        (length,) = observability.QUEUE.collect()
        assert length.samples[0].value == 0
        assert record.queued > 0.09

    shared(test)


def test_computation_beyond_its_time_limit_is_terminated_and_the_next_is_answered() -> None:
    async def test(pool: ComputePool) -> None:
        first = await pool.run_in_process(own_process)
        began = time.monotonic()
        result = await error_of(pool.run_in_process(sleep_for, 60.0))
        assert time.monotonic() - began < PATIENCE
        assert result.type == problems.TIME_EXCEEDED
        await wait_for(lambda: not process_exists(first))
        assert await pool.run_in_process(own_process) != first
        assert ready_processes() == 1

    run(test, ONE.model_copy(update={"budget_seconds": 1.0}))


@pytest.mark.parametrize("error", [RuntimeError, struct.error, EOFError, MemoryError])
def test_any_failure_of_an_exchange_loses_that_process_only(
    monkeypatch: pytest.MonkeyPatch, error: type[Exception]
) -> None:
    call = ComputeProcess.call

    async def fail(_process: ComputeProcess, *_: object) -> None:
        monkeypatch.setattr(ComputeProcess, "call", call)
        raise error("of a child")

    async def test(pool: ComputePool) -> None:
        first, counted = await pool.run_in_process(own_process), lost_processes()
        monkeypatch.setattr(ComputeProcess, "call", fail)
        assert (await error_of(pool.run_in_process(own_process))).type == problems.LOST
        await wait_for(lambda: not process_exists(first))
        assert await pool.run_in_process(own_process) != first
        assert lost_processes() == counted + 1

    run(test)


def test_ended_process_is_not_offered() -> None:
    async def test(pool: ComputePool) -> None:
        (process,) = pool._processes
        # As by a computation that is cancelled once it has the process.
        pool._idle.remove(process)
        process.kill()
        pool._offer(process)
        assert not pool._idle

    run(test)


def test_pool_without_supervision_is_not_ready() -> None:
    async def main() -> ServiceError:
        pool = ComputePool(ONE)
        async with pool.started(own_process):
            await pool.run_in_process(own_process)
        return await error_of(pool.run_in_process(own_process))

    assert anyio.run(main).type == problems.LOST


def test_process_that_fails_to_start_is_restarted(tmp_path: Path) -> None:
    async def test(pool: ComputePool) -> None:
        result = await error_of(pool.run_in_process(own_process))
        assert (result.type, result.retry_after) == (problems.LOST, 1)
        assert ready_processes() == 0
        (tmp_path / "live").touch()
        await wait_for(lambda: ready_processes() == 1)
        assert await pool.run_in_process(own_process) != os.getpid()

    run(test, HASTY, warm_up=partial(die_unless, tmp_path / "live"))


def test_process_that_fails_its_self_test_is_not_used() -> None:
    async def test(pool: ComputePool) -> None:
        assert (await error_of(pool.run_in_process(own_process))).type == problems.LOST
        assert ready_processes() == 0

    run(test, HASTY, warm_up=broken)


def test_query_that_waits_too_long_is_rejected(tmp_path: Path) -> None:
    async def test(pool: ComputePool) -> None:
        async with occupied(pool, tmp_path / "go"):
            assert (await error_of(pool.run_in_process(own_process))).type == problems.BUSY

    run(test, HASTY)


def test_queue_is_served_in_order_and_waiting_does_not_count_as_computing(tmp_path: Path) -> None:
    order: list[int] = []

    async def ask(pool: ComputePool, number: int) -> None:
        await pool.run_in_process(sleep_for, 0.5)
        order.append(number)

    async def test(pool: ComputePool) -> None:
        async with occupied(pool, tmp_path / "go"), anyio.create_task_group() as tasks:
            for number in range(4):
                tasks.start_soon(ask, pool, number)
                await anyio.sleep(0.01)
            release(tmp_path / "go")
        assert order == [0, 1, 2, 3]

    # Together they exceed the time limit of a single query.
    run(test, ONE.model_copy(update={"queue_length": 9, "budget_seconds": 1.8}))


TWO = ONE.model_copy(update={"compute_processes": 2, "queue_length": 9, "queue_seconds": 2.0})


def test_client_with_several_processes_makes_room_for_another() -> None:
    async def test(pool: ComputePool) -> None:
        displaced: list[ServiceError] = []

        async def keep_busy() -> None:
            start_record("greedy")
            try:
                await pool.run_in_process(sleep_for, 60.0)
            except ServiceError as error:
                displaced.append(error)

        with anyio.CancelScope() as scope:
            async with anyio.create_task_group() as tasks:
                for _ in range(4):
                    tasks.start_soon(keep_busy)
                await anyio.sleep(0.1)
                start_record("modest")
                # Before the two that came first.
                await pool.run_in_process(own_process)
                await pool.run_in_process(own_process)
                scope.cancel()
        assert [error.type for error in displaced[:1]] == [problems.BUSY]

    run(test, TWO.model_copy(update={"queue_seconds": 12.0}))


def test_client_with_the_longest_queue_gives_up_its_last(tmp_path: Path) -> None:
    async def test(pool: ComputePool) -> None:
        results: list[object] = []

        async def ask(client: str) -> None:
            start_record(client)
            try:
                await pool.run_in_process(own_process)
                results.append(client)
            except ServiceError as error:
                results.append(error.type)

        async with occupied(pool, tmp_path / "go"), anyio.create_task_group() as tasks:
            for client in ("greedy", "greedy", "greedy", "modest"):
                tasks.start_soon(ask, client)
                await anyio.sleep(0.05)
            assert results == [problems.BUSY]
            release(tmp_path / "go")
        assert sorted(results[1:], key=str) == ["greedy", "greedy", "modest"]

    run(test, ONE.model_copy(update={"queue_length": 3}))


def test_queries_of_one_client_do_not_displace_each_other() -> None:
    async def test(pool: ComputePool) -> None:
        async with anyio.create_task_group() as tasks:
            for _ in range(3):
                tasks.start_soon(pool.run_in_process, sleep_for, 1.0)

    run(test, TWO)
