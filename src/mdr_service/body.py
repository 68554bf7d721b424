"""The body of a request, as long as it may be and of the type that is understood."""

from asyncio import timeout

from fastapi import Request
from starlette.requests import ClientDisconnect

from mdr_service import problems, wire
from mdr_service.settings import SETTINGS


async def read(request: Request) -> bytes:
    """Return the body, refusing it as soon as it is known to be too long or too slow."""
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type != wire.MEDIA_TYPE:
        raise problems.ServiceError(
            problems.UNSUPPORTED_MEDIA_TYPE, f"the Content-Type must be {wire.MEDIA_TYPE}"
        )
    announced = request.headers.get("content-length", "")
    if announced.isdecimal() and int(announced) > SETTINGS.max_body_bytes:
        raise _too_large()
    try:
        async with timeout(SETTINGS.body_seconds):
            return await _received(request)
    except TimeoutError:
        detail = f"it is waited for {SETTINGS.body_seconds:g} s"
        raise problems.ServiceError(problems.BODY_TOO_SLOW, detail) from None


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
