"""Example requests in SI units (N, m, Pa); tests compare their responses with textbooks."""

import json
from importlib.resources import files
from typing import Any, Final


def _read(name: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(files(__package__).joinpath(name).read_text("utf-8"))
    return content


_EXAMPLES: Final = _read("examples.json")
NORMAL_EXAMPLES: Final = _EXAMPLES["normal"]
TANGENTIAL_EXAMPLES: Final = _EXAMPLES["tangential"]
HISTORY_EXAMPLES: Final = _EXAMPLES["history"]
STRESS_EXAMPLES: Final = _EXAMPLES["stress"]
SUBSURFACE_EXAMPLES: Final = _EXAMPLES["subsurface"]
WEAR_EXAMPLES: Final = _EXAMPLES["wear"]
EVOLUTION_EXAMPLES: Final = _EXAMPLES["evolution"]
BATCH_EXAMPLES: Final = _EXAMPLES["batch"]
PARAMETER_EXAMPLES: Final = _EXAMPLES["parameters"]
"""Parameters of the GET requests, by the name of the query."""

ANSWERS: Final = json.loads(
    files("mdr_service").joinpath("schemas/answers.json").read_text("utf-8")
)
"""Responses to the first example of each operation, by its name, rounded to six digits."""
