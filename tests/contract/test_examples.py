"""Every example of the documentation gives the number that its textbook gives."""

from math import atanh, pi, sqrt

import pytest

from mdr_service.schemas.examples import NORMAL_EXAMPLES
from tests.conftest import Client

STEEL = 210e9 / (1 - 0.3**2)
"""Effective modulus of steel against a rigid body."""


def hertz() -> dict[str, list[float]]:
    """Hertz 1882, the ball on the flat."""
    e_star, radius, force = STEEL / 2, 0.01, 10.0
    a = (3 * force * radius / (4 * e_star)) ** (1 / 3)
    return {
        "contact_radius": [a],
        "indentation_depth": [a**2 / radius],
        "normal_force": [force],
        "mean_pressure": [force / (pi * a**2)],
        "normal_stiffness": [2 * e_star * a],
        "elastic_energy": [0.4 * force * a**2 / radius],
    }


def boussinesq() -> dict[str, list[float]]:
    """Boussinesq 1885, the flat cylinder: F = 2 E* a d."""
    e_star, a = 5e6 / (1 - 0.5**2), 0.005
    depths = [0.0, 1e-4, 2e-4, 5e-4]
    return {
        "contact_radius": [a] * 4,
        "normal_force": [2 * e_star * a * d for d in depths],
        "elastic_energy": [e_star * a * d**2 for d in depths],
    }


def sneddon() -> dict[str, list[float]]:
    """Love 1939, Sneddon 1965, the cone: d = π a tan θ / 2, F = 2 E* d² / (π tan θ)."""
    slope, depth = 0.1, 1e-6
    return {
        "contact_radius": [2 * depth / (pi * slope)],
        "normal_force": [2 * STEEL * depth**2 / (pi * slope)],
        "mean_pressure": [STEEL * slope / 2],
        "elastic_energy": [2 * STEEL * depth**3 / (3 * pi * slope)],
    }


def exact_sphere() -> dict[str, list[float]]:
    """Sneddon 1965, the sphere: d = a artanh(a/R), F = E* ((R² + a²) artanh(a/R) − a R)."""
    e_star, radius = 1e6, 0.01
    radii = [0.001, 0.005]
    return {
        "indentation_depth": [a * atanh(a / radius) for a in radii],
        "normal_force": [
            e_star * ((radius**2 + a**2) * atanh(a / radius) - a * radius) for a in radii
        ],
    }


def worn_ball() -> dict[str, list[float]]:
    """Ejike 1981, the ball with a flat: d = a √(a² − b²)/R, F = 2 E* (2a² + b²) √(a² − b²)/3R."""
    e_star, radius, b, a = 1e9, 0.01, 0.001, 0.002
    root = sqrt(a**2 - b**2)
    return {
        "indentation_depth": [a * root / radius],
        "normal_force": [2 * e_star * (2 * a**2 + b**2) * root / (3 * radius)],
    }


def table() -> dict[str, list[float]]:
    """Hertz 1882 again: a cubic spline through points of a parabola is that parabola."""
    e_star, radius = 1e9, 0.01
    radii = [0.001, 0.002]
    return {
        "indentation_depth": [a**2 / radius for a in radii],
        "normal_force": [4 * e_star * a**3 / (3 * radius) for a in radii],
    }


TEXTBOOK = {
    "hertz": hertz,
    "boussinesq": boussinesq,
    "sneddon": sneddon,
    "exact_sphere": exact_sphere,
    "worn_ball": worn_ball,
    "table": table,
}


def test_every_example_has_its_textbook() -> None:
    assert set(TEXTBOOK) == set(NORMAL_EXAMPLES)


@pytest.mark.parametrize("name", NORMAL_EXAMPLES)
def test_example_gives_the_textbook_number(client: Client, name: str) -> None:
    answer = client.post("/v1/normal", NORMAL_EXAMPLES[name]["value"])
    assert answer.status_code == 200
    document = answer.json()
    for quantity, expected in TEXTBOOK[name]().items():
        assert document[quantity] == pytest.approx(expected, rel=1e-12, abs=0), quantity
    assert document["warnings"] == []
