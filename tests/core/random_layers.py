"""Random contacts with a layer over all kinds of profile, compared with 30 digits.

python -m tests.core.random_layers [count] [seed]

Prints the largest errors. The contact radius is one; depth and force lead back to it.
"""

from __future__ import annotations

import random
import sys
from typing import TYPE_CHECKING, Any, NamedTuple

from mpmath import mp, mpf

from mdr_core import Layer, Material, fields, layer
from tests.core.comparison import profile_from
from tests.core.random_cases import PROFILE_GENERATORS, Draw
from tests.oracles import layer_reference
from tests.oracles.shapes import KINDS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Largest error for contact radii up to ten times the thickness.
BOUND = 1e-10
GENERATORS: dict[str, Callable[[Draw], dict[str, Any]]] = {
    **PROFILE_GENERATORS,
    "flat_punch": lambda _: {"radius": 1.0},
    "two_spheres": lambda draw: {
        "radii": [ball := 1 / draw.uniform(0.01, 0.8), draw.choice([-2 * ball, 1.5, 10.0])]
    },
}
NAMES = ("indentation_depth", "normal_force", "normal_stiffness", "elastic_energy")


class Error(NamedTuple):
    """Relative error of a result, and the largest one that the result states."""

    error: float
    stated: float
    name: str


def scene(draw: Draw, kind: str) -> layer_reference.LayerContact:
    """Random layer under a random profile of a kind."""
    profile = {"kind": kind, **GENERATORS[kind](draw)}
    base = draw.choice(["bonded", "frictionless"])
    nu = draw.choice([0.0, 0.5, draw.uniform(0, 0.5)])
    share = draw.choice([1.0, draw.uniform(0.05, 1.0)])
    thickness = float(10 ** draw.uniform(-0.9999, 2))
    return layer_reference.LayerContact(profile, thickness, base, nu, share)


def errors(scene: layer_reference.LayerContact, draw: Draw) -> Iterator[Error]:
    """Errors of a contact under each of its loads, of its pressure, and of adhesion."""
    profile = profile_from(scene.profile)
    sample = Layer(scene.thickness, scene.base, scene.nu, scene.share)
    material, flat = Material(1.0, layer=sample), profile.is_flat_punch
    with mp.workdps(layer_reference.DIGITS):
        truths = scene.solved
        depth, force = (float(truths[name]) for name in NAMES[:2])
        loads = {"indentation_depth": depth, "normal_force": force}
        known = {"indentation_depth": depth} if flat else {"contact_radius": 1.0}
        for load in (known, *({name: value} for name, value in loads.items())):
            found: Any = layer.solve(profile, material, **load)
            for name, truth in (*((name, truths[name]) for name in NAMES), ("contact_radius", 1)):
                yield _error(found, f"{name} at {load}", getattr(found, name), truth)
        radius = draw.choice([draw.uniform(0.01, 0.99), 1 - 10 ** draw.uniform(-9, -1)])
        contact: Any = layer.solve(profile, material, **known)
        pressure, truth = fields.pressure(contact, radius)[0], scene.pressure(radius)
        size = max(abs(truth), force)
        yield _error(contact, f"pressure at {radius}", pressure - truth + size, size)
        work = depth**2 * 10 ** draw.uniform(-5, -1)
        lower = scene.adhesive(work)
        sunk = {"indentation_depth": float(lower[0])} if flat else known
        adhesive: Any = layer.solve(profile, material, work_of_adhesion=work, **sunk)
        for name, truth, scale in zip(NAMES, lower, (depth, force), strict=False):
            value = getattr(adhesive, name) - truth + scale
            yield _error(adhesive, f"{name} with w = {work}", value, scale)


def _error(found: Any, name: str, value: Any, truth: Any) -> Error:
    return Error(float(abs(mpf(value) / truth - 1)), found.error_estimate, name)


def worst(seed: int, kind: str) -> tuple[Error, layer_reference.LayerContact]:
    """Largest error of a random case over its limit, the smaller of bound and stated error."""
    draw = random.Random(seed)
    found = scene(draw, kind)
    return max(errors(found, draw), key=lambda each: each.error / min(each.stated, BOUND)), found


def main(count: int = 500, seed: int = 1) -> int:
    missed, largest, nearest = 0, 0.0, 0.0
    for number in range(count):
        error, found = worst(seed + number, KINDS[number % len(KINDS)])
        largest, nearest = max(largest, error.error), max(nearest, error.error / error.stated)
        if error.error > min(error.stated, BOUND):
            missed += 1
            sys.stdout.write(f"{error}, {found}\n")
    sys.stdout.write(f"{count} cases, largest error {largest:.1e}, {nearest:.2g} of the stated\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
