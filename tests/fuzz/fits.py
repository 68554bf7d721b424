"""Every fit of a random curve returns finite parameters with standard errors, or is rejected.

Run with `python -m tests.fuzz.fits COUNT SEED`.
"""

from __future__ import annotations

import json
import sys
import traceback
import warnings
from typing import Any

import numpy as np

from mdr_core import Paraboloid, normal
from mdr_service.dispatch import respond
from mdr_service.problems import FAILURES, INTERNAL, to_problem
from mdr_service.queries import QUERIES
from mdr_service.serializers import JSON

Array = np.ndarray
NAMES = ("e_star", "contact_point", "force_offset", "work_of_adhesion")
PROFILES: tuple[dict[str, Any], ...] = (
    {"kind": "paraboloid", "radius": 1.0},
    {"kind": "cone", "slope": 0.4},
    {"kind": "flat_punch", "radius": 0.5},
    {"kind": "sphere", "radius": 1.0},
    {"kind": "power", "coefficient": 1.0, "exponent": 3.0},
    {"kind": "spherical_tip_cone", "slope": 0.4, "tip_radius": 0.5},
    {"kind": "truncated_cone", "flat_radius": 0.3, "slope": 0.5},
    {"kind": "rounded_punch", "flat_radius": 0.2, "rounding_radius": 1.0},
)


def _depths(random: np.random.Generator) -> Array:
    """Return depths of one branch or two, with a hold or not, as instruments order them."""
    count, start = int(random.integers(3, 120)), random.choice([-1.0, -0.3, 0.0, 0.5, 0.9])
    up = np.linspace(start, 1, count)
    depth = {
        "up": up,
        "down": up[::-1],
        "both": np.r_[up, up[::-1]],
        "held": np.r_[up, np.ones(count // 3), up[::-1], np.full(count // 3, start)],
        "few": random.choice(up[: int(random.integers(1, 4))], count),
        "shuffled": random.permutation(up),
    }[str(random.choice(["up", "down", "both", "held", "few", "shuffled"]))]
    return depth * 10.0 ** random.uniform(-9, 1) * random.choice([0.01, 0.3])


def _forces(random: np.random.Generator, depth: Array) -> Array:
    """Return forces that a contact has, or noise alone, a line, a step or a single peak."""
    size = float(np.abs(depth).max()) or 1.0
    x = depth / size
    kind = random.choice(["hertz", "noise", "line", "step", "peak", "zero", "tension"])
    ball = normal.solve(Paraboloid(1.0), 1.0, indentation_depth=np.maximum(x, 0)).normal_force
    force = {
        "hertz": ball,
        "noise": 0 * x,
        "line": x,
        "step": np.sign(x),
        "peak": np.where(np.arange(x.size) == x.size // 2, 1.0, 0.0),
        "zero": 0 * x,
        "tension": np.where((x < 0) & (x > -0.2), -0.1, ball),
    }[str(kind)]
    noise = 0.0 if kind == "zero" else random.choice([0, 1e-12, 1e-3, 0.03, 0.5])
    force = force + noise * random.standard_normal(x.size)
    if random.random() < 0.2:
        force = np.round(force, int(random.integers(0, 3)))
    return np.asarray(force * 10.0 ** random.uniform(-9, 3) + random.choice([0, 0, 1e-3]))


def drawn(random: np.random.Generator) -> dict[str, Any]:
    """Return a random request of a fit."""
    depth = _depths(random)
    names = [name for name in NAMES if random.random() < 0.5] or ["e_star"]
    query: dict[str, Any] = {
        "profile": PROFILES[int(random.integers(len(PROFILES)))],
        "indentation_depth": depth.tolist(),
        "normal_force": _forces(random, depth).tolist(),
        "fit": names,
    }
    chance = random.random(5)
    material: dict[str, Any] = {} if "e_star" in names else {"e_star": 1.0}
    if chance[0] < 0.1:
        query["layer"] = {"thickness": float(np.ptp(depth)) or 1.0, "base": "frictionless"}
    if chance[1] < 0.3:
        query["segment"] = str(random.choice(["loading", "unloading"]))
    if chance[2] < 0.2:
        query |= {"poissons_ratio": 0.3, "noise": 10.0 ** random.uniform(-9, 1)}
    if chance[3] < 0.3:
        query["time"] = np.cumsum(random.integers(0, 3, depth.size)).astype(float).tolist()
        drifts: tuple[dict[str, Any], ...] = (
            {"drift": "hold"},
            {"drift_rate": 1e-3 * float(np.ptp(depth))},
            {"drift_rate": 0.0, "drift_rate_error": 1e-3 * float(np.ptp(depth))},
        )
        query |= drifts[int(random.integers(3))]
    return query | ({"material": material} if material else {})


def fault(query: dict[str, Any]) -> str:
    """Return what is wrong with the response to a request, empty if nothing is."""
    try:
        request = QUERIES["fit"].request.model_validate(query)
        document = json.loads(respond("fit", request, JSON))
    except FAILURES as error:
        problem = to_problem(error)
        return "internal error" if problem.type == INTERNAL else ""
    # Any other exception is a fault.
    except Exception:  # noqa: BLE001
        return traceback.format_exc(limit=-3)
    errors = document["standard_errors"]
    return "" if all(error > 0 for error in errors) else f"standard errors {errors}"


def main(count: int, seed: int) -> int:
    """Print the faults of `count` fits, and return their number."""
    random, faults = np.random.default_rng(seed), 0
    for i in range(count):
        query = drawn(random)
        if wrong := fault(query):
            faults += 1
            sys.stdout.write(f"fit {i} of seed {seed}: {wrong}\n{json.dumps(query)[:400]}\n")
    sys.stdout.write(f"{count} fits: {faults} faults\n")
    return faults


if __name__ == "__main__":
    warnings.simplefilter("error")
    sys.exit(bool(main(int(sys.argv[1]), int(sys.argv[2]))))
