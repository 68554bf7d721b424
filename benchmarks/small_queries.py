"""Requests per second of small queries of every kind of profile, against a bare endpoint.

The bare endpoint takes the same body by a model of its own, which looks no further than the names
of its members, and returns a constant; for `/v1/stress` it validates the body as the service does
and writes arrays of the answer's size. Both are asked in turn, by a client that sends one request
after the other; the last column is the ratio with four connections at once. A table is asked for
the first time in every request, or again and again.

`python small_queries.py [KIND ...]` prints the rows of some kinds; `ratios.py` has all of them.
"""

from __future__ import annotations

import itertools
import json
import sys
from contextlib import ExitStack
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import measure
import numpy as np
import wire_ratio

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.core.evaluations import PROFILES

from mdr_service.dispatch import respond
from mdr_service.queries import QUERIES
from mdr_service.schemas.contacts import NormalQuery
from mdr_service.serializers import JSON

if TYPE_CHECKING:
    from collections.abc import Iterator

RADII, LOAD_STEPS, POINTS, END = 1000, 10, 200, 1.25
# Short rounds in turn: the speed of a virtual machine changes within a second. After a pause the
# first requests take up to twice as long, on either server, and longer if they run more code.
SECONDS, WARM_UP = 0.1, 0.05
# Rounds with one connection, and with several.
ROUNDS, CROWDED_ROUNDS = 13, 5
FRICTION, SHARE = 0.3, 0.6
PATHS = ("tangential/history", "cycle")
CLOSED = ("paraboloid", "cone", "flat_punch")
AGAIN, FIRST = "the same table", "a new table"
# Lower bounds of the ratio: of closed kinds, of the others, of the same table, of new tables, which
# are computed in another process.
TARGETS = {
    "stress": (0.45, 0.12, 0.08, 0.02),
    "tangential": (0.4, 0.15, 0.15, 0.01),
    "normal": (0.7, 0.3, 0.15, 0.01),
    "wear": (0.25, 0.1, 0.08, 0.01),
    "tangential/history": (0.25, 0.1, 0.08, 0.01),
    "cycle": (0.25, 0.1, 0.08, 0.01),
}
# Upper bounds of the processor time of a query without HTTP, over that of reading and writing its
# text by the standard library. A third of the time of a closed form goes to warnings, errors of the
# model and thresholds.
IN_PROCESS = {
    "stress": (2, 7, 20, 80),
    "tangential": (30, 65, 10, 100),
    "normal": (20, 40, 5, 100),
    "wear": (65, 210, 20, 100),
    "tangential/history": (45, 130, 25, 100),
    "cycle": (65, 155, 20, 100),
}
# The socket of the benchmark is deep: its largest pressure is searched, in six times the time of
# the whole query of a ball.
SEARCHED = 8
# Calls of each query in process, of which the fastest counts.
CALLS = 4


def kinds() -> list[str]:
    """Every kind of profile; a table as the same one and as new ones."""
    return [*(kind for kind in PROFILES if kind != "tabulated"), AGAIN, FIRST]


def profile(kind: str) -> dict[str, Any]:
    """The profile in a request."""
    if kind not in {AGAIN, FIRST}:
        return {"kind": kind, **PROFILES[kind]}
    r = np.linspace(0.0, END, POINTS)
    return {"kind": "tabulated", "r": r.tolist(), "f": (r * r / 4).tolist()}


def bodies(kind: str, query: str) -> Iterator[str]:
    """Bodies of one request after the other; of new tables each ends at a radius of its own."""
    body = json.dumps(requests(kind)[query])
    if kind != FIRST:
        yield from itertools.repeat(body)
    head, tail = body.split(f", {END}]", 1)
    for number in itertools.count(1):
        yield f"{head}, {END + number * 1e-9!r}]{tail}"


def requests(kind: str) -> dict[str, dict[str, Any]]:
    """A small request of each query, at a contact radius of 1 under 0.6 of the limiting force."""
    part = {"profile": profile(kind), "material": {"e_star": 1.0, "g_star": 0.9}}
    load = {"indentation_depth": 0.05} if kind == "flat_punch" else {"contact_radius": 1.0}
    normal = QUERIES["normal"]
    found = normal.solve(NormalQuery.model_validate_json(json.dumps({**part, "load": load})))
    force = float(found.normal_force)
    limit, held = FRICTION * force, {**part, "load": {"normal_force": force}}
    rubbed = {**held, "friction_coefficient": FRICTION}
    # Steps of the golden ratio: turning points of all sizes.
    steps = [limit * (0.1 + 0.618 * i % 1 * 0.8) * (-1) ** i for i in range(LOAD_STEPS)]

    def path(forces: list[float]) -> dict[str, Any]:
        history = {
            "normal": {"normal_force": [force] * len(forces)},
            "tangential": {"tangential_force": forces},
        }
        return {**part, "friction_coefficient": FRICTION, "history": history}

    return {
        "stress": {
            **rubbed,
            "tangential": {"tangential_force": SHARE * limit},
            "radius": (np.arange(RADII) / RADII).tolist(),
            "quantities": ["pressure", "shear_stress"],
        },
        "tangential": {**rubbed, "tangential": {"tangential_force": SHARE * limit}},
        "normal": held,
        "wear": {**rubbed, "oscillation": {"tangential_force": SHARE * limit}},
        "tangential/history": path(steps),
        "cycle": path([SHARE * limit, -SHARE * limit, SHARE * limit]),
    }


def rows(chosen: list[str] | None = None) -> list[measure.Row]:
    """The ratios of every query and kind.

    Each round asks all of them, so that a slow phase of the machine moves a few rounds of every
    row and not all rounds of a few rows.
    """
    with ExitStack() as stack:
        service = [sys.executable, "-m", "mdr_command", "serve", "--port"]
        bare = [sys.executable, str(Path(__file__).with_name("bare_endpoint.py"))]
        ours, theirs = (
            stack.enter_context(wire_ratio.server(command)) for command in (service, bare)
        )
        cases = [Case(kind, query, ours, theirs) for kind in chosen or kinds() for query in TARGETS]
        for number in range(ROUNDS):
            for case in cases:
                case.measure(crowded=number < CROWDED_ROUNDS)
    return [case.row() for case in cases]


def bound(bounds: dict[str, tuple[float, ...]], query: str, kind: str) -> float:
    """The bound for the kind's class."""
    size = bounds[query][{AGAIN: 2, FIRST: 3}.get(kind, 0 if kind in CLOSED else 1)]
    more = SEARCHED if kind == "two_spheres" else 1
    return size * more if bounds is IN_PROCESS else size / more


def in_process() -> list[measure.Row]:
    """The processor time of every query and kind, without HTTP."""
    return [_in_process(kind, query) for kind in kinds() for query in TARGETS]


def _in_process(kind: str, query: str) -> measure.Row:
    texts, name = bodies(kind, query), "history" if query in PATHS else query

    def ours() -> bytes:
        return respond(name, next(texts).encode(), JSON)

    def bare() -> str:
        return json.dumps(json.loads(next(texts)))

    rounds = [
        (measure.fastest(ours, CALLS), measure.fastest(bare, CALLS))
        for _ in range(measure.count(measure.ROUNDS))
    ]
    target = f"<= {bound(IN_PROCESS, query, kind)}"
    return measure.row(f"{query}, {kind}, without HTTP / its JSON", "fastest", rounds, target)


class Case:
    """Rates of one query of one kind, by rounds."""

    def __init__(self, kind: str, query: str, ours: int, theirs: int) -> None:
        """Take the ports of both servers; raise unless they respond."""
        self.kind, self.query, self.texts = kind, query, bodies(kind, query)
        self.rounds: list[tuple[float, float]] = []
        self.crowded: list[tuple[float, float]] = []
        path = query.replace("cycle", "tangential/history")
        other = "stress" if query == "stress" else "small"
        self.targets = f"{ours}/v1/{path}", f"{theirs}/{other}"
        for target in self.targets:
            wire_ratio.check(target, next(self.texts))

    def measure(self, *, crowded: bool) -> None:
        """Measure one round, with several connections as well if it is `crowded`."""
        self.rounds.append(self._rates(1))
        if crowded:
            self.crowded.append(self._rates(wire_ratio.CONNECTIONS))

    def _rates(self, connections: int) -> tuple[float, float]:
        ours, theirs = (
            wire_ratio.rate(target, self.texts, SECONDS, connections, WARM_UP)
            for target in self.targets
        )
        return ours, theirs

    def row(self) -> measure.Row:
        """The row of the table."""
        kind, query = self.kind, self.query
        rates = " / ".join(f"{median(column):.0f}" for column in zip(*self.rounds, strict=True))
        crowded = measure.spread(self.crowded)[0]
        other = "the wire alone" if query == "stress" else "bare FastAPI endpoint"
        return measure.Row(
            f"/v1/{query}, {kind} / {other}",
            "asyncio client",
            *measure.spread(self.rounds),
            f">= {bound(TARGETS, query, kind)}",
            f"{rates} requests/s; {wire_ratio.CONNECTIONS} at once {crowded:.3f}",
        )


if __name__ == "__main__":
    for one in rows(sys.argv[1:]):
        print(f"{one.name:60s} {one.ratio:7.3f} {one.target:8s} {one.detail}")
