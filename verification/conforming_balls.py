"""Two spheres without friction, or a ball in a socket, by series of solid ball and cavity.

The pressure acts along the mean normal of both surfaces in the ratio of their compliances, and is a
sum of powers of (1 - (r/a)^2)^(k + 1/2). The points of the contact, displaced by series over
Legendre polynomials, close the gap of the exact spheres. A ball is held between two equal contacts,
a socket is a cavity of an infinite body. It generalises `compressed_ball`.

Source: A. I. Lur'e, Three-Dimensional Problems of the Theory of Elasticity, 1964, chapter 6:
displacements grad(phi) and r^2 grad(phi) + alpha r phi, with phi = r^m P_n, m = n or -(n + 1).
"""

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from mpmath import atanh, findroot, mpf, pi, quad
from numpy.typing import NDArray

from verification.case import QUADRATURE, Case, at, fields

Array = NDArray[np.float64]
# Young's modulus and Poisson's ratio of an elastic body; None of a rigid one.
Elastic = tuple[float, float] | None
# Terms of the pressure, points of the contact, and highest degree of the series times a/R: forces,
# depths and pressures are accurate to 2e-4.
_TERMS, _POINTS, _RESOLUTION = 8, 60, 120
# An estimate is right within a factor of three.
_FACTOR: Final = 2.0
# Largest deviations of the true pressure and radius below which the estimate may be too large.
_SMALL: Final = 0.02


def _slope(radius: float, r: Array) -> Array:
    return np.asarray(r / np.sqrt(radius * radius - r * r))


def _degrees(cosine: Array, count: int) -> Iterator[tuple[Array, Array]]:
    """Yield P_n(cos theta) and its derivative by theta, from n = 0 on."""
    sine = np.sqrt(1 - cosine**2)
    below, legendre = np.zeros_like(cosine), np.ones_like(cosine)
    for n in range(count):
        yield legendre, -n * (below - cosine * legendre) / sine
        below, legendre = legendre, ((2 * n + 1) * cosine * legendre - n * below) / (n + 1)


def _receding(
    radius: float,
    elastic: tuple[float, float],
    load: tuple[Array, ...],
    at_: Array,
    slopes: Array,
) -> Array:
    """Displacement of a body away from the other one at radii, for each term of the pressure.

    The radius of a cavity is negative.
    """
    is_cavity, radius = radius < 0, abs(radius)
    r, weight, shape, tilt = load
    young, nu = elastic
    lame, shear = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
    cosine, cosine_at = (np.sqrt(1 - (each / radius) ** 2) for each in (r, at_))
    sine, sine_at = r / radius, at_ / radius
    area = weight * r / cosine / radius**2
    # Tractions on the surface, radial and polar, and their projections on Legendre polynomials.
    normal = -shape * (cosine * (tilt * sine + cosine) * area)[:, None]
    polar = -shape * (cosine * (tilt * cosine - sine) * area)[:, None]
    radial, along = (np.zeros((at_.size, shape.shape[1])) for _ in range(2))
    count = int(_RESOLUTION * radius / r.max())
    degrees = zip(_degrees(cosine, count), _degrees(cosine_at, count), strict=True)
    for n, ((p, dp), (q, dq)) in enumerate(degrees):
        if n % 2 and not is_cavity:
            # Equal contacts press from both sides.
            continue
        first = (2 * n + 1) / 2 * (p @ normal) * (1 if is_cavity else 2)
        if n == 0:
            stiffness = -4 * shear if is_cavity else 3 * lame + 2 * shear
            radial += np.outer(q, first / stiffness)
            continue
        second = (2 * n + 1) / (2 * n * (n + 1)) * (dp @ polar) * (1 if is_cavity else 2)
        m = -(n + 1) if is_cavity else n
        alpha = -2 * (m * lame + (3 * m + 1) * shear) / ((m + 3) * lame + (m + 5) * shear)
        stresses = [
            [
                2 * shear * m * (m - 1),
                lame * (2 * m + alpha * (m + 3)) + 2 * shear * (m + alpha) * (m + 1),
            ],
            [2 * shear * (m - 1), shear * (2 * m + alpha)],
        ]
        one, two = np.linalg.solve(stresses, [first, second])
        radial += np.outer(q, m * one + (m + alpha) * two)
        along += np.outer(dq, one + two)
    down = cosine_at[:, None] * radial - sine_at[:, None] * along
    out = sine_at[:, None] * radial + cosine_at[:, None] * along
    return np.asarray((1 if is_cavity else -1) * radius * (down + slopes[:, None] * out))


def solve(a: float, other: float, first: Elastic, second: Elastic) -> tuple[float, float, float]:
    """Return depth, force and pressure on the axis of a contact of radius a with a ball, R = 1.

    Parameters
    ----------
    a : contact radius, in the undeformed bodies.
    other : radius of the second body, negative for a socket.
    first, second : Young's modulus and Poisson's ratio of the ball and of the other body, or None.
    """
    nodes, weights = np.polynomial.legendre.leggauss(300)
    angle = (nodes + 1) * np.pi / 4
    r, weight = a * np.sin(angle), weights * np.pi / 4 * a * np.cos(angle)
    shape = np.stack([np.cos(angle) ** (2 * k + 1) for k in range(_TERMS)], axis=1)
    places = a * np.sin((np.arange(_POINTS) + 0.5) * np.pi / 2 / _POINTS)
    compliance = [0.0 if each is None else (1 - each[1] ** 2) / each[0] for each in (first, second)]
    sign = 1.0 if other < 0 else -1.0

    def tilt(radius: Array) -> Array:
        slopes = (
            _slope(1.0, radius) * compliance[1] + sign * _slope(abs(other), radius) * compliance[0]
        )
        return np.asarray(slopes / sum(compliance))

    receding = np.zeros((_POINTS, _TERMS))
    for radius, elastic, side in ((1.0, first, 1.0), (other, second, sign)):
        if elastic is not None:
            load = r, weight, shape, side * tilt(r)
            receding += _receding(radius, elastic, load, places, side * tilt(places))
    gap = sum(
        np.sign(radius) * places**2 / (abs(radius) + np.sqrt(radius**2 - places**2))
        for radius in (1.0, other)
    )
    # The displaced points close the gap, up to the depth.
    system = np.column_stack([receding, -np.ones(_POINTS)]) / gap[-1]
    *pressure, depth = np.linalg.lstsq(system, -gap / gap[-1], rcond=1e-14)[0]
    force = sum(2 * np.pi * a * a / (2 * k + 3) * part for k, part in enumerate(pressure))
    return float(depth), float(force), float(sum(pressure))


def half_space(a: Any, other: float) -> tuple[Any, Any]:
    """Return depth and F_N/E* of the half-space model with the exact gap, R = 1."""

    def part(radius: Any) -> tuple[Any, Any]:
        angle = atanh(a / radius)
        return a * angle, (a * a + radius * radius) * angle - a * radius

    (d1, f1), (d2, f2) = part(mpf(1)), part(mpf(other))
    return d1 + d2, f1 + f2


def _largest_pressure(a: float, other: float) -> float:
    """Return the largest pressure over E* of the half-space model."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    share, largest = (nodes + 1) / 2, 0.0
    for r in np.linspace(0.0, a, 200, endpoint=False):
        root = np.sqrt(a * a - r * r)
        x = np.hypot(r, share * root)
        slope = sum(np.arctanh(x / R) + x * R / (R * R - x * x) for R in (1.0, other))
        largest = max(largest, float(weights @ (slope * root / x)) / 2 / np.pi)
    return largest


# Contact radius, radius of the other body, and Poisson's ratios, None of a rigid body; E = 1.
SCENES: Final[tuple[tuple[float, float, float | None, float | None], ...]] = (
    (0.1, -1.03, None, 0.3),
    (0.3, -1.03, None, 0.3),
    (0.6, -1.03, None, 0.3),
    (0.8, -1.003, None, 0.3),
    (0.6, -1.03, None, 0.45),
    (0.1, -1.003, 0.3, 0.3),
    (0.3, -1.03, 0.3, 0.3),
    (0.3, -1.03, 0.45, 0.45),
    (0.45, -1.3, 0.3, 0.3),
    (0.6, -1.1, 0.3, 0.3),
    (0.2, -1.03, 0.3, None),
    (0.6, -1.03, 0.3, None),
    (0.2, 1.0, 0.3, 0.3),
    (0.3, 3.0, 0.3, 0.3),
    (0.3, 3.0, None, 0.3),
)


def scenes() -> Iterator[Case]:
    """Contact radius of the model and estimates of its errors, under the force of the series."""
    for a, other, nu, second in SCENES:
        bodies: list[Elastic] = [None if each is None else (1.0, each) for each in (nu, second)]
        depth, force, pressure = solve(a, other, bodies[0], bodies[1])
        e_star = 1 / sum((1 - each[1] ** 2) / each[0] for each in bodies if each is not None)
        model = findroot(
            lambda x, f=force / e_star, r=other: half_space(x, r)[1] / f - 1,
            (0.8 * a, 1.05 * a),
            solver="anderson",
        )
        at_depth = findroot(
            lambda x, d=depth, r=other: half_space(x, r)[0] / d - 1,
            (0.8 * a, 1.15 * a),
            solver="anderson",
        )
        of_pressure = pressure / e_star / _largest_pressure(float(model), other) - 1
        given = [
            "rigid" if each is None else {"youngs_modulus": 1.0, "poissons_ratio": each}
            for each in (nu, second)
        ]
        request = {
            "profile": {"kind": "two_spheres", "radii": [1.0, other]},
            "material": {"bodies": given},
            "load": {"normal_force": force},
        }
        name = f"radii 1, {other}, ν = {nu}, {second}, a/R = {a}"
        start = "conforming-balls", "series"
        yield Case(
            *("conforming-balls", "closed form", f"{name}: contact_radius", "/v1/normal"),
            *(request, at("contact_radius"), model),
        )
        for member, error in (
            ("model_error", force / e_star / half_space(at_depth, other)[1] - 1),
            ("model_error_radius", a / model - 1),
            ("model_error_pressure", of_pressure),
        ):
            if abs(error) > _SMALL:
                yield Case(
                    *(*start, f"{name}: {member}", "/v1/normal"),
                    *(request, at(member), abs(error)),
                    bound=_FACTOR,
                    uncertainty=0.02,
                    as_ratio=True,
                )


def hip_joint() -> Iterator[Case]:
    """Closed forms of a ball of 14 mm in a socket of 14.1 mm under 2500 N."""
    small, large = mpf(14), mpf("14.1")
    e_star = 1 / ((1 - mpf("0.3") ** 2) / 210000 + (1 - mpf("0.45") ** 2) / 1000)

    def force(a: Any) -> Any:
        parts = [(a * a + r * r) * atanh(a / r) - a * r for r in (small, large)]
        return e_star * (parts[0] - parts[1])

    a = findroot(lambda x: force(x) / 2500 - 1, mpf("10.5"))
    depth = a * (atanh(a / small) - atanh(a / large))
    request: dict[str, Any] = {
        "profile": {"kind": "two_spheres", "radii": [14.0, -14.1]},
        "material": {
            "bodies": [
                {"youngs_modulus": 210000.0, "poissons_ratio": 0.3},
                {"youngs_modulus": 1000.0, "poissons_ratio": 0.45},
            ]
        },
        "load": {"normal_force": 2500.0},
    }
    for member, value in (("contact_radius", a), ("indentation_depth", depth)):
        yield Case(
            *("conforming-balls", "closed form", f"hip joint: {member}", "/v1/normal"),
            *(request, at(member), value),
        )

    def density(x: Any) -> Any:
        parts = [atanh(x / r) / x + r / (r * r - x * x) for r in (small, large)]
        return parts[0] - parts[1]

    yield Case(
        *("conforming-balls", "closed form", "hip joint: pressure on the axis", "/v1/stress"),
        *(fields(request, "pressure", [0.0]), at("pressure", 0, 0)),
        e_star / pi * quad(density, [0, a / 2, a]),
        bound=QUADRATURE,
    )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    yield from hip_joint()
    yield from scenes()
