"""Stresses stay accurate towards the surface, edges and axis, and in the far field."""

from __future__ import annotations

import json
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpc, mpf

from mdr_core import normal, tangential
from mdr_core.profiles import Cone, Paraboloid, Profile
from mdr_core.subsurface import error_estimate, stress
from mdr_core.subsurface.stress import of_moments
from mdr_core.tangential import TangentialContact
from tests.core.comparison import profile_from
from tests.oracles.subsurface_limits import FRICTION, NU, STORED
from tests.stability.curves import Array, Curve, steps

if TYPE_CHECKING:
    from collections.abc import Callable

    from mdr_core.normal import NormalContact

NODES, WEIGHTS = np.polynomial.legendre.leggauss(100)
STORED = {stored["name"]: stored for stored in json.loads(STORED.read_text(encoding="utf-8"))}
BALL, CONE = Paraboloid(2.0), Cone(0.2)
#: Digits that the closed moments need where r is 1e-12 and they lose r^4.
CLOSED_DIGITS = 150


def contact_of(profile: Profile, c: float | None) -> NormalContact | TangentialContact:
    pressed = normal.solve(profile, 1.0, contact_radius=1.0)
    return pressed if c is None else tangential.solve(pressed, 0.9, FRICTION, stick_radius=c)


def primitives(zeta: mpc, r: mpf) -> list[tuple[mpc, mpc]]:
    """Integrals of K and of zeta K over zeta for the kernels of notes, section 14."""
    r2, rho = r * r, mp.sqrt(r * r + zeta * zeta)
    log = mp.log(rho + zeta)
    root, cube = (zeta * rho + r2 * log) / 2, rho**3 / 3
    return [
        (log, rho),
        (-1 / rho, log - zeta / rho),
        ((zeta - rho) / r2, (zeta**2 / 2 - (root - r2 * log)) / r2),
        (zeta / (r2 * rho), -1 / rho),
        ((root - zeta**2 / 2) / r2, (cube - zeta**3 / 3) / r2),
        (
            (r2 * zeta + 2 * zeta**3 / 3 - 2 * cube) / r2**2,
            (r2 * zeta**2 / 2 + zeta**4 / 2 - zeta * rho**3 / 2 + r2 * root / 2) / r2**2,
        ),
        (
            (zeta * rho - zeta**2) / r2**2,
            (r2 * rho + 2 * (cube - r2 * rho) - 2 * zeta**3 / 3) / r2**2,
        ),
    ]


def closed_moments(profile: Profile, low: float, r: mpf, z: mpf) -> np.ndarray:
    """Im int g'(x) K dx from `low` to 1, of the constant and linear slopes of cone and ball."""
    ends = [primitives(mpc(z, x), r) for x in (mpf(low), mpf(1))]
    steps_ = [tuple(b - a for a, b in zip(*pair, strict=True)) for pair in zip(*ends, strict=True)]
    if isinstance(profile, Cone):
        values = [mp.pi / 2 * mpf(profile.slope) * plain / 1j for plain, _ in steps_]
    else:
        # x = (zeta - z)/i.
        values = [-2 / mpf(BALL.radius) * (by_zeta - z * plain) for plain, by_zeta in steps_]
    return np.array([[mp.im(value)] for value in values], dtype=object)


def exact_stress(profile: Profile, c: float | None, place: list[float]) -> Array:
    with mp.workdps(CLOSED_DIGITS):
        x, y, z = map(mpf, place)
        r = mp.hypot(x, y)
        where = tuple(np.array([part]) for part in (float(r), float(z), complex(x, y) / float(r)))
        pressed = closed_moments(profile, 0.0, r, z)
        sheared = mpf(0) if c is None else mpf(FRICTION) * closed_moments(profile, c, r, z)
        first, second = ((part / mp.pi).astype(float) for part in (pressed, sheared + 0 * pressed))
        return np.asarray(of_moments(first + 1j * second, where, NU)[:, 0])


def plain_gauss(contact: NormalContact | TangentialContact, place: list[float]) -> Array:
    """The integrals of notes, section 14, by one rule over the contact and the slip annulus."""
    sheared = isinstance(contact, TangentialContact)
    profile = (contact.normal if sheared else contact).profile
    first = float(profile.contact_radius(np.zeros(())))
    r, z = np.array([np.hypot(*place[:2])]), np.array([place[2]])
    where = (r, z, (place[0] + 1j * place[1]) / r)

    def moments(low: float) -> Array:
        x = low + (1 - low) * (1 + NODES) / 2
        zeta = z + 1j * x
        rho = np.sqrt(r * r + zeta * zeta)
        u = rho + zeta
        kernels = [1 / rho, zeta / rho**3, 1 / (rho * u), rho**-3, 1 / u, u**-2, 1 / (rho * u * u)]
        mass = profile.dg(x) * WEIGHTS * (1 - low) / 2
        return np.array([[(mass * kernel.imag).sum()] for kernel in kernels])

    pressed = moments(first)
    along = FRICTION * moments(float(contact.stick_radius)) if sheared else 0 * pressed
    total = of_moments(pressed + 1j * along, where, NU)
    return np.asarray(total[:, 0] / np.pi)


def beneath(
    title: str, distance: str, distances: Array, points: list[tuple[Any, list[float], Array]]
) -> Curve:
    """The errors at points of contacts whose exact stresses are given."""
    ours, naive, bound = [], [], []
    for contact, place, exact in points:
        result = stress(contact, *place, poissons_ratio=NU, body=2)
        with np.errstate(all="ignore"):
            plain = plain_gauss(contact, place)
        for errors, values in ((ours, np.array(result)), (naive, plain)):
            errors.append(np.abs(values - exact).max() / np.abs(exact).max())
        bound.append(error_estimate(contact, *place))
    naive_formula = "100 nodes of Gauss–Legendre"
    failed = np.nan_to_num(np.array(naive), nan=np.inf)
    name = f"beneath-{title}"
    return Curve(
        name, title, distance, naive_formula, distances, np.array(ours), failed, np.array(bound)
    )


def closed(
    title: str,
    distance: str,
    distances: Array,
    place: Callable[[float], tuple[float, float]],
    profile: Profile = BALL,
    stick: Callable[[float], float] = lambda _: 0.7,
) -> Curve:
    points = []
    for one in distances.tolist():
        r, z = place(one)
        # In this plane r has no rounding.
        at = [r, 0.0, z]
        c = stick(one)
        points.append((contact_of(profile, c), at, exact_stress(profile, c, at)))
    return beneath(title, distance, distances, points)


def stored(name: str) -> Curve:
    record, points = STORED[name], []
    for point in record["points"]:
        contact = contact_of(profile_from(point["profile"]), point["stick_radius"])
        exact = np.array([float(value) for value in point["expected"]])
        points.append((contact, point["place"], exact))
    return beneath(record["title"], record["distance"], np.array(record["distances"]), points)


NEAR, FAR = steps(1.0, 1e-12), steps(1.1, 1e12)
CURVES = {
    "inside": partial(closed, "beneath a paraboloid, r = a/2", "z/a", NEAR, lambda z: (0.5, z)),
    "stick edge": partial(closed, "beneath a paraboloid, r = c", "z/a", NEAR, lambda z: (0.7, z)),
    "edge": partial(closed, "beneath a paraboloid, r = a", "z/a", NEAR, lambda z: (1.0, z)),
    "outside": partial(closed, "beneath a paraboloid, r = 1.3 a", "z/a", NEAR, lambda z: (1.3, z)),
    "axis": partial(closed, "towards the axis, z = a/100", "r/a", NEAR, lambda r: (r, 0.01)),
    "tip": partial(closed, "towards the tip of a cone", "r/a = z/a", NEAR, lambda r: (r, r), CONE),
    "annulus": partial(
        closed,
        "c → a, at that distance from the edge",
        "1 − c/a",
        steps(0.5, 1e-12),
        lambda gap: (1 - gap / 2, gap / 4),
        stick=lambda gap: 1 - gap,
    ),
    "far": partial(closed, "far away", "distance/a", FAR, lambda far: (0.6 * far, 0.8 * far)),
} | {name: partial(stored, name) for name in STORED}
#: A plain rule does well where nothing is singular nearby.
REGULAR = {"far", "outside"}


@pytest.mark.parametrize("name", CURVES)
def test_stresses_beneath(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    if name not in REGULAR:
        sweep.naive_fails(1e-8)
