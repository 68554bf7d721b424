"""Partial slip obeys the laws of energy, order, symmetry and units."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mdr_core import fields, normal, tangential
from mdr_core.errors import InputError
from mdr_core.profiles import FlatPunch, Paraboloid, RoundedPunch
from tests.core.comparison import profile_from
from tests.core.test_laws import (
    E_STAR,
    at_radius,
    break_radius,
    cases,
    integral,
    repeatable,
    rescaled,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mdr_core.normal import NormalContact
    from mdr_core.tangential import TangentialContact

    Array = NDArray[np.float64]
    Case = tuple[dict[str, Any], float]

G_STAR = 2.9
MU = 0.37
ANSWERS = (
    "tangential_force",
    "tangential_displacement",
    "stick_radius",
    "slip_width",
    "tangential_stiffness",
    "dissipated_energy",
)

ratio = st.floats(0.01, 0.97)


def near(value: Any, rel: float = 1e-12, absolute: float = 0.0) -> Any:
    """Relative comparison only: small loads give results far below pytest's absolute tolerance."""
    return pytest.approx(value, rel=rel, abs=absolute)


def solve_tangential(contact: NormalContact, **load: Any) -> TangentialContact:
    return tangential.solve(contact, G_STAR, MU, **load)


def at_ratio(fields_: dict[str, Any], radius: float, rho: float) -> TangentialContact:
    """F_x as a fraction of mu F_N."""
    contact = at_radius(fields_, radius)
    return solve_tangential(contact, tangential_force=rho * MU * float(contact.normal_force))


def knots(low: float, high: float, *between: float) -> list[float]:
    return [low, *sorted({x for x in between if low < x < high}), high]


def values(result: TangentialContact) -> list[float]:
    return [float(getattr(result, name)) for name in ANSWERS]


@repeatable
@given(cases(), ratio)
def test_traction_integrates_to_the_force(case: Case, rho: float) -> None:
    result = at_ratio(*case, rho)

    def ring(r: Array) -> Array:
        return 2 * pi * r * fields.shear_stress(result, r)

    c = float(result.stick_radius)
    carried = integral(ring, knots(0.0, case[1], break_radius(case[0]), c))
    assert carried == near(float(result.tangential_force), rel=1e-7)


@repeatable
@given(cases(), ratio)
def test_foundation_integrates_to_the_force(case: Case, rho: float) -> None:
    result = at_ratio(*case, rho)
    c = float(result.stick_radius)
    carried = 2 * integral(
        lambda x: fields.foundation_shear(result, x),
        knots(0.0, case[1], break_radius(case[0]), c),
    )
    assert carried == near(float(result.tangential_force), rel=1e-8)


@repeatable
@given(cases(), st.lists(st.floats(1e-30, 1.0), min_size=3, max_size=6, unique=True))
def test_slip_grows_with_the_force(case: Case, ratios: list[float]) -> None:
    contact = at_radius(*case)
    force = np.sort(ratios) * (MU * contact.normal_force)
    result = solve_tangential(contact, tangential_force=force)
    assert np.all(result.stick_radius >= 0)
    assert np.all(result.stick_radius <= contact.contact_radius)
    rounding = 1e-13
    assert np.all(np.diff(result.stick_radius) <= rounding * result.stick_radius[:-1])
    for name in ("tangential_displacement", "slip_width", "dissipated_energy"):
        answer = getattr(result, name)
        assert np.all(np.diff(answer) >= -rounding * answer[:-1]), name
        assert np.all(answer >= 0), name


@pytest.mark.parametrize("rho", [1e-100, 1e-200, 1e-300])
@repeatable
@given(cases())
def test_smallest_tangential_loads(rho: float, case: Case) -> None:
    """The product of two lengths underflows at such loads."""
    result = at_ratio(*case, rho)
    assert str(result.regime) == "partial_slip"
    slope = float(result.normal.profile.dg(np.array([case[1]]))[0])
    # At a kink g' has two limits, of which `dg` returns the upper one.
    assume(np.isfinite(slope))
    width = float(result.tangential_force) / (2 * MU * E_STAR * case[1] * slope)
    assert float(result.slip_width) == near(width, rel=1e-11)
    shift = float(result.tangential_force) / (2 * G_STAR * case[1])
    assert float(result.tangential_displacement) == near(shift, rel=1e-12)
    assert float(result.dissipated_energy) >= 0
    stress = fields.shear_stress(result, [0.0, 0.5 * case[1]])
    # A ring of force F_x at the edge.
    assert stress[0] == near(float(result.tangential_force) / (2 * pi * case[1] ** 2))


@repeatable
@given(cases(), st.floats(0.2, 0.95), st.just(0.0) | st.floats(1e-50, 0.999))
def test_traction_is_a_superposition_of_pressures(case: Case, stick: float, place: float) -> None:
    """Ciavarella-Jaeger: tau = mu [p(a) - p(c)], where the difference is well-conditioned."""
    fields_, a = case
    b = break_radius(fields_)
    blunt = fields_["kind"] in {"rounded_punch", "truncated_cone", "truncated_paraboloid"}
    c = b + (a - b) * stick if blunt else a * stick
    contact = at_radius(fields_, a)
    result = solve_tangential(contact, stick_radius=c)
    r = np.array([a * place])
    outer = fields.pressure(contact, r)
    inner = fields.pressure(at_radius(fields_, c), r)
    stress = fields.shear_stress(result, r)
    if np.isfinite(outer[0]) and np.isfinite(inner[0]):
        assert stress[0] == near(MU * (outer - inner)[0], 0.0, 1e-11 * MU * outer[0])


@repeatable
@given(cases(), st.floats(0.05, 0.8))
def test_stiffness_is_the_derivative_of_the_force(case: Case, rho: float) -> None:
    result = at_ratio(*case, rho)
    u = float(result.tangential_displacement)

    def stiffness(at: Array) -> Array:
        return solve_tangential(result.normal, tangential_displacement=at).tangential_stiffness

    ends = solve_tangential(result.normal, tangential_displacement=[u, 1.1 * u]).tangential_force
    work = integral(stiffness, [u, 1.1 * u])
    # Where the step crosses a break, c(u) has a kink; the error is that of the rule.
    assert ends[1] - ends[0] == near(work, rel=1e-5)


@repeatable
@given(cases(), ratio)
def test_reversed_direction_is_the_mirror_image(case: Case, rho: float) -> None:
    right = at_ratio(*case, rho)
    left = at_ratio(*case, -rho)
    for name, there, here in zip(ANSWERS, values(left), values(right), strict=True):
        odd = name in {"tangential_force", "tangential_displacement"}
        assert there == (-here if odd else here), name
    r = np.array([0.0, 0.3, 0.77, 0.999, 1.5]) * case[1]
    for name in ("shear_stress", "slip", "foundation_shear"):
        field = getattr(fields, name)
        assert np.array_equal(field(left, r), -field(right, r)), name
    assert np.all(fields.slip(right, r) <= 0)
    assert np.all(fields.shear_stress(right, r) >= 0)


def stored(result: TangentialContact, b: float) -> float:
    """Energy q_x^2/(2 G*) of the tangential springs."""
    c, a = float(result.stick_radius), float(result.normal.contact_radius)
    outer = integral(
        lambda x: fields.foundation_shear(result, x) ** 2,
        knots(c, a, b),
    )
    held = float(fields.foundation_shear(result, [0.5 * c])[0])
    return (outer + held**2 * c) / G_STAR


@repeatable
@given(cases(), st.floats(0.2, 0.97))
def test_dissipated_energy_is_work_minus_stored_energy(case: Case, rho: float) -> None:
    fields_, radius = case
    result = at_ratio(fields_, radius, rho)
    u = float(result.tangential_displacement)

    def force(at: Array) -> Array:
        return solve_tangential(result.normal, tangential_displacement=at).tangential_force

    middle = []
    b = break_radius(fields_)
    if float(result.stick_radius) < b < radius:
        middle = [float(solve_tangential(result.normal, stick_radius=b).tangential_displacement)]
    work = integral(force, knots(0.0, u, *middle))
    dissipated = float(result.dissipated_energy)
    assert dissipated == near(work - stored(result, b), 0.0, 1e-8 * work)


@repeatable
@given(cases(), ratio, st.floats(-9.0, 3.0), st.floats(-6.0, 6.0))
def test_results_scale_with_units(
    case: Case, rho: float, length_power: float, modulus_power: float
) -> None:
    fields_, radius = case
    unit, modulus = 10.0**length_power, 10.0**modulus_power
    old = at_ratio(fields_, radius, rho)
    force = modulus * unit**2
    contact = normal.solve(
        profile_from(rescaled(fields_, unit)),
        E_STAR * modulus,
        normal_force=float(old.normal.normal_force) * force,
    )
    load = float(old.tangential_force) * force
    new = tangential.solve(contact, G_STAR * modulus, MU, tangential_force=load)
    factors = (force, unit, unit, unit, modulus * unit, force * unit)
    for name, value, factor in zip(ANSWERS, values(old), factors, strict=True):
        # The rounding error of rho is amplified by up to 1/(1 - rho), a power's coefficient by its
        # exponent.
        assert float(getattr(new, name)) == near(value * factor, rel=2e-11), name


@repeatable
@given(cases())
def test_zero_force_gives_full_stick(case: Case) -> None:
    contact = at_radius(*case)
    for name in ANSWERS[:2]:
        result = solve_tangential(contact, **{name: 0.0})
        assert str(result.regime) == "stick"
        assert values(result) == [0.0, 0.0, case[1], 0.0, 2 * G_STAR * case[1], 0.0]
    result = solve_tangential(contact, stick_radius=case[1])
    assert str(result.regime) == "stick"
    assert values(result)[:4] == [0.0, 0.0, case[1], 0.0]
    assert not fields.shear_stress(result, [0.0, case[1] / 2]).any()
    assert not fields.slip(result, [0.0, case[1] / 2, case[1]]).any()


@repeatable
@given(cases())
def test_limiting_force_gives_full_slip(case: Case) -> None:
    contact = at_radius(*case)
    bound = MU * contact.normal_force
    most = MU * E_STAR / G_STAR * float(contact.indentation_depth)
    result = solve_tangential(contact, tangential_force=bound)
    sliding = solve_tangential(contact, tangential_displacement=2.5 * most)
    for one, u in ((result, most), (sliding, 2.5 * most)):
        assert str(one.regime) == "full_slip"
        assert float(one.tangential_force) == near(float(bound), rel=1e-15)
        assert float(one.tangential_displacement) == near(u, rel=1e-14)
        assert float(one.stick_radius) == 0
        assert float(one.slip_width) == case[1]
        assert float(one.tangential_stiffness) == 0
    extra = float(sliding.dissipated_energy) - float(result.dissipated_energy)
    assert extra == near(1.5 * most * float(bound), rel=1e-11)
    r = np.array([0.1, 0.6, 0.97]) * case[1]
    pressure = fields.pressure(contact, r)
    assert fields.shear_stress(result, r) == near(MU * pressure, rel=1e-11)


@repeatable
@given(cases())
def test_slip_with_zero_stick_radius_is_the_shape(case: Case) -> None:
    """With c = 0, Eq. (5.40) transforms g back to f."""
    contact = at_radius(*case)
    result = solve_tangential(contact, tangential_force=MU * contact.normal_force)
    r = np.array([0.2, 0.7, 0.98]) * case[1]
    shape = contact.profile.f(r)
    moved = fields.slip(result, r)
    assert moved == near(-MU * E_STAR / G_STAR * shape, rel=1e-11)


@repeatable
@given(cases())
def test_displacement_at_the_edge_and_in_the_far_field(case: Case) -> None:
    contact, a = at_radius(*case), case[1]
    r = np.array([a, np.nextafter(a, np.inf), 1e7 * a])
    up = fields.normal_displacement(contact, r)
    assert up[1] == near(up[0], rel=1e-6)
    afar = float(contact.normal_force) / (pi * E_STAR * r[2])
    assert up[2] == near(afar, rel=1e-11)


def test_slip_does_not_enter_a_flat() -> None:
    contact = normal.solve(RoundedPunch(0.6, 2.0), E_STAR, contact_radius=0.9)
    bound = MU * float(contact.normal_force)
    result = solve_tangential(contact, tangential_force=np.array([0.1, 0.999, 1 - 1e-12]) * bound)
    assert np.all(result.stick_radius >= 0.6)
    edge = solve_tangential(contact, stick_radius=0.6)
    assert float(edge.tangential_force) == near(bound, rel=1e-15)
    assert float(solve_tangential(contact, stick_radius=0.0).tangential_force) == near(bound)
    assert str(solve_tangential(contact, stick_radius=0.0).regime) == "full_slip"
    with pytest.raises(InputError) as caught:
        solve_tangential(contact, stick_radius=[0.7, 0.59])
    assert caught.value.path == ("tangential", "stick_radius", 1)


@pytest.mark.parametrize("profile", [Paraboloid(1.0), RoundedPunch(0.6, 2.0), FlatPunch(0.5)])
def test_zero_normal_load_has_no_friction(profile: Any) -> None:
    contact = normal.solve(profile, E_STAR, normal_force=0.0)
    still = solve_tangential(contact, tangential_force=0.0)
    assert str(still.regime) == "stick"
    moving = solve_tangential(contact, tangential_displacement=[0.0, 1e-3, -1e-3])
    assert list(moving.regime) == ["stick", "full_slip", "full_slip"]
    for result in (still, moving):
        for name in ("tangential_force", "dissipated_energy"):
            assert not getattr(result, name).any(), name
    with pytest.raises(InputError):
        solve_tangential(contact, tangential_force=1e-300)


def test_tangential_loads_broadcast_with_the_normal_ones() -> None:
    contact = normal.solve(Paraboloid(1.0), E_STAR, normal_force=[1.0, 2.0])
    result = solve_tangential(contact, tangential_force=[0.1, 0.3])
    for index, (n, f) in enumerate(((1.0, 0.1), (2.0, 0.3))):
        one = solve_tangential(
            normal.solve(Paraboloid(1.0), E_STAR, normal_force=n), tangential_force=f
        )
        for name in ANSWERS:
            assert getattr(result, name).shape == (2,)
            assert float(getattr(result, name)[index]) == float(getattr(one, name)), name
    wide = solve_tangential(
        normal.solve(Paraboloid(1.0), E_STAR, normal_force=1.0), stick_radius=[0.0, 0.1]
    )
    assert wide.tangential_force.shape == wide.slip_width.shape == (2,)
    stress = fields.shear_stress(result, [0.0, 0.1, 0.2])
    assert stress.shape == (2, 3)
