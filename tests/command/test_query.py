"""The command line prints the bytes of the service and exits with a status per problem type."""

import json
import os
import pty
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from mdr_command.__main__ import main
from mdr_core.errors import AccuracyError
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import Client
from tests.faults.server import PATIENCE
from tests.service.test_batch import NAMES
from tests.service.test_formats import BALL, CASES

MDR = [sys.executable, "-m", "mdr_command"]
BODY = json.dumps(BALL).encode()
PAST_THE_EQUATOR = json.dumps(
    {
        "profile": {"kind": "sphere", "radius": 1.0},
        "material": {"e_star": 1.0},
        "load": {"contact_radius": 2.0},
    }
).encode()
HISTORY = EXAMPLES["evolution"]["held_forces"]["value"] | {"resolution": 8}
# Takes several seconds, so that it can be interrupted on fast machines, too.
LONG = HISTORY | {"resolution": 96, "rtol": 1e-9, "cycles": [10.0 * n for n in range(2000)]}


class InProcess:
    """The command line in this process, which is faster than a subprocess."""

    def __init__(self, capture: pytest.CaptureFixture[bytes], file: Path) -> None:
        self.capture = capture
        self.file = file

    def __call__(
        self, name: str, text: bytes, format_name: str = "json"
    ) -> tuple[int, bytes, bytes]:
        self.file.write_bytes(text)
        status = main([name, str(self.file), "--format", format_name])
        return status, *self.capture.readouterr()


@pytest.fixture
def in_process(capfdbinary: pytest.CaptureFixture[bytes], tmp_path: Path) -> InProcess:
    return InProcess(capfdbinary, tmp_path / "request.json")


@pytest.mark.every(8)
@pytest.mark.parametrize(
    "format_name", ["json", "csv", "npz", pytest.param("svg", marks=pytest.mark.long)]
)
@pytest.mark.parametrize(
    ("path", "query"), [case[::2] for case in CASES], ids=[f"{case[0]} {case[1]}" for case in CASES]
)
def test_output_is_the_response_of_the_service(
    client: Client, in_process: InProcess, path: str, query: object, format_name: str
) -> None:
    text = json.dumps(query).encode()
    output = client.post_text(f"{path}?format={format_name}", text)
    if output.status_code == 200:
        assert in_process(NAMES[path], text, format_name) == (0, output.content, b"")
    else:
        assert (path, format_name) == ("/v1/normal", "svg")
        assert in_process(NAMES[path], text, format_name)[:2] == (2, b"")


@pytest.mark.long
@pytest.mark.parametrize("where", ["standard input", "a file"])
def test_request_is_read_from_file_or_standard_input(
    client: Client, where: str, tmp_path: Path
) -> None:
    file = tmp_path / "request.json"
    file.write_bytes(BODY)
    command, text = ([*MDR, "normal"], BODY)
    if where == "a file":
        command, text = [*command, str(file)], b""
    result = subprocess.run(command, input=text, capture_output=True, check=True, timeout=PATIENCE)
    assert (result.stdout, result.stderr) == (client.post_text("/v1/normal", BODY).content, b"")


@pytest.mark.parametrize(
    ("query", "text"),
    [
        ("normal", b"{"),
        ("normal", BODY.replace(b"0.01", b"-1")),
        ("normal", PAST_THE_EQUATOR),
        ("tangential", BODY),
    ],
    ids=["malformed JSON", "a wrong value", "no contact", "another query"],
)
def test_errors_are_those_of_the_service_one_on_a_line(
    client: Client, in_process: InProcess, query: str, text: bytes
) -> None:
    errors = client.post_text(f"/v1/{query}", text).json()["errors"]
    status, out, err = in_process(query, text)
    assert (status, out) == (2, b"")
    for line, error in zip(err.decode().splitlines(), errors, strict=True):
        place = error["pointer"][1:].replace("/", ".")
        named = f"{place}: " if place else ""
        assert line.startswith(f"mdr {query}: {in_process.file}: {named}{error['detail']}")


def failing(error: Exception) -> Callable[[object], object]:
    def solve(_query: object) -> object:
        raise error

    return solve


@pytest.mark.parametrize(
    ("error", "status", "sentence"),
    [
        (AccuracyError("raise it", ("rtol",)), 3, "rtol: raise it"),
        (ZeroDivisionError(), 1, "internal error: report it with the request"),
    ],
)
def test_each_type_of_problem_has_its_exit_status(
    in_process: InProcess,
    monkeypatch: pytest.MonkeyPatch,
    error: Exception,
    status: int,
    sentence: str,
) -> None:
    monkeypatch.setitem(QUERIES, "normal", QUERIES["normal"]._replace(solve=failing(error)))
    computed, out, err = in_process("normal", BODY)
    assert (computed, out) == (status, b"")
    assert f"mdr normal: {in_process.file}: {sentence}" in err.decode()


@pytest.mark.parametrize("name", ["/dev/zero", "-"])
def test_endless_request_is_rejected(
    name: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with Path("/dev/zero").open() as zeros:
        monkeypatch.setattr(sys, "stdin", zeros)
        assert main(["normal", name]) == 2
    assert "MDR_MAX_BODY_BYTES" in capfd.readouterr().err


@pytest.mark.long
def test_query_imports_no_server(tmp_path: Path) -> None:
    file = tmp_path / "request.json"
    file.write_bytes(BODY)
    code = (
        f"import sys; from mdr_command.__main__ import main; main(['normal', {str(file)!r}]); "
        "sys.exit(bool({'fastapi', 'starlette', 'uvicorn', 'anyio', 'matplotlib'} "
        "& set(sys.modules)))"
    )
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, timeout=PATIENCE)


@contextmanager
def terminal() -> Iterator[tuple[int, int]]:
    """Both ends of a pseudoterminal: the user's and the program's."""
    ours, response = pty.openpty()
    try:
        yield ours, response
    finally:
        os.close(ours)
        os.close(response)


@pytest.mark.long
def test_output_on_a_terminal_ends_with_a_newline(client: Client) -> None:
    with terminal() as (ours, response):
        subprocess.run([*MDR, "normal"], input=BODY, stdout=response, check=True, timeout=PATIENCE)
        shown = os.read(ours, 100_000)
    assert shown == client.post_text("/v1/normal", BODY).content + b"\r\n"


@pytest.mark.long
def test_interrupt_ends_the_command_without_a_traceback() -> None:
    process = subprocess.Popen(
        [*MDR, "evolution"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdin is not None
    # More than a pipe holds: the command reads it once it is written, and then computes.
    process.stdin.write(json.dumps(LONG).encode() + b" " * 200_000)
    process.stdin.close()
    process.stdin = None
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out) == (130, b"")
    assert b"Traceback" not in errors


@pytest.mark.long
def test_closed_output_pipe_ends_silently() -> None:
    many = BALL | {"load": {"normal_force": [1.0 + i for i in range(10_000)]}}
    process = subprocess.Popen(
        [*MDR, "normal"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    process.stdout.close()
    process.stdout = None
    _, err = process.communicate(json.dumps(many).encode(), timeout=PATIENCE)
    assert (process.returncode, err) == (141, b"")


@pytest.mark.every(2)
@pytest.mark.parametrize("command", ["profiles", "normal"])
def test_output_on_a_full_device_is_reported(command: str) -> None:
    with Path("/dev/full").open("wb") as device:
        process = subprocess.run(
            [*MDR, command],
            input=BODY,
            stdout=device,
            stderr=subprocess.PIPE,
            timeout=PATIENCE,
            check=False,
        )
    assert process.returncode == 4
    assert process.stderr == b"mdr: [Errno 28] No space left on device\n"
