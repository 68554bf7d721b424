"""A request would pass more source files than documented, or take a thread needlessly."""

import asyncio
import json
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
import uvicorn
from uvicorn.server import ServerState

import mdr_core
import mdr_service
from mdr_service.app import create_app
from mdr_service.dispatch import respond
from mdr_service.protocol import BoundedProtocol
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.serializers import FORMATS
from tests.conftest import JSON, Client

SERVICE, CORE = (Path(str(each.__file__)).parent for each in (mdr_service, mdr_core))
BODY = json.dumps(EXAMPLES["normal"]["hertz"]["value"]).encode()


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


@contextmanager
def recorded(files: set[str]) -> Iterator[None]:
    """Add the files of all functions that are called in this thread within the context."""

    def record(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            files.add(frame.f_code.co_filename)

    sys.setprofile(record)
    try:
        yield
    finally:
        sys.setprofile(None)


async def served(path: str, body: bytes) -> set[str]:
    """Return the files from the bytes of a request on its socket to the end of its response."""
    app, state, found = create_app(), dict[str, Any](), list[set[str]]()
    config = uvicorn.Config(app, http=BoundedProtocol, lifespan="off", log_config=None)
    config.load()
    head = f"POST {path} HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
    text = f"{head}Content-Length: {len(body)}\r\nConnection: close\r\n\r\n".encode() + body

    def protocol() -> BoundedProtocol:
        return BoundedProtocol(config, ServerState(), state)

    async def ask() -> bytes:
        reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
        writer.write(text)
        response = await reader.read()
        writer.close()
        return response

    async with app.router.lifespan_context(app):
        server = await asyncio.get_running_loop().create_server(protocol, "127.0.0.1", 0)
        async with server:
            # The first requests build the framework's middleware stack, and fit a table.
            for _ in range(4):
                assert (await ask()).startswith(b"HTTP/1.1 200 ")
            for _ in range(3):
                found.append(set())
                with recorded(found[-1]):
                    await ask()
    # The supervision of the compute processes, which runs now and then, is part of no request.
    return set.intersection(*found)


def test_small_query_passes_few_files() -> None:
    files = own(asyncio.run(served("/v1/normal", BODY)))
    assert {"mdr_service/protocol.py", "mdr_core/profiles/powers.py"} <= set(files)
    assert {"mdr_service/dispatch.py", "mdr_service/queries/contacts.py"} <= set(files)
    assert len(files) <= 14, files


@pytest.mark.long
def test_history_of_a_table_passes_few_files() -> None:
    """The files of the server and of its compute process."""
    cycles = {"normal": {"normal_force": 1.0}, "tangential": {"tangential_force": 0.1}}
    query = EXAMPLES["history"]["mindlin_deresiewicz"]["value"] | {"cycles": cycles}
    query |= {"profile": EXAMPLES["normal"]["table"]["value"]["profile"]}
    body = json.dumps(query).encode()
    files = asyncio.run(served("/v1/tangential/history", body))
    assert own(files)
    respond("history", body, FORMATS["json"])
    with recorded(files):
        respond("history", body, FORMATS["json"])
    assert {"mdr_service/compute_processes.py", "mdr_core/profiles/tabulated.py"} <= set(own(files))
    assert len(own(files)) <= 30, own(files)


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
