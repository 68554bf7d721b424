"""The application, put together."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version

from fastapi import FastAPI
from starlette.staticfiles import StaticFiles

from mdr_service import handlers, openapi, routes
from mdr_service.compute import COMPUTE


@asynccontextmanager
async def _lifespan(_app: FastAPI) -> AsyncIterator[None]:
    async with COMPUTE.ready():
        yield


def create_app() -> FastAPI:
    """Return the application, ready to serve."""
    # The framework's own pages load their scripts from other hosts.
    app = FastAPI(
        routes=routes.router.routes,
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        # It would look for a collector at every request; `/metrics` tells more.
        telemetry={"tracing": False, "metrics": False, "logs": False},
        lifespan=_lifespan,
    )
    handlers.install(app, routes.ENDPOINTS)
    app.state.openapi = openapi.document(version("mdr"), app.routes)
    app.mount("/docs/swagger", StaticFiles(packages=[("fastapi_swagger", "resources")]))
    app.mount("/docs/page", StaticFiles(packages=[("mdr_service", "page")]))
    return app
