"""Example responses of the OpenAPI document; regenerated when run as a module."""

import json
import sys
from importlib.resources import files
from math import ceil, log10
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest

from mdr_service import openapi, queries
from mdr_service.schemas.examples import EXAMPLES
from tests.conftest import Client, running_client

PATHS = {name: query.path.removeprefix("/v1/") for name, query in queries.QUERIES.items()}
QUERIES = {name: (path, EXAMPLES[name]) for name, path in (PATHS | {"batch": "batch"}).items()}
DIGITS = 6


def supported(document: dict[str, Any], digits: int) -> int:
    """Return how many digits the error estimate of a document supports, at most `digits`."""
    estimate = document.get("error_estimate", 0.0)
    return min(digits, ceil(-log10(estimate))) if estimate else digits


def rounded(value: Any, digits: int = DIGITS) -> Any:
    """Return JSON with the supported digits of every number, and one digit of every estimate."""
    if isinstance(value, dict):
        digits = supported(value, digits)
        return {
            key: rounded(each, 1 if key.endswith("error_estimate") else digits)
            for key, each in value.items()
        }
    if isinstance(value, list):
        return [rounded(each, digits) for each in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value


def assert_close(
    shown: Any,
    real: Any,
    digits: int = sys.float_info.dig,
    estimate: float = 0.0,
    scale: float = 0.0,
    pointer: str = "",
) -> None:
    """Assert that JSON agrees within the rounding to its digits and twice its error estimates.

    Twice, because the documents may come from two processors. Estimates of a field [load][radius]
    are relative to its largest value, the `scale`. Of an estimate, the magnitude is compared.
    """
    if isinstance(shown, dict):
        assert list(shown) == list(real), pointer
        estimates = [real[name] for name in real if name.endswith("error_estimate")]
        estimate, digits = max([estimate, *estimates]), supported(real, digits)
        for name in shown:
            here = (1, 0.0) if name.endswith("error_estimate") else (digits, estimate)
            if "value" in shown and name != "value":
                # A stress changes with the square of the distance from its peak.
                here = digits, estimate**0.5
            assert_close(shown[name], real[name], *here, pointer=f"{pointer}/{name}")
    elif isinstance(shown, list):
        assert len(shown) == len(real), pointer
        if shown and isinstance(shown[0], list):
            numbers = [abs(value) for row in shown for value in row if isinstance(value, float)]
            scale = max(numbers, default=0.0)
        for index, pair in enumerate(zip(shown, real, strict=True)):
            assert_close(*pair, digits, estimate, scale, f"{pointer}/{index}")
    elif isinstance(shown, float):
        rel = 5 * 10.0**-digits + 2 * estimate
        assert real == pytest.approx(shown, rel=rel, abs=2 * estimate * scale), pointer
    else:
        assert shown == real, pointer


def answers(client: Client) -> dict[str, Any]:
    """Return the response to the first example of each operation, by its name."""
    result = {}
    for name, (path, examples) in QUERIES.items():
        body = next(iter(examples.values()))["value"]
        result[name] = client.post(f"/v1/{path}", body).json()
    for name, parameters in EXAMPLES["parameters"].items():
        path = QUERIES[name][0]
        result[f"get_{name}"] = client.get(f"/v1/{path}?{urlencode(parameters)}").json()
    return result


if __name__ == "__main__":
    with running_client() as served:
        text = json.dumps(rounded(answers(served)), ensure_ascii=False, indent=1)
    Path(str(files(openapi.__package__).joinpath("schemas/answers.json"))).write_text(text + "\n")
