"""Example responses of the OpenAPI document; regenerated when run as a module."""

import json
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from mdr_service import openapi
from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import Client, running_client

QUERIES = {
    "normal": ("normal", EXAMPLES["normal"]),
    "tangential": ("tangential", EXAMPLES["tangential"]),
    "history": ("tangential/history", EXAMPLES["history"]),
    "stress": ("stress", EXAMPLES["stress"]),
    "subsurface": ("subsurface", EXAMPLES["subsurface"]),
    "wear": ("wear", EXAMPLES["wear"]),
    "evolution": ("wear/evolution", EXAMPLES["evolution"]),
    "batch": ("batch", EXAMPLES["batch"]),
}
DIGITS = 6


def rounded(value: Any) -> Any:
    """Return JSON with six significant digits of every number."""
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, list):
        return [rounded(each) for each in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def answers(client: Client) -> dict[str, Any]:
    """Return the response to the first example of each operation, by its name."""
    result = {}
    for name, (path, examples) in QUERIES.items():
        body = next(iter(examples.values()))["value"]
        result[name] = rounded(client.post(f"/v1/{path}", body).json())
    for name, parameters in EXAMPLES["parameters"].items():
        path = QUERIES[name][0]
        result[f"get_{name}"] = rounded(client.get(f"/v1/{path}?{urlencode(parameters)}").json())
    return result


if __name__ == "__main__":
    with running_client() as served:
        text = json.dumps(answers(served), ensure_ascii=False, indent=1)
    Path(str(files(openapi.__package__).joinpath("schemas/answers.json"))).write_text(text + "\n")
