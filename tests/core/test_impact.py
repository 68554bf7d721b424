"""Oblique impacts obey their closed forms, conserve energy, and are as exact as `rtol` requires."""

import math
from typing import Any

import numpy as np
import pytest

import mdr_core as mdr
from mdr_core import impact
from mdr_core.history import ContactState, advance, unloaded
from mdr_core.profiles import Profile
from tests.core.comparison import profile_from
from tests.core.evaluations import PROFILES

MU, E_STAR, G_STAR = 0.2, 1.0, 0.8
NORMAL_MASS, TANGENTIAL_MASS = 1.0, 2 / 7
KINDS = {kind: profile_from({"kind": kind, **profile}) for kind, profile in PROFILES.items()}


def solved(profile: Profile, v: Any, w: Any, **changed: float) -> impact.Impact:
    given = {"normal_mass": NORMAL_MASS, "tangential_mass": TANGENTIAL_MASS} | changed
    return impact.solve(
        profile, E_STAR, G_STAR, MU, **given, normal_velocity=v, tangential_velocity=w
    )


def speed(profile: Profile) -> float:
    """Velocity of approach at which the contact has the radius one."""
    contact = mdr.normal.solve(profile, E_STAR, **load_of_radius(profile))
    return math.sqrt(2 * float(contact.elastic_energy) / NORMAL_MASS)


def load_of_radius(profile: Profile) -> dict[str, float]:
    return {"normal_force": 1.0} if profile.kind == "flat_punch" else {"contact_radius": 1.0}


@pytest.mark.parametrize("kind", KINDS)
def test_sliding_throughout_follows_from_the_normal_impulse(kind: str) -> None:
    v = speed(KINDS[kind])
    change = 2 * MU * NORMAL_MASS * v / TANGENTIAL_MASS
    w = 5 * change
    hit = solved(KINDS[kind], v, [w, -w])
    assert hit.regime.tolist() == ["full_slip", "full_slip"]
    assert hit.tangential_rebound_velocity == pytest.approx(
        [w - change, change - w], rel=1e-10, abs=0
    )
    loss = TANGENTIAL_MASS * (w**2 - (w - change) ** 2) / 2
    assert hit.dissipated_energy == pytest.approx([loss, loss], rel=1e-4, abs=0)


@pytest.mark.parametrize("kind", KINDS)
def test_equal_frequencies_leave_no_slip(kind: str) -> None:
    # With m_t/m = G*/E* the point (d, u) moves along a line, on which nothing slips.
    v = speed(KINDS[kind])
    w = 0.9 * MU * v * E_STAR / G_STAR
    hit = solved(KINDS[kind], v, w, tangential_mass=NORMAL_MASS * G_STAR / E_STAR)
    assert hit.tangential_rebound_velocity == pytest.approx(-w, rel=1e-9, abs=0)
    assert hit.dissipated_energy == pytest.approx(0, abs=1e-9 * v**2)


@pytest.mark.parametrize("kind", KINDS)
def test_work_of_friction_is_the_loss_of_energy(kind: str) -> None:
    v = speed(KINDS[kind])
    w = MU * v * np.array([0.3, 1.0, 2.0, 4.0])
    hit = solved(KINDS[kind], v, w)
    lost = TANGENTIAL_MASS * (w**2 - hit.tangential_rebound_velocity**2) / 2
    assert hit.dissipated_energy == pytest.approx(lost, abs=1e-4 * TANGENTIAL_MASS * w.max() ** 2)
    impulse = TANGENTIAL_MASS * (w - hit.tangential_rebound_velocity)
    assert hit.tangential_impulse == pytest.approx(impulse, rel=1e-12, abs=0)
    assert set(hit.regime) <= {"partial_slip", "full_slip"}
    assert 0 < hit.error_estimate < 3e-4


@pytest.mark.parametrize("exponent", [0.6, 1.0, 2.0, 3.5])
def test_duration_of_a_power(exponent: float) -> None:
    # int dd/sqrt(1 - (d/d_max)^q) with the energy as the power q = 2 + 1/n of the depth.
    hit = solved(mdr.Power(0.3, exponent), 0.4, 0.0)
    q = 2 + 1 / exponent
    time = 2 * math.sqrt(math.pi) * math.gamma(1 + 1 / q) / math.gamma(0.5 + 1 / q)
    expected = time * hit.maximum_indentation_depth / 0.4
    assert hit.duration == pytest.approx(expected, rel=1e-7, abs=0)
    assert str(hit.regime) == "stick"
    energy = mdr.normal.solve(
        mdr.Power(0.3, exponent), E_STAR, normal_force=hit.maximum_normal_force
    ).elastic_energy
    assert energy == pytest.approx(NORMAL_MASS * 0.4**2 / 2, rel=1e-11, abs=0)


def test_alumina_on_glass() -> None:
    # Source: kharaz; values of an independent implementation of the memory.
    angle = np.radians([4.2, 9.8, 20.2, 30.4, 39.5])
    material = mdr.from_bodies([mdr.Body(360e9, 0.23), mdr.Body(70e9, 0.25)])
    mass = 4000 * 4 / 3 * math.pi * 2.5e-3**3
    v, w = 3.9 * np.cos(angle), 3.9 * np.sin(angle)
    hit = impact.solve(
        mdr.Paraboloid(2.5e-3),
        material,
        material,
        0.092,
        normal_mass=mass,
        tangential_mass=2 / 7 * mass,
        normal_velocity=v,
        tangential_velocity=w,
    )
    centre = 1 + 2 / 7 * (hit.tangential_rebound_velocity / w - 1)
    expected = [0.747045, 0.639908, 0.592916, 0.686380, 0.776790]
    assert centre == pytest.approx(expected, abs=1e-5)
    assert [notice.code for notice in hit.warnings] == ["half_space", "elastic_similarity"]


def stepped(profile: Profile, v: float, w: float, step: float) -> float:
    """Tangential velocity after the impact, by the implicit midpoint rule with `advance`."""

    def at(state: ContactState) -> np.ndarray:
        return np.array([state.indentation_depth, state.tangential_displacement])

    state = unloaded(profile, E_STAR, G_STAR, MU)
    velocity, mass = np.array([v, w]), np.array([NORMAL_MASS, TANGENTIAL_MASS])
    while velocity[0] > 0 or state.in_contact:
        old, before = state, velocity
        for _ in range(8):
            state = advance(old, *(at(old) + step * (before + velocity) / 2))
            work = (
                state.elastic_energy - old.elastic_energy,
                state.tangential_energy - old.tangential_energy + state.dissipation,
            )
            velocity = before - step * np.array(work) / (at(state) - at(old)) / mass
    return float(velocity[1])


@pytest.mark.parametrize(
    "kind",
    [
        "paraboloid",
        *(pytest.param(each, marks=pytest.mark.long) for each in ("rounded_punch", "sphere")),
    ],
)
def test_time_stepping_converges_to_the_result(kind: str) -> None:
    profile = KINDS[kind]
    v = speed(profile)
    w = 1.3 * MU * v
    hit = solved(profile, v, w)
    step = float(hit.duration) / 400
    coarse, fine = stepped(profile, v, w, 2 * step), stepped(profile, v, w, step)
    expected = fine + (fine - coarse) / 3
    assert hit.tangential_rebound_velocity == pytest.approx(
        expected, abs=3 * w * hit.error_estimate
    )
    assert hit.tangential_rebound_velocity == pytest.approx(expected, abs=1e-3 * w)


def error(hit: impact.Impact, exact: impact.Impact) -> float:
    """Largest error of the velocities and the energy, over the larger one before or after."""
    largest = max(abs(exact.tangential_velocity), abs(exact.tangential_rebound_velocity))
    velocity = abs(hit.tangential_rebound_velocity - exact.tangential_rebound_velocity) / largest
    energy = abs(hit.dissipated_energy - exact.dissipated_energy)
    return float(max(velocity, 2 * energy / (TANGENTIAL_MASS * largest**2)))


@pytest.mark.parametrize("seed", range(24))
def test_estimate_holds_for_random_impacts(seed: int) -> None:
    rng = np.random.default_rng(seed)
    # Kinds whose fine solutions take less than a second.
    kind = ("paraboloid", "cone", "truncated_paraboloid", "capped_paraboloid")[seed % 4]
    v = speed(KINDS[kind]) * rng.uniform(0.3, 1.0)
    w = MU * v * rng.uniform(0.05, 6.0)
    exact = solved(KINDS[kind], v, w, rtol=1e-6)
    assert exact.error_estimate <= 1e-6
    for rtol in (1e-3, 1e-4, 1e-5):
        hit = solved(KINDS[kind], v, w, rtol=rtol)
        assert hit.error_estimate <= rtol
        assert error(hit, exact) <= hit.error_estimate + exact.error_estimate
        assert not [notice for notice in hit.warnings if notice.code == "accuracy"]


@pytest.mark.long
@pytest.mark.parametrize("kind", ["paraboloid", "cone"])
def test_looser_tolerance_takes_less_work_and_a_tighter_one_errs_less(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Work is the number of samples; errors of several impacts are against a finer solution."""
    v = speed(KINDS[kind])
    velocities = MU * v * np.array([0.4, 1.0, 1.7, 2.6])
    exact = [solved(KINDS[kind], v, w, rtol=1e-8) for w in velocities]
    counts: list[int] = []
    motion = impact._motion

    def counted(scene: Any, count: int) -> Any:
        counts.append(count)
        return motion(scene, count)

    monkeypatch.setattr(impact, "_motion", counted)
    work, worst = {}, {}
    for rtol in (1e-3, 1e-6):
        hits = [solved(KINDS[kind], v, w, rtol=rtol) for w in velocities]
        work[rtol] = sum(counts)
        counts.clear()
        worst[rtol] = max(error(*pair) for pair in zip(hits, exact, strict=True))
    assert work[1e-3] <= 0.7 * work[1e-6]
    assert worst[1e-6] <= worst[1e-3] / 20


def test_tolerance_that_is_not_reached_is_a_warning() -> None:
    hit = solved(mdr.Paraboloid(1e5), 1.0, 0.3, rtol=1e-13)
    assert [notice.code for notice in hit.warnings] == ["accuracy"]
    assert 1e-13 < hit.error_estimate < 1e-7


@pytest.mark.parametrize("unit", [1e-40, 1e-9, 1e12])
def test_change_of_units(unit: float) -> None:
    # Masses as lengths keep the unit of time sqrt(m/(E* L)).
    punch, large = mdr.RoundedPunch(0.2, 1.0), mdr.RoundedPunch(0.2 * unit, unit)
    v, w = 0.1, np.array([0.01, 0.03])
    masses = {"normal_mass": 2.0, "tangential_mass": 0.6}
    hit = solved(punch, v, w, **masses)
    other = solved(large, unit * v, unit * w, **{k: unit * m for k, m in masses.items()})
    bound = 1e-10 * unit * w.min()
    for name in ("normal_rebound_velocity", "tangential_rebound_velocity"):
        expected = unit * getattr(hit, name)
        assert getattr(other, name) == pytest.approx(expected, rel=0, abs=bound), name
    assert other.duration == pytest.approx(hit.duration, rel=1e-10, abs=0)
    assert other.dissipated_energy == pytest.approx(
        unit**3 * hit.dissipated_energy, rel=1e-8, abs=0
    )


def test_one_impact_of_several_is_the_same_alone() -> None:
    profile = mdr.Cone(0.3)
    several = solved(profile, [0.2, 0.4], [0.05, -0.1])
    for i, (v, w) in enumerate([(0.2, 0.05), (0.4, -0.1)]):
        alone = solved(profile, v, w)
        assert alone.tangential_rebound_velocity == several.tangential_rebound_velocity[i]
        assert alone.duration == several.duration[i]


def test_rounding_errors_of_oscillations_are_not_refused() -> None:
    v, mass = 3e-5, 0.03
    w = v * np.array([0.05, 0.2, 0.4, 0.7, 1.0])
    hit = solved(mdr.Paraboloid(0.01), v, w, tangential_mass=mass)
    lost = mass * (w**2 - hit.tangential_rebound_velocity**2) / 2
    assert hit.dissipated_energy / (mass * w**2) == pytest.approx(lost / (mass * w**2), abs=5e-3)


def test_rapid_oscillations_are_refused() -> None:
    with pytest.raises(mdr.AccuracyError, match="tangential_mass: is so small"):
        solved(mdr.Cone(0.3), 0.1, 0.01, tangential_mass=1e-4)


def test_velocities_broadcast() -> None:
    v, w = np.array([[1.0], [2.0]]), np.array([5.0, 6.0, 7.0])
    after = solved(mdr.Paraboloid(1e5), v, w).tangential_rebound_velocity
    # Sliding throughout.
    expected = w - 2 * MU * NORMAL_MASS * v / TANGENTIAL_MASS
    assert after == pytest.approx(expected, rel=1e-12, abs=0)
