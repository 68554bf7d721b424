"""The ASGI application."""

import gc
import multiprocessing
import os
import signal
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

import orjson
from fastapi import FastAPI

from mdr_core import __version__
from mdr_service import health, middleware, openapi
from mdr_service.api import explorer, operations, queries
from mdr_service.compute_processes import ComputePool
from mdr_service.settings import SETTINGS


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    if supervisor := multiprocessing.parent_process():
        # A terminal that closes sends SIGHUP to all processes. Workers ignore it, because the
        # supervisor ends them.
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        threading.Thread(target=_end_after, args=(supervisor.join,), daemon=True).start()
    async with app.state.compute.started(health.self_test):
        # Garbage collection would visit the objects of all modules, and block the event loop for 80
        # ms.
        gc.freeze()
        yield


def _end_after(wait: Callable[[], None]) -> None:
    wait()
    os.kill(os.getpid(), signal.SIGTERM)


def create_app() -> FastAPI:
    """Return the application."""
    app = FastAPI(
        # Routes of an included router take a few microseconds longer per request.
        routes=[route for part in (queries, operations, explorer) for route in part.router.routes],
        title="MDR",
        version=__version__,
        description=openapi.DESCRIPTION,
        openapi_tags=openapi.TAGS,
        license_info={"name": "MIT", "identifier": "MIT"},
        contact={"name": "The MDR authors"},
        # The URL is relative to the document, so that it is valid below a root path as well.
        servers=[{"url": ".", "description": "This service"}],
        separate_input_output_schemas=False,
        # The framework's own pages load scripts from other hosts, and the framework writes its
        # document for each request.
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        # Instrumentation of the framework would search for a collector on every request; `/metrics`
        # covers more.
        telemetry={"tracing": False, "metrics": False, "logs": False},
        lifespan=_lifespan,
    )
    app.state.transfers = middleware.Transfers(SETTINGS.max_transfer_bytes)
    app.state.compute = ComputePool(SETTINGS)
    middleware.install(app)
    # The framework caches the document. It takes a quarter of a second to build, so build it before
    # the first request.
    openapi.extend(app.openapi())
    app.state.openapi = orjson.dumps(app.openapi())
    app.mount("/docs/swagger", explorer.Pages(packages=[("fastapi_swagger", "resources")]))
    app.mount("/docs/page", explorer.Pages(packages=[("mdr_service", "page")]))
    app.mount("/explorer", explorer.FILES)
    if explorer.MANUAL.is_dir():
        app.mount("/manual/", explorer.Pages(directory=explorer.MANUAL, html=True))
    return app
