"""What the service stands, in figures: `make faults`, some minutes, loopback only.

    python -m tests.faults.campaign [name ...]

Prints a table. Exits with 1 if anything is lost, reset, wrong or undocumented. The times are
printed beside what they are meant to be, and depend on what else the machine does.
"""

import asyncio
import json
import random
import re
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path

import psutil

from mdr_service.schemas import examples
from mdr_service.settings import SETTINGS
from tests.contract import strict_json
from tests.faults.load import Answered, Client, ResetError, clients, percentile, post, request
from tests.faults.server import free_port, running, service

DOCUMENT = json.loads((Path(__file__).parents[2] / "openapi.json").read_text("utf-8"))
MATERIAL = {"e_star": 1.0, "g_star": 0.8}
SMALL = post(
    "/v1/normal",
    {
        "profile": {"kind": "cone", "slope": 0.1},
        "material": MATERIAL,
        "load": {"normal_force": 1.0},
    },
)
# The largest that are let in, by the estimate: seconds of one processor. One is long to send, the
# other only long to answer.
HEAVY = (
    post(
        "/v1/tangential",
        {
            "profile": {"kind": "sphere", "radius": 10.0},
            "material": MATERIAL,
            "load": {"indentation_depth": 0.05},
            "friction_coefficient": 0.3,
            "tangential": {"tangential_force": [1e-4 + 1e-9 * n for n in range(60_000)]},
        },
    ),
    post(
        "/v1/wear/evolution",
        examples.EVOLUTION_EXAMPLES["shakedown"]["value"]
        | {"resolution": 96, "cycles": [float(10 * n) for n in range(240)]},
    ),
)
# Some tenths of a second of one processor.
MIDDLE = post(
    "/v1/tangential",
    {
        "profile": {"kind": "sphere", "radius": 10.0},
        "material": MATERIAL,
        "load": {"indentation_depth": 0.05},
        "friction_coefficient": 0.3,
        "tangential": {"tangential_force": [1e-4 + 1e-9 * n for n in range(8_000)]},
    },
)
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


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    what: str
    found: str
    meant: str
    right: bool = True


Campaign = Callable[[int, psutil.Process], Awaitable[list[Row]]]


async def small_beside_large(port: int, _server: psutil.Process) -> list[Row]:
    rows = []
    idle = 0.0
    for heavy in (0, 1, 4, 20):
        # In a process of their own: the small one is to wait for the service, not for them.
        command = [sys.executable, "-m", "tests.faults.heavy", str(port), str(heavy), "7"]
        others = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.PIPE)
        await asyncio.sleep(1.5)
        times = await _times(port, 6.0)
        told, _ = await others.communicate()
        statuses = Counter({int(status): count for status, count in json.loads(told).items()})
        p50, p99 = percentile(times, 0.5), percentile(times, 0.99)
        idle = idle or p99
        beside = f", beside {heavy} clients with the largest: {dict(statuses)}"
        rows.append(
            Row(
                f"small query{beside if heavy else ', idle'}",
                f"p50 {1e3 * p50:.2f} ms, p99 {1e3 * p99:.2f} ms, {p99 / idle:.1f} × idle, "
                f"{len(times)} asked",
                "p99 <= 25 ms and 10 × idle" if heavy else "",
                set(statuses) <= {200, 503, 504},
            )
        )
    return rows


async def _times(port: int, seconds: float) -> list[float]:
    times = []
    async with clients(port, 1) as (client,):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            answer = await client.ask(SMALL)
            assert answer.status == 200
            times.append(answer.seconds)
            await asyncio.sleep(0.002)
    return times


async def overload(port: int, _server: psutil.Process) -> list[Row]:
    """Four times as much as two processes can do, for a minute."""
    async with clients(port, 1) as (client,):
        alone = [await client.ask(MIDDLE) for _ in range(4)]
    each = percentile([answer.seconds for answer in alone], 0.5)
    every = each / SETTINGS.compute_processes / 4
    tasks: list[asyncio.Task[Answered]] = []
    end = time.monotonic() + 60
    while time.monotonic() < end:
        tasks.append(asyncio.create_task(_once(port, MIDDLE)))
        await asyncio.sleep(every)
    answers = [await task for task in tasks]
    good = [answer for answer in answers if answer.status == 200]
    late = [answer.seconds for answer in answers if answer.status == 503]
    right = all(answer.body == alone[0].body for answer in good)
    others = Counter(answer.status for answer in answers) - Counter({200: len(good)})
    return [
        Row(
            "4 × overload for 60 s: accepted",
            f"{len(good)} of {len(answers)}, all {'right' if right else 'NOT RIGHT'}; "
            f"slowest {max(answer.seconds for answer in good):.1f} s",
            "all right",
            right,
        ),
        Row(
            "4 × overload for 60 s: refused",
            f"{dict(others)}; p50 {1e3 * percentile(late, 0.5):.1f} ms, p99 "
            f"{1e3 * percentile(late, 0.99):.1f} ms, slowest {1e3 * max(late):.0f} ms",
            "503 in < 50 ms",
            set(others) <= {503},
        ),
    ]


async def _once(port: int, text: bytes) -> Answered:
    async with clients(port, 1) as (client,):
        return await client.ask(text)


async def bad_bodies(port: int, server: psutil.Process) -> list[Row]:
    before = peak = server.memory_info().rss
    rows = []
    length = 8 * SETTINGS.max_body_bytes
    blank = b" " * 2**20
    headers = ("Content-Type: application/json",)
    chunk = b"%x\r\n%s\r\n" % (len(blank), blank)
    pieces = {
        "with its length": request(
            "/v1/normal", None, (*headers, f"Content-Length: {length}")
        ).replace(b"GET", b"POST", 1)
        + blank * 8,
        "in chunks": request("/v1/normal", None, (*headers, "Transfer-Encoding: chunked")).replace(
            b"GET", b"POST", 1
        )
        + chunk * 32,
    }
    for name, text in pieces.items():
        for _ in range(5):
            answer = await _once(port, text)
            peak = max(peak, server.memory_info().rss)
        rows.append(
            Row(
                f"body past the limit, {name}",
                f"{answer.status} after {1e3 * answer.seconds:.0f} ms",
                "413",
                answer.status == 413,
            )
        )
    bad = post(
        "/v1/normal",
        {"profile": {"kind": "cone", "slope": 1}, "material": MATERIAL}
        | {"load": {"normal_force": ["a"] * 10_000}},
    )
    answer = await _once(port, bad)
    peak = max(peak, server.memory_info().rss)
    rows.append(
        Row(
            "10⁴ bad elements",
            f"{answer.status}, {len(answer.body)} bytes",
            "422, <= 4096 bytes",
            answer.status == 422 and len(answer.body) <= 4096,
        )
    )
    slow = request("/v1/normal", b"{" * 100)[:-50]
    answer = await _once(port, slow)
    rows.append(
        Row(
            "a body that does not come",
            f"{answer.status} after {answer.seconds:.1f} s",
            f"408 after {SETTINGS.body_seconds:g} s",
            answer.status == 408,
        )
    )
    rows.append(Row("memory, all of these", f"+{(peak - before) / 2**20:.1f} MiB", "< +20 MiB"))
    return rows


async def parallel(port: int, _server: psutil.Process) -> list[Row]:
    texts = [request(path, body) for path, body in REQUESTS]
    chosen = [texts[n % len(texts)] for n in range(1000)]
    async with clients(port, 1) as (client,):
        serial = {text: (await _patient(client, text)).body for text in texts}
    random.Random(1).shuffle(chosen)
    same = 0
    async with clients(port, 50) as many:
        queue = list(chosen)

        async def work(client: Client) -> int:
            right = 0
            while queue:
                text = queue.pop()
                right += (await _patient(client, text)).body == serial[text]
            return right

        same = sum(await asyncio.gather(*(work(client) for client in many)))
    return [
        Row(
            "10³ requests by 50 clients against serial ones",
            f"{same} bit-identical",
            "1000",
            same == 1000,
        )
    ]


async def _patient(client: Client, text: bytes) -> Answered:
    """Return the answer, asking again as long as the service is busy."""
    while True:
        answer = await client.ask(text)
        if answer.status != 503:
            return answer
        await asyncio.sleep(0.2)


async def memory(port: int, server: psutil.Process) -> list[Row]:
    """10⁵ mixed requests: right, wrong and elsewhere."""
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
            levels.append(server.memory_info().rss / 2**20)
    return [
        Row(
            "10⁵ mixed requests",
            f"{dict(counts)}; {', '.join(f'{level:.1f}' for level in levels)} MiB: "
            f"+{levels[-1] - levels[0]:.2f} MiB after the first 10⁴",
            "< +1 MiB",
            set(counts) <= {200, 400, 404, 503},
        )
    ]


async def mutated(port: int, server: psutil.Process) -> list[Row]:
    """10⁵ bodies with bytes changed, cut, doubled and put elsewhere."""
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
            body = _mutated(body, rng)
            try:
                answer = await client.ask(request(path, body))
            except ResetError:
                faults["reset"] += 1
                continue
            counts[answer.status] += 1
            if answer.status not in documented[path]:
                faults[f"undocumented {answer.status}"] += 1
            if answer.status == 500:
                faults["500"] += 1
                say(f"answered by 500: {path} {body!r}")
            if answer.status == 200 and (told := _wrong(answer.body)):
                faults[told] += 1

    async with clients(port, 8) as many:
        await asyncio.gather(*(work(client) for client in many))
    return [
        Row(
            "10⁵ bodies with mutated bytes",
            f"{dict(sorted(counts.items()))}; {dict(faults) or 'nothing wrong'}",
            "0 × 500, 0 resets, 0 undocumented, 0 NaN, no null without its warning",
            not faults,
        )
    ]


def _mutated(body: bytes, rng: random.Random) -> bytes:
    found = bytearray(body)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        at = rng.randrange(len(found))
        way = rng.randrange(6)
        if way == 0:
            found[at] = rng.randrange(256)
        elif way == 1:
            del found[at : at + rng.choice([1, 2, 8])]
        elif way == 2:
            found[at:at] = bytes([rng.randrange(256)])
        elif way == 3:
            found[at:at] = found[at : at + rng.choice([1, 4, 16])]
        elif way == 4:
            # A digit becomes another, so that the body is often still a query.
            digits = [n for n, byte in enumerate(found) if chr(byte).isdigit()]
            if digits:
                found[rng.choice(digits)] = ord(rng.choice("0123456789"))
        else:
            found[at : at + 1] = rng.choice([b"1e999", b"NaN", b"-0.0", b"1e-320", b"null", b"[]"])
        if not found:
            found += b"0"
    return bytes(found)


def _wrong(body: bytes) -> str | None:
    """Return what is wrong with a good answer: no JSON, or an infinity that no warning names."""
    try:
        answer = strict_json.loads(body)
    except ValueError:
        return "not JSON"
    codes = {each["code"] for each in answer["warnings"]}
    explained = codes & {"singular", "endless_wear"}
    return "null without a warning" if b"null" in body and not explained else None


async def schema(port: int, _server: psutil.Process) -> list[Row]:
    """Requests made from the OpenAPI document, and against it."""
    command = [
        str(Path(sys.executable).with_name("schemathesis")),
        *("run", f"http://127.0.0.1:{port}/openapi.json", "--no-color", "--continue-on-failure"),
        *("--phases", "examples,coverage,fuzzing", "--max-examples", "350", "--checks", "all"),
        # What fits the schema may have no answer for all that: friction beyond its limit, say.
        *("--exclude-checks", "positive_data_acceptance", "--seed", "1"),
    ]
    process = await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT
    )
    told, _ = await process.communicate()
    text = told.decode()
    cases = re.search(r"(\d+) generated", text)
    failures = [line.strip() for line in text.splitlines() if line.strip().startswith("❌ ST")]
    if failures:
        # With the commands that show each of them.
        say(text)
    return [
        Row(
            "requests from the whole OpenAPI document",
            f"{cases[1] if cases else 'no'} cases; {', '.join(failures) or 'nothing wrong'}",
            ">= 10⁴ cases, 0 × 5xx but 503 and 504, 0 undocumented",
            bool(cases) and not failures,
        )
    ]


CAMPAIGNS: dict[str, Campaign] = {
    "small": small_beside_large,
    "overload": overload,
    "bodies": bad_bodies,
    "parallel": parallel,
    "schema": schema,
    "mutated": mutated,
    "memory": memory,
}


def show(row: Row) -> None:
    mark = "  " if row.right else "! "
    say(f"{mark}{row.what}\n      {row.found}\n      meant: {row.meant}")


def say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def main(names: list[str]) -> int:
    wrong = 0
    for name in names or list(CAMPAIGNS):
        port = free_port()
        with running(service(port), port, subprocess.DEVNULL) as process:
            started = time.monotonic()
            found: list[Row] = asyncio.run(_run(CAMPAIGNS[name], port, psutil.Process(process.pid)))
            for row in found:
                show(row)
                wrong += not row.right
            say(f"    ({name}: {time.monotonic() - started:.0f} s)")
    return 1 if wrong else 0


async def _run(campaign: Campaign, port: int, server: psutil.Process) -> list[Row]:
    return await campaign(port, server)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
