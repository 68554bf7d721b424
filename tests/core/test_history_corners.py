"""Histories have their closed forms under forces and under displacements."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, history, normal, tangential
from mdr_core.profiles import Cone, FlatPunch, Paraboloid, Power, Profile, RoundedPunch, Tabulated
from tests.core.comparison import EPS, INPUT, profile_from
from tests.core.test_history_paths import DEPTH, FULL_SLIP, MATERIAL, PROFILES, solve
from tests.oracles import slip_reference as slip

MU, E_STAR, G_STAR = MATERIAL.mu, MATERIAL.e_star, MATERIAL.g_star
SHIFT = E_STAR / G_STAR
BOUND = 1e-12
#: Relative to a small load over that of full slip: normal coordinates are rounded.
SMALL = 4 * EPS
SHAPES = ["paraboloid", "power0.7", "sphere", "rounded-punch", "truncated-cone"]
CHOSEN = [*SHAPES, "flat-punch"]
every_shape = pytest.mark.parametrize("name", CHOSEN)
shapes = pytest.mark.parametrize("name", SHAPES)
both_directions = pytest.mark.parametrize("sign", [1, -1])
#: F_N of most tests: close to that at DEPTH, so that the breaks lie inside the contact.
FORCES = {
    name: float(normal.solve(profile_from(fields), E_STAR, indentation_depth=DEPTH).normal_force)
    for name, fields in PROFILES.items()
    if name in CHOSEN
}


def near(value: Any, absolute: float = 0.0, rel: float = BOUND) -> Any:
    return pytest.approx(value, rel=rel, abs=absolute)


class FirstLoading:
    """First loading at one normal load, its inverse, and their condition numbers."""

    def __init__(self, name: str, control: str, load: float, mu: mpf | float = MU) -> None:
        with mp.workdps(slip.WORK_DIGITS):
            at = slip.setting(PROFILES[name], control, load, MATERIAL)
            self.at = slip.Setting(
                at.body, at.a, at.depth, at.n, at.e_star, at.g_star, mpf(mu), at.load_rate, at.load
            )
            self.depth, self.force = float(at.depth), float(at.n * at.e_star)
            self.bound = float(at.n * at.e_star * mpf(mu))
            self.most = float(self.at.shift * at.depth)

    def _solve(self, control: str, given: float) -> tuple[float, float, float]:
        """The other quantity, its condition number with respect to the prescribed one, and c."""
        other = {
            "tangential_force": "tangential_displacement",
            "tangential_displacement": "tangential_force",
        }[control]
        with mp.workdps(slip.WORK_DIGITS):
            if self.at.flat_punch:
                stiffness = 2 * self.at.g_star * self.at.a
                factor = stiffness if other == "tangential_force" else 1 / stiffness
                return float(mpf(given) * factor), 1.0, float(self.at.a)
            result = slip.solve(self.at, control, given, energy=False)
            rate = float(result.condition[other] + result.condition_load[other])
            return float(result.values[other]), rate, float(result.c)

    def displacement(self, force: float) -> float:
        return self._solve("tangential_force", force)[0]

    def load(self, displacement: float) -> float:
        return self._solve("tangential_displacement", displacement)[0]

    def allowed(self, force: float) -> float:
        """Relative error of u due to the rounding error of the forces and of small steps."""
        small = SMALL * self.bound / abs(force)
        return BOUND + small + INPUT * self._solve("tangential_force", force)[1]

    def radius(self, force: float) -> float:
        return self._solve("tangential_force", force)[2]


@every_shape
@both_directions
@pytest.mark.parametrize("rho", [1e-6, 0.9])
def test_increased_normal_force_keeps_the_displacement(name: str, sign: int, rho: float) -> None:
    """The annulus of new contact carries dF_x <= mu dF_N; beyond that, first loading follows."""
    before, after = FORCES[name] / 2, FORCES[name]
    first = sign * rho * MU * before
    steps = [0.6, 0.999]
    extra = [sign * part * MU * (after - before) for part in steps]
    # Half-way between the start of first loading and full slip.
    beyond = sign * (abs(first) + MU * (after - before) + MU * after) / 2
    result = solve(
        name,
        normal_force=[before, before, after, after, after, after],
        tangential_force=[0.0, first, first, *(first + step for step in extra), beyond],
    )
    low, high = (
        FirstLoading(name, "normal_force", before),
        FirstLoading(name, "normal_force", after),
    )
    u = result.tangential_displacement
    start = low.displacement(first)
    assert u[1] == near(start, rel=low.allowed(first))
    assert u[2] == near(u[1], rel=low.allowed(first))
    assert result.dissipation[2] == 0
    assert result.regime[2] == "stick"
    for index, step in enumerate(extra):
        move = high.displacement(step)
        # The force increment is a difference of two prescribed forces.
        rounding = 4 * 2.0**-52 * abs(first / step)
        assert u[3 + index] == near(start + move, abs(move) * (high.allowed(step) + rounding))
    assert u[5] == near(high.displacement(beyond), rel=high.allowed(beyond))


@every_shape
@both_directions
def test_reduced_normal_force_ends_on_the_curve_of_the_reduced_force(name: str, sign: int) -> None:
    before, after = FORCES[name], FORCES[name] / 2
    force = sign * 0.8 * MU * after
    result = solve(name, normal_force=[before, before, after], tangential_force=[0.0, force, force])
    low = FirstLoading(name, "normal_force", after)
    assert result.tangential_displacement[2] == near(
        low.displacement(force), rel=low.allowed(force)
    )
    depth = FirstLoading(name, "normal_force", after).depth
    assert result.indentation_depth[2] == near(depth)
    on = solve(name, normal_force=[after, after], tangential_force=[0.0, force])
    assert result.state.depth == near(on.state.depth, rel=1e-11)
    assert result.state.load == near(on.state.load, rel=1e-11)


@every_shape
@both_directions
@pytest.mark.parametrize("share", [0.3, 0.99])
def test_oblique_loading_sticks(name: str, sign: int, share: float) -> None:
    """Eq. (5.71), followed by Cattaneo and Mindlin with the remaining friction."""
    force, slope = FORCES[name], share * MU
    first = sign * slope * force
    step = 0.3 * MU * (1 - share) * force
    ahead = solve(
        name, normal_force=force, tangential_force=[first, first + sign * step], samples_per_step=5
    )
    back = solve(name, normal_force=force, tangential_force=[first, first - sign * step])
    given = ahead.normal_force[:5]
    assert given == near(np.linspace(0.2, 1.0, 5) * force)
    u = sign * slope * SHIFT * ahead.indentation_depth[:5]
    assert ahead.tangential_displacement[:5] == near(u)
    assert list(ahead.regime[:5]) == ["stick"] * 5
    assert not ahead.dissipated_energy[:5].any()
    exact = mpf(first) / mpf(force) * sign
    for result, direction in ((ahead, 1), (back, -1)):
        left = FirstLoading(name, "normal_force", force, MU - direction * exact)
        move = left.displacement(step)
        # The slope carries the rounding error of the prescribed force.
        rounding = (left.allowed(step) + 8 * 2.0**-52 * abs(first) / step) * abs(move)
        expected = u[-1] + sign * direction * move
        assert result.tangential_displacement[-1] == near(expected, rounding + 2e-15 * abs(u[-1]))


@every_shape
@both_directions
@pytest.mark.parametrize("part", [1 / 3, 1 / 4, 0.7])
def test_friction_limit_after_a_preload(name: str, sign: int, part: float) -> None:
    """New springs are at the friction limit from the start; slip of rounding-error size is zero."""
    for ulps in range(-4, 5):
        result = solve(
            name,
            indentation_depth=[part * DEPTH, DEPTH],
            tangential_displacement=[0.0, sign * (1 - part) * FULL_SLIP * (1 + ulps * 2.0**-52)],
            samples_per_step=4,
        )
        bound = 64 * 2.0**-52 * MU * float(result.normal_force[-1]) * FULL_SLIP
        assert np.all(result.dissipated_energy <= bound), ulps
        gained = result.normal_force[-1] - result.normal_force[3]
        assert result.tangential_force[-1] == near(sign * MU * gained)


@every_shape
@both_directions
def test_oblique_displacement_slides_from_first_contact(name: str, sign: int) -> None:
    """Steeper than the friction limit: displacement ratio above mu E*/G*."""
    u = sign * 1.7 * FULL_SLIP
    result = solve(name, indentation_depth=[DEPTH], tangential_displacement=[u], samples_per_step=4)
    assert result.tangential_force == near(sign * MU * result.normal_force)
    assert list(result.regime) == ["full_slip"] * 4
    curve = FirstLoading(name, "indentation_depth", DEPTH)
    with mp.workdps(50):
        at = curve.at
        # Each spring slips by (u - u_max) of the load step on which its load grows.
        squares = at.depth**2 * at.a if at.flat_punch else _squares(at)
        excess = (abs(mpf(u)) / at.depth - at.shift) * at.mu * at.e_star
        # Energies of a table are sums over its knots.
        bound = 1e-11 if "table" in name else BOUND
        assert float(result.dissipated_energy[-1]) == near(float(excess * squares), rel=bound)


def _squares(at: slip.Setting) -> mpf:
    """int_0^a (d - g)^2 dx."""
    edge = at.body.b if at.body.blunt else mpf(0)
    return at.depth * at.n / 2 - slip.overlap(at, edge)


@every_shape
@both_directions
def test_oblique_loading_after_a_preload(name: str, sign: int) -> None:
    before, after = FORCES[name] / 3, FORCES[name]
    low, high = (
        FirstLoading(name, "normal_force", before),
        FirstLoading(name, "normal_force", after),
    )
    gentle = sign * 0.7 * MU * (after - before)
    result = solve(name, normal_force=[before, after], tangential_force=[0.0, gentle])
    expected = SHIFT * 0.7 * MU * sign * (high.depth - low.depth)
    if name == "flat-punch":
        expected = sign * abs(gentle) / (2 * G_STAR * PROFILES[name]["radius"])
    assert result.tangential_displacement[1] == near(expected)
    assert result.dissipated_energy[1] == 0
    assert result.regime[1] == "stick"
    steep = sign * 1.2 * MU * (after - before)
    result = solve(name, normal_force=[before, after], tangential_force=[0.0, steep])
    assert result.tangential_displacement[1] == near(
        high.displacement(steep), rel=high.allowed(steep)
    )


@shapes
def test_slip_fronts_separate_the_segments_of_the_traction(name: str) -> None:
    force = FORCES[name]
    top, back = 0.9 * MU * force, 0.5 * MU * force
    curve = FirstLoading(name, "normal_force", force)
    c, c2 = curve.radius(top), curve.radius((top - back) / 2)
    path: dict[str, Any] = {"normal_force": force}
    start = solve(name, **path, tangential_force=[0.0])
    assert start.slip_fronts.shape == (0,)
    loaded = solve(name, **path, tangential_force=[0.0, top])
    assert loaded.slip_fronts == near([c], rel=1e-11)
    turned = solve(name, **path, tangential_force=[0.0, top, back])
    assert turned.slip_fronts == near([c, c2], rel=1e-11)
    back_again = solve(name, **path, tangential_force=[0.0, top, back, top])
    assert back_again.slip_fronts == near([c], rel=1e-11)
    reversed_ = solve(name, **path, tangential_force=[0.0, top, -top])
    assert reversed_.slip_fronts == near([c], rel=1e-11)


@every_shape
def test_closed_inner_loop_erases_its_memory(name: str) -> None:
    force = FORCES[name]
    outer = [0.0, 0.8, -0.3]
    inner = [0.5, 0.1, 0.4, 0.0, 0.5]
    rest = [0.6, -0.5, 0.2]
    scale = MU * force
    short, long = (
        solve(name, normal_force=force, tangential_force=[f * scale for f in points])
        for points in ([*outer, 0.5, *rest], [*outer, *inner, *rest])
    )
    kept = len(rest) + 1
    for column in ("tangential_displacement", "tangential_energy"):
        values = [getattr(result, column)[-kept:] for result in (short, long)]
        assert values[1] == near(values[0], 1e-13 * np.max(np.abs(values[0]))), column
    dissipated = [result.dissipation[-len(rest) :] for result in (short, long)]
    assert dissipated[1] == near(dissipated[0], rel=1e-11)
    assert long.state.depth.shape == short.state.depth.shape
    assert long.state.depth == near(short.state.depth)
    assert long.state.load == near(short.state.load, 1e-13 * np.max(np.abs(short.state.load)))


@every_shape
@both_directions
def test_separation_and_renewed_contact(name: str, sign: int) -> None:
    """Contact is re-established at the current displacement, here after a fifth of the step."""
    u = sign * 0.4 * FULL_SLIP
    result = solve(
        name,
        indentation_depth=[DEPTH, -DEPTH / 4, DEPTH],
        tangential_displacement=[u, 2 * u, -u],
        samples_per_step=20,
    )
    gone = result.indentation_depth <= 0
    assert list(result.regime[gone]) == ["no_contact"] * np.count_nonzero(gone)
    for column in ("normal_force", "tangential_force", "tangential_energy", "contact_radius"):
        if column != "contact_radius" or name in SHAPES[:3]:
            assert not getattr(result, column)[gone].any(), column
    # From 2 u at first contact by -3 u in total, a fifth of it before contact.
    fresh = solve(name, indentation_depth=[DEPTH], tangential_displacement=[0.8 * -3 * u])
    assert result.tangential_force[-1] == near(fresh.tangential_force[-1])
    dissipated = result.dissipated_energy
    assert dissipated[-1] - dissipated[gone][-1] == near(
        fresh.dissipated_energy[-1], 1e-13 * dissipated[-1]
    )
    assert not result.dissipation[gone][1:].any()


@every_shape
def test_force_vanishes_and_grows_again(name: str) -> None:
    """The slip memory is erased; oblique loading restarts from the current displacement."""
    force, slope = FORCES[name], 0.5 * MU
    result = solve(
        name,
        normal_force=[force, 0.0, force],
        tangential_force=[0.9 * MU * force, 0.0, slope * force],
    )
    assert result.regime[1] == "no_contact"
    move = result.tangential_displacement[2] - result.tangential_displacement[1]
    assert move == near(slope * SHIFT * result.indentation_depth[2], rel=1e-11)
    assert result.dissipation[2] == near(0.0, 1e-14 * MU * force * DEPTH)


@both_directions
def test_flat_punch_passes_from_full_stick_to_full_slip(sign: int) -> None:
    radius = PROFILES["flat-punch"]["radius"]
    stiffness, bound = 2 * G_STAR * radius, MU * 2 * E_STAR * radius * DEPTH
    most = bound / stiffness
    points = np.array([0.0, 0.9, 1.5, 1.0, -0.4, -0.9, -2.0])
    result = solve(
        "flat-punch",
        indentation_depth=DEPTH,
        tangential_displacement=sign * most * points,
    )
    # Full slip from 1 to 1.5, full stick down to -0.5, then full slip again.
    expected = np.array([0.0, 0.9, 1.0, 0.5, -0.9, -1.0, -1.0])
    assert result.tangential_force == near(sign * bound * expected)
    dissipated = np.array([0.0, 0.0, 0.5, 0.5, 0.5, 0.9, 2.0]) * most * bound
    assert result.dissipated_energy == near(dissipated)
    regimes = ["stick", "stick", "full_slip", "stick", "stick", "full_slip", "full_slip"]
    assert list(result.regime) == regimes
    assert result.slip_fronts.shape == (0,)


@shapes
@both_directions
def test_long_sliding_distance_keeps_the_force(name: str, sign: int) -> None:
    """Sliding over a distance much larger than the depth must not cause cancellation."""
    far = sign * 2.0**40 * FULL_SLIP
    result = solve(
        name, indentation_depth=[DEPTH, DEPTH, DEPTH / 2], tangential_displacement=[0.0, far, far]
    )
    assert result.tangential_force[1] == near(sign * MU * result.normal_force[1])
    assert result.tangential_force[2] == near(sign * MU * result.normal_force[2])
    assert result.indentation_depth.tolist() == [DEPTH, DEPTH, DEPTH / 2]
    assert result.state.depth[-1] == near(DEPTH / 2)


@pytest.mark.parametrize(
    ("radii", "heights"),
    [
        (
            [0.000284653109639236, 0.000298208019622057, 0.000304985474613467],
            [6.66360178423122e-08, 7.67698485780209e-08, 7.90612819359751e-08],
        ),
        (
            [
                *(0.000304985474613467, 0.000311762929604877, 0.000338872749570519),
                *(0.000345650204561929, 0.00035242765955334),
            ],
            [
                *(7.90612819359751e-08, 8.30742573900286e-08, 9.21776636349578e-08),
                *(9.35735335733202e-08, 1.04744227768906e-07),
            ],
        ),
    ],
    ids=["three", "five"],
)
def test_dissipated_energy_of_a_cycle_on_a_rough_table(
    radii: list[float], heights: list[float]
) -> None:
    """The dissipated energy is continuous in the load: it equals the mean of its neighbours."""
    last = 0.00251443580181325, 3.85203450924955e-05
    profile = Tabulated([0.0, *radii, last[0]], [0.0, *heights, last[1]])

    def cycles(factor: float) -> history.LoadCycles:
        return history.cycles(
            profile,
            112824.9882380765,
            92914.69619606301,
            0.1,
            normal_force=7.248241580288089e-06 * factor,
            normal_amplitude=2.4017243799068697e-06 * factor,
            tangential_displacement=3.0354333418054147e-10,
            count=2,
        )

    below, result, above = (cycles(factor) for factor in (1 - 1e-4, 1.0, 1 + 1e-4))
    energy = float(result.energy_per_cycle[0])
    beside = float(below.energy_per_cycle[0] + above.energy_per_cycle[0]) / 2
    assert energy == pytest.approx(beside, rel=1e-3, abs=0)
    assert 0 <= result.energy_per_cycle[1] < 1e-12 * energy


@pytest.mark.parametrize("profile", [Paraboloid(1.3), RoundedPunch(0.2, 1.0), FlatPunch(0.7)])
@pytest.mark.parametrize("samples", [1, 7])
@pytest.mark.parametrize("sign", [-1, 1])
def test_nothing_slips_where_the_loads_grow_in_the_ratio_of_friction(
    profile: Profile, samples: int, sign: int
) -> None:
    """Eq. (5.71) at equality: all springs are at their limit at all times, and none slips."""
    mu, e_star, g_star = 0.3, 1.1, 0.9
    loads = np.array([0.7, 1.9, 2.0, 3.1])
    solved = partial(history.solve, profile, e_star, g_star, mu, samples_per_step=samples)
    forces = solved(normal_force=loads, tangential_force=sign * mu * loads)
    displacements = solved(
        indentation_depth=loads / 10,
        tangential_displacement=sign * mu * e_star / g_star * loads / 10,
    )
    for result in (forces, displacements):
        assert set(result.regime) == {"stick"}
        assert result.dissipated_energy[-1] == pytest.approx(
            0, abs=1e-15 * result.elastic_energy[-1]
        )


@pytest.mark.parametrize("beyond", [1e-12, 1e-9, 1e-4])
def test_dissipated_energy_just_beyond_the_flat_of_a_table(beyond: float) -> None:
    """Slip stops at the flat: from there to full slip no energy is dissipated."""
    b, r = 0.3331961512716172, np.linspace(0.0, 1.0, 79)
    table = Tabulated(r, np.maximum(r - b, 0.0), breaks=(b,))
    contact = normal.solve(table, E_STAR, contact_radius=b * (1 + beyond))
    limit = MU * contact.normal_force
    path = history.solve(
        *(table, E_STAR, G_STAR, MU),
        normal_force=float(contact.normal_force),
        tangential_force=[0.0, 0.9999 * limit, (1 - 1e-6) * limit, (1 - 1e-9) * limit],
    )
    spent = path.dissipated_energy[1:]
    assert spent == pytest.approx(spent[0], rel=1e-3, abs=0)


@pytest.mark.parametrize("share", [0.0, 0.3])
@pytest.mark.parametrize(
    ("pressed", "pushed", "limit"),
    [
        ("indentation_depth", "tangential_displacement", MU * SHIFT),
        ("normal_force", "tangential_force", MU),
    ],
)
def test_nothing_slips_where_the_loads_return_as_they_came(
    pressed: str, pushed: str, limit: float, share: float
) -> None:
    """Eq. (5.71) in reverse, down to a millionth of the loads."""
    for part in np.geomspace(0.5, 1e-6, 40):
        loads = 0.9 * DEPTH * np.array([1.0, part, 1.0])
        path = solve("paraboloid", **{pressed: loads, pushed: share * limit * loads})
        assert set(path.regime) == {"stick"}
        assert path.dissipated_energy == near(0, 1e-15 * path.elastic_energy[0])


def test_growth_in_the_ratio_of_friction_leaves_the_regime_as_it_is() -> None:
    """After partial slip the springs that come into contact at their limit do not slip."""
    result = history.solve(
        Paraboloid(1.3),
        1.0,
        1.0,
        0.5,
        normal_force=[1.0, 1.0, 2.0, 2.0, 3.0],
        tangential_force=[0.0, 0.25, 0.75, 1.0, 1.5],
    )
    assert list(result.regime) == [
        "stick",
        "partial_slip",
        "partial_slip",
        "full_slip",
        "full_slip",
    ]
    assert result.dissipation[[2, 4]] == pytest.approx(0, abs=1e-15 * result.elastic_energy[-1])


@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
def test_path_under_controls_of_different_pairs_may_end_in_separation(control: str) -> None:
    """The traction ends with the contact."""
    tangential = "tangential_displacement" if control == "normal_force" else "tangential_force"
    path: dict[str, Any] = {control: [1.0, 1.0, 0.5, 0.0], tangential: [0.0, 0.02, 0.0, 0.0]}
    found = history.solve(Paraboloid(1.0), 1.0, 0.8, 0.3, **path)
    assert found.slip_fronts.size == 0
    assert not found.state.in_contact
    assert fields.shear_stress(found.state, [0.0, 0.5]).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("profile", [Power(1.0, 0.1), Power(1.0, 0.3), Cone(0.1), Paraboloid(1.0)])
@pytest.mark.parametrize("share", np.linspace(0.1, 0.9, 9).tolist())
def test_work_up_to_the_friction_limit_after_a_reversal(profile: Profile, share: float) -> None:
    """By Masing's rule the way from -Q to the limit dissipates 2 D(Q) more than the first one."""
    force, mu = 0.5692807687098409, 0.21740850467603928
    path = {"normal_force": force, "tangential_force": mu * force * np.array([0, -share, 1])}
    found = history.solve(profile, 1.0, 1.0, mu, **path)
    contact = normal.solve(profile, 1.0, normal_force=force)
    first, limit = (
        float(tangential.solve(contact, 1.0, mu, tangential_force=part).dissipated_energy)
        for part in (mu * force * share, mu * force)
    )
    assert found.dissipated_energy[-1] == near(limit + 2 * first)


@pytest.mark.parametrize("less", [1e-6, 1e-7, 1e-8, 1e-9])
def test_error_estimate_where_loads_fall_nearly_in_the_ratio_of_friction(less: float) -> None:
    """In other units the loads are rounded, and little is left of their small difference."""
    pressed = np.array([7.0, 4.0, 9.0, 3.0])
    pushed = 0.3 * pressed * (1 - less * np.array([0, 1, 0.3, 0.6]))
    moduli = np.array([1e3, 800.0])
    one, other = (
        history.solve(
            Paraboloid(1.9),
            *(unit * moduli).tolist(),
            0.3,
            normal_force=unit * pressed,
            tangential_force=unit * pushed,
        )
        for unit in (1.0, 1e-3)
    )
    expected, room = one.dissipated_energy, one.error_estimate + other.error_estimate
    room *= float(expected.max())
    assert other.dissipated_energy / 1e-3 == near(expected, rel=0, absolute=room)


@pytest.mark.parametrize(
    ("profile", "force", "mu", "rest"),
    [
        (Power(1.0, 0.1), 0.777, 0.46, 1e-2),
        (Power(1.0, 0.1), 0.478, 0.5, 1e-3),
        (Cone(0.1), 0.33, 0.78, 1e-2),
        (Cone(0.1), 0.113, 0.73, 1e-4),
        (Paraboloid(1.0), 0.218, 0.11, 1e-2),
    ],
)
def test_work_up_to_the_friction_limit_after_loading_almost_in_its_ratio(
    profile: Profile, force: float, mu: float, rest: float
) -> None:
    """Springs loaded to 1 - e of the limit slip by the share e of the way of unloaded ones."""

    def work(*shares: float) -> float:
        path = {"normal_force": force, "tangential_force": mu * force * np.array(shares)}
        return float(history.solve(profile, 1.0, 1.0, mu, **path).dissipated_energy[-1])

    # The force returns from 0 to the first load point by Masing's rule.
    expected = 2 * work(1 - rest, 0) + rest * work(0, 1)
    assert work(1 - rest, 0, 1) == near(expected)


@pytest.mark.parametrize("samples", [2, 3, 6])
def test_steps_on_which_the_front_stops_near_the_axis_add_up(samples: int) -> None:
    """The displacement equals the limit by chance: all springs slip, and none twice."""
    depth, shift = [0.0446, 0.0446, 0.811], [0.0, -0.0892, 0.811]
    path = {"indentation_depth": depth, "tangential_displacement": shift}
    one, other = (
        history.solve(Paraboloid(1.0), 1.0, 1.0, 1.0, **path, samples_per_step=count)
        for count in (1, samples)
    )
    assert other.dissipated_energy[-1] == near(one.dissipated_energy[-1])


@pytest.mark.parametrize("profile", [FlatPunch(1.0), RoundedPunch(0.5, 1.0)])
def test_flats_have_no_contact_radius_without_contact(profile: Profile) -> None:
    """Depth 0 separates the bodies, as its regime and state say."""
    path = {"indentation_depth": [0.1, 0.0], "tangential_displacement": 0.0}
    found = history.solve(profile, 1.0, 1.0, 1.0, **path)
    assert found.regime[-1] == "no_contact"
    assert found.contact_radius[-1] == found.state.contact_radius == 0
