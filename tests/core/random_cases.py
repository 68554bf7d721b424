"""Random contacts biased towards cancellation, compared with mpmath.

python -m tests.core.random_cases [seconds] [seed]      # make random

Prints the largest errors. Contact and stick radii are prescribed and therefore exact. Stick edges,
radii and contact edges cluster at breaks and at each other.
"""

from __future__ import annotations

import random
import sys
import time
from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING, Any

from mpmath import isinf, mp, mpf

from mdr_core import fields, normal, tangential
from tests.core.comparison import profile_from
from tests.oracles import slip_reference

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from mdr_core.profiles import Profile

#: Relative error limit of fields at the tightest tolerance.
BOUND = 1e-11
EDGE = 1.0
EXPONENTS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.5, 7.0)
Draw = random.Random


@dataclass(frozen=True)
class Scene:
    """A contact of radius one with stick radius `stick`, and the radii to check."""

    profile: dict[str, Any]
    made: Profile
    stick: float
    radii: list[float]


@dataclass(frozen=True)
class Miss:
    """A result whose error exceeds its limit, in units of the limit."""

    times: float
    quantity: str
    radius: float
    scene: Scene

    def __str__(self) -> str:
        scene = self.scene
        at = f"{self.quantity} at {self.radius!r}, c = {scene.stick!r}"
        return f"{self.times:.3g} x the bound: {at}, {scene.profile}"


def _spread(draw: Draw, low: float, high: float) -> float:
    """Random number, uniform in its logarithm between two powers of ten."""
    return float(10 ** draw.uniform(low, high))


def _near(draw: Draw, position: float, closest: float = -12.0) -> float:
    """A radius next to a given one, on either side."""
    return position * (1 + draw.choice([-1, 1]) * _spread(draw, closest, -2))


def _break(draw: Draw) -> float:
    """A break radius: tiny, next to the contact edge, or in between."""
    near_edge = 1 - _spread(draw, -9, -1)
    return draw.choice([_spread(draw, -6, -0.01), near_edge, draw.uniform(0.05, 0.99)])


def _power(draw: Draw) -> dict[str, Any]:
    odd = draw.choice([_spread(draw, -0.7, 1.7), float(draw.randrange(1, 9)), 1.5])
    return {"coefficient": _spread(draw, -3, 1), "exponent": odd}


def _series(draw: Draw) -> dict[str, Any]:
    powers = sorted(draw.sample(EXPONENTS, draw.randrange(1, 4)))
    return {"terms": [{"coefficient": _spread(draw, -3, 0), "exponent": n} for n in powers]}


def _rounded_cone(draw: Draw) -> dict[str, Any]:
    slope = _spread(draw, -2, 0)
    return {"slope": slope, "tip_radius": _break(draw) / slope}


def _spherical_tip(draw: Draw) -> dict[str, Any]:
    slope = _spread(draw, -2, 1.5)
    return {"slope": slope, "tip_radius": _break(draw) * hypot(1, 1 / slope)}


PROFILE_GENERATORS: dict[str, Callable[[Draw], dict[str, Any]]] = {
    "paraboloid": lambda draw: {"radius": _spread(draw, -1, 3)},
    "cone": lambda draw: {"slope": _spread(draw, -3, 0)},
    "power": _power,
    "series": _series,
    "sphere": lambda draw: {"radius": 1 + _spread(draw, -5, 3)},
    "ellipsoid": lambda draw: {"radius": 1 + _spread(draw, -5, 2), "height": _spread(draw, -2, 2)},
    "hyperboloid": lambda draw: {
        "slope": _spread(draw, -2, 0),
        "tip_radius": _spread(draw, -5, 3),
    },
    "rounded_punch": lambda draw: {
        "flat_radius": _break(draw),
        "rounding_radius": _spread(draw, -1, 3),
    },
    "truncated_cone": lambda draw: {"flat_radius": _break(draw), "slope": _spread(draw, -2, 0)},
    "truncated_paraboloid": lambda draw: {
        "flat_radius": _break(draw),
        "radius": _spread(draw, -1, 3),
    },
    "rounded_cone": _rounded_cone,
    "spherical_tip_cone": _spherical_tip,
    "capped_paraboloid": lambda draw: {
        "cap_radius": _break(draw),
        "tip_radius": _spread(draw, 0.5, 3),
        "radius": _spread(draw, -2, 0.4),
    },
}


def scene(draw: Draw) -> Scene:
    """Random contact, drawn again while it has no slip annulus."""
    kind = draw.choice(list(PROFILE_GENERATORS))
    profile = {"kind": kind, **PROFILE_GENERATORS[kind](draw)}
    made = profile_from(profile)
    breaks = [float(b) for b in made.breaks if 0 < b < EDGE]
    sticks = [draw.uniform(0.02, 0.98), 1 - _spread(draw, -12, -1), _spread(draw, -6, -0.5)]
    stick = draw.choice([*sticks, *(_near(draw, b) for b in breaks)])
    flat = float(made.first_radius)
    if not flat < stick < EDGE:
        return scene(draw)
    radii = [draw.uniform(0.01, 0.999), 1 - _spread(draw, -14, -2), _spread(draw, -8, -1)]
    radii += [_near(draw, position) for position in (stick, *breaks[-2:])]
    radii += [1 + _spread(draw, -12, 2)]
    return Scene(profile, made, stick, radii)


def misses(scene: Scene) -> Iterator[Miss]:
    """Results of a case whose error exceeds the error limit."""
    contact = normal.solve(scene.made, 1.0, contact_radius=EDGE)
    pushed = tangential.solve(contact, 1.0, 1.0, stick_radius=scene.stick)
    radii = scene.radii
    result = {
        "pressure": fields.pressure(contact, radii),
        "shear_stress": fields.shear_stress(pushed, radii),
        "slip": fields.slip(pushed, radii),
        "normal_displacement": fields.normal_displacement(contact, radii),
    }
    material = slip_reference.Material(1.0, 1.0, 1.0)
    at = slip_reference.setting(scene.profile, "contact_radius", EDGE, material)
    c = mpf(scene.stick)
    for index, radius in enumerate(radii):
        r = mpf(radius)
        truths = {
            "pressure": slip_reference.traction(at, mpf(0), r),
            "shear_stress": slip_reference.traction(at, c, r),
            "slip": slip_reference.slip(at, c, r),
            "normal_displacement": slip_reference.displacement(at, r),
        }
        for quantity, truth in truths.items():
            times = _relative_error(float(result[quantity][index]), truth) / BOUND
            if not times <= 1:
                yield Miss(times, quantity, radius, scene)


def _relative_error(value: float, truth: mpf) -> float:
    if truth == 0 or isinf(truth):
        return 0.0 if value == float(truth) else float("inf")
    with mp.workdps(40):
        return float(abs((mpf(value) - truth) / truth))


def main(seconds: float = 300.0, seed: int = 1) -> int:
    draw, end, count = Draw(seed), time.monotonic() + seconds, 0
    result: list[Miss] = []
    while time.monotonic() < end:
        result += misses(scene(draw))
        count += 1
    for miss in sorted(result, key=lambda miss: -miss.times)[:20]:
        sys.stdout.write(f"{miss}\n")
    sys.stdout.write(f"{count} cases, {len(result)} results beyond their error limit\n")
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main(*(kind(text) for kind, text in zip((float, int), sys.argv[1:], strict=False))))
