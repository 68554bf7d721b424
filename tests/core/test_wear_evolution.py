"""Wear obeys general laws, reaches its limit and agrees with an explicit scheme."""

from __future__ import annotations

from functools import cache, partial
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq

from mdr_core import fields, normal, tangential
from mdr_core.errors import InputError
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    FlatPunch,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    Tabulated,
    TruncatedCone,
)
from mdr_core.wear import evolution, integrator, limit
from tests.oracles.wear_explicit import Controls, Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mdr_core.wear.initial_state import InitialState

    Array = NDArray[np.float64]

E_STAR, G_STAR, MU, WEAR = 1.3, 0.9, 0.4, 2e-4
PROFILES: dict[str, Profile] = {
    "paraboloid": Paraboloid(1.0),
    "cone": Cone(0.7),
    "rounded_punch": RoundedPunch(0.4, 1.0),
    "sphere": Sphere(2.5),
}
MORE: dict[str, Profile] = {
    "power": Power(2.6, 0.8),
    "truncated_cone": TruncatedCone(0.4, 0.7),
    "tabulated": Tabulated(
        tuple(np.linspace(0, 3, 31).tolist()), tuple((np.linspace(0, 3, 31) ** 2 / 2).tolist())
    ),
}
MIXED = "force and displacement"
BY_FORCE = "depth and force"
CONTROLS = ("depth and displacement", "forces", MIXED)
#: Mixed control is the most expensive.
TWO_OF_THREE = pytest.mark.parametrize(
    "control", [*CONTROLS[:2], pytest.param(MIXED, marks=pytest.mark.long)]
)
ALL_CYCLES = (0.0, 1.0, 1e2, 1e3, 1e4, 1e6, 1e9, 1e12)
# The other kinds behave alike under each control, so one control suffices.
PAIRS = [(kind, control) for kind in PROFILES for control in CONTROLS]
PAIRS += zip(MORE, CONTROLS[::-1], strict=True)


@cache
def worn(
    kind: str,
    control: str,
    part: float = 0.45,
    cycles: tuple[float, ...] = ALL_CYCLES,
    **given: Any,
) -> evolution.WearEvolution:
    """The profile at a = 1, with the amplitude as a fraction of full slip."""
    shape = (PROFILES | MORE)[kind]
    contact = normal.solve(shape, E_STAR, contact_radius=1.0)
    if control.startswith("depth"):
        held = normal.solve(shape, E_STAR, indentation_depth=float(contact.indentation_depth))
    else:
        held = normal.solve(shape, E_STAR, normal_force=float(contact.normal_force))
    moved = part * MU * E_STAR / G_STAR * float(contact.indentation_depth)
    load: dict[str, float] = {"tangential_displacement": moved}
    if control in {"forces", BY_FORCE}:
        load = {"tangential_force": part * MU * float(contact.normal_force)}
    return evolution.solve(held, G_STAR, MU, wear_coefficient=WEAR, cycles=cycles, **load, **given)


def ring_integral(result: evolution.WearEvolution, cycle: int) -> float:
    """2 pi int h r dr by independent quadrature, split at slope jumps of h."""
    ends = [
        float(result.stick_radius[0]),
        float(result.stick_radius[cycle]),
        float(result.contact_radius[cycle]),
    ]
    nodes, weights = leggauss(80)
    total = 0.0
    for low, high in pairwise(ends):
        # The substitution removes the roots at both ends.
        angle = pi / 4 * (1 + nodes)
        r = low + (high - low) * np.sin(angle) ** 2
        step = (high - low) * np.sin(2 * angle) * pi / 4
        total += float((weights * step * 2 * pi * r * result.worn_depth(r)[cycle]).sum())
    return total


def friction_work(result: evolution.WearEvolution) -> Array:
    """(8 mu^2 E*^2/G*) int_c^a (d - g)(g - g(c)) dx of a cycle, by independent quadrature."""
    nodes, weights = leggauss(80)
    angle, found = pi / 4 * (1 + nodes), []
    for row, (c, a) in enumerate(zip(result.stick_radius, result.contact_radius, strict=True)):
        x = c + (a - c) * np.sin(angle) ** 2
        step = weights * (a - c) * np.sin(2 * angle) * pi / 4
        g = result.normal.profile.g(x) + result.spring_wear(x)[row]
        depth = result.indentation_depth[row]
        inner = float(result.normal.profile.g(c))
        if result.initial.stick_grows:
            # Worn by then, but the displacement is constant: G* u = mu E* (d - g(c)).
            moved = float(result.tangential_contact.tangential_displacement)
            inner = depth - G_STAR * moved / (MU * E_STAR)
        found.append(float(step @ ((depth - g) * (g - inner))))
    return np.array(found) * 8 * MU**2 * E_STAR**2 / G_STAR


@pytest.mark.parametrize("resolution", [24, 64])
@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("kind", PROFILES)
def test_initial_wear_follows_the_friction_work(kind: str, control: str, resolution: int) -> None:
    """Reference: dissipated energy of a cycle from the closed forms of partial slip."""
    result = worn(kind, control, cycles=(0.0,))
    step = 1e-6 * result.initial.cycle_unit
    early = worn(kind, control, cycles=(step,), resolution=resolution)
    work = 4 * float(result.initial.tangential_contact.dissipated_energy)
    expected = pytest.approx(WEAR * work * step, rel=1e-4 if resolution == 24 else 1e-6, abs=0)
    assert early.worn_volume[0] == expected


@pytest.mark.every(15)
@pytest.mark.parametrize(("kind", "control"), PAIRS)
def test_worn_volume_follows_the_friction_work(kind: str, control: str) -> None:
    """dV/dN = K W by Simpson's rule, W from the springs: notes, §6."""
    result = worn(kind, control)
    for cycle in (2, 4, 7):
        assert ring_integral(result, cycle) == pytest.approx(
            result.worn_volume[cycle], rel=1e-3, abs=0
        )
    steps = worn(kind, control, cycles=(90.0, 100.0, 110.0))
    volume = WEAR * 20.0 / 6 * ([1.0, 4.0, 1.0] @ friction_work(steps))
    assert np.ptp(steps.worn_volume) == pytest.approx(volume, rel=1e-4, abs=0)
    assert steps.dissipated_energy == pytest.approx(steps.worn_volume / WEAR, rel=1e-15, abs=0)


def limiting(result: evolution.WearEvolution) -> limit.LimitingWear:
    tangential_contact = result.initial.tangential_contact
    constant = result.initial.constant_displacement
    name = "tangential_displacement" if constant else "tangential_force"
    return limit.solve(
        result.initial.normal, G_STAR, MU, **{name: float(getattr(tangential_contact, name))}
    )


def distance(result: evolution.WearEvolution) -> float:
    """Largest distance of the last profile from the limiting one, relative to the depth."""
    r = np.linspace(0.0, 1.5 * float(result.contact_radius[-1]), 400)
    r = r[r < 0.99 * float(np.asarray(result.initial.normal.profile.domain))]
    exact = np.asarray(limiting(result).worn_depth(r))
    gap = np.abs(result.worn_depth(r)[-1] - exact).max()
    return float(gap / result.indentation_depth[-1])


@pytest.mark.every(14)
@pytest.mark.parametrize("part", [0.02, 0.45, 0.85])
@pytest.mark.parametrize("control", CONTROLS[:2])
@pytest.mark.parametrize("kind", PROFILES)
def test_final_profile_is_the_limiting_profile(kind: str, control: str, part: float) -> None:
    result = worn(kind, control, part)
    assert distance(result) <= 1e-4
    exact = limiting(result)
    assert result.contact_radius[-1] == pytest.approx(float(exact.wear_radius), rel=1e-4, abs=0)
    assert result.indentation_depth[-1] == pytest.approx(
        float(exact.indentation_depth), rel=1e-4, abs=0
    )
    assert result.normal_force[-1] == pytest.approx(float(exact.normal_force), rel=1e-4, abs=0)
    assert result.worn_volume[-1] == pytest.approx(float(exact.worn_volume), rel=1e-3, abs=0)
    assert "limit_reached" in {notice.code for notice in result.warnings}


@pytest.mark.every(15)
@pytest.mark.parametrize(("kind", "control"), PAIRS)
def test_wear_never_adds_material(kind: str, control: str) -> None:
    cycles = (0.0, *np.geomspace(1.0, 1e7, 22).tolist())
    result = worn(kind, control, cycles=cycles)
    c, a = float(result.stick_radius[0]), float(result.contact_radius[-1])
    r = c + (a - c) * np.linspace(-0.5, 1.2, 300)
    depth = result.worn_depth(r[r > 0])
    assert np.all(np.diff(depth, axis=0) >= 0)
    assert np.all(depth >= 0)
    assert np.all(depth[:, r[r > 0] < c] == 0)
    assert np.all(result.pressure(r[r > 0]) >= 0)
    noise = 1e-5
    for name in ("worn_volume", "contact_radius", "stick_radius", "indentation_depth"):
        answer = getattr(result, name)
        assert np.all(np.diff(answer) >= -noise * answer[-1]), name
    if control == CONTROLS[0]:
        assert np.all(np.diff(result.normal_force) <= noise * result.normal_force[0])
    else:
        assert np.all(result.normal_force == result.normal_force[0])


@pytest.mark.parametrize("control", CONTROLS[:2])
def test_worn_depth_has_a_single_maximum(control: str) -> None:
    """From the stick edge it increases to one maximum, then decreases to the contact edge."""
    cycles = tuple(np.geomspace(10.0, 1e5, 25).tolist())
    result = worn("paraboloid", control, cycles=cycles)
    for row, c, a in zip(
        result.worn_depth(0.3 + np.linspace(0.0, 1.4, 2000)),
        result.stick_radius,
        result.contact_radius,
        strict=True,
    ):
        r = 0.3 + np.linspace(0.0, 1.4, 2000)
        steps = np.diff(row[(r > c) & (r < a)])
        summit = int(np.argmax(steps < 0))
        assert np.all(steps[:summit] >= 0)
        assert np.all(steps[summit:] <= 1e-7 * row.max())


@TWO_OF_THREE
def test_pressure_integrates_to_the_force(control: str) -> None:
    result = worn("paraboloid", control, resolution=48)
    nodes, weights = leggauss(120)
    for cycle in (0, 2, 3):
        c, a = float(result.stick_radius[cycle]), float(result.contact_radius[cycle])
        carried = 0.0
        for low, high in ((0.0, c), (c, a)):
            angle = pi / 4 * (1 + nodes)
            r = low + (high - low) * np.sin(angle) ** 2
            step = (high - low) * np.sin(2 * angle) * pi / 4
            carried += float((weights * step * 2 * pi * r * result.pressure(r)[cycle]).sum())
        assert carried == pytest.approx(
            result.normal_force[cycle], rel=2e-3 if cycle else 1e-6, abs=0
        )


@pytest.mark.every(3)
@pytest.mark.parametrize("part", [1e-6, 1e-2])
@TWO_OF_THREE
def test_narrow_annulus_widens_by_half(control: str, part: float) -> None:
    """a - c grows by a half; depth and stick edge change to second order only."""
    result = worn("paraboloid", control, part)
    width = float(result.initial.tangential_contact.slip_width)
    grown = (result.contact_radius - result.stick_radius)[-1] / width
    assert grown == pytest.approx(1.5, rel=max(1e-4, part), abs=0)
    assert result.stick_radius[-1] - result.stick_radius[0] <= 2 * width**2 + 1e-9 * width
    assert result.error_estimate <= 0.02


@pytest.mark.every(4)
@pytest.mark.parametrize("part", [1e-3, 0.01, 0.1, 0.3])
def test_small_force_amplitude_at_constant_depth_reaches_the_limit(part: float) -> None:
    """The stick edge hardly moves: the layer outside it is thinner than the nodes' spacing.

    Reference: Eqs. (5.83) and (5.88) with c from 2 mu E* c (d - g(c)) = F_x, g = x^2, d = 1.
    """
    result = worn("paraboloid", BY_FORCE, part, cycles=(1e9,))
    c = brentq(lambda x: x - x**3 - part * 2 / 3, 0.6, 1.0, xtol=1e-15)

    def height(a: float) -> float:
        """Limiting less initial profile at a radius a."""
        root = np.sqrt(a * a - c * c)
        return float((1 - a * a / 2) * np.arccos(c / a) - c * root / 2) * 2 / pi

    a = brentq(height, c * (1 + 1e-9), 2.0, xtol=1e-15)
    assert result.stick_radius[0] == pytest.approx(c, rel=1e-7, abs=0)
    assert result.contact_radius[0] == pytest.approx(a, rel=1e-7, abs=0)
    angle, root = np.arccos(c / a), np.sqrt(a * a - c * c)
    volume = 2 * (a * a * angle - c * root) - (a**4 * angle + c * (a * a - 2 * c * c) * root) / 2
    assert result.worn_volume[0] == pytest.approx(volume, rel=1e-6, abs=0)


def test_estimate_where_the_contact_grows_over_a_break() -> None:
    """Both runs of the estimate err alike there; reference: F_N = F_N(c) + 2 E* c (d - g(c))."""
    d, moved = 0.07816829, 0.97 * 1.25 * 0.3 * 0.07816829
    contact = normal.solve(
        CappedParaboloid(0.69389344, 3.9115115, 1.02886893), 1.0, indentation_depth=d
    )
    result = evolution.solve(
        contact, 0.8, 0.3, wear_coefficient=10.0, cycles=[1e9], tangential_displacement=moved
    )
    # The stick zone is inside the cap, where g = x^2/R.
    c = np.sqrt(0.03 * d * 3.9115115)
    force = 4 * c**3 / (3 * 3.9115115) + 2 * c * 0.97 * d
    assert result.contact_radius[0] > 0.69389344
    assert result.normal_force[0] == pytest.approx(force, rel=result.error_estimate, abs=0)


def test_zero_cycles_is_the_initial_state() -> None:
    result = worn("paraboloid", CONTROLS[0])
    r = np.array([0.0, 0.3, 0.74, 0.8, 0.95, 1.3])
    assert np.array_equal(result.pressure(r)[0], fields.pressure(result.initial.normal, r))
    assert np.array_equal(result.profile(r)[0], result.initial.normal.profile.f(r))
    assert result.contact_radius[0] == pytest.approx(1.0, rel=1e-14, abs=0)


EXPLICIT_GRID = 360


@pytest.mark.parametrize("control", CONTROLS)
def test_agreement_with_the_explicit_scheme(control: str) -> None:
    """The error of the explicit scheme is of the order of its spacing, 1.8 a/360."""
    result = worn("paraboloid", control, cycles=(100.0, 300.0, 1000.0, 3000.0, 10000.0))
    r = np.arange(EXPLICIT_GRID) * (1.8 / EXPLICIT_GRID)
    scene = Scene(r, r * r / 2, E_STAR, G_STAR, MU, WEAR)
    tangential_contact, contact = result.initial.tangential_contact, result.initial.normal
    force, moved = float(contact.normal_force), float(tangential_contact.tangential_displacement)
    held = {
        CONTROLS[0]: Controls(depth=float(contact.indentation_depth), displacement=moved),
        CONTROLS[1]: Controls(
            normal_force=force, tangential_force=float(tangential_contact.tangential_force)
        ),
        CONTROLS[2]: Controls(normal_force=force, displacement=moved),
    }[control]
    states = scene.run(held, result.cycles.tolist())
    depth = result.worn_depth(r)
    for cycle, state in enumerate(states):
        gap = np.abs(state.profile - r * r / 2 - depth[cycle]).max()
        assert gap <= 8e-3 * result.indentation_depth[cycle]
        assert state.worn_volume == pytest.approx(result.worn_volume[cycle], rel=1.5e-2, abs=0)
        assert state.depth == pytest.approx(result.indentation_depth[cycle], rel=4e-3, abs=0)
        assert state.contact_radius == pytest.approx(result.contact_radius[cycle], rel=6e-3, abs=0)
        assert state.stick_radius == pytest.approx(result.stick_radius[cycle], rel=6e-3, abs=0)


def test_cost_is_independent_of_the_number_of_cycles(monkeypatch: pytest.MonkeyPatch) -> None:
    # Counts evaluations of the rate, which dominate the run time.
    called: list[int] = []
    rates = integrator.rates

    def counted(initial: InitialState, vector: Array) -> Array:
        called[-1] += 1
        return rates(initial, vector)

    monkeypatch.setattr(integrator, "rates", counted)
    for last in (1e4, 1e9):
        called.append(0)
        assert worn.__wrapped__("paraboloid", CONTROLS[1], cycles=(last,)).worn_volume[0] > 0
    assert 0 < called[1] <= 5 * called[0]


@TWO_OF_THREE
def test_results_scale_with_units(control: str) -> None:
    old = worn("paraboloid", control)
    length, modulus = 1e-6, 1e11
    force = modulus * length**2
    contact = old.initial.normal
    load = (
        {"indentation_depth": float(contact.indentation_depth) * length}
        if control == CONTROLS[0]
        else {"normal_force": float(contact.normal_force) * force}
    )
    tangential_contact = old.initial.tangential_contact
    moved: dict[str, float] = {
        "tangential_displacement": float(tangential_contact.tangential_displacement) * length
    }
    if control == CONTROLS[1]:
        moved = {"tangential_force": float(tangential_contact.tangential_force) * force}
    new = evolution.solve(
        normal.solve(Paraboloid(length), E_STAR * modulus, **load),
        G_STAR * modulus,
        MU,
        wear_coefficient=WEAR / modulus,
        cycles=ALL_CYCLES,
        **moved,
    )
    for name, unit in (
        ("worn_volume", length**3),
        ("indentation_depth", length),
        ("contact_radius", length),
        ("stick_radius", length),
        ("normal_force", force),
        ("dissipated_energy", force * length),
    ):
        # Rounding lets the integrator choose different steps.
        assert getattr(new, name) == pytest.approx(getattr(old, name) * unit, rel=1e-5, abs=0)


def test_no_wear_without_slip() -> None:
    punch = normal.solve(FlatPunch(1.0), E_STAR, normal_force=1.0)
    ball = normal.solve(Paraboloid(1.0), E_STAR, indentation_depth=1.0)
    for contact, amplitude in ((punch, 0.1), (ball, 0.0)):
        result = evolution.solve(
            contact, G_STAR, MU, wear_coefficient=1.0, cycles=[0, 1e6],
            tangential_displacement=amplitude,
        )  # fmt: skip
        r = np.array([0.0, 0.5, 0.9, 1.5])
        assert not result.worn_depth(r).any()
        assert not result.worn_volume.any()
        assert not result.dissipated_energy.any()
        assert np.all(result.stick_radius == 1.0)
        assert np.all(result.contact_radius == 1.0)
        assert np.all(result.normal_force == float(contact.normal_force))
        assert np.array_equal(result.pressure(r)[1], fields.pressure(contact, r))
        assert result.error_estimate < 1e-11


def test_contact_beyond_the_profile_is_rejected_with_its_cycle() -> None:
    table = Tabulated((0.0, 0.4, 0.8, 1.05), (0.0, 0.08, 0.32, 0.55125))
    contact = normal.solve(table, E_STAR, contact_radius=1.0)
    held = normal.solve(table, E_STAR, indentation_depth=float(contact.indentation_depth))
    amplitude = 0.3 * float(tangential.solve(held, G_STAR, MU, stick_radius=0.0).limiting_force)
    moved = 0.8 * MU * E_STAR / G_STAR * float(held.indentation_depth)
    assert amplitude > 0
    with pytest.raises(InputError) as caught:
        evolution.solve(
            held, G_STAR, MU, wear_coefficient=WEAR, cycles=[0.0, 1.0, 1e6],
            tangential_displacement=moved,
        )  # fmt: skip
    assert caught.value.path == ("cycles", 2)


@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
@pytest.mark.parametrize("amplitude", ["tangential_displacement", "tangential_force"])
def test_contact_that_ends_with_its_profile_cannot_wear(control: str, amplitude: str) -> None:
    table = Tabulated((0.0, 0.25, 0.5, 0.75, 1.0), (0.0, 0.03125, 0.125, 0.28125, 0.5))
    whole = normal.solve(table, E_STAR, contact_radius=1.0)
    load = {control: (1 - 1e-12) * float(getattr(whole, control))}
    contact = normal.solve(table, E_STAR, **load)
    with pytest.raises(InputError) as caught:
        evolution.solve(
            contact, G_STAR, MU, wear_coefficient=WEAR, cycles=[1e3], **{amplitude: 0.1 * MU}
        )
    assert caught.value.path == ("cycles", 0)


def test_radius_beyond_the_profile_is_rejected() -> None:
    result = worn("sphere", CONTROLS[0])
    for field in (*map(partial(getattr, result), evolution.FIELDS), result.field_error_estimate):
        with pytest.raises(InputError) as caught:
            field([0.0, 2.4, 2.6])
        assert caught.value.path == ("radius", 2)


@pytest.mark.parametrize("cycles", [1e6, 1e12])
def test_wear_settles_at_the_loosest_tolerance(cycles: float) -> None:
    """Errors of the integration stay below the pressure at which wear counts as ended."""
    contact = normal.solve(Paraboloid(0.1), 2.77, normal_force=1.5)
    amplitude = {"tangential_force": 0.57 * 0.715 * 1.5}
    worn = evolution.solve(
        contact,
        10.0,
        0.715,
        **amplitude,
        wear_coefficient=0.354,
        cycles=[cycles],
        resolution=8,
        rtol=1e-3,
    )
    limiting = limit.solve(contact, 10.0, 0.715, **amplitude)
    assert worn.settled_at < 1e3
    assert worn.worn_volume[0] == pytest.approx(
        float(limiting.worn_volume), rel=worn.error_estimate, abs=0
    )


def test_error_of_fields_next_to_the_edge_does_not_depend_on_units() -> None:
    """It is relative to the mean pressure, which is larger than the pressure there.

    The two runs are compared over the whole annulus; their difference next to c decides.
    """
    estimates = []
    for length in (1.0, 1e-6):
        contact = normal.solve(Paraboloid(length), E_STAR, indentation_depth=0.1 * length)
        moved = {"tangential_displacement": 0.02 * length}
        run = {"wear_coefficient": WEAR, "cycles": [1e3], "resolution": 8, "rtol": 1e-3}
        worn = evolution.solve(contact, G_STAR, MU, **moved, **run)
        edge = float(worn.contact_radius[0])
        estimates.append(worn.field_error_estimate([edge * (1 - 1e-6)], ["pressure"]))
    assert estimates[0] < 0.05
    assert estimates[1] == pytest.approx(estimates[0], rel=1e-3, abs=0)
