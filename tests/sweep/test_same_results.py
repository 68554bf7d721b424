"""Every row of a sweep is bit-identical to the response of the service."""

import math
from random import Random
from typing import Any

import pytest

from mdr_service.queries import QUERIES
from mdr_service.queries.contacts import solve_tangential
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.flat import flat, nested
from mdr_sweep import vectorized
from mdr_sweep.spec import Spec
from tests.conftest import Client
from tests.sweep.cases import KINDS, Row, random_cases, served, swept, table


@pytest.mark.every(7)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("query", ["normal", "tangential"])
def test_rows_of_every_kind_equal_the_responses(client: Client, query: str, kind: str) -> None:
    rows = random_cases(kind, query, 200)
    assert swept(query, rows) == [served(client, query, row) for row in rows]


@pytest.mark.parametrize("kind", KINDS)
def test_random_rows_of_limiting_wear_equal_the_responses(client: Client, kind: str) -> None:
    rows = random_cases(kind, "wear", 12)
    assert swept("wear", rows) == [served(client, "wear", row) for row in rows]


def test_table_of_all_kinds_equals_the_responses(client: Client) -> None:
    rows = [row for kind in KINDS for row in random_cases(kind, "tangential", 12, seed=1)]
    Random(3).shuffle(rows)
    assert swept("tangential", rows) == [served(client, "tangential", row) for row in rows]


def test_warnings_are_per_case_near_full_slip(client: Client) -> None:
    row: Row = {"profile.kind": "paraboloid", "profile.radius": 0.01, "material.e_star": 1e11}
    row |= {"material.g_star": 8e10, "friction_coefficient": 0.3, "load.normal_force": 10.0}
    ratios = [i / 400 for i in range(400)] + [1 - 10**-k for k in range(2, 12)]
    rows = [row | {"tangential.tangential_force": 3.0 * ratio} for ratio in ratios]
    Random(4).shuffle(rows)
    computed = swept("tangential", rows)
    assert computed == [served(client, "tangential", row) for row in rows]
    assert 0 < sum(each["warning"] is not None for each in computed) < 10


BALL: Row = {
    "profile.kind": "paraboloid",
    "profile.radius": 0.01,
    "friction_coefficient": 0.3,
    "material.e_star": 1e11,
    "material.g_star": 8e10,
    "material.shear_modulus": 4e10,
}
ON_BASE = {name: BALL[name] for name in ("profile.kind", "profile.radius", "material.e_star")}
ON_BASE |= {"load.normal_force": 10.0, "material.layer.base": "frictionless"}
FLANK: Row = {"profile.kind": "cone", "material.e_star": 1e11}
CURVE = flat(EXAMPLES["fit"]["hydrogel"]["value"])
LOOP = flat(EXAMPLES["tangential_fit"]["ball_on_glass"]["value"])


@pytest.mark.parametrize(
    ("query", "shared", "swept_field", "values"),
    [
        ("torsion", BALL | {"load.normal_force": 10.0}, "torsion.torque", [0.0, 1e-5, -9e-5, 1.0]),
        (
            "impact",
            BALL | {"normal_mass": 1.0, "tangential_mass": 0.3, "normal_velocity": 1.0},
            "tangential_velocity",
            [0.0, 0.3, -2.0],
        ),
        (
            "evolution",
            BALL
            | {
                "load.normal_force": 10.0,
                "oscillation.tangential_force": 1.5,
                "wear_coefficient": 1e-12,
                "resolution": 8,
            },
            "cycles",
            [[0.0], [1e3, 1e4], [1e9]],
        ),
        ("fit", CURVE, "profile.radius", [4e3, 6e3, 0.0]),
        ("fit", CURVE | {"layer.base": "frictionless"}, "layer.thickness", [1e4, 1e3, 10.0]),
        ("tangential_fit", LOOP, "rig_compliance", [None, 0.0, -1.0]),
        ("normal", ON_BASE, "material.layer.thickness", [1e-2, 1e-4, 1e-9]),
        ("normal", FLANK | {"profile.half_angle": 70.3}, "load.normal_force", [1.0, 9.0, -1.0]),
        ("normal", FLANK | {"load.normal_force": 1.0}, "profile.half_angle", [70.3, 1.0, 95.0]),
    ],
)
def test_rows_of_other_queries_equal_the_responses(
    client: Client, query: str, shared: Row, swept_field: str, values: list[Any]
) -> None:
    rows = [shared | {swept_field: value} for value in values]
    assert swept(query, rows) == [served(client, query, row) for row in rows]


def test_adhesive_rows_equal_the_responses(client: Client) -> None:
    """Some rows have a work of adhesion, one of them a load below the pull-off."""
    row: Row = {"profile.kind": "paraboloid", "profile.radius": 1e-3, "material.e_star": 1e6}
    rows = [
        row | ({"material.work_of_adhesion": w} if w else {}) | {"load.normal_force": force}
        for w, force in [(0.05, -1e-4), (None, 1e-4), (0.1, 1e-4), (0.05, -1e-3), (0.2, 0.0)]
    ]
    assert swept("normal", rows) == [served(client, "normal", row) for row in rows]
    spec = Spec("normal", {}, ("pull_off_force",))
    forces = vectorized.solve(spec, table(rows)).column("pull_off_force").to_pylist()
    expected = [-1.5 * math.pi * w * 1e-3 for w in (0.05, 0.1, 0.2)]
    assert [forces[0], forces[2], forces[4]] == pytest.approx(expected, rel=1e-12, abs=0)
    assert math.isnan(forces[1])
    assert forces[3] is None


@pytest.mark.parametrize("query", ["normal", "tangential"])
def test_data_error_of_a_table_is_that_of_the_response(client: Client, query: str) -> None:
    measured: Row = {"profile.kind": "tabulated", "profile.r": [0.0, 0.2, 0.5, 0.7, 1.0]}
    measured |= {"profile.f": [0.0, 0.021, 0.12, 0.25, 0.5]}
    row: Row = {"material.e_star": 1e6}
    if query == "tangential":
        row |= {"material.g_star": 8e5, "friction_coefficient": 0.3}
        row |= {"tangential.tangential_force": 1.0}
    shapes = measured, {"profile.kind": "sphere", "profile.radius": 1.0}
    rows = [shape | row | {"load.normal_force": force} for shape in shapes for force in (1e2, 1e4)]
    found = vectorized.solve(Spec(query, {}, ("data_error",)), table(rows)).column("data_error")
    both = measured | row | {"load.normal_force": [1e2, 1e4]}
    expected = client.post(f"/v1/{query}", nested(both)).json()["data_error"]
    assert found.to_pylist()[:2] == expected
    assert all(map(math.isnan, found.to_pylist()[2:]))


STEEL = {
    "material.bodies.0.youngs_modulus": 210e9,
    "material.bodies.0.poissons_ratio": 0.3,
    "material.yield_strength": 3e8,
    "material.body_thickness": 1e-3,
}
BODIES: list[Row] = [
    {"material.bodies.1": "rigid"},
    {"material.bodies.1.youngs_modulus": 70e9, "material.bodies.1.poissons_ratio": 0.33},
]


@pytest.mark.every(5)
@pytest.mark.parametrize("kind", ["paraboloid", "sphere", "cone", "rounded_punch", "power"])
def test_rows_with_a_yield_strength_equal_the_responses(client: Client, kind: str) -> None:
    rows = [
        {name: value for name, value in row.items() if not name.startswith("material.")}
        | STEEL
        | body
        for body in BODIES
        for row in random_cases(kind, "tangential", 8, seed=2)
    ]
    assert swept("tangential", rows) == [served(client, "tangential", row) for row in rows]


# Invalid values of fields, by error.
INVALID: dict[str, Row] = {
    "negative": {"profile.radius": -1.0},
    "nothing": {"material.e_star": 0.0},
    "not a number": {"load.normal_force": math.nan},
    "endless": {"friction_coefficient": math.inf},
    "too large": {"material.g_star": 1e51},
    "too small": {"load.normal_force": 1e-100},
    "unknown kind": {"profile.kind": "pyramid"},
    "missing": {"material.g_star": None},
    "two controls": {"load.indentation_depth": 1e-6},
    "no control": {"tangential.tangential_force": None},
    "no equilibrium": {"tangential.tangential_force": 1e6},
    "field of another kind": {"profile.slope": 0.1},
}


def with_invalid_rows(step: int, count: int) -> list[Row]:
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
    changes = list(INVALID.values())
    for i in range(0, count, step):
        rows[i] |= changes[(i // step) % len(changes)]
    return rows


def test_invalid_rows_leave_all_other_rows_unchanged(client: Client) -> None:
    count = 30 * len(INVALID)
    rows = with_invalid_rows(30, count)
    computed = swept("tangential", rows)
    assert sum(row["error"] is not None for row in computed) == len(INVALID)
    assert [row["error"] is None for row in computed] == [bool(i % 30) for i in range(count)]
    assert computed == [served(client, "tangential", row) for row in rows]


@pytest.mark.parametrize("invalid", INVALID)
def test_invalid_row_has_the_error_of_the_service(client: Client, invalid: str) -> None:
    row: dict[str, Any] = with_invalid_rows(2, 2)[1] | INVALID[invalid]
    (alone,) = swept("tangential", [row])
    assert alone["error"].startswith("/")
    assert alone == served(client, "tangential", row)


@pytest.mark.parametrize("rows", [1, 3, 5])
def test_table_without_a_valid_row(client: Client, rows: int) -> None:
    invalid = [row | {"profile.radius": -1.0} for row in with_invalid_rows(9, rows)]
    assert swept("tangential", invalid) == [served(client, "tangential", row) for row in invalid]


@pytest.mark.parametrize("kind", ["paraboloid", "cone", "rounded_punch"])
def test_maxima_of_stresses_equal_those_of_the_core(kind: str) -> None:
    names = ("contact_radius", "maximum_pressure", "maximum_shear_stress")
    rows = random_cases(kind, "tangential", 12, seed=4)
    computed = vectorized.solve(Spec("tangential", {}, names), table(rows)).to_pylist()
    for row, result in zip(rows, computed, strict=True):
        if result["error"]:
            continue
        query: Any = QUERIES["tangential"].request.model_validate(nested(row))
        pushed = solve_tangential(query)
        expected = (
            float(pushed.normal.contact_radius),
            float(pushed.normal.maximum_pressure),
            float(pushed.maximum_shear_stress),
        )
        assert tuple(result[name] for name in names) == expected
