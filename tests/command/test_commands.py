"""Commands of `mdr`: arguments, help, and lazy imports."""

import subprocess
import sys

import pytest

from mdr_command import __main__ as command
from mdr_core import __version__
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
    assert capsys.readouterr().out == f"mdr {__version__}\n"


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
    assert capsys.readouterr().err == "mdr normal: there is no --nothing; see mdr normal --help\n"


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
