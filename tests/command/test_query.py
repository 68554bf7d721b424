"""The command line answers with the bytes of the service, and fails by its documents."""

import json
import os
import pty
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from mdr_command.__main__ import main
from mdr_core.errors import AccuracyError
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EVOLUTION_EXAMPLES
from tests.conftest import Client
from tests.faults.server import PATIENCE
from tests.service.test_batch import ASKS
from tests.service.test_forms import BALL, CASES

MDR = [sys.executable, "-m", "mdr_command"]
BODY = json.dumps(BALL).encode()
PAST_THE_EQUATOR = json.dumps(
    {
        "profile": {"kind": "sphere", "radius": 1.0},
        "material": {"e_star": 1.0},
        "load": {"contact_radius": 2.0},
    }
).encode()
FOLLOWED = EVOLUTION_EXAMPLES["held_forces"]["value"] | {"resolution": 8}
# Takes a second at least: long enough to be interrupted.
LONG = FOLLOWED | {"resolution": 96, "rtol": 1e-9}


class Within:
    """The command line in this process, which is faster than one of its own."""

    def __init__(self, capture: pytest.CaptureFixture[bytes], file: Path) -> None:
        self.capture = capture
        self.file = file

    def __call__(self, name: str, text: bytes, form: str = "json") -> tuple[int, bytes, bytes]:
        self.file.write_bytes(text)
        status = main([name, str(self.file), "--format", form])
        return status, *self.capture.readouterr()


@pytest.fixture
def within(capfdbinary: pytest.CaptureFixture[bytes], tmp_path: Path) -> Within:
    return Within(capfdbinary, tmp_path / "request.json")


@pytest.mark.parametrize(
    "form", ["json", "csv", "npz", pytest.param("svg", marks=pytest.mark.long)]
)
@pytest.mark.parametrize(
    ("path", "query"), [case[::2] for case in CASES], ids=[f"{case[0]} {case[1]}" for case in CASES]
)
def test_output_is_the_response_of_the_service(
    client: Client, within: Within, path: str, query: object, form: str
) -> None:
    text = json.dumps(query).encode()
    answer = client.post_text(f"{path}?format={form}", text)
    if answer.status_code == 200:
        assert within(ASKS[path], text, form) == (0, answer.content, b"")
    else:
        assert (path, form) == ("/v1/normal", "svg")
        assert within(ASKS[path], text, form) == (2, b"", answer.content + b"\n")


@pytest.mark.parametrize("where", ["standard input", "a file"])
def test_request_is_read_from_file_or_standard_input(
    client: Client, where: str, tmp_path: Path
) -> None:
    file = tmp_path / "request.json"
    file.write_bytes(BODY)
    command, text = ([*MDR, "normal"], BODY)
    if where == "a file":
        command, text = [*command, str(file)], b""
    told = subprocess.run(command, input=text, capture_output=True, check=True, timeout=PATIENCE)
    assert (told.stdout, told.stderr) == (client.post_text("/v1/normal", BODY).content, b"")


@pytest.mark.parametrize(
    ("asked", "text", "form"),
    [
        ("normal", b"{", "json"),
        ("normal", BODY.replace(b"0.01", b"-1"), "json"),
        ("normal", PAST_THE_EQUATOR, "json"),
        ("tangential", BODY, "json"),
        ("normal", BODY, "xml"),
    ],
    ids=["no JSON", "a wrong value", "no contact", "another query", "no such form"],
)
def test_problem_is_the_document_of_the_service(
    client: Client, within: Within, asked: str, text: bytes, form: str
) -> None:
    answer = client.post_text(f"/v1/{asked}?format={form}", text)
    assert answer.status_code >= 400
    assert within(asked, text, form) == (2, b"", answer.content + b"\n")


def failing(error: Exception) -> Callable[[object], object]:
    def solve(_query: object) -> object:
        raise error

    return solve


@pytest.mark.parametrize(
    ("error", "status", "kind"),
    [
        (AccuracyError("not in doubles"), 3, "accuracy-not-reachable"),
        (ZeroDivisionError(), 1, "internal-error"),
    ],
)
def test_each_type_of_problem_has_its_exit_status(
    within: Within, monkeypatch: pytest.MonkeyPatch, error: Exception, status: int, kind: str
) -> None:
    monkeypatch.setitem(QUERIES, "normal", QUERIES["normal"]._replace(solve=failing(error)))
    found, out, err = within("normal", BODY)
    assert (found, out) == (status, b"")
    assert json.loads(err.splitlines()[-1])["type"] == f"urn:mdr:problem:{kind}"


def test_missing_file_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["normal", "/nowhere/request.json"]) == 2
    assert capsys.readouterr().err == "mdr: /nowhere/request.json: No such file or directory\n"


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
    """Two ends of a terminal: that of the person, and that of the program."""
    ours, theirs = pty.openpty()
    try:
        yield ours, theirs
    finally:
        os.close(ours)
        os.close(theirs)


def test_progress_bar_is_shown_on_a_terminal(client: Client) -> None:
    text = json.dumps(FOLLOWED).encode()
    with terminal() as (ours, theirs):
        told = subprocess.run(
            [*MDR, "evolution"],
            input=text,
            stdout=subprocess.PIPE,
            stderr=theirs,
            check=True,
            timeout=PATIENCE,
        )
        shown = os.read(ours, 100_000)
    assert told.stdout == client.post_text("/v1/wear/evolution", text).content
    assert b"about 1 %" in shown
    # Nothing is left in the line.
    assert shown.endswith(b"\r\x1b[K")


def test_output_on_a_terminal_ends_with_a_newline(client: Client) -> None:
    with terminal() as (ours, theirs):
        subprocess.run([*MDR, "normal"], input=BODY, stdout=theirs, check=True, timeout=PATIENCE)
        shown = os.read(ours, 100_000)
    assert shown == client.post_text("/v1/normal", BODY).content + b"\r\n"


def test_interrupt_ends_the_command_without_a_traceback() -> None:
    with terminal() as (ours, theirs):
        asked = subprocess.Popen(
            [*MDR, "evolution"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=theirs,
            # A process inherits it if its parent ignores the signal, as in a shell's background.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),  # noqa: PLW1509 -- no threads
        )
        assert asked.stdin is not None
        asked.stdin.write(json.dumps(LONG).encode())
        asked.stdin.close()
        asked.stdin = None
        # As soon as the bar is there it is under way.
        shown = os.read(ours, 100)
        asked.send_signal(signal.SIGINT)
        out, _ = asked.communicate(timeout=PATIENCE)
        shown += os.read(ours, 100_000)
    assert (asked.returncode, out) == (130, b"")
    assert b"Traceback" not in shown


def test_closed_output_pipe_ends_silently() -> None:
    many = BALL | {"load": {"normal_force": [1.0 + i for i in range(10_000)]}}
    asked = subprocess.Popen(
        [*MDR, "normal"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert asked.stdout is not None
    asked.stdout.close()
    asked.stdout = None
    _, err = asked.communicate(json.dumps(many).encode(), timeout=PATIENCE)
    assert (asked.returncode, err) == (141, b"")
