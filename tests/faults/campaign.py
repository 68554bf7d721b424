"""Performance of the service under load and attack: `make faults`, over loopback only.

python -m tests.faults.campaign [name ...]

Prints a table of measured values and their limits, and exits with 1 if a limit is exceeded.
"""

import asyncio
import json
import random
import re
import subprocess
import sys
import time
from collections import Counter
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil

from mdr_service.schemas import examples
from mdr_service.settings import SETTINGS
from tests.contract import strict_json
from tests.faults.attacks import SMALL, tangential
from tests.faults.load import Client, ResetError, Response, clients, percentile, request
from tests.faults.server import free_port, running, service

DOCUMENT = json.loads((Path(__file__).parents[2] / "openapi.json").read_text("utf-8"))
# A few hundredths of a second of a core, so it needs a compute process.
LONGER = tangential(8_000)
QUERIES = {
    "/v1/normal": examples.NORMAL_EXAMPLES,
    "/v1/tangential": examples.TANGENTIAL_EXAMPLES,
    "/v1/tangential/history": examples.HISTORY_EXAMPLES,
    "/v1/stress": examples.STRESS_EXAMPLES,
    "/v1/wear": examples.WEAR_EXAMPLES,
}
REQUESTS = [
    (path, json.dumps(each["value"]).encode())
    for path, named in QUERIES.items()
    for each in named.values()
]
MEBIBYTE = 2**20


@dataclass(frozen=True)
class Row:
    """One row of the table."""

    what: str
    result: str
    bound: str
    right: bool


Campaign = Callable[[int, psutil.Process], Awaitable[list[Row]]]


@asynccontextmanager
async def beside(attack: str, port: int, seconds: float) -> AsyncIterator[Counter[str]]:
    """Run an attack within the context; yield its statuses, which are complete on exit."""
    command = [sys.executable, "-m", "tests.faults.attacks", attack, str(port), str(seconds)]
    attackers = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.PIPE)
    result: Counter[str] = Counter()
    # Wait for the start of Python.
    await asyncio.sleep(1.5)
    try:
        yield result
    finally:
        detail, _ = await attackers.communicate()
        result.update(json.loads(detail))


async def small_queries(port: int, seconds: float) -> list[float]:
    """Return the times of sequential small queries."""
    times = []
    async with clients(port, 1) as (client,):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            response = await client.ask(SMALL)
            assert response.status == 200
            times.append(response.seconds)
            await asyncio.sleep(0.002)
    return times


async def largest_memory(server: psutil.Process) -> int:
    """Return the peak memory of the server, measured until the task is cancelled."""
    largest = 0
    try:
        while True:
            largest = max(largest, server.memory_info().rss)
            await asyncio.sleep(0.02)
    except asyncio.CancelledError:
        return largest


def small_queries_during(attack: str, *, seconds: float = 14.0, bounded: bool = True) -> Campaign:
    """Return the campaign of small queries during an attack that ends with SIGTERM.

    `bounded` : the attack must not need memory beyond the limit.
    """

    async def campaign(port: int, server: psutil.Process) -> list[Row]:
        await small_queries(port, 1.0)
        idle = percentile(await small_queries(port, 5.0), 0.99)
        before = server.memory_info().rss
        watching = asyncio.create_task(largest_memory(server))
        async with beside(attack, port, seconds + 25.0) as result:
            times = await small_queries(port, seconds)
            watching.cancel()
            growth = (await watching - before) / MEBIBYTE
            server.terminate()
            detail = time.monotonic()
            await asyncio.to_thread(server.wait, 60)
            ended = time.monotonic() - detail
        p99 = percentile(times, 0.99)
        most = min(25e-3, 10 * idle)
        return [
            Row(
                f"small query during {attack}",
                f"p50 {1e3 * percentile(times, 0.5):.2f} ms, p99 {1e3 * p99:.2f} ms, "
                f"{len(times)} requests; idle p99 {1e3 * idle:.2f} ms; {dict(result)}",
                "p99 <= 25 ms and 10 × idle",
                p99 <= most,
            ),
            Row(
                "    growth of memory",
                f"{growth:.1f} MiB",
                "<= 64 MiB",
                growth <= 64 or not bounded,
            ),
            Row(
                "    end after SIGTERM",
                f"{ended:.1f} s",
                f"<= {SETTINGS.shutdown_seconds + 1} s",
                ended <= SETTINGS.shutdown_seconds + 1,
            ),
        ]

    return campaign


async def hostile(port: int, _server: psutil.Process) -> list[Row]:
    """Two connections with the most expensive queries, and four with long and short ones."""
    counts: Counter[tuple[str, int]] = Counter()

    async def ask(name: str, text: bytes, pause: float, end: float) -> None:
        async with clients(port, 1) as (client,):
            while time.monotonic() < end:
                counts[name, (await client.ask(text)).status] += 1
                await asyncio.sleep(pause)

    async with beside("expensive queries, 2 clients", port, 42.0) as result:
        end = time.monotonic() + 40.0
        long = [ask("long", LONGER, 0.5, end) for _ in range(4)]
        await asyncio.gather(*long, ask("small", SMALL, 0.05, end))
    rows = []
    for name, least in (("long", 0.8), ("small", 1.0)):
        requested = sum(count for (what, _), count in counts.items() if what == name)
        share = counts[name, 200] / requested
        statuses = {status: count for (what, status), count in counts.items() if what == name}
        rows.append(
            Row(
                f"{name} queries during two connections with the most expensive:  {dict(result)}",
                f"{100 * share:.0f} % answered, {statuses}",
                f">= {100 * least:.0f} %",
                share >= least,
            )
        )
    return rows


async def overload(port: int, _server: psutil.Process) -> list[Row]:
    """Four times the load that two processes can handle, for a minute."""
    async with clients(port, 1) as (client,):
        alone = [await client.ask(LONGER) for _ in range(4)]
    each = percentile([response.seconds for response in alone], 0.5)
    every = each / SETTINGS.compute_processes / 4
    tasks: list[asyncio.Task[Response]] = []
    end = time.monotonic() + 60
    while time.monotonic() < end:
        tasks.append(asyncio.create_task(once(port, LONGER)))
        await asyncio.sleep(every)
    answers = [await task for task in tasks]
    good = [response for response in answers if response.status == 200]
    late = [response.seconds for response in answers if response.status == 503]
    right = all(response.body == alone[0].body for response in good)
    others = Counter(response.status for response in answers) - Counter({200: len(good)})
    most = SETTINGS.queue_seconds + SETTINGS.budget_seconds
    slowest = max(response.seconds for response in answers)
    return [
        Row(
            "overload by a factor of 4 for 60 s",
            f"{len(good)} of {len(answers)} answered, {dict(others)}; slowest {slowest:.1f} s; "
            f"rejected in p50 {1e3 * percentile(late, 0.5):.1f} ms",
            f"all identical or 503, within {most:g} s",
            right and set(others) <= {503} and slowest <= most and len(good) > 0,
        )
    ]


async def once(port: int, text: bytes) -> Response:
    async with clients(port, 1) as (client,):
        return await client.ask(text)


async def parallel(port: int, _server: psutil.Process) -> list[Row]:
    texts = [request(path, body) for path, body in REQUESTS]
    chosen = [texts[n % len(texts)] for n in range(1000)]
    async with clients(port, 1) as (client,):
        serial = {text: (await retry(client, text)).body for text in texts}
    random.Random(1).shuffle(chosen)
    same = 0
    async with clients(port, 50) as many:
        queue = list(chosen)

        async def work(client: Client) -> int:
            right = 0
            while queue:
                text = queue.pop()
                right += (await retry(client, text)).body == serial[text]
            return right

        same = sum(await asyncio.gather(*(work(client) for client in many)))
    what = "1000 requests by 50 clients, compared with serial ones"
    return [Row(what, f"{same} bit-identical", "1000", same == 1000)]


async def retry(client: Client, text: bytes) -> Response:
    """Return the response, retrying while the service is busy."""
    while True:
        response = await client.ask(text)
        if response.status != 503:
            return response
        await asyncio.sleep(0.2)


async def memory(port: int, server: psutil.Process) -> list[Row]:
    """10⁵ mixed requests: valid, invalid and to unknown paths."""
    texts = [request(path, body) for path, body in REQUESTS]
    texts += [request(path, body[: len(body) // 2]) for path, body in REQUESTS]
    texts += [request(path, None) for path in ("/health", "/nowhere", "/v1/limits", "/metrics")]
    rng = random.Random(2)
    counts: Counter[int] = Counter()
    levels = []

    async def work(client: Client, number: int) -> None:
        for _ in range(number):
            counts[(await client.ask(rng.choice(texts))).status] += 1

    async with clients(port, 4) as many:
        for _ in range(10):
            await asyncio.gather(*(work(client, 2_500) for client in many))
            levels.append(server.memory_info().rss / MEBIBYTE)
    growth = levels[-1] - levels[0]
    return [
        Row(
            "10⁵ mixed requests: growth of memory after the first 10⁴",
            f"{growth:.2f} MiB; {dict(counts)}",
            "<= 4 MiB",
            growth <= 4.0 and set(counts) <= {200, 400, 404, 503},
        )
    ]


async def mutated(port: int, _server: psutil.Process) -> list[Row]:
    """10⁵ bodies with bytes changed, removed, doubled and moved."""
    documented = {
        path: {int(status) for status in operations["post"]["responses"]}
        for path, operations in DOCUMENT["paths"].items()
        if "post" in operations
    }
    rng = random.Random(3)
    counts: Counter[int] = Counter()
    faults: Counter[str] = Counter()

    async def work(client: Client) -> None:
        for _ in range(12_500):
            path, body = rng.choice(REQUESTS)
            body = mutation(body, rng)
            try:
                response = await client.ask(request(path, body))
            except ResetError:
                faults["reset"] += 1
                continue
            counts[response.status] += 1
            if response.status not in documented[path]:
                faults[f"undocumented {response.status}"] += 1
            if response.status == 500:
                faults["500"] += 1
                say(f"responses with 500:  {path} {body!r}")
            if response.status == 200 and (fault := fault_of(response.body)):
                faults[fault] += 1

    async with clients(port, 8) as many:
        await asyncio.gather(*(work(client) for client in many))
    return [
        Row(
            "10⁵ bodies with mutated bytes",
            f"{dict(sorted(counts.items()))}; {dict(faults) or 'no fault'}",
            "0 × 500, reset, undocumented, NaN or null without a warning",
            not faults,
        )
    ]


def mutation(body: bytes, rng: random.Random) -> bytes:
    result = bytearray(body)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        at = rng.randrange(len(result))
        way = rng.randrange(6)
        if way == 0:
            result[at] = rng.randrange(256)
        elif way == 1:
            del result[at : at + rng.choice([1, 2, 8])]
        elif way == 2:
            result[at:at] = bytes([rng.randrange(256)])
        elif way == 3:
            result[at:at] = result[at : at + rng.choice([1, 4, 16])]
        elif way == 4:
            # Replacing a digit by another often leaves a valid query.
            digits = [n for n, byte in enumerate(result) if chr(byte).isdigit()]
            if digits:
                result[rng.choice(digits)] = ord(rng.choice("0123456789"))
        else:
            result[at : at + 1] = rng.choice([b"1e999", b"NaN", b"-0.0", b"1e-320", b"null", b"[]"])
        if not result:
            result += b"0"
    return bytes(result)


def fault_of(body: bytes) -> str | None:
    """Return the error of a result, if any: invalid JSON, or an infinity without a warning."""
    try:
        response = strict_json.loads(body)
    except ValueError:
        return "not JSON"
    codes = {each["code"] for each in response["warnings"]}
    explained = codes & {"singular", "endless_wear"}
    return "null without a warning" if b"null" in body and not explained else None


async def schema(port: int, _server: psutil.Process) -> list[Row]:
    """Requests generated from the OpenAPI document, valid and invalid."""
    command = [
        str(Path(sys.executable).with_name("schemathesis")),
        *("run", f"http://127.0.0.1:{port}/openapi.json", "--no-color", "--continue-on-failure"),
        *("--phases", "examples,coverage,fuzzing", "--max-examples", "350", "--checks", "all"),
        # Some queries that match the schema have no result, e.g. beyond the friction limit.
        *("--exclude-checks", "positive_data_acceptance", "--seed", "1"),
    ]
    process = await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT
    )
    detail, _ = await process.communicate()
    text = detail.decode()
    cases = re.search(r"(\d+) generated", text)
    failures = [line.strip() for line in text.splitlines() if line.strip().startswith("❌ ST")]
    if failures:
        # Includes the commands that reproduce each failure.
        say(text)
    number = int(cases[1]) if cases else 0
    return [
        Row(
            "requests generated from the OpenAPI document",
            f"{number} cases; {', '.join(failures) or 'no fault'}",
            ">= 10⁴ cases, 0 × 5xx but 503 and 504, 0 undocumented",
            number >= 10_000 and not failures,
        )
    ]


CAMPAIGNS: dict[str, Campaign] = {
    "value": small_queries_during("50 MB header value"),
    "lines": small_queries_during("50 MB of header lines"),
    "trailers": small_queries_during("50 MB of trailers"),
    "floods": small_queries_during("floods of pipelined requests"),
    "fields": small_queries_during("10⁵ unknown fields, 4 clients"),
    "batches": small_queries_during("batches of 1000, 20 clients"),
    "readers": small_queries_during("20 slow readers"),
    "bodies": small_queries_during("100 long bodies without an end"),
    "headers": small_queries_during("500 slow headers"),
    "expensive": small_queries_during("expensive queries, 20 clients"),
    "hostile": hostile,
    "overload": overload,
    "parallel": parallel,
    "schema": schema,
    "mutated": mutated,
    "memory": memory,
}


def say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def main(names: list[str]) -> int:
    missed = 0
    for name in names or list(CAMPAIGNS):
        port = free_port()
        with running(service(port), port, subprocess.DEVNULL) as process:
            started = time.monotonic()
            rows: list[Row] = asyncio.run(
                measured(CAMPAIGNS[name], port, psutil.Process(process.pid))
            )
            for row in rows:
                mark = "  " if row.right else "! "
                say(f"{mark}{row.what}\n      {row.result}\n      bound: {row.bound}")
                missed += not row.right
            say(f"    ({name}: {time.monotonic() - started:.0f} s)")
    return 1 if missed else 0


async def measured(campaign: Campaign, port: int, server: psutil.Process) -> list[Row]:
    return await campaign(port, server)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
