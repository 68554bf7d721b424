"""Oblique impact of spheres: Maw, Barber and Fawcett, finite elements, and a measurement."""

from collections.abc import Iterator
from math import cos, pi, radians, sin
from typing import Any

from verification.case import Case, at

PATH = "/v1/tangential/impact"
REBOUND = "tangential_rebound_velocity"
# Incidence and rebound w/(mu v) of a steel sphere, and the reading error of the figure.
FEM = (
    (0.272, -0.027),
    (0.586, -0.027),
    (0.876, -0.080),
    (1.190, -0.213),
    (1.553, -0.373),
    (1.915, -0.627),
    (2.314, -0.947),
    (2.785, -1.253),
    (3.317, -1.520),
    (3.970, -1.720),
    (4.755, -1.707),
    (5.758, -1.200),
    (7.124, 0.133),
    (9.118, 2.147),
    (12.356, 5.427),
)
FEM_READING = 0.02
# Angle from the normal and measured tangential restitution of the centre, and the reading error.
MEASURED = (
    (1.84, 0.793),
    (3.703, 0.745),
    (9.496, 0.673),
    (20.012, 0.597),
    (30.127, 0.688),
    (39.382, 0.771),
    (49.694, 0.848),
    (60.02, 0.901),
)
MEASURED_READING = 0.005


def scaled(nu: float, ratio: float, incidence: list[float]) -> dict[str, Any]:
    """Return the request of impacts whose tangential velocities are w/(mu v).

    `ratio` is m/m_t, 7/2 of a solid sphere.
    """
    return {
        "profile": {"kind": "paraboloid", "radius": 1.0},
        "material": {"e_star": 1.0, "g_star": 2 * (1 - nu) / (2 - nu)},
        "friction_coefficient": 0.3,
        "normal_mass": 1.0,
        "tangential_mass": 1 / ratio,
        "normal_velocity": 1 / 0.3,
        "tangential_velocity": incidence,
    }


def sliding() -> Iterator[Case]:
    """Sliding throughout from psi_1 = 4 chi - 1 on, with psi = 2 (1 - nu)/(2 - nu) w/(mu v)."""
    for body, nu, ratio in (
        ("solid sphere", 0.3, 3.5),
        ("hollow sphere", 0.3, 2.5),
        ("solid sphere", 0.5, 3.5),
    ):
        unit = 2 * (1 - nu) / (2 - nu)
        least = 2 * ratio - 1 / unit
        for i, (psi, incidence) in enumerate(((1.001, 1.001 * least), (2, 2 * least))):
            yield Case(
                "maw",
                "psi_1 > 4 chi - 1",
                f"{body}, nu = {nu}, psi_1 = {psi} (4 chi - 1): w/(mu v) after the impact",
                PATH,
                scaled(nu, ratio, [1.001 * least, 2 * least]),
                at(REBOUND, i),
                incidence - 2 * ratio,
                bound=1e-9,
            )


def finite_elements() -> Iterator[Case]:
    """Steel sphere on a plane."""
    request = scaled(0.3, 3.5, [before for before, _ in FEM])
    for i, (before, after) in enumerate(FEM):
        yield Case(
            "wu",
            "test 5",
            f"steel sphere, w/(mu v) = {before}: w/(mu v) after the impact",
            PATH,
            request,
            at(REBOUND, i),
            after,
            bound=0.2,
            uncertainty=FEM_READING,
            scale=1.0,
        )


def alumina() -> Iterator[Case]:
    """Spheres of 5 mm on glass at 3.9 m/s."""
    mass = 4000 * 4 / 3 * pi * 2.5e-3**3
    angles = [radians(angle) for angle, _ in MEASURED]
    along = [3.9 * sin(angle) for angle in angles]
    request = {
        "profile": {"kind": "paraboloid", "radius": 2.5e-3},
        "material": {
            "bodies": [
                {"youngs_modulus": 360e9, "poissons_ratio": 0.23},
                {"youngs_modulus": 70e9, "poissons_ratio": 0.25},
            ]
        },
        "friction_coefficient": 0.092,
        "normal_mass": mass,
        "tangential_mass": 2 / 7 * mass,
        "normal_velocity": [3.9 * cos(angle) for angle in angles],
        "tangential_velocity": along,
    }
    for i, (angle, restitution) in enumerate(MEASURED):
        yield Case(
            "kharaz",
            "measured restitution",
            f"alumina on glass, {angle} degrees, e_t = {restitution}: velocity after the impact",
            PATH,
            request,
            at(REBOUND, i),
            along[i] * (1 + 7 / 2 * (restitution - 1)),
            bound=0.03,
            uncertainty=MEASURED_READING,
            # Deviations are those of e_t.
            scale=7 / 2 * along[i],
        )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    for part in (sliding, finite_elements, alumina):
        yield from part()
