"""Queries on the event loop are short, and sizes have bounds."""

import json
from time import thread_time
from typing import Any

import numpy as np
import pytest

from mdr_core.errors import InputError
from mdr_service.dispatch import is_short, respond
from mdr_service.queries import QUERIES
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.serializers import FORMATS
from mdr_service.settings import SETTINGS
from tests.core.evaluations import PROFILES

BALL = EXAMPLES["normal"]["hertz"]["value"]
TANGENTIAL = EXAMPLES["tangential"]["cattaneo_mindlin"]["value"]
STRESS = EXAMPLES["stress"]["cattaneo_mindlin"]["value"]
SUBSURFACE = next(iter(EXAMPLES["subsurface"].values()))["value"]
WEAR = EXAMPLES["wear"]["held_force"]["value"]
EVOLUTION = EXAMPLES["evolution"]["shakedown"]["value"]
HISTORY = EXAMPLES["history"]["mindlin_deresiewicz"]["value"]
TERMS = {"kind": "series", "terms": [{"coefficient": 1.0, "exponent": 2.0}] * 100}
TABLE = EXAMPLES["normal"]["table"]["value"]["profile"]
POINTS = {"normal": {"normal_force": [8.0, 9.0]}, "tangential": {"tangential_force": [0.1, 0.2]}}
MIXED = POINTS | {"normal": {"indentation_depth": [1e-6, 2e-6]}}
PATH = {name: HISTORY[name] for name in ("profile", "material", "friction_coefficient")}
STRENGTH = {"material": STRESS["material"] | {"yield_strength": 1e9}}
# Time of a query on the event loop over that of the closed form of Hertz at 110 loads, which takes
# half a millisecond on a core of 2023: such a query delays the others by at most 15 ms there.
MOST_TIMES = 30.0


def query(name: str, value: dict[str, Any]) -> Query:
    return QUERIES[name].request.model_validate_json(json.dumps(value).encode())


@pytest.mark.parametrize(
    ("name", "value", "short"),
    [
        ("normal", BALL, True),
        ("normal", BALL | {"load": {"normal_force": [10.0] * 110}}, True),
        ("normal", BALL | {"load": {"normal_force": [10.0] * 111}}, False),
        ("normal", BALL | {"profile": TABLE}, False),
        ("normal", BALL | STRENGTH, False),
        ("tangential", TANGENTIAL, True),
        ("stress", STRESS | {"radius": [1e-5] * 360}, True),
        ("stress", STRESS | {"radius": [1e-5] * 370}, False),
        ("stress", STRESS | {"profile": TERMS, "radius": [1e-5] * 20}, False),
        ("history", PATH | {"history": POINTS}, True),
        ("history", PATH | {"history": POINTS | {"samples_per_step": 200}}, False),
        ("history", PATH | {"history": MIXED}, True),
        ("stress", PATH | {"history": MIXED, "radius": [0.0], "quantities": ["slip"]}, True),
        ("subsurface", SUBSURFACE, False),
        ("wear", WEAR, True),
        ("evolution", EVOLUTION, False),
    ],
)
def test_short_queries_run_on_the_event_loop(
    name: str,
    value: dict[str, Any],
    short: bool,  # noqa: FBT001 -- of a table of cases
) -> None:
    assert is_short(query(name, value)) == short


def processor_time(name: str, given: Query) -> float:
    start = thread_time()
    respond(name, given, FORMATS["json"])
    return thread_time() - start


@pytest.mark.long
@pytest.mark.alone
@pytest.mark.parametrize("kind", sorted(PROFILES.keys() - {"tabulated"}))
def test_a_short_query_takes_little_more_than_closed_forms(kind: str) -> None:
    # A series and two spheres are short up to fewer loads.
    share = {"series": len(PROFILES["series"]["terms"]), "two_spheres": 2}.get(kind, 1)
    part = {"profile": {"kind": kind, **PROFILES[kind]}, "material": {"e_star": 1.0, "g_star": 0.9}}
    rubbed = part | {"friction_coefficient": 0.3, "tangential": {"tangential_displacement": 1e-9}}
    path = {
        "normal": {"normal_force": [8e-3, 9e-3]},
        "tangential": {"tangential_force": [0.0, 1e-3]},
        "samples_per_step": 55 // share,
    }
    load = {"load": {"normal_force": np.linspace(0.01, 0.02, 110 // share).tolist()}}
    radii = {"radius": np.linspace(0.0, 1.0, 540 // share).tolist()}
    amplitude = {"tangential_force": np.linspace(1e-4, 5e-3, 110 // share).tolist()}
    rubbing = {"friction_coefficient": 0.3, "oscillation": amplitude}
    hertz = query("normal", BALL | {"load": {"normal_force": np.linspace(5.0, 10.0, 110).tolist()}})
    for name, value in (
        ("normal", part | load),
        ("tangential", rubbed | load),
        (
            "stress",
            rubbed | {"load": {"normal_force": 0.02}, "quantities": ["pressure", "slip"]} | radii,
        ),
        ("history", part | {"friction_coefficient": 0.3, "history": path}),
        ("wear", part | rubbing | {"load": {"normal_force": 0.02}}),
    ):
        given = query(name, value)
        assert is_short(given)
        rounds = [(processor_time(name, given), processor_time("normal", hertz)) for _ in range(7)]
        times, closed = (min(each) for each in zip(*rounds, strict=True))
        assert times < MOST_TIMES * closed, name


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
