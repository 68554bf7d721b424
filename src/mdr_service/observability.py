"""Observability: request log and Prometheus metrics, without queries or results."""

import logging
import logging.config
import os
from collections.abc import Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from datetime import UTC, datetime
from time import perf_counter
from typing import Any, Final

import orjson
from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, Info

from mdr_core import __version__

REGISTRY: Final = CollectorRegistry()
LATENCIES: Final = Histogram(
    "mdr_request_seconds",
    "Time from the headers of a request to the end of its response, by route and status.",
    ("route", "status"),
    registry=REGISTRY,
    buckets=(0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 20),
)
PROBLEMS: Final = Counter(
    "mdr_problems", "Failed requests by type of problem.", ("type",), registry=REGISTRY
)
QUEUE: Final = Gauge(
    "mdr_queue_length", "Queries waiting for a compute process.", registry=REGISTRY
)
PROCESSES: Final = Gauge(
    "mdr_compute_processes", "Compute processes that are idle or at work.", registry=REGISTRY
)
RESTARTS: Final = Counter(
    "mdr_compute_restarts", "Compute processes replaced, by reason.", ("reason",), registry=REGISTRY
)
LOST_LINES: Final = Counter(
    "mdr_log_lines_lost", "Log lines lost because standard error was not read.", registry=REGISTRY
)
# File descriptor of standard error in POSIX.
_STANDARD_ERROR: Final = 2
Info("mdr_build", "Version of the service.", registry=REGISTRY).info({"version": __version__})


class LogStream:
    """Standard error, written without waiting for its reader: lines beyond its buffer are lost."""

    def write(self, text: str) -> None:
        """Write a line. A pipe takes a line as a whole, unless it is longer than `PIPE_BUF`."""
        block = text.encode()
        try:
            while block:
                block = block[os.write(_STANDARD_ERROR, block) :]
        except OSError:
            LOST_LINES.inc()


@dataclass(slots=True)
class RequestRecord:
    """Log record of one request."""

    id: str
    method: str
    client: str = ""
    """Address of the client."""
    start: float = field(default_factory=perf_counter)
    status: int = 0
    queued: float = 0.0
    """Time in the queue [s]."""
    held: int = 0
    """Length of the request's large bodies in memory [bytes]."""


CURRENT: Final[ContextVar[RequestRecord | None]] = ContextVar("request", default=None)
"""Record of the current request."""


class JsonLines(logging.Formatter):
    """One line of JSON per log record, with the id of the current request."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        line: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC),
            "level": record.levelname.lower(),
            "message": record.getMessage(),
        }
        if request := CURRENT.get():
            line["id"] = request.id
        line |= getattr(record, "members", {})
        if record.exc_info:
            line["trace"] = self.formatException(record.exc_info)
        return orjson.dumps(line, default=str).decode()


def configure_logging() -> None:
    """Write log records and warnings of this process as lines of JSON."""
    logging.config.dictConfig(dict(LOGGING))
    logging.captureWarnings(capture=True)


LOGGING: Final[Mapping[str, Any]] = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {"lines": {"()": "mdr_service.observability.JsonLines"}},
    "handlers": {
        "stderr": {"class": "logging.StreamHandler", "formatter": "lines", "stream": LogStream()}
    },
    "root": {"handlers": ["stderr"], "level": "WARNING"},
    "loggers": {name: {"level": "INFO"} for name in ("mdr_service", "uvicorn")},
}
