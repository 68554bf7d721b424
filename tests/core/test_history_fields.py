"""Fields at the end of a history would not be the superpositions of Eqs. (5.18) and (5.38)."""

import numpy as np
import pytest

from mdr_core import fields, history, normal, tangential
from mdr_core.history import ContactState
from mdr_core.profiles import (
    Cone,
    FlatPunch,
    Paraboloid,
    Profile,
    RoundedPunch,
    TruncatedParaboloid,
)
from tests.core.comparison import EPS
from tests.core.test_history_arc_fields import CYCLE, MU, PROFILES, E, G


def by_kind(profile: Profile) -> str:
    return profile.kind


def load_history_end(profile: Profile) -> ContactState:
    return history.solve(profile, E, G, MU, **CYCLE).state


def hertz(a: float, r: np.ndarray) -> np.ndarray:
    """Pressure of the unit paraboloid over E*, Eq. (5.38)."""
    return 2 / np.pi * np.sqrt(np.maximum(a * a - r * r, 0.0))


def test_reversal_superposes_two_cattaneo_mindlin_fields() -> None:
    # Eq. (5.18) with Masing's rule: tau = tau(c) - 2 tau(c2).
    first, back = 0.3, 0.05
    state = history.solve(
        Paraboloid(1.0), E, G, MU, normal_force=1.0, tangential_force=[0.0, first, back]
    ).state
    a = (3 / (4 * E)) ** (1 / 3)
    c = a * (1 - first / MU) ** (1 / 3)
    c2 = a * (1 - (first - back) / (2 * MU)) ** (1 / 3)
    np.testing.assert_allclose(state.slip_fronts, [c, c2], rtol=1e-14)
    r = np.linspace(0, 0.99 * a, 37)
    expected = MU * E * (hertz(a, r) - hertz(c, r) - 2 * (hertz(a, r) - hertz(c2, r)))
    result = fields.shear_stress(state, r)
    np.testing.assert_allclose(result, expected, rtol=1e-12, atol=1e-13 * MU * E * a)


@pytest.mark.parametrize("profile", PROFILES, ids=by_kind)
@pytest.mark.parametrize("ratio", [1e-9, 1e-6, 0.01, 0.6])
def test_single_load_equals_the_tangential_query(profile: Profile, ratio: float) -> None:
    contact = normal.solve(profile, E, normal_force=1.0)
    once = tangential.solve(contact, G, MU, tangential_force=ratio * MU)
    load_path = history.solve(
        profile, E, G, MU, normal_force=1.0, tangential_force=[0.0, ratio * MU]
    )
    a = float(contact.contact_radius)
    r = np.array([0.0, 0.2, 0.5, 0.77, 0.9]) * a
    # The width of a narrow annulus is a difference of rounded coordinates.
    rtol = 1e-11 + 8 * EPS / ratio
    for field in (fields.shear_stress, fields.foundation_shear):
        np.testing.assert_allclose(field(load_path.state, r), field(once, r), rtol=rtol)
    slip = fields.slip(once, r)
    np.testing.assert_allclose(fields.slip(load_path.state, r), slip, rtol=10 * rtol, atol=1e-300)


@pytest.mark.parametrize("amplitude", [1e-9, 0.3])
def test_springs_that_stick_carry_the_displacement(amplitude: float) -> None:
    """G* u_x, here zero: the steps of q_x over the slip annuli cancel."""
    path = np.array([0.0, amplitude, 0.0]) * MU * E / G * 0.7
    result = history.solve(
        TruncatedParaboloid(0.5, 2.0), E, G, MU, indentation_depth=0.7, tangential_displacement=path
    )
    r = np.array([0.0, 0.3, 0.5, 0.6])
    assert result.slip_fronts[0] > r[-1]
    assert fields.foundation_shear(result.state, r) == pytest.approx(0 * r, abs=0)


def test_traction_of_a_flat_punch() -> None:
    state = load_history_end(FlatPunch(0.5))
    r = np.array([0.0, 0.3, 0.49])
    expected = 0.1 / (2 * np.pi * 0.5 * np.sqrt(0.25 - r * r))
    np.testing.assert_allclose(fields.shear_stress(state, r), expected, rtol=1e-13)
    assert np.all(fields.slip(state, r) == 0)
    assert np.isposinf(fields.shear_stress(state, [0.5])[0])
    assert state.slip_fronts.size == 0


@pytest.mark.parametrize("profile", PROFILES, ids=by_kind)
def test_separated_contact_has_zero_traction(profile: Profile) -> None:
    state = history.solve(
        profile, E, G, MU, indentation_depth=[0.1, -0.1], tangential_displacement=[0.0, 0.05]
    ).state
    r = np.array([0.0, 0.1, 1.0])
    for field in (fields.shear_stress, fields.foundation_shear, fields.slip):
        assert np.all(field(state, r) == 0)


def test_grid_includes_every_slip_front() -> None:
    state = load_history_end(RoundedPunch(0.4, 1.0))
    grid = fields.grid(state, 60)
    assert grid.size == 60
    assert {0.0, 0.4} <= set(grid)
    for edge in (state.contact_radius, *state.slip_fronts):
        # Just inside, where the rounding error of the edge is negligible.
        assert 0 < np.min(np.abs(grid - edge)) < 1e-3 * edge


@pytest.mark.parametrize("seed", range(20))
def test_springs_that_never_slipped_after_normal_loading_have_no_slope(seed: int) -> None:
    """Not even one by rounding: the stress of any slope is infinite at the tip of a cone."""
    rng = np.random.default_rng(seed)
    loads = rng.uniform(0.5, 1.0, 8)
    forces = 0.3 * MU * loads * rng.uniform(-1, 1, 8)
    forces[0] = 0.0
    state = history.solve(Cone(0.3), E, G, MU, normal_force=loads, tangential_force=forces).state
    assert state.segments.slope[0] == 0
    assert np.isfinite(fields.shear_stress(state, [0.0])).all()
