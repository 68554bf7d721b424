"""A twist has the torque, rotation, stick radius and energy of independent evaluations."""

from __future__ import annotations

import random
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, torsion
from mdr_core.materials import Body, from_bodies
from mdr_core.profiles import FlatPunch, Paraboloid, Power, Sphere, Tabulated
from tests.core.comparison import profile_from
from tests.core.random_cases import PROFILE_GENERATORS, _near, _spread
from tests.oracles.torsion_reference import (
    DIGITS,
    Twist,
    first_kind,
    integral_of_first_kind,
    second_kind,
    torque_kernel,
)

MU, G, E_STAR = 0.3, 0.7, 1.9
#: Bound of the task; the largest error found is 1e-12, next to the equator of a sphere.
BOUND = 1e-10
PROFILES: list[dict[str, Any]] = [
    {"kind": "cone", "slope": 0.3},
    {"kind": "sphere", "radius": 2.0},
    {"kind": "sphere", "radius": 1.001},
    {"kind": "power", "coefficient": 0.7, "exponent": 4.0},
    {"kind": "power", "coefficient": 0.7, "exponent": 1.5},
    {"kind": "power", "coefficient": 0.7, "exponent": 0.3},
    {"kind": "power", "coefficient": 0.7, "exponent": 20.3},
    {
        "kind": "series",
        "terms": [{"coefficient": 0.4, "exponent": 2.0}, {"coefficient": 0.1, "exponent": 3.7}],
    },
    {"kind": "hyperboloid", "slope": 0.4, "tip_radius": 0.01},
    {"kind": "two_spheres", "radii": [1.2, -1.3]},
    {"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 2.0},
    {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.3},
    {"kind": "truncated_paraboloid", "flat_radius": 0.9999, "radius": 2.0},
    {"kind": "rounded_cone", "slope": 0.4, "tip_radius": 1.5},
    {"kind": "spherical_tip_cone", "slope": 0.5, "tip_radius": 1.0},
    {"kind": "capped_paraboloid", "cap_radius": 0.5, "tip_radius": 3.0, "radius": 1.1},
]
STICKS = (1 - 1e-12, 0.97, 0.5000001, 0.3, 1e-3, 1e-9)


def twisted(profile: Any, **load: Any) -> torsion.TorsionalContact:
    """Twist of a contact of radius 1, or of a flat punch under a force of 1."""
    at = {"normal_force": 1.0} if isinstance(profile, FlatPunch) else {"contact_radius": 1.0}
    return torsion.solve(normal.solve(profile, E_STAR, **at), G, MU, **load)


def reduced(twist: torsion.TorsionalContact) -> tuple[float, float, float]:
    """P, moment and work, in whose units the references are."""
    moment = twist.torque * 3 * np.pi / (8 * MU * E_STAR)
    rotation = twist.rotation * 2 * np.pi * G / (MU * E_STAR)
    work = twist.dissipated_energy * np.pi**2 * G / (4 * MU**2 * E_STAR**2)
    return float(rotation), float(moment), float(work)


@pytest.mark.parametrize("c", [1 - 1e-14, 1 - 1e-6, 0.9, 0.5, 0.1, 1e-3, 1e-9])
def test_ball_is_lubkins(c: float) -> None:
    """phi = (mu p0/2G)(K - E), and its torque, which needs one integral of K.

    M = (8 mu p0 a^3/3) [q^3 (K - E) + 3 int_q^1 y^2 (K - E) dy], q = c/a. By parts the integrals
    are I2 = I0/4 + q [(1 - q^2) K/2 - (K - E)/4] of y^2 K, and J2 of y^2 E is
    (J0 + I2 + q (1 - q^2) E)/4 with J0 = [I0 + q (K - E)]/2, where I0 = int_q^1 K dy.
    """
    contact = normal.solve(Paraboloid(2.0), E_STAR, contact_radius=1.0)
    twist = torsion.solve(contact, G, MU, stick_radius=c)
    with mp.workdps(DIGITS):
        q, p0 = mpf(c), 2 * mpf(E_STAR) / (mp.pi * 2)
        k, e, i0 = first_kind(q), second_kind(q), integral_of_first_kind(q)
        i2 = i0 / 4 + q * ((1 - q * q) * k / 2 - (k - e) / 4)
        j2 = ((i0 + q * (k - e)) / 2 + i2 + q * (1 - q * q) * e) / 4
        rotation = mpf(MU) * p0 / (2 * mpf(G)) * (k - e)
        torque = 8 * mpf(MU) * p0 / 3 * (q**3 * (k - e) + 3 * (i2 - j2))
    assert twist.rotation == pytest.approx(float(rotation), rel=1e-13, abs=0)
    assert twist.torque == pytest.approx(float(torque), rel=1e-13, abs=0)
    assert twist.slip_width == pytest.approx(1 - c, rel=1e-15, abs=0)


@pytest.mark.parametrize(
    ("c", "rotation", "share"),
    [
        (0.9, 0.0241989839087, 0.299373217594),
        (0.5, 0.14181894299, 0.897338429005),
        (0.1, 0.401946572695, 0.999272152693),
    ],
)
def test_ball_of_unit_pressure(c: float, rotation: float, share: float) -> None:
    """Values of a separate evaluation in mpmath; p0 = a = G = 1."""
    contact = normal.solve(Paraboloid(1.0), np.pi / 2, contact_radius=1.0)
    twist = torsion.solve(contact, 1.0, 0.3, stick_radius=c)
    assert twist.rotation == pytest.approx(rotation, rel=1e-11, abs=0)
    largest = 0.3 * contact.normal_force * twist.torsion_arm
    assert twist.torque / largest == pytest.approx(share, rel=1e-11, abs=0)


@pytest.mark.parametrize(
    ("profile", "arm"),
    [
        (Paraboloid(2.0), 3 * np.pi / 16),
        (profile_from({"kind": "cone", "slope": 0.3}), np.pi / 6),
        # (pi/4) (n + 1)/(n + 2) for r^n.
        (Power(0.7, 4.0), 5 * np.pi / 24),
        (Power(0.7, 0.1), 1.1 * np.pi / 8.4),
        (Power(0.7, 60.0), 61 * np.pi / 248),
        (FlatPunch(1.0), np.pi / 4),
        # A separate evaluation in mpmath.
        (Sphere(2.0), 0.596704607),
    ],
)
def test_arm_of_the_largest_torque(profile: Any, arm: float) -> None:
    rel = 1e-9 if isinstance(profile, Sphere) else 1e-13
    assert twisted(profile, rotation=0.1).torsion_arm == pytest.approx(arm, rel=rel, abs=0)


@pytest.mark.every(4)
@pytest.mark.parametrize("c", STICKS)
@pytest.mark.parametrize("fields_", PROFILES, ids=lambda fields_: fields_["kind"])
def test_every_kind_is_the_reference(fields_: dict[str, Any], c: float) -> None:
    twist = twisted(profile_from(fields_), stick_radius=c)
    with mp.workdps(DIGITS):
        truth = Twist(fields_, mpf(1))
        expected = truth.rotation(mpf(c)), truth.moment(mpf(c)), truth.second_moment()
        errors = [
            float(abs(mpf(value) / reference - 1))
            for value, reference in zip(
                (*reduced(twist)[:2], float(twist.second_moment)), expected, strict=True
            )
        ]
    assert max(errors) < min(BOUND, twist.error_estimate)


@pytest.mark.every(5)
@pytest.mark.parametrize("c", [1 - 1e-9, 0.7, 0.2])
@pytest.mark.parametrize(
    "fields_",
    [
        {"kind": "paraboloid", "radius": 1.3},
        *PROFILES[:2],
        *PROFILES[4:7],
        PROFILES[9],
        PROFILES[12],
    ],
    ids=lambda fields_: fields_["kind"],
)
def test_dissipated_energy_is_the_reference(fields_: dict[str, Any], c: float) -> None:
    twist = twisted(profile_from(fields_), stick_radius=c)
    with mp.workdps(DIGITS):
        error = float(abs(mpf(reduced(twist)[2]) / Twist(fields_, mpf(1)).work(mpf(c)) - 1))
    assert error < min(BOUND, twist.error_estimate)


def test_flat_punch_sticks_up_to_two_thirds() -> None:
    """A disc turns with M = (16/3) G a^3 phi, up to tau = mu p at the edge, M = (2/3) mu F_N a."""
    onset = MU * 2 / 3
    stuck = twisted(FlatPunch(1.0), torque=[0.0, onset / 2, onset * (1 - 1e-12)])
    np.testing.assert_allclose(stuck.torque, 16 / 3 * G * stuck.rotation, rtol=1e-13)
    assert (stuck.regime == "stick").all()
    assert (stuck.stick_radius == 1).all()
    assert twisted(FlatPunch(1.0), torque=onset * 1.001).regime == "partial_slip"


@pytest.mark.parametrize("c", [0.999, 0.5, 1e-4])
def test_flat_punch_slips_beyond_it(c: float) -> None:
    """P = (d/a) K(c/a) and the moment d a^2 w(c/a), as dg is one step d at x = a."""
    depth = 1 / (2 * E_STAR)
    rotation, moment, _ = reduced(twisted(FlatPunch(1.0), stick_radius=c))
    with mp.workdps(DIGITS):
        assert rotation == pytest.approx(depth * float(first_kind(mpf(c))), rel=1e-13, abs=0)
        assert moment == pytest.approx(depth * float(torque_kernel(mpf(c))), rel=1e-13, abs=0)


@pytest.mark.parametrize("points", [20, 60, 200])
@pytest.mark.parametrize("rotation", [1e-4, 1e-2, 0.05])
def test_table_of_a_ball(points: int, rotation: float) -> None:
    r = np.linspace(0, 0.2, points)
    table = Tabulated(r, 1 - np.sqrt(1 - r * r))
    found, ball = (
        torsion.solve(normal.solve(profile, E_STAR, normal_force=1e-3), G, MU, rotation=rotation)
        for profile in (table, Sphere(1.0))
    )
    assert found.data_error is not None
    allowed = float(found.data_error) + found.error_estimate
    for name in ("torque", "torsion_arm", "dissipated_energy"):
        assert getattr(found, name) == pytest.approx(getattr(ball, name), rel=allowed, abs=0)


def test_noisy_tables_of_a_ball() -> None:
    """`data_error` covers torques of given rotations, and the reverse, in most tables."""
    r, covered = np.linspace(0, 0.2, 80), []
    heights = 1 - np.sqrt(1 - r * r)
    ball = normal.solve(Sphere(1.0), E_STAR, normal_force=1e-3)
    truth = torsion.solve(ball, G, MU, rotation=[1e-3, 1e-2])
    for seed in range(6):
        noise = 1e-3 * heights[-1] * np.random.default_rng(seed).standard_normal(r.size)
        table = normal.solve(Tabulated(r, heights + noise), E_STAR, normal_force=1e-3)
        for load, other in (("rotation", "torque"), ("torque", "rotation")):
            found = torsion.solve(table, G, MU, **{load: getattr(truth, load)})
            error = abs(getattr(found, other) / getattr(truth, other) - 1)
            assert found.data_error is not None
            covered += (error <= found.data_error).tolist()
    assert np.mean(covered) >= 0.8


def test_bodies_give_the_shear_modulus() -> None:
    """1/G = 1/G1 + 1/G2, and the body's own G against a rigid one."""
    steel, rubber = Body(210e9, 0.3), Body(2e6, 0.5)
    pair = from_bodies([steel, rubber])
    together = 1 / (2.6 / 210e9 + 3 / 2e6)
    assert pair.shear_modulus == pytest.approx(together, rel=1e-14, abs=0)
    assert from_bodies([rubber, "rigid"]).shear_modulus == pytest.approx(2e6 / 3, rel=1e-14, abs=0)
    contact = normal.solve(Paraboloid(0.01), pair, normal_force=1.0)
    by_pair, by_number = (
        torsion.solve(contact, modulus, 0.5, rotation=1e-3) for modulus in (pair, together)
    )
    assert by_pair.torque == pytest.approx(by_number.torque, rel=1e-13, abs=0)


@pytest.mark.every(20)
@pytest.mark.parametrize("seed", range(20))
def test_torque_rotation_and_stick_radius_are_inverse(seed: int) -> None:
    """100 contacts of every kind, with c next to a, to the axis and to breaks."""
    draw = random.Random(seed)
    for _ in range(100):
        kind = draw.choice(list(PROFILE_GENERATORS))
        profile = profile_from({"kind": kind, **PROFILE_GENERATORS[kind](draw)})
        near_breaks = [_near(draw, float(b)) for b in profile.breaks if 0 < b < 1]
        sticks = [draw.uniform(0.02, 0.98), 1 - _spread(draw, -14, -1), _spread(draw, -8, -0.5)]
        c = draw.choice([*sticks, *near_breaks])
        if not 0 < c < 1 or profile.first_radius >= 1:
            continue
        twist = twisted(profile, stick_radius=c)
        largest = MU * twist.normal.normal_force * twist.torsion_arm
        for name in ("rotation", "torque"):
            # From here on the torque does not determine c.
            if name == "torque" and twist.torque > largest * (1 - 1e-9):
                continue
            back = twisted(profile, **{name: getattr(twist, name)})
            for other in ("rotation", "torque", "stick_radius", "slip_width", "dissipated_energy"):
                error = abs(getattr(back, other) / getattr(twist, other) - 1)
                assert error <= back.error_estimate, (profile, c, name, other)
                assert name == "torque" or error < 1e-9, (profile, c, other)


def test_torque_next_to_the_largest() -> None:
    """At 1 - M/M_max = 1e-9 the stick radius has the accuracy of that difference."""
    contact = normal.solve(Paraboloid(1.0), np.pi / 2, contact_radius=1.0)
    largest = 0.3 * contact.normal_force * 3 * np.pi / 16
    twist = torsion.solve(contact, 1.0, 0.3, torque=largest * (1 - np.array([1e-3, 1e-9, 1e-11])))
    # M_max - M = (8/9) mu p0 c^3 to the first order.
    c = np.cbrt(largest * np.array([1e-3, 1e-9, 1e-11]) / (8 / 9 * 0.3))
    np.testing.assert_allclose(twist.stick_radius[1:], c[1:], rtol=1e-4)
    assert (twist.error_estimates < 0.1).all()
    # The rotation is well determined: P = p0 (ln(4/c) - 1).
    np.testing.assert_allclose(twist.rotation[1:], 0.15 * (np.log(4 / c[1:]) - 1), rtol=1e-5)


@pytest.mark.parametrize("c", [0.999, 0.6, 0.3, 0.05])
@pytest.mark.parametrize("fields_", PROFILES, ids=lambda fields_: fields_["kind"])
def test_shear_stress_carries_the_torque(fields_: dict[str, Any], c: float) -> None:
    """2 pi int tau r^2 dr = M, tau = mu p in the slip annulus, and less than that within."""
    profile = profile_from(fields_)
    twist = twisted(profile, stick_radius=c)
    nodes, weights = np.polynomial.legendre.leggauss(160)
    stops, total = sorted({0.0, c, 1.0, *(float(b) for b in profile.breaks if b < 1)}), 0.0
    for low, high in pairwise(stops):
        # Points cluster at both ends, at which the stress has roots or logarithms.
        t = (nodes + 1) / 2
        r = low + (high - low) * t**3 * (10 - 15 * t + 6 * t * t)
        slope = (high - low) * 30 * t**2 * (1 - t) ** 2 / 2
        stress = fields.torsional_stress(twist, r)
        total += (weights * slope * 2 * np.pi * r**2 * stress).sum()
        pressure = MU * fields.pressure(twist.normal, r)
        assert (stress <= pressure * (1 + 1e-11)).all()
        if low >= c:
            np.testing.assert_array_equal(stress, pressure)
    assert total == pytest.approx(float(twist.torque), rel=1e-9, abs=0)


def test_shear_stress_of_a_stuck_punch() -> None:
    """tau = (4 G phi/pi) r/sqrt(a^2 - r^2), the stress of a disc that turns."""
    twist, r = twisted(FlatPunch(1.0), rotation=-0.01), np.array([0.0, 0.3, 0.9])
    stress = fields.torsional_stress(twist, [*r, 1.0, 1.5])
    expected = -4 * G * 0.01 / np.pi * r / np.sqrt(1 - r * r)
    np.testing.assert_allclose(stress[:3], expected, rtol=1e-13)
    assert stress[3:].tolist() == [-np.inf, 0.0]
