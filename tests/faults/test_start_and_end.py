"""The service rejects invalid settings at the start, and sends its responses before it ends."""

import http.client
import json
import os
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from functools import partial
from pathlib import Path

import pytest

from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import JSON
from tests.faults.server import PATIENCE, free_port, is_served, running, service
from tests.faults.test_processes import busy, wait_for

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
# How a service starts and ends does not depend on the number of its compute processes.
FEW = {"MDR_COMPUTE_PROCESSES": "1"}


@pytest.mark.parametrize("workers", ["1", "2"])
@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_signal_ends_the_service_cleanly(stop: signal.Signals, workers: str) -> None:
    port = free_port()
    with running([*service(port), "--workers", workers], port, **FEW) as process:
        process.send_signal(stop)
        output, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    assert f"http://127.0.0.1:{port}/docs" in output
    assert "Traceback" not in output
    assert not is_served(port)


BRIEF = {
    "MDR_BUDGET_SECONDS": "0.4",
    "MDR_QUEUE_SECONDS": "0.4",
}


def test_incomplete_request_does_not_delay_shutdown() -> None:
    port = free_port()
    with (
        running(service(port), port, **FEW, **BRIEF) as process,
        socket.create_connection(("127.0.0.1", port)) as half_sent,
    ):
        half_sent.sendall(
            b"POST /v1/normal HTTP/1.1\r\nHost: service\r\n"
            b"Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
        )
        time.sleep(0.2)
        signalled = time.monotonic()
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)
        assert time.monotonic() - signalled < 5
    assert process.returncode == 0


def test_sighup_is_ignored_under_nohup() -> None:
    port = free_port()
    with running(["nohup", *service(port)], port, subprocess.DEVNULL, **FEW) as process:
        process.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        assert is_served(port)


def test_second_interrupt_completes_the_request_in_flight_at_once() -> None:
    port = free_port()
    with running(service(port), port, **FEW) as process, connected(port) as client:
        # A few seconds of computation.
        ball = EXAMPLES["evolution"]["shakedown"]["value"]
        query = ball | {"resolution": 96, "cycles": [10.0 * n for n in range(2000)]}
        client.request("POST", "/v1/wear/evolution", json.dumps(query), JSON)
        busy(process.pid)
        process.send_signal(signal.SIGINT)
        wait_for(lambda: not is_served(port))
        process.send_signal(signal.SIGINT)
        signalled = time.monotonic()
        response = client.getresponse()
        assert response.status == 503
        assert json.loads(response.read())["type"] == "urn:mdr:problem:stopping"
        process.communicate(timeout=PATIENCE)
        assert time.monotonic() - signalled < 5
    assert process.returncode == 0


def connected(port: int) -> "closing[http.client.HTTPConnection]":
    return closing(http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE))


def test_standard_error_that_nobody_reads_does_not_stop_the_service() -> None:
    port = free_port()
    with running(service(port), port, **FEW) as process:
        with connected(port) as client:
            # A pipe holds about 400 lines.
            for _ in range(2_000):
                client.request("GET", "/health")
                assert client.getresponse().read()
        process.send_signal(signal.SIGTERM)
        signalled = time.monotonic()
        assert process.wait(PATIENCE) == 0
        assert time.monotonic() - signalled < 5


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&- <&-", "| true"])
def test_closed_stream_does_not_stop_the_service(closed: str) -> None:
    port = free_port()
    command = ["sh", "-c", f"{shlex.join(service(port))} {closed}"]
    with (
        running(command, port, subprocess.DEVNULL, **FEW) as process,
        connected(port) as client,
    ):
        for _ in range(3):
            client.request("GET", "/health/ready")
            response = client.getresponse()
            assert response.status == 200
            assert response.read().startswith(b'{"status":"ok"')
        os.killpg(process.pid, signal.SIGTERM)
        wait_for(lambda: not is_served(port))


def test_log_is_whole_lines_of_json() -> None:
    port = free_port()
    with running([*service(port), "--workers", "2"], port, **FEW) as process:
        for _ in range(200):
            with connected(port) as client:
                client.request("GET", "/health")
                client.getresponse().read()
        process.send_signal(signal.SIGTERM)
        output, _ = process.communicate(timeout=PATIENCE)
    first, *lines = output.splitlines()
    assert first.startswith("MDR: ")
    messages = [json.loads(line)["message"] for line in lines]
    # The last lines are written at the end; the start of the test has sent a request as well.
    assert messages.count("request") == 201
    assert messages[-1].startswith("Stopping parent process")


def failed(*commands: list[str], **environment: str) -> list[subprocess.CompletedProcess[str]]:
    """Run commands in parallel, since most of their time is spent on imports."""
    run = partial(subprocess.run, capture_output=True, text=True, check=False)
    with ThreadPoolExecutor() as pool:
        return list(pool.map(partial(run, env=os.environ | environment), commands))


def test_invalid_argument_is_rejected_with_one_line() -> None:
    ports, workers = "--port must be between 0 and 65535", "--workers must be between 1 and 1000"
    given = {"port=70000": ports, "port=-1": ports, "port=http": ports, "workers=0": workers}
    commands = [[sys.executable, "-m", "mdr_command", "serve", f"--{each}"] for each in given]
    for ended, message in zip(failed(*commands), given.values(), strict=True):
        assert (ended.returncode, ended.stdout) == (2, "")
        assert ended.stderr == f"mdr serve: {message}\n"


def test_unknown_host_is_reported_with_one_line() -> None:
    (ended,) = failed([*service(free_port()), "--host", "nowhere.invalid"])
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr.startswith("mdr serve: cannot listen on nowhere.invalid port ")
    assert len(ended.stderr.splitlines()) == 1


def test_port_in_use_is_reported_before_the_compute_processes_start() -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        for ended in failed(*([*service(port), "--workers", workers] for workers in "12")):
            assert ended.returncode == 1
            assert ended.stderr == (
                f"mdr serve: cannot listen on 127.0.0.1 port {port}: Address already in use\n"
            )
            assert not ended.stdout


@pytest.mark.parametrize(
    ("name", "value"),
    [("MDR_MAX_LENGTH", "many"), ("MDR_QUEUE_SECONDS", "nan")],
)
def test_invalid_setting_exits_with_one_line(name: str, value: str) -> None:
    (ended,) = failed(service(free_port()), **{name: value})
    assert ended.returncode == 1
    assert ended.stderr.startswith(f"{name}: ")
    assert len(ended.stderr.splitlines()) == 1


def _environment_is_made() -> bool:
    command = ["make", "--question", ".venv/runtime"]
    return (
        shutil.which("make") is not None
        and subprocess.run(command, cwd=ROOT, capture_output=True, check=False).returncode == 0
    )


@pytest.mark.skipif(not _environment_is_made(), reason="the environment was not created by make")
@pytest.mark.parametrize("stop", ["SIGTERM to make only", "Ctrl-C in the terminal"])
def test_make_run_ends_with_its_service(stop: str) -> None:
    port = free_port()
    command = ["make", "--directory", str(ROOT), "run", f"PORT={port}"]
    with running(command, port, **FEW) as process:
        if stop.startswith("SIGTERM"):
            process.send_signal(signal.SIGTERM)
        else:
            # A terminal signals the whole foreground process group.
            os.killpg(process.pid, signal.SIGINT)
        output, _ = process.communicate(timeout=PATIENCE)
    assert f"http://127.0.0.1:{port}/docs" in output
    assert "Traceback" not in output
    assert not is_served(port)
