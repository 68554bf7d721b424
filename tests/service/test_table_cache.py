"""A table is fitted once, and a fit in the cache is used for its own table only."""

import json

import numpy as np
import pytest

from mdr_core import profiles
from mdr_service.dispatch import respond
from mdr_service.queries import QUERIES, contacts
from mdr_service.schemas.profiles import TabulatedProfile
from mdr_service.serializers import FORMATS
from tests.conftest import Client

R = np.linspace(0, 1e-3, 40)
MODULI = {"e_star": 1e11, "g_star": 8e10}
LOAD = {"normal_force": 2.0}


def table(curvature: float = 1.0, **rest: object) -> TabulatedProfile:
    given = {"r": R.tolist(), "f": (curvature * R**2).tolist()} | rest
    return TabulatedProfile.model_validate({"kind": "tabulated"} | given)


def test_table_is_fitted_once() -> None:
    assert contacts.profile(table()) is contacts.profile(table())


@pytest.mark.parametrize(
    "other",
    [
        table(curvature=np.nextafter(1.0, 2.0)),
        table(uncertainty=1e-9),
        table(breaks=[R[3]]),
        table(breaks=[R[4]]),
    ],
)
def test_different_table_is_fitted_separately(other: TabulatedProfile) -> None:
    assert contacts.profile(table()) is not contacts.profile(other)


@pytest.mark.parametrize("name", ["normal", "tangential", "stress", "wear"])
def test_cached_table_gives_identical_bytes(name: str) -> None:
    request = {
        "profile": table().model_dump(),
        "material": MODULI,
        "load": LOAD,
    }
    if name != "normal":
        request["friction_coefficient"] = 0.3
        member = "oscillation" if name == "wear" else "tangential"
        request[member] = {"tangential_force": 0.2}
    if name == "stress":
        request |= {"points": 20, "quantities": ["pressure", "shear_stress"]}
    query = QUERIES[name].request.model_validate_json(json.dumps(request).encode())
    contacts._by_parameters.cache_clear()
    first = respond(name, query, FORMATS["json"])
    assert contacts._by_parameters.cache_info().misses == 1
    assert respond(name, query, FORMATS["json"]) == first
    assert contacts._by_parameters.cache_info().misses == 1


def test_table_is_fitted_in_a_compute_process(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(profiles, "Tabulated", never)
    request = {"profile": table(2.0).model_dump(), "material": MODULI, "load": LOAD}
    first = client.post("/v1/normal", request)
    assert first.status_code == 200
    assert client.post("/v1/normal", request).content == first.content


def test_batch_with_a_table_is_computed_in_a_compute_process(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(profiles, "Tabulated", never)
    short = {"kind": "tabulated", "r": [0.0, 1.0, 2.0, 3.0], "f": [0.0, 1.0, 4.0, 9.0]}
    request = {"profile": short, "material": MODULI, "load": LOAD}
    response = client.post("/v1/batch", {"queries": [{"ask": "normal", "request": request}]})
    assert [each["status"] for each in response.json()["answers"]] == [200]


def test_invalid_table_is_a_problem_of_its_field(client: Client) -> None:
    profile = {"kind": "tabulated", "r": [0.0, 1.0, 2.0, 3.0], "f": [0.0, -1.0, -4.0, -9.0]}
    response = client.post("/v1/normal", {"profile": profile, "material": MODULI, "load": LOAD})
    assert response.status_code == 422
    assert response.json()["errors"][0]["pointer"].startswith("/profile/")


def never(*_arguments: object, **_options: object) -> None:
    raise AssertionError("the event loop resolves it")


def test_tables_used_last_are_kept() -> None:
    tables = [table(curvature=1.0 + factor) for factor in range(40)]
    for each in tables:
        contacts.profile(each)
        # One that is used again stays.
        kept = contacts.profile(tables[0])
    assert contacts._by_parameters.cache_info().currsize == 32
    assert contacts.profile(tables[0]) is kept
