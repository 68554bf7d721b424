"""The application, called in process and without sockets."""

import asyncio
import json
import logging
import signal
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from mdr_service.app import create_app
from mdr_service.queries import QUERIES

PATHS: Final = {name: kind.path for name, kind in QUERIES.items()}
SECONDS: Final = 10.0
"""CPU time limit of one request."""


class TooSlow(BaseException):
    """The request exceeded the CPU time limit."""


@dataclass(frozen=True)
class Reply:
    """Status, content and, for an internal error, the traceback."""

    status: int
    content: bytes
    defect: BaseException | None = None


class Service:
    """The application without sockets; it computes everything in this process."""

    def __init__(self) -> None:
        async def run(work: Callable[..., Any], *arguments: Any) -> Any:
            return work(*arguments)

        self._app = create_app()
        # A campaign starts no other processes.
        self._app.state.compute.run_in_process = run
        self._loop = asyncio.new_event_loop()
        self._defects: list[BaseException] = []
        handler = logging.Handler()
        handler.emit = self._keep  # type: ignore[method-assign]  # the only method of a handler
        logging.getLogger().handlers = [handler]
        signal.signal(signal.SIGPROF, self._stop)

    def post(self, name: str, query: Any) -> Reply:
        path, body = PATHS[name], json.dumps(query)
        scope = {
            "type": "http",
            "http_version": "1.1",
            "scheme": "http",
            "root_path": "",
            "method": "POST",
            "path": path,
            "raw_path": path.encode(),
            "query_string": b"",
            "client": None,
            "server": None,
            "headers": [(b"content-type", b"application/json")],
        }
        sent: list[Any] = []

        async def receive() -> dict[str, Any]:
            return {"type": "http.request", "body": body.encode(), "more_body": False}

        async def send(message: dict[str, Any]) -> None:
            sent.append(message)

        self._defects.clear()
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        try:
            self._loop.run_until_complete(self._app(scope, receive, send))
        except TooSlow as error:
            return Reply(504, b"", error)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
        content = b"".join(message.get("body", b"") for message in sent)
        defect = self._defects[0] if self._defects else None
        return Reply(sent[0]["status"], content, defect)

    def _keep(self, record: logging.LogRecord) -> None:
        if record.exc_info and record.exc_info[1]:
            self._defects.append(record.exc_info[1])

    def _stop(self, *_: object) -> None:
        raise TooSlow
