"""Two clocks, processes that can be ended, and a queue that says beforehand what will not fit."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import anyio
import pytest

from mdr_core.errors import AccuracyError, DefectError, InputError
from mdr_service import apart, problems, watch
from mdr_service.compute import Compute
from mdr_service.problems import ServiceError
from mdr_service.settings import Settings

LONG = 1.0
"""Seconds, by estimate: more than is answered at once."""
SHORT = 1e-6
FEW = Settings(
    compute_processes=1,
    queue_length=1,
    queue_seconds=60.0,
    budget_seconds=60.0,
    shutdown_seconds=121,
)


def let_go(path: Path) -> None:
    path.touch()


def is_there(process: int) -> bool:
    return Path(f"/proc/{process}").exists()


def own_process() -> int:
    return os.getpid()


def asleep(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


def until(path: str) -> int:
    """Return once there is a file."""
    while not Path(path).exists():
        time.sleep(0.01)
    return os.getpid()


def killed() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def wrong() -> None:
    raise InputError(("load", "normal_force", 3), "is wrong")


def not_so_exact() -> None:
    raise AccuracyError("not so exact")


def refused() -> None:
    raise ServiceError(problems.NOT_ACCEPTABLE, "not so", [("/load", "why")])


def broken() -> None:
    raise RuntimeError("a bug")


def run(work: Callable[[Compute], Awaitable[None]], settings: Settings = FEW) -> None:
    async def main() -> None:
        compute = Compute(settings)
        async with compute.ready():
            # The same anywhere: estimates are those of the machine of the rates.
            compute.slowness = 1.0
            await work(compute)

    anyio.run(main)


@asynccontextmanager
async def occupied(compute: Compute, path: Path, seconds: float = LONG) -> AsyncIterator[None]:
    """Keep the one process busy as long as the context."""
    async with anyio.create_task_group() as tasks:
        tasks.start_soon(compute.run, seconds, until, str(path))
        await anyio.sleep(0.05)
        yield
        let_go(path)


async def problem(awaited: Awaitable[object]) -> ServiceError:
    with pytest.raises(ServiceError) as caught:
        await awaited
    return caught.value


def test_a_short_one_runs_here_and_a_long_one_elsewhere() -> None:
    async def work(compute: Compute) -> None:
        assert await compute.run(SHORT, own_process) == os.getpid()
        first = await compute.run(LONG, own_process)
        assert first != os.getpid()
        assert await compute.run(LONG, own_process) == first

    run(work)


def test_failures_survive_the_way_back() -> None:
    async def work(compute: Compute) -> None:
        found = await problem(compute.run(LONG, wrong))
        assert (found.kind, found.errors) == (
            problems.INVALID_REQUEST,
            (("/load/normal_force/3", "is wrong"),),
        )
        assert (await problem(compute.run(LONG, not_so_exact))).kind == problems.ACCURACY
        found = await problem(compute.run(LONG, refused))
        assert (found.kind, found.errors) == (problems.NOT_ACCEPTABLE, (("/load", "why"),))
        with pytest.raises(DefectError, match="a bug"):
            await compute.run(LONG, broken)
        assert await compute.run(LONG, own_process) != os.getpid()

    run(work)


def test_what_takes_too_long_is_ended_and_the_next_is_answered() -> None:
    async def work(compute: Compute) -> None:
        first = await compute.run(LONG, own_process)
        found = await problem(compute.run(LONG, asleep, 60.0))
        assert found.kind == problems.TIME_EXCEEDED
        assert await compute.run(LONG, own_process) != first
        assert not is_there(first)

    run(work, FEW.model_copy(update={"budget_seconds": 2.0}))


def test_a_killed_process_loses_its_own_work_only() -> None:
    async def work(compute: Compute) -> None:
        found = await problem(compute.run(LONG, killed))
        assert (found.kind, found.retry_after) == (problems.LOST, 1)
        assert await compute.run(LONG, own_process) != os.getpid()

    run(work)


def test_what_finds_the_queue_full_is_refused(tmp_path: Path) -> None:
    async def work(compute: Compute) -> None:
        async with occupied(compute, tmp_path / "go"), anyio.create_task_group() as tasks:
            tasks.start_soon(compute.run, LONG, own_process)
            await anyio.sleep(0.05)
            found = await problem(compute.run(LONG, own_process))
            assert found.kind == problems.BUSY
            assert found.retry_after is not None
            assert found.retry_after >= 1
            let_go(tmp_path / "go")

    run(work)


def test_what_would_wait_too_long_is_refused_before_it_waits(tmp_path: Path) -> None:
    async def work(compute: Compute) -> None:
        async with occupied(compute, tmp_path / "go", seconds=50.0):
            found = await problem(compute.run(LONG, own_process))
            assert (found.kind, found.retry_after) == (problems.BUSY, 50)

    run(work)


def test_what_waits_too_long_is_refused(tmp_path: Path) -> None:
    async def work(compute: Compute) -> None:
        # It is expected to end at once, and does not.
        async with occupied(compute, tmp_path / "go", seconds=0.01):
            found = await problem(compute.run(LONG, own_process))
            assert found.kind == problems.BUSY

    run(work, FEW.model_copy(update={"queue_seconds": 0.2}))


def test_the_queue_is_served_in_its_order_and_waiting_costs_no_budget(tmp_path: Path) -> None:
    order: list[int] = []

    async def ask(compute: Compute, number: int) -> None:
        await compute.run(0.01, asleep, 0.5)
        order.append(number)

    async def work(compute: Compute) -> None:
        async with occupied(compute, tmp_path / "go", 0.01), anyio.create_task_group() as tasks:
            for number in range(4):
                tasks.start_soon(ask, compute, number)
                await anyio.sleep(0.01)
            let_go(tmp_path / "go")
        assert order == [0, 1, 2, 3]

    # Together they take longer than the budget of each.
    run(work, FEW.model_copy(update={"queue_length": 9, "budget_seconds": 1.5}))


def test_a_request_knows_what_it_cost_and_how_long_it_waited(tmp_path: Path) -> None:
    async def work(compute: Compute) -> None:
        watched = watch.begin("GET")
        async with occupied(compute, tmp_path / "go", 0.01), anyio.create_task_group() as tasks:
            tasks.start_soon(compute.run, LONG, own_process)
            await anyio.sleep(0.1)
            let_go(tmp_path / "go")
        assert watched.cost == pytest.approx(LONG + 0.01)
        assert watched.queued > 0.09

    run(work)


def test_a_compute_process_ends_with_its_parent() -> None:
    code = (
        "import anyio, os, signal; from mdr_service import apart\n"
        "async def main():\n"
        "    await anyio.to_process.run_sync(apart.prepare)\n"
        "    print(await anyio.to_process.run_sync(os.getpid), flush=True)\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
        "    import time; time.sleep(60)\n"
        "anyio.run(main)"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    child = int(told.stdout)
    deadline = time.monotonic() + 30
    while is_there(child) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not is_there(child)


def test_the_speed_of_this_machine_is_some_speed() -> None:
    assert 1e-3 < apart.slowness() < 1e3
