"""The service in process, for every test that needs no socket."""

import asyncio
from collections.abc import Iterator

import httpx
import pytest

from mdr_service.app import create_app

JSON = {"content-type": "application/json"}


class Client:
    """Asks the application itself, as plain calls."""

    def __init__(self, runner: asyncio.Runner) -> None:
        self._runner = runner
        self._client = httpx.AsyncClient(
            transport=httpx.ASGITransport(create_app()), base_url="http://service"
        )

    def request(self, method: str, path: str, **options: object) -> httpx.Response:
        return self._runner.run(self._client.request(method, path, **options))

    def get(self, path: str) -> httpx.Response:
        return self.request("GET", path)

    def post(self, path: str, query: object) -> httpx.Response:
        return self.request("POST", path, json=query)

    def post_text(self, path: str, body: bytes) -> httpx.Response:
        return self.request("POST", path, content=body, headers=JSON)

    def send(self, request: httpx.Request) -> httpx.Response:
        return self._runner.run(self._client.send(request))

    def close(self) -> None:
        self._runner.run(self._client.aclose())


@pytest.fixture(scope="session")
def client() -> Iterator[Client]:
    with asyncio.Runner() as runner:
        client = Client(runner)
        yield client
        client.close()
