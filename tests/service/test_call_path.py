"""Number of source files on the call path of a small query."""

import asyncio
import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import mdr_core
import mdr_service
from mdr_core import normal
from mdr_core.profiles import Paraboloid
from mdr_service.app import create_app
from mdr_service.schemas.examples import EXAMPLES

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
