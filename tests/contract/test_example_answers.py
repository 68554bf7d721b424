"""The example responses of the OpenAPI document are those of the service."""

from mdr_service.schemas.examples import ANSWERS
from tests.conftest import Client
from tests.contract.example_answers import DIGITS, answers, assert_close


def test_example_responses_are_those_of_the_service(client: Client) -> None:
    assert_close(ANSWERS, answers(client), DIGITS)


def test_every_query_has_an_example_response(client: Client) -> None:
    document = client.get("/openapi.json").json()
    for path in document["paths"].values():
        for operation in path.values():
            # A file, the input of `table`, is not JSON.
            is_file = operation["operationId"] == "table"
            if {"contact", "wear", "batch"} & set(operation["tags"]) and not is_file:
                content = operation["responses"]["200"]["content"]["application/json"]
                assert content["example"] == ANSWERS[operation["operationId"]]
