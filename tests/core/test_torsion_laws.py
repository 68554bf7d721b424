"""A twist respects energy, stiffness, order, symmetry, units and the rejection of bad input."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_core import adhesion, normal, tangential, torsion
from mdr_core.errors import InputError
from mdr_core.materials import Body, Material, from_bodies
from mdr_core.profiles import FlatPunch, Paraboloid, RoundedPunch, Sphere, TruncatedCone
from tests.core.comparison import profile_from
from tests.core.evaluations import PROFILES, profile_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from mdr_core.normal import NormalContact
    from mdr_core.torsion import TorsionalContact

    Array = NDArray[np.float64]

MU, G, E_STAR = 0.3, 0.7, 1.9
KINDS = sorted(PROFILES)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


def pressed(kind: str) -> NormalContact:
    return normal.solve(profile_of(kind), E_STAR, normal_force=0.4)


def twist(contact: NormalContact, **load: Any) -> TorsionalContact:
    return torsion.solve(contact, G, MU, **load)


def amplitude(contact: NormalContact, share: float) -> float:
    """Rotation at a share of the largest torque."""
    arm = float(twist(contact, rotation=0.0).torsion_arm)
    torque = share * MU * float(contact.normal_force) * arm
    return float(twist(contact, torque=torque).rotation)


def integral(contact: NormalContact, name: str, end: float) -> float:
    """int_0^end of a result over the rotation.

    In pieces that halve towards the rotations at which the slip front reaches a break, or a flat
    punch begins to slip: the law has roots or logarithms there.
    """
    a = float(contact.contact_radius)
    if contact.profile.kind == "flat_punch":
        inner = [MU * float(contact.normal_force) / (8 * G * a * a)]
    else:
        breaks = [float(b) for b in contact.profile.breaks if b < a]
        inner = [float(twist(contact, stick_radius=b).rotation) for b in breaks]
    halves = 0.5 ** np.arange(1, 40)
    shares = np.unique(np.concatenate([[0.0], halves, 1 - halves, [1.0]]))
    total, stops = 0.0, [0.0, *(phi for phi in inner if phi < end), end]
    for low, high in pairwise(stops):
        ends = low + (high - low) * shares
        half = np.diff(ends)[:, None] / 2
        phi = ends[:-1, None] + half * (1 + NODES)
        values = getattr(twist(contact, rotation=phi.ravel()), name).reshape(phi.shape)
        total += float((half * WEIGHTS * values).sum())
    return total


@pytest.mark.parametrize("share", [0.2, 0.9, 0.999])
@pytest.mark.parametrize("kind", KINDS)
def test_further_twist_turns_the_stick_zone(kind: str, share: float) -> None:
    """M is the integral of dM/dphi = (16/3) G c^3."""
    contact = pressed(kind)
    end = amplitude(contact, share)
    rise = integral(contact, "torsional_stiffness", end)
    assert rise == pytest.approx(float(twist(contact, rotation=end).torque), rel=1e-9, abs=0)
    stiffness = 16 / 3 * G * contact.contact_radius**3
    assert twist(contact, rotation=0.0).torsional_stiffness == pytest.approx(
        stiffness, rel=1e-14, abs=0
    )


@pytest.mark.parametrize("share", [0.2, 0.9, 0.999])
@pytest.mark.parametrize("kind", KINDS)
def test_dissipated_energy_is_work_less_stored_energy(kind: str, share: float) -> None:
    """The stored energy of a body under Coulomb friction is int phi dM."""
    contact = pressed(kind)
    end = amplitude(contact, share)
    work = integral(contact, "torque", end)
    found = twist(contact, rotation=end)
    dissipated = 2 * work - float(found.torque) * end
    scale = work if kind == "flat_punch" else float(found.dissipated_energy)
    assert found.dissipated_energy == pytest.approx(dissipated, abs=1e-9 * scale)


@pytest.mark.parametrize("load", ["torque", "rotation"])
@pytest.mark.parametrize("share", [0.3, 0.95])
@pytest.mark.parametrize("kind", KINDS)
def test_energy_of_a_cycle_is_the_area_of_its_loop(kind: str, share: float, load: str) -> None:
    contact = pressed(kind)
    turning = twist(contact, rotation=amplitude(contact, share))
    loop = torsion.cycle(contact, G, MU, **{load: getattr(turning, load)}, samples=8)
    # From the samples alone: Masing's rule, with twice the rotation and the torque.
    end, top = float(turning.rotation), float(turning.torque)
    half = integral(contact, "torque", end)
    area = 8 * half - 4 * end * top
    scale = end * top if kind == "flat_punch" else abs(area)
    assert loop.energy_per_cycle == pytest.approx(area, abs=1e-9 * scale)
    assert loop.rotation.shape == loop.torque.shape == (17,)
    # Closed, with opposite turning points, and odd.
    np.testing.assert_allclose(loop.torque[[0, 8, 16]], [top, -top, top], rtol=1e-11)
    np.testing.assert_allclose(loop.rotation[[0, 8, 16]], [end, -end, end], rtol=1e-12)
    np.testing.assert_array_equal(loop.torque[9:], -loop.torque[1:9])
    assert (np.diff(loop.torque[:9]) < 0).all()
    # Just after a reversal all of the contact sticks.
    first = np.diff(loop.torque[:2]) / np.diff(loop.rotation[:2])
    assert first == pytest.approx(16 / 3 * G * contact.contact_radius**3, rel=0.2, abs=0)


def test_samples_of_a_loop_enclose_its_energy() -> None:
    """The integral of the samples, by Fejer's rule at their Chebyshev points."""
    contact = pressed("paraboloid")
    loop = torsion.cycle(contact, G, MU, torque=[0.01, 0.03], samples=96)
    theta = np.linspace(0, np.pi, 97)
    for case in range(2):
        down = np.polynomial.chebyshev.Chebyshev.fit(np.cos(theta), loop.torque[:97, case], 96)
        mean = down.integ()(1.0) - down.integ()(-1.0)
        # The mirrored way back has the opposite mean.
        area = -2 * mean * loop.rotation[0, case]
        assert loop.energy_per_cycle[case] == pytest.approx(area, rel=1e-9, abs=0)


@pytest.mark.parametrize("kind", KINDS)
def test_torque_grows_towards_the_largest(kind: str) -> None:
    contact = pressed(kind)
    unit = float(twist(contact, stick_radius=0.5 * contact.contact_radius).rotation)
    phi = unit * np.geomspace(1e-12, 1e4, 60)
    found = twist(contact, rotation=phi)
    largest = MU * contact.normal_force * found.torsion_arm[0]
    assert (np.diff(found.torque) >= -1e-13 * found.torque[-1]).all()
    assert (np.diff(found.stick_radius) <= 0).all()
    assert (np.diff(found.dissipated_energy) >= 0).all()
    assert found.torque[-1] == pytest.approx(float(largest), rel=1e-13, abs=0)
    assert (found.torque <= largest * (1 + 1e-13)).all()
    assert found.torque[0] == pytest.approx(
        float(16 / 3 * G * contact.contact_radius**3 * phi[0]), rel=1e-6, abs=0
    )


def test_full_slip_dissipates_the_work_of_the_largest_torque() -> None:
    contact = pressed("sphere")
    far = twist(contact, rotation=[100.0, 200.0, -200.0])
    assert far.regime.tolist() == ["full_slip"] * 3
    assert far.stick_radius.tolist() == far.torsional_stiffness.tolist() == [0.0] * 3
    np.testing.assert_array_equal(far.slip_width, contact.contact_radius)
    gain = far.dissipated_energy[1] - far.dissipated_energy[0]
    assert gain == pytest.approx(100 * float(far.torque[0]), rel=1e-12, abs=0)
    assert far.torque[2] == -far.torque[1]
    # Where full slip begins, the energy is continuous.
    last = twist(contact, stick_radius=2.3e-16 * contact.contact_radius)
    beyond = twist(contact, rotation=last.rotation * 1.03)
    assert last.regime == "partial_slip"
    assert beyond.regime == "full_slip"
    gain = float(beyond.dissipated_energy - last.dissipated_energy)
    assert gain == pytest.approx(0.03 * float(last.rotation * last.torque), rel=1e-11, abs=0)


@pytest.mark.parametrize("load", ["torque", "rotation"])
def test_opposite_twist_has_the_opposite_sign(load: str) -> None:
    contact = pressed("cone")
    one, other = (twist(contact, **{load: value}) for value in (0.01, -0.01))
    for name in ("torque", "rotation"):
        assert getattr(other, name) == -getattr(one, name)
    for name in ("stick_radius", "slip_width", "dissipated_energy", "torsion_arm"):
        assert getattr(other, name) == getattr(one, name)


@pytest.mark.parametrize("pressure", [1e-50, 1e50])
@pytest.mark.parametrize("length", [1e-50, 1e50])
@pytest.mark.parametrize(
    "profile", [lambda unit: RoundedPunch(0.5 * unit, unit), lambda unit: Sphere(1.3 * unit)]
)
def test_units_scale(profile: Callable[[float], Any], length: float, pressure: float) -> None:
    def scaled(unit: float, modulus: float, **load: Any) -> TorsionalContact:
        contact = normal.solve(profile(unit), modulus, contact_radius=unit)
        return torsion.solve(contact, 0.4 * modulus, MU, **load)

    one = scaled(1.0, 1.0, stick_radius=[0.8, 0.4, 1e-3])
    energy = pressure * length * length * length
    for load, factor in (("stick_radius", length), ("rotation", 1.0), ("torque", energy)):
        other = scaled(length, pressure, **{load: getattr(one, load) * factor})
        for name, size in (
            ("torque", energy),
            ("rotation", 1.0),
            ("stick_radius", length),
            ("slip_width", length),
            ("dissipated_energy", energy),
            ("torsional_stiffness", energy),
            ("torsion_arm", length),
        ):
            expected = getattr(one, name) * size
            # The torque of the smallest stick radius is 1e-9 below the largest one.
            rel = 1e-12 if load != "torque" else 1e-5
            np.testing.assert_allclose(getattr(other, name), expected, rtol=rel)


def test_arrays_broadcast_with_the_normal_loads() -> None:
    contact = normal.solve(Paraboloid(1.0), E_STAR, normal_force=np.array([[0.2], [0.0], [0.6]]))
    rotations = np.array([0.0, 0.01, -0.1, 50.0])
    many = torsion.solve(contact, np.array([1.0, 2.0, 3.0, 4.0]), MU, rotation=rotations)
    assert many.torque.shape == (3, 4)
    for row, force in enumerate([0.2, 0.0, 0.6]):
        for column, rotation in enumerate(rotations):
            single = normal.solve(Paraboloid(1.0), E_STAR, normal_force=force)
            one = torsion.solve(single, column + 1.0, MU, rotation=rotation)
            for name in one.quantities:
                value = getattr(many, name)
                value = value[row, column] if np.ndim(value) and value.shape == (3, 4) else value
                if name == "torsion_arm":
                    value = many.torsion_arm[row, 0]
                if name == "regime":
                    assert value == getattr(one, name)
                else:
                    assert value == pytest.approx(float(getattr(one, name)), rel=1e-12, abs=0)


def test_a_sweep_of_profiles_is_its_single_cases() -> None:
    flats, radii, modulus = np.array([0.2, 0.5]), np.array([1.0, 3.0]), np.array([1.0, 2.0])
    swept = normal.solve(RoundedPunch(flats, radii), modulus, normal_force=0.3)
    many = torsion.solve(swept, G, MU, torque=[0.01, -0.02])
    for case, torque in enumerate([0.01, -0.02]):
        punch = RoundedPunch(float(flats[case]), float(radii[case]))
        alone = normal.solve(punch, float(modulus[case]), normal_force=0.3)
        one = torsion.solve(alone, G, MU, torque=torque)
        for name in ("rotation", "stick_radius", "dissipated_energy", "torsion_arm"):
            assert getattr(many, name)[case] == pytest.approx(
                float(getattr(one, name)), rel=1e-12, abs=0
            )


def test_a_contact_without_load_slips_or_rests() -> None:
    flat = normal.solve(TruncatedCone(1.0, 0.1), E_STAR, normal_force=[0.0, 1e-30])
    found = torsion.solve(flat, G, MU, rotation=[0.0, 1e-32])
    assert found.regime.tolist() == ["stick", "partial_slip"]
    assert found.torque[0] == found.dissipated_energy[0] == 0
    # The limit of a flat punch: on first contact the pressure is at the edge of the flat.
    np.testing.assert_allclose(found.torsion_arm, np.pi / 4, rtol=1e-12)
    assert torsion.solve(flat, G, MU, rotation=1.0).regime[0] == "full_slip"
    with pytest.raises(InputError, match="no equilibrium"):
        torsion.solve(flat, G, MU, torque=1e-40)


def test_dissimilar_bodies_are_a_warning() -> None:
    pair = from_bodies([Body(210e9, 0.3), Body(3e9, 0.4)])
    contact = normal.solve(Paraboloid(0.01), pair, normal_force=10.0)
    found = torsion.solve(contact, pair, MU, torque=1e-5)
    assert "elastic_similarity" in [notice.code for notice in found.warnings]
    assert found.model_error == contact.model_error
    assert found.to_dict()["normal_force"] == 10.0


BALL = normal.solve(Paraboloid(1.0), E_STAR, normal_force=[0.2, 0.4])
PUNCH = normal.solve(FlatPunch(1.0), E_STAR, normal_force=1.0)


@pytest.mark.parametrize(
    ("call", "path", "detail"),
    [
        (lambda: twist(BALL, torque=[0.0, 1.0]), ("torsion", "torque", 1), "no equilibrium"),
        (lambda: twist(BALL, torque=[0.0, -1.0]), ("torsion", "torque", 1), "no equilibrium"),
        (lambda: twist(BALL, stick_radius=[0.1, 2.0]), ("torsion", "stick_radius", 1), "between"),
        (lambda: twist(BALL, stick_radius=0.0), ("torsion", "stick_radius"), "without bound"),
        (lambda: twist(PUNCH, stick_radius=1.0), ("torsion", "stick_radius"), "flat punch"),
        (
            lambda: twist(normal.solve(Paraboloid(1.0), 1.0, contact_radius=1e-110), rotation=1.0),
            ("load", "contact_radius"),
            "double precision",
        ),
        (lambda: twist(BALL, rotation=[0.1, np.inf]), ("torsion", "rotation", 1), "finite"),
        (
            lambda: twist(BALL, rotation=[0.1, 0.2, 0.3]),
            ("torsion", "rotation"),
            "give one, or as many",
        ),
        (lambda: twist(BALL), ("torsion",), "exactly one"),
        (lambda: twist(BALL, torque=0.1, rotation=0.1), ("torsion",), "exactly one"),
        (
            lambda: torsion.solve(BALL, 0.0, MU, torque=0.0),
            ("material", "shear_modulus"),
            "positive",
        ),
        (
            lambda: torsion.solve(BALL, None, MU, torque=0.0),
            ("material", "shear_modulus"),
            "needed",
        ),
        (
            lambda: torsion.solve(BALL, Material(1.0, 0.9), MU, torque=0.0),
            ("material", "shear_modulus"),
            "needed",
        ),
        (
            lambda: torsion.solve(BALL, Body(1.0, 0.3), MU, torque=0.0),  # type: ignore[arg-type]
            ("material", "shear_modulus"),
            "both bodies",
        ),
        (lambda: torsion.solve(BALL, G, 0.0, torque=0.0), ("friction_coefficient",), "positive"),
        (lambda: twist(tangential.solve(BALL, G, MU, tangential_force=0.0)), ("contact",), "alone"),
        (
            lambda: twist(adhesion.solve(Paraboloid(1.0), 1.0, 0.01, normal_force=0.1), torque=0),
            ("contact",),
            "adhesion",
        ),
    ],
)
def test_bad_input_is_rejected(call: Callable[[], Any], path: tuple[str, ...], detail: str) -> None:
    with pytest.raises(InputError, match=detail) as caught:
        call()
    assert caught.value.path == path


def test_every_kind_is_tested() -> None:
    assert {profile_from({"kind": "cone", "slope": 1.0}).kind, *KINDS} == set(KINDS)
