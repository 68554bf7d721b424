"""Partial slip by ring elements: a numerical solution that shares nothing with MDR's method.

Pressure and traction are constant on rings; the displacement of a uniformly loaded disc, in
elliptic integrals (Johnson, section 3.4), gives the influence of a ring on the middle of another.
Contact and friction are bounds on the unknowns, p >= 0 and tau <= mu p, found by an active set.
The tangential kernel is that of Cattaneo and Mindlin, with G* in the place of E*.
"""

from collections.abc import Iterator
from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipe, ellipk

from verification.case import Case, at, tangential

Array = NDArray[np.float64]
# Radius of the meshed disc over the contact radius.
REACH: Final = 1.25
FRICTION, G_STAR = 0.3, 0.8
RINGS: Final = (100, 200, 400)


def _disc(b: Array, r: Array) -> Array:
    """Displacement at r by unit pressure on a disc of radius b, E* = 1."""
    inside = r < b
    b_ = np.where(b > 0, b, 1.0)
    near = 4 * b_ / np.pi * ellipe(np.where(inside, r / b_, 0.0) ** 2)
    m = np.where(inside, 0.0, b / r) ** 2
    far = 4 * r / np.pi * (ellipe(m) - (1 - m) * ellipk(m))
    return np.asarray(np.where(inside, near, far))


@cache
def _rings(count: int) -> tuple[Array, Array, Array]:
    """Middles and areas of the rings, and their influence on each other."""
    edges = np.linspace(0.0, REACH, count + 1)
    r = (edges[1:] + edges[:-1]) / 2
    discs = _disc(edges[None, :], r[:, None])
    return r, np.pi * np.diff(edges**2), np.diff(discs, axis=1)


def solve(
    shape: Array, count: int, depth: float, shift: float
) -> tuple[Array, Array, Array, Array]:
    """Return middles, areas, pressure and traction of the rings.

    Parameters
    ----------
    shape : f at the middles of the rings.
    count : number of rings.
    depth, shift : indentation depth and tangential displacement.
    """
    r, area, influence = _rings(count)
    touches = shape < depth
    for _ in range(count):
        pressure = np.zeros(count)
        pressure[touches] = np.linalg.solve(
            influence[np.ix_(touches, touches)], (depth - shape)[touches]
        )
        kept = touches & (pressure > 0)
        if (kept == touches).all():
            break
        touches = kept
    limit = FRICTION * pressure
    slips = np.zeros(count, dtype=bool)
    for _ in range(count):
        traction = np.where(slips, limit, 0.0)
        sticks = touches & ~slips
        rest = G_STAR * shift - influence @ traction
        traction[sticks] = np.linalg.solve(influence[np.ix_(sticks, sticks)], rest[sticks])
        more = sticks & (traction > limit)
        if not more.any():
            break
        slips |= more
    return r, area, pressure, traction


def cases() -> Iterator[Case]:
    """Yield forces and stresses of three profiles with three meshes.

    The bound is one ring's width over the contact radius, a rounded punch's with its flat.
    """
    profiles: tuple[tuple[str, dict[str, Any], Any, float, float], ...] = (
        ("paraboloid", {"kind": "paraboloid", "radius": 2.0}, lambda r: r * r / 4, 0.5, 0.1),
        ("cone", {"kind": "cone", "slope": 0.1}, lambda r: 0.1 * r, 0.05 * np.pi, 0.03),
        (
            "rounded punch",
            {"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 2.0},
            lambda r: np.square(np.maximum(r - 0.5, 0)) / 4,
            # (5.59) at a = 1.
            (np.sqrt(0.75) - 0.5 * np.arccos(0.5)) / 2,
            0.04,
        ),
    )
    for name, profile, shape, depth, shift in profiles:
        for count in RINGS:
            r, area, pressure, traction = solve(shape(_rings(count)[0]), count, depth, shift)
            bound = REACH / count
            request = tangential(
                profile,
                {"indentation_depth": float(depth)},
                {"tangential_displacement": shift},
                FRICTION,
                G_STAR,
            )
            for quantity, value in (
                ("normal_force", area @ pressure),
                ("tangential_force", area @ traction),
            ):
                yield Case(
                    "ring-elements",
                    f"{count} rings",
                    f"{name}: {quantity}",
                    "/v1/tangential",
                    request,
                    at(quantity),
                    float(value),
                    bound=bound,
                    uncertainty=bound,
                )
            place = int(np.argmin(abs(r - 0.4)))
            for quantity, found in (("pressure", pressure), ("shear_stress", traction)):
                query = request | {"radius": [float(r[place])], "quantities": [quantity]}
                yield Case(
                    "ring-elements",
                    f"{count} rings",
                    f"{name}: {quantity} at r/a = 0.4",
                    "/v1/stress",
                    query,
                    at(quantity, 0, 0),
                    float(found[place]),
                    bound=bound,
                    uncertainty=bound,
                )
