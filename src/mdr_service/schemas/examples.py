"""Example requests in SI units (N, m, Pa); tests compare their responses with textbooks."""

import json
from importlib.resources import files
from typing import Any, Final


def _read(name: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(files(__package__).joinpath(name).read_text("utf-8"))
    return content


EXAMPLES: Final = _read("examples.json")
"""Examples by the name of the query; those of `parameters` are GET requests."""
ANSWERS: Final = _read("answers.json")
"""Responses to the first example of each operation, by its name, rounded to six digits."""
