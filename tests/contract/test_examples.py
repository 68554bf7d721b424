"""Every example of the documentation gives the result of its textbook."""

import json
from collections.abc import Callable
from math import acos, acosh, asin, atanh, inf, pi, sqrt
from typing import Any

import pytest

from mdr_service.schemas.examples import EXAMPLES
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
    """Boussinesq 1885, flat punch: F = 2 E* a d."""
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
    """Ejike 1981, ball with a flat: d = a √(a² − b²)/R, F = 2 E* (2a² + b²) √(a² − b²)/3R."""
    e_star, radius, b, a = 1e9, 0.01, 0.001, 0.002
    root = sqrt(a**2 - b**2)
    return {
        "indentation_depth": [a * root / radius],
        "normal_force": [2 * e_star * (2 * a**2 + b**2) * root / (3 * radius)],
    }


def adhesive_ball() -> dict[str, list[float]]:
    """Johnson, Kendall and Roberts 1971: a³ = (3R/4E*) (F + 3πwR + √(6πwRF + (3πwR)²))."""
    e_star, radius, w, forces = 2e6 / (1 - 0.5**2), 0.001, 0.05, [-2e-4, 0.0, 1e-4]
    part = 3 * pi * w * radius
    apparent = [force + part + sqrt(2 * part * force + part**2) for force in forces]
    radii = [(3 * radius * force / (4 * e_star)) ** (1 / 3) for force in apparent]
    return {
        "contact_radius": radii,
        "indentation_depth": [a**2 / radius - sqrt(2 * pi * a * w / e_star) for a in radii],
        "retraction": [sqrt(2 * pi * a * w / e_star) for a in radii],
        "pull_off_force": [-part / 2] * 3,
        "pull_off_depth": [-0.75 * ((pi * w / e_star) ** 2 * radius) ** (1 / 3)] * 3,
    }


def table() -> dict[str, list[float]]:
    """Hertz 1882: a cubic spline through points of a parabola is that parabola."""
    e_star, radius = 1e9, 0.01
    radii = [0.001, 0.002]
    return {
        "indentation_depth": [a**2 / radius for a in radii],
        "normal_force": [4 * e_star * a**3 / (3 * radius) for a in radii],
    }


STEEL_SHEAR = 210e9 / (2 * 1.3) * 4 / (2 - 0.3)
"""Effective shear modulus of steel against a rigid body."""
RUBBER, RUBBER_SHEAR = 5e6 / 0.75, 5e6 / 3 * 4 / 1.5


def cattaneo_mindlin() -> dict[str, object]:
    """Cattaneo 1938, Mindlin 1949: c/a = (1 − F_x/(µ F_N))^(1/3), Eqs. (5.12), (5.16)."""
    (a,), (d,) = hertz()["contact_radius"], hertz()["indentation_depth"]
    ratio, friction, force = STEEL / STEEL_SHEAR, 0.3, 10.0
    forces = [0.0, 1.0, 2.0, 2.9, 3.0]
    sticking = [(1 - fx / (friction * force)) ** (1 / 3) for fx in forces[:-1]] + [0.0]
    # Mindlin and Deresiewicz 1953: a quarter of the energy per cycle.
    full = 3 * friction * ratio * force * friction * d / 2 / 5
    return {
        **{name: values * 5 for name, values in hertz().items()},
        "tangential_force": forces,
        "stick_radius": [a * s for s in sticking],
        "slip_width": [a * (1 - s) for s in sticking],
        "tangential_displacement": [friction * ratio * d * (1 - s**2) for s in sticking],
        "tangential_stiffness": [STEEL_SHEAR * a * s for s in sticking],
        "dissipated_energy": [full * (2 / 3) * (1 - s) ** 3 * (1 + 3 * s + s**2) for s in sticking],
        "regime": ["stick"] + ["partial_slip"] * 3 + ["full_slip"],
    }


def truman() -> dict[str, object]:
    """Truman, Sackfield and Hills 1995, the cone: Eqs. (5.47), (5.48)."""
    slope, a, friction = 0.1, 0.004, 0.8
    radii = [0.001, 0.002, 0.003]
    whole = pi / 2 * friction * RUBBER * slope
    return {
        "stick_radius": radii,
        "slip_width": [a - c for c in radii],
        "tangential_force": [whole * (a**2 - c**2) for c in radii],
        "tangential_displacement": [whole / RUBBER_SHEAR * (a - c) for c in radii],
        # A quarter of (π² µ² E*² tan²θ/(3 G*)) (a − c)³.
        "dissipated_energy": [whole**2 / (3 * RUBBER_SHEAR) * (a - c) ** 3 for c in radii],
        "regime": ["partial_slip"] * 3,
    }


def flat_punch() -> dict[str, object]:
    """Eq. (5.33): F_x = 2 G* a u_x, up to µ F_N."""
    a, depth, friction = 0.005, 1e-4, 0.5
    limit = friction * 2 * RUBBER * a * depth
    stiffness = 2 * RUBBER_SHEAR * a
    return {
        "tangential_force": [stiffness * 1e-5, limit],
        "tangential_displacement": [1e-5, 1e-3],
        "stick_radius": [a, 0.0],
        "slip_width": [0.0, a],
        "tangential_stiffness": [stiffness, 0.0],
        "dissipated_energy": [0.0, limit * (1e-3 - limit / stiffness)],
        "regime": ["stick", "full_slip"],
    }


def mindlin_curve(force: float, friction: float = 0.3) -> float:
    """Displacement of the steel ball under 10 N in first loading, Eqs. (5.12), (5.16)."""
    (depth,), normal_force = hertz()["indentation_depth"], 10.0
    ratio = STEEL / STEEL_SHEAR
    return friction * ratio * depth * (1 - (1 - force / (friction * normal_force)) ** (2 / 3))


def mindlin_deresiewicz() -> dict[str, object]:
    """Mindlin and Deresiewicz 1953, Eqs. (5.19), (5.20): the branches and the area of the loop."""
    (a,), limit, force = hertz()["contact_radius"], 3.0, 2.0
    rest = 1 - force / limit
    bracket = 1 - rest ** (5 / 3) - 5 / 6 * (1 - rest) * (1 + rest ** (2 / 3))
    energy = 18 * limit**2 / (5 * a * STEEL_SHEAR / 2) * bracket
    top = mindlin_curve(force)
    back = top - 2 * mindlin_curve(force / 2)
    return {
        "step": [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5],
        "normal_force": [5.0] + [10.0] * 11,
        "tangential_force": [0.0, 0.0, 1.0, 2.0, *[0.0, -2.0, 0.0, 2.0] * 2],
        "tangential_displacement": [
            *(0.0, 0.0, mindlin_curve(1.0), top),
            *[back, -top, -back, top] * 2,
        ],
        "energy_per_cycle": [energy, energy],
        "secant_stiffness": [force / top] * 2,
        "slip_fronts": [a * rest ** (1 / 3)],
    }


def residual() -> dict[str, object]:
    """Eqs. (5.19), (5.20): half of the force in reverse causes reverse slip, the rest remains."""
    (a,), limit, force = hertz()["contact_radius"], 3.0, 2.0
    top = mindlin_curve(force)
    fronts = [1 - force / limit, 1 - force / (2 * limit)]
    return {
        "tangential_displacement": [0.0, top, top - 2 * mindlin_curve(force / 2)],
        "slip_fronts": [a * rest ** (1 / 3) for rest in fronts],
        "regime": ["stick", "partial_slip", "partial_slip"],
    }


def oblique() -> dict[str, object]:
    """Mindlin and Deresiewicz 1953: F_x = β F_N sticks, and u_x = β E*/G* d.

    Unloading follows the solution with friction coefficient µ + β.
    """
    (depth,), share = hertz()["indentation_depth"], 0.1
    there = share * STEEL / STEEL_SHEAR * depth
    return {
        "tangential_force": [1.0, -1.0],
        "tangential_displacement": [there, there - mindlin_curve(2.0, friction=0.3 + share)],
        "slip_fronts": [hertz()["contact_radius"][0] * (1 - 2 / 4) ** (1 / 3)],
        "regime": ["stick", "partial_slip"],
    }


def carried_on() -> dict[str, object]:
    """Masing's rule from u_x = 0.2 to -0.1 µm, the state, and on to 0."""
    radius, depth, full_slip = 0.01, 8e-7, 0.3 * 115e9 / 95e9 * 8e-7
    limit = 0.3 * 4 / 3 * 115e9 * sqrt(radius) * depth**1.5
    steps = [2e-7, 3e-7 / 2, 1e-7 / 2]
    first, second, third = (limit * (1 - (1 - u / full_slip) ** 1.5) for u in steps)
    return {
        "tangential_force": [first - 2 * second + 2 * third],
        "slip_fronts": [sqrt(radius * depth * (1 - u / full_slip)) for u in steps],
        "regime": ["partial_slip"],
    }


def cone_with_separation() -> dict[str, object]:
    """Cone: F_x/(µ F_N) = 1 − (1 − u_x/u_max)², Eqs. (5.47), (5.48), and a separation."""
    slope, depth, friction = 0.1, 1e-4, 0.5
    depths = [depth / 4, depth / 2, 3 * depth / 4, *[depth] * 5]
    forces = [2 * RUBBER * d**2 / (pi * slope) for d in depths]
    full = friction * RUBBER / RUBBER_SHEAR * depth
    shares = [1 - max(1 - i / 4 * depth / full, 0.0) ** 2 for i in range(1, 5)]
    lifting = [0.0725, 0.045, 0.0175]
    off = [2 * RUBBER * (d * 1e-3) ** 2 / (pi * slope) for d in lifting]
    return {
        "normal_force": forces + off + [0.0] + off[::-1] + forces[-1:],
        "tangential_force": [0.0] * 4
        + [friction * forces[-1] * share for share in shares]
        + [friction * force for force in off]
        + [0.0] * 5,
        "regime": ["stick"] * 4
        + ["full_slip" if share == 1 else "partial_slip" for share in shares]
        + ["full_slip"] * 3
        + ["no_contact"]
        + ["stick"] * 4,
        "slip_fronts": [],
    }


def cattaneo_mindlin_fields() -> dict[str, object]:
    """Eqs. (5.38) and (5.45): pressure, shear stress and Johnson's slip."""
    (a,) = hertz()["contact_radius"]
    e_star, radius, friction = STEEL / 2, 0.01, 0.3
    c = a / 3 ** (1 / 3)
    radii = [0.0, 2e-5, 4e-5, 6e-5, 7e-5, 8e-5, 9e-5]
    peak = 2 * e_star / (pi * radius)

    def root(edge: float, r: float) -> float:
        return sqrt(edge**2 - r**2) if r < edge else 0.0

    def slip(r: float) -> float:
        if not c < r < a:
            return 0.0
        scale = friction * STEEL / STEEL_SHEAR / (pi * radius)
        return scale * ((2 * c**2 - r**2) * (pi / 2 - asin(c / r)) - c * sqrt(r**2 - c**2))

    return {
        "radius": radii,
        "pressure": [[peak * root(a, r) for r in radii]],
        "shear_stress": [[friction * peak * (root(a, r) - root(c, r)) for r in radii]],
        "slip": [[slip(r) for r in radii]],
    }


def sneddon_fields() -> dict[str, object]:
    """Love 1939: p = E* tan θ arcosh(a/r)/2."""
    e_star, slope = 1e9, 0.1
    radii = [0.0, 0.0005, 0.001, 0.0015]
    return {
        "radius": radii,
        "pressure": [
            [None, *(e_star * slope / 2 * acosh(a / r) if r < a else 0.0 for r in radii[1:])]
            for a in (0.001, 0.002)
        ],
    }


def boussinesq_fields() -> dict[str, object]:
    """Boussinesq 1885: p = E* d/(π √(a² − r²)), and 2 d arcsin(a/r)/π around it."""
    a, depth = 0.005, 1e-4
    return {
        "radius": [0.0, 0.004, 0.006, 0.01],
        "pressure": [[*(RUBBER * depth / (pi * sqrt(a**2 - r**2)) for r in (0.0, 0.004)), 0, 0]],
        "normal_displacement": [
            [depth, depth, *(2 * depth / pi * asin(a / r) for r in (0.006, 0.01))]
        ],
        "foundation_load": [[RUBBER * depth, RUBBER * depth, 0.0, 0.0]],
    }


E_STAR, G_STAR, BALL, FRICTION = 115e9, 95e9, 0.01, 0.3
DEPTH, STICK = 1e-6, 5e-5


def worn_ball_profile(r: float, c: float, depth: float) -> float:
    """Eqs. (5.83), (5.85), inside the worn annulus."""
    annulus = c * r / (pi * BALL) * sqrt(1 - (c / r) ** 2)
    return depth - 2 / pi * (depth - r**2 / (2 * BALL)) * asin(c / r) - annulus


def worn_annulus(c: float, depth: float) -> tuple[float, float]:
    """Eq. (5.88) for the wear radius, and the integral of the worn depth up to it."""
    low, high = c * (1 + 1e-9), sqrt(2 * depth * BALL)
    for _ in range(100):
        middle = (low + high) / 2
        worn = worn_ball_profile(middle, c, depth) > middle**2 / (2 * BALL)
        low, high = (middle, high) if worn else (low, middle)
    s, angle = sqrt(high**2 - c**2), acos(c / high)
    lens = (high**2 * angle - c * s) / 2
    moment = high**4 / 8 * angle + c * s * (high**2 - 2 * c**2) / 8
    return high, 4 * (depth * lens - moment / BALL)


def shakedown() -> dict[str, object]:
    """Eqs. (5.80), (5.85), (5.88), (5.90) for c = a/2 at constant depth."""
    end, volume = worn_annulus(STICK, DEPTH)
    radii = [0.0, 4e-5, 7e-5, 1e-4, 1.2e-4, 1.5e-4]
    before = [r**2 / (2 * BALL) for r in radii]
    return {
        "stick_radius": [STICK],
        "wear_radius": [end],
        "normal_force": [2 * E_STAR * (DEPTH * STICK - STICK**3 / (3 * BALL))],
        "worn_volume": [volume],
        "initial_profile": before,
        "limiting_profile": [
            [
                worn_ball_profile(r, STICK, DEPTH) if STICK < r < end else f
                for r, f in zip(radii, before, strict=True)
            ]
        ],
    }


def fretted(tangential_force: float, force: float = 10.0) -> tuple[float, float, float, float]:
    """Constant forces: c by Eq. (5.16), and F_x = 2 µ E* c (d − c²/R); gives annulus and volume."""
    a = (3 * force * BALL / (4 * E_STAR)) ** (1 / 3)
    c = a * (1 - tangential_force / (FRICTION * force)) ** (1 / 3)
    depth = c**2 / BALL + tangential_force / (2 * FRICTION * E_STAR * c)
    return c, depth, *worn_annulus(c, depth)


def amplitudes() -> dict[str, object]:
    annuli = [fretted(tangential_force) for tangential_force in (1.0, 2.0, 2.9)]
    a = fretted(0.0)[0]
    return {
        "stick_radius": [a, *(annulus[0] for annulus in annuli)],
        "indentation_depth": [a**2 / BALL, *(annulus[1] for annulus in annuli)],
        "wear_radius": [a, *(annulus[2] for annulus in annuli)],
        "worn_volume": [0.0, *(annulus[3] for annulus in annuli)],
        "regime": ["stick"] + ["partial_slip"] * 3,
    }


def unbounded() -> dict[str, object]:
    c, depth, end, volume = fretted(2.0)
    depths = [0.0, 0.0, worn_ball_profile(1e-4, c, depth) - 1e-8 / (2 * BALL)]
    return {
        "stick_radius": [c, 0.0],
        "wear_radius": [end, None],
        "worn_volume": [volume, None],
        "worn_depth": [depths, [None] * 3],
        "regime": ["partial_slip", "full_slip"],
    }


def constant_force() -> dict[str, object]:
    """Eq. (5.90): F_N = (4/3) E* √R √(d − w) (d + w/2), w = G* u/(µ E*)."""
    w, force = G_STAR * 2e-7 / (FRICTION * E_STAR), 10.0
    low, high = w, 1e-5
    for _ in range(100):
        d = (low + high) / 2
        bears = 4 / 3 * E_STAR * sqrt(BALL) * sqrt(d - w) * (d + w / 2)
        low, high = (d, high) if bears < force else (low, d)
    return {"indentation_depth": [d], "stick_radius": [sqrt(BALL * (d - w))]}


def wear_of_cycles() -> dict[str, object]:
    """The first cycle wears K W, and Eqs. (5.80)-(5.90) describe the limit."""
    a, c = sqrt(DEPTH * BALL), STICK
    work = 16 * FRICTION**2 * E_STAR**2 / (15 * G_STAR * BALL**2)
    first = work * (a - c) ** 3 * (a**2 + 3 * a * c + c**2)
    end, volume = worn_annulus(c, DEPTH)
    return {
        "cycles": [0.0, 1.0, 1e5, 1e6, 1e8],
        "worn_volume": [0.0, 1e-14 * first, None, None, volume],
        "dissipated_energy": [0.0, first, None, None, volume / 1e-14],
        "contact_radius": [a, a, None, None, end],
        "stick_radius": [c] * 5,
    }


def wear_at_constant_forces() -> dict[str, object]:
    c, _, _, _ = fretted(2.0)
    return {"normal_force": [10.0] * 5, "stick_radius": [c] * 5}


def wear_in_full_slip() -> dict[str, object]:
    """Archard's law: K mu F_N times the distance, less the elastic 8 K mu lambda U, U = 2 F d/5."""
    each = 1e-14 * 0.3 * 25 * 4 * 0.005
    return {
        "normal_force": [25.0] * 5,
        "stick_radius": [0.0] * 5,
        "worn_volume": [each, 10 * each, 100 * each, 1e3 * each, 5e3 * each],
    }


TEXTBOOK = {
    "hertz": hertz,
    "boussinesq": boussinesq,
    "sneddon": sneddon,
    "exact_sphere": exact_sphere,
    "worn_ball": worn_ball,
    "adhesive_ball": adhesive_ball,
    "table": table,
}
TANGENTIAL_TEXTBOOK = {
    "cattaneo_mindlin": cattaneo_mindlin,
    "truman": truman,
    "flat_punch": flat_punch,
}
HISTORY_TEXTBOOK = {
    "mindlin_deresiewicz": mindlin_deresiewicz,
    "residual": residual,
    "oblique": oblique,
    "carried_on": carried_on,
    "cone_with_a_gap": cone_with_separation,
}
STRESS_TEXTBOOK = {
    "cattaneo_mindlin": cattaneo_mindlin_fields,
    "sneddon": sneddon_fields,
    "boussinesq": boussinesq_fields,
}
WEAR_TEXTBOOK = {
    "shakedown": shakedown,
    "amplitudes": amplitudes,
    "endless": unbounded,
    "held_force": constant_force,
}
EVOLUTION_TEXTBOOK = {
    "shakedown": wear_of_cycles,
    "held_forces": wear_at_constant_forces,
    "reciprocating": wear_in_full_slip,
}
# Validity warnings that concern wear itself.
WEAR_WARNINGS = {
    "amplitudes": {"no_wear"},
    "endless": {"endless_wear"},
    "held_force": {"path_dependent"},
}
# Tips and edges that no real material withstands, and slopes at which 0.63 |beta| t + t^2 exceeds 1
# %.
WARNINGS = {
    "boussinesq": {"plastic"},
    "cone_with_a_gap": {"plastic"},
    "exact_sphere": {"half_space"},
    "flat_punch": {"plastic"},
    "sneddon": {"half_space", "plastic"},
    "adhesive_ball": set(),
    "table": {"half_space"},
    "truman": set(),
    "worn_ball": {"half_space", "plastic"},
}
CASES = [
    pytest.param(path, name, examples[name]["value"], textbook, id=f"{path} {name}")
    for path, examples, textbooks in (
        ("/v1/normal", EXAMPLES["normal"], TEXTBOOK),
        ("/v1/tangential", EXAMPLES["tangential"], TANGENTIAL_TEXTBOOK),
        ("/v1/tangential/history", EXAMPLES["history"], HISTORY_TEXTBOOK),
        ("/v1/stress", EXAMPLES["stress"], STRESS_TEXTBOOK),
        ("/v1/wear", EXAMPLES["wear"], WEAR_TEXTBOOK),
    )
    for name, textbook in textbooks.items()
]


def test_every_example_has_a_textbook_reference() -> None:
    assert set(TEXTBOOK) == set(EXAMPLES["normal"])
    assert set(TANGENTIAL_TEXTBOOK) == set(EXAMPLES["tangential"])
    assert set(HISTORY_TEXTBOOK) == set(EXAMPLES["history"])
    assert set(WEAR_TEXTBOOK) == set(EXAMPLES["wear"])
    assert set(EVOLUTION_TEXTBOOK) == set(EXAMPLES["evolution"])
    # The stresses of the rounded punch have no closed form, but their integrals do.
    assert {*STRESS_TEXTBOOK, "rounded_punch"} == set(EXAMPLES["stress"])


def same(result: object, expected: object) -> None:
    """Compare numbers to twelve digits of the largest, all else exactly."""
    if isinstance(expected, list) and expected and isinstance(expected[0], list):
        assert isinstance(result, list)
        for one, other in zip(result, expected, strict=True):
            same(one, other)
    elif isinstance(expected, list) and expected and not isinstance(expected[0], str):
        assert result is not None
        given = [inf if value is None else value for value in result]
        wanted = [inf if value is None else value for value in expected]
        assert given == pytest.approx(wanted, rel=1e-12, abs=0)
    else:
        assert result == expected


@pytest.mark.parametrize(("path", "name", "query", "textbook"), CASES)
def test_example_gives_the_textbook_result(
    client: Client,
    path: str,
    name: str,
    query: dict[str, Any],
    textbook: Callable[[], dict[str, object]],
) -> None:
    answer = client.post(path, query)
    assert answer.status_code == 200
    document = answer.json()
    for quantity, expected in textbook().items():
        same(document[quantity], expected)
    codes = {warning["code"] for warning in document.pop("warnings")}
    if path == "/v1/wear":
        assert codes == WEAR_WARNINGS.get(name, set())
        return
    assert codes == WARNINGS.get(name, set()) | (
        {"singular"} if "null" in json.dumps(document) else set()
    )


@pytest.mark.every(2)
@pytest.mark.parametrize("name", EXAMPLES["evolution"])
def test_wear_evolution_matches_its_limits(client: Client, name: str) -> None:
    document = client.post("/v1/wear/evolution", EXAMPLES["evolution"][name]["value"]).json()
    for quantity, values in EVOLUTION_TEXTBOOK[name]().items():
        for result, expected in zip(document[quantity], values, strict=True):
            if expected is not None:
                assert result == pytest.approx(expected, rel=2e-3, abs=0), quantity


def test_stresses_of_the_rounded_punch_integrate_to_its_forces(client: Client) -> None:
    """F_N by Eq. (5.61) and F_x by Eq. (5.65), against the integrals of the computed fields."""
    answer = client.post("/v1/stress", EXAMPLES["stress"]["rounded_punch"]["value"]).json()
    radius, b, a, c, friction = 0.05, 0.004, 0.005, 0.0045, 0.5

    def force(edge: float) -> float:
        s = sqrt(edge**2 - b**2)
        depth = edge / radius * (s - b * acos(b / edge))
        return RUBBER * edge * depth + RUBBER * s**3 / (3 * radius)

    for name, expected in (
        ("pressure", force(a)),
        ("shear_stress", friction * (force(a) - force(c))),
    ):
        (values,), r = answer[name], answer["radius"]
        rings = zip(zip(r, values, strict=True), zip(r[1:], values[1:], strict=True), strict=False)
        total = sum(pi * (q + p) * (v - u) * (u + v) / 2 for (u, p), (v, q) in rings)
        assert total == pytest.approx(expected, rel=1e-3, abs=0)
