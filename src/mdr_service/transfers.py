"""Bound of the long request and response bodies that are in memory at a time."""

from typing import Final

from mdr_service import problems
from mdr_service.observability import RequestRecord
from mdr_service.problems import ServiceError

LONG: Final = 65_536
"""Length above which a body counts; the server buffers as much of every connection [bytes]."""


class Transfers:
    """Total length of long bodies, at most `limit` bytes unless a single request has them."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._total = 0

    def add(self, record: RequestRecord, size: int) -> None:
        """Add a body, or a part of one, of a request; raise ServiceError beyond the limit."""
        if self._total > record.held and self._total + size > self._limit:
            detail = "other long bodies are being transferred; try again in 1 s"
            raise ServiceError(problems.BUSY, detail, retry_after=1)
        self._total += size
        record.held += size

    def remove(self, record: RequestRecord) -> None:
        """Remove the bodies of a request."""
        self._total -= record.held
