"""The commands: what each takes, and what is loaded for it."""

import subprocess
import sys
from importlib.metadata import version

import pytest

from mdr_command import __main__ as command
from mdr_service.questions import QUESTIONS
from tests.faults.server import PATIENCE


def test_every_question_is_a_command() -> None:
    assert {*QUESTIONS, "serve", "openapi"} <= {*command.COMMANDS}


@pytest.mark.parametrize("given", [["--help"], *([name, "--help"] for name in command.COMMANDS)])
def test_help_is_at_hand(given: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(given)
    assert ended.value.code == 0
    told = capsys.readouterr().out
    assert told.startswith("usage: mdr")
    if given == ["--help"]:
        assert all(name in told for name in command.COMMANDS)


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"mdr {version('mdr')}\n"


@pytest.mark.parametrize(
    "given", [[], ["nothing"], ["--nothing"], ["normal", "--nothing"], ["serve", "--port", "-1"]]
)
def test_what_is_no_command_is_refused(
    given: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(given)
    assert ended.value.code == 2
    assert capsys.readouterr().err.startswith("usage: mdr")


def test_a_missing_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lacking = command.Command("needs more", "nowhere.to.be_found", extra="more")
    monkeypatch.setitem(command.COMMANDS, "lacking", lacking)
    assert command.main(["lacking"]) == 2
    assert capsys.readouterr().err == "mdr lacking needs nowhere: install mdr[more]\n"


def test_a_missing_part_of_ours_is_a_defect(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = command.Command("broken", "mdr_service.nowhere")
    monkeypatch.setitem(command.COMMANDS, "broken", broken)
    with pytest.raises(ModuleNotFoundError):
        command.main(["broken"])


def test_nothing_is_loaded_to_tell_of_the_commands() -> None:
    code = (
        "import sys\nfrom mdr_command.__main__ import main\ntry:\n    main(['--help'])\n"
        "finally:\n    assert not {'numpy', 'pydantic', 'mdr_service'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, timeout=PATIENCE)
