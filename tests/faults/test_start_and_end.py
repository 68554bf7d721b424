"""The service starts with a sentence, and ends when it is told to."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.faults.server import PATIENCE, free_port, is_served, running, service

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_cleanly(stop: signal.Signals) -> None:
    port = free_port()
    with running(service(port), port) as process:
        process.send_signal(stop)
        output, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    assert f"http://127.0.0.1:{port}/docs" in output
    assert "Traceback" not in output
    assert not is_served(port)


BRIEF = {
    "MDR_SHUTDOWN_SECONDS": "1",
    "MDR_BUDGET_SECONDS": "0.4",
    "MDR_QUEUE_SECONDS": "0.4",
}


def test_a_half_sent_request_does_not_keep_it_from_ending() -> None:
    port = free_port()
    with (
        running(service(port), port, **BRIEF) as process,
        socket.create_connection(("127.0.0.1", port)) as half_sent,
    ):
        half_sent.sendall(
            b"POST /v1/normal HTTP/1.1\r\nHost: service\r\n"
            b"Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
        )
        time.sleep(0.2)
        told = time.monotonic()
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)
        assert time.monotonic() - told < 5
    assert process.returncode == 0


def test_a_port_that_is_none_is_refused() -> None:
    told = subprocess.run(service(99_999), capture_output=True, text=True, check=False)
    assert told.returncode == 2
    assert "--port" in told.stderr
    assert not told.stdout


@pytest.mark.parametrize(
    ("name", "value"), [("MDR_MAX_LOADS", "many"), ("MDR_SHUTDOWN_SECONDS", "14")]
)
def test_a_senseless_limit_is_told_in_a_sentence(name: str, value: str) -> None:
    told = subprocess.run(
        service(free_port()),
        env=os.environ | {name: value},
        capture_output=True,
        text=True,
        check=False,
    )
    assert told.returncode == 1
    assert told.stderr.startswith(f"{name}: ")
    assert len(told.stderr.splitlines()) == 1


def _environment_is_made() -> bool:
    question = ["make", "--question", ".venv/runtime"]
    return (
        shutil.which("make") is not None
        and subprocess.run(question, cwd=ROOT, capture_output=True, check=False).returncode == 0
    )


@pytest.mark.skipif(not _environment_is_made(), reason="make has not made this environment")
@pytest.mark.parametrize("stop", ["SIGTERM to make alone", "Ctrl-C in the terminal"])
def test_make_run_ends_with_its_service(stop: str) -> None:
    port = free_port()
    command = ["make", "--directory", str(ROOT), "run", f"PORT={port}"]
    with running(command, port) as process:
        if stop.startswith("SIGTERM"):
            process.send_signal(signal.SIGTERM)
        else:
            # A terminal signals the whole group in its foreground.
            os.killpg(process.pid, signal.SIGINT)
        output, _ = process.communicate(timeout=PATIENCE)
    assert f"http://127.0.0.1:{port}/docs" in output
    assert "Traceback" not in output
    assert not is_served(port)


def test_the_document_is_printed_without_serving() -> None:
    command = [sys.executable, "-m", "mdr_command", "openapi"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert printed == (ROOT / "openapi.json").read_text("utf-8")
