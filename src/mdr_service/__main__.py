"""The command line: serve, or print the OpenAPI document."""

import argparse
import json
import signal
import sys
from types import FrameType
from typing import Final

import uvicorn
from fastapi import FastAPI

from mdr_service.app import create_app
from mdr_service.settings import SETTINGS

_LAST_PORT: Final = 65535


def main() -> None:
    """Do what the command line says."""
    arguments = _parser().parse_args()
    app = create_app()
    if arguments.openapi:
        json.dump(app.state.openapi, sys.stdout, indent=2, ensure_ascii=False)
        sys.stdout.write("\n")
    else:
        _serve(app, arguments.host, arguments.port)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mdr-service", description=__doc__)
    parser.add_argument("--host", default="127.0.0.1", help="address to listen at (%(default)s)")
    parser.add_argument("--port", default=8000, type=_port, help="port (%(default)s)")
    parser.add_argument("--openapi", action="store_true", help="print the OpenAPI document")
    return parser


def _port(text: str) -> int:
    number = int(text)
    # The system would serve at the remainder by 65536, and nobody know.
    if not 0 <= number <= _LAST_PORT:
        raise ValueError
    return number


def _serve(app: FastAPI, host: str, port: int) -> None:
    # uvicorn ends by raising once more the signal that stopped it. Being told to stop is no
    # failure, so that one ends in exit status 0.
    signal.signal(signal.SIGTERM, _leave)
    signal.signal(signal.SIGINT, _leave)
    place = f"[{host}]" if ":" in host else host
    sys.stdout.write(f"MDR: the documentation is at http://{place}:{port}/docs\n")
    sys.stdout.flush()
    uvicorn.run(
        app,
        host=host,
        port=port,
        loop="uvloop",
        http="httptools",
        # Without it a client that never finishes its request keeps the service from ending.
        timeout_graceful_shutdown=SETTINGS.shutdown_seconds,
        server_header=False,
        access_log=False,
        lifespan="off",
        ws="none",
    )


def _leave(_signal: int, _frame: FrameType | None) -> None:
    sys.exit(0)


if __name__ == "__main__":
    main()
