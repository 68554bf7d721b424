"""Requests per second of `/v1/normal` against a bare endpoint of the framework.

The bare endpoint validates the same body with the same model and returns a constant. Each is served
by one worker with the same event loop and parser, in a process of its own. They receive requests in
turn, so that one is idle while the other works.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median

import measure

from mdr_service.schemas.examples import EXAMPLES

HOST = "127.0.0.1"
# Requests/s at PORT/PATH.
Load = Callable[[str], float]
BODY = json.dumps(EXAMPLES["normal"]["hertz"]["value"])
CONNECTIONS, ROUND_SECONDS, ROUNDS = 4, 1, 9
# Start-up takes longer on a busy machine.
START_SECONDS = 60


def rows() -> list[measure.Row]:
    """The ratios, with the rates and the load generator."""
    with ExitStack() as stack:
        service = [sys.executable, "-m", "mdr_command", "serve", "--port"]
        bare = [sys.executable, str(Path(__file__).with_name("bare_endpoint.py"))]
        mdr_port, bare_port = (stack.enter_context(server(command)) for command in (service, bare))
        load = stack.enter_context(load_generator(BODY))
        targets = [f"{mdr_port}/v1/normal", f"{bare_port}/declared", f"{bare_port}/dict"]
        for target in targets:
            check(target, BODY)
            load(target)
        rounds = [[load(target) for target in targets] for _ in range(measure.count(ROUNDS))]
    return [
        _row(load, f"bare FastAPI endpoint, {kind}", [(one[0], one[index]) for one in rounds])
        for index, kind in ((1, "declared response"), (2, "plain dict"))
    ]


def _row(load: Load, other: str, rounds: list[tuple[float, float]]) -> measure.Row:
    mdr_rate, bare_rate = (median(column) for column in zip(*rounds, strict=True))
    return measure.Row(
        f"/v1/normal, one load, requests/s / {other}",
        load.__name__.removeprefix("_"),
        *measure.spread(rounds),
        ">= 0.7",
        f"{mdr_rate:.0f} / {bare_rate:.0f} requests/s, {CONNECTIONS} connections",
    )


@contextmanager
def server(command: list[str]) -> Iterator[int]:
    """A running server process on a free port."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        port = int(probe.getsockname()[1])
    process = subprocess.Popen(
        [*command, str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        end = time.monotonic() + START_SECONDS
        while not _listens(port):
            if process.poll() is not None or time.monotonic() > end:
                raise RuntimeError(f"{' '.join(command)} does not start")
            time.sleep(0.05)
        yield port
    finally:
        process.terminate()
        process.wait(10)


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex((HOST, port)) == 0


def _request(target: str, body: str) -> tuple[int, bytes]:
    port, path = target.split("/", 1)
    head = (
        f"POST /{path} HTTP/1.1",
        f"Host: {HOST}",
        "Content-Type: application/json",
        f"Content-Length: {len(body)}",
    )
    return int(port), ("\r\n".join(head) + "\r\n\r\n" + body).encode()


def check(target: str, body: str) -> None:
    """Raise unless the server responds; the tests check the content."""
    port, request = _request(target, body)
    with socket.create_connection((HOST, port)) as connection:
        connection.sendall(request)
        status = connection.recv(4096).split(b"\r\n", 1)[0]
    if b" 200 " not in status:
        raise RuntimeError(f"the server responds {status!r}")


@contextmanager
def load_generator(body: str) -> Iterator[Load]:
    if shutil.which("wrk") is None:

        def _asyncio_client(target: str) -> float:
            """A client in Python, which costs as much CPU time as a small server."""
            return rate(target, itertools.repeat(body), max(ROUND_SECONDS * measure.PART, 0.2))

        yield _asyncio_client
        return
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "post.lua"
        script.write_text(
            f"wrk.method = 'POST'\nwrk.body = '{body}'\n"
            "wrk.headers['Content-Type'] = 'application/json'\n"
        )

        def _wrk(target: str) -> float:
            command = ["wrk", "-t1", f"-c{CONNECTIONS}", f"-d{ROUND_SECONDS}s", "-s", str(script)]
            answer = subprocess.run(
                [*command, f"http://{HOST}:{target}"],
                check=True,
                capture_output=True,
                text=True,
            ).stdout
            if "Non-2xx" in answer:
                raise RuntimeError(answer)
            return float(answer.split("Requests/sec:")[1].split()[0])

        yield _wrk


def rate(
    target: str,
    bodies: Iterator[str],
    seconds: float,
    connections: int = CONNECTIONS,
    warm_up: float = 0.0,
) -> float:
    """Requests per second of a client in this process that sends the bodies in turn.

    Each connection first sends requests for `warm_up` seconds, which do not count.
    """
    return asyncio.run(_drive(target, bodies, seconds, connections, warm_up))


async def _drive(
    target: str, bodies: Iterator[str], seconds: float, connections: int, warm_up: float
) -> float:
    sent = (_send(target, bodies, seconds, warm_up) for _ in range(connections))
    return sum(await asyncio.gather(*sent))


async def _send(target: str, bodies: Iterator[str], seconds: float, warm_up: float) -> float:
    port, _ = target.split("/", 1)
    reader, writer = await asyncio.open_connection(HOST, int(port))
    for duration in (warm_up, seconds):
        count, start = 0, time.perf_counter()
        while (now := time.perf_counter()) < start + duration:
            writer.write(_request(target, next(bodies))[1])
            head = await reader.readuntil(b"\r\n\r\n")
            length = head.lower().split(b"content-length:", 1)[1].split(b"\r\n", 1)[0]
            await reader.readexactly(int(length))
            count += 1
    writer.close()
    await writer.wait_closed()
    return count / (now - start)
