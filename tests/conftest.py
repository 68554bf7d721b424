"""Fixtures: the service in process, and the selection of the two test tiers."""

import gc
import signal
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import pytest
from anyio.from_thread import BlockingPortal, start_blocking_portal
from fastapi import FastAPI

from mdr_service.app import create_app
from mdr_service.compute_processes import ComputePool
from mdr_service.settings import SETTINGS

JSON = {"content-type": "application/json"}
# Slow machines must not fail tests that do not measure time.
PATIENT = SETTINGS.model_copy(update={"budget_seconds": 300.0, "queue_seconds": 300.0})

# Background processes of a shell ignore SIGINT, those of `nohup` SIGHUP, and pass this on to their
# children, so restore the default for the processes that tests start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave all but every n-th case of a test marked `every(n)` to the long tier."""
    number: Counter[str] = Counter()
    for item in items:
        marker = item.get_closest_marker("every")
        if marker:
            test = item.nodeid.partition("[")[0]
            if number[test] % marker.args[0]:
                item.add_marker(pytest.mark.long)
            number[test] += 1


def pytest_collection_finish() -> None:
    # Each garbage collection would visit all tests, which takes a tenth of the time.
    gc.freeze()


class Client:
    """In-process client of the application."""

    def __init__(self, portal: BlockingPortal, app: FastAPI) -> None:
        self.app = app
        self._portal = portal
        self._client = httpx.AsyncClient(
            transport=httpx.ASGITransport(app), base_url="http://service"
        )

    def request(self, method: str, path: str, **options: object) -> httpx.Response:
        return self._portal.call(lambda: self._client.request(method, path, **options))

    def get(self, path: str) -> httpx.Response:
        return self.request("GET", path)

    def post(self, path: str, query: object) -> httpx.Response:
        return self.request("POST", path, json=query)

    def post_text(self, path: str, body: bytes) -> httpx.Response:
        return self.request("POST", path, content=body, headers=JSON)

    def send(self, request: httpx.Request) -> httpx.Response:
        return self._portal.call(self._client.send, request)

    def close(self) -> None:
        self._portal.call(self._client.aclose)


@contextmanager
def running_client() -> Iterator[Client]:
    """Run the application in process."""
    app = create_app()
    app.state.compute = ComputePool(PATIENT)
    lifespan = app.router.lifespan_context(app)
    with start_blocking_portal() as portal, portal.wrap_async_context_manager(lifespan):
        client = Client(portal, app)
        yield client
        client.close()


@pytest.fixture(scope="session")
def client() -> Iterator[Client]:
    with running_client() as client:
        yield client
