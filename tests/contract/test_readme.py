"""The commands and code of README and manual give the output that they show."""

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
from playwright._impl._driver import compute_driver_executable

from mdr_service.settings import PREFIX, Settings
from tests.conftest import Client
from tests.contract.example_answers import assert_close
from tests.faults.server import free_port, running, service

ROOT = Path(__file__).parents[2]
# The gallery shows figures in place of output: `test_gallery.py`.
PAGES = [
    page
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
    if page.name != "gallery.md"
]
TEXTS = {page.name: page.read_text("utf-8") for page in PAGES}
ADDRESS = "http://127.0.0.1:8000"


def examples(language: str, output: str) -> list[tuple[str, str]]:
    pattern = rf"```{language}\n([^`]*)```\s+```{output}\n([^`]*)```"
    return [found for text in TEXTS.values() for found in re.findall(pattern, text)]


# Tables show no estimate. Two processors may each err by the 1e-12 that closed forms promise.
TABLE = 2e-12
NUMBER = re.compile(r"[+-]?\d+(?:\.\d*)?(?:e[+-]?\d+)?")


def same_text(result: str, shown: str) -> None:
    """Compare printed text: numbers within one unit of the sixth digit, all else exactly."""
    assert NUMBER.split(result) == NUMBER.split(shown)
    numbers = ([float(number) for number in NUMBER.findall(text)] for text in (result, shown))
    assert next(numbers) == pytest.approx(next(numbers), rel=1e-5, abs=0)


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


def curl_command(command: str) -> tuple[str, str]:
    """Return path and output file of a command that sends a file."""
    curl, silent, address, option, _, data, _, output, target = shlex.split(command)
    assert (curl, silent, option, data, output) == ("curl", "-s", "-H", "-d", "-o")
    assert address.startswith(ADDRESS)
    return address.removeprefix(ADDRESS), target


def output_of(client: Client, command: str) -> str:
    """Return the output of a shell command: of the service itself, or of curl in its place."""
    if command.startswith("curl"):
        return curl_response(client, command).text
    return shell(command)


def shell(command: str, folder: Path | None = None) -> str:
    """Return the output of a command line in which `mdr` comes from this environment."""
    path = {"PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])}
    done = subprocess.run(
        ["sh", "-c", command], cwd=folder, env=os.environ | path, capture_output=True, check=True
    )
    return done.stdout.decode()


@pytest.mark.parametrize(("command", "shown"), examples("sh", "json"))
def test_curl_example_shows_the_response(client: Client, command: str, shown: str) -> None:
    assert_close(json.loads(shown), json.loads(output_of(client, command)))


@pytest.mark.parametrize(
    ("command", "shown"),
    [
        pytest.param(*each, marks=[] if each[0].startswith("curl") else pytest.mark.long)
        for each in examples("sh", "csv")
    ],
)
def test_curl_example_shows_the_table(client: Client, command: str, shown: str) -> None:
    result, expected = (
        list(csv.reader(io.StringIO(text, newline="")))
        for text in (output_of(client, command), shown)
    )
    assert result[0] == expected[0]
    for one, other in zip(result[1:], expected[1:], strict=True):
        assert list(map(float, one)) == pytest.approx(list(map(float, other)), rel=TABLE, abs=0)


@pytest.mark.long
def test_python_examples_print_their_output() -> None:
    port = free_port()
    with running(service(port), port):
        for code, shown in examples("python", "text"):
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(code.replace(":8000", f":{port}"), {})  # noqa: S102 -- our own pages
            same_text(output.getvalue(), shown)


@pytest.mark.long
def test_javascript_examples_print_their_output() -> None:
    port = free_port()
    with running(service(port), port):
        for code, shown in examples("js", "text"):
            script = code.replace(":8000", f":{port}")
            node = [compute_driver_executable()[0], "--input-type=module", "--eval", script]
            same_text(subprocess.check_output(node, text=True), shown)


@pytest.mark.long
def test_python_examples_are_typed(tmp_path: Path) -> None:
    files = [tmp_path / f"example_{i}.py" for i, _ in enumerate(examples("python", "text"))]
    for file, (code, _) in zip(files, examples("python", "text"), strict=True):
        file.write_text(code, "utf-8")
    mypy = [sys.executable, "-m", "mypy", "--strict", "--config-file", os.devnull]
    # pandas has no types of its own.
    mypy += ["--disable-error-code", "import-untyped"]
    done = subprocess.run([*mypy, *files], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_every_setting_is_listed_with_its_default() -> None:
    for name, field in Settings.model_fields.items():
        row = f"| `{PREFIX}{name.upper()}` | {field.default or 'none'} |"
        assert row in TEXTS["operation.md"]


REQUESTS = [
    (path, request)
    for name, path in (("yield.md", "/v1/subsurface"), ("sweeps.md", "/v1/tangential"))
    for request in re.findall(r"```json\n([^`]*)```", TEXTS[name])
]


@pytest.mark.parametrize(("path", "request_text"), REQUESTS)
def test_request_is_solved(client: Client, path: str, request_text: str) -> None:
    # An axis of a sweep is a text in place of a number: its start is a case.
    one_case = re.sub(r'"([0-9.e-]+):[^"]*:log"', r"\1", request_text)
    assert client.post_text(path, one_case.encode()).status_code == 200


@pytest.mark.long
def test_sweep_of_the_manual_can_start(tmp_path: Path) -> None:
    (command,) = re.findall(r"```\n(mdr sweep [^`]*)```", TEXTS["sweeps.md"])
    (study,) = re.findall(r"```json\n([^`]*)```", TEXTS["sweeps.md"])
    (tmp_path / "study.json").write_text(study, "utf-8")
    assert "1,000,000" in shell(f"{command.strip()} --plan", tmp_path)


def test_every_example_is_tested() -> None:
    tried = [*examples("sh", "json"), *examples("sh", "csv"), *examples("python", "text")]
    shown = [re.findall(r"^```(?:sh|python)\n", text, re.MULTILINE) for text in TEXTS.values()]
    assert len(tried) == sum(map(len, shown)) >= 16
    answers = len([*examples("sh", "json"), *REQUESTS])
    shown = [re.findall(r"^```json\n", text, re.MULTILINE) for text in TEXTS.values()]
    assert answers == sum(map(len, shown))


@pytest.mark.parametrize("page", [*PAGES, ROOT / "docs" / "gallery.md", ROOT / "CONTRIBUTING.md"])
def test_links_between_files_lead_to_files(page: Path) -> None:
    for link in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text("utf-8")):
        assert (page.parent / link).exists(), link


def test_profile_table_lists_every_kind(client: Client) -> None:
    shown = re.findall(r"^\| `(\w+)` \| (.*?) \| (.*?) \|$", TEXTS["http.md"], re.MULTILINE)
    kinds = {
        each["kind"]: (", ".join(f"`{field['name']}`" for field in each["fields"]), each["formula"])
        for each in client.get("/v1/profiles").json()["profiles"]
    }
    assert {kind: tuple(rest) for kind, *rest in shown if kind in kinds} == kinds
