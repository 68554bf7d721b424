"""Each figure of the gallery is the response to its request, and its Python computes the same."""

import json
import re
import shutil
from pathlib import Path
from textwrap import dedent
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt

from tests.conftest import Client
from tests.contract.test_readme import curl_command

FOLDER = Path(__file__).parents[2] / "docs"
EXAMPLES = FOLDER.parent / "examples"
PAGE = (FOLDER / "gallery.md").read_text("utf-8")
REQUESTS = dict(re.findall(r'```json title="(\w+)\.json"\n(.*?)```', PAGE, re.DOTALL))
COMMANDS = {
    re.findall(r"@(\w+)\.json", command)[0]: command.strip()
    for command in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
}
PROGRAMS = {
    re.findall(r'savefig\("(\w+)\.svg"\)', program)[0]: dedent(program)
    for program in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
}
FIGURES = re.findall(r"!\[[^]]*\]\(gallery/(\w+)\.svg\)", PAGE)


def test_every_figure_has_request_curl_and_python() -> None:
    assert len(FIGURES) >= 9
    for each in (REQUESTS, COMMANDS, PROGRAMS):
        assert list(each) == FIGURES
    assert {path.stem for path in (FOLDER / "gallery").iterdir()} == set(FIGURES)


@pytest.mark.every(3)
@pytest.mark.parametrize("name", FIGURES)
def test_figure_is_the_response(client: Client, name: str) -> None:
    path, target = curl_command(COMMANDS[name])
    assert target == f"{name}.svg"
    response = client.post_text(path, REQUESTS[name].encode())
    assert response.status_code == 200
    same_picture(response.text, (FOLDER / "gallery" / target).read_text("utf-8"))


def same_picture(one: str, other: str) -> None:
    """Compare elements, texts, and the numbers of paths to a tenth of a point.

    The names of clipping paths and markers are digests, which depend on the last digit.
    """
    pattern = r"<(\w+)|>([^<>]+)</text>"
    assert re.findall(pattern, one) == re.findall(pattern, other)
    for first, second in zip(
        *(re.findall(r' d="([^"]*)"', each) for each in (one, other)), strict=True
    ):
        numbers = [
            np.array(re.sub("[A-Za-z]", " ", each).split(), float) for each in (first, second)
        ]
        assert numbers[0] == pytest.approx(numbers[1], abs=0.1)


@pytest.mark.parametrize("name", FIGURES)
def test_python_computes_the_response(
    client: Client, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, _ = curl_command(COMMANDS[name])
    response = client.post_text(path.partition("?")[0], REQUESTS[name].encode()).json()
    shutil.copy(EXAMPLES / "tip.csv", tmp_path)
    monkeypatch.chdir(tmp_path)
    with mpl.rc_context({"backend": "agg"}):
        exec(PROGRAMS[name], {})  # noqa: S102 -- our own page
        lines = [np.array(line.get_ydata(), dtype=float) for line in plt.gca().get_lines()]
        plt.close("all")
    assert (tmp_path / f"{name}.svg").exists()
    # Measured points are those of the request.
    rows = [*rows_of(response), *rows_of(json.loads(REQUESTS[name]))]
    assert lines
    for line in lines:
        assert any(
            row.size == line.size and np.allclose(row, line, rtol=1e-9, atol=0) for row in rows
        ), name


def rows_of(value: Any) -> Any:
    """Yield the innermost lists of numbers, and columns of single points; null is infinite."""
    if isinstance(value, dict):
        for each in value.values():
            yield from rows_of(each)
    elif isinstance(value, list) and value and isinstance(value[0], list):
        if len(value[0]) == 1:
            yield from rows_of([row[0] for row in value])
        for each in value:
            yield from rows_of(each)
    elif isinstance(value, list) and not any(isinstance(each, str | dict) for each in value):
        yield np.array([np.inf if each is None else each for each in value], dtype=float)
