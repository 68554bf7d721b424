"""The explorer, the page at ``/`` with its files, the manual, and the texts to which they link."""

import sys
from importlib.metadata import distribution
from pathlib import Path
from typing import Final

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from mdr_service.api.documentation import PAGE_HEADERS

router = APIRouter(include_in_schema=False)

_OWN: Final = distribution("mdr-contact")
_README: Final = str(_OWN.metadata.json["description"])
_LICENSE: Final = _OWN.read_text("licenses/LICENSE")
_HEADERS: Final = PAGE_HEADERS | {"Cache-Control": "no-cache", "Accept-Ranges": "none"}
# The manual is built by `make docs`, and in the container image.
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


class Pages(StaticFiles):
    """Files with the security policy of the pages; browsers revalidate them on every visit."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file, or the status 304.

        A header `Range` is ignored, as RFC 9110 allows: the files are small.
        """
        scope["headers"] = [each for each in scope["headers"] if each[0] != b"range"]
        response = await super().get_response(path, scope)
        response.headers.update(_HEADERS)
        return response


FILES: Final = Pages(packages=[("mdr_service", "explorer")])


@router.get("/")
async def page(request: Request) -> Response:
    """Return the explorer, or for ``Accept: application/json`` the links of the service."""
    if request.headers.get("accept", "").startswith("application/json"):
        return JSONResponse(_LINKS, headers={"Vary": "Accept"})
    response = await FILES.get_response("index.html", request.scope)
    response.headers["Vary"] = "Accept"
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
    return Response(request.app.state.openapi, media_type="application/json")
