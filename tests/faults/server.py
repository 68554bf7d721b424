"""The service as a separate process on a real socket."""

import http.client
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 30.0
"""Time limit for events that take well under a second on an idle machine [s]."""


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_until_ready(port: int) -> None:
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
        try:
            connection.request("GET", "/health")
            if connection.getresponse().status == 200:
                return
        except ConnectionRefusedError:
            time.sleep(0.05)
        finally:
            connection.close()
    raise TimeoutError("the service did not become ready")


def is_served(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@contextmanager
def running(
    command: list[str], port: int, output: int = subprocess.PIPE, **environment: str
) -> Iterator[subprocess.Popen[str]]:
    """Start `command`, wait until it serves at `port`, and terminate it with all its children.

    The output pipe is not read; it holds the log lines of some hundred requests.
    """
    process = subprocess.Popen(
        command,
        env=os.environ | environment,
        stdout=output,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    try:
        wait_until_ready(port)
        yield process
    finally:
        process.kill()
        process.communicate(timeout=PATIENCE)


def service(port: int) -> list[str]:
    return [sys.executable, "-m", "mdr_command", "serve", "--port", str(port)]
