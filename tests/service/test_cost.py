"""Estimated computing time: order of magnitude, growth with the sizes, and rejection."""

import json
from statistics import median
from time import thread_time
from typing import Any

import numpy as np
import pytest

from mdr_core.errors import InputError
from mdr_service import cost
from mdr_service.dispatch import respond
from mdr_service.problems import ServiceError
from mdr_service.queries import QUERIES
from mdr_service.schemas.batch import BatchQuery
from mdr_service.schemas.contacts import NormalQuery, Query
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.serializers import FORMATS
from mdr_service.settings import SETTINGS
from tests.conftest import Client

JSON = FORMATS["json"]
CASES = [(name, example["value"]) for name in QUERIES for example in EXAMPLES[name].values()]
BALL = EXAMPLES["normal"]["hertz"]["value"]
STRESS = EXAMPLES["stress"]["cattaneo_mindlin"]["value"]
WEAR = EXAMPLES["wear"]["held_force"]["value"]
EVOLUTION = EXAMPLES["evolution"]["shakedown"]["value"]
HISTORY = EXAMPLES["history"]["mindlin_deresiewicz"]["value"]
TABLE = EXAMPLES["normal"]["table"]["value"]["profile"]
SERIES = {
    "kind": "series",
    "terms": [{"coefficient": 10.0 ** (2 * n - 2), "exponent": n} for n in range(1, 20)],
}


def query(name: str, value: dict[str, Any]) -> Query:
    return SCHEMAS[name].model.model_validate_json(json.dumps(value).encode())


@pytest.mark.long
@pytest.mark.alone
def test_no_example_takes_far_longer_than_its_estimate() -> None:
    """Otherwise it would block the event loop. Relative to the median, which is the machine's."""
    cases = []
    for name, value in CASES:
        given = query(name, value)
        times = []
        # The first call imports modules.
        for _ in range(8):
            start = thread_time()
            respond(name, given, JSON)
            times.append(thread_time() - start)
        cases.append((name, min(times), cost.seconds(given)))
    machine = median(taken / estimated for _, taken, estimated in cases)
    slow = [
        (name, taken, estimated)
        for name, taken, estimated in cases
        if taken >= 4 * machine * max(estimated, cost.AT_ONCE_SECONDS)
    ]
    assert slow == []


def test_each_field_adds_to_the_estimate() -> None:
    fields, one = (
        {**STRESS, "radius": [1e-5] * 10_000, "quantities": names}
        for names in (STRESS["quantities"], ["slip"])
    )
    assert cost.seconds(query("stress", fields)) > 1.1 * cost.seconds(query("stress", one))


@pytest.mark.parametrize(
    ("name", "value", "change"),
    [
        ("normal", BALL, {"load": {"normal_force": [10.0] * 1000}}),
        ("normal", BALL, {"profile": {"kind": "sphere", "radius": 0.01}}),
        ("normal", BALL, {"profile": SERIES}),
        ("normal", BALL, {"profile": TABLE}),
        ("stress", STRESS, {"radius": [1e-5] * 1000}),
        ("stress", STRESS, {"tangential": {"tangential_force": [2.0] * 1000}}),
        ("wear", WEAR, {"load": {"normal_force": [10.0] * 1000}}),
        ("evolution", EVOLUTION, {"resolution": 96}),
        ("evolution", EVOLUTION, {"cycles": [1e3 * n for n in range(1000)]}),
        ("history", HISTORY, {"cycles": {**HISTORY["cycles"], "count": 1000}}),
        ("history", HISTORY, {"cycles": {**HISTORY["cycles"], "samples_per_step": 1000}}),
    ],
)
def test_estimate_grows_with_the_size(
    name: str, value: dict[str, Any], change: dict[str, Any]
) -> None:
    assert cost.seconds(query(name, value | change)) > 1.1 * cost.seconds(query(name, value))


def test_nonlinear_steps_under_mixed_control_are_expensive() -> None:
    path = {"normal": {"indentation_depth": [1e-6, 2e-6]}}
    mixed = path | {"tangential": {"tangential_force": [0.1, 0.2]}}
    exact = path | {"tangential": {"tangential_displacement": [1e-8, 2e-8]}}
    rest = {key: value for key, value in HISTORY.items() if key != "cycles"}
    slow, fast = (cost.seconds(query("history", rest | {"history": p})) for p in (mixed, exact))
    assert slow - fast == pytest.approx(2 * 2.5e-3, rel=1e-9, abs=0)


def test_plots_are_drawn_in_a_compute_process() -> None:
    assert cost.require_feasible(query("normal", BALL), FORMATS["svg"]) > cost.AT_ONCE_SECONDS
    assert cost.require_feasible(query("normal", BALL), JSON) < cost.AT_ONCE_SECONDS


def test_fewer_computations_run_on_the_event_loop_the_more_requests_there_are() -> None:
    longest = [
        max(t for t in range(100, 10_000, 10) if cost.is_short(1e-6 * t, n))
        for n in (1, 2, 4, 1000)
    ]
    assert longest == [2000, 1000, 500, 500]


def test_batch_estimate_is_the_sum_of_its_queries() -> None:
    items = [{"ask": "normal", "request": BALL}, {"ask": "stress", "request": STRESS}]
    invalid = {"ask": "normal", "request": {}}
    batch = BatchQuery.model_validate({"queries": [*items, invalid]})
    expected = cost.seconds(query("normal", BALL)) + cost.seconds(query("stress", STRESS))
    expected += cost._INVALID
    assert cost.seconds(batch) == pytest.approx(expected, rel=1e-12, abs=0)


def mixed(steps: int) -> dict[str, Any]:
    """Return a history of many steps, in each of which both controls change nonlinearly."""
    rest = {key: value for key, value in HISTORY.items() if key != "cycles"}
    normal = {"indentation_depth": [1e-6, 2e-6] * (steps // 2)}
    return rest | {"history": {"normal": normal, "tangential": {"tangential_force": 0.1}}}


OVERSIZED = mixed(50_000)


def test_oversized_query_is_rejected_with_the_feasible_size(client: Client) -> None:
    with pytest.raises(ServiceError) as raised:
        cost.require_feasible(query("history", OVERSIZED), JSON)
    pointer, detail = raised.value.errors[0]
    assert pointer == "/history"
    fitting = int(detail.rpartition("about ")[2].split()[0])
    expected = cost.require_feasible(query("history", mixed(fitting)), JSON)
    assert expected == pytest.approx(SETTINGS.budget_seconds, rel=0.2, abs=0)
    response = client.post("/v1/tangential/history", OVERSIZED)
    assert response.status_code == 422
    assert response.json()["type"] == "urn:mdr:problem:too-costly"
    assert response.json()["errors"][0]["pointer"] == "/history"


def test_sizes_of_one_are_not_offered_for_reduction() -> None:
    path = {"history": OVERSIZED["history"], "friction_coefficient": 0.3}
    stress = {"profile": BALL["profile"], "material": STRESS["material"], **path}
    stress |= {"radius": [0.0], "quantities": ["pressure"]}
    with pytest.raises(ServiceError) as raised:
        cost.require_feasible(query("stress", stress), JSON)
    assert [pointer for pointer, _ in raised.value.errors] == ["/history"]


def test_oversized_query_of_a_batch_is_rejected_separately(client: Client) -> None:
    queries = [
        {"ask": "history", "request": OVERSIZED},
        {"ask": "normal", "request": BALL},
    ]
    first, second = client.post("/v1/batch", {"queries": queries}).json()["answers"]
    assert first["problem"]["type"] == "urn:mdr:problem:too-costly"
    assert second["status"] == 200


def test_every_number_of_a_response_counts() -> None:
    # A third quantity exceeds the limit, where loads times radii alone would not.
    most = SETTINGS.max_numbers
    loads, radii = 10, most // 20
    value = STRESS | {
        "load": {"normal_force": [10.0] * loads},
        "radius": [1e-5] * radii,
        "quantities": ["pressure", "slip", "shear_stress"],
    }
    with pytest.raises(InputError, match=f"must not exceed {most}"):
        QUERIES["stress"].solve(query("stress", value))


@pytest.mark.parametrize("control", ["normal_force", "contact_radius"])
def test_maximum_number_of_loads_on_a_smooth_table_is_accepted(control: str) -> None:
    """They take less than a second: the largest pressure is at the axis."""
    r = [i / 199 for i in range(200)]
    table = {"kind": "tabulated", "r": r, "f": [x * x / 2 for x in r]}
    loads = {control: [1e-3] * SETTINGS.max_loads}
    query = {"profile": table, "material": {"e_star": 1.0}, "load": loads}
    assert cost.require_feasible(NormalQuery.model_validate(query), "application/json") < 5.0


def test_history_under_a_query_beneath_the_surface_counts() -> None:
    """A path of thousands of nonlinear steps must not run on the event loop."""
    loads = np.linspace(1.0, 2.0, 200).tolist()
    path = {"normal": {"normal_force": loads}, "tangential": {"tangential_displacement": loads}}
    common = {
        "profile": {"kind": "sphere", "radius": 1.0},
        "material": {"e_star": 1.0, "g_star": 0.8, "poissons_ratio": 0.3},
        "friction_coefficient": 0.3,
        "history": path,
    }
    alone = cost.seconds(HistoryQuery.model_validate(common))
    beneath = cost.seconds(SubsurfaceQuery.model_validate(common | {"x": [0.0], "z": [0.1]}))
    assert beneath >= alone > 0.1
