"""Figures of the service under load and attack: `make faults`, over loopback only.

    python -m tests.faults.campaign [name ...]

Prints every figure when it is measured, and in the end one table of all figures and their bounds;
exits with 1 if a bound is missed.
"""

import asyncio
import json
import subprocess
import sys
import time
from collections import Counter
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress

import psutil

from mdr_service.settings import SETTINGS
from tests.faults.attacks import SMALL, tangential
from tests.faults.figures import MEBIBYTE, Row, say, table
from tests.faults.kills import kills
from tests.faults.load import HOST, Response, clients, percentile, request
from tests.faults.mixed_requests import memory, mutated, parallel, schema
from tests.faults.server import free_port, running, service

# Some hundredths of a second of a core: it needs a compute process.
LONGER = tangential(8_000)
# As load balancers and orchestrators ask: a connection for each probe.
LIVE = f"HEAD /health/live HTTP/1.1\r\nHost: {HOST}\r\nConnection: close\r\n\r\n".encode()

Campaign = Callable[[int, psutil.Process], Awaitable[list[Row]]]


@asynccontextmanager
async def beside(attack: str, port: int, seconds: float) -> AsyncIterator[Counter[str]]:
    """Attack while in the context; yield the statuses, which are complete after its end."""
    command = [sys.executable, "-m", "tests.faults.attacks", attack, str(port), str(seconds)]
    attackers = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.PIPE)
    found: Counter[str] = Counter()
    # Until Python has started.
    await asyncio.sleep(1.5)
    try:
        yield found
    finally:
        told, _ = await attackers.communicate()
        found.update(json.loads(told))


async def small_queries(port: int, seconds: float) -> list[float]:
    """Return the times of small queries, one after the other."""
    times = []
    async with clients(port, 1) as (client,):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            answer = await client.ask(SMALL)
            assert answer.status == 200
            times.append(answer.seconds)
            await asyncio.sleep(0.002)
    return times


async def largest_memory(server: psutil.Process) -> int:
    """Return the largest memory of the server until the task is cancelled."""
    largest = 0
    try:
        while True:
            largest = max(largest, server.memory_info().rss)
            await asyncio.sleep(0.02)
    except asyncio.CancelledError:
        return largest


def small_beside(attack: str, *, seconds: float = 14.0, bounded: bool = True) -> Campaign:
    """Return the campaign of small queries beside an attack, which SIGTERM ends.

    `bounded` : the attack may not need memory beyond the bound.
    """

    async def campaign(port: int, server: psutil.Process) -> list[Row]:
        await small_queries(port, 1.0)
        idle = percentile(await small_queries(port, 5.0), 0.99)
        before = server.memory_info().rss
        watching = asyncio.create_task(largest_memory(server))
        async with beside(attack, port, seconds + 25.0) as found:
            times = await small_queries(port, seconds)
            watching.cancel()
            growth = (await watching - before) / MEBIBYTE
            server.terminate()
            told = time.monotonic()
            await asyncio.to_thread(server.wait, 60)
            ended = time.monotonic() - told
        p99 = percentile(times, 0.99)
        median = 1e3 * percentile(times, 0.5)
        return [
            Row(
                f"{attack}: p99 of small queries",
                f"{1e3 * p99:.2f} ms",
                "<= 25 ms",
                p99 <= 25e-3,
                f"median {median:.2f} ms of {len(times)}; the attack was answered {dict(found)}",
            ),
            Row(
                f"{attack}: p99 over that of an idle service",
                f"{p99 / idle:.1f}",
                "<= 10",
                p99 <= 10 * idle,
                f"idle {1e3 * idle:.2f} ms",
            ),
            Row(
                f"{attack}: growth of memory",
                f"{growth:.1f} MiB",
                "<= 64 MiB" if bounded else "none",
                growth <= 64 or not bounded,
            ),
            Row(
                f"{attack}: end after SIGTERM",
                f"{ended:.1f} s",
                f"<= {SETTINGS.shutdown_seconds + 1} s",
                ended <= SETTINGS.shutdown_seconds + 1,
            ),
        ]

    return campaign


async def new_connections(port: int, seconds: float) -> list[float]:
    """Return the times of a liveness probe, each on a connection of its own."""
    times = []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        start = time.perf_counter()
        # A probe without a response counts with the time for which it waited.
        with suppress(TimeoutError, ConnectionError):
            async with asyncio.timeout(20.0):
                reader, writer = await asyncio.open_connection(HOST, port)
                writer.write(LIVE)
                assert (await reader.readline()).startswith(b"HTTP/1.1 200 ")
                writer.close()
        times.append(time.perf_counter() - start)
        await asyncio.sleep(0.05)
    return times


def connections_beside(attack: str) -> Campaign:
    """Return the campaign of liveness probes beside clients that keep their connections."""

    async def campaign(port: int, _server: psutil.Process) -> list[Row]:
        async with beside(attack, port, 16.0) as found:
            times = await new_connections(port, 12.0)
        p99 = percentile(times, 0.99)
        median = 1e3 * percentile(times, 0.5)
        return [
            Row(
                f"{attack}: p99 of probes on new connections",
                f"{1e3 * p99:.1f} ms",
                "<= 250 ms",
                p99 <= 0.25,
                f"median {median:.1f} ms of {len(times)}; the others were answered {dict(found)}",
            )
        ]

    return campaign


async def first_visits(port: int, server: psutil.Process) -> list[Row]:
    """Fifty browsers that download the largest file of the explorer at once, before any other."""
    text = request("/explorer/plotly.min.js", None)
    before, taken = server.memory_info().rss, sum(server.cpu_times()[:2])
    watching = asyncio.create_task(largest_memory(server))
    answers = await asyncio.gather(*(once(port, text) for _ in range(50)))
    watching.cancel()
    growth = (await watching - before) / MEBIBYTE
    taken = sum(server.cpu_times()[:2]) - taken
    right = {(answer.status, len(answer.body)) for answer in answers}
    return [
        Row(
            "50 first visits at once: processor time",
            f"{taken:.2f} s",
            "<= 1.5 s, all answered",
            taken <= 1.5 and len(right) == 1 and answers[0].status == 200,
            f"{right}",
        ),
        Row(
            "50 first visits at once: growth of memory",
            f"{growth:.1f} MiB",
            "<= 64 MiB",
            growth <= 64,
        ),
    ]


async def hostile(port: int, _server: psutil.Process) -> list[Row]:
    """Two connections with the most expensive queries, beside four with long and short ones."""
    counts: Counter[tuple[str, int]] = Counter()

    async def ask(name: str, text: bytes, pause: float, end: float) -> None:
        async with clients(port, 1) as (client,):
            while time.monotonic() < end:
                counts[name, (await client.ask(text)).status] += 1
                await asyncio.sleep(pause)

    async with beside("expensive queries, 2 clients", port, 42.0) as found:
        end = time.monotonic() + 40.0
        long = [ask("long", LONGER, 0.5, end) for _ in range(4)]
        await asyncio.gather(*long, ask("small", SMALL, 0.05, end))
    rows = []
    for name, least in (("long", 0.8), ("small", 1.0)):
        asked = sum(count for (what, _), count in counts.items() if what == name)
        share = counts[name, 200] / asked
        statuses = {status: count for (what, status), count in counts.items() if what == name}
        rows.append(
            Row(
                f"two connections with the most expensive queries: {name} ones answered",
                f"{100 * share:.0f} %",
                f">= {100 * least:.0f} %",
                share >= least,
                f"{statuses}; the attack was answered {dict(found)}",
            )
        )
    return rows


async def overload(port: int, _server: psutil.Process) -> list[Row]:
    """Four times as much as two processes can do, for a minute."""
    async with clients(port, 1) as (client,):
        alone = [await client.ask(LONGER) for _ in range(4)]
    each = percentile([answer.seconds for answer in alone], 0.5)
    every = each / SETTINGS.compute_processes / 4
    tasks: list[asyncio.Task[Response]] = []
    end = time.monotonic() + 60
    while time.monotonic() < end:
        tasks.append(asyncio.create_task(once(port, LONGER)))
        await asyncio.sleep(every)
    answers = [await task for task in tasks]
    good = [answer for answer in answers if answer.status == 200]
    late = [answer.seconds for answer in answers if answer.status == 503]
    right = all(answer.body == alone[0].body for answer in good)
    others = Counter(answer.status for answer in answers) - Counter({200: len(good)})
    most = SETTINGS.queue_seconds + SETTINGS.budget_seconds
    slowest = max(answer.seconds for answer in answers)
    return [
        Row(
            "overload by a factor of 4 for 60 s: slowest response",
            f"{slowest:.1f} s",
            f"identical or 503, <= {most:g} s",
            right and set(others) <= {503} and slowest <= most and len(good) > 0,
            f"{len(good)} of {len(answers)} answered, {dict(others)}; refused in a median of "
            f"{1e3 * percentile(late, 0.5):.1f} ms",
        )
    ]


async def once(port: int, text: bytes) -> Response:
    async with clients(port, 1) as (client,):
        return await client.ask(text)


CAMPAIGNS: dict[str, Campaign] = {
    "value": small_beside("50 MB header value"),
    "lines": small_beside("50 MB of header lines"),
    "trailers": small_beside("50 MB of trailers"),
    "floods": small_beside("floods of pipelined requests"),
    "tables": small_beside("new tables, 1 client"),
    "fields": small_beside("10⁵ unknown fields, 4 clients"),
    "batches": small_beside("batches of 1000, 20 clients"),
    "readers": small_beside("20 slow readers"),
    "bodies": small_beside("100 long bodies without an end"),
    "headers": small_beside("500 slow headers"),
    "expensive": small_beside("expensive queries, 20 clients"),
    "queries": connections_beside("200 clients of small queries"),
    "readme": connections_beside("50 readers of /readme"),
    "openapi": connections_beside("50 readers of /openapi.json"),
    "visits": first_visits,
    "hostile": hostile,
    "overload": overload,
    "kills": kills,
    "parallel": parallel,
    "schema": schema,
    "mutated": mutated,
    "memory": memory,
}


def main(names: list[str]) -> int:
    everything: list[Row] = []
    for name in names or list(CAMPAIGNS):
        port = free_port()
        with running(service(port), port, subprocess.DEVNULL) as process:
            started = time.monotonic()
            rows: list[Row] = asyncio.run(
                measured(CAMPAIGNS[name], port, psutil.Process(process.pid))
            )
            for row in rows:
                mark = " " if row.right else "!"
                say(f"{mark} {row.what}: {row.found} ({row.bound}) {row.detail}".rstrip())
            say(f"  ({name}: {time.monotonic() - started:.0f} s)")
            everything += rows
    say(f"\n{table(everything)}")
    return 0 if all(row.right for row in everything) else 1


async def measured(campaign: Campaign, port: int, server: psutil.Process) -> list[Row]:
    return await campaign(port, server)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
