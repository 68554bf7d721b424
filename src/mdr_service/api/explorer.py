"""The explorer, the page at ``/`` with its files, the manual, and the texts to which they link."""

import gzip
import sys
from collections.abc import AsyncIterator
from functools import cache, partial
from importlib.metadata import distribution
from pathlib import Path
from threading import Lock
from typing import Final

import orjson
from anyio import to_thread
from fastapi import APIRouter, FastAPI, Request
from starlette.responses import (
    FileResponse,
    JSONResponse,
    PlainTextResponse,
    RedirectResponse,
    Response,
    StreamingResponse,
)
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from mdr_service.api.documentation import PAGE_HEADERS
from mdr_service.middleware import LONG, header

router = APIRouter(include_in_schema=False)

_OWN: Final = distribution("mdr-contact")
_README: Final = str(_OWN.metadata.json["description"])
_LICENSE: Final = _OWN.read_text("licenses/LICENSE")
# Built by `make docs`, and in the image.
MANUAL: Final = Path(sys.prefix, "share", "mdr", "manual")
_LINKS: Final = {
    "explorer": "./",
    "documentation": "docs",
    "manual": "manual",
    "readme": "readme",
    "license": "license",
    "openapi": "openapi.json",
    "profiles": "v1/profiles",
    "limits": "v1/limits",
    "health": "health",
    "metrics": "metrics",
}


# The file of Plotly is compressed in 0.15 s of a core: once, however many clients ask for it first.
_reading: Final = Lock()


@cache
def _content(path: str, _changed: float, *, compressed: bool) -> bytes:
    content = Path(path).read_bytes()
    return gzip.compress(content, compresslevel=6, mtime=0) if compressed else content


def _content_once(path: str, changed: float, *, compressed: bool) -> bytes:
    """Return a file, read and compressed once."""
    with _reading:
        return _content(path, changed, compressed=compressed)


async def _pieces(content: bytes) -> AsyncIterator[memoryview]:
    """Yield a file in pieces; a longer one would count as memory of each request."""
    for begin in range(0, len(content), LONG):
        yield memoryview(content)[begin : begin + LONG]


class Pages(StaticFiles):
    """Files with the security policy of the pages; browsers revalidate them on every visit."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file, compressed if the client takes that, or the status 304.

        A header `Range` is ignored, as RFC 9110 allows: the files are small.
        """
        response = await super().get_response(path, scope)
        headers = PAGE_HEADERS | {"Cache-Control": "no-cache", "Vary": "Accept-Encoding"}
        response.headers.update(headers)
        if not isinstance(response, FileResponse) or not response.stat_result:
            return response
        compressed = "gzip" in header(scope, b"accept-encoding")
        file = str(response.path), response.stat_result.st_mtime
        content = await to_thread.run_sync(partial(_content_once, *file, compressed=compressed))
        if compressed:
            response.headers["Content-Encoding"] = "gzip"
        response.headers["Content-Length"] = str(len(content))
        del response.headers["Accept-Ranges"]
        return StreamingResponse(_pieces(content), response.status_code, response.headers)


FILES: Final = Pages(packages=[("mdr_service", "explorer"), ("plotly", "package_data")])


@router.get("/")
async def page(request: Request) -> Response:
    """Return the explorer, or for ``Accept: application/json`` the links of the service."""
    if request.headers.get("accept", "").startswith("application/json"):
        return JSONResponse(_LINKS, headers={"Vary": "Accept"})
    response = await FILES.get_response("index.html", request.scope)
    response.headers["Vary"] = "Accept, Accept-Encoding"
    return response


@router.get("/manual")
async def manual() -> Response:
    """Redirect to the manual, or to the introduction if it is not built."""
    return RedirectResponse("manual/" if MANUAL.is_dir() else "readme")


@router.get("/readme")
async def readme() -> Response:
    """Return the introduction to the service."""
    return PlainTextResponse(_README)


@router.get("/license")
async def license_() -> Response:
    """Return the licence of the service."""
    return PlainTextResponse(_LICENSE)


@router.get("/openapi.json")
async def document(request: Request) -> Response:
    """Return the OpenAPI document."""
    return Response(openapi_document(request.app), media_type="application/json")


@cache
def openapi_document(app: FastAPI) -> bytes:
    """Return the OpenAPI document, which the endpoint of the framework writes for each request."""
    return orjson.dumps(app.openapi())
