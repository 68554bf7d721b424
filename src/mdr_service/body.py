"""The body of a request, as long as it may be and of the type that is understood."""

from anyio import fail_after
from fastapi import Request

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
        with fail_after(SETTINGS.body_seconds):
            return await _received(request)
    except TimeoutError:
        detail = f"it is waited for {SETTINGS.body_seconds:g} s"
        raise problems.ServiceError(problems.BODY_TOO_SLOW, detail) from None


async def _received(request: Request) -> bytes:
    chunks: list[bytes] = []
    size = 0
    async for chunk in request.stream():
        size += len(chunk)
        if size > SETTINGS.max_body_bytes:
            raise _too_large()
        chunks.append(chunk)
    return b"".join(chunks)


def _too_large() -> problems.ServiceError:
    return problems.ServiceError(
        problems.BODY_TOO_LARGE, f"the limit is {SETTINGS.max_body_bytes} bytes"
    )
