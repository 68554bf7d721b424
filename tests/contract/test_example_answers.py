"""The example responses of the OpenAPI document are those of the service."""

from typing import Any

import pytest

from mdr_service.schemas.examples import ANSWERS
from tests.conftest import Client
from tests.contract.example_answers import DIGITS, answers

ROUNDED = 2 * 10.0**-DIGITS


def assert_close(
    shown: Any,
    real: Any,
    pointer: str = "",
    tolerance: float = ROUNDED,
    floor: float = 0.0,
) -> None:
    """Assert that JSON agrees within the rounding of the numbers and their own estimates.

    Estimates of a field [load][radius] are relative to its largest value, which gives the `floor`.
    """
    if isinstance(shown, dict):
        assert list(shown) == list(real), pointer
        estimates = [real[name] for name in real if name.endswith("error_estimate")]
        tolerance = max([tolerance, *estimates])
        for name in shown:
            if not name.endswith("error_estimate"):
                assert_close(shown[name], real[name], f"{pointer}/{name}", tolerance)
    elif isinstance(shown, list):
        assert len(shown) == len(real), pointer
        if tolerance > ROUNDED and shown and isinstance(shown[0], list):
            numbers = [abs(value) for row in shown for value in row if isinstance(value, float)]
            floor = tolerance * max(numbers, default=0.0)
        for index, pair in enumerate(zip(shown, real, strict=True)):
            assert_close(*pair, f"{pointer}/{index}", tolerance, floor)
    elif isinstance(shown, float):
        assert real == pytest.approx(shown, rel=tolerance, abs=floor), pointer
    else:
        assert shown == real, pointer


def test_example_responses_are_those_of_the_service(client: Client) -> None:
    assert_close(ANSWERS, answers(client))


def test_every_query_has_an_example_response(client: Client) -> None:
    document = client.get("/openapi.json").json()
    for path in document["paths"].values():
        for operation in path.values():
            if {"contact", "wear", "batch"} & set(operation["tags"]):
                content = operation["responses"]["200"]["content"]["application/json"]
                assert content["example"] == ANSWERS[operation["operationId"]]
