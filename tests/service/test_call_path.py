"""Number of source files on the call path of a small query."""

import asyncio
import json
import sys
from pathlib import Path
from types import FrameType
from typing import Any

import mdr_core
import mdr_service
from mdr_core import normal
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


def test_small_query_passes_few_files() -> None:
    app = create_app()
    # The first request builds the framework's middleware stack.
    assert statuses(app) == [200]
    files: set[Path] = set()
    solved: list[bool] = []

    def profile(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and not solved:
            files.add(Path(frame.f_code.co_filename))
        elif event == "return" and frame.f_code is normal.solve.__code__:
            solved.append(True)

    sys.setprofile(profile)
    try:
        assert statuses(app) == [200]
    finally:
        sys.setprofile(None)
    assert solved
    service, core = (
        sorted(str(file.relative_to(root)) for file in files if root in file.parents)
        for root in (SERVICE, CORE)
    )
    assert len(service) <= 7, service
    assert len(core) <= 5, core
    assert {"middleware.py", "dispatch.py", "queries/contacts.py"} <= set(service)
    assert {"normal.py", "profiles/powers.py"} <= set(core)
