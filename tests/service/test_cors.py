"""Cross-origin requests: rejected by default, allowed for configured origins."""

import asyncio

import httpx
import pytest
from fastapi import FastAPI
from httpx import ASGITransport, AsyncClient, Response

from mdr_service import middleware
from mdr_service.app import create_app
from mdr_service.compute_processes import ComputePool
from mdr_service.settings import SETTINGS, from_environment

PAGE = "https://page.example"
HERTZ = {"profile": {"kind": "paraboloid", "radius": 0.01}, "material": {"e_star": 1e11}}
LOADED = HERTZ | {"load": {"normal_force": 1.0}}
MANY = HERTZ | {"load": {"normal_force": [1.0] * 10_000}}


def application(monkeypatch: pytest.MonkeyPatch, origins: str) -> FastAPI:
    given = from_environment({"MDR_CORS_ORIGINS": origins} if origins else {})
    monkeypatch.setattr(middleware, "SETTINGS", given)
    app = create_app()
    # Without a compute process or a queue, queries that need one are rejected.
    none = SETTINGS.model_copy(update={"queue_length": 0})
    app.state.compute = ComputePool(none)
    return app


def send(app: FastAPI, method: str, path: str, origin: str = PAGE, **options: object) -> Response:
    async def request() -> Response:
        async with AsyncClient(transport=ASGITransport(app), base_url="http://service") as client:
            headers = {"Origin": origin, **options.pop("headers", {})}
            return await client.request(method, path, headers=headers, **options)

    return asyncio.run(request())


def preflight(app: FastAPI, origin: str = PAGE) -> Response:
    headers = {"Access-Control-Request-Method": "POST"}
    headers["Access-Control-Request-Headers"] = "content-type"
    return send(app, "OPTIONS", "/v1/normal", origin, headers=headers)


def allowed(response: httpx.Response) -> str | None:
    return response.headers.get("access-control-allow-origin")


def test_other_origins_are_rejected_by_default(monkeypatch: pytest.MonkeyPatch) -> None:
    app = application(monkeypatch, "")
    assert preflight(app).status_code == 405
    assert allowed(send(app, "POST", "/v1/normal", json=LOADED)) is None


def test_configured_origin_is_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    app = application(monkeypatch, f"http://localhost:5173, {PAGE}")
    response = preflight(app)
    assert (response.status_code, allowed(response)) == (200, PAGE)
    assert "content-type" in response.headers["access-control-allow-headers"].lower()
    assert preflight(app, "https://other.example").status_code == 400
    response = send(app, "POST", "/v1/normal", json=LOADED)
    assert (response.status_code, allowed(response)) == (200, PAGE)
    assert allowed(send(app, "POST", "/v1/normal", "https://other.example", json=LOADED)) is None


def test_wildcard_allows_all_origins(monkeypatch: pytest.MonkeyPatch) -> None:
    assert allowed(send(application(monkeypatch, "*"), "GET", "/health")) == "*"


@pytest.mark.parametrize(
    ("status", "method", "path", "options"),
    [
        (404, "GET", "/nowhere", {}),
        (405, "DELETE", "/v1/normal", {}),
        (413, "POST", "/v1/normal", {"content": b" " * (SETTINGS.max_body_bytes + 1)}),
        (422, "POST", "/v1/normal", {"json": HERTZ}),
        (500, "GET", "/health/ready", {}),
        (503, "POST", "/v1/normal", {"json": MANY}),
    ],
)
def test_problems_are_readable_across_origins(
    status: int,
    method: str,
    path: str,
    options: dict[str, object],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app = application(monkeypatch, PAGE)
    if status == 500:
        app.state.compute = None
    if "content" in options:
        options = options | {"headers": {"Content-Type": "application/json"}}
    response = send(app, method, path, **options)
    assert response.status_code == status
    assert response.json()["status"] == status
    assert allowed(response) == PAGE
    assert "X-Request-Id" in response.headers["access-control-expose-headers"]


@pytest.mark.parametrize("origins", ["page.example", "https://page.example/", "https://a b"])
def test_invalid_origin_prevents_startup(origins: str) -> None:
    with pytest.raises(SystemExit, match="MDR_CORS_ORIGINS: "):
        from_environment({"MDR_CORS_ORIGINS": origins})
