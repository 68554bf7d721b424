"""``mdr serve``: the HTTP service at an address of one's own."""

import argparse
import signal
import sys
from types import FrameType
from typing import Final

import uvicorn

from mdr_service import watch
from mdr_service.settings import SETTINGS

_LAST_PORT: Final = 65535


def declare(parser: argparse.ArgumentParser) -> None:
    """Take the address."""
    parser.add_argument("--host", default="127.0.0.1", help="address to listen at (%(default)s)")
    parser.add_argument("--port", default=8000, type=_port, help="port (%(default)s)")
    parser.add_argument(
        "--workers",
        default=1,
        type=_workers,
        help="processes that serve, each with compute processes of its own; one that ends is "
        "replaced (%(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Serve until a signal ends it."""
    host, port = arguments.host, arguments.port
    # uvicorn ends by raising once more the signal that stopped it. Being told to stop is no
    # failure, so that one ends in exit status 0.
    signal.signal(signal.SIGTERM, _leave)
    signal.signal(signal.SIGINT, _leave)
    place = f"[{host}]" if ":" in host else host
    sys.stdout.write(f"MDR: the documentation is at http://{place}:{port}/docs\n")
    sys.stdout.flush()
    uvicorn.run(
        # Several workers each import it by its name.
        "mdr_service.app:create_app",
        factory=True,
        workers=arguments.workers,
        log_config=dict(watch.LOGGING),
        host=host,
        port=port,
        loop="uvloop",
        http="httptools",
        # Without it a client that never finishes its request keeps the service from ending.
        timeout_graceful_shutdown=SETTINGS.shutdown_seconds,
        server_header=False,
        access_log=False,
        # No answer and no line of the log depends on where the client is.
        proxy_headers=False,
        lifespan="on",
        ws="none",
    )
    return 0


def _port(text: str) -> int:
    number = int(text)
    # The system would serve at the remainder by 65536, and nobody know.
    if not 0 <= number <= _LAST_PORT:
        raise ValueError
    return number


def _workers(text: str) -> int:
    number = int(text)
    if number < 1:
        raise ValueError
    return number


def _leave(_signal: int, _frame: FrameType | None) -> None:
    sys.exit(0)
