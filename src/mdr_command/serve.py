"""``mdr serve``: the HTTP service."""

import argparse
import os
import signal
import socket
import sys
from contextlib import suppress
from functools import partial

import uvicorn
from uvicorn.supervisors import Multiprocess

from mdr_command import ExitStatus
from mdr_service import observability
from mdr_service.protocol import BACKLOG, MAX_HEADER_BYTES, BoundedProtocol
from mdr_service.settings import SETTINGS


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on (%(default)s)")
    parser.add_argument(
        "--port", default=8000, type=partial(_number, "port", 0, 65_535), help="port (%(default)s)"
    )
    parser.add_argument(
        "--workers",
        default=1,
        type=partial(_number, "workers", 1, 1_000),
        help="server processes, each with its own compute processes; one that ends is replaced "
        "(%(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Serve until a signal ends the process."""
    host, port = arguments.host, arguments.port
    config = uvicorn.Config(
        # Each server process imports the application by its name.
        "mdr_service.app:create_app",
        factory=True,
        workers=arguments.workers,
        log_config=dict(observability.LOGGING),
        host=host,
        port=port,
        # The asyncio loop accepts all waiting connections in one turn. uvloop accepts one, so that
        # new clients starve beside hundreds that send small queries. A query takes as long with
        # either loop.
        loop="asyncio",
        http=BoundedProtocol,
        backlog=BACKLOG,
        h11_max_incomplete_event_size=MAX_HEADER_BYTES,
        # Without a limit, a client that never reads its response would prevent the shutdown.
        timeout_graceful_shutdown=SETTINGS.shutdown_seconds,
        # The limit exceeds the pauses of clients and proxies that reuse connections; nginx has 75
        # s.
        timeout_keep_alive=75,
        server_header=False,
        access_log=False,
        lifespan="on",
        ws="none",
    )
    # The socket is bound before the compute processes start, which takes a second, so that a used
    # port is reported at once.
    listener = _bind(host, port)
    # uvicorn raises the signal that stopped it once more, but a requested stop is not a failure.
    for each in (signal.SIGTERM, signal.SIGINT):
        signal.signal(each, lambda *_: sys.exit(0))
    place = f"[{host}]" if ":" in host else host
    line = f"MDR: starting, documentation at http://{place}:{listener.getsockname()[1]}/docs\n"
    # The service runs whether or not the line can be written.
    with suppress(OSError):
        os.write(sys.stdout.fileno(), line.encode())
    # A reader of the log that stops reading must not stop the service.
    os.set_blocking(sys.stderr.fileno(), sys.stderr.isatty())
    # `nohup` makes the server ignore the end of its terminal.
    ignored = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    if arguments.workers > 1:
        run_server = Multiprocess(config, [listener]).run
    else:
        run_server = partial(uvicorn.Server(config).run, [listener])
    hang_up = signal.SIG_IGN if ignored else lambda *_: signal.raise_signal(signal.SIGTERM)
    signal.signal(signal.SIGHUP, hang_up)
    run_server()
    return ExitStatus.OK


def _bind(host: str, port: int) -> socket.socket:
    """Return a socket bound to the address; end the process with a message if that fails."""
    try:
        family, type_, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM
        )[0]
        # The event loop sets TCP_NODELAY only on sockets whose protocol is given.
        listener = socket.socket(family, type_, protocol)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
    except OSError as error:
        sys.exit(f"mdr serve: cannot listen on {host} port {port}: {error.strerror}")
    return listener


def _number(name: str, least: int, most: int, text: str) -> int:
    """Return a number of the command line; end the process with a message if it is out of range.

    The socket layer would silently wrap port numbers modulo 65536.
    """
    if len(text) > len(str(most)) or not text.isdecimal() or not least <= int(text) <= most:
        sys.stderr.write(f"mdr serve: --{name} must be between {least} and {most}\n")
        sys.exit(2)
    return int(text)
