"""GET returns the response of the equivalent POST, and its errors name the parameter."""

import json
import pickle
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mdr_service import problems
from mdr_service.query_parameters import PARAMETERS
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.settings import SETTINGS
from tests.conftest import Client
from tests.contract import strict_json
from tests.service.test_wrong_input import pointers

DOCUMENT = json.loads((Path(__file__).parents[2] / "openapi.json").read_text("utf-8"))
BALL = {"kind": "paraboloid", "radius": 0.01}
MODULI = {"e_star": 1.15e11, "g_star": 9.5e10}
STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
BODIES = {"youngs_modulus_1": 210e9, "poissons_ratio_1": 0.3}
FRICTION = {"friction_coefficient": 0.3}
REQUEST = {"profile": BALL, "material": MODULI}
RANGE = {"normal_force_from": 1, "normal_force_to": 10, "n": 50}
NORMAL = {**BALL, "e_star": 1.15e11, "normal_force": 10}
DATA = Path(__file__).parents[1] / "data"
# Parameters and the equivalent request, in which a list of numbers may be a range.
SAME = json.loads((DATA / "same_requests.json").read_text("utf-8"))


def expanded(value: Any) -> Any:
    """Return a request with its ranges as lists."""
    if isinstance(value, dict) and "range" in value:
        spaced = np.geomspace if value["scale"] == "log" else np.linspace
        return spaced(*value["range"]).tolist()
    if isinstance(value, dict):
        return {name: expanded(each) for name, each in value.items()}
    return value


def at(query: str, parameters: Mapping[str, object] | None = None) -> str:
    path = f"/v1/{'tangential/history' if query == 'history' else query}"
    return f"{path}?{urlencode(parameters)}" if parameters else path


@pytest.mark.parametrize(
    "form", ["json", "csv", "npz", pytest.param("svg", marks=pytest.mark.long)]
)
@pytest.mark.parametrize("name", SAME)
def test_get_returns_the_bytes_of_post(client: Client, name: str, form: str) -> None:
    query, parameters, request = SAME[name].values()
    computed = client.get(at(query, {**parameters, "format": form}))
    expected = client.post(f"{at(query)}?format={form}", expanded(request))
    assert expected.status_code == 200
    assert computed.status_code == expected.status_code
    assert computed.headers["content-type"] == expected.headers["content-type"]
    assert computed.content == expected.content


def test_chosen_members_are_returned_alone(client: Client) -> None:
    whole = client.get(at("normal", NORMAL)).json()
    chosen = client.get(at("normal", {**NORMAL, "answers": "contact_radius,method"}))
    assert chosen.json() == {name: whole[name] for name in ("contact_radius", "method")}
    for form, separator in {"csv": "\r\n", "txt": "\n"}.items():
        query = {**BALL, "e_star": 1.15e11, **RANGE, "answers": "normal_force", "format": form}
        lines = client.get(at("normal", query)).text.strip().split(separator)
        assert [float(each) for each in lines[form == "csv" :]] == np.linspace(1, 10, 50).tolist()


@pytest.mark.parametrize("name", ["contact_radius", "error_estimate"])
def test_one_number_as_text_is_the_number_alone(client: Client, name: str) -> None:
    whole = client.get(at("normal", NORMAL)).json()
    text = client.get(at("normal", {**NORMAL, "answers": name, "format": "txt"}))
    assert text.headers["content-type"].partition(";")[0] == "text/plain"
    assert float(text.text) == np.ravel(whole[name])[0]
    assert re.fullmatch(r"[0-9.e-]+", text.text)


# By query: parameters, and wrong changes of them, each with the parameter at fault and, for the
# mistakes of newcomers, what a reader has to be told to continue.
STORED = json.loads((DATA / "wrong_parameters.json").read_text("utf-8"))
REJECTED = [(query, name) for query, cases in STORED.items() for name in cases["wrong"]]


@pytest.mark.parametrize(("query", "name"), REJECTED)
def test_invalid_value_points_at_its_parameter(client: Client, query: str, name: str) -> None:
    case = STORED[query]["wrong"][name]
    given = STORED[query]["parameters"] | case.get("change", {})
    given = {each: given[each] for each in given if each not in case.get("without", ())}
    response = client.get(at(query, given))
    assert response.status_code == 422
    assert f"/{case['pointer']}" in pointers(response)
    if "said" in case:
        detail = response.json()["detail"]
        assert detail.startswith(f"{case['pointer']}: ")
        assert all(part in detail for part in case["said"]), detail


@pytest.mark.parametrize("count", [SETTINGS.max_length + 1, "9" * 5000], ids=["many", "huge"])
def test_range_of_too_many_is_rejected(client: Client, count: object) -> None:
    response = client.get(at("normal", {**BALL, "e_star": 1, **RANGE, "n": count}))
    assert "/n" in pointers(response)


def test_unknown_format_is_not_acceptable(client: Client) -> None:
    answer = client.get(at("normal", {**NORMAL, "format": "xml"}))
    assert (answer.status_code, answer.json()["type"]) == (406, "urn:mdr:problem:not-acceptable")


@pytest.mark.parametrize("loads", ["1,2,3", "1.0,2.0", "1e0, 2", "+1,2.5,3"])
def test_list_of_loads_equals_the_list_of_the_request(client: Client, loads: str) -> None:
    response = client.get(at("normal", {**NORMAL, "normal_force": loads}))
    assert response.json()["normal_force"] == [float(each) for each in loads.split(",")]


@pytest.mark.parametrize(
    "loads",
    [
        "1,10",
        "1:10",
        "1;10",
        "0,5",
        "-0,5",
        "1.234,5",
        "1,234",
        "1,234.5",
        "1,234,567",
        "1,2,",
        ",1",
    ],
)
def test_number_with_a_comma_is_told_how_to_give_a_list(client: Client, loads: str) -> None:
    response = client.get(at("normal", {**NORMAL, "normal_force": loads}))
    advice = "; give several as a list such as 1.0,2.0, or as a range by _from, _to and n"
    assert response.json()["detail"].endswith(advice)
    # Of a radius of the profile there is one.
    response = client.get(at("normal", {**NORMAL, "radius": loads}))
    assert response.json()["detail"].endswith("a decimal comma")


def test_repeated_parameter_is_rejected(client: Client) -> None:
    response = client.get(at("normal", NORMAL) + "&radius=0.01&e_star=1")
    assert pointers(response) == ["/radius", "/e_star"]
    assert response.json()["detail"].endswith(": is given more than once (and 1 more)")
    assert "more parameters" in client.get("/v1/normal?" + "a&" * 99).json()["detail"]


@pytest.mark.parametrize(
    "written", ["1.15E+11", "1.15e%2B11", "%2B1.15e11", "115000000000", "115e9"]
)
def test_number_of_a_spreadsheet_is_accepted(client: Client, written: str) -> None:
    plain = {name: value for name, value in NORMAL.items() if name != "e_star"}
    response = client.get(f"{at('normal', plain)}&e_star={written}")
    assert response.content == client.get(at("normal", NORMAL)).content


@pytest.mark.parametrize("query", PARAMETERS)
def test_documented_parameters_have_a_result(client: Client, query: str) -> None:
    get = DOCUMENT["paths"][at(query)]["get"]
    shown = {each["name"]: each["example"] for each in get["parameters"] if "example" in each}
    assert shown == EXAMPLES["parameters"][query]
    assert client.get(at(query, shown)).status_code == 200


@pytest.mark.parametrize("query", PARAMETERS)
def test_every_parameter_is_documented(query: str) -> None:
    get = DOCUMENT["paths"][at(query)]["get"]
    names = [each["name"] for each in get["parameters"]]
    assert sorted(names) == sorted(PARAMETERS[query].model_fields)
    assert all(each["in"] == "query" and each["description"] for each in get["parameters"])
    for each in get["parameters"]:
        if {"type": "number"} in each["schema"].get("anyOf", ()):
            assert re.search(r"\[([a-z0-9/*^()-]+|as the mean)\]$", each["description"])
        # Swagger UI compares a parameter of the one type number with a pattern without exponents.
        assert each["schema"].get("type") not in {"number", "integer"}


def test_response_may_be_cached_and_a_problem_may_not(client: Client) -> None:
    assert client.get("/v1/normal").headers["cache-control"] == "no-store"
    response = client.get(at("normal", NORMAL))
    assert response.headers["cache-control"] == "max-age=3600"
    assert "accept" in response.headers["vary"].lower()


def test_head_has_the_headers_of_get(client: Client) -> None:
    get, head = (client.request(method, at("normal", NORMAL)) for method in ("GET", "HEAD"))
    assert head.status_code == 200
    assert head.headers["cache-control"] == get.headers["cache-control"]


def test_problem_without_pointers_has_none_for_parameters() -> None:
    given = PARAMETERS["normal"].model_validate({"kind": "cone"})
    with pytest.raises(problems.ServiceError) as raised, given.pointing():
        raise problems.INTERNAL_ERROR
    assert not raised.value.errors


def test_problem_of_parameters_pickles() -> None:
    given = PARAMETERS["normal"].model_validate({"kind": "cone", "normal_force": "1"})
    with pytest.raises(problems.ServiceError) as raised, given.pointing():
        given.query()
    copy = pickle.loads(pickle.dumps(raised.value))  # noqa: S301
    assert raised.value.errors
    assert vars(copy) == vars(raised.value)


NAMES = sorted({name for model in PARAMETERS.values() for name in model.fields})
ENDS = [f"{name}{end}" for name in NAMES for end in ("_from", "_to")]
TEXTS = (
    st.text(max_size=8)
    | st.floats().map(repr)
    | st.integers(-3, 40).map(str)
    | st.sampled_from(["log", "linear", "pressure", "pressure,slip", "csv", "npz", "cone", ""])
)
QUERY_STRINGS = st.builds(
    lambda right, others: right | others,
    st.sampled_from([{}, NORMAL, *(same["parameters"] for same in SAME.values())]),
    st.dictionaries(st.sampled_from([*NAMES, *ENDS, "n", "scale", "format"]), TEXTS, max_size=3),
)


@settings(
    max_examples=300,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(query=st.sampled_from(list(PARAMETERS)), parameters=QUERY_STRINGS)
def test_random_parameters_have_a_result_or_a_pointer(
    client: Client, query: str, parameters: dict[str, object]
) -> None:
    response = client.get(at(query, parameters))
    assert response.status_code in {200, 406, 422}
    if response.status_code == 422:
        document = strict_json.loads(response.content)
        assert isinstance(document, dict)
        known = PARAMETERS[query].fields
        pointers = [error["pointer"].removeprefix("/") for error in document["errors"]]
        assert pointers
        assert {*pointers} <= {*parameters, *known, *ENDS, "n"}


@pytest.mark.parametrize(
    "query_string", ["%", "%ff=%ff", "=", "&&", "a", "%00=1", "kind=%F0%9F%98%80", "kind", "?", "#"]
)
def test_random_query_string_never_causes_an_internal_error(
    client: Client, query_string: str
) -> None:
    assert client.get(f"/v1/normal?{query_string}").status_code == 422
