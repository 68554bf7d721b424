"""Fields at the end of a history would not balance its force, or not be those of its foundation."""

import itertools
from functools import partial

import mpmath
import numpy as np
import pytest

from mdr_core import fields, history, normal
from mdr_core.history import LoadHistory
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Ellipsoid,
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
)

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
FORCES = np.array([1.0, 1.0, 1.3, 1.1, 1.6, 1.5])
CONTROLS = ("normal_force", "indentation_depth")
PATHS = pytest.mark.parametrize("control", ["forces", *CONTROLS])
CYCLE = {"normal_force": [1.0, 1.0, 1.5, 0.8], "tangential_force": [0.0, 0.3, -0.2, 0.1]}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


def load_history_end(profile: Profile, control: str) -> LoadHistory:
    """A cycle of forces, or a path of arcs under mixed control."""
    if control == "forces":
        return history.solve(profile, E, G, MU, **CYCLE)
    depth = normal.solve(profile, E, normal_force=FORCES).indentation_depth
    if control == "normal_force":
        moved = np.array([0.0, 0.0, 0.2, 0.1, 0.3, 0.25]) * MU * E / G * depth[0]
        return history.solve(profile, E, G, MU, normal_force=FORCES, tangential_displacement=moved)
    pushed = np.array([0.0, 0.0, 0.18, 0.09, 0.32, 0.27]) * MU
    return history.solve(profile, E, G, MU, indentation_depth=depth, tangential_force=pushed)


def stops(way: LoadHistory) -> list[float]:
    """Radii between which fields are smooth."""
    profile, state = way.path.start.profile, way.state
    breaks = profile.contact_radius(profile.coordinate_breaks)
    result = [0.0, *map(float, profile.breaks), *breaks, *state.slip_fronts, state.contact_radius]
    return sorted({float(stop) for stop in result if stop <= state.contact_radius})


def single_arc(control: str) -> tuple[LoadHistory, float, float, float]:
    """The unit paraboloid under normal load followed by one arc: its rate, start and end."""
    radius = 1.0
    first, last = 0.6, 0.9
    depth = np.array([first, last]) ** 2 / radius
    reduced = 4 / 3 * np.array([first, last]) ** 3 / radius
    if control == "normal_force":
        rate = 0.4
        moved = [0.0, rate * (reduced[1] - reduced[0]) * MU * E / G]
        loads = {"normal_force": E * reduced, "tangential_displacement": moved}
    else:
        rate = -0.9
        pushed = [0.0, rate * (depth[1] - depth[0]) * MU * E]
        loads = {"indentation_depth": depth, "tangential_force": pushed}
    return history.solve(Paraboloid(radius), E, G, MU, **loads), rate, first, last


@pytest.mark.parametrize("control", CONTROLS)
def test_stress_of_one_arc_on_a_paraboloid(control: str) -> None:
    # Eq. (5.70) with q_x' = mu E* k g': k = 2 x rate, or rate/(2 x), and g' = 2 x.
    way, rate, first, last = single_arc(control)
    r = np.array([1e-12, 0.2, 0.59999, 0.60001, 0.75, 0.899999])

    def integral(x: mpmath.mpf, at: mpmath.mpf) -> mpmath.mpf:
        root = mpmath.sqrt(x * x - at * at)
        if control == "normal_force":
            return 2 * rate * (x * root + at * at * mpmath.acosh(x / at))
        return rate * mpmath.acosh(x / at)

    with mpmath.workdps(40):
        expected = [
            float(MU * E / mpmath.pi * (integral(last, at) - integral(max(first, at), at)))
            for at in map(mpmath.mpf, r.tolist())
        ]
    # Next to the edge, the rounding of a alone changes the stress by 1e-10 of itself.
    result = fields.shear_stress(way.state, r)
    np.testing.assert_allclose(result, expected, rtol=1e-11, atol=1e-12 * max(map(abs, expected)))
    assert np.all(fields.shear_stress(way.state, [last * (1 + 1e-12), 2.0]) == 0)


@pytest.mark.parametrize("control", CONTROLS)
def test_foundation_and_slip_of_one_arc_on_a_paraboloid(control: str) -> None:
    way, rate, first, last = single_arc(control)
    r = np.array([0.3, 0.6, 0.61, 0.75, 0.9 * (1 - 1e-9)])

    def above(x: mpmath.mpf) -> mpmath.mpf:
        x = max(x, mpmath.mpf(first))
        if control == "normal_force":
            return rate * 4 / 3 * (mpmath.mpf(last) ** 3 - x**3)
        return rate * (last - x)

    expected = [float(MU * E * above(mpmath.mpf(at))) for at in r.tolist()]
    result = fields.foundation_shear(way.state, r)
    np.testing.assert_allclose(result, expected, rtol=1e-11, atol=1e-13 * abs(expected[0]))

    def slipped(at: float) -> float:
        # Eq. (5.40) over the arc alone; everything inside it moves rigidly.
        if at <= first:
            return 0.0
        slope = (lambda x: 4 * rate * x * x) if control == "normal_force" else (lambda x: rate)
        value = mpmath.quad(lambda x: slope(x) * mpmath.acos(x / at), [first, at])
        return float(-MU * E / G * 2 / mpmath.pi * value)

    slips = [slipped(at) for at in r.tolist()]
    scale = max(map(abs, slips))
    np.testing.assert_allclose(fields.slip(way.state, r), slips, rtol=1e-10, atol=1e-13 * scale)


@PATHS
@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.kind)
def test_stress_and_foundation_balance_the_tangential_force(profile: Profile, control: str) -> None:
    way = load_history_end(profile, control)
    carried, borne = 0.0, 0.0
    for low, high in itertools.pairwise(stops(way)):
        angle = (NODES + 1) * np.pi / 2
        r = (low + high) / 2 - (high - low) / 2 * np.cos(angle)
        step = np.pi / 2 * (high - low) / 2 * np.sin(angle) * WEIGHTS
        carried += float((step * 2 * np.pi * r * fields.shear_stress(way.state, r)).sum())
        borne += float((step * 2 * fields.foundation_shear(way.state, r)).sum())
    # The fields belong to the arcs, whereas the force is extrapolated from chords.
    force = pytest.approx(way.tangential_force[-1], rel=way.error_estimate, abs=0)
    assert carried == force
    assert borne == force
    assert borne == pytest.approx(carried, rel=1e-11, abs=0)
    assert way.error_estimate < 2e-5


@PATHS
@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.kind)
def test_slip_is_the_transform_of_the_foundation_slip(profile: Profile, control: str) -> None:
    # Eq. (5.40): s = (2/pi) int_0^r s_1D/sqrt(r^2 - x^2) dx, s_1D = q_x/G* minus its value on the
    # axis.
    way = load_history_end(profile, control)
    carried = partial(fields.foundation_shear, way.state)
    on_axis = float(carried([0.0])[0])
    for share in (0.35, 0.9, 1.0):
        r = share * way.state.contact_radius
        angles = sorted({float(np.arcsin(x / r)) for x in stops(way) if x < r} | {np.pi / 2})
        expected = 0.0
        for low, high in itertools.pairwise(angles):
            turn = (NODES + 1) * np.pi / 2
            angle = low + (high - low) * (1 - np.cos(turn)) / 2
            step = WEIGHTS * np.pi / 2 * (high - low) / 2 * np.sin(turn)
            result = carried(np.minimum(r * np.sin(angle), r)) - on_axis
            expected += 2 / np.pi / G * float((step * result).sum())
        size = abs(on_axis) / G
        assert float(fields.slip(way.state, [r])[0]) == pytest.approx(
            expected, rel=1e-10, abs=1e-13 * size
        )


@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.kind)
def test_arc_under_depth_control_does_not_reach_the_axis(profile: Profile) -> None:
    # k = rate/(2 x) would exceed the friction limit there, so the denominator is never zero.
    way = load_history_end(profile, "indentation_depth")
    values = [fields.shear_stress(way.state, [0.0])[0], fields.slip(way.state, [0.0])[0]]
    assert np.all(np.isfinite(values))
