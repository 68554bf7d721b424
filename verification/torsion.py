"""Torsion with slip: Lubkin, Deresiewicz, Jaeger, Segalman, and rings of torsional elements.

In the ring solution pressure and traction are constant on rings, with the pressure of
`ring_elements`; it shares nothing with the method of turning discs.
"""

from collections.abc import Iterator
from functools import cache
from typing import Any, Final

import numpy as np
from mpmath import acosh, cosh, ellipe, ellipk, mpf, pi, quad, sqrt
from numpy.typing import NDArray
from scipy.special import ellipe as second_kind
from scipy.special import ellipkm1 as first_kind

from verification import ring_elements
from verification.case import Case, Json, at

PATH: Final = "/v1/torsion"
MU: Final = 0.3
Array = NDArray[np.float64]
# Points of Gauss's rule on a ring, and on a half of one next to its own middle.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


def _request(profile: Json, load: Json, twist: Json, **moduli: float) -> dict[str, Any]:
    return {
        "profile": profile,
        "material": moduli or {"e_star": 1.0, "shear_modulus": 0.7},
        "load": dict(load),
        "friction_coefficient": MU,
        "torsion": dict(twist),
    }


def _like_spheres() -> tuple[dict[str, Any], Any, Any, Any]:
    """Two spheres with R = 2, E = 1 and nu = 0.3: request, a, E* and G = G1/2."""
    body = {"youngs_modulus": 1.0, "poissons_ratio": 0.3}
    nu, a = mpf(0.3), mpf("0.125")
    request = {
        "profile": {"kind": "paraboloid", "radius": 1.0},
        "material": {"bodies": [body, body]},
        "load": {"contact_radius": float(a)},
        "friction_coefficient": MU,
    }
    return request, a, 1 / (2 * (1 - nu**2)), 1 / (4 * (1 + nu))


def _first(q: Any) -> Any:
    """K with the complementary modulus q."""
    return ellipk(1 - q * q)


def _second(q: Any) -> Any:
    """E likewise."""
    return ellipe(1 - q * q)


def lubkin() -> Iterator[Case]:
    """Rotation, torque, largest torque and traction of two like spheres.

    The rotation is closed. So is the torque but for int_q^1 K dy, q = c/a, to which the integrals
    of y^2 K and y^2 E are reduced by parts.
    """
    spheres, a, e_star, shear = _like_spheres()
    p0 = 2 * e_star * a / pi
    for ratio in (0.999999, 0.9, 0.5, 0.1, 0.001):
        request = spheres | {"torsion": {"stick_radius": float(a * ratio)}}
        q = mpf(float(a * ratio)) / a
        k, f = _first(q), _second(q)
        i0 = quad(_first, [q, sqrt(q), 1])
        i2 = i0 / 4 + q * ((1 - q * q) * k / 2 - (k - f) / 4)
        j2 = ((i0 + q * (k - f)) / 2 + i2 + q * (1 - q * q) * f) / 4
        torque = 8 * MU * p0 * a**3 / 3 * (q**3 * (k - f) + 3 * (i2 - j2))
        for name, value in (("rotation", MU * p0 / (2 * shear) * (k - f)), ("torque", torque)):
            words = f"like spheres, c/a = {ratio}: {name}"
            yield Case("lubkin", name, words, PATH, request, at(name), value, bound=1e-11)
        if ratio == 0.5:
            words, arm = "like spheres: largest torque over mu F", 3 * pi * a / 16
            yield Case("lubkin", "largest torque", words, PATH, request, at("torsion_arm"), arm)
            words, tau = "like spheres: shear_stress at r/a = 0.8", MU * p0 * mpf("0.6")
            query, place = request | {"radius": [float(a * 0.8)]}, at("shear_stress", 0, 0)
            yield Case("lubkin", "traction", words, PATH, query, place, tau, bound=1e-11)


def deresiewicz() -> Iterator[Case]:
    """Rotation and dissipated energy of like spheres under small torques.

    phi = (mu N/(4 G a^2)) [1 - s] [3 - s], s^2 = 1 - 3M/(2 mu N a), with G of either sphere, is
    exact to the second order in M, and the energy, a quarter of that of its loop, to the third.
    """
    spheres, a, e_star, shear = _like_spheres()
    limit = MU * 4 * e_star * a**3 / 3
    for part in (1e-4, 1e-3, 1e-2):
        torque = part * limit * a
        request = spheres | {"torsion": {"torque": float(torque)}}
        root = sqrt(1 - 3 * mpf(part) / 2)
        rotation = limit / (8 * shear * a**2) * (1 - root) * (3 - root)
        words = f"like spheres, M/(mu N a) = {part}: "
        for name, value, bound in (
            ("rotation", rotation, 0.3 * part**2),
            ("dissipated_energy", 3 * part * torque**2 / (64 * shear * a**3), 2 * part),
        ):
            yield Case(
                *("deresiewicz", "small torques", words + name, PATH, request, at(name), value),
                bound=bound,
                uncertainty=bound,
            )


def segalman() -> Iterator[Case]:
    """Both asymptotes of the law of two like spheres, which their approximations share."""
    spheres, a, e_star, shear = _like_spheres()
    limit = MU * 4 * e_star * a**3 / 3
    for rotation, words, value in (
        (1e-12, "as phi -> 0: torque 16 G a^3 phi/3", 16 * shear * a**3 / 3 * mpf(1e-12)),
        (1e3, "as phi -> inf: torque 3 pi mu N a/16", 3 * pi * limit * a / 16),
    ):
        request = spheres | {"torsion": {"rotation": rotation}}
        case = f"like spheres {words}"
        yield Case("segalman", "asymptotes", case, PATH, request, at("torque"), value, bound=1e-9)


def jaeger() -> Iterator[Case]:
    """Rotations of a cone and of r^4 by the closed pressure, (mu/2G) int_c^a p/sqrt(r^2 - c^2) dr.

    Steuermann's profiles are powers of even exponents.
    """
    shear, cone, power = mpf("0.7"), mpf("0.1"), mpf("0.2")

    def of_cone(r: Any) -> Any:
        return cone / 2 * acosh(1 / r)

    def of_power(r: Any) -> Any:
        return 32 * power / (9 * pi) * sqrt(1 - r * r) * (1 + 2 * r * r)

    profiles: tuple[tuple[str, dict[str, Any], Any], ...] = (
        ("cone", {"kind": "cone", "slope": float(cone)}, of_cone),
        ("r^4", {"kind": "power", "coefficient": float(power), "exponent": 4.0}, of_power),
    )
    for name, profile, pressure in profiles:
        for c in (0.9, 0.5, 0.05):
            # r = c cosh t removes the root at c.
            top = acosh(1 / mpf(c))
            whole = quad(lambda t, c=c, p=pressure: p(min(c * cosh(t), 1)), [0, top / 2, top])
            request = _request(profile, {"contact_radius": 1.0}, {"stick_radius": c})
            words, rotation = f"{name}, c/a = {c}: rotation", MU / (2 * shear) * whole
            yield Case(
                *("jaeger", "superposition", words, PATH, request, at("rotation"), rotation),
                bound=1e-11,
            )


def _ring_twist(shape: Array, count: int, depth: float, rotation: float, shear: float) -> float:
    """Torque of rings under a rotation, with stick and slip found by an active set."""
    edges = np.linspace(0.0, ring_elements.REACH, count + 1)
    r, _, pressure, _ = ring_elements.solve(shape, count, depth, 0.0)
    influence, limit = _turning(count) / shear, MU * pressure
    touches, slips = pressure > 0, np.zeros(count, dtype=bool)
    for _ in range(count):
        traction = np.where(slips, limit, 0.0)
        sticks = touches & ~slips
        rest = rotation * r - influence @ traction
        traction[sticks] = np.linalg.solve(influence[np.ix_(sticks, sticks)], rest[sticks])
        more = sticks & (traction > limit)
        if not more.any():
            break
        slips |= more
    return float(2 * np.pi / 3 * np.diff(edges**3) @ traction)


@cache
def _turning(count: int) -> Array:
    """Circumferential displacement in the middle of a ring by unit traction on another, G = 1.

    (1/2 pi) int s ds int cos(t)/R dt, whose inner integral is (2/(r s)) [(r^2 + s^2) K/(r + s) -
    (r + s) E], 1 - m = (r - s)^2/(r + s)^2. On the ring itself the points cluster at its middle,
    where K has a logarithm.
    """
    edges = np.linspace(0.0, ring_elements.REACH, count + 1)
    r = (edges[1:] + edges[:-1]) / 2
    far = (_NODES + 1) / 2
    near = np.concatenate([(1 - far**3) / 2, (1 + far**3) / 2])
    result = np.zeros((count, count))
    for shares, weights, own in (
        (far, _WEIGHTS / 2, ~np.eye(count, dtype=bool)),
        (near, np.tile(3 * far**2 * _WEIGHTS / 4, 2), np.eye(count, dtype=bool)),
    ):
        s = edges[:-1, None] + np.diff(edges)[:, None] * shares
        place = r[:, None, None] + 0 * s
        rest = np.square((place - s) / (place + s))
        inner = (place**2 + s**2) / (place + s) * first_kind(rest)
        inner -= (place + s) * second_kind(1 - rest)
        values = inner / (np.pi * place) @ weights * np.diff(edges)
        result[own] = values[own]
    return result


def rings() -> Iterator[Case]:
    """Torque of a truncated cone, with the slip front on its flank and in its flat.

    The solution converges with the width of the rings, and so does the bound.
    """
    shear, profile = 0.7, {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.1}
    # d = t a arccos(b/a) at a = 1, b = 1/2.
    depth = 0.1 * np.pi / 3
    for count in ring_elements.RINGS:
        middles = (np.arange(count) + 0.5) * ring_elements.REACH / count
        shape = 0.1 * np.maximum(middles - 0.5, 0.0)
        for rotation, front in ((0.004, "on the flank"), (0.02, "in the flat")):
            torque = _ring_twist(shape, count, depth, rotation, shear)
            request = _request(profile, {"indentation_depth": depth}, {"rotation": rotation})
            bound = 0.01 / count
            words = f"truncated cone, slip front {front}: torque"
            yield Case(
                *("ring-elements", f"{count} rings", words, PATH, request, at("torque"), torque),
                bound=bound,
                uncertainty=bound,
            )


def cases() -> Iterator[Case]:
    """Yield every case of torsion."""
    for source in (lubkin, deresiewicz, segalman, jaeger, rings):
        yield from source()
