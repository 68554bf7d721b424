"""Every row of a sweep is answered like the service answers it alone, to the last bit."""

import math
from random import Random
from typing import Any

import pytest

from mdr_core import fields
from mdr_service import solve
from mdr_sweep import chunk, single
from mdr_sweep.study import Study
from tests.conftest import Client
from tests.sweep.scenes import KINDS, Row, scenes, served, swept, table


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("query", ["normal", "tangential"])
def test_two_hundred_random_rows_of_every_kind(client: Client, query: str, kind: str) -> None:
    rows = scenes(kind, query, 200)
    assert swept(query, rows) == [served(client, query, row) for row in rows]


@pytest.mark.parametrize("kind", KINDS)
def test_random_rows_of_limiting_wear(client: Client, kind: str) -> None:
    rows = scenes(kind, "wear", 12)
    assert swept("wear", rows) == [served(client, "wear", row) for row in rows]


def test_rows_of_all_kinds_in_one_table(client: Client) -> None:
    rows = [row for kind in KINDS for row in scenes(kind, "tangential", 12, seed=1)]
    Random(3).shuffle(rows)
    assert swept("tangential", rows) == [served(client, "tangential", row) for row in rows]


STEEL = {
    "material.bodies.0.youngs_modulus": 210e9,
    "material.bodies.0.poissons_ratio": 0.3,
    "material.yield_strength": 3e8,
}
BODIES: list[Row] = [
    {"material.bodies.1": "rigid"},
    {"material.bodies.1.youngs_modulus": 70e9, "material.bodies.1.poissons_ratio": 0.33},
]


@pytest.mark.parametrize("kind", ["paraboloid", "sphere", "cone", "rounded_punch", "power"])
def test_rows_of_bodies_that_may_yield(client: Client, kind: str) -> None:
    rows = [
        {name: value for name, value in row.items() if not name.startswith("material.")}
        | STEEL
        | body
        for body in BODIES
        for row in scenes(kind, "tangential", 25, seed=2)
    ]
    assert swept("tangential", rows) == [served(client, "tangential", row) for row in rows]


# Ten sorts of wrong rows, and some more.
WRONG: dict[str, Row] = {
    "negative": {"profile.radius": -1.0},
    "nothing": {"material.e_star": 0.0},
    "no number": {"load.normal_force": math.nan},
    "endless": {"friction_coefficient": math.inf},
    "too large": {"material.g_star": 1e31},
    "next to nothing": {"load.normal_force": 1e-100},
    "no such kind": {"profile.kind": "pyramid"},
    "left out": {"material.g_star": None},
    "two controls": {"load.indentation_depth": 1e-6},
    "no control": {"tangential.tangential_force": None},
    "no equilibrium": {"tangential.tangential_force": 1e6},
    "of another kind": {"profile.slope": 0.1},
    "unknown field": {"load.pressure": 1.0},
}


def with_wrong_rows(every: int, count: int) -> list[Row]:
    rows: list[Row] = [
        {
            "profile.kind": "paraboloid",
            "profile.radius": 0.01 + i * 1e-6,
            "material.e_star": 1e11,
            "material.g_star": 8e10,
            "load.normal_force": 10.0,
            "friction_coefficient": 0.3,
            "tangential.tangential_force": 1.0 + i / count,
        }
        for i in range(count)
    ]
    sorts = list(WRONG.values())
    for i in range(0, count, every):
        rows[i] |= sorts[(i // every) % len(sorts)]
    return rows


def test_one_row_in_a_hundred_is_wrong_in_many_ways(client: Client) -> None:
    count = 100 * len(WRONG)
    rows = with_wrong_rows(100, count)
    found = swept("tangential", rows)
    assert sum(row["error"] is not None for row in found) == len(WRONG)
    assert [row["error"] is None for row in found] == [bool(i % 100) for i in range(count)]
    assert found == [served(client, "tangential", row) for row in rows]


@pytest.mark.parametrize("sort", WRONG)
def test_a_wrong_row_says_what_is_wrong(client: Client, sort: str) -> None:
    row: dict[str, Any] = with_wrong_rows(2, 2)[1] | WRONG[sort]
    (alone,) = swept("tangential", [row])
    assert alone["error"].startswith("/")
    assert alone == served(client, "tangential", row)


@pytest.mark.parametrize("rows", [1, 3, 5])
def test_a_table_in_which_all_is_wrong(client: Client, rows: int) -> None:
    wrong = [row | {"profile.radius": -1.0} for row in with_wrong_rows(9, rows)]
    assert swept("tangential", wrong) == [served(client, "tangential", row) for row in wrong]


@pytest.mark.parametrize("kind", ["paraboloid", "cone", "rounded_punch"])
def test_largest_stresses_are_those_of_the_fields(kind: str) -> None:
    names = ("contact_radius", "maximum_pressure", "maximum_shear_stress")
    rows = scenes(kind, "tangential", 12, seed=4)
    found = chunk.answer(Study("tangential", {}, names), table(rows)).to_pylist()
    for row, told in zip(rows, found, strict=True):
        if told["error"]:
            continue
        query: Any = single.read("tangential", row)
        pushed = solve.tangential(query)
        expected = (
            float(pushed.normal.contact_radius),
            float(fields.largest_pressure(pushed.normal)),
            float(fields.largest_shear_stress(pushed)),
        )
        assert tuple(told[name] for name in names) == expected
