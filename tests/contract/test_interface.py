"""The interface `/v1` only grows from one release to the next."""

import copy
import json
from collections.abc import Callable
from typing import Any

import pytest

from tests.contract.interface import RELEASED, ROOT, broken, facts

DOCUMENT = json.loads((ROOT / "openapi.json").read_text("utf-8"))
Schemas = dict[str, Any]


def test_nothing_released_is_lost_and_no_member_becomes_required() -> None:
    """Before version 1.0 a minor release may break it: `python -m tests.contract.interface`."""
    released = set(RELEASED.read_text("utf-8").splitlines())
    assert broken(released, DOCUMENT) == []


def schema(name: str) -> Callable[[Any], Any]:
    return lambda document: document["components"]["schemas"][name]


BREAKS: dict[str, tuple[str, Callable[[Any], object]]] = {
    "path": ("- POST /v1/torsion", lambda d: d["paths"].pop("/v1/torsion")),
    "format": (
        "- POST /v1/normal 200 text/csv",
        lambda d: d["paths"]["/v1/normal"]["post"]["responses"]["200"]["content"].pop("text/csv"),
    ),
    "member of a request": (
        "- FitQuery.noise",
        lambda d: schema("FitQuery")(d)["properties"].pop("noise"),
    ),
    "member of a response": (
        "- NormalAnswer.contact_radius",
        lambda d: schema("NormalAnswer")(d)["properties"].pop("contact_radius"),
    ),
    "member that a response always had": (
        "- NormalAnswer.contact_radius is required",
        lambda d: schema("NormalAnswer")(d)["required"].remove("contact_radius"),
    ),
    "value": (
        "- FitQuery.fit: force_offset",
        lambda d: schema("FitQuery")(d)["properties"]["fit"]["items"]["enum"].remove(
            "force_offset"
        ),
    ),
    "type": (
        "- FitQuery.noise: number",
        lambda d: schema("FitQuery")(d)["properties"]["noise"].update(type="string"),
    ),
    "new requirement": (
        "+ FitQuery.noise is required",
        lambda d: schema("FitQuery")(d)["required"].append("noise"),
    ),
    "new parameter that is required": (
        "+ GET /v1/normal ?other is required",
        lambda d: d["paths"]["/v1/normal"]["get"]["parameters"].append(
            {"name": "other", "required": True, "schema": {"type": "number"}}
        ),
    ),
}


@pytest.mark.parametrize("name", BREAKS)
def test_each_kind_of_break_is_found(name: str) -> None:
    expected, change = BREAKS[name]
    changed = copy.deepcopy(DOCUMENT)
    change(changed)
    assert expected in broken(facts(DOCUMENT), changed)


def test_growth_is_no_break() -> None:
    grown = copy.deepcopy(DOCUMENT)
    schemas = grown["components"]["schemas"]
    schemas["FitQuery"]["properties"]["weights"] = {"type": "array"}
    schemas["FitQuery"]["required"].remove("normal_force")
    schemas["NewQuery"] = {"properties": {"load": {"type": "number"}}, "required": ["load"]}
    body = {"content": {"application/json": {"schema": {"$ref": "#/components/schemas/NewQuery"}}}}
    grown["paths"]["/v1/new"] = {"post": {"requestBody": body, "responses": {"200": {}}}}
    assert broken(facts(DOCUMENT), grown) == []
