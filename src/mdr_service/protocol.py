"""HTTP/1.1 protocol of the server: uvicorn's, with bounds against hostile clients.

They are implemented here because the application has no access to incomplete headers or to the
progress of a client that reads. The class relies on internals of uvicorn, whose version is pinned
for that reason; tests check that every overridden method exists and is called.
"""

import re
import socket
import struct
from asyncio import AbstractEventLoop, Transport
from typing import Any, Final

import orjson
from httptools import (
    HttpParserError,
    HttpParserInvalidURLError,
    HttpParserUpgrade,
    HttpRequestParser,
)
from uvicorn.config import Config
from uvicorn.protocols.http.httptools_impl import (
    STATUS_LINE,
    HttpToolsProtocol,
    RequestResponseCycle,
)
from uvicorn.server import ServerState

from mdr_service import observability, problems
from mdr_service.problems import ProblemType, ServiceError
from mdr_service.settings import SETTINGS

MAX_HEADER_BYTES: Final = 32_768
"""Maximum length of request line and headers; nginx has 32 kB as well, Apache 8 kB a line."""
MAX_HEADER_FIELDS: Final = 100
"""Maximum number of headers, as in Apache."""
# Maximum number of pipelined requests of a connection, each in memory; browsers sent up to 6.
_MAX_PIPELINED: Final = 32
# Interval at which the client's progress is checked.
_CHECK_SECONDS: Final = 2.0
# A client that reads less than this of a response in `_WRITE_SECONDS` counts as not reading.
# Measured: 20 kB/s pass, 5 kB/s do not.
_WRITTEN_BYTES: Final = 16_384
# Longer than the pauses of slow mobile networks, which last some seconds.
_WRITE_SECONDS: Final = 10.0
# Send buffer of the kernel, which by default hides megabytes from the measurement.
_SEND_BUFFER_BYTES: Final = 131_072
# Time for a rejected client to finish sending and read the response.
_LINGER_SECONDS: Final = 1.0
# What is in a header `Host` (RFC 9110, 7.2).
_HOST: Final = re.compile(rb"[A-Za-z0-9._~!$&'()*+,;=%:\[\]-]*")
# `struct linger` of socket(7): what the kernel has not sent is discarded.
_DISCARD: Final = struct.pack("ii", 1, 0)


class BoundedProtocol(HttpToolsProtocol):
    """One connection of an HTTP/1.1 client."""

    # None before the first request, which the declaration of uvicorn omits.
    cycle: RequestResponseCycle | None  # type: ignore[assignment]

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: AbstractEventLoop | None = None,
    ) -> None:
        # For the application: the tasks of all requests in progress.
        app_state["tasks"] = server_state.tasks
        super().__init__(config, server_state, app_state, _loop)
        self._rejected = False
        # Bytes received since the parser last passed on everything it held.
        self._buffered = 0
        # Time of the first byte of the current request, or of the connection.
        self._awaited_since = self.loop.time()
        # Unsent bytes in the transport at the last progress of the client, and its time.
        self._unsent, self._unsent_since = 0, 0.0
        self._check = self.loop.call_later(_CHECK_SECONDS, self._check_progress)

    # uvicorn has the narrower type as well.
    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._socket = transport.get_extra_info("socket")
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER_BYTES)

    def connection_lost(self, exc: Exception | None) -> None:
        self._check.cancel()
        self._unset_keepalive_if_required()
        super().connection_lost(exc)

    def _check_progress(self) -> None:
        """Close the connection if its client sends or reads too slowly."""
        self._check = self.loop.call_later(_CHECK_SECONDS, self._check_progress)
        now = self.loop.time()
        unsent = self.transport.get_write_buffer_size()
        if not unsent or not self._unsent or unsent <= self._unsent - _WRITTEN_BYTES:
            self._unsent, self._unsent_since = unsent, now
        elif now - self._unsent_since > _WRITE_SECONDS:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _DISCARD)
            self.transport.abort()
        late = now - self._awaited_since > SETTINGS.request_seconds
        awaited = self._is_receiving() and self.timeout_keep_alive_task is None
        if late and awaited and not self._rejected and not self.transport.is_closing():
            detail = f"a request must arrive within {SETTINGS.request_seconds:g} s"
            in_headers = not self.cycle or self.cycle.response_complete
            slow = problems.HEADERS_TOO_SLOW if in_headers else problems.BODY_TOO_SLOW
            self._reject(slow, detail)

    def resume_writing(self) -> None:
        self._unsent = 0
        super().resume_writing()

    def data_received(self, data: bytes) -> None:
        if self.timeout_keep_alive_task is not None:
            self._unset_keepalive_if_required()
            self._awaited_since = self.loop.time()
        # A piece at a time: some ten thousand short headers would delay the other connections.
        for begin in range(0, len(data), MAX_HEADER_BYTES):
            if not self._rejected:
                self._receive(data[begin : begin + MAX_HEADER_BYTES])

    def _receive(self, data: bytes) -> None:
        self._buffered += len(data)
        try:
            self._parse(data)
        except HttpParserError as error:
            if self._buffered <= MAX_HEADER_BYTES:
                # An error in a method of this class is the context of the error of the parser.
                cause = error.__context__ or error
                is_url = isinstance(cause, HttpParserInvalidURLError)
                # That error alone repeats what was sent.
                detail = "the URL cannot be parsed" if is_url else str(cause)
                self._reject(problems.MALFORMED_HTTP, detail)
                return
        if self._buffered > MAX_HEADER_BYTES:
            detail = f"the limits are {MAX_HEADER_BYTES} bytes and {MAX_HEADER_FIELDS} fields"
            self._reject(problems.HEADERS_TOO_LARGE, detail)

    def _parse(self, data: bytes) -> None:
        """Parse data; decline an upgrade by parsing the headers again without the offer."""
        while data:
            try:
                self.parser.feed_data(data)
            except HttpParserUpgrade as offer:
                rest = data[offer.args[0] :]
            else:
                return
            method, version = self.parser.get_method(), self.parser.get_http_version()
            if method == b"CONNECT":
                raise HttpParserError("this is not a proxy")
            lines = [b"%s %s HTTP/%s" % (method, self.url, version.encode())]
            lines += [name + b": " + value for name, value in self.headers if name != b"upgrade"]
            data = b"\r\n".join((*lines, b"", rest))
            self.parser = HttpRequestParser(self)
            # As in uvicorn, which responds to a request before it reads the next.
            self.parser.set_dangerous_leniencies(lenient_data_after_close=True)

    def on_message_begin(self) -> None:
        self._awaited_since = self.loop.time()
        super().on_message_begin()

    def on_headers_complete(self) -> None:
        if self.parser.should_upgrade():
            return
        size = len(self.url) + sum([len(name) + len(value) for name, value in self.headers])
        if size > MAX_HEADER_BYTES or len(self.headers) > MAX_HEADER_FIELDS:
            self._buffered = MAX_HEADER_BYTES + 1
            raise HttpParserError
        self._require_valid_framing()
        # A client that sends the next request is reading, or will wait for its response.
        self._buffered = self._unsent = 0
        if len(self.pipeline) >= _MAX_PIPELINED:
            raise HttpParserError(f"more than {_MAX_PIPELINED} requests wait for a response")
        super().on_headers_complete()
        # Trailers are parsed like headers, but the request is already in the application.
        self.headers = []

    def _require_valid_framing(self) -> None:
        """Raise HttpParserError where a proxy in front could read another request.

        The parser leaves that to its user: RFC 9112, 2.3, 3.2 and 6.1.
        """
        version = self.parser.get_http_version()
        if version not in {"1.0", "1.1"}:
            raise HttpParserError("the version must be HTTP/1.1")
        hosts = [value for name, value in self.headers if name == b"host"]
        if (
            len(hosts) > 1
            or (version == "1.1" and not hosts)
            or not _HOST.fullmatch(b"".join(hosts))
        ):
            raise HttpParserError("exactly one valid Host is needed")
        codings = [value.lower() for name, value in self.headers if name == b"transfer-encoding"]
        if codings and (codings != [b"chunked"] or version == "1.0"):
            raise HttpParserError("the only transfer coding is chunked")

    def on_body(self, body: bytes) -> None:
        self._buffered = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        if not self.parser.should_upgrade():
            super().on_message_complete()

    def _is_receiving(self) -> bool:
        """Return True if the request whose response is next is incomplete or has not begun."""
        cycle = self.cycle
        if not cycle or cycle.response_complete:
            return True
        return cycle.more_body and not cycle.response_started and not self.pipeline

    def _reject(self, type_: ProblemType, detail: str) -> None:
        """Respond with a problem if no response is pending, and close the connection."""
        self._rejected = True
        observability.PROBLEMS.labels(type_.name).inc()
        if not self._is_receiving():
            self.transport.close()
            return
        if self.cycle:
            # The application stops receiving the body, and its response is dropped.
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        document = orjson.dumps(problems.document(ServiceError(type_, detail)))
        headers = (
            *self.server_state.default_headers,
            (b"content-type", problems.MEDIA_TYPE.encode()),
            (b"content-length", b"%d" % len(document)),
            (b"connection", b"close"),
        )
        lines = [name + b": " + value + b"\r\n" for name, value in headers]
        self.transport.write(b"".join((STATUS_LINE[type_.status], *lines, b"\r\n", document)))
        # A connection closed with unread data is reset, and the client may lose the response.
        self.flow.resume_reading()
        self.loop.call_later(_LINGER_SECONDS, self.transport.close)
