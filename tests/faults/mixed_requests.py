"""Campaigns of mixed requests: in parallel, for memory, mutated, and generated from OpenAPI."""

import asyncio
import json
import random
import re
import sys
from collections import Counter
from pathlib import Path

import psutil

from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EXAMPLES
from tests.contract import strict_json
from tests.faults.figures import MEBIBYTE, Row, say
from tests.faults.load import Client, ResetError, Response, clients, request

DOCUMENT = json.loads((Path(__file__).parents[2] / "openapi.json").read_text("utf-8"))
# Without the evolution, which takes a second.
REQUESTS = [
    (kind.path, json.dumps(each["value"]).encode())
    for name, kind in QUERIES.items()
    if name != "evolution"
    for each in EXAMPLES[name].values()
]


async def parallel(port: int, _server: psutil.Process) -> list[Row]:
    texts = [request(path, body) for path, body in REQUESTS]
    chosen = [texts[n % len(texts)] for n in range(1000)]
    async with clients(port, 1) as (client,):
        serial = {text: (await patiently(client, text)).body for text in texts}
    random.Random(1).shuffle(chosen)
    same = 0
    async with clients(port, 50) as many:
        queue = list(chosen)

        async def work(client: Client) -> int:
            right = 0
            while queue:
                text = queue.pop()
                right += (await patiently(client, text)).body == serial[text]
            return right

        same = sum(await asyncio.gather(*(work(client) for client in many)))
    what = "1000 requests by 50 clients, compared with serial ones"
    return [Row(what, f"{same} bit-identical", "1000", same == 1000)]


async def patiently(client: Client, text: bytes) -> Response:
    """Return the response; repeat the request as long as the service is busy."""
    while True:
        answer = await client.ask(text)
        if answer.status != 503:
            return answer
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

    for _ in range(10):
        # Connections would not outlive the pause of a client that is done before the others.
        async with clients(port, 4) as many:
            await asyncio.gather(*(work(client, 2_500) for client in many))
        levels.append(server.memory_info().rss / MEBIBYTE)
    growth = levels[-1] - levels[0]
    return [
        Row(
            "10⁵ mixed requests: growth of memory after the first 10⁴",
            f"{growth:.2f} MiB",
            "<= 4 MiB",
            growth <= 4.0 and set(counts) <= {200, 400, 404, 503},
            f"statuses {dict(counts)}",
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
            if answer.status == 200 and (fault := fault_of(answer.body)):
                faults[fault] += 1

    async with clients(port, 8) as many:
        await asyncio.gather(*(work(client) for client in many))
    return [
        Row(
            "10⁵ bodies with mutated bytes",
            f"{dict(faults) or 'no fault'}",
            "0 × 500, reset, undocumented, NaN or null without a warning",
            not faults,
            f"statuses {dict(sorted(counts.items()))}",
        )
    ]


def mutation(body: bytes, rng: random.Random) -> bytes:
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


def fault_of(body: bytes) -> str | None:
    """Return the fault of a result, if any: invalid JSON, or an infinity without a warning."""
    try:
        answer = strict_json.loads(body)
    except ValueError:
        return "not JSON"
    # The members of a warning may be null whatever the results are.
    codes = {each["code"] for each in answer.pop("warnings")}
    explained = codes & {"singular", "endless_wear"}
    return "null without a warning" if "null" in json.dumps(answer) and not explained else None


async def schema(port: int, _server: psutil.Process) -> list[Row]:
    """Requests generated from the OpenAPI document, valid and invalid."""
    command = [
        str(Path(sys.executable).with_name("schemathesis")),
        *("--config-file", str(Path(__file__).with_name("schemathesis.toml")), "--no-color"),
        *("run", f"http://127.0.0.1:{port}/openapi.json", "--continue-on-failure"),
        *("--phases", "examples,coverage,fuzzing", "--max-examples", "350", "--seed", "1"),
    ]
    process = await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT
    )
    output, _ = await process.communicate()
    text = output.decode()
    cases = re.search(r"(\d+) generated", text)
    failures = [line.strip() for line in text.splitlines() if line.strip().startswith("❌ ST")]
    if failures:
        # With the commands that show each of them.
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
