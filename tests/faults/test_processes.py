"""A process that ends, stops or fails to start costs no more than its own request."""

import asyncio
import http.client
import json
import os
import resource
import signal
import socket
import subprocess
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import psutil
import pytest

from tests.faults.kills import RECOVERY, Kills, compute_processes, lost
from tests.faults.server import PATIENCE, free_port, is_served, running, service

pytestmark = [pytest.mark.long, pytest.mark.alone]

SMALL = {
    "profile": {"kind": "cone", "slope": 0.1},
    "material": {"e_star": 1.0, "g_star": 0.8},
    "load": {"normal_force": 1.0},
}
# Some tenths of a second of a core, with a short response.
LONGER = {
    "profile": {"kind": "paraboloid", "radius": 1.0},
    "material": {"e_star": 1.0, "g_star": 0.8},
    "friction_coefficient": 0.3,
    "load": {"normal_force": 1e-3},
    "oscillation": {"tangential_force": 1e-4},
    "wear_coefficient": 1e-3,
    "cycles": [1e6],
    "resolution": 96,
    "rtol": 1e-9,
}
PATIENT = {
    "MDR_QUEUE_SECONDS": "100",
    "MDR_BUDGET_SECONDS": "100",
}


def ask(port: int, path: str, query: object) -> tuple[int, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=4 * PATIENCE)
    try:
        connection.request("POST", path, json.dumps(query), {"Content-Type": "application/json"})
        response = connection.getresponse()
        return response.status, response.read()
    finally:
        connection.close()


def computing(server: int) -> list[psutil.Process]:
    """Return the compute processes of a server."""
    computed = []
    for process in psutil.Process(server).children(recursive=True):
        try:
            if any("compute_process" in each for each in process.cmdline()):
                computed.append(process)
        except psutil.Error:
            continue
    return computed


def busy(server: int) -> psutil.Process:
    """Return a compute process once it is computing."""
    computed: list[psutil.Process] = []

    def is_busy() -> bool:
        before = {each: sum(each.cpu_times()[:2]) for each in computing(server)}
        time.sleep(0.05)
        computed[:] = [each for each, spent in before.items() if sum(each.cpu_times()[:2]) > spent]
        return bool(computed)

    wait_for(is_busy)
    return computed[0]


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def requests(port: int, clients: int) -> tuple[ThreadPoolExecutor, list[Future[tuple[int, bytes]]]]:
    pool = ThreadPoolExecutor(clients)
    return pool, [pool.submit(ask, port, "/v1/wear/evolution", LONGER) for _ in range(clients)]


def test_requests_in_flight_are_completed_after_sigterm_within_the_stated_time() -> None:
    port = free_port()
    environment = PATIENT | {
        "MDR_BUDGET_SECONDS": "20",
        "MDR_QUEUE_SECONDS": "20",
        "MDR_REQUEST_SECONDS": "1",
    }
    with (
        running(service(port), port, **environment) as process,
        socket.create_connection(("127.0.0.1", port)) as half_sent,
    ):
        expected = ask(port, "/v1/wear/evolution", LONGER)
        children = computing(process.pid)
        half_sent.sendall(
            b"POST /v1/normal HTTP/1.1\r\nHost: service\r\n"
            b"Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
        )
        pool, answers = requests(port, 8)
        with pool:
            busy(process.pid)
            time.sleep(0.2)
            process.send_signal(signal.SIGTERM)
            terminated = time.monotonic()
            wait_for(lambda: not is_served(port))
            computed = [each.result() for each in answers]
        process.communicate(timeout=60)
        assert time.monotonic() - terminated < 41 + PATIENCE
    assert process.returncode == 0
    assert computed == [expected] * 8
    assert expected[0] == 200
    assert not any(child.is_running() for child in children)


def test_killed_compute_process_loses_its_own_request_only() -> None:
    port = free_port()
    with running(service(port), port, **PATIENT) as process:
        expected = ask(port, "/v1/wear/evolution", LONGER)
        assert expected[0] == 200
        pool, answers = requests(port, 4)
        with pool:
            busy(process.pid).kill()
            computed = [each.result() for each in answers]
        assert sorted(status for status, _ in computed) == [200, 200, 200, 503]
        assert b"urn:mdr:problem:process-lost" in min(computed, key=lambda each: len(each[1]))[1]
        assert [each for each in computed if each[0] == 200] == [expected] * 3
        assert ask(port, "/v1/wear/evolution", LONGER) == expected
        assert ask(port, "/v1/normal", SMALL)[0] == 200
        wait_for(lambda: len(computing(process.pid)) == 2)


@pytest.mark.parametrize("workers", [1, 2])
def test_killed_compute_processes_are_replaced_at_any_moment(workers: int) -> None:
    """For ten minutes: python -m tests.faults.campaign kills."""
    port = free_port()
    command = [*service(port), "--workers", str(workers)]
    with running(command, port, subprocess.DEVNULL) as process:
        server = psutil.Process(process.pid)
        wait_for(lambda: len(compute_processes(server)) == 2 * workers)
        found = Kills(server, 30.0)
        asyncio.run(found.run(port))
        assert found.faults == Counter()
        assert found.slowest <= RECOVERY
        wait_for(lambda: len(compute_processes(server)) == 2 * workers)
        if workers == 1:
            assert asyncio.run(lost(port)) == len(found.times)
        wait_for(lambda: ready(port) == 200)


def test_compute_processes_end_with_a_killed_server() -> None:
    port = free_port()
    with running(service(port), port, **PATIENT) as process:
        children = computing(process.pid)
        assert len(children) == 2
        pool, answers = requests(port, 2)
        busy(process.pid)
        process.kill()
        process.wait(PATIENCE)
        wait_for(lambda: not any(Path(f"/proc/{child.pid}").exists() for child in children))
        pool.shutdown(wait=True)
        assert all(each.exception() for each in answers)


def test_killed_worker_is_replaced() -> None:
    port = free_port()
    command = [*service(port), "--workers", "2"]
    with running(command, port, **PATIENT) as process:
        expected = ask(port, "/v1/normal", SMALL)
        wait_for(lambda: len(computing(process.pid)) == 4)
        workers = {each.ppid() for each in computing(process.pid)}
        assert len(workers) == 2
        killed = min(workers)
        orphans = [each for each in computing(process.pid) if each.ppid() == killed]
        os.kill(killed, signal.SIGKILL)
        # Meanwhile the other worker serves.
        for _ in range(50):
            assert ask(port, "/v1/normal", SMALL) == expected
        wait_for(lambda: not any(each.is_running() for each in orphans))
        wait_for(lambda: len({each.ppid() for each in computing(process.pid)} - {killed}) == 2)
        children = computing(process.pid)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        wait_for(lambda: not any(each.is_running() for each in children))
    assert process.returncode == 0
    assert not is_served(port)


def ready(port: int) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    connection.request("GET", "/health/ready")
    status = connection.getresponse().status
    connection.close()
    return status


@pytest.mark.parametrize("state", ["idle", "busy"])
def test_stopped_compute_processes_are_replaced(state: str) -> None:
    """Within 15 s; until then the instance is not ready, and queries are rejected."""
    port = free_port()
    # A process is missed after the time limit of the self-test.
    with running(service(port), port) as process:
        expected = ask(port, "/v1/wear/evolution", LONGER)
        stopped = computing(process.pid)
        pool = ThreadPoolExecutor(4)
        answers = []
        if state == "busy":
            answers.append(pool.submit(ask, port, "/v1/wear/evolution", LONGER))
            busy(process.pid)
        for each in stopped:
            each.suspend()
        began = time.monotonic()
        assert ready(port) in {503, 504}
        assert ask(port, "/v1/normal", SMALL)[0] == 200
        while (status := ready(port)) != 200:
            assert status in {503, 504}
            assert time.monotonic() - began < 15.0
        answers.append(pool.submit(ask, port, "/v1/wear/evolution", LONGER))
        computed = [each.result() for each in answers]
        pool.shutdown()
        # A computation in a stopped process takes longer than its time limit.
        assert all(each == expected or each[0] in {503, 504} for each in computed)
        assert computed[-1] == expected
        wait_for(lambda: gauge(port, "mdr_compute_processes") == 2.0)
        assert len(computing(process.pid)) == 2
        assert not set(computing(process.pid)) & set(stopped)


def gauge(port: int, name: str) -> float:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    connection.request("GET", "/metrics")
    text = connection.getresponse().read().decode()
    connection.close()
    return float(text.split(f"\n{name} ")[1].split()[0])


def test_server_without_file_descriptors_recovers() -> None:
    port = free_port()
    with running(service(port), port) as process:
        connections = [socket.create_connection(("127.0.0.1", port)) for _ in range(60)]
        assert ready(port) == 200
        resource.prlimit(process.pid, resource.RLIMIT_NOFILE, (40, 40))
        for each in computing(process.pid):
            each.kill()
        held = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
        held.sock = connections[0]
        statuses = set()

        def rejected() -> bool:
            held.request("GET", "/health/ready")
            response = held.getresponse()
            statuses.add(response.status)
            return b"process-lost" in response.read()

        wait_for(rejected)
        assert statuses == {503}
        for each in connections[1:]:
            each.close()

        def recovered() -> bool:
            # Until the server has closed its ends as well, it may reset a new connection.
            with suppress(ConnectionError):
                return ready(port) == 200
            return False

        wait_for(recovered)
        assert ask(port, "/v1/wear/evolution", LONGER)[0] == 200
        wait_for(lambda: len(computing(process.pid)) == 2)
        held.close()


def test_idle_connections_make_room_for_new_ones() -> None:
    port, limit = free_port(), 256
    with running(service(port), port) as process:
        resource.prlimit(process.pid, resource.RLIMIT_NOFILE, (limit, limit))
        idle = [socket.create_connection(("127.0.0.1", port)) for _ in range(2 * limit)]
        assert [ready(port) for _ in range(20)] == [200] * 20
        assert psutil.Process(process.pid).num_fds() < limit
        for each in idle:
            each.close()


def test_workers_end_with_a_killed_supervisor() -> None:
    port = free_port()
    with running([*service(port), "--workers", "2"], port, **PATIENT) as process:
        wait_for(lambda: len(computing(process.pid)) == 4)
        children = psutil.Process(process.pid).children(recursive=True)
        process.kill()
        wait_for(lambda: not any(each.is_running() for each in children))
        assert not is_served(port)
