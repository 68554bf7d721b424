"""Largest stresses and the onset of yield are those of the literature."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core import history as load_history
from mdr_core.errors import AccuracyError, InputError
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Ellipsoid,
    FlatPunch,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    SphericalTipCone,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr_core.subsurface import (
    MEASURES,
    StressTensor,
    largest,
    stress,
    yield_finding,
    yield_onset_force,
    yielding,
)
from mdr_core.subsurface.stress import on_rings
from tests.oracles.subsurface_generate import shape_of, tensor

STRENGTH = 0.01


def ball(radius: float = 0.1) -> normal.NormalContact:
    return normal.solve(Paraboloid(2.0), 3.0, contact_radius=radius)


def sliding(friction: float) -> tangential.TangentialContact:
    return tangential.solve(ball(), 2.5, friction, tangential_displacement=10.0)


def onset_pressure(force: float) -> float:
    contact = normal.solve(Paraboloid(2.0), 3.0, normal_force=force)
    return float(contact.maximum_pressure) / STRENGTH


@pytest.mark.parametrize(
    ("nu", "shear", "depth", "onset"),
    [(0.0, 0.3848, 0.382, 1.299), (0.3, 0.3100, 0.481, 1.613), (0.5, 0.2663, 0.548, 1.877)],
)
def test_hertz(nu: float, shear: float, depth: float, onset: float) -> None:
    """Johnson, section 4.2, by both criteria: on the axis two principal stresses are equal."""
    contact = ball()
    peak = largest(contact, "maximum_shear", poissons_ratio=nu)
    assert float(peak.value / contact.maximum_pressure) == pytest.approx(shear, abs=6e-5)
    assert float(peak.z) / 0.1 == pytest.approx(depth, abs=6e-4)
    assert float(np.hypot(peak.x, peak.y)) < 1e-4
    for measure in MEASURES:
        force = yield_onset_force(contact, STRENGTH, measure, poissons_ratio=nu)
        assert onset_pressure(float(force)) == pytest.approx(onset, abs=6e-4)


@pytest.mark.parametrize(
    ("nu", "friction", "onset"),
    [
        (0.3, 0.3, 1.466),
        (0.3, 0.4, 1.151),
        (0.3, 0.5, 0.944),
        (0.0, 0.1, 1.214),
        (0.0, 0.2, 1.020),
        (0.0, 0.4, 0.772),
        (0.5, 0.4, 1.250),
    ],
)
def test_sliding_ball_yields_on_its_surface(nu: float, friction: float, onset: float) -> None:
    """Tresca on the surface along the load, by Hamilton's closed form."""
    contact = sliding(friction)
    peak = largest(contact, "maximum_shear", poissons_ratio=nu, body=2)
    assert float(contact.normal.maximum_pressure / peak.value) / 2 == pytest.approx(onset, abs=6e-4)
    assert (float(peak.y), float(peak.z)) == pytest.approx((0.0, 0.0), abs=1e-7)
    force = yield_onset_force(contact, STRENGTH, "maximum_shear", poissons_ratio=nu, body=2)
    assert onset_pressure(float(force)) == pytest.approx(onset, abs=6e-4)


def test_stresses_of_the_bodies_are_mirror_images() -> None:
    contact = tangential.solve(ball(), 2.5, 0.3, stick_radius=0.06)
    one, two = (largest(contact, poissons_ratio=0.3, body=body) for body in (1, 2))
    assert float(one.value) == pytest.approx(float(two.value), rel=1e-6, abs=0)
    assert float(one.x) == pytest.approx(-float(two.x), rel=1e-3, abs=0)


@pytest.mark.every(3)
@pytest.mark.parametrize("stick", [None, 0.08])
@pytest.mark.parametrize(
    "profile",
    [Paraboloid(2.0), Power(0.4, 3.7), RoundedPunch(0.05, 2.0), Hyperboloid(0.2, 0.05)],
)
def test_largest_stress_is_not_exceeded_by_samples(profile: Profile, stick: float | None) -> None:
    contact = normal.solve(profile, 3.0, contact_radius=0.1)
    case = tangential.solve(contact, 2.5, 0.4, stick_radius=stick) if stick else contact
    x, y, z = np.random.default_rng(3).uniform(-0.12, 0.12, size=(3, 20000))
    z = np.where(np.arange(z.size) % 4 == 0, 0.0, np.abs(z))
    result = stress(case, x, y, z, poissons_ratio=0.2)
    for measure in MEASURES:
        peak = largest(case, measure, poissons_ratio=0.2)
        sampled = getattr(result, measure).max()
        assert sampled < float(peak.value) * (1 + 1e-6)
        at = stress(case, peak.x, peak.y, peak.z, poissons_ratio=0.2)
        assert getattr(at, measure) == pytest.approx(float(peak.value), rel=1e-5, abs=0)


@pytest.mark.long
@pytest.mark.parametrize(
    ("profile", "nu", "friction", "stick", "highest"),
    [
        # At x > 0, where a peak at x < 0 has almost the same height.
        (Power(0.3, 20.0), 0.0, 0.054, 0.79, (0.92, 0.98)),
        # Beside the plane of the tangential force.
        (RoundedPunch(0.5, 2.0), 0.06, 0.023, 0.51, (0.4, 1.0)),
    ],
)
def test_weak_friction_lifts_one_of_many_peaks(
    profile: Profile, nu: float, friction: float, stick: float, highest: tuple[float, float]
) -> None:
    contact = normal.solve(profile, 3.0, contact_radius=1.0)
    case = tangential.solve(contact, 2.5, friction, stick_radius=stick)
    for measure in MEASURES:
        peak = float(largest(case, measure, poissons_ratio=nu).value)
        r, z = np.linspace(*highest, 61), np.geomspace(1e-3, 0.4, 81)[:, None]
        sampled = [
            getattr(
                stress(case, r * np.cos(turn), r * np.sin(turn), z, poissons_ratio=nu), measure
            ).max()
            for turn in np.linspace(0, np.pi, 13)
        ]
        assert max(sampled) < peak * (1 + 1e-7)
        assert max(sampled) > peak * (1 - 3e-3)


def test_weak_friction_with_the_largest_stress_next_to_the_axis() -> None:
    """On the axis the stress in each direction of the search differs by rounding errors."""
    rng = np.random.default_rng(1)
    x, z = np.linspace(-0.02, 0.02, 41), np.linspace(0.4, 0.6, 41)[:, None]
    for _ in range(12):
        nu, friction, width = (
            rng.uniform(0, 0.5),
            10 ** rng.uniform(-2, -1),
            10 ** rng.uniform(-5, 0),
        )
        contact = normal.solve(Paraboloid(1.0), 3.0, contact_radius=1.0)
        case = tangential.solve(contact, 2.5, friction, stick_radius=1 - width)
        for measure in MEASURES:
            peak = float(largest(case, measure, poissons_ratio=nu).value)
            sampled = getattr(stress(case, x, 0.0, z, poissons_ratio=nu), measure).max()
            assert sampled < peak * (1 + 1e-6)
            assert sampled > peak * (1 - 3e-3)


@pytest.mark.every(8)
@pytest.mark.parametrize("push", [0.0, 1e-12, 1e-8, 1e-4])
@pytest.mark.parametrize("beyond", [1e-6, 1e-3])
def test_narrow_peaks_next_to_a_flat(
    beyond: float, push: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each is a ridge in r and z, the longer the closer the slip annulus is to the edge."""
    calls: list[None] = []

    def counted(*given: Any) -> StressTensor:
        calls.append(None)
        return on_rings(*given)

    contact = normal.solve(RoundedPunch(0.5, 10.0), 1.0, contact_radius=0.5 * (1 + beyond))
    force = push * 0.5 * contact.normal_force
    case = tangential.solve(contact, 0.9, 0.5, tangential_force=force)
    monkeypatch.setattr(yielding, "on_rings", counted)
    peak = float(largest(case, "maximum_shear", poissons_ratio=0.0).value)
    assert len(calls) < 150
    r = 0.5 * (1 + beyond * np.linspace(-1, 1, 401))
    z = 0.5 * beyond * np.geomspace(1e-6, 10, 401)[:, None]
    sampled = stress(case, r, 0.0, z, poissons_ratio=0.0).maximum_shear.max()
    assert sampled < peak * (1 + 1e-6)
    assert sampled > peak * (1 - 3e-3)


@pytest.mark.parametrize("measure", MEASURES)
def test_friction_moves_the_largest_stress_off_the_axis(measure: str) -> None:
    contact = normal.solve(Hyperboloid(0.2, 0.02), 3.0, contact_radius=0.1)
    case = tangential.solve(contact, 2.5, 0.3, stick_radius=0.065)
    peak = largest(case, measure, poissons_ratio=0.06)
    x, z = np.linspace(-1e-3, 1e-3, 101), np.linspace(0.9, 1.1, 101)[:, None] * float(peak.z)
    nearby = getattr(stress(case, x, 0.0, z, poissons_ratio=0.06), measure)
    assert nearby.max() < float(peak.value) * (1 + 1e-6)
    assert float(peak.x) < 0


def test_two_peaks_of_one_ridge_after_a_load_history() -> None:
    """The grid of the search has one maximum, next to the lower one, at x = 0.61 a, z = 0.43 a."""
    state = load_history.solve(
        Sphere(0.6865),
        1.0,
        0.7097,
        0.3514,
        normal_force=[0.006958, 0.009494, 0.009896, 0.015701],
        tangential_force=[-0.0010631, -0.0014804, 0.0014405, 0.0047343],
    ).state
    a, steps = state.contact_radius, np.linspace(-0.01, 0.01, 21)
    place = a * (0.24 + steps), 0.0, a * (0.51 + steps[:, None])
    sampled = stress(state, *place, poissons_ratio=0.45, body=2).von_mises.max()
    peak = largest(state, poissons_ratio=0.45, body=2)
    assert float(peak.value) == pytest.approx(sampled, rel=1e-5, abs=0)


def test_peak_across_the_load_after_a_load_history() -> None:
    """The surface bears the largest stress at a slip front, in one direction only."""
    state = load_history.solve(
        Sphere(0.5982),
        1.0,
        0.7762,
        1.244,
        normal_force=[0.002191, 0.001795, 0.002206, 0.002069, 0.002348],
        tangential_force=[0.001496, -0.001301, 0.001265, 0.0004477, 0.001293],
    ).state
    sampled = stress(state, 0.0, state.slip_fronts, 0.0, poissons_ratio=0.5, body=2)
    peak = largest(state, "maximum_shear", poissons_ratio=0.5, body=2)
    assert float(peak.value) == pytest.approx(sampled.maximum_shear.max(), rel=1e-5, abs=0)
    assert float(peak.y) == pytest.approx(state.slip_fronts[1], rel=1e-6, abs=0)


def test_cusp_at_the_edge_of_a_sliding_contact() -> None:
    """A smooth curve through the grid has its peak beside the edge, where the stress is lower."""
    contact = normal.solve(RoundedPunch(0.3484, 1.0), 1.0, contact_radius=0.6809)
    case = tangential.solve(contact, 1.0, 0.4337, stick_radius=0.0)
    at_edge = stress(case, 0.6809, 0.0, 0.0, poissons_ratio=0.2156).maximum_shear
    peak = largest(case, "maximum_shear", poissons_ratio=0.2156)
    assert float(peak.value) >= float(at_edge) * (1 - 1e-9)
    assert float(peak.x) == pytest.approx(0.6809, rel=1e-6, abs=0)


def test_peak_across_the_load_beside_a_flat() -> None:
    """Along the narrow ring of the edge, ahead of the load, a second peak is 0.3 % lower."""
    contact = normal.solve(RoundedPunch(1.0, 112.0), 1.0, contact_radius=1 + 1e-5)
    case = tangential.solve(contact, 0.667, 0.5, stick_radius=0.0)
    angle, r = np.linspace(1.6, 2.2, 61)[:, None], 1 + 1e-5 * np.linspace(0.8, 0.9, 11)
    sampled = stress(case, r * np.cos(angle), r * np.sin(angle), 0.0, poissons_ratio=0.3)
    peak = largest(case, "maximum_shear", poissons_ratio=0.3)
    assert float(peak.value) == pytest.approx(sampled.maximum_shear.max(), rel=1e-5, abs=0)


@pytest.mark.parametrize("profile", [Power(0.4, 1.5), RoundedPunch(0.05, 2.0)])
def test_onset_is_that_of_any_load_in_its_ratio(profile: Profile) -> None:
    radii = np.array([0.06, 0.1, 0.3])
    contact = normal.solve(profile, 3.0, contact_radius=radii)
    pushed = tangential.solve(contact, 2.5, 0.4, tangential_force=0.2 * contact.normal_force)
    for case in (contact, pushed):
        forces = yield_onset_force(case, STRENGTH, poissons_ratio=0.3)
        assert forces == pytest.approx(np.full(3, forces[0]), rel=1e-4, abs=0)


@pytest.mark.parametrize("unit", [1e-30, 1.0, 1e30])
def test_onset_of_a_load_at_the_onset_is_that_load(unit: float) -> None:
    """The first step is then shorter than the rounding error of the logarithm of a large load.

    p_max = (6 F E*^2/(pi^3 R^2))^(1/3) gives F = (pi p_max)^3 R^2/(6 E*^2), with 1.613 Y from
    `test_hertz`.
    """
    modulus, strength = 1e5 * unit, 300.0 * unit
    force = (np.pi * 1.613 * strength) ** 3 * 100.0 / (6 * modulus**2)
    for _ in range(3):
        contact = normal.solve(Paraboloid(10.0), modulus, normal_force=force)
        onset = float(yield_onset_force(contact, strength, poissons_ratio=0.3))
        assert onset == pytest.approx(force, rel=2e-3, abs=0)
        force = onset


@pytest.mark.every(3)
@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize(
    "profile", [Sphere(2.0), RoundedPunch(0.05, 2.0), Power(0.4, 1.5), Hyperboloid(0.2, 0.05)]
)
def test_yield_begins_at_the_onset(profile: Profile, measure: str) -> None:
    contact = tangential.solve(
        normal.solve(profile, 3.0, normal_force=1e-3), 2.5, 0.4, tangential_force=[0.0, 2e-4]
    )
    forces = yield_onset_force(contact, STRENGTH, measure, poissons_ratio=0.3)
    limit = STRENGTH if measure == "von_mises" else STRENGTH / 2
    for force, ratio in zip(forces, (0.0, 0.2), strict=True):
        there = normal.solve(profile, 3.0, normal_force=force)
        at = tangential.solve(there, 2.5, 0.4, tangential_force=ratio * force)
        peak = largest(at, measure, poissons_ratio=0.3)
        assert float(peak.value) == pytest.approx(limit, rel=1e-4, abs=0)


def test_infinite_stresses() -> None:
    punch = normal.solve(FlatPunch(0.3), 3.0, normal_force=1.0)
    cone = normal.solve(Cone(0.1), 3.0, normal_force=1.0)
    for contact, radius in ((punch, 0.3), (cone, 0.0)):
        peak = largest(contact, poissons_ratio=0.3)
        assert np.isinf(peak.value)
        assert (float(peak.x), float(peak.z)) == (radius, 0)
        assert float(yield_onset_force(contact, STRENGTH, poissons_ratio=0.3)) == 0


def test_punch_that_yields_at_its_edge_under_any_load() -> None:
    """The search ends where the stress beneath the edge no longer depends on the load."""
    punch = normal.solve(TruncatedParaboloid(1.0, 4.0), 1.0, indentation_depth=0.05)
    peak = largest(punch, "maximum_shear", poissons_ratio=0.5)
    strength = float(peak.value) / 10
    assert float(yield_onset_force(punch, strength, poissons_ratio=0.5)) == 0


def test_slope_discontinuity_yields_when_the_contact_reaches_it() -> None:
    profile = CappedParaboloid(0.05, 20.0, 1.0)
    contact = normal.solve(profile, 3.0, contact_radius=0.02)
    at_break = normal.solve(profile, 3.0, contact_radius=0.05)
    force = yield_onset_force(contact, 1.0, poissons_ratio=0.3)
    assert float(force) == pytest.approx(float(at_break.normal_force), rel=1e-12, abs=0)


@pytest.mark.parametrize("radius", [0.02, 0.0501, 0.2])
def test_slip_yields_at_once_at_a_slope_discontinuity_of_an_incompressible_body(
    radius: float,
) -> None:
    """Slip starts at the edge, and therefore at the discontinuity when the contact reaches it."""
    profile = CappedParaboloid(0.05, 20.0, 1.0)
    at_break = normal.solve(profile, 3.0, contact_radius=0.05)
    contact = normal.solve(profile, 3.0, contact_radius=radius)
    push = 0.2 * contact.normal_force
    pushed = tangential.solve(contact, 2.5, 0.3, tangential_force=push)
    force = yield_onset_force(pushed, 1.0, poissons_ratio=0.5)
    assert float(force) == pytest.approx(float(at_break.normal_force), rel=1e-12, abs=0)
    assert np.isfinite(largest(pushed, poissons_ratio=0.5).value) == (radius != 0.0501)


@pytest.mark.parametrize(
    ("profile", "searches"),
    [(Paraboloid(2.0), 1), (RoundedPunch(0.05, 2.0), 5), (SphericalTipCone(0.3, 1e-3), 8)],
)
@pytest.mark.parametrize("share", [0.2, 3.0])
def test_onset_takes_few_searches(
    monkeypatch: pytest.MonkeyPatch, profile: Profile, searches: int, share: float
) -> None:
    """Each takes a tenth of a second."""
    counted: list[float] = []

    def peak(*case: Any) -> tuple[float, ...]:
        counted.append(searched(*case)[0])
        return searched(*case)

    contact = normal.solve(profile, 3.0, normal_force=1e-3)
    pushed = tangential.solve(contact, 2.5, 0.4, tangential_force=2e-4)
    strength = share * float(largest(pushed, poissons_ratio=0.3).value)
    searched = yielding._peak
    monkeypatch.setattr(yielding, "_peak", peak)
    assert float(yield_onset_force(pushed, strength, poissons_ratio=0.3)) > 0
    assert len(counted) <= searches


@pytest.mark.parametrize("push", [0.5, 0.9])
def test_cusp_at_a_tip_that_is_almost_a_cone(push: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """There sigma_rr = -(1/2 + nu) p, and the stress falls like r^0.09 from the axis."""
    calls: list[None] = []

    def counted(*given: Any) -> StressTensor:
        calls.append(None)
        return on_rings(*given)

    contact = normal.solve(Power(1.0, 1.09), 3.0, contact_radius=1.0)
    force = push * 0.3 * contact.normal_force
    case = tangential.solve(contact, 2.5, 0.3, tangential_force=force)
    monkeypatch.setattr(yielding, "on_rings", counted)
    peak = largest(case, "maximum_shear", poissons_ratio=0.3)
    assert len(calls) < 50
    pressure, shear = fields.pressure(contact, 0.0)[0], fields.shear_stress(case, 0.0)[0]
    expected = np.hypot((1 - 2 * 0.3) / 4 * pressure, shear)
    assert float(peak.value) == pytest.approx(float(expected), rel=1e-12, abs=0)


def test_onset_next_to_the_equator_of_an_ellipsoid_takes_few_searches(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """There the force ends in a root of the distance, which secants overshoot."""
    counted: list[float] = []

    def peak(*case: Any) -> tuple[float, ...]:
        counted.append(searched(*case)[0])
        return searched(*case)

    contact = normal.solve(Ellipsoid(0.0402, 9.08e-5), 2.1e5, indentation_depth=2.64e-7)
    sliding_ball = tangential.solve(contact, 1.4e5, 0.5, tangential_displacement=7.8e-7)
    searched = yielding._peak
    monkeypatch.setattr(yielding, "_peak", peak)
    force = float(yield_onset_force(sliding_ball, 806.0, poissons_ratio=0.5))
    assert len(counted) <= 12
    at_onset = normal.solve(Ellipsoid(0.0402, 9.08e-5), 2.1e5, normal_force=force)
    slides = tangential.solve(at_onset, 1.4e5, 0.5, tangential_force=0.5 * force)
    stress_there = float(largest(slides, poissons_ratio=0.5).value)
    assert stress_there == pytest.approx(806.0, rel=2e-5, abs=0)


def test_incompressible_cone() -> None:
    """On the axis next to the tip sigma_rr - sigma_zz = (3/4) E* tan(theta)."""
    contact = normal.solve(Cone(0.1), 3.0, contact_radius=1.0)
    peak = largest(contact, "maximum_shear", poissons_ratio=0.5)
    assert 2 * float(peak.value) == pytest.approx(0.75 * 3.0 * 0.1, rel=1e-5, abs=0)
    assert float(yield_onset_force(contact, 0.2, poissons_ratio=0.5)) == 0
    assert np.isinf(yield_onset_force(contact, 0.3, poissons_ratio=0.5))
    for factor, expected in ((0.999, True), (1.001, False)):
        strength = factor * 0.75 * 3.0 * 0.1
        assert bool(yield_finding(contact, (0.5,), strength).where) == expected
    assert bool(yield_finding(contact, (0.3,), 1e9).where)


# Of the reference alone.
@pytest.mark.long
def test_largest_difference_next_to_the_tip_of_an_incompressible_cone() -> None:
    """By definition, in mpmath: the maximum is on the axis and differs from E* tan(theta)."""
    mp.dps = 30
    shape = shape_of({"kind": "cone", "slope": 1.0})
    differences = []
    for degrees in (1e-6, 20, 45, 70, 89):
        angle = np.radians(degrees)
        place = mpf(1e-6 * np.sin(angle)), mpf(0), mpf(1e-6 * np.cos(angle))
        xx, yy, zz, xy, xz, yz = map(float, tensor(shape, mpf(1), None, mpf(0), mpf(0.5), place))
        principal = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        differences.append(principal[2] - principal[0])
    assert differences[0] == pytest.approx(0.75, rel=1e-9, abs=0)
    assert differences == sorted(differences, reverse=True)


def test_slope_discontinuity_of_an_incompressible_body() -> None:
    """Below it, the pressure -K ln|x| in plane strain, K = E* t/(2 pi), has the difference 2 K."""
    contact = normal.solve(TruncatedCone(0.5, 0.1), 3.0, contact_radius=1.0)
    at = stress(contact, 0.5, 0.0, [1e-8, 1e-6], poissons_ratio=0.5)
    assert 2 * at.maximum_shear == pytest.approx(0.3 / np.pi, rel=1e-5, abs=0)
    assert np.isfinite(largest(contact, poissons_ratio=0.5).value)
    assert np.isinf(largest(contact, poissons_ratio=0.49).value)
    slides = tangential.solve(contact, 2.5, 0.3, tangential_displacement=10.0)
    assert np.isinf(largest(slides, poissons_ratio=0.5).value)


@pytest.mark.parametrize(("nu", "onset"), [(0.0, 1.299), (0.3, 1.613), (0.5, 1.877)])
@pytest.mark.parametrize("profile", [Paraboloid(2.0), Sphere(2.0)])
def test_yielding_under_a_ball(profile: Profile, nu: float, onset: float) -> None:
    """Johnson, section 6.1; a sphere of 2 mm under 2 um differs by less than the tolerance."""
    # p_0 = 2 E* a/(pi R).
    radii = onset * STRENGTH * np.pi * 2.0 / (2 * 3.0) * np.array([0.5, 0.997, 1.003, 2.0])
    contact = normal.solve(profile, 3.0, contact_radius=radii)
    assert yield_finding(contact, (nu,), STRENGTH).where.tolist() == [False, False, True, True]
    # It is unknown which body is softer, so the one with the larger stress counts.
    assert yield_finding(contact, (nu, 0.0), STRENGTH).where[1] == (nu > 0)


def test_friction_lowers_the_onset_of_yield() -> None:
    """Full slip at mu = 0.3, nu = 0.3 yields at p_0 = 1.466 Y instead of 1.613 Y."""
    radii = STRENGTH * np.pi * 2.0 / (2 * 3.0) * np.array([1.4, 1.5, 1.5, 1.5])
    contact = normal.solve(Paraboloid(2.0), 3.0, contact_radius=radii)
    limit = 0.3 * contact.normal_force
    forces = limit * [0.999, 0.0, 0.2, 0.999]
    pushed = tangential.solve(contact, 2.5, 0.3, tangential_force=forces)
    assert yield_finding(pushed, (0.3,), STRENGTH).where.tolist() == [False, False, False, True]
    peaks = 2 * largest(pushed, "maximum_shear", poissons_ratio=0.3).value
    assert (peaks >= STRENGTH).tolist() == [False, False, False, True]
    history = load_history.solve(
        Paraboloid(2.0),
        3.0,
        2.5,
        0.3,
        normal_force=contact.normal_force[3],
        tangential_force=[0.0, forces[3], 0.0],
    )
    # The residual tractions of the cycle are as severe as its extreme.
    assert yield_finding(history, (0.3,), STRENGTH).where.tolist() == [False, True, True]


def test_yielding_of_many_loads_equals_single_loads() -> None:
    rng = np.random.default_rng(5)
    contact = normal.solve(RoundedPunch(0.5, 20.0), 3.0, contact_radius=rng.uniform(0.51, 0.7, 12))
    share = rng.uniform(0, 0.99, 12)
    pushed = tangential.solve(
        contact, 2.5, 0.4, tangential_force=share * 0.4 * contact.normal_force
    )
    peaks = 2 * largest(pushed, "maximum_shear", poissons_ratio=0.3).value
    strength = float(np.median(peaks))
    assert np.array_equal(yield_finding(pushed, (0.3,), strength).where, peaks >= strength)


def test_yielding_with_arrays_of_profiles() -> None:
    radius, modulus = np.array([1.0, 2.0, 4.0]), np.array([2.0, 3.0, 3.0])
    contact = normal.solve(Hyperboloid(0.1, radius), modulus, normal_force=1e-3)
    each = [
        normal.solve(Hyperboloid(0.1, r), e, normal_force=1e-3)
        for r, e in zip(radius, modulus, strict=True)
    ]
    peaks = [2 * float(largest(one, "maximum_shear", poissons_ratio=0.3).value) for one in each]
    strength = float(np.mean(peaks))
    expected = [peak >= strength for peak in peaks]
    assert yield_finding(contact, (0.3,), strength).where.tolist() == expected


@pytest.mark.long
def test_onset_in_full_slip_next_to_a_cone() -> None:
    """Slip reaches the tip, next to which the stress changes over many decades."""
    profile, strength = Power(0.4, 1.1), 2.0
    contact = normal.solve(profile, 3.0, normal_force=1e-3)
    slides = tangential.solve(contact, 2.5, 0.3, tangential_force=0.3 * contact.normal_force)
    force = yield_onset_force(slides, strength, poissons_ratio=0.25)
    contact = normal.solve(profile, 3.0, normal_force=force)
    slides = tangential.solve(contact, 2.5, 0.3, tangential_displacement=contact.indentation_depth)
    assert bool(slides.full_slip)
    peak = largest(slides, poissons_ratio=0.25).value
    assert float(peak) == pytest.approx(strength, rel=1e-4, abs=0)


def test_contact_that_no_double_tells_from_its_flat() -> None:
    """Its stresses equal the stresses under a flat punch."""
    x, force = np.array([0.0, 0.2, 0.5, 0.9]), 1e-40
    rounded, flat = (
        normal.solve(profile, 3.0, normal_force=force)
        for profile in (RoundedPunch(0.5, 2.0), FlatPunch(0.5))
    )
    assert float(rounded.contact_radius) == 0.5
    one, other = (
        np.array(stress(each, x, 0.0, 0.1, poissons_ratio=0.3)) for each in (rounded, flat)
    )
    assert np.abs(one - other).max() < 1e-12 * np.abs(other).max()


def test_largest_stress_that_no_radius_resolves_is_rejected() -> None:
    """Beneath the edge the stresses are similar where s << b: they grow like s^2."""
    punch = RoundedPunch(0.5, 2.0)
    close, far, unresolved = (
        normal.solve(punch, 3.0, indentation_depth=punch.depth(np.array(s * s)))
        for s in (1e-6, 1e-5, 1e-7)
    )
    one, other = (float(largest(each, poissons_ratio=0.3).value) for each in (close, far))
    assert one == pytest.approx(other / 100, rel=1e-5, abs=0)
    with pytest.raises(AccuracyError, match="beyond the flat"):
        largest(unresolved, poissons_ratio=0.3)
    cone = normal.solve(TruncatedCone(0.5, 0.1), 3.0, normal_force=1e-40)
    assert largest(cone, poissons_ratio=0.3).value == np.inf


def test_unreachable_stress_has_no_onset() -> None:
    sphere = normal.solve(Sphere(1.0), 3.0, contact_radius=0.1)
    assert np.isinf(yield_onset_force(sphere, 1e20, poissons_ratio=0.3))
    r = np.linspace(0, 0.2, 20)
    table = normal.solve(Tabulated(r, r * r / 4), 3.0, contact_radius=0.1)
    assert np.isinf(yield_onset_force(table, 1.0, poissons_ratio=0.3))


def test_invalid_requests_are_rejected() -> None:
    with pytest.raises(InputError):
        largest(ball(), "pressure", poissons_ratio=0.3)
    with pytest.raises(InputError):
        yield_onset_force(ball(), 0.0, poissons_ratio=0.3)
    with pytest.raises(InputError):
        yield_onset_force(
            normal.solve(Paraboloid(2.0), 3.0, normal_force=0.0), 1.0, poissons_ratio=0.3
        )


def test_no_load() -> None:
    contact = normal.solve(Paraboloid(2.0), 3.0, normal_force=[0.0, 1e-3])
    assert largest(contact, poissons_ratio=0.3).value[0] == 0
