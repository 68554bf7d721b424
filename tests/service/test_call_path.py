"""Number of source files on the call path of a small query, and requests that need no thread."""

import asyncio
import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import mdr_core
import mdr_service
from mdr_core import normal
from mdr_core.profiles import Paraboloid
from mdr_service.app import create_app
from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import JSON, Client

SERVICE, CORE = (Path(str(each.__file__)).parent for each in (mdr_service, mdr_core))
BODY = json.dumps(EXAMPLES["normal"]["hertz"]["value"]).encode()
SCOPE: dict[str, Any] = {
    "type": "http",
    "method": "POST",
    "path": "/v1/normal",
    "query_string": b"",
    "headers": [(b"content-type", b"application/json")],
}


def statuses(app: Any) -> list[int]:
    """Return the status of the response to a Hertz query."""
    messages: list[Any] = []

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": BODY}

    async def send(message: Any) -> None:
        messages.append(message)

    asyncio.run(app(dict(SCOPE), receive, send))
    return [message["status"] for message in messages if "status" in message]


def own(files: Iterable[str]) -> list[str]:
    """Return the files of the service and of the core among `files`."""
    roots = (SERVICE, CORE)
    paths = {Path(file) for file in files}
    return sorted(
        str(path.relative_to(root.parent))
        for path in paths
        for root in roots
        if root in path.parents
    )


def callers(frame: FrameType | None) -> Iterator[str]:
    """Yield the files of a frame and of the frames that wait for it."""
    while frame:
        yield frame.f_code.co_filename
        frame = frame.f_back


def test_small_query_passes_few_files() -> None:
    app = create_app()
    # The first request builds the framework's middleware stack.
    assert statuses(app) == [200]
    called: set[str] = set()
    stacked: set[str] = set()
    solved: list[bool] = []

    def profile(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and not solved:
            called.add(frame.f_code.co_filename)
            if frame.f_code is Paraboloid.coordinate_from_reduced_force.__code__:
                stacked.update(callers(frame))
        elif event == "return" and frame.f_code is normal.solve.__code__:
            solved.append(True)

    sys.setprofile(profile)
    try:
        assert statuses(app) == [200]
    finally:
        sys.setprofile(None)
    assert solved
    # The frames from the application to the number, and all that they call on the way.
    assert len(own(stacked)) <= 7, own(stacked)
    assert len(own(called)) <= 12, own(called)
    assert {"mdr_service/middleware.py", "mdr_service/dispatch.py"} <= set(own(stacked))
    assert {"mdr_core/normal.py", "mdr_core/profiles/powers.py"} <= set(own(stacked))


@pytest.mark.parametrize(
    ("method", "path", "body", "status"),
    [
        ("POST", "/v1/normal", BODY, 200),
        ("POST", "/v1/normal", b"{}", 422),
        ("POST", "/v1/normal", b"{", 400),
        ("GET", "/v1/normal?kind=cone&slope=0.1&e_star=1&normal_force=1", b"", 200),
        ("GET", "/v1/normal?kind=cone&kind=cone", b"", 422),
        ("GET", "/v1/normal?kind=spoon", b"", 422),
        ("GET", "/v1/nowhere", b"", 404),
        ("GET", "/v1/batch", b"", 405),
        ("GET", "/health", b"", 200),
    ],
)
def test_request_needs_no_thread(
    client: Client,
    monkeypatch: pytest.MonkeyPatch,
    method: str,
    path: str,
    body: bytes,
    status: int,
) -> None:
    """The framework runs plain dependencies and exception handlers in a thread, which is slow."""

    async def run_sync(function: object, *_arguments: object, **_options: object) -> None:
        raise AssertionError(f"{function} runs in a thread")

    monkeypatch.setattr("anyio.to_thread.run_sync", run_sync)
    assert client.request(method, path, content=body, headers=JSON).status_code == status
