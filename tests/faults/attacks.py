"""Hostile and heavy clients: `python -m tests.faults.attacks NAME PORT SECONDS`.

Each attack runs in a separate process, so that it does not slow the measurements of a test.
Prints the number of responses by status; 0 denotes a closed connection.
"""

import asyncio
import json
import sys
import time
from collections import Counter
from collections.abc import Awaitable, Callable
from contextlib import suppress

from mdr_service.api.query_route import MAX_PARSED_ON_LOOP
from mdr_service.schemas.examples import EXAMPLES
from tests.faults.load import HOST, Client, ResetError, post, request

MEGABYTE = 2**20
# Address of the attackers; the clients that are measured have another.
ADDRESS = "127.0.0.2"
MATERIAL = {"e_star": 1.0, "g_star": 0.8}
CONE = {"profile": {"kind": "cone", "slope": 0.1}, "material": MATERIAL}
SMALL = post("/v1/normal", CONE | {"load": {"normal_force": 1.0}})


def tangential(count: int) -> bytes:
    return post(
        "/v1/tangential",
        {
            "profile": {"kind": "sphere", "radius": 10.0},
            "material": MATERIAL,
            "load": {"indentation_depth": 0.05},
            "friction_coefficient": 0.3,
            "tangential": {"tangential_force": [1e-4 + 1e-9 * n for n in range(count)]},
        },
    )


# Core seconds each. The first is expensive to send and to compute, the other only to compute.
EXPENSIVE = (
    post(
        "/v1/normal",
        {
            "profile": {
                "kind": "tabulated",
                "r": [n / 199 for n in range(200)],
                "f": [(n / 199) ** 2 / 20 for n in range(200)],
            },
            "material": MATERIAL,
            "load": {"normal_force": [1e-6 + 1e-11 * n for n in range(10_000)]},
        },
    ),
    post(
        "/v1/wear/evolution",
        EXAMPLES["evolution"]["shakedown"]["value"]
        | {"resolution": 96, "cycles": [float(10 * n) for n in range(2000)]},
    ),
)


def new_table(number: int, points: int = 1_100) -> bytes:
    """Return a query about a table that no other has, almost as long as the event loop parses."""
    heights = [f"{n * n * (1 + 1e-4 * number):.6g}" for n in range(points)]
    table = f'"kind":"tabulated","r":{list(range(points))},"f":[{",".join(heights)}]'
    rest = '"material":{"e_star":1.0},"load":{"normal_force":1e3}'
    body = f'{{"profile":{{{table}}},{rest}}}'.replace(" ", "").encode()
    assert 12_000 < len(body) <= MAX_PARSED_ON_LOOP
    return request("/v1/normal", body)


UNKNOWN_FIELDS = request(
    "/v1/normal", b"{" + b",".join(b'"f%d":0' % n for n in range(100_000)) + b"}"
)
BATCH = post(
    "/v1/batch",
    {"queries": [{"ask": "normal", "request": CONE | {"load": {"normal_force": 1.0}}}] * 1000},
)
# The largest response: the maximum number of values of one query.
LARGEST = post(
    "/v1/stress",
    CONE
    | {"load": {"normal_force": [1.0 + 1e-3 * n for n in range(100)]}}
    | {"radius": [2.5e-4 * n for n in range(1, 10_001)], "quantities": ["pressure"]},
)

Attack = Callable[[int, float], Awaitable[Counter[int]]]


def statuses(response: bytes) -> Counter[int]:
    return Counter([int(response[9:12]) if response.startswith(b"HTTP/1.1 ") else 0])


def sending(
    head: bytes, piece: bytes, length: int, clients: int = 1, patience: float = 5.0
) -> Attack:
    """Return an attack that repeatedly sends a head and a part of its body, then waits."""

    async def once(port: int) -> Counter[int]:
        reader, writer = await asyncio.open_connection(HOST, port)
        with suppress(ConnectionError):
            writer.write(head)
            for _ in range(length // len(piece)):
                writer.write(piece)
                await writer.drain()
        response = b""
        with suppress(ConnectionError, TimeoutError):
            async with asyncio.timeout(patience):
                response = await reader.read(MEGABYTE)
        writer.close()
        return statuses(response)

    return repeated(once, clients)


def requesting(text: bytes | tuple[bytes, ...], clients: int) -> Attack:
    """Return an attack of clients that send valid requests and read the responses."""
    texts = (text,) if isinstance(text, bytes) else text
    numbers = iter(range(clients))

    async def once(client: Client, index: int) -> Counter[int]:
        try:
            response = await client.ask(texts[index % len(texts)])
        except (ConnectionError, ResetError):
            await asyncio.sleep(0.1)
            return Counter([0])
        if response.status == 503:
            await asyncio.sleep(0.5)
        return Counter([response.status])

    async def attack(port: int, seconds: float) -> Counter[int]:
        end = time.monotonic() + seconds
        result: Counter[int] = Counter()

        async def keep_sending(index: int) -> None:
            client = Client(port, ADDRESS)
            while time.monotonic() < end:
                result.update(await once(client, index))
                index += 1
            await client.close()

        await asyncio.gather(*(keep_sending(number) for number in numbers))
        return result

    return attack


def repeated(once: Callable[[int], Awaitable[Counter[int]]], clients: int) -> Attack:
    async def attack(port: int, seconds: float) -> Counter[int]:
        end = time.monotonic() + seconds
        result: Counter[int] = Counter()

        async def keep_on() -> None:
            while time.monotonic() < end:
                try:
                    result.update(await once(port))
                except ConnectionError:
                    result[0] += 1
                    await asyncio.sleep(0.1)

        await asyncio.gather(*(keep_on() for _ in range(clients)))
        return result

    return attack


async def slow_readers(port: int, seconds: float) -> Counter[int]:
    """Request the largest response and read its first bytes only."""
    end = time.monotonic() + seconds

    async def one() -> Counter[int]:
        result: Counter[int] = Counter()
        while time.monotonic() < end:
            with suppress(ConnectionError):
                reader, writer = await asyncio.open_connection(HOST, port, limit=1024)
                writer.write(LARGEST)
                status = statuses(await reader.read(100))
                result += status
                # A rejected client tries again; the others keep their connections.
                await asyncio.sleep(end - time.monotonic() if status[200] else 0.5)
                writer.close()
        return result

    return sum(await asyncio.gather(*(one() for _ in range(20))), Counter())


async def slow_headers(port: int, seconds: float) -> Counter[int]:
    """Send one header per second on many connections, and never finish."""
    end = time.monotonic() + seconds

    async def one(number: int) -> Counter[int]:
        result: Counter[int] = Counter()
        await asyncio.sleep(number / 500)
        while time.monotonic() < end:
            try:
                result += await keep_open(*await asyncio.open_connection(HOST, port))
            except ConnectionError:
                result[0] += 1
                await asyncio.sleep(1.0)
        return result

    async def keep_open(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> Counter[int]:
        writer.write(b"GET / HTTP/1.1\r\n")
        response = b""
        while time.monotonic() < end and not response and not reader.at_eof():
            writer.write(b"X: y\r\n")
            with suppress(TimeoutError):
                async with asyncio.timeout(1.0):
                    response = await reader.read(100)
        writer.close()
        return statuses(response)

    return sum(await asyncio.gather(*(one(number) for number in range(500))), Counter())


HEAD = b"POST /v1/normal HTTP/1.1\r\nHost: x\r\n"
CHUNKED = HEAD + b"Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n"
ATTACKS: dict[str, Attack] = {
    "50 MB header value": sending(HEAD + b"X: ", b"a" * MEGABYTE, 50 * MEGABYTE),
    "50 MB of header lines": sending(HEAD, b"X: y\r\n" * 100_000, 50 * MEGABYTE),
    "50 MB of trailers": sending(CHUNKED, b"X: y\r\n" * 100_000, 50 * MEGABYTE),
    "floods of pipelined requests": sending(
        b"", b"GET /health HTTP/1.1\r\nHost: x\r\n\r\n" * 10_000, 4 * MEGABYTE, clients=4
    ),
    # More than the service keeps.
    "new tables, 1 client": requesting(tuple(map(new_table, range(50))), clients=1),
    "10⁵ unknown fields, 4 clients": requesting(UNKNOWN_FIELDS, clients=4),
    "batches of 1000, 20 clients": requesting(BATCH, clients=20),
    "20 slow readers": slow_readers,
    "100 long bodies without an end": sending(
        request("/v1/normal", b" " * 4 * MEGABYTE)[: -4 * MEGABYTE],
        b" " * (4 * MEGABYTE - 1),
        4 * MEGABYTE - 1,
        clients=100,
        patience=15.0,
    ),
    "500 slow headers": slow_headers,
    "200 clients of small queries": requesting(SMALL, clients=200),
    "50 readers of /readme": requesting(request("/readme", None), clients=50),
    "50 readers of /openapi.json": requesting(request("/openapi.json", None), clients=50),
    "expensive queries, 1 client": requesting(EXPENSIVE, clients=1),
    "expensive queries, 20 clients": requesting(EXPENSIVE, clients=20),
    "expensive queries, 2 clients": requesting(EXPENSIVE[1:], clients=2),
}


def main(name: str, port: int, seconds: float) -> None:
    result = asyncio.run(ATTACKS[name](port, seconds))
    sys.stdout.write(json.dumps(dict(sorted(result.items()))))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))
