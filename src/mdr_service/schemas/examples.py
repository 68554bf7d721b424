"""Example requests in SI units (N, m, Pa); tests compare their responses with textbooks."""

import json
from importlib.resources import files
from typing import Any, Final

_FOLDER: Final = files(__package__)
EXAMPLES: Final[dict[str, Any]] = json.loads(_FOLDER.joinpath("examples.json").read_text("utf-8"))
"""Examples by the name of the query; `parameters` contains GET requests."""
ANSWERS: Final[dict[str, Any]] = json.loads(_FOLDER.joinpath("answers.json").read_text("utf-8"))
"""Responses to the first example of each operation, by its name, rounded to six digits."""
