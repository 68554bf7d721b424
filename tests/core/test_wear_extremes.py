"""Wear that cannot be resolved or represented raises an error that names its cause."""

from typing import Any

import numpy as np
import pytest

from mdr_core import normal, tangential
from mdr_core.errors import AccuracyError, InputError
from mdr_core.profiles import (
    Cone,
    Paraboloid,
    Power,
    Profile,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr_core.wear import evolution, integrator, limit
from mdr_core.wear.initial_state import InitialState


@pytest.mark.parametrize("cycles", [2e-309, 1e-250])
def test_too_few_cycles_are_rejected(cycles: float) -> None:
    contact = normal.solve(Paraboloid(2.0), 2.3e9, normal_force=1e5)
    given: dict[str, Any] = {"wear_coefficient": 1e-13, "tangential_displacement": 1e-5}
    with pytest.raises(AccuracyError, match="request more cycles") as caught:
        evolution.solve(contact, 1.9e9, 0.4, cycles=[cycles], resolution=8, **given)
    assert caught.value.path == ("cycles",)


def test_unresolved_annulus_is_rejected() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    with pytest.raises(AccuracyError) as caught:
        evolution.solve(
            contact,
            1.0,
            0.4,
            wear_coefficient=1e-4,
            cycles=[1e7],
            tangential_displacement=0.4 * (1 - 1e-7),
            resolution=8,
        )
    assert caught.value.path == ("resolution",)


def test_overflowing_outer_radius_is_rejected() -> None:
    """Near full slip the depth grows without bound, and r^0.05 reaches it beyond 1e308."""
    contact = normal.solve(Power(0.0175, 0.05), 4e27, normal_force=[3.43e16])
    force = [0.9999999999 * 38.7 * 3.43e16]
    with pytest.raises(InputError, match="double precision") as caught:
        _ = limit.solve(contact, 4e27, 38.7, tangential_force=force).wear_radius
    assert caught.value.path == ("load", "normal_force", 0)


@pytest.mark.parametrize("size", [1e-50, 1e-20, 1e50])
def test_limit_under_a_needle_is_similar_at_every_size(size: float) -> None:
    """Depths scale with a^0.05. The stick radius is 1e-140 a, the square of which may underflow."""
    needle, limits = Power(1.0, 0.05), []
    for a in (1.0, size):
        depth = normal.solve(needle, 1.0, contact_radius=a).indentation_depth
        contact = normal.solve(needle, 1.0, indentation_depth=depth)
        slips = 0.5 * depth * (1 - 1e-7)
        worn = limit.solve(contact, 1.0, 0.5, tangential_displacement=slips)
        limits.append([worn.wear_radius / a, worn.worn_volume / (a * a * depth)])
    assert limits[1] == pytest.approx(limits[0], rel=1e-11, abs=0)


def kinked(corner: float = 1.0) -> Tabulated:
    """A paraboloid with a corner."""
    r = np.linspace(0.0, 3.0, 13)
    return Tabulated(tuple(r), tuple(r**2 / 2 + 0.5 * np.maximum(r - corner, 0)), (corner,))


@pytest.mark.parametrize(
    "width", [0.2, *(pytest.param(width, marks=pytest.mark.long) for width in (0.4, 0.6))]
)
def test_edge_of_the_contact_passes_a_break_in_few_steps(
    width: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """g' is infinite beyond the break, which the nodes pass one after the other."""
    body = kinked()
    contact = normal.solve(body, 1.3, contact_radius=1.0003)
    within = normal.solve(body, 1.3, contact_radius=1.0003 - width)
    contact = normal.solve(body, 1.3, normal_force=float(contact.normal_force))
    monkeypatch.setattr(integrator, "_MAX_CALLS", 2000)
    worn = evolution.solve(
        contact,
        0.9,
        0.4,
        wear_coefficient=2e-4,
        cycles=[1e2, 1e4],
        resolution=24,
        tangential_force=0.4 * float(contact.normal_force - within.normal_force),
    )
    assert worn.contact_radius[-1] > 1.003


@pytest.mark.long
@pytest.mark.parametrize("held", ["indentation_depth", "normal_force"])
def test_edge_of_the_contact_leaves_a_break_that_it_rests_on(held: str) -> None:
    """The slope of g is infinite at the edge; reference: the limit once wear has stopped."""
    body = kinked()
    contact = normal.solve(body, 1.0, contact_radius=1.5)
    moved = {"tangential_displacement": 0.1 * float(contact.indentation_depth)}
    contact = normal.solve(body, 1.0, **{held: float(getattr(contact, held))})
    if held == "normal_force":
        start = tangential.solve(contact, 0.8, 0.3, **moved)
        moved = {"tangential_force": float(start.tangential_force)}
    worn = evolution.solve(contact, 0.8, 0.3, wear_coefficient=10.0, cycles=[1e6], **moved)
    exact = limit.solve(contact, 0.8, 0.3, **moved)
    assert worn.error_estimate < 0.02
    for value, true in (
        (worn.contact_radius[0], float(exact.wear_radius)),
        (worn.worn_volume[0], float(exact.worn_volume)),
    ):
        assert value == pytest.approx(true, rel=worn.error_estimate, abs=0)


def test_stick_edge_that_moves_inwards_past_a_break_is_an_error() -> None:
    """More nodes do not resolve it: the error names the radius."""
    body = kinked(0.5)
    contact = normal.solve(body, 1.0, contact_radius=0.9)
    contact = normal.solve(body, 1.0, indentation_depth=float(contact.indentation_depth))
    start = tangential.solve(contact, 0.8, 0.3, stick_radius=0.505)
    force = {"tangential_force": float(start.tangential_force)}
    cycles = InitialState(start, 10.0, 40).cycle_unit * np.array([0.1, 1.0])
    assert 0.5 < float(start.stick_radius) < 0.51
    with pytest.raises(AccuracyError, match=r"the stick edge moves past radius 0\.5,") as caught:
        evolution.solve(contact, 0.8, 0.3, wear_coefficient=10.0, cycles=cycles, **force)
    assert caught.value.path == ("cycles",)
    early = evolution.solve(contact, 0.8, 0.3, wear_coefficient=10.0, cycles=cycles[:1], **force)
    assert early.stick_radius[0] > 0.5


def test_jump_of_slope_in_a_narrow_annulus_is_an_error_that_names_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    body = kinked()
    contact = normal.solve(body, 1.3, contact_radius=1 + 9e-7)
    within = normal.solve(body, 1.3, contact_radius=1 - 1e-7)
    contact = normal.solve(body, 1.3, indentation_depth=float(contact.indentation_depth))
    moved = 0.4 * 1.3 / 0.9 * float(contact.indentation_depth - within.indentation_depth)
    monkeypatch.setattr(integrator, "_MAX_CALLS", 500)
    with pytest.raises(AccuracyError, match=r"the worn annulus contains radius 1,") as caught:
        evolution.solve(
            contact, 0.9, 0.4, wear_coefficient=2e-4, cycles=[1e8], tangential_displacement=moved
        )
    assert caught.value.path == ("cycles",)


@pytest.mark.parametrize("place", [0.1, 0.5, 0.9])
def test_first_wear_of_a_narrow_annulus_about_a_break_is_within_its_estimate(place: float) -> None:
    """Against the friction work of a cycle from partial slip."""
    body, width = kinked(), 0.01
    contact = normal.solve(body, 1.3, contact_radius=1 + place * width)
    within = normal.solve(body, 1.3, contact_radius=1 + (place - 1) * width)
    given = {"tangential_force": 0.4 * float(contact.normal_force - within.normal_force)}
    contact = normal.solve(body, 1.3, normal_force=float(contact.normal_force))
    given |= {"wear_coefficient": 2e-4}
    cycles = 1e-6 * evolution.solve(contact, 0.9, 0.4, cycles=[0.0], **given).initial.cycle_unit
    worn = evolution.solve(contact, 0.9, 0.4, cycles=[cycles], **given)
    work = 4 * float(worn.initial.tangential_contact.dissipated_energy) * cycles
    bound = pytest.approx(2e-4 * work, rel=worn.error_estimate, abs=0)
    assert worn.worn_volume[0] == bound


@pytest.mark.parametrize("body", [TruncatedCone(0.5, 1.0), TruncatedParaboloid(1.0, 1.0)])
def test_narrow_annulus_next_to_a_flat_wears_to_its_limit(body: Profile) -> None:
    contact = normal.solve(body, 1.3, contact_radius=1 + 1e-6)
    within = normal.solve(body, 1.3, contact_radius=1 + 2e-8)
    contact = normal.solve(body, 1.3, indentation_depth=float(contact.indentation_depth))
    rise = float(contact.indentation_depth - within.indentation_depth)
    moved = {"tangential_displacement": 0.4 * 1.3 / 0.9 * rise}
    worn = evolution.solve(contact, 0.9, 0.4, wear_coefficient=2e-4, cycles=[1e12], **moved)
    limit_volume = float(limit.solve(contact, 0.9, 0.4, **moved).worn_volume)
    assert worn.error_estimate < 2e-4
    bound = pytest.approx(limit_volume, rel=worn.error_estimate, abs=0)
    assert worn.worn_volume[0] == bound


@pytest.mark.parametrize(
    ("body", "part"), [(TruncatedParaboloid(0.3, 1.0), 2e-4), (Paraboloid(1.0), 1e-8)]
)
def test_first_cycle_of_a_narrow_annulus_takes_few_steps(
    body: Profile, part: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first cycle wears 1e-6 of the total, which must exceed the rounding error of the slip."""
    contact = normal.solve(body, 1.0, contact_radius=0.3 * (1 + 1.5e-5))
    contact = normal.solve(body, 1.0, indentation_depth=float(contact.indentation_depth))
    force = {"tangential_force": part * 0.4 * float(contact.normal_force)}
    start = tangential.solve(contact, 1.2, 0.4, **force)
    cycles = InitialState(start, 1e-3, 40).cycle_unit * np.array([1e-6, 1.0])
    monkeypatch.setattr(integrator, "_MAX_CALLS", 1500)
    worn = evolution.solve(contact, 1.2, 0.4, wear_coefficient=1e-3, cycles=cycles, **force)
    assert worn.error_estimate < 1e-3


@pytest.mark.parametrize("body", [Power(1.0, 3.0), Sphere(2.5), TruncatedCone(0.5, 1.0)])
def test_tightest_tolerance_takes_few_steps_in_mixed_control(
    body: Profile, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The rounding error in the rate of the retained wear stays below the tolerance."""
    contact = normal.solve(body, 1.3, contact_radius=1.0)
    moved = 0.2 * 1.3 / 0.9 * float(contact.indentation_depth)
    contact = normal.solve(body, 1.3, normal_force=float(contact.normal_force))
    given: dict[str, Any] = {"wear_coefficient": 1e-6, "resolution": 16, "cycles": [1e-3, 100.0]}
    given |= {"tangential_displacement": moved}
    monkeypatch.setattr(integrator, "_MAX_CALLS", 600)
    worn = evolution.solve(contact, 0.9, 0.4, **given)
    rough = evolution.solve(contact, 0.9, 0.4, **given)
    for name in ("worn_volume", "stick_radius"):
        off = pytest.approx(getattr(worn, name), rel=1e-4, abs=0)
        assert getattr(rough, name) == off, name


def test_limit_within_the_rounding_error_of_a_flat_is_rejected() -> None:
    """Otherwise a worn volume would be negative."""
    contact = normal.solve(TruncatedCone(0.4, 0.7), 1.3, indentation_depth=[1e-3, 1e-11])
    with pytest.raises(AccuracyError, match="edge of a flat") as caught:
        limit.solve(contact, 0.9, 0.4, tangential_displacement=1e-12)
    assert caught.value.path == ("load", "indentation_depth", 1)


def test_equal_numbers_of_cycles_are_ascending() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    given = {"wear_coefficient": 1e-2, "tangential_displacement": 0.75, "resolution": 8}
    worn = evolution.solve(contact, 1.0, 1.0, cycles=[5.0, 5.0], **given)
    assert worn.worn_volume[0] == worn.worn_volume[1] > 0
    with pytest.raises(InputError, match="ascending") as raised:
        evolution.solve(contact, 1.0, 1.0, cycles=[5.0, 5.0, 4.0], **given)
    assert raised.value.path == ("cycles", 2)


def test_worn_profile_is_defined_up_to_the_end_of_the_profile() -> None:
    contact = normal.solve(Sphere(2.0), 1.0, indentation_depth=0.1)
    worn = limit.solve(contact, 1.0, 1.0, tangential_displacement=1e-3)
    end = float(contact.profile.domain)
    height = 2 - np.sqrt((2 - end) * (2 + end))
    assert worn.initial_profile([end])[0] == pytest.approx(height, rel=1e-14, abs=0)
    with pytest.raises(InputError) as raised:
        worn.initial_profile([end, np.nextafter(end, 3.0)])
    assert raised.value.path == ("radius", 1)


@pytest.mark.parametrize(
    ("profile", "load", "amplitude", "rtol"),
    [
        (
            Cone(0.1),
            {"normal_force": 0.1 * np.pi / 2},
            {"tangential_displacement": 0.02 * np.pi},
            1e-3,
        ),
        (Paraboloid(1.0), {"indentation_depth": 1.0}, {"tangential_force": 0.2}, 1e-9),
    ],
    ids=["cone at 1e-3", "depth with a force at 1e-9"],
)
def test_loosest_and_tight_tolerances_are_answered(
    profile: Profile, load: dict[str, Any], amplitude: dict[str, Any], rtol: float
) -> None:
    contact = normal.solve(profile, 1.0, **load)
    given: dict[str, Any] = {"wear_coefficient": 1e-3, "cycles": [1e4, 3e4], **amplitude}
    finer = evolution.solve(contact, 1.0, 0.5, **given, resolution=64)
    result = evolution.solve(contact, 1.0, 0.5, **given, rtol=rtol)
    error = np.abs(result.worn_volume / finer.worn_volume - 1).max()
    assert error <= result.error_estimate + finer.error_estimate
