"""Tables kept by a compute process: same bytes, bounded memory, counted lookups."""

import json
import re

import numpy as np
import pytest

from mdr_core.profiles import Tabulated
from mdr_service.content_negotiation import FORMATS
from mdr_service.dispatch import parse, respond
from mdr_service.queries import QUERIES, contacts
from mdr_service.schemas.profiles import TabulatedProfile
from mdr_service.table_cache import TableCache
from tests.conftest import Client

R = np.linspace(0, 1e-3, 40)
BYTES = Tabulated(R, R**2).nbytes


def table(curvature: float = 1.0, **rest: object) -> TabulatedProfile:
    given = {"r": R.tolist(), "f": (curvature * R**2).tolist()} | rest
    return TabulatedProfile.model_validate({"kind": "tabulated"} | given)


def test_a_table_is_resolved_once() -> None:
    cache = TableCache(10 * BYTES)
    assert cache.resolved(table()) is cache.resolved(table())
    assert cache.report() == (1, 1, BYTES)
    assert cache.report() == (0, 0, BYTES)


@pytest.mark.parametrize(
    "other",
    [
        table(curvature=np.nextafter(1.0, 2.0)),
        table(interpolation="pchip"),
        table(breaks=[R[3]]),
        table(breaks=[R[4]]),
    ],
)
def test_another_table_is_resolved_anew(other: TabulatedProfile) -> None:
    cache = TableCache(10 * BYTES)
    assert cache.resolved(table()) is not cache.resolved(other)
    assert cache.report()[:2] == (0, 2)


def test_the_table_used_longest_ago_goes_first_and_the_bound_holds() -> None:
    cache = TableCache(int(2.5 * BYTES))
    first = cache.resolved(table(1.0))
    cache.resolved(table(2.0))
    assert cache.resolved(table(1.0)) is first
    cache.resolved(table(3.0))
    assert cache.report().size <= 2.5 * BYTES
    assert cache.resolved(table(1.0)) is first
    cache.resolved(table(2.0))
    assert cache.report()[:2] == (1, 1)


def test_a_table_beyond_the_bound_is_not_kept() -> None:
    cache = TableCache(BYTES - 1)
    assert cache.resolved(table()) is not cache.resolved(table())
    assert cache.report() == (0, 2, 0)


@pytest.mark.parametrize("name", ["normal", "tangential", "stress", "wear"])
def test_a_kept_table_gives_the_same_bytes(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    request = {
        "profile": table().model_dump(),
        "material": {"e_star": 1e11, "g_star": 8e10},
        "load": {"normal_force": 2.0},
    }
    if name != "normal":
        request["friction_coefficient"] = 0.3
        sideways = "oscillation" if name == "wear" else "tangential"
        request[sideways] = {"tangential_force": 0.2}
    if name == "stress":
        request |= {"points": 20, "quantities": ["pressure", "shear_stress"]}
    query = parse(QUERIES[name].model, json.dumps(request).encode())
    kept = TableCache(10 * BYTES)
    monkeypatch.setattr(contacts, "TABLES", kept)
    first, second = (respond(name, query, FORMATS["json"]) for _ in range(2))
    assert kept.report().hits == 1
    monkeypatch.setattr(contacts, "TABLES", TableCache(0))
    assert first == second == respond(name, query, FORMATS["json"])


def counted(client: Client) -> list[float]:
    text = client.get("/metrics").text
    names = ('mdr_table_lookups_total{result="hit"}', 'mdr_table_lookups_total{result="miss"}')
    found = [re.search(rf"^{re.escape(name)} (.*)$", text, re.MULTILINE) for name in names]
    size = re.search(r"^mdr_table_bytes (.*)$", text, re.MULTILINE)
    return [float(each[1]) if each else 0.0 for each in (*found, size)]


def test_metrics_count_lookups_and_bytes(client: Client) -> None:
    # A curvature of its own, so that no other test has asked for this table.
    request = {"profile": table(1.2345).model_dump(), "material": {"e_star": 1e11}}
    before = counted(client)
    for _ in range(3):
        assert client.post("/v1/normal", request | {"load": {"normal_force": 2.0}}).is_success
    hits, misses, size = (b - a for a, b in zip(before, counted(client), strict=True))
    assert hits + misses == 3
    # Each of the compute processes resolves it once at most.
    assert 1 <= misses <= 2
    assert size == misses * BYTES
