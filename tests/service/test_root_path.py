"""Behind a root path, endpoints are found and responses are unchanged."""

import asyncio

import pytest
from httpx import ASGITransport, AsyncClient, Response

from mdr_service.app import create_app

APP = create_app()
GOOD = b'{"profile":{"kind":"cone","slope":0.1},"material":{"e_star":1},"load":{"normal_force":1}}'


def send(root_path: str, method: str, path: str, body: bytes) -> Response:
    async def request() -> Response:
        transport = ASGITransport(APP, root_path=root_path)
        async with AsyncClient(transport=transport, base_url="http://service") as client:
            headers = {"Content-Type": "application/json", "X-Request-Id": "one"}
            return await client.request(method, root_path + path, content=body, headers=headers)

    return asyncio.run(request())


@pytest.mark.parametrize(
    ("status", "method", "path", "body"),
    [
        (200, "POST", "/v1/normal", GOOD),
        (422, "POST", "/v1/normal", b"{}"),
        (400, "POST", "/v1/normal", b"{"),
        (200, "GET", "/health", b""),
        (200, "HEAD", "/health", b""),
        (404, "GET", "/v1", b""),
        (405, "PUT", "/v1/normal", GOOD),
    ],
)
def test_below_a_root_path(status: int, method: str, path: str, body: bytes) -> None:
    here, below = (send(root, method, path, body) for root in ("", "/mdr"))
    assert here.status_code == status
    assert (below.status_code, below.headers, below.content) == (
        here.status_code,
        here.headers,
        here.content,
    )
