"""Bytes to models and answers to bytes: the only module that touches JSON text."""

import re
from collections.abc import Mapping
from typing import Any, Final, TypeVar

import orjson
from fastapi import Request
from pydantic import BaseModel, ValidationError
from starlette.responses import Response

from mdr_service import problems
from mdr_service.settings import SETTINGS

MEDIA_TYPE: Final = "application/json"
_TOO_MANY_DIGITS: Final = "Invalid JSON: number out of range"
_LONG_INTEGER: Final = re.compile(rb"(?<![\d.])\d{4300,}+(?![\d.eE])")

_Model = TypeVar("_Model", bound=BaseModel)


async def read(request: Request, model: type[_Model]) -> _Model:
    """Return the request's body as a `model`.

    The text is parsed once, straight into the model, which is faster than the framework's own
    way over a dictionary.
    """
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type != MEDIA_TYPE:
        raise problems.ServiceError(
            problems.UNSUPPORTED_MEDIA_TYPE, f"the Content-Type must be {MEDIA_TYPE}"
        )
    body = await _body(request)
    try:
        return _parse(model, body)
    except ValidationError as error:
        raise problems.invalid(error) from None


def _parse(model: type[_Model], body: bytes) -> _Model:
    try:
        return model.model_validate_json(body)
    except ValidationError as error:
        if not error.errors()[0]["msg"].startswith(_TOO_MANY_DIGITS):
            raise
    # The parser stops at an integer this long. It is JSON nevertheless, and no double holds it:
    # written as another such number, it is refused where it stands.
    return model.model_validate_json(_LONG_INTEGER.sub(b"1e999", body))


async def _body(request: Request) -> bytes:
    """Return the body, refusing it as soon as it is known to be too long."""
    announced = request.headers.get("content-length", "")
    if announced.isdecimal() and int(announced) > SETTINGS.max_body_bytes:
        raise _too_large()
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


def answer(document: Mapping[str, Any]) -> Response:
    """Return the response of a document whose numbers are known to be finite, or meant as null."""
    return Response(
        orjson.dumps(document, option=orjson.OPT_SERIALIZE_NUMPY), media_type=MEDIA_TYPE
    )
