"""A ball rubbed by strokes longer than its contact wears by the law K p S."""

from __future__ import annotations

from functools import cache
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from mdr_core import normal
from mdr_core.errors import InputError
from mdr_core.profiles import (
    Cone,
    FlatPunch,
    Paraboloid,
    Profile,
    RoundedPunch,
    Tabulated,
    TruncatedCone,
)
from mdr_core.wear import evolution, limit
from tests.oracles.wear_full_slip import FullSlip

if TYPE_CHECKING:
    from mdr_core.normal import NormalContact

E_STAR, G_STAR, MU, WEAR = 1.3, 0.9, 0.4, 2e-4
RADII = np.linspace(0.0, 6.0, 61)
PROFILES: dict[str, Profile] = {
    "ball": Paraboloid(1.0),
    "cone": Cone(0.7),
    "rounded_punch": RoundedPunch(0.4, 1.0),
    "table": Tabulated(tuple(RADII.tolist()), tuple((RADII**2 / 2).tolist())),
}
HELD = ("normal_force", "indentation_depth")
#: Four decades of cycles, up to a contact of 1.4 times the first radius.
DECADES = (1.0, 10.0, 1e2, 1e3, 1e4)
#: The other kinds and the constant depth are in the long tier.
BALL_FIRST = pytest.mark.parametrize(
    ("kind", "held"),
    [
        pytest.param(
            kind, held, marks=() if (kind, held) == ("ball", HELD[0]) else pytest.mark.long
        )
        for kind in PROFILES
        for held in HELD
    ],
)


def pressed(kind: str, held: str) -> NormalContact:
    """The profile at a = 1 under a constant force or depth."""
    contact = normal.solve(PROFILES[kind], E_STAR, contact_radius=1.0)
    return normal.solve(PROFILES[kind], E_STAR, **{held: float(getattr(contact, held))})


@cache
def worn(
    kind: str, held: str, times: float = 2.0, cycles: tuple[float, ...] = DECADES, **given: Any
) -> evolution.WearEvolution:
    """Wear by an amplitude that is `times` the one at the onset of full slip."""
    contact = pressed(kind, held)
    moved = times * MU * E_STAR / G_STAR * float(contact.indentation_depth)
    return evolution.solve(
        contact, G_STAR, MU, wear_coefficient=WEAR, cycles=cycles,
        tangential_displacement=moved, **given,
    )  # fmt: skip


def friction_work(result: evolution.WearEvolution) -> np.ndarray[Any, np.dtype[np.float64]]:
    """4 mu int p (u_x - (mu E*/G*)(d - f)) 2 pi r dr of a cycle, by independent quadrature."""
    nodes, weights = leggauss(200)
    ratio, found = MU * E_STAR / G_STAR, []
    for row, (a, d) in enumerate(zip(result.contact_radius, result.indentation_depth, strict=True)):
        angle = pi / 4 * (1 + nodes)
        r = a * np.sin(angle)
        slip = float(result.tangential_contact.tangential_displacement) - ratio * (
            d - result.profile(r)[row]
        )
        ring = 2 * pi * r * a * np.cos(angle) * weights * pi / 4
        found.append(4 * MU * float(ring @ (result.pressure(r)[row] * slip)))
    return np.array(found)


@BALL_FIRST
def test_agreement_with_linear_elements_within_the_estimate(kind: str, held: str) -> None:
    """Independent of the product; with the error that the oracle itself states, below 2e-4."""
    result, profile = worn(kind, held), PROFILES[kind]
    load = "depth" if held == "indentation_depth" else "normal_force"
    oracle = FullSlip(
        profile.f, profile.g, E_STAR, G_STAR, MU, WEAR,
        displacement=float(result.tangential_contact.tangential_displacement),
        radius=float(result.normal.contact_radius),
        **{load: float(getattr(result.normal, held))},
    )  # fmt: skip
    # A break is the most expensive, and its estimate the largest.
    values, errors = oracle.extrapolated(DECADES, 20 if kind == "rounded_punch" else 60)
    assert (errors < 2e-4 * values).all()
    names = ("worn_volume", "indentation_depth", "normal_force", "contact_radius")
    for name, expected, error in zip(names, values, errors, strict=True):
        # The estimate of a force that wear takes away is relative to the force before wear.
        size = float(result.normal.normal_force) if name == "normal_force" else expected
        off = result.error_estimate * size + error
        assert (np.abs(getattr(result, name) - expected) <= off).all(), name


@BALL_FIRST
@pytest.mark.parametrize("times", [1.2, 1e4])
def test_worn_volume_is_k_times_the_friction_work(kind: str, held: str, times: float) -> None:
    """dV/dN = K W by Simpson's rule; W also from F_N and the elastic energy before wear."""
    cycles = tuple(np.array([1e-3, 540.0, 600.0, 660.0]) / times)
    # A break of the profile next to the onset takes more nodes.
    result = worn(kind, held, times, cycles, resolution=48 if kind == "rounded_punch" else 24)
    first, *work = friction_work(result)
    volume = WEAR * 120.0 / times / 6 * ([1.0, 4.0, 1.0] @ np.array(work))
    grown = result.worn_volume[3] - result.worn_volume[1]
    assert grown == pytest.approx(volume, rel=1e-4, abs=0)
    assert result.worn_volume[0] == pytest.approx(WEAR * first * cycles[0], rel=1e-4, abs=0)
    contact, ratio = result.normal, MU * E_STAR / G_STAR
    moved = float(result.tangential_contact.tangential_displacement)
    energy = float(contact.elastic_energy)
    before = 4 * MU * float(contact.normal_force) * moved - 8 * MU * ratio * energy
    assert result.worn_volume[0] == pytest.approx(WEAR * before * cycles[0], rel=1e-4, abs=0)


@pytest.mark.parametrize("kind", ["ball", "cone"])
def test_constant_depth_ends_where_nothing_touches(kind: str) -> None:
    """The limit is f = d within its radius: pi R d^2 of a ball, pi d^3/(3 tan^2) of a cone."""
    result = worn(kind, "indentation_depth", 2.0, (1e9,))
    depth = float(result.normal.indentation_depth)
    volume = {"ball": pi * depth**2, "cone": pi * depth**3 / (3 * 0.7**2)}[kind]
    radius = {"ball": np.sqrt(2 * depth), "cone": depth / 0.7}[kind]
    assert result.worn_volume[0] == pytest.approx(volume, rel=result.error_estimate, abs=0)
    assert result.contact_radius[0] == pytest.approx(radius, rel=result.error_estimate, abs=0)
    assert result.normal_force[0] <= 1e-5 * float(result.normal.normal_force)
    assert {"contact_lost", "limit_reached"} <= {notice.code for notice in result.warnings}


@pytest.mark.parametrize("cycles", [1e2, 1e6])
def test_long_strokes_wear_a_flat_scar(cycles: float) -> None:
    """Worn far beyond its elastic depth, a ball is flat up to a and carries a uniform pressure.

    Archard's law: pi a^4/(4 R) = 4 K mu F_N u_x N.
    """
    result = worn("ball", HELD[0], 1e4, (cycles,))
    force, a = float(result.normal.normal_force), float(result.contact_radius[0])
    moved = float(result.tangential_contact.tangential_displacement)
    volume = 4 * WEAR * MU * force * moved * cycles
    assert result.worn_volume[0] == pytest.approx(volume, rel=2e-4, abs=0)
    assert a == pytest.approx((4 * volume / pi) ** 0.25, rel=1e-2 * (1e2 / cycles) ** 0.5, abs=0)
    mean = force / (pi * a * a)
    assert result.pressure([0.0, 0.5 * a, 0.9 * a])[0] == pytest.approx(mean, rel=0.02, abs=0)
    assert "endless_wear" in {notice.code for notice in result.warnings}


@BALL_FIRST
def test_error_within_estimate(kind: str, held: str) -> None:
    truth = worn(kind, held, resolution=80, rtol=1e-8)
    for resolution in (8, 24):
        result = worn(kind, held, resolution=resolution)
        for name in ("worn_volume", "indentation_depth", "contact_radius"):
            expected = pytest.approx(getattr(truth, name), rel=result.error_estimate, abs=0)
            assert getattr(result, name) == expected, (resolution, name)
        whole = result.error_estimate * float(truth.normal.normal_force)
        assert result.normal_force == pytest.approx(truth.normal_force, rel=0, abs=whole)


def test_onset_of_full_slip_is_continuous() -> None:
    """At a constant depth, just below and above the onset."""
    below, above = (worn("ball", "indentation_depth", times) for times in (1 - 1e-4, 1 + 1e-4))
    assert above.worn_volume == pytest.approx(below.worn_volume, rel=2e-3, abs=0)


def test_limit_state_of_full_slip_is_that_of_the_limit_query() -> None:
    result = worn("cone", "indentation_depth", 3.0, (1e9,))
    moved = float(result.tangential_contact.tangential_displacement)
    exact = limit.solve(result.normal, G_STAR, MU, tangential_displacement=moved)
    r = np.linspace(0.0, 1.1 * float(exact.wear_radius), 24)
    off = result.field_error_estimate(r, ["worn_depth"]) * float(result.normal.indentation_depth)
    assert result.worn_depth(r)[0] == pytest.approx(exact.worn_depth(r), rel=0, abs=off)
    assert off < 5e-3


def test_what_full_slip_does_not_answer_is_rejected() -> None:
    moved: dict[str, Any] = {"tangential_displacement": 10.0}
    moved |= {"wear_coefficient": WEAR, "cycles": [1.0, 1e9]}
    punch = normal.solve(FlatPunch(1.0), E_STAR, normal_force=1.0)
    with pytest.raises(InputError, match="round the edge"):
        evolution.solve(punch, G_STAR, MU, **moved)
    ball = pressed("ball", HELD[0])
    force = {"tangential_force": MU * float(ball.normal_force)}
    with pytest.raises(InputError, match="prescribe the displacement"):
        evolution.solve(ball, G_STAR, MU, wear_coefficient=WEAR, cycles=[1.0], **force)
    table = normal.solve(PROFILES["table"], E_STAR, normal_force=0.1)
    with pytest.raises(InputError, match=r"the worn contact reaches radius 6") as caught:
        evolution.solve(table, G_STAR, MU, **moved)
    assert caught.value.path == ("cycles", 1)
    # Wear at the edge loads the axis, whose small slip stops.
    with pytest.raises(InputError, match="the axis sticks") as caught:
        worn("ball", HELD[0], 1.05)
    assert caught.value.path == ("cycles", 4)


@pytest.mark.parametrize("load", [{"normal_force": 0.0}, {"indentation_depth": 0.0}])
@pytest.mark.parametrize("profile", [Paraboloid(1.0), RoundedPunch(0.5, 2.0)])
def test_an_unloaded_contact_does_not_wear(profile: Profile, load: dict[str, float]) -> None:
    contact = normal.solve(profile, 1.0, **load)
    worn = evolution.solve(
        contact, 0.8, 0.3, wear_coefficient=1e-3, cycles=[1e5], tangential_displacement=0.1
    )
    assert worn.worn_volume == worn.dissipated_energy == 0
    assert worn.worn_depth([0.0, 0.2, 0.6]).max() == 0
    assert not {"endless_wear", "contact_lost"} & {each.code for each in worn.warnings}


@pytest.mark.long
def test_force_of_a_contact_that_is_lost_is_not_negative() -> None:
    cone = TruncatedCone(5.118414318771832e-4, 0.02031281477070676)
    contact = normal.solve(cone, 1.37706586091e11, indentation_depth=2.9158660487485462e-9)
    worn = evolution.solve(
        contact, 9.4253178667e10, 0.5, wear_coefficient=8.54232917622404e-12,
        cycles=[566475.5919754602], tangential_displacement=2.7268679184697464e-9, resolution=16,
    )  # fmt: skip
    assert 0 <= worn.normal_force[0] < worn.error_estimate * float(contact.normal_force)
