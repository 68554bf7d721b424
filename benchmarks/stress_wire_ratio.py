"""Requests per second of `/v1/stress` with many radii against a bare endpoint.

The bare endpoint validates the same body with the same model and serialises arrays of the same size
with the same library: the radii of the request, and two precomputed fields. Servers and load are
those of `wire_ratio`.
"""

from __future__ import annotations

import json
import sys
from contextlib import ExitStack
from pathlib import Path
from statistics import median

import measure
import wire_ratio

RADII = 10_000
ROUNDS = 9
# All digits of every radius, as a program would send them.
QUERY = {
    "profile": {"kind": "paraboloid", "radius": 0.01},
    "material": {"e_star": 1.1e11, "g_star": 0.9e11},
    "load": {"normal_force": 10.0},
    "friction_coefficient": 0.3,
    "tangential": {"tangential_force": 2.0},
    "radius": [1e-4 * index / (RADII - 1) for index in range(RADII)],
    "quantities": ["pressure", "shear_stress"],
}


def rows() -> list[measure.Row]:
    """The ratio, with the rates and the load generator."""
    body = json.dumps(QUERY)
    with ExitStack() as stack:
        service = [sys.executable, "-m", "mdr_command", "serve", "--port"]
        bare = [sys.executable, str(Path(__file__).with_name("bare_endpoint.py"))]
        ports = (stack.enter_context(wire_ratio.server(command)) for command in (service, bare))
        mdr_port, bare_port = ports
        load = stack.enter_context(wire_ratio.load_generator(body))
        targets = (f"{mdr_port}/v1/stress", f"{bare_port}/stress")
        for target in targets:
            wire_ratio.check(target, body)
            load(target)
        count = measure.count(ROUNDS)
        rounds = [(load(targets[0]), load(targets[1])) for _ in range(count)]
    rates = " / ".join(f"{median(column):.0f}" for column in zip(*rounds, strict=True))
    return [
        measure.Row(
            f"/v1/stress, {RADII} radii, two fields, requests/s / bare FastAPI endpoint",
            load.__name__.removeprefix("_"),
            *measure.spread(rounds),
            ">= 0.85",
            f"{rates} requests/s, {wire_ratio.CONNECTIONS} connections",
        )
    ]
