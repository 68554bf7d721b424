"""`mdr` accepts valid arguments, starts quickly and documents each of its commands."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from mdr_command import __main__ as command
from mdr_core import COMPILED, __version__
from mdr_service.queries import QUERIES
from tests.faults.server import PATIENCE


def test_every_query_has_a_command() -> None:
    assert {*QUERIES, "serve", "openapi"} <= {*command.COMMANDS}


@pytest.mark.parametrize("given", [["--help"], *([name, "--help"] for name in command.COMMANDS)])
def test_help_exits_with_status_zero(given: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(given)
    assert ended.value.code == 0
    result = capsys.readouterr().out
    assert result.startswith("usage: mdr")
    if given == ["--help"]:
        assert all(name in result for name in command.COMMANDS)


def test_version_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(["--version"])
    assert ended.value.code == 0
    shown = capsys.readouterr().out
    assert shown.startswith(f"mdr {__version__}")
    assert ("without its compiled module" in shown) is not COMPILED


def test_version_names_a_missing_compiled_module(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr(command, "__file__", str(tmp_path / "mdr_command" / "__main__.py"))
    with pytest.raises(SystemExit):
        command.main(["--version"])
    assert "without its compiled module: load histories" in capsys.readouterr().out


@pytest.mark.parametrize("given", [[], ["nothing"], ["--nothing"]])
def test_unknown_command_exits_with_usage(
    given: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(given)
    assert ended.value.code == 2
    assert capsys.readouterr().err.startswith("usage: mdr")


def test_unknown_option_exits_with_its_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["normal", "--nothing", "1"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("mdr normal: there is no --nothing; see mdr normal --help")


def test_command_without_options_shows_that_it_takes_a_file(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert command.main(["subsurface", "--table", "ball.csv", "--normal-force", "1"]) == 2
    assert "mdr subsurface request.json" in capsys.readouterr().err


def test_missing_module_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = command.Command("broken", "mdr broken", "mdr_service.nowhere")
    monkeypatch.setitem(command.COMMANDS, "broken", broken)
    with pytest.raises(ModuleNotFoundError):
        command.main(["broken"])


@pytest.mark.long
def test_missing_packages_are_reported_with_the_install_command() -> None:
    code = (
        "import sys\nsys.modules['orjson'] = None\nfrom mdr_command.__main__ import main\n"
        "raise SystemExit(main(['normal']))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 5
    assert (
        done.stderr
        == "mdr normal: orjson is missing; run `pip install '.[service]'` in the checkout\n"
    )


def test_help_imports_no_numerical_module() -> None:
    code = (
        "import sys\nfrom mdr_command.__main__ import main\ntry:\n    main(['--help'])\n"
        "finally:\n    assert not {'numpy', 'pydantic', 'mdr_service'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, timeout=PATIENCE)


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-8"])
@pytest.mark.parametrize("given", ["--help", "profiles", "normal --help", "completion zsh"])
def test_text_is_shown_on_any_terminal(encoding: str, given: str) -> None:
    process = run(given, PYTHONIOENCODING=encoding)
    assert (process.returncode, process.stderr) == (0, b"")
    assert ("\\u" in process.stdout.decode(encoding)) == (encoding != "utf-8" and given != "--help")


@pytest.mark.long
def test_openapi_document_is_utf8_on_any_terminal() -> None:
    document = json.loads(run("openapi", PYTHONIOENCODING="ascii").stdout.decode())
    assert document["info"]["title"] == "MDR"
    assert "µ" in json.dumps(document, ensure_ascii=False)


@pytest.mark.parametrize(
    ("given", "status", "message"),
    [
        ("profiles >&-", 4, b"mdr: [Errno 9] Bad file descriptor\n"),
        ("profiles >&- 2>&-", 4, b""),
        ("profiles <&-", 0, b""),
        ("normal - <&-", 2, b"mdr normal: "),
    ],
)
def test_closed_stream_is_no_internal_error(given: str, status: int, message: bytes) -> None:
    process = run(given)
    assert process.returncode == status
    assert message in process.stderr
    assert b"Traceback" not in process.stderr


def run(given: str, **environment: str) -> "subprocess.CompletedProcess[bytes]":
    """Run `mdr` with the arguments and redirections of a shell."""
    return subprocess.run(
        ["sh", "-c", f"exec {sys.executable} -m mdr_command {given}"],
        env=os.environ | environment,
        capture_output=True,
        check=False,
        timeout=PATIENCE,
    )
