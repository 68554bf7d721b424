"""Largest stresses and the onset of yield, against the values of the literature."""

from __future__ import annotations

import numpy as np
import pytest

from mdr_core import normal, tangential
from mdr_core.errors import InputError
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    FlatPunch,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    Tabulated,
)
from mdr_core.subsurface import MEASURES, largest, stress, yield_onset_force

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
    """Tresca on the surface along the load, by the closed stresses of Hamilton."""
    contact = sliding(friction)
    peak = largest(contact, "maximum_shear", poissons_ratio=nu, body=2)
    assert float(contact.normal.maximum_pressure / peak.value) / 2 == pytest.approx(onset, abs=6e-4)
    assert float(peak.z) == float(peak.y) == 0
    force = yield_onset_force(contact, STRENGTH, "maximum_shear", poissons_ratio=nu, body=2)
    assert onset_pressure(float(force)) == pytest.approx(onset, abs=6e-4)


def test_the_bodies_are_mirror_images() -> None:
    contact = tangential.solve(ball(), 2.5, 0.3, stick_radius=0.06)
    one, two = (largest(contact, poissons_ratio=0.3, body=body) for body in (1, 2))
    assert float(one.value) == pytest.approx(float(two.value), rel=1e-6, abs=0)
    assert float(one.x) == pytest.approx(-float(two.x), rel=1e-3, abs=0)


@pytest.mark.parametrize("stick", [None, 0.08])
@pytest.mark.parametrize(
    "profile",
    [Paraboloid(2.0), Power(0.4, 3.7), RoundedPunch(0.05, 2.0), Hyperboloid(0.2, 0.05)],
)
def test_no_sample_exceeds_the_largest_stress(profile: Profile, stick: float | None) -> None:
    contact = normal.solve(profile, 3.0, contact_radius=0.1)
    case = tangential.solve(contact, 2.5, 0.4, stick_radius=stick) if stick else contact
    x, y, z = np.random.default_rng(3).uniform(-0.12, 0.12, size=(3, 20000))
    z = np.where(np.arange(z.size) % 4 == 0, 0.0, np.abs(z))
    found = stress(case, x, y, z, poissons_ratio=0.2, rtol=1e-6)
    for measure in MEASURES:
        peak = largest(case, measure, poissons_ratio=0.2)
        sampled = getattr(found, measure).max()
        assert sampled < float(peak.value) * (1 + 1e-6)
        at = stress(case, peak.x, peak.y, peak.z, poissons_ratio=0.2)
        assert getattr(at, measure) == pytest.approx(float(peak.value), rel=1e-5, abs=0)


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


def test_slope_discontinuity_yields_when_the_contact_reaches_it() -> None:
    profile = CappedParaboloid(0.05, 20.0, 1.0)
    contact = normal.solve(profile, 3.0, contact_radius=0.02)
    at_break = normal.solve(profile, 3.0, contact_radius=0.05)
    force = yield_onset_force(contact, 1.0, poissons_ratio=0.3)
    assert float(force) == pytest.approx(float(at_break.normal_force), rel=1e-12, abs=0)


def test_incompressible_cone() -> None:
    """On the axis next to the tip sigma_rr - sigma_zz = (3/4) E* tan(theta)."""
    contact = normal.solve(Cone(0.1), 3.0, contact_radius=1.0)
    peak = largest(contact, "maximum_shear", poissons_ratio=0.5)
    assert 2 * float(peak.value) == pytest.approx(0.75 * 3.0 * 0.1, rel=1e-5, abs=0)
    assert float(yield_onset_force(contact, 0.2, poissons_ratio=0.5)) == 0
    assert np.isinf(yield_onset_force(contact, 0.3, poissons_ratio=0.5))


def test_stress_that_no_load_reaches() -> None:
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
