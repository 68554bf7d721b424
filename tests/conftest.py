"""The service in process, for every test that needs no socket."""

from collections.abc import Iterator

import httpx
import pytest
from anyio.from_thread import BlockingPortal, start_blocking_portal

from mdr_service.app import create_app

JSON = {"content-type": "application/json"}


class Client:
    """Asks the application itself, as plain calls."""

    def __init__(self, portal: BlockingPortal) -> None:
        self._portal = portal
        self._client = httpx.AsyncClient(
            transport=httpx.ASGITransport(create_app()), base_url="http://service"
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


@pytest.fixture(scope="session")
def client() -> Iterator[Client]:
    # One loop from the first request to the last: the compute processes end with it.
    with start_blocking_portal() as portal:
        client = Client(portal)
        yield client
        client.close()
