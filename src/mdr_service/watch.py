"""What the service tells of itself: one line of JSON per request, and metrics for Prometheus.

Neither ever holds what was asked or answered.
"""

import logging
import os
import re
import sys
from collections.abc import Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import lru_cache
from time import perf_counter, time
from typing import Any, Final

import orjson
from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

METRICS_MEDIA_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"
_ID: Final = re.compile(r"[A-Za-z0-9._~+/=-]{1,64}")
_OTHER: Final = "other"
_METHODS: Final = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})

REGISTRY: Final = CollectorRegistry()
REQUESTS: Final = Counter(
    "mdr_requests", "Requests answered.", ("route", "status"), registry=REGISTRY
)
LATENCIES: Final = Histogram(
    "mdr_request_seconds",
    "From the first byte of a request to the last of its answer.",
    ("route",),
    registry=REGISTRY,
    buckets=(0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 20),
)
PROBLEMS: Final = Counter(
    "mdr_problems", "Requests that failed, by kind of problem.", ("kind",), registry=REGISTRY
)
QUEUE: Final = Gauge("mdr_queue_length", "Queries that wait for a process.", registry=REGISTRY)
PROCESSES: Final = Gauge(
    "mdr_compute_processes", "Compute processes that are ready or at work.", registry=REGISTRY
)
RESTARTS: Final = Counter(
    "mdr_compute_restarts",
    "Compute processes that ended before their work was done.",
    ("reason",),
    registry=REGISTRY,
)
ESTIMATES: Final = Histogram(
    "mdr_cost_ratio",
    "Time that a compute process took, over the estimate.",
    registry=REGISTRY,
    buckets=(0.125, 0.25, 0.5, 1, 2, 4, 8),
)

_requests: Final = logging.getLogger("mdr_service.requests")


@dataclass(slots=True)
class Watched:
    """One request, as long as it is being answered."""

    id: str
    method: str
    start: float = field(default_factory=perf_counter)
    status: int = 0
    cost: float = 0.0
    """Seconds that the answer was estimated to take."""
    queued: float = 0.0
    """Seconds that it waited for a process."""


_current: ContextVar[Watched | None] = ContextVar("request", default=None)


def begin(method: str, given: str = "") -> Watched:
    """Watch a request, under the id that the client gave it if that is one."""
    name = given if given and _ID.fullmatch(given) else os.urandom(8).hex()
    watched = Watched(name, method if method in _METHODS else _OTHER)
    _current.set(watched)
    return watched


def current() -> Watched | None:
    """Return the request that is being answered here, if any."""
    return _current.get()


def end(watched: Watched, route: str | None) -> None:
    """Count a request that has been answered, and write its line."""
    seconds = perf_counter() - watched.start
    route = route or _OTHER
    _count(route, watched.status).inc()
    _latency(route).observe(seconds)
    if _requests.isEnabledFor(logging.INFO):
        line = {
            "time": _time(time()),
            "level": "info",
            "message": "request",
            "id": watched.id,
            "method": watched.method,
            "route": route,
            "status": watched.status,
            "ms": round(1e3 * seconds, 3),
            "cost_ms": round(1e3 * watched.cost, 3),
            "queue_ms": round(1e3 * watched.queued, 3),
        }
        # The logger decides whether, and does not write: a record of its own for every request
        # would take a tenth of the time of a small one.
        sys.stderr.write(orjson.dumps(line, option=orjson.OPT_APPEND_NEWLINE).decode())


def metrics() -> bytes:
    """Return all metrics of this process, as Prometheus reads them."""
    return generate_latest(REGISTRY)


_counts: Final[dict[tuple[str, int], Counter]] = {}
_latencies: Final[dict[str, Histogram]] = {}


def _count(route: str, status: int) -> Counter:
    # The library looks a label up behind a lock, which takes longer than to count.
    if (found := _counts.get((route, status))) is None:
        found = _counts[route, status] = REQUESTS.labels(route, str(status))
    return found


def _latency(route: str) -> Histogram:
    if (found := _latencies.get(route)) is None:
        found = _latencies[route] = LATENCIES.labels(route)
    return found


def _time(seconds: float) -> str:
    whole = int(seconds)
    return f"{_second(whole)}.{int(1e3 * (seconds - whole)):03d}+00:00"


@lru_cache(maxsize=1)
def _second(seconds: int) -> str:
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%dT%H:%M:%S")


class JsonLines(logging.Formatter):
    """Writes every record as one line of JSON, with the id of the request it is about."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        line: dict[str, Any] = {
            "time": _time(record.created),
            "level": record.levelname.lower(),
            "message": record.getMessage(),
        }
        if watched := _current.get():
            line["id"] = watched.id
        if record.exc_info:
            line["trace"] = self.formatException(record.exc_info)
        return orjson.dumps(line, default=str).decode()


LOGGING: Final[Mapping[str, Any]] = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {"lines": {"()": "mdr_service.watch.JsonLines"}},
    "handlers": {"stderr": {"class": "logging.StreamHandler", "formatter": "lines"}},
    "loggers": {
        name: {"handlers": ["stderr"], "level": "INFO", "propagate": False}
        for name in ("mdr_service", "uvicorn")
    },
}
