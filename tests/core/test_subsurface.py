"""Stresses beneath the surface have their closed forms, balance and far field."""

from __future__ import annotations

import itertools
from math import pi
from typing import TYPE_CHECKING

import numpy as np
import pytest

from mdr_core import fields, normal, tangential
from mdr_core import history as load_history
from mdr_core.errors import InputError
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    FlatPunch,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedCone,
    RoundedPunch,
    Tabulated,
)
from mdr_core.subsurface import StressTensor, error_estimate, largest, stress

if TYPE_CHECKING:
    from mdr_core.history import ContactState, LoadHistory
    from mdr_core.tangential import TangentialContact

E_STAR, FRICTION = 3.0, 0.3


def normal_contact(profile: Profile) -> normal.NormalContact:
    if isinstance(profile, FlatPunch):
        return normal.solve(profile, E_STAR, indentation_depth=0.2)
    return normal.solve(profile, E_STAR, contact_radius=1.0)


def tangential_contact(profile: Profile, stick: float) -> tangential.TangentialContact:
    contact = normal_contact(profile)
    if stick > 0:
        return tangential.solve(contact, 2.6, FRICTION, stick_radius=stick)
    return tangential.solve(contact, 2.6, FRICTION, tangential_displacement=100.0)


def test_flat_punch() -> None:
    """Sneddon 1946: sigma_zz = -p_m (1 + 3 z^2)/(2 (1 + z^2)^2) on the axis."""
    contact, z = normal_contact(FlatPunch(1.0)), np.linspace(0, 5, 30)
    result = stress(contact, 0.0, 0.0, z, poissons_ratio=0.3)
    mean = float(contact.mean_pressure)
    expected = -mean * (1 + 3 * z * z) / (2 * np.square(1 + z * z))
    assert np.abs(result.zz - expected).max() < 1e-14 * mean
    edge = stress(contact, 1.0, 0.0, 0.0, poissons_ratio=0.3)
    assert np.isinf(edge.von_mises)
    assert np.isinf(edge.maximum_shear)
    assert not any(np.isnan(part) for part in edge)


def point_force(
    x: np.ndarray, y: np.ndarray, z: np.ndarray, nu: float, normal_force: float, shear: float
) -> np.ndarray:
    """Boussinesq's and Cerruti's solutions: Johnson, Eqs. (3.21), (3.67)."""
    rho = np.sqrt(x * x + y * y + z * z)
    r2, m = x * x + y * y, 1 - 2 * nu
    p = normal_force / (2 * pi)

    def in_plane(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        bracket = (1 - z / rho) * (u * u - v * v) / r2 + z * v * v / rho**3
        return p * (m / r2 * bracket - 3 * z * u * u / rho**5)

    xy = m / r2 * ((1 - z / rho) * 2 * x * y / r2 - x * y * z / rho**3)
    xy = p * (xy - 3 * x * y * z / rho**5)
    normal_contact = [
        in_plane(x, y),
        in_plane(y, x),
        -3 * p * z**3 / rho**5,
        xy,
        -3 * p * x * z * z / rho**5,
        -3 * p * y * z * z / rho**5,
    ]
    q, s = shear / (2 * pi), rho + z
    c1, c2 = 1 / (rho * s**2), (3 * rho + z) / (rho**3 * s**3)
    cerruti = [
        -3 * x**3 / rho**5 + m * (x / rho**3 - 3 * x * c1 + x**3 * c2),
        -3 * x * y * y / rho**5 + m * (x / rho**3 - x * c1 + x * y * y * c2),
        -3 * x * z * z / rho**5,
        -3 * x * x * y / rho**5 + m * (-y * c1 + x * x * y * c2),
        -3 * x * x * z / rho**5,
        -3 * x * y * z / rho**5,
    ]
    return np.array(normal_contact) + q * np.array(cerruti)


POINTS = np.array([[0.3, 0.2, 0.6], [-0.9, 0.4, 0.5], [1.4, -0.3, 0.7], [0.05, 0.0, 1.2]])


def superposed(
    contact: normal.NormalContact, partial: TangentialContact | ContactState, stops: list[float]
) -> np.ndarray:
    """By definition: stresses at `POINTS` with the surface tractions as point forces."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    # r = stop - width s^2 from either side removes the roots at the stops.
    r, mass = [], []
    for low, high in itertools.pairwise(stops):
        s, at = (1 + nodes) / 2, (low + high) / 2
        for end in (low, high):
            r.append(end + (at - end) * s * s)
            mass.append(np.abs(at - end) * s * weights)
    radius, shares = np.concatenate(r), np.concatenate(mass)
    p = fields.pressure(contact, radius)
    tau = fields.shear_stress(partial, radius)
    angle = 2 * pi * np.arange(96) / 96
    around = 2 * pi / 96 * (radius * shares)[:, None]
    total = []
    for x, y, z in POINTS:
        dx = x - radius[:, None] * np.cos(angle)
        dy = y - radius[:, None] * np.sin(angle)
        depth = np.full_like(dx, z)
        unit = point_force(dx, dy, depth, 0.3, 1.0, 0.0)
        shear = point_force(dx, dy, depth, 0.3, 0.0, 1.0)
        total.append(((unit * p[:, None] + shear * tau[:, None]) * around).sum(axis=(1, 2)))
    return np.array(total)


@pytest.mark.parametrize("profile", [Paraboloid(2.0), RoundedPunch(0.5, 2.0), FlatPunch(1.0)])
def test_superposed_point_forces(profile: Profile) -> None:
    if isinstance(profile, FlatPunch):
        contact = tangential.solve(normal_contact(profile), 2.6, FRICTION, tangential_force=0.1)
    else:
        contact = tangential_contact(profile, 0.7)
    stops = [0.0, 1.0] if isinstance(profile, FlatPunch) else [0.0, 0.5, 0.7, 1.0]
    expected = superposed(contact.normal, contact, stops)
    result = np.array(stress(contact, *POINTS.T, poissons_ratio=0.3, body=2)).T
    assert np.abs(result - expected).max() < 2e-10 * np.abs(result).max()


TABLE = Tabulated(np.linspace(0, 1.4, 29), np.linspace(0, 1.4, 29) ** 2 / 4)
# Reversed, oblique and nonlinear load paths that end at contact radius 1.
PATHS = {
    "reversed": (
        "indentation_depth",
        [1.0, 1.0, 1.0],
        "tangential_displacement",
        [0.2, -0.1, 0.05],
    ),
    "oblique": ("indentation_depth", [0.6, 1.2, 1.0], "tangential_displacement", [0.1, 0.25, 0.1]),
    "curved": ("normal_force", [0.7, 1.2, 1.0], "tangential_displacement", [0.1, 0.2, 0.05]),
}


def at_end(profile: Profile, name: str) -> tuple[normal.NormalContact, LoadHistory]:
    contact = normal_contact(profile)
    control, loads, other, displacements = PATHS[name]
    size = float(contact.indentation_depth)
    loads = [part * float(getattr(contact, control)) for part in loads]
    given = {control: loads, other: [part * size for part in displacements]}
    return contact, load_history.solve(profile, E_STAR, 2.6, FRICTION, **given)


@pytest.mark.parametrize("count", [9, 200])
@pytest.mark.parametrize("flat", [0.0, 0.5])
def test_tables_that_are_exact(flat: float, count: int) -> None:
    """Points of a paraboloid, or of a rounded punch with its break, have one shape.

    The last digits of 200 heights leave 1e-10 of the stress.
    """
    r = np.unique(np.append(np.linspace(0, 1.4, count), flat))
    heights = np.square(np.maximum(r - flat, 0.0)) / 4
    table = Tabulated(r, heights, (flat,) if flat else ())
    body = RoundedPunch(flat, 2.0) if flat else Paraboloid(2.0)
    rng = np.random.default_rng(4)
    x, z = rng.uniform(-1.6, 1.6, 400), 10 ** rng.uniform(-12, 1, 400)
    x[:100] = rng.choice([0.0, 0.7, 1.0], 100) + rng.choice([-1, 1], 100) * z[:100]
    z[100:150] = 0.0
    result, expected = (
        np.array(stress(tangential_contact(one, 0.7), x, 0.1 * x, z, poissons_ratio=0.3))
        for one in (table, body)
    )
    assert np.abs(result - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.every(4)
@pytest.mark.parametrize("name", PATHS)
@pytest.mark.parametrize(
    "profile", [Paraboloid(2.0), Cone(0.2), Power(0.3, 1.6), RoundedPunch(0.5, 2.0), TABLE]
)
def test_end_of_a_history_by_superposed_point_forces(profile: Profile, name: str) -> None:
    contact, history = at_end(profile, name)
    fronts = history.slip_fronts.tolist()
    breaks = [0.5] if isinstance(profile, RoundedPunch) else []
    if profile is TABLE:
        breaks = profile.r[1:20].tolist()
    stops = sorted({0.0, 1.0, *fronts, *breaks})
    expected = superposed(contact, history.state, stops)
    result = np.array(stress(history.state, *POINTS.T, poissons_ratio=0.3, body=2)).T
    assert fronts
    assert np.abs(result - expected).max() < 1e-8 * np.abs(result).max()


@pytest.mark.parametrize("profile", [Paraboloid(2.0), RoundedPunch(0.5, 2.0), FlatPunch(1.0)])
def test_end_of_a_monotonic_history_is_the_tangential_contact(profile: Profile) -> None:
    contact = normal_contact(profile)
    force = 0.6 * FRICTION * float(contact.normal_force)
    loads = {"normal_force": float(contact.normal_force), "tangential_force": [0.0, force]}
    history = load_history.solve(profile, E_STAR, 2.6, FRICTION, **loads)
    once = tangential.solve(contact, 2.6, FRICTION, tangential_force=force)
    x, z = np.linspace(-1.4, 1.4, 29), np.array([0.0, 1e-9, 0.1, 0.8])[:, None]
    for body in (1, 2):
        given = {"poissons_ratio": 0.3, "body": body}
        result, expected = (
            np.array(stress(one, x, 0.2, z, **given)) for one in (history.state, once)
        )
        assert np.abs(result - expected).max() < 1e-9 * np.abs(expected).max()
    peaks = [float(largest(one, poissons_ratio=0.3).value) for one in (history.state, once)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-5, abs=0)


@pytest.mark.parametrize("name", PATHS)
def test_tractions_at_the_end_of_a_history(name: str) -> None:
    contact, history = at_end(RoundedPunch(0.5, 2.0), name)
    # Not at the edge, where the pressure has a root: its rounding differs from that of the radius.
    r = np.concatenate([np.linspace(0, 1.5, 62), [1 - 1e-9], history.slip_fronts])
    result = stress(history.state, r, 0.0, 0.0, poissons_ratio=0.3, body=2)
    p, tau = fields.pressure(contact, r), fields.shear_stress(history.state, r)
    assert np.abs(result.zz + p).max() < 1e-9 * p.max()
    error, fronts = np.abs(result.xz + tau), len(history.slip_fronts)
    assert error[:-fronts].max() < 1e-9 * p.max()
    # The stress has a root in the distance from a slip front, and so in its rounding error.
    assert error[-fronts:].max() < 1e-7 * p.max()


@pytest.mark.parametrize("stick", [0.0, 0.6])
@pytest.mark.parametrize("profile", [Paraboloid(2.0), Cone(0.2), RoundedPunch(0.5, 2.0)])
def test_tractions_on_the_surface(profile: Profile, stick: float) -> None:
    if isinstance(profile, RoundedPunch) and stick == 0:
        stick = 0.7
    contact = tangential_contact(profile, stick)
    # At 1 - 1e-7 a rounding error of the radius changes the pressure by 5e-13 of the largest.
    r = np.concatenate([np.linspace(0.01, 2, 60), 1 + np.array([-1e-7, 1e-7]), [stick or 0.5, 1.0]])
    for angle in (0.0, 2.1):
        if angle:
            # The distance of x and y from the axis is rounded, and tau has a root in that from c.
            r = r[:-2]
        p, tau = fields.pressure(contact.normal, r), fields.shear_stress(contact, r)
        x, y = r * np.cos(angle), r * np.sin(angle)
        for body, sign in ((1, -1), (2, 1)):
            result = stress(contact, x, y, 0.0, poissons_ratio=0.3, body=body)
            largest = p.max()
            assert np.abs(result.zz + p).max() < 1e-12 * largest
            assert np.abs(result.xz + sign * tau).max() < 1e-12 * largest
            assert np.abs(result.yz).max() < 1e-12 * largest


def test_equilibrium() -> None:
    """The divergence vanishes, evaluated by sixth-order differences."""
    contact, h = tangential_contact(RoundedPunch(0.5, 2.0), 0.7), 1e-3
    steps = np.array([-3, -2, -1, 1, 2, 3]) * h
    rule = np.array([-1, 9, -45, 45, -9, 1]) / (60 * h)
    rng = np.random.default_rng(2)
    place = np.array([rng.normal(size=20), rng.normal(size=20), 0.2 + rng.random(20)])

    def along(axis: int) -> StressTensor:
        moved = place[:, None, :] + np.zeros((3, 6, 20))
        moved[axis] += steps[:, None]
        result = stress(contact, *moved, poissons_ratio=0.2, body=2)
        return StressTensor(*(rule @ part for part in result))

    dx, dy, dz = (along(axis) for axis in range(3))
    size = np.abs(np.array([dx, dy, dz])).max()
    for balance in (dx.xx + dy.xy + dz.xz, dx.xy + dy.yy + dz.yz, dx.xz + dy.yz + dz.zz):
        assert np.abs(balance).max() < 1e-9 * size


@pytest.mark.parametrize(("body", "sign"), [(1, 1), (2, -1)])
def test_balance_of_forces_through_a_plane(body: int, sign: int) -> None:
    """The tangential force acts on body 1, which pulls body 2 along x.

    The part beyond the plane has the normal -z, and therefore bears -sigma_xz.
    """
    contact = tangential_contact(Paraboloid(2.0), 0.5)
    nodes, weights = np.polynomial.legendre.leggauss(80)
    angle = 2 * pi * np.arange(16) / 16
    for depth in (0.05, 1.0):
        # r = depth tan(t) covers the plane.
        stops = np.arctan(np.array([0.0, 0.45, 0.55, 0.95, 1.05]) / depth)
        ends = np.append(stops, pi / 2)
        low, high = ends[:-1, None], ends[1:, None]
        t = ((low + high) / 2 + (high - low) / 2 * nodes).ravel()
        run = ((high - low) / 2 * weights).ravel() * depth / np.cos(t) ** 2
        r = depth * np.tan(t)
        x, y = r[:, None] * np.cos(angle), r[:, None] * np.sin(angle)
        result = stress(contact, x, y, depth, poissons_ratio=0.3, body=body)
        area = (r * run)[:, None] * 2 * pi / angle.size
        assert (result.zz * area).sum() == pytest.approx(
            -float(contact.normal.normal_force), rel=1e-9, abs=0
        )
        assert (result.xz * area).sum() == pytest.approx(
            sign * float(contact.tangential_force), rel=1e-9, abs=0
        )


@pytest.mark.parametrize("stick", [0.0, 0.6])
@pytest.mark.parametrize("exponent", [1.01, 1.3, 2.0, 5.0])
def test_tractions_at_the_origin(exponent: float, stick: float) -> None:
    contact = tangential_contact(Power(0.3, exponent), stick)
    p = float(fields.pressure(contact.normal, [0.0])[0])
    tau = float(fields.shear_stress(contact, [0.0])[0])
    for body, sign in ((1, 1), (2, -1)):
        result = stress(contact, 0.0, 0.0, 0.0, poissons_ratio=0.3, body=body)
        expected = [-0.8 * p, -0.8 * p, -p, 0.0, sign * tau, 0.0]
        assert np.abs(np.array(result) - expected).max() < 1e-12 * p
        if exponent >= 2:
            beside = stress(contact, 1e-14, 0.0, 0.0, poissons_ratio=0.3, body=body)
            assert np.abs(np.array(beside) - expected).max() < 1e-11 * p


@pytest.mark.parametrize("z", [1e-5, 1e-31, 1e-40])
def test_axis_of_a_cone_however_near_its_tip(z: float) -> None:
    """sigma_zz = -(E* t/2) (ln(sqrt(1 + z^2)/z) + 1/(1 + z^2)), z in contact radii."""
    contact = normal.solve(Cone(0.1), 1.0, contact_radius=1.0)
    found = float(stress(contact, 0.0, 0.0, z, poissons_ratio=0.3).zz)
    expected = -0.05 * (np.log(np.hypot(1, z) / z) + 1 / (1 + z * z))
    assert found == pytest.approx(expected, rel=1e-13, abs=0)


@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("end", ["sliding", "reversed"])
def test_stresses_are_infinite_at_the_tip_of_a_cone(end: str, body: int) -> None:
    """Infinite tractions of either sign meet there; no component may be undefined."""
    contact: tangential.TangentialContact | load_history.ContactState
    if end == "sliding":
        pressed = normal.solve(Cone(0.1), 1.0, contact_radius=1.0)
        contact = tangential.solve(pressed, 0.8, 0.3, tangential_displacement=1.0)
    else:
        moved = [1.0, -1.0]
        contact = load_history.solve(
            Cone(0.1), 1.0, 0.8, 0.3, indentation_depth=[0.1, 0.1], tangential_displacement=moved
        ).state
    at = stress(contact, 0.0, 0.0, 0.0, poissons_ratio=0.3, body=body)
    normals, shears = np.ravel(at[:3]), np.ravel(at[3:])
    assert (normals == -np.inf).all()
    assert (shears == np.inf).all()
    assert np.ravel(at.von_mises) == np.ravel(at.maximum_shear) == np.inf
    assert (at.principal == -np.inf).all()


@pytest.mark.parametrize("index", [1, 2, 3, 4])
def test_contact_that_ends_at_a_point_of_its_table(index: int) -> None:
    """Johnson, Eq. (3.45): a spline takes the parabola exactly."""
    r = np.linspace(0.0, 1.0, 5)
    a = float(r[index])
    contact = normal.solve(Tabulated(tuple(r), tuple(r * r / 2)), E_STAR, contact_radius=a)
    z = np.array([0.0, 1e-3, 0.3, 2.0])
    peak = 2 * E_STAR * a / pi
    result = stress(contact, 0.0, 0.0, z, poissons_ratio=0.3).zz
    assert result == pytest.approx(-peak / (1 + np.square(z / a)), rel=1e-12, abs=0)
    below = stress(contact, 0.5 * a, 0.0, 0.0, poissons_ratio=0.3).zz
    assert float(below) == pytest.approx(-peak * 0.75**0.5, rel=1e-11, abs=0)


@pytest.mark.parametrize("part", [0.5, 0.25])
@pytest.mark.parametrize(
    ("profile", "a"),
    [
        (RoundedCone(0.25, 1.0), 0.25),
        (Hyperboloid(0.1, 1.0), 0.5),
        (CappedParaboloid(0.3, 2.0, 1.0), 0.25),
    ],
)
def test_stick_radius_that_is_a_binary_part_of_the_contact(
    profile: Profile, a: float, part: float
) -> None:
    """On the axis of the surface sigma_xx = -(1 + 2 nu) p/2, and the traction is tau."""
    contact = normal.solve(profile, E_STAR, contact_radius=a)
    partial = tangential.solve(contact, 2.6, FRICTION, stick_radius=part * a)
    pressure = float(fields.pressure(contact, [0.0])[0])
    result = stress(partial, 0.0, 0.0, [0.0, 1e-20], poissons_ratio=0.3, body=2)
    assert result.zz == pytest.approx(-pressure, rel=1e-11, abs=0)
    assert result.xx == pytest.approx(-0.8 * pressure, rel=1e-11, abs=0)
    tau = float(fields.shear_stress(partial, [0.0])[0])
    assert np.abs(result.xz) == pytest.approx(abs(tau), rel=1e-11, abs=0)


def test_shapes_of_loads_and_points() -> None:
    contact = normal.solve(Paraboloid(2.0), E_STAR, normal_force=[0.1, 0.2, 0.4])
    x, z = np.linspace(-1, 1, 5), np.linspace(0, 1, 4)
    result = stress(contact, x, 0.0, z[:, None], poissons_ratio=0.3)
    assert result.zz.shape == result.von_mises.shape == result.maximum_shear.shape == (3, 4, 5)
    assert result.principal.shape == (3, 4, 5, 3)
    one = normal.solve(Paraboloid(2.0), E_STAR, normal_force=0.2)
    alone = stress(one, x, 0.0, z[:, None], poissons_ratio=0.3)
    assert np.array_equal(alone.xx, result.xx[1])


def test_prescribed_radii_of_many_loads_are_exact() -> None:
    """Next to the edge the pressure has a root, which magnifies rounding errors of the radius."""
    r, profile = np.array([1 - 1e-9, 1.0]), RoundedPunch(0.5, 2.0)
    many, one = (normal.solve(profile, E_STAR, contact_radius=a) for a in ([1.0, 2.0], 1.0))
    result, alone = (stress(each, r, 0.0, 0.0, poissons_ratio=0.3).zz for each in (many, one))
    assert np.array_equal(result[0], alone)
    assert np.abs(alone + fields.pressure(one, r)).max() < 1e-12 * float(one.mean_pressure)


def test_no_load_gives_no_stress() -> None:
    contact = normal.solve(Paraboloid(2.0), E_STAR, normal_force=0.0)
    result = stress(contact, [0.0, 1.0], 0.0, [0.0, 1.0], poissons_ratio=0.3)
    assert not np.any(np.array(result))


@pytest.mark.parametrize("exponent", [-50, 50])
def test_any_unit_of_length(exponent: int) -> None:
    unit = 10.0**exponent
    small = normal.solve(Paraboloid(2.0 * unit), E_STAR, contact_radius=unit)
    x, z = np.array([0.0, 0.3, 1.0, 1.7]), np.array([0.0, 1e-6, 0.4, 3.0])
    result = stress(small, x * unit, 0.0, z * unit, poissons_ratio=0.3)
    expected = stress(normal_contact(Paraboloid(2.0)), x, 0.0, z, poissons_ratio=0.3)
    assert np.abs(np.array(result) - np.array(expected)).max() < 1e-13 * np.abs(expected.zz).max()


@pytest.mark.parametrize(("x", "z"), [(np.nan, 0.0), (0.0, -1e-30), (np.inf, 0.0)])
def test_invalid_points_are_rejected(x: float, z: float) -> None:
    with pytest.raises(InputError):
        stress(normal_contact(Paraboloid(2.0)), x, 0.0, z, poissons_ratio=0.3)


def test_error_estimate_contains_the_rounding_of_the_edge() -> None:
    exact = normal_contact(Paraboloid(2.0))
    computed = normal.solve(Paraboloid(2.0), E_STAR, normal_force=float(exact.normal_force))
    points = 1 - 1e-12, 0.0, 0.0
    assert error_estimate(exact, *points) < 1e-12
    assert error_estimate(computed, *points) > 1e-11
