"""The explorer, the page at ``/`` with its files, the manual, and the texts to which they link."""

import asyncio
import gzip
import sys
from functools import cache
from hashlib import sha256
from importlib.metadata import distribution, version
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from fastapi import APIRouter, Request
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.staticfiles import StaticFiles

from mdr_service.api.documentation import PAGE_HEADERS

if TYPE_CHECKING:
    from collections.abc import Mapping

router = APIRouter(include_in_schema=False)

# The version in the name lets browsers keep the library until another one is installed.
_PLOTLY: Final = f"plotly-{version('plotly')}.min.js"
_OWN: Final = "mdr-contact"
_MEDIA_TYPES: Final = {
    "css": "text/css",
    "html": "text/html",
    "js": "text/javascript",
    "svg": "image/svg+xml",
}
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


class _File(NamedTuple):
    compressed: bytes
    tag: str


@cache
def _file(name: str) -> _File:
    """Return a file of the page, compressed once. Raises OSError if there is none."""
    if name == _PLOTLY:
        path = distribution("plotly").locate_file("plotly/package_data/plotly.min.js")
        content = Path(str(path)).read_bytes()
    else:
        content = files("mdr_service").joinpath("explorer", name).read_bytes()
        if name == "index.html":
            content = content.replace(b"plotly.min.js", _PLOTLY.encode())
    compressed = gzip.compress(content, mtime=0)
    return _File(compressed, f'"{sha256(compressed).hexdigest()[:32]}"')


async def _respond(name: str, request: Request, headers: "Mapping[str, str]") -> Response:
    file = await asyncio.to_thread(_file, name)
    headers = {"ETag": file.tag, "Vary": "Accept, Accept-Encoding", **headers}
    if request.headers.get("if-none-match") == file.tag:
        return Response(status_code=304, headers=headers)
    media_type = _MEDIA_TYPES[name.rpartition(".")[2]]
    if "gzip" in request.headers.get("accept-encoding", ""):
        headers = {**headers, "Content-Encoding": "gzip"}
        return Response(file.compressed, media_type=media_type, headers=headers)
    return Response(gzip.decompress(file.compressed), media_type=media_type, headers=headers)


@router.get("/")
async def page(request: Request) -> Response:
    """Return the explorer, or for ``Accept: application/json`` the links of the service."""
    if request.headers.get("accept", "").startswith("application/json"):
        return JSONResponse(_LINKS, headers={"Vary": "Accept"})
    return await _respond("index.html", request, {"Cache-Control": "no-cache", **PAGE_HEADERS})


@router.get("/explorer/{name}")
async def file(name: str, request: Request) -> Response:
    """Return a file of the explorer."""
    known = {each.name for each in files("mdr_service").joinpath("explorer").iterdir()}
    if name == _PLOTLY:
        lasting = {"Cache-Control": "public, max-age=31536000, immutable"}
        return await _respond(name, request, lasting)
    if name not in known:
        raise HTTPException(404)
    return await _respond(name, request, {"Cache-Control": "no-cache"})


@router.get("/manual")
async def manual() -> Response:
    """Redirect to the manual, or to the introduction if it is not built."""
    return RedirectResponse("manual/" if MANUAL.is_dir() else "readme")


class Manual(StaticFiles):
    """Files of the manual, with the security policy of the explorer."""

    def file_response(self, *arguments: Any, **options: Any) -> Response:
        """Return a file with the policy."""
        response = super().file_response(*arguments, **options)
        response.headers.update(PAGE_HEADERS)
        return response


@router.get("/readme")
async def readme() -> Response:
    """Return the introduction to the service."""
    return PlainTextResponse(distribution(_OWN).metadata.json["description"])


@router.get("/license")
async def license_() -> Response:
    """Return the licence of the service."""
    return PlainTextResponse(distribution(_OWN).read_text("licenses/LICENSE"))
