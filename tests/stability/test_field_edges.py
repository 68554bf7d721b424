"""Fields next to edges that follow from a load err by the rounding of the load at most."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import acos, acosh, cbrt, isfinite, log, mpf, pi, root, sin, sqrt, workdps

from mdr_core import fields, history, normal, subsurface, tangential
from mdr_core.profiles import Cone, Paraboloid, Power, Profile
from tests.core.comparison import profile_from, stored
from tests.oracles import slip_reference
from tests.oracles.slip_reference import Material, setting

MU, RTOL = 0.4, 1e-13
MATERIAL = Material(1.0, 0.8, MU)
R = np.linspace(0.0, 1.2, 30)
SHAPES: dict[str, tuple[dict[str, Any], float]] = stored("profiles")["beside_edges"]
#: Fractions of full slip: slip annuli from about 1e-10 a to most of the contact.
FRACTIONS = (1e-10, 1e-5, 0.01, 0.5, 0.99)
FIELDS = ("pressure", "shear_stress", "slip", "normal_displacement")


def solved(
    name: str, fraction: float, control: str
) -> tuple[tangential.TangentialContact, Any, mpf]:
    """A contact under prescribed forces, with its exact loads and stick radius."""
    shape, a = SHAPES[name]
    profile = profile_from(shape)
    force = float(normal.solve(profile, 1.0, contact_radius=a).normal_force)
    contact = normal.solve(profile, 1.0, normal_force=force)
    full = MU * force
    if control == "tangential_displacement":
        full = MU / 0.8 * float(contact.indentation_depth)
    given = full * fraction
    at = setting(shape, "normal_force", force, MATERIAL)
    c = slip_reference.solve(at, control, given, energy=False).c
    return tangential.solve(contact, 0.8, MU, **{control: given}), at, c


def field_error(
    contact: tangential.TangentialContact, at: Any, c: mpf, name: str, radii: np.ndarray
) -> float:
    truths = {
        "pressure": lambda r: slip_reference.traction(at, mpf(0), r),
        "shear_stress": lambda r: MU * slip_reference.traction(at, c, r),
        "slip": lambda r: slip_reference.slip(at, c, r),
        "normal_displacement": lambda r: slip_reference.displacement(at, r),
    }
    source = contact.normal if name in ("pressure", "normal_displacement") else contact
    field = getattr(fields, name)
    usual = field(source, fields.grid(contact, 60))
    largest = float(np.max(np.abs(usual[np.isfinite(usual)])))
    exact = [truths[name](mpf(r)) for r in radii.tolist()]
    result = field(source, radii).tolist()
    errors = [abs(value - r) for value, r in zip(result, exact, strict=True) if isfinite(r)]
    return float(max(errors)) / largest


def estimate(contact: tangential.TangentialContact, name: str, radii: np.ndarray) -> float:
    return max(contact.error_estimate, RTOL) + fields.edge_error(contact, name, radii)


@pytest.mark.every(11)
@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("shape", SHAPES)
def test_error_within_estimate_on_a_grid(shape: str, fraction: float) -> None:
    contact, at, c = solved(shape, fraction, "tangential_force")
    radii = fields.grid(contact, 10)
    for name in FIELDS:
        assert field_error(contact, at, c, name, radii) <= estimate(contact, name, radii), name


@pytest.mark.every(7)
@pytest.mark.parametrize("control", ["tangential_force", "tangential_displacement"])
@pytest.mark.parametrize("shape", SHAPES)
def test_error_within_estimate_next_to_the_edges(shape: str, control: str) -> None:
    for fraction in (1e-5, 0.5):
        contact, at, c = solved(shape, fraction, control)
        for offset in (1e-14, 1e-12, 1e-9):
            ends = float(contact.stick_radius), float(contact.normal.contact_radius)
            radii = np.array([end * (1 + side * offset) for end in ends for side in (-1, 1)])
            for name in FIELDS:
                error = field_error(contact, at, c, name, radii)
                assert error <= estimate(contact, name, radii), (name, fraction, offset)


@pytest.mark.parametrize("shape", SHAPES)
def test_grid_is_as_accurate_as_single_radii(shape: str) -> None:
    """Where the slip annulus is not thin itself, the edges add 1e-12 at most, times two."""
    contact, _, _ = solved(shape, 0.5, "tangential_force")
    radii = fields.grid(contact, 100)
    if shape != "thin annulus":
        assert all(fields.edge_error(contact, name, radii) <= 2.5e-12 for name in FIELDS)


def test_prescribed_edges_are_exact() -> None:
    contact = normal.solve(profile_from(SHAPES["sphere"][0]), 1.0, contact_radius=0.5)
    pushed = tangential.solve(contact, 0.8, MU, stick_radius=0.3)
    radii = fields.grid(pushed, 30)
    assert {0.3, 0.5} <= set(radii.tolist())
    for name in FIELDS:
        assert fields.edge_error(pushed, name, radii) == 0


@pytest.mark.parametrize("shape", ["paraboloid", "cone"])
def test_edges_of_a_sweep_match_single_loads(shape: str) -> None:
    """The last load is next to full slip, where the stick radius is ill-conditioned."""
    profile = profile_from(SHAPES[shape][0])
    forces = normal.solve(profile, 1.0, contact_radius=[0.4, 0.5, 0.6]).normal_force
    pushed = MU * forces * np.array([0.2, 0.5, 1 - 1e-11])

    def solve(at: Any) -> tangential.TangentialContact:
        contact = normal.solve(profile, 1.0, normal_force=forces[at])
        return tangential.solve(contact, 0.8, MU, tangential_force=pushed[at])

    together, alone = solve(slice(None)), [solve(load) for load in range(3)]
    for radii in (np.linspace(0.0, 0.6, 40), np.array([float(alone[1].stick_radius) * 0.999])):
        for name in FIELDS:
            errors = [fields.edge_error(each, name, radii) for each in alone]
            assert fields.edge_error(together, name, radii) == pytest.approx(
                max(errors), rel=1e-9, abs=0
            )
    assert together.error_estimate == max(each.error_estimate for each in alone)


def just_below_full_slip(seed: int) -> tuple[Any, float, float, mpf, mpf]:
    """A paraboloid in any units, a force just below µF_N, and the exact radii a and c."""
    rng = np.random.default_rng(seed)
    curvature, modulus, force = 10 ** rng.uniform((-3, -3, -6), (3, 12, 6))
    mu = rng.uniform(0.05, 1.0)
    contact = normal.solve(Paraboloid(curvature), modulus, normal_force=force)
    pushed = mu * force * (1 - 10 ** rng.uniform(-13, -6))
    pushed = float(np.nextafter(mu * force, 0.0)) if seed % 2 else pushed
    with workdps(40):
        a = cbrt(3 * mpf(force) * mpf(curvature) / (4 * mpf(modulus)))
        c = a * cbrt(max(1 - mpf(pushed) / (mpf(mu) * mpf(force)), 0))
    return contact, mu, pushed, a, c


def hertzian(contact: Any, mu: float, a: mpf, c: mpf, radii: np.ndarray) -> list[mpf]:
    """Shear stress of Cattaneo and Mindlin, Eq. (5.38)."""
    with workdps(40):
        scale = 2 * mpf(mu) * mpf(contact.e_star) / (pi * mpf(contact.profile.radius))
        return [
            scale * (sqrt(a * a - r * r) - (sqrt(c * c - r * r) if r < c else 0))
            for r in map(mpf, radii.tolist())
        ]


@pytest.mark.parametrize("seed", range(40))
def test_estimate_next_to_full_slip_is_that_of_the_stick_zone(seed: int) -> None:
    """An ill-conditioned stick radius changes stresses by c/a inside it, and not at all outside."""
    contact, mu, pushed, a, c = just_below_full_slip(seed)
    single = tangential.solve(contact, 0.8 * contact.e_star, mu, tangential_force=pushed)
    force = float(contact.normal_force)
    path = history.solve(
        contact.profile,
        contact.e_star,
        0.8 * contact.e_star,
        mu,
        normal_force=force,
        tangential_force=[0.0, pushed],
    )
    inside = np.array([0.0, 0.5, 0.9]) * float(single.stick_radius)
    outside = np.array([0.3, 0.6]) * float(contact.contact_radius)
    for radii in (inside, outside):
        exact = hertzian(contact, mu, a, c, np.append(radii, outside))
        # A history within rounding error of full slip is in full slip.
        sources = [(single, single), (path, path.state)][: 1 if seed % 2 else 2]
        for whole, source in sources:
            at = np.append(radii, outside)
            found = fields.shear_stress(source, at).tolist()
            error = max(abs(mpf(x) - y) for x, y in zip(found, exact, strict=True)) / max(exact)
            bound = fields.own_error(whole) + fields.edge_error(source, "shear_stress", at)
            assert error <= bound
            assert bound <= (1e-5 if radii is inside else 1e-9)
    # A response states four times this bound.
    places = np.append(0.0, outside), 0.0, [[0.0], [0.3 * float(contact.contact_radius)]]
    assert subsurface.error_estimate(single, *places) <= 1e-5 / 4


#: Profiles of one exponent n, and g(x)/x^n.
TIPS: dict[str, tuple[Profile, int, mpf]] = {
    "cone": (Cone(0.2), 1, pi / 2 * mpf(0.2)),
    "paraboloid": (Paraboloid(2.0), 2, 1 / mpf(2.0)),
    "quartic": (Power(0.3, 4.0), 4, mpf(8) / 3 * mpf(0.3)),
}


def one_unit_below(name: str, force: float) -> tuple[tangential.TangentialContact, mpf, mpf]:
    """A contact one unit in the last place below full slip, and the exact radii a and c."""
    profile, n, height = TIPS[name]
    contact = normal.solve(profile, 1.0, normal_force=force)
    pushed = float(np.nextafter(MU * force, 0.0))
    left = mpf(force) - mpf(pushed) / mpf(MU)
    radii = (root(load * (n + 1) / (2 * n * height), n + 1) for load in (mpf(force), left))
    return tangential.solve(contact, 1.0, MU, tangential_force=pushed), *radii


def traction(name: str, a: mpf, c: mpf, r: mpf) -> mpf:
    """(mu/pi) int g'(x)/sqrt(x^2 - r^2) dx from c or r to a."""
    _, n, height = TIPS[name]

    def below(x: mpf) -> mpf:
        if n == 1:
            return log(x) if r == 0 else acosh(max(x / r, 1))
        rise = sqrt(max(x * x - r * r, 0))
        return 2 * rise if n == 2 else 4 * rise**3 / 3 + 4 * r * r * rise

    return MU * height / pi * (below(a) - below(c))


def slip(name: str, _: mpf, c: mpf, r: mpf) -> mpf:
    """-(2 mu/pi) int (g(x) - g(c))/sqrt(r^2 - x^2) dx from c to r, with x = r cos t."""
    _, n, height = TIPS[name]
    t = acos(min(c / max(r, c), 1))
    power = {1: sin(t), 2: t / 2 + sin(2 * t) / 4, 4: (12 * t + 8 * sin(2 * t) + sin(4 * t)) / 32}
    return -2 * MU * height / pi * (r**n * power[n] - c**n * t)


#: Radii over c and over a, which are next to the stick edge, far away, or both.
NEXT, FAR = np.array([0.1, 0.99, 1 - 1e-9, 1.0, 1.001, 2.0]), np.array([0.0, 0.1, 0.5, 0.9])
PLACES = (NEXT, FAR), (0 * FAR, FAR), (NEXT, 0 * FAR)


@pytest.mark.parametrize("force", [0.7, 1.1, 1.9, 2.3, 5.9])
@pytest.mark.parametrize("field", [traction, slip])
@pytest.mark.parametrize("name", TIPS)
def test_estimate_one_unit_below_full_slip(name: str, field: Any, force: float) -> None:
    """The estimate exceeds the error by at most ten times what the error of c may change."""
    with workdps(40):
        contact, a, c = one_unit_below(name, force)
        at, moved = mpf(float(contact.stick_radius)), mpf(float(contact.stick_error))
        evaluated = fields.slip if field is slip else fields.shear_stress
        for inner, outer in PLACES:
            radii = np.append(inner * float(at), outer * float(a))
            exact, *ends = (
                [field(name, a, edge, mpf(r)) for r in radii.tolist()]
                for edge in (c, at - moved, at + moved)
            )
            largest = max(map(abs, exact))
            error, *possible = (
                max(abs(x - y) for x, y in zip(values, exact, strict=True)) / largest
                for values in (evaluated(contact, radii).tolist(), *ends)
            )
            field_name = evaluated.__name__
            bound = fields.own_error(contact) + fields.edge_error(contact, field_name, radii)
            assert error <= bound <= 10 * max(possible) + 1e-11


@pytest.mark.parametrize("force", [0.7, 1.1, 1.9, 2.3, 5.9])
@pytest.mark.parametrize("name", TIPS)
def test_estimate_beneath_one_unit_below_full_slip(name: str, force: float) -> None:
    """The reference has the exact stick radius, prescribed."""
    with workdps(40):
        contact, _, true = one_unit_below(name, force)
    exact = tangential.solve(contact.normal, 1.0, MU, stick_radius=float(true))
    a, c = float(contact.normal.contact_radius), float(contact.stick_radius)
    depths = np.array([0.0, 1e-6 * c, 0.1 * c, c, 0.1 * a])[:, None]
    for radii in (c * np.array([0.5, 0.999, 1.0, 1.001, 3.0]), a * np.array([0.1, 0.5])):
        found, truth = (
            np.array(subsurface.stress(one, radii, 0.0, depths, poissons_ratio=0.5, body=2))
            for one in (contact, exact)
        )
        error = np.abs(found - truth).max() / np.abs(truth).max()
        bound = subsurface.error_estimate(contact, radii, 0.0, depths)
        assert error <= bound <= (0.1 if name == "cone" else 1e-5)
        assert bound <= 1e-10 or radii[-1] < a / 100
