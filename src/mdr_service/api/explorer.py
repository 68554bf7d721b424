"""The explorer, the page at ``/`` with its files, the manual, and the texts to which they link."""

import sys
from importlib.metadata import distribution
from pathlib import Path
from typing import Any, Final

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.staticfiles import StaticFiles

from mdr_service.api.documentation import PAGE_HEADERS

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


class Pages(StaticFiles):
    """Files with the security policy of the pages; browsers ask each time whether one changed."""

    def file_response(self, *arguments: Any, **options: Any) -> Response:
        """Return a file with the policy."""
        response = super().file_response(*arguments, **options)
        response.headers.update(PAGE_HEADERS | {"Cache-Control": "no-cache"})
        return response


FILES: Final = Pages(packages=[("mdr_service", "explorer"), ("plotly", "package_data")])


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
    return PlainTextResponse(distribution(_OWN).metadata.json["description"])


@router.get("/license")
async def license_() -> Response:
    """Return the licence of the service."""
    return PlainTextResponse(distribution(_OWN).read_text("licenses/LICENSE"))
