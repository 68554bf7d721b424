"""A table would be fitted at every query, or a kept one would answer for another."""

import json

import numpy as np
import pytest
from prometheus_client import generate_latest

from mdr_service import observability
from mdr_service.dispatch import respond
from mdr_service.queries import contacts
from mdr_service.schemas.profiles import TabulatedProfile
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.serializers import FORMATS

R = np.linspace(0, 1e-3, 40)


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
        "material": {"e_star": 1e11, "g_star": 8e10},
        "load": {"normal_force": 2.0},
    }
    if name != "normal":
        request["friction_coefficient"] = 0.3
        member = "oscillation" if name == "wear" else "tangential"
        request[member] = {"tangential_force": 0.2}
    if name == "stress":
        request |= {"points": 20, "quantities": ["pressure", "shear_stress"]}
    query = SCHEMAS[name].model.model_validate_json(json.dumps(request).encode())
    contacts._tabulated.cache_clear()
    first = respond(name, query, FORMATS["json"])
    assert contacts._tabulated.cache_info().misses == 1
    assert respond(name, query, FORMATS["json"]) == first
    assert contacts._tabulated.cache_info().misses == 1


def test_few_tables_are_kept_and_counted_in_the_metrics() -> None:
    contacts._tabulated.cache_clear()
    for factor in range(20):
        contacts.profile(table(curvature=1.0 + factor))
    assert b"\nmdr_tables 16.0\n" in generate_latest(observability.REGISTRY)
