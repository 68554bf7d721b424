"""Campaign of compute processes that are killed at random moments, idle and busy."""

import asyncio
import json
import random
import re
import time
from collections import Counter
from math import inf

import psutil

from mdr_service import problems
from tests.faults.attacks import tangential
from tests.faults.figures import Row
from tests.faults.load import Client, ResetError, clients, request

# Some hundredths of a second of a core: it needs a compute process.
LONG = tangential(8_000)
READY = request("/health/ready", None)
METRICS = request("/metrics", None)
# Time after which a query is answered whatever was killed before it [s].
RECOVERY = 10.0
LOST = f"503 {problems.LOST.name}"


class Kills:
    """Clients that check the service while its compute processes are killed."""

    def __init__(self, server: psutil.Process, seconds: float, seed: int = 1) -> None:
        self.server = server
        self.end = time.monotonic() + seconds
        self.random = random.Random(seed)
        self.times: list[float] = []
        """Time of the kill of each process."""
        self.statuses: Counter[str] = Counter()
        self.faults: Counter[str] = Counter()
        self.slowest = 0.0
        """Longest time from the loss of a query to its result [s]."""

    async def run(self, port: int) -> None:
        async with clients(port, 4) as (one, two, three, four):
            await asyncio.gather(
                self.kill(), self.use(one), self.use(two), self.use(three), self.probe(four)
            )

    async def kill(self) -> None:
        """Kill one or all compute processes again and again."""
        while time.monotonic() < self.end:
            await asyncio.sleep(self.between((0.0, 3.0), (5.0, 12.0)))
            living = compute_processes(self.server)
            for each in self.random.choice([living[:1], living[-1:], living]):
                each.kill()
                self.times.append(time.monotonic())

    async def use(self, client: Client) -> None:
        """Send queries, with pauses in which the processes are idle."""
        while time.monotonic() < self.end:
            start = time.monotonic()
            while (status := await self.ask(client, LONG)) != "200":
                if status != LOST:
                    self.faults[status] += 1
                await asyncio.sleep(0.2)
            # A further kill starts the time anew.
            start = max([start, *self.times])
            self.slowest = max(self.slowest, time.monotonic() - start)
            # The server closes a connection that is idle for long.
            await client.close()
            await asyncio.sleep(self.between((0.0, 0.0), (0.0, 1.0), (10.0, 12.0)))

    async def probe(self, client: Client) -> None:
        """Compare readiness with the query after it."""
        while time.monotonic() < self.end:
            start = time.monotonic()
            ready, answered = await self.ask(client, READY), await self.ask(client, LONG)
            last = max(self.times, default=-inf)
            if ready == "200" and answered != "200" and last < start:
                self.faults[f"ready, then {answered}"] += 1
            if ready != "200" and last < start - RECOVERY:
                self.faults[f"not ready: {ready}"] += 1
            await asyncio.sleep(0.3)

    async def ask(self, client: Client, text: bytes) -> str:
        """Return the status, with the type of problem if there is one."""
        try:
            response = await client.ask(text)
        except ResetError:
            found = "reset"
        else:
            found = f"{response.status}"
            if response.status != 200:
                found += " " + json.loads(response.body)["type"].removeprefix("urn:mdr:problem:")
        self.statuses[found] += 1
        return found

    def between(self, *ranges: tuple[float, float]) -> float:
        """Return a random time in one of the ranges."""
        return self.random.uniform(*self.random.choice(ranges))


def compute_processes(server: psutil.Process) -> list[psutil.Process]:
    """Return the compute processes below a server that have not ended."""
    found = []
    for each in server.children(recursive=True):
        try:
            if each.status() != "zombie" and any("compute_process" in a for a in each.cmdline()):
                found.append(each)
        except psutil.Error:
            continue
    return found


async def lost(port: int) -> int:
    """Return the number of compute processes that ended, according to the metrics."""
    async with clients(port, 1) as (client,):
        text = (await client.ask(METRICS)).body.decode()
    pattern = r'^mdr_compute_restarts_total\{reason="(?:lost|start)"\} (\S+)'
    counts = re.findall(pattern, text, re.MULTILINE)
    return int(sum(map(float, counts)))


async def kills(port: int, server: psutil.Process, seconds: float = 600.0) -> list[Row]:
    """Kill compute processes for a time; the server has to be new."""
    files = server.num_fds()
    found = Kills(server, seconds)
    await found.run(port)
    await asyncio.sleep(RECOVERY)
    counted, processes = await lost(port), len(compute_processes(server))
    what = f"{len(found.times)} kills of compute processes in {seconds:g} s"
    right = not found.faults and found.statuses["200"] > 0
    return [
        Row(
            f"{what}: responses other than 200 and process-lost, wrong readiness",
            f"{dict(found.faults) or 'none'}",
            "none",
            right,
            f"{dict(found.statuses)}",
        ),
        Row(
            f"{what}: longest time to the next result",
            f"{found.slowest:.1f} s",
            f"<= {RECOVERY:g} s",
            found.slowest <= RECOVERY,
        ),
        Row(f"{what}: counted", f"{counted}", f"{len(found.times)}", counted == len(found.times)),
        Row(
            f"{what}: processes afterwards, and growth of open files",
            f"{processes}, {server.num_fds() - files}",
            "2, <= 4",
            processes == 2 and server.num_fds() - files <= 4,
        ),
    ]
