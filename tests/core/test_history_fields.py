"""Fields at the end of a history are the superpositions of Eqs. (5.18) and (5.38)."""

import itertools
from functools import partial

import numpy as np
import pytest

from mdr_core import fields, history, normal, tangential
from mdr_core.history import ContactState, LoadHistory
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Ellipsoid,
    FlatPunch,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedCone,
    RoundedPunch,
    Sphere,
    SphericalTipCone,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from tests.core.comparison import EPS

E, G, MU = 1.3, 0.9, 0.4
RADII = np.linspace(0.0, 3.0, 17)
PROFILES = (
    Paraboloid(1.0),
    Cone(0.3),
    RoundedPunch(0.4, 1.0),
    Sphere(3.0),
    Ellipsoid(2.0, 1.0),
    Power(0.7, 0.7),
    Power(2.0, 4.0),
    RoundedCone(0.3, 1.0),
    SphericalTipCone(0.3, 1.0),
    Hyperboloid(0.3, 1.0),
    TruncatedCone(0.3, 0.4),
    CappedParaboloid(0.2, 2.0, 1.0),
    Tabulated(RADII, RADII**2 / 2),
    Tabulated(RADII, np.maximum(RADII - 0.375, 0.0) ** 2 / 2, breaks=(0.375,)),
)
every_profile = pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.kind)
every_control = pytest.mark.parametrize("control", ["forces", "normal_force", "indentation_depth"])
CYCLE = {"normal_force": [1.0, 1.0, 1.5, 0.8], "tangential_force": [0.0, 0.3, -0.2, 0.1]}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


def load_history_end(profile: Profile) -> ContactState:
    return history.solve(profile, E, G, MU, **CYCLE).state


def followed(profile: Profile, control: str) -> LoadHistory:
    """A cycle of forces, or a curved path under controls of different pairs."""
    if control == "forces":
        return history.solve(profile, E, G, MU, **CYCLE)
    force = np.array([1.0, 1.0, 1.3, 1.1, 1.6, 1.5])
    depth = normal.solve(profile, E, normal_force=force).indentation_depth
    solved = partial(history.solve, profile, E, G, MU, samples_per_step=3)
    if control == "normal_force":
        moved = np.array([0.0, 0.0, 0.2, 0.1, 0.3, 0.25]) * MU * E / G * depth[0]
        return solved(normal_force=force, tangential_displacement=moved)
    pushed = np.array([0.0, 0.0, 0.18, 0.09, 0.32, 0.27]) * MU
    return solved(indentation_depth=depth, tangential_force=pushed)


def stops(path: LoadHistory) -> list[float]:
    """Radii between which fields are smooth."""
    profile, state = path.path.start.profile, path.state
    breaks = profile.contact_radius(profile.coordinate_breaks)
    found = [0.0, *map(float, profile.breaks), *breaks, *state.slip_fronts, state.contact_radius]
    return sorted({float(stop) for stop in found if stop <= state.contact_radius})


@every_control
@every_profile
def test_stress_and_foundation_balance_the_tangential_force(profile: Profile, control: str) -> None:
    path = followed(profile, control)
    carried, borne = 0.0, 0.0
    for low, high in itertools.pairwise(stops(path)):
        angle = (NODES + 1) * np.pi / 2
        r = (low + high) / 2 - (high - low) / 2 * np.cos(angle)
        step = np.pi / 2 * (high - low) / 2 * np.sin(angle) * WEIGHTS
        carried += float((step * 2 * np.pi * r * fields.shear_stress(path.state, r)).sum())
        borne += float((step * 2 * fields.foundation_shear(path.state, r)).sum())
    # The quadrature resolves the roots at both ends of an interval to 1e-12.
    assert borne == pytest.approx(path.tangential_force[-1], rel=1e-11, abs=0)
    assert carried == pytest.approx(path.tangential_force[-1], rel=1e-11, abs=0)


@every_control
@every_profile
def test_slip_is_the_transform_of_the_foundation_slip(profile: Profile, control: str) -> None:
    # Eq. (5.40): s = (2/pi) int_0^r s_1D/sqrt(r^2 - x^2) dx, s_1D = q_x/G* minus its value on the
    # axis.
    path = followed(profile, control)
    carried = partial(fields.foundation_shear, path.state)
    on_axis = float(carried([0.0])[0])
    for share in (0.35, 0.9, 1.0):
        r = share * path.state.contact_radius
        angles = sorted({float(np.arcsin(x / r)) for x in stops(path) if x < r} | {np.pi / 2})
        expected = 0.0
        for low, high in itertools.pairwise(angles):
            turn = (NODES + 1) * np.pi / 2
            angle = low + (high - low) * (1 - np.cos(turn)) / 2
            step = WEIGHTS * np.pi / 2 * (high - low) / 2 * np.sin(turn)
            result = carried(np.minimum(r * np.sin(angle), r)) - on_axis
            expected += 2 / np.pi / G * float((step * result).sum())
        size = abs(on_axis) / G
        assert float(fields.slip(path.state, [r])[0]) == pytest.approx(
            expected, rel=1e-10, abs=1e-13 * size
        )


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


@every_profile
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


@every_profile
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
    """Not even a slope due to rounding: its stress would be infinite at the tip of a cone."""
    rng = np.random.default_rng(seed)
    loads = rng.uniform(0.5, 1.0, 8)
    forces = 0.3 * MU * loads * rng.uniform(-1, 1, 8)
    forces[0] = 0.0
    state = history.solve(Cone(0.3), E, G, MU, normal_force=loads, tangential_force=forces).state
    assert state.slope[0] == 0
    assert np.isfinite(fields.shear_stress(state, [0.0])).all()
