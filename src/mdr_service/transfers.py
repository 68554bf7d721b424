"""Bound of the long request and response bodies that are in memory at a time."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Final

from anyio import CancelScope

from mdr_service import problems
from mdr_service.observability import RequestRecord
from mdr_service.problems import ServiceError

LONG: Final = 65_536
"""Length above which a body counts; the server buffers as much of every connection [bytes]."""
# Time in which a client that reads 2 MB/s receives the longest response.
_READ_SECONDS: Final = 10.0


class Transfers:
    """Total length of long bodies, at most `limit` bytes unless a single request has them."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._total = 0
        self._sending: dict[CancelScope, float] = {}

    def add(self, record: RequestRecord, size: int) -> None:
        """Add a body, or a part of one, of a request; raise ServiceError beyond the limit."""
        if self._total > record.held and self._total + size > self._limit:
            # A slow client must not block the others for long.
            oldest = next(iter(self._sending), None)
            if oldest and monotonic() - self._sending[oldest] > _READ_SECONDS:
                oldest.cancel()
            detail = "other long bodies are being transferred; try again in 1 s"
            raise ServiceError(problems.BUSY, detail, retry_after=1)
        self._total += size
        record.held += size

    def remove(self, record: RequestRecord) -> None:
        """Remove the bodies of a request."""
        self._total -= record.held

    @contextmanager
    def sending(self) -> Iterator[CancelScope]:
        """Send a response within the context, which is cancelled if others need the room."""
        with CancelScope() as scope:
            self._sending[scope] = monotonic()
            try:
                yield scope
            finally:
                del self._sending[scope]
