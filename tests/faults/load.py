"""Asynchronous clients over raw sockets."""

import asyncio
import json
import time
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

HOST = "127.0.0.1"


@dataclass(frozen=True)
class Response:
    """A response and its time."""

    status: int
    body: bytes
    seconds: float


class ResetError(Exception):
    """The server closed the connection without a response."""


def request(path: str, body: bytes | None, headers: Sequence[str] = ()) -> bytes:
    """Return the bytes of a request: GET without a body, POST with one."""
    lines = [f"{'GET' if body is None else 'POST'} {path} HTTP/1.1", f"Host: {HOST}", *headers]
    if body is not None:
        lines += ["Content-Type: application/json", f"Content-Length: {len(body)}"]
    return ("\r\n".join(lines) + "\r\n\r\n").encode() + (body or b"")


def post(path: str, query: Any) -> bytes:
    return request(path, json.dumps(query).encode())


class Client:
    """A persistent connection, reopened after a response that closes it."""

    def __init__(self, port: int, address: str = HOST) -> None:
        self._port = port
        self._address = address
        self._streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def ask(self, text: bytes) -> Response:
        if self._streams is None:
            self._streams = await asyncio.open_connection(
                HOST, self._port, limit=2**26, local_addr=(self._address, 0)
            )
        reader, writer = self._streams
        start = time.perf_counter()
        try:
            writer.write(text)
            head = (await reader.readuntil(b"\r\n\r\n")).lower()
            length = int(head.split(b"content-length:", 1)[1].split(b"\r\n", 1)[0])
            body = await reader.readexactly(length)
        except (asyncio.IncompleteReadError, ConnectionError) as error:
            await self.close()
            raise ResetError from error
        taken = time.perf_counter() - start
        if b"\r\nconnection: close" in head:
            await self.close()
        return Response(int(head.split(b" ", 2)[1]), body, taken)

    async def close(self) -> None:
        if self._streams:
            _, writer = self._streams
            self._streams = None
            writer.close()


@asynccontextmanager
async def clients(port: int, count: int) -> AsyncIterator[list[Client]]:
    result = [Client(port) for _ in range(count)]
    try:
        yield result
    finally:
        for client in result:
            await client.close()


def percentile(values: Sequence[float], share: float) -> float:
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]
