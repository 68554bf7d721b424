"""Cache of resolved tables in a compute process: identical bytes and bounded memory."""

import json

import numpy as np
import pytest

from mdr_core.profiles import Tabulated
from mdr_service.dispatch import parse, respond
from mdr_service.queries import contacts
from mdr_service.schemas.profiles import TabulatedProfile
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.serializers import FORMATS
from mdr_service.table_cache import TableCache

R = np.linspace(0, 1e-3, 40)
BYTES = Tabulated(R, R**2).nbytes


def table(curvature: float = 1.0, **rest: object) -> TabulatedProfile:
    given = {"r": R.tolist(), "f": (curvature * R**2).tolist()} | rest
    return TabulatedProfile.model_validate({"kind": "tabulated"} | given)


@pytest.mark.parametrize("room", [BYTES, 10 * BYTES])
def test_table_is_resolved_once(room: int) -> None:
    cache = TableCache(room)
    assert cache.resolved(table()) is cache.resolved(table())
    assert cache.size == BYTES


@pytest.mark.parametrize(
    "other",
    [
        table(curvature=np.nextafter(1.0, 2.0)),
        table(interpolation="pchip"),
        table(breaks=[R[3]]),
        table(breaks=[R[4]]),
    ],
)
def test_different_table_is_resolved_separately(other: TabulatedProfile) -> None:
    cache = TableCache(10 * BYTES)
    assert cache.resolved(table()) is not cache.resolved(other)


def test_least_recently_used_table_is_evicted() -> None:
    cache = TableCache(int(2.5 * BYTES))
    first = cache.resolved(table(1.0))
    second = cache.resolved(table(2.0))
    assert cache.resolved(table(1.0)) is first
    cache.resolved(table(3.0))
    assert cache.size <= 2.5 * BYTES
    assert cache.resolved(table(1.0)) is first
    assert cache.resolved(table(2.0)) is not second


def test_oversized_table_is_not_cached() -> None:
    cache = TableCache(BYTES - 1)
    assert cache.resolved(table()) is not cache.resolved(table())
    assert cache.size == 0


@pytest.mark.parametrize("name", ["normal", "tangential", "stress", "wear"])
def test_cached_table_gives_identical_bytes(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
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
    query = parse(SCHEMAS[name].model, json.dumps(request).encode())
    kept = TableCache(10 * BYTES)
    monkeypatch.setattr(contacts, "TABLES", kept)
    first = respond(name, query, FORMATS["json"])
    (table_,) = kept._tables.values()
    second = respond(name, query, FORMATS["json"])
    assert [*kept._tables.values()] == [table_]
    monkeypatch.setattr(contacts, "TABLES", TableCache(0))
    assert first == second == respond(name, query, FORMATS["json"])
