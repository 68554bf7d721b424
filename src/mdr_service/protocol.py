"""HTTP/1.1 protocol of the server: uvicorn's on h11, with bounds against hostile clients.

h11 bounds the buffer of an incomplete request, and reads the next request only after the response;
the kernel drops a client that reads nothing. This class bounds the time in which a request arrives,
because the application has no access to it. It relies on internals of uvicorn, whose version is
therefore pinned; tests check that every overridden method exists and is called.
"""

import re
import resource
import socket
import sys
from asyncio import Transport
from math import ceil
from typing import Any, Final, cast

import h11
import orjson
from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle

from mdr_service import observability, problems
from mdr_service.problems import ProblemType, ServiceError
from mdr_service.settings import SETTINGS

MAX_HEADER_BYTES: Final = 16_384
"""Maximum length of request line and headers, by default the limit of h11 and of Node.js."""
BACKLOG: Final = 128
"""Maximum number of connections that wait in the kernel; the event loop accepts as many in one
turn."""
# Number of descriptors kept free: for files and compute processes, and for the connections that are
# accepted in the four turns of the event loop until others are closed for them.
_FREE_DESCRIPTORS: Final = 64 + 4 * BACKLOG
LINGER_SECONDS: Final = 1.0
"""Time for a rejected client to finish sending and read the response."""
# Size of the send buffer of the kernel, which by default keeps megabytes of each response. The
# kernel sends about as much per round trip: a megabyte per second to a client 100 ms away.
_SEND_BUFFER_BYTES: Final = 131_072
# Part of a message of h11 that quotes text of the client.
_SENT: Final = re.compile(r":? (?:bytearray|b['\"]).*", re.DOTALL)


class BoundedProtocol(H11Protocol):
    """One connection of an HTTP/1.1 client."""

    # None before the first request; the declaration of uvicorn omits that case.
    cycle: RequestResponseCycle | None  # type: ignore[assignment]

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self._rejected = False
        self._await_request()
        self._arrival = self.loop.call_at(self.due, self._check_arrival)

    # uvicorn declares the transport by the narrower type as well.
    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        link = transport.get_extra_info("socket")
        link.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER_BYTES)
        if option := getattr(socket, "TCP_USER_TIMEOUT", None):
            # Linux only.
            link.setsockopt(socket.IPPROTO_TCP, option, ceil(1e3 * SETTINGS.request_seconds))
        most, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
        if len(self.connections) > most - min(_FREE_DESCRIPTORS, most // 2):
            self._make_room()

    @property
    def is_idle(self) -> bool:
        """True before a request, and after its response, until the connection is closed."""
        answered = self.cycle is None or self.cycle.response_complete
        open_ = not self.transport.is_closing()
        return open_ and answered and self.conn.their_state is h11.IDLE

    def _make_room(self) -> None:
        """Close the connection that has been idle longest, or this one if all others are busy.

        Without a free descriptor the event loop accepts no connection, and logs that hundreds of
        times a second.
        """
        own = cast("set[BoundedProtocol]", self.connections)
        idle = [each for each in own if each is not self and each.is_idle]
        min(idle, key=lambda each: each.due, default=self).transport.close()

    def connection_lost(self, exc: Exception | None) -> None:
        self._arrival.cancel()
        self._unset_keepalive_if_required()
        super().connection_lost(exc)

    def _await_request(self) -> None:
        """Restart the time limit at the first byte of a request, or after a response.

        The next request may have been sent ahead.
        """
        self.due = self.loop.time() + SETTINGS.request_seconds

    def _check_arrival(self) -> None:
        """Close the connection if its client sends too slowly."""
        state, kept_alive = self.conn.their_state, self.timeout_keep_alive_task is not None
        if self.loop.time() >= self.due:
            if state in {h11.IDLE, h11.SEND_BODY} and not kept_alive and not self._rejected:
                self._reject_slow(in_headers=state is h11.IDLE)
                return
            self._await_request()
        self._arrival = self.loop.call_at(self.due, self._check_arrival)

    def _reject_slow(self, *, in_headers: bool) -> None:
        begun = in_headers and self.conn.trailing_data[0]
        if self.cycle and self.cycle.response_complete and not begun:
            # A client would take a second response for the response to its next request.
            self.transport.close()
            return
        slow = problems.HEADERS_TOO_SLOW if in_headers else problems.BODY_TOO_SLOW
        self._reject(slow, f"a request must arrive within {SETTINGS.request_seconds:g} s")

    def data_received(self, data: bytes) -> None:
        if self.timeout_keep_alive_task is not None:
            self._await_request()
        # The loop reads one piece at a time, because ten thousand short headers would delay the
        # other connections.
        for begin in range(0, len(data), MAX_HEADER_BYTES):
            if not self._rejected:
                super().data_received(data[begin : begin + MAX_HEADER_BYTES])

    def handle_events(self) -> None:
        try:
            super().handle_events()
        except h11.RemoteProtocolError as error:
            self._reject_malformed(error)

    def send_400_response(self, msg: str) -> None:
        # uvicorn calls this method while it handles the error of the request.
        self._reject_malformed(cast("h11.RemoteProtocolError", sys.exception()))

    def _should_upgrade(self) -> bool:
        """Decline an upgrade; called for each request before it is handed to the application.

        Raises h11.RemoteProtocolError where the headers are too large, or a proxy in front could
        read another request: RFC 9112, 2.3 and 6.1.
        """
        # The length is checked as sent, because h11 checks only headers that are incomplete when it
        # reads them.
        target = self.scope["raw_path"], self.scope["query_string"]
        line = b"%s %s?%s HTTP/1.1" % (self.scope["method"].encode(), *target)
        if len(b"\r\n".join((line, *map(b": ".join, self.headers), b"", b""))) > MAX_HEADER_BYTES:
            raise h11.RemoteProtocolError("headers are too large", error_status_hint=431)
        names, version = {name for name, _ in self.headers}, self.scope["http_version"]
        if version not in {"1.0", "1.1"}:
            raise h11.RemoteProtocolError("the version must be HTTP/1.1")
        if b"transfer-encoding" in names and (b"content-length" in names or version == "1.0"):
            raise h11.RemoteProtocolError("Transfer-Encoding is combined with another framing")
        return False

    def on_response_complete(self) -> None:
        self._await_request()
        super().on_response_complete()

    def _reject_malformed(self, error: h11.RemoteProtocolError) -> None:
        if error.error_status_hint == problems.HEADERS_TOO_LARGE.status:
            self._reject(problems.HEADERS_TOO_LARGE, f"the limit is {MAX_HEADER_BYTES} bytes")
        else:
            self._reject(problems.MALFORMED_HTTP, _SENT.sub("", str(error)))

    def _reject(self, type_: ProblemType, detail: str) -> None:
        """Respond with a problem unless a response has started, and close the connection."""
        self._rejected = True
        observability.PROBLEMS.labels(type_.name).inc()
        if self.cycle and not self.cycle.response_complete:
            # The application stops receiving the body, and its response is dropped.
            self.cycle.disconnected = True
            self.cycle.message_event.set()
            if self.cycle.response_started:
                self.transport.close()
                return
        document = orjson.dumps(problems.document(ServiceError(type_, detail)))
        headers = (
            *self.server_state.default_headers,
            (b"content-type", problems.MEDIA_TYPE.encode()),
            (b"content-length", b"%d" % len(document)),
            (b"connection", b"close"),
        )
        lines = [name + b": " + value + b"\r\n" for name, value in headers]
        status = b"HTTP/1.1 %d %s\r\n" % (type_.status, type_.title.encode())
        self.transport.write(b"".join((status, *lines, b"\r\n", document)))
        # A connection closed with unread data is reset, and the client may lose the response.
        self.flow.resume_reading()
        self.loop.call_later(LINGER_SECONDS, self.transport.close)
