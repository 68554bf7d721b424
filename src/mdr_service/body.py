"""The body of a request, as long as it may be and of the type that is understood."""

from asyncio import timeout
from collections.abc import Coroutine, Generator
from types import coroutine
from typing import Any

from fastapi import Request
from starlette.requests import ClientDisconnect

from mdr_service import headers, problems, wire
from mdr_service.settings import SETTINGS


async def read(request: Request) -> bytes:
    """Return the body, refusing it as soon as it is known to be too long or too slow."""
    given = headers.first(request.scope, b"content-type")
    media_type = given.partition(";")[0].strip().lower()
    if media_type != wire.MEDIA_TYPE:
        raise problems.ServiceError(
            problems.UNSUPPORTED_MEDIA_TYPE, f"the Content-Type must be {wire.MEDIA_TYPE}"
        )
    announced = headers.first(request.scope, b"content-length")
    if announced.isdecimal() and int(announced) > SETTINGS.max_body_bytes:
        raise _too_large()
    receiving = _received(request)
    try:
        # Most often all of it is there already. Then it is not waited for, and needs no clock,
        # which takes nearly as long as to parse a small one.
        waited_for = receiving.send(None)
    except StopIteration as received:
        body: bytes = received.value
        return body
    try:
        async with timeout(SETTINGS.body_seconds):
            return await _resumed(receiving, waited_for)
    except TimeoutError:
        detail = f"it is waited for {SETTINGS.body_seconds:g} s"
        raise problems.ServiceError(problems.BODY_TOO_SLOW, detail) from None


@coroutine
def _resumed(
    receiving: Coroutine[Any, Any, bytes], waited_for: object
) -> Generator[Any, Any, bytes]:
    """Go on with what waits already."""
    try:
        yield waited_for
    except BaseException:
        receiving.close()
        raise
    return (yield from receiving.__await__())


async def _received(request: Request) -> bytes:
    chunks: list[bytes] = []
    size = 0
    more = True
    while more:
        message = await request.receive()
        if message["type"] == "http.disconnect":
            raise ClientDisconnect
        chunk = message.get("body", b"")
        size += len(chunk)
        if size > SETTINGS.max_body_bytes:
            raise _too_large()
        chunks.append(chunk)
        more = message.get("more_body", False)
    return b"".join(chunks)


def _too_large() -> problems.ServiceError:
    return problems.ServiceError(
        problems.BODY_TOO_LARGE, f"the limit is {SETTINGS.max_body_bytes} bytes"
    )
