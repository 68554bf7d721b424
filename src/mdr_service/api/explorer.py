"""The explorer, the page at ``/`` with its files, the manual, and the texts to which they link."""

import gzip
import sys
from functools import cache
from importlib.metadata import distribution
from pathlib import Path
from typing import Final

from anyio import to_thread
from fastapi import APIRouter, Request
from starlette.responses import (
    FileResponse,
    JSONResponse,
    PlainTextResponse,
    RedirectResponse,
    Response,
)
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from mdr_service.api.documentation import PAGE_HEADERS
from mdr_service.middleware import header

router = APIRouter(include_in_schema=False)

_OWN: Final = "mdr-contact"
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


@cache
def _compressed(path: str, _changed: float) -> bytes:
    """Return a file, compressed once: Plotly's takes 0.06 s or more."""
    return gzip.compress(Path(path).read_bytes(), compresslevel=6, mtime=0)


class Pages(StaticFiles):
    """Files with the security policy of the pages; browsers revalidate them on every visit."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file, compressed if the client takes that, or the status 304."""
        response = await super().get_response(path, scope)
        headers = PAGE_HEADERS | {"Cache-Control": "no-cache", "Vary": "Accept-Encoding"}
        response.headers.update(headers)
        if not isinstance(response, FileResponse) or not response.stat_result:
            return response
        if "gzip" not in header(scope, b"accept-encoding"):
            return response
        file = str(response.path), response.stat_result.st_mtime
        body = await to_thread.run_sync(_compressed, *file)
        response.headers["Content-Encoding"] = "gzip"
        del response.headers["content-length"]
        return Response(body, response.status_code, response.headers)


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
    return PlainTextResponse(distribution(_OWN).metadata.json["description"])


@router.get("/license")
async def license_() -> Response:
    """Return the licence of the service."""
    return PlainTextResponse(distribution(_OWN).read_text("licenses/LICENSE"))
