"""What an answer costs is known before any work is done; how well, `make costs` measures."""

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pytest

from mdr_core import profiles
from mdr_core.profiles import Profile, RoundedCone, Sphere, TruncatedCone
from mdr_service import cost, problems, sizes
from mdr_service.compute import AT_ONCE_SECONDS, COMPUTE
from mdr_service.questions import QUESTIONS, answer
from mdr_service.schemas import examples
from mdr_service.schemas.queries import FieldName
from mdr_service.settings import SETTINGS
from tests.conftest import Client

EXAMPLES: Mapping[str, Mapping[str, Any]] = {
    "normal": examples.NORMAL_EXAMPLES,
    "tangential": examples.TANGENTIAL_EXAMPLES,
    "history": examples.HISTORY_EXAMPLES,
    "stress": examples.STRESS_EXAMPLES,
    "wear": examples.WEAR_EXAMPLES,
    "evolution": examples.EVOLUTION_EXAMPLES,
}
PATHS = {
    "normal": "/v1/normal",
    "tangential": "/v1/tangential",
    "history": "/v1/tangential/history",
    "stress": "/v1/stress",
    "wear": "/v1/wear",
    "evolution": "/v1/wear/evolution",
}
MATERIAL = {"e_star": 1.0, "g_star": 0.8}
SPHERE = {"profile": {"kind": "sphere", "radius": 1.0}, "material": MATERIAL}
PRESSED = SPHERE | {"load": {"indentation_depth": 0.01}}
RUBBED = SPHERE | {"friction_coefficient": 0.3}
PUSHED = RUBBED | {"load": {"indentation_depth": 0.01}}
WORN = PUSHED | {
    "oscillation": {"tangential_displacement": 1e-4},
    "wear_coefficient": 1e-3,
    "cycles": [1.0],
}
MANY = [0.01] * 20_000


def table(count: int) -> dict[str, object]:
    r = [index / count for index in range(count)]
    return {"kind": "tabulated", "r": r, "f": [x * x for x in r]}


def seconds(question: str, query: object, media_type: str = "application/json") -> float:
    return cost.seconds(question, QUESTIONS[question].model.model_validate(query), media_type)


def asked() -> Iterator[tuple[str, object]]:
    for question, named in EXAMPLES.items():
        for example in named.values():
            yield question, example["value"]


@pytest.mark.parametrize(("question", "query"), list(asked()))
def test_every_example_in_every_form_has_a_cost(question: str, query: object) -> None:
    for media_type in QUESTIONS[question].media_types:
        assert 0 < seconds(question, query, media_type) < SETTINGS.budget_seconds / 4


@pytest.mark.parametrize("kind", profiles.KINDS)
def test_every_kind_has_every_rate_and_none_is_negative(kind: str) -> None:
    everything = {
        "kinked": kind == "tabulated",
        "nodes": 8,
        "radii": 1,
        "quantities": FieldName.__args__,
    }
    base = sizes.Sizes("normal", kind, "json", 10.0)._replace(**everything)
    names = {
        name
        for question, samples, curved in itertools.product(QUESTIONS, (0, 1), (0, 1))
        for name, _ in sizes.counts(
            base._replace(question=question, samples=samples, curved=curved)
        )
    }
    assert all(cost.RATES[kind][name] >= 0 for name in names)
    if kind in {"series", "tabulated"}:
        assert all(cost.RATES[kind][cost.PER_LENGTH + name] >= 0 for name in names)


@pytest.mark.parametrize(
    ("question", "few", "many"),
    [
        (
            "normal",
            SPHERE | {"load": {"indentation_depth": [0.01] * 10}},
            SPHERE | {"load": {"indentation_depth": MANY}},
        ),
        (
            "tangential",
            PUSHED | {"tangential": {"tangential_force": [0.0] * 10}},
            PUSHED | {"tangential": {"tangential_force": [0.0] * 1000}},
        ),
        (
            "stress",
            SPHERE
            | {"load": {"indentation_depth": 0.01}, "points": 10, "quantities": ["pressure"]},
            PRESSED | {"points": 50_000, "quantities": ["pressure"]},
        ),
        (
            "stress",
            SPHERE
            | {"load": {"indentation_depth": 0.01}, "points": 10, "quantities": ["pressure"]},
            PRESSED | {"points": 10, "quantities": ["pressure", "normal_displacement"]},
        ),
        (
            "history",
            RUBBED
            | {"cycles": {"normal": {"normal_force": 1}, "tangential": {"tangential_force": 0.1}}},
            RUBBED
            | {
                "cycles": {
                    "normal": {"normal_force": 1},
                    "tangential": {"tangential_force": 0.1},
                    "count": 1000,
                }
            },
        ),
        (
            "history",
            RUBBED
            | {
                "cycles": {
                    "normal": {"normal_force": 1, "amplitude": 0.1},
                    "tangential": {"tangential_displacement": 1e-3},
                },
                "rtol": 1e-4,
            },
            RUBBED
            | {
                "cycles": {
                    "normal": {"normal_force": 1, "amplitude": 0.1},
                    "tangential": {"tangential_displacement": 1e-3},
                },
                "rtol": 1e-8,
            },
        ),
        ("evolution", WORN | {"resolution": 8}, WORN | {"resolution": 96}),
        ("evolution", WORN | {"rtol": 1e-4}, WORN | {"rtol": 1e-10}),
        ("evolution", WORN, WORN | {"cycles": [1.0] * 1000}),
        (
            "normal",
            {"profile": table(10), "material": MATERIAL, "load": {"indentation_depth": 0.01}},
            {"profile": table(2000), "material": MATERIAL, "load": {"indentation_depth": 0.01}},
        ),
    ],
)
def test_more_costs_more(question: str, few: object, many: object) -> None:
    assert seconds(question, few) < seconds(question, many)


def test_the_usual_question_is_answered_at_once() -> None:
    for name, example in examples.NORMAL_EXAMPLES.items():
        if name != "table":
            assert seconds("normal", example["value"]) < AT_ONCE_SECONDS


@pytest.mark.parametrize(
    ("question", "query", "places"),
    [
        (
            "tangential",
            PUSHED
            | {"load": {"indentation_depth": MANY * 5}, "tangential": {"stick_radius": 0.05}},
            ["/load"],
        ),
        (
            "stress",
            SPHERE
            | {
                "load": {"indentation_depth": MANY[:10]},
                "points": SETTINGS.max_radii,
                "quantities": ["normal_displacement"],
            },
            ["/load", "/points"],
        ),
        (
            "history",
            RUBBED
            | {
                "cycles": {
                    "normal": {"normal_force": 0.01, "amplitude": 0.001},
                    "tangential": {"tangential_displacement": 1e-3},
                    "count": 20_000,
                }
            },
            ["/cycles"],
        ),
        (
            "evolution",
            WORN | {"cycles": [1.0] * 50_000, "resolution": 96},
            ["/cycles", "/resolution"],
        ),
    ],
)
def test_what_takes_too_long_is_refused_with_what_would_not(
    client: Client,
    question: str,
    query: dict[str, Any],
    places: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # A machine of any speed: whether these fit is up to this number alone.
    model = QUESTIONS[question].model.model_validate(query)
    asked = cost.seconds(question, model, "application/json")
    monkeypatch.setattr(COMPUTE, "slowness", COMPUTE.most_seconds * COMPUTE.slowness / asked * 4)
    answer = client.post(PATHS[question], query)
    assert answer.status_code == 422
    document = answer.json()
    assert document["type"] == problems.TOO_COSTLY.type
    assert len(answer.content) < 4096
    found = sizes.of(question, model, "application/json")
    for error in document["errors"]:
        number, what = error["detail"].split(maxsplit=1)
        field = {"radii would fit": "radii", "nodes would fit": "nodes"}.get(what, "loads")
        field = "samples" if what == "samples would fit" else field
        ratio = int(number) / getattr(found, field)
        part = ratio if found.samples else 1
        fitting = found._replace(
            **{field: int(number)},
            curved=int(found.curved * part),
            forced=int(found.forced * part),
            inverted=int(found.inverted * (ratio if field == "loads" else 1)),
        )
        assert cost.estimated(fitting) <= COMPUTE.most_seconds
    assert {error["pointer"] for error in document["errors"]} <= set(places)
    assert document["errors"] or question == "evolution"


def test_costs_of_a_batch_add_up(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    query = {"ask": "normal", "request": examples.NORMAL_EXAMPLES["hertz"]["value"]}
    each = seconds("normal", query["request"])
    monkeypatch.setattr(COMPUTE, "slowness", COMPUTE.most_seconds * COMPUTE.slowness / (3.5 * each))
    assert client.post("/v1/batch", {"queries": [query] * 3}).status_code == 200
    answer = client.post("/v1/batch", {"queries": [query] * 4})
    assert answer.status_code == 422
    assert answer.json()["type"] == problems.TOO_COSTLY.type
    assert answer.json()["errors"] == [
        {"pointer": "/queries/3", "detail": "the first 3 queries would fit"}
    ]


def test_what_is_too_costly_in_a_batch_is_so_alone(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = examples.NORMAL_EXAMPLES["hertz"]["value"]
    large = SPHERE | {"load": {"indentation_depth": MANY}}
    monkeypatch.setattr(
        COMPUTE, "slowness", COMPUTE.most_seconds * COMPUTE.slowness / seconds("normal", large) * 2
    )
    queries = [{"ask": "normal", "request": each} for each in (small, large, small)]
    answer = client.post("/v1/batch", {"queries": queries})
    found = answer.json()["answers"]
    assert [each["status"] for each in found] == [200, 422, 200]
    assert found[1]["problem"] == client.post("/v1/normal", large).json()


def test_an_answer_of_a_million_numbers_fits() -> None:
    query = SPHERE | {
        "load": {"indentation_depth": [0.01] * 10},
        "points": 100_000,
        "quantities": ["pressure"],
    }
    assert seconds("stress", query) < SETTINGS.budget_seconds / 2


SHAPES: Mapping[str, Mapping[str, float]] = {
    "sphere": {"radius": 10.0},
    "rounded_cone": {"slope": 0.1, "tip_radius": 3.0},
    "truncated_cone": {"flat_radius": 0.3, "slope": 0.1},
}


def curved_way(legs: int, samples: int) -> dict[str, Any]:
    """A normal force and a displacement, up and down, never twice the same."""
    force = [1.0 + 0.3 * (-1) ** leg + 0.001 * leg for leg in range(legs)]
    shift = [1e-3 * (-1) ** (leg // 2) * (1 + 0.01 * leg) for leg in range(legs)]
    return {
        "normal": {"normal_force": force},
        "tangential": {"tangential_displacement": shift},
        "samples_per_step": samples,
    }


@pytest.mark.parametrize("kind", [Sphere, RoundedCone, TruncatedCone], ids=lambda kind: kind.kind)
def test_what_arcs_cost_grows_as_what_is_evaluated(
    kind: type[Profile], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Counted, not timed: an evaluation costs what the call does, and a little for each place."""
    plain, count = kind.depth, [0.0]

    def depth(self: Profile, s: Any) -> Any:
        count[0] += 1 + np.size(s) / 200
        return plain(self, s)

    monkeypatch.setattr(kind, "depth", depth)
    profile = {"kind": kind.kind, **SHAPES[kind.kind]}
    ratios = []
    for legs, samples, rtol in itertools.product((2, 10, 50, 200), (1, 4), (1e-4, 1e-10)):
        way = curved_way(legs, samples)
        query = {**RUBBED, "profile": profile, "history": way, "rtol": rtol}
        model = QUESTIONS["history"].model.model_validate(query)
        count[0] = 0.0
        answer("history", model, "application/json")
        ratios.append(cost.seconds("history", model, "application/json") / count[0])
    assert max(ratios) <= 16 * min(ratios), ratios
