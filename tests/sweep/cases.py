"""Random cases of every kind of profile, as rows of a table and as requests to the service."""

import json
import math
from collections.abc import Mapping, Sequence
from random import Random
from typing import Any

import pyarrow as pa

from mdr_service.queries import QUERIES
from mdr_service.schemas.flat import nested
from mdr_sweep import vectorized
from mdr_sweep.spec import QUANTITIES, Spec
from tests.conftest import Client

Row = dict[str, Any]
PARAMETERS = {
    "flat_punch": {"radius": (-4, -1)},
    "cone": {"slope": (-3, 0)},
    "paraboloid": {"radius": (-3, 0)},
    "sphere": {"radius": (-3, 0)},
    "ellipsoid": {"radius": (-3, 0), "height": (-3, 0)},
    "power": {"coefficient": (-1, 3), "exponent": (-1, 1.2)},
    "rounded_punch": {"flat_radius": (-5, -2), "rounding_radius": (-3, 0)},
    "truncated_cone": {"flat_radius": (-5, -2), "slope": (-3, 0)},
    "truncated_paraboloid": {"flat_radius": (-5, -2), "radius": (-3, 0)},
    "rounded_cone": {"slope": (-3, 0), "tip_radius": (-4, 0)},
    "spherical_tip_cone": {"slope": (-3, 1), "tip_radius": (-4, 0)},
    "hyperboloid": {"slope": (-3, 1), "tip_radius": (-4, 0)},
    "capped_paraboloid": {"cap_radius": (-5, -2), "tip_radius": (-1, 1), "radius": (-3, -1)},
}
KINDS = (*PARAMETERS, "series", "tabulated")


def random_cases(kind: str, query: str, count: int, seed: int = 0) -> list[Row]:
    """Return cases with loads of every control, some of them zero or at full slip."""
    random = Random(f"{kind} {query} {seed}")
    return [_case(random, kind, query) for _ in range(count)]


def _case(random: Random, kind: str, query: str) -> Row:
    row = {"profile.kind": kind} | _profile(random, kind)
    e_star = _power(random, 6, 12)
    row |= {"material.e_star": e_star}
    depth = random.choice([_power(random, -9, -4)] * 9 + [0.0])
    control = random.choice(["indentation_depth", "normal_force", "contact_radius"])
    if query == "wear" and control == "contact_radius":
        control = "indentation_depth"
    size = {
        "indentation_depth": depth,
        "normal_force": e_star * depth * _power(random, -5, -2),
        "contact_radius": depth * _power(random, 1, 4),
    }
    row[f"load.{control}"] = size[control]
    if query == "normal":
        return row
    friction = _power(random, -2, 0.3)
    row |= {"material.g_star": e_star * random.uniform(0.5, 1.0), "friction_coefficient": friction}
    part = random.choice([random.uniform(0, 1.2)] * 9 + [0.0])
    if control == "normal_force":
        pushed = ("tangential_force", friction * size[control] * min(part, 1.0))
    else:
        pushed = ("tangential_displacement", friction * depth * part)
    if query == "tangential" and control == "contact_radius" and random.random() < 0.5:
        pushed = ("stick_radius", size[control] * part)
    sign = random.choice([1, -1]) if query == "tangential" and pushed[0] != "stick_radius" else 1
    group = "oscillation" if query == "wear" else "tangential"
    row[f"{group}.{pushed[0]}"] = sign * pushed[1]
    return row


def _profile(random: Random, kind: str) -> Row:
    if kind == "series":
        terms = sorted(random.sample([1.0, 1.5, 2.0, 3.0, 4.0], 2))
        return {
            f"profile.terms.{i}.{name}": value
            for i, exponent in enumerate(terms)
            for name, value in (("coefficient", _power(random, -1, 2)), ("exponent", exponent))
        }
    if kind == "tabulated":
        step, scale = _power(random, -5, -3), _power(random, -2, 1)
        return {
            "profile.r": [step * i for i in range(6)],
            "profile.f": [scale * step * i * i for i in range(6)],
        }
    computed = {f"profile.{name}": _power(random, *ends) for name, ends in PARAMETERS[kind].items()}
    if kind == "power" and random.random() < 0.5:
        computed["profile.exponent"] = random.choice([0.5, 1.0, 1.5, 2.0, 3.0])
    return computed


def _power(random: Random, low: float, high: float) -> float:
    return float(10 ** random.uniform(low, high))


def table(rows: Sequence[Mapping[str, Any]]) -> pa.RecordBatch:
    """Return the rows as a table; cells of absent fields are empty."""
    names = dict.fromkeys(name for row in rows for name in row)
    return pa.RecordBatch.from_pydict({name: [row.get(name) for row in rows] for name in names})


def swept(query: str, rows: Sequence[Mapping[str, Any]]) -> list[Row]:
    """Return the results of a sweep over the rows, without the columns of the input."""
    solved = vectorized.solve(Spec(query, {}, QUANTITIES[query]), table(rows))
    return solved.select([*QUANTITIES[query], "warning", "error"]).to_pylist()


def served(client: Client, query: str, row: Mapping[str, Any]) -> Row:
    """Return the response of the service to one row, as a row of a result."""
    body = json.dumps(nested({name: value for name, value in row.items() if value is not None}))
    response = client.post_text(QUERIES[query].path, body.encode())
    document = response.json()
    nothing: Row = dict.fromkeys(QUANTITIES[query])
    if response.status_code != 200:
        errors = [f"{each['pointer']} {each['detail']}" for each in document.get("errors", [])]
        return nothing | {"warning": None, "error": "; ".join(errors) or document["detail"]}
    codes = " ".join(dict.fromkeys(each["code"] for each in document["warnings"]))
    # What the service writes as null is infinite.
    answers = {
        name: math.inf if document[name][-1] is None else document[name][-1] for name in nothing
    }
    return answers | {"warning": codes or None, "error": None}
