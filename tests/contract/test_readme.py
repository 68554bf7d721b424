"""The commands and code of the README give the output that it shows."""

import contextlib
import csv
import io
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from mdr_service.settings import PREFIX, Settings
from tests.conftest import Client
from tests.faults.server import free_port, running, service

README = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
ADDRESS = "http://127.0.0.1:8000"


def examples(language: str, output: str) -> list[tuple[str, str]]:
    pattern = rf"```{language}\n([^`]*)```\s+```{output}\n([^`]*)```"
    return re.findall(pattern, README)


# Integrals over the cycles are compared to fewer digits, since they depend on the platform.
FOLLOWED = "/v1/wear/evolution"


def same(result: object, shown: object, rel: float = 1e-12) -> None:
    """Compare documents: numbers to twelve digits unless stated otherwise, all else exactly."""
    if isinstance(shown, dict):
        assert isinstance(result, dict)
        assert list(result) == list(shown)
        for name in shown:
            # Only the magnitude of an error estimate is reproducible.
            loose = name == "error_estimate" and rel > 1e-12
            same(result[name], shown[name], 0.5 if loose else rel)
    elif isinstance(shown, list) and shown and isinstance(shown[0], list | dict):
        assert isinstance(result, list)
        for one, other in zip(result, shown, strict=True):
            same(one, other, rel)
    elif isinstance(shown, float) or (
        isinstance(shown, list) and shown and isinstance(shown[0], float)
    ):
        assert result == pytest.approx(shown, rel=rel, abs=0)
    else:
        assert result == shown


def curl_response(client: Client, command: str) -> httpx.Response:
    """Return the response to a curl command."""
    curl, silent, address, *options = shlex.split(command)
    assert (curl, silent) == ("curl", "-s")
    assert address.startswith(ADDRESS)
    path = address.removeprefix(ADDRESS)
    if not options:
        return client.get(path)
    headers = {}
    while options[0] == "-H":
        name, _, value = options[1].partition(": ")
        headers[name] = value
        del options[:2]
    data, body = options
    assert data == "-d"
    assert headers["Content-Type"] == "application/json"
    return client.request("POST", path, content=body.encode(), headers=headers)


def output_of(client: Client, command: str) -> str:
    """Return the output of a shell command: of the service itself, or of curl in its place."""
    if command.startswith("curl"):
        return curl_response(client, command).text
    path = {"PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])}
    shell = ["sh", "-c", command]
    told = subprocess.run(shell, env=os.environ | path, capture_output=True, check=True)
    return told.stdout.decode()


def test_shell_examples_use_the_command_line() -> None:
    assert any("| mdr " in command for command, _ in examples("sh", "csv"))


@pytest.mark.parametrize(("command", "shown"), examples("sh", "json"))
def test_curl_example_shows_the_response(client: Client, command: str, shown: str) -> None:
    tolerance = 1e-3 if FOLLOWED in command else 1e-12
    same(json.loads(output_of(client, command)), json.loads(shown), tolerance)


@pytest.mark.parametrize(("command", "shown"), examples("sh", "csv"))
def test_curl_example_shows_the_table(client: Client, command: str, shown: str) -> None:
    result, expected = (
        list(csv.reader(io.StringIO(text, newline="")))
        for text in (output_of(client, command), shown)
    )
    assert result[0] == expected[0]
    for one, other in zip(result[1:], expected[1:], strict=True):
        assert list(map(float, one)) == pytest.approx(list(map(float, other)), rel=1e-12, abs=0)


@pytest.mark.parametrize(("code", "shown"), examples("python", "text"))
def test_python_example_prints_its_output(code: str, shown: str) -> None:
    port = free_port()
    output = io.StringIO()
    with running(service(port), port), contextlib.redirect_stdout(output):
        exec(code.replace(":8000", f":{port}"), {})  # noqa: S102 -- our own README
    assert output.getvalue() == shown


def test_every_setting_is_listed_with_its_default() -> None:
    for name, field in Settings.model_fields.items():
        assert f"| `{PREFIX}{name.upper()}` | {field.default or 'none'} |" in README


def test_every_example_is_tested() -> None:
    tried = [*examples("sh", "json"), *examples("sh", "csv"), *examples("python", "text")]
    assert len(tried) == len(re.findall(r"```(?:sh|python)\n", README)) == 13
