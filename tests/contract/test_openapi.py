"""The committed OpenAPI document is the one that is served, and it is complete."""

import json
import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import pytest

from mdr_service import problems
from mdr_service.schemas.answers import (
    Answer,
    EvolutionAnswer,
    HistoryAnswer,
    NormalAnswer,
    Problem,
    StressAnswer,
    SubsurfaceAnswer,
    TangentialAnswer,
    WearAnswer,
)
from mdr_service.serializers import PICTURES
from tests.conftest import Client
from tests.contract import strict_json

ROOT = Path(__file__).parents[2]
DOCUMENT = json.loads((ROOT / "openapi.json").read_text("utf-8"))
DIMENSIONS = ("[length]", "[pressure]", "[force]", "[1]")


def operations() -> Iterator[tuple[str, dict[str, object]]]:
    for path, methods in DOCUMENT["paths"].items():
        for method, operation in methods.items():
            yield f"{method} {path}", operation


def references(part: object) -> Iterator[str]:
    if isinstance(part, dict):
        if isinstance(part.get("$ref"), str):
            yield part["$ref"]
        part = list(part.values())
    if isinstance(part, list):
        for each in part:
            yield from references(each)


def test_committed_document_is_the_served_one(client: Client) -> None:
    assert strict_json.loads(client.get("/openapi.json").content) == DOCUMENT, "run make openapi"


def test_every_reference_is_defined() -> None:
    defined = {f"#/components/schemas/{name}" for name in DOCUMENT["components"]["schemas"]}
    assert set(references(DOCUMENT)) <= defined


@pytest.mark.parametrize(("name", "operation"), list(operations()))
def test_every_operation_documents_its_problems(name: str, operation: dict[str, object]) -> None:
    assert operation["summary"]
    assert operation["operationId"]
    expected = {"200", "431", "500"}
    if name.startswith("post"):
        expected |= {"400", "406", "408", "413", "415", "422", "503", "504"}
    if operation["operationId"] == "table":
        # A file of any media type, and a response in JSON alone.
        expected -= {"400", "406", "415"}
    if operation["operationId"].startswith("get_"):
        expected |= {"406", "422", "503", "504"}
    if operation["operationId"] == "ready":
        expected |= {"503", "504"}
    assert set(operation["responses"]) == expected
    for status in expected - {"200"}:
        content = operation["responses"][status]["content"]
        schema = {"$ref": "#/components/schemas/Problem"}
        assert content == {problems.MEDIA_TYPE: {"schema": schema}}


def test_every_profile_field_states_its_dimension() -> None:
    profile = DOCUMENT["components"]["schemas"]["NormalQuery"]["properties"]["profile"]
    kinds = [reference.rpartition("/")[2] for reference in references(profile)]
    assert len(set(kinds)) == 16
    for kind in kinds:
        fields = DOCUMENT["components"]["schemas"][kind]["properties"]
        for name in set(fields) - {"kind", "terms"}:
            description = fields[name]["description"]
            assert description.endswith((*DIMENSIONS, "[length^(1-exponent)]", "[degree]")), (
                kind,
                name,
            )


def test_every_profile_states_the_limits_of_its_numbers() -> None:
    for name, schema in DOCUMENT["components"]["schemas"].items():
        for field, described in schema.get("properties", {}).items():
            if described.get("type") == "number" and not field.endswith("error_estimate"):
                limits = {"minimum", "exclusiveMinimum", "maximum"} & set(described)
                assert len(limits) == 2, (name, field)


def test_every_problem_type_is_documented() -> None:
    text = (ROOT / "docs/errors.md").read_text("utf-8")
    rows = re.findall(r"^\| `([a-z-]+)` \| (\d{3}) \|", text, re.MULTILINE)
    known = [each for each in vars(problems).values() if isinstance(each, problems.ProblemType)]
    assert rows == [(kind.name, str(kind.status)) for kind in known]


RESPONSES = pytest.mark.parametrize(
    ("path", "model"),
    [
        ("/v1/normal", NormalAnswer),
        ("/v1/tangential", TangentialAnswer),
        ("/v1/tangential/history", HistoryAnswer),
        ("/v1/stress", StressAnswer),
        ("/v1/subsurface", SubsurfaceAnswer),
        ("/v1/wear", WearAnswer),
        ("/v1/wear/evolution", EvolutionAnswer),
    ],
)


@RESPONSES
def test_response_matches_its_schema(client: Client, path: str, model: type[Answer]) -> None:
    post = DOCUMENT["paths"][path]["post"]
    examples = post["requestBody"]["content"]["application/json"]["examples"]
    for example in examples.values():
        response = client.post(path, example["value"])
        assert response.headers["content-type"] == "application/json"
        strict_json.loads(response.content)
        model.model_validate_json(response.content)
    # The values of tables and archives are compared in test_formats and test_formats_arrays.
    example = next(iter(examples.values()))
    for media_type in post["responses"]["200"]["content"]:
        if media_type not in PICTURES:
            returned_in(client, path, example["value"], media_type)


def returned_in(client: Client, path: str, query: object, media_type: str) -> None:
    response = client.request("POST", path, json=query, headers={"accept": media_type})
    assert response.status_code == 200
    assert response.headers["content-type"].partition(";")[0] == media_type


@pytest.mark.long
@pytest.mark.parametrize(
    "path",
    [
        path
        for path in DOCUMENT["paths"]
        if "post" in DOCUMENT["paths"][path] and path != "/v1/table"
    ],
)
def test_pictures_are_drawn(client: Client, path: str) -> None:
    post = DOCUMENT["paths"][path]["post"]
    example = next(iter(post["requestBody"]["content"]["application/json"]["examples"].values()))
    for media_type in post["responses"]["200"]["content"]:
        if media_type in PICTURES:
            returned_in(client, path, example["value"], media_type)


def test_every_member_states_its_dimension() -> None:
    loads = ("Load", "Tangential", "NormalPoints", "TangentialPoints")
    oscillations = ("OscillatingNormalLoad", "TangentialAmplitude", "Oscillation")
    constant = ("ConstantNormalLoads", "ConstantNormalLoad")
    answers = ("NormalAnswer", "TangentialAnswer", "HistoryAnswer", "StressAnswer")
    answers += ("WearAnswer", "EvolutionAnswer")
    for query in (*loads, *oscillations, *constant, *answers):
        schema = DOCUMENT["components"]["schemas"][query]
        parts = schema.get("oneOf", [schema])
        for name, field in chain(*(part["properties"].items() for part in parts)):
            if name == "amplitude":
                assert field["description"].endswith("[as the mean]")
            elif name not in {
                "holds_while",
                "method",
                "sources",
                "warnings",
                "regime",
                "final_state",
            }:
                assert re.search(r"\[[a-z0-9/*^]+\]$", field["description"]), (query, name)


def test_members_of_a_schema_are_described_on_one_line_with_dimension_and_default() -> None:
    schemas = DOCUMENT["components"]["schemas"]
    for schema in schemas.values():
        for part in schema.get("oneOf", [schema]):
            for field in part.get("properties", {}).values():
                description = field.get("description", "")
                assert "\n" not in description
                dimension = re.search(r" \[([^\[]*)\]$", description)
                assert field.get("x-dimension") == (dimension and dimension[1])
    assert "default" not in schemas["Cycles"]["properties"]["count"]
    (count,) = (
        parameter
        for parameter in DOCUMENT["paths"]["/v1/tangential/history"]["get"]["parameters"]
        if parameter["name"] == "count"
    )
    for described in (schemas["Cycles"]["properties"]["count"], count):
        assert described["description"] == "Number of cycles; default 1 [1]"


def test_problem_matches_its_schema(client: Client) -> None:
    Problem.model_validate_json(client.post("/v1/normal", {}).content)
