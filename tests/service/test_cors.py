"""Requests from pages of other hosts: off by default, and for each origin that is named."""

import asyncio

import httpx
import pytest
from fastapi import FastAPI
from httpx import ASGITransport, AsyncClient, Response

from mdr_service import middleware
from mdr_service.app import create_app
from mdr_service.settings import SETTINGS, from_environment
from mdr_service.workers import WorkerPool

PAGE = "https://page.example"
HERTZ = {"profile": {"kind": "paraboloid", "radius": 0.01}, "material": {"e_star": 1e11}}
LOADED = HERTZ | {"load": {"normal_force": 1.0}}
TABLE = LOADED | {"profile": {"kind": "tabulated", "r": [0, 1e-3], "f": [0, 1e-6]}}


def application(monkeypatch: pytest.MonkeyPatch, origins: str) -> FastAPI:
    given = from_environment({"MDR_CORS_ORIGINS": origins} if origins else {})
    monkeypatch.setattr(middleware, "SETTINGS", given)
    app = create_app()
    # Without a process or a queue whatever needs one is refused.
    none = SETTINGS.model_copy(update={"queue_length": 0})
    app.state.workers = WorkerPool(none, app.state.transfers)
    return app


def ask(app: FastAPI, method: str, path: str, origin: str = PAGE, **options: object) -> Response:
    async def asked() -> Response:
        async with AsyncClient(transport=ASGITransport(app), base_url="http://service") as client:
            headers = {"Origin": origin, **options.pop("headers", {})}
            return await client.request(method, path, headers=headers, **options)

    return asyncio.run(asked())


def preflight(app: FastAPI, origin: str = PAGE) -> Response:
    asked = {"Access-Control-Request-Method": "POST"}
    asked["Access-Control-Request-Headers"] = "content-type"
    return ask(app, "OPTIONS", "/v1/normal", origin, headers=asked)


def allowed(response: httpx.Response) -> str | None:
    return response.headers.get("access-control-allow-origin")


def test_no_other_page_may_ask_by_default(monkeypatch: pytest.MonkeyPatch) -> None:
    app = application(monkeypatch, "")
    assert preflight(app).status_code == 405
    assert allowed(ask(app, "POST", "/v1/normal", json=LOADED)) is None


def test_a_named_page_may_ask_and_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    app = application(monkeypatch, f"http://localhost:5173, {PAGE}")
    answer = preflight(app)
    assert (answer.status_code, allowed(answer)) == (200, PAGE)
    assert "content-type" in answer.headers["access-control-allow-headers"].lower()
    assert preflight(app, "https://other.example").status_code == 400
    answer = ask(app, "POST", "/v1/normal", json=LOADED)
    assert (answer.status_code, allowed(answer)) == (200, PAGE)
    assert allowed(ask(app, "POST", "/v1/normal", "https://other.example", json=LOADED)) is None


def test_all_pages_may_ask(monkeypatch: pytest.MonkeyPatch) -> None:
    assert allowed(ask(application(monkeypatch, "*"), "GET", "/health")) == "*"


@pytest.mark.parametrize(
    ("status", "method", "path", "options"),
    [
        (404, "GET", "/nowhere", {}),
        (405, "DELETE", "/v1/normal", {}),
        (413, "POST", "/v1/normal", {"content": b" " * (SETTINGS.max_body_bytes + 1)}),
        (422, "POST", "/v1/normal", {"json": HERTZ}),
        (500, "GET", "/health/ready", {}),
        (503, "POST", "/v1/normal", {"json": TABLE}),
    ],
)
def test_a_page_can_read_problems(
    status: int,
    method: str,
    path: str,
    options: dict[str, object],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app = application(monkeypatch, PAGE)
    if status == 500:
        app.state.workers = None
    if "content" in options:
        options = options | {"headers": {"Content-Type": "application/json"}}
    answer = ask(app, method, path, **options)
    assert answer.status_code == status
    assert answer.json()["status"] == status
    assert allowed(answer) == PAGE
    assert "X-Request-Id" in answer.headers["access-control-expose-headers"]


@pytest.mark.parametrize("origins", ["page.example", "https://page.example/", "https://a b"])
def test_what_is_no_origin_ends_the_start(origins: str) -> None:
    with pytest.raises(SystemExit, match="MDR_CORS_ORIGINS: "):
        from_environment({"MDR_CORS_ORIGINS": origins})
