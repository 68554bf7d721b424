"""Adhesive contacts have their closed forms and energy release rate, on the stable branch.

Expected values are closed forms, evaluated in high precision where they are not elementary, or
come from scans and quotients that share no root finding with the core.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

import mdr_core as mdr
from mdr_core import adhesion, fields, subsurface
from tests.core.comparison import profile_from
from tests.core.random_cases import PROFILE_GENERATORS, Draw

if TYPE_CHECKING:
    from mdr_core.profiles import Profile
    from mdr_core.typing import Array

CLOSED = 1e-11
#: Radius, E* and w from kPa gels at nanonewtons to steel, and in extreme units.
UNITS = [(2e-6, 3e3, 0.05), (0.02e-6, 1e11, 1.0), (1.0, 1.0, 0.3), (1e40, 1e-45, 1e-50)]
EACH_KIND: list[Profile] = [
    mdr.Paraboloid(1.0),
    mdr.Cone(0.5),
    mdr.Power(0.5, 3.5),
    mdr.Series((mdr.PowerTerm(0.3, 1.0), mdr.PowerTerm(0.5, 4.0))),
    mdr.Sphere(1.5),
    mdr.TwoSpheres((1.5, -2.0)),
    mdr.Ellipsoid(1.5, 0.7),
    mdr.Hyperboloid(0.6, 0.4),
    mdr.RoundedPunch(0.4, 0.8),
    mdr.TruncatedCone(0.3, 0.5),
    mdr.TruncatedParaboloid(0.3, 0.8),
    mdr.RoundedCone(0.6, 0.5),
    mdr.SphericalTipCone(0.6, 0.5),
    mdr.CappedParaboloid(0.4, 3.0, 0.8),
    mdr.Tabulated(np.linspace(0, 2, 40), np.linspace(0, 2, 40) ** 2 / 2),
    mdr.Tabulated(
        np.linspace(0, 2, 41), 0.4 * np.maximum(np.linspace(0, 2, 41) - 0.5, 0), breaks=[0.5]
    ),
]


def close(value: Any, expected: Any, bound: float = CLOSED) -> bool:
    return bool(np.all(np.abs(np.asarray(value) / np.asarray(expected, dtype=float) - 1) <= bound))


@pytest.mark.parametrize("units", UNITS)
def test_paraboloid_pulls_off_as_jkr(units: tuple[float, float, float]) -> None:
    radius, e_star, w = units
    ball = mdr.Paraboloid(radius)
    under_force, under_depth = -1.5 * np.pi * w * radius, -0.75 * radius
    under_depth *= float(mp.cbrt((mp.pi * mpf(w) / (mpf(e_star) * radius)) ** 2))
    contact = adhesion.solve(ball, e_star, w, normal_force=under_force)
    size = float(mp.cbrt(9 * mp.pi * mpf(w) * mpf(radius) ** 2 / (8 * mpf(e_star))))
    assert close(contact.contact_radius, size)
    assert close(contact.pull_off_force, under_force)
    assert close(contact.pull_off_depth, under_depth)
    assert abs(contact.normal_stiffness) <= CLOSED * e_star * size
    contact = adhesion.solve(ball, e_star, w, indentation_depth=under_depth)
    assert close(contact.contact_radius, size / np.cbrt(9))
    assert close(contact.normal_force, under_force * 5 / 9)
    assert np.isneginf(contact.normal_stiffness)
    assert {"singular"} <= {notice.code for notice in contact.warnings}


@pytest.mark.parametrize("units", UNITS)
def test_flat_punch_pulls_off_as_kendall(units: tuple[float, float, float]) -> None:
    radius, e_star, w = units
    force = -float(mp.sqrt(8 * mp.pi * mpf(e_star) * mpf(w) * mpf(radius) ** 3))
    punch = mdr.FlatPunch(radius)
    contact = adhesion.solve(punch, e_star, w, normal_force=[force, force / 2, -force])
    assert close(contact.pull_off_force, force)
    assert close(contact.indentation_depth * 2 * e_star * radius, contact.normal_force)
    assert close(contact.retraction[0], -contact.pull_off_depth)
    assert contact.retraction[2] == 0
    assert np.isinf(contact.maximum_pressure).tolist() == [False, False, True]
    assert close(contact.elastic_energy, e_star * radius * contact.indentation_depth**2)


@pytest.mark.parametrize("profile", EACH_KIND, ids=lambda profile: profile.kind)
@pytest.mark.parametrize("radius", [0.7, 1.1])
def test_energy_release_rate_is_the_work_of_adhesion(profile: Profile, radius: float) -> None:
    """(1/(2 pi a)) dU/da at fixed depth, from energies of other contacts with that depth."""
    e_star, w, step = 2.0, 0.01, 2e-3
    contact = adhesion.solve(profile, e_star, w, contact_radius=radius)

    def energy(a: float) -> float:
        step = float(profile.g(np.float64(a)) - contact.indentation_depth)
        other = adhesion.solve(
            profile, e_star, e_star * step**2 / (2 * np.pi * a), contact_radius=a
        )
        return float(other.elastic_energy)

    near, far = (energy(radius + k * step) - energy(radius - k * step) for k in (1, 2))
    slope = (8 * near - far) / (12 * step)
    assert close(slope / (2 * np.pi * radius), w, 1e-7)


@pytest.mark.parametrize("profile", EACH_KIND, ids=lambda profile: profile.kind)
def test_stiffness_is_the_slope_of_force_over_depth(profile: Profile) -> None:
    contact = adhesion.solve(profile, 2.0, 0.01, normal_force=[0.05, 0.1])
    depth, step = contact.indentation_depth, 1e-4
    forces = adhesion.solve(
        profile, 2.0, 0.01, indentation_depth=np.add.outer(step * np.array([-2, -1, 1, 2]), depth)
    ).normal_force
    slope = (forces[0] - forces[3] + 8 * (forces[2] - forces[1])) / (12 * step)
    assert close(contact.normal_stiffness, slope, 1e-7)


@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
@pytest.mark.parametrize("beyond", [1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize(("rounding", "work"), [(0.0143, 3.61e-8), (1.0, 1e-6), (1.0, 1e-3)])
def test_error_estimate_contains_the_stiffness_next_to_a_flat(
    rounding: float, work: float, beyond: float, control: str
) -> None:
    punch = mdr.RoundedPunch(1.0, rounding)
    curve = adhesion.Curve(punch, float(np.sqrt(2 * np.pi) * np.sqrt(work)))
    load = curve.least[control] * (1 - beyond)
    contact = adhesion.solve(punch, 1.0, work, **{control: load})
    with mp.workdps(50):
        c = mp.sqrt(2 * mp.pi * mpf(work))

        def edge(e: Any) -> tuple[Any, Any, Any]:
            """Retraction, sqrt(a^2 - b^2) and arccos(b/a) at a = 1 + e."""
            s = mp.sqrt(e * (2 + e))
            return c * mp.sqrt(1 + e), s, mp.atan(s)

        def excess(e: Any) -> Any:
            (step, s, phi), a = edge(e), 1 + e
            if control == "indentation_depth":
                return a * (s - phi) / rounding - step - mpf(load)
            force = ((4 * a * a - 1) * s - 3 * a * a * phi) / (3 * mpf(rounding))
            return force - 2 * a * step - mpf(load)

        # The outer one of the two roots lies beyond the pull-off.
        ends = mpf(float(curve.stable[control][0][0])), mpf(10)
        e = mp.findroot(excess, ends, solver="bisect", maxsteps=150, verify=False)
        (step, s, phi), a = edge(e), 1 + e
        softer = step / ((2 * s - phi) / mpf(rounding) - step / (2 * a))
        expected, size = 2 * (a - softer), 2 * (a + abs(softer))
    error = abs(float(contact.normal_stiffness) - float(expected)) / float(size)
    assert error <= float(contact.error_estimates)


@pytest.mark.parametrize("share", [1.0, 1 - 1e-15, 1 - 1e-12])
@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
@pytest.mark.parametrize(
    "profile", [mdr.TruncatedCone(2.0, 0.1), mdr.TruncatedParaboloid(2.0, 1.0)]
)
def test_edge_of_a_sharp_flat_has_the_stiffness_of_its_punch(
    profile: Profile, control: str, share: float
) -> None:
    least = adhesion.Curve(profile, float(np.sqrt(2 * np.pi * 1e-6))).least[control]
    contact = adhesion.solve(profile, 1.0, 1e-6, **{control: share * least})
    assert close(contact.normal_stiffness, 4.0)


@pytest.mark.parametrize("profile", EACH_KIND, ids=lambda profile: profile.kind)
def test_controls_return_one_another(profile: Profile) -> None:
    first = adhesion.solve(profile, 2.0, 0.01, normal_force=np.linspace(-0.005, 0.3, 7))
    for name in ("indentation_depth", "contact_radius"):
        again = adhesion.solve(profile, 2.0, 0.01, **{name: getattr(first, name)})
        for result in ("contact_radius", "indentation_depth", "normal_force", "elastic_energy"):
            own, other = getattr(first, result), getattr(again, result)
            assert np.abs(own - other).max() <= 1e-9 * np.abs(own).max()


@pytest.mark.parametrize("part", [1e-1, 1e-4, 1e-8, 1e-12, 0.0])
@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
def test_estimate_bounds_the_error_next_to_pull_off(control: str, part: float) -> None:
    """The contact radius changes like the root of the load there; E* = R = 1, w = 1/pi."""
    with mp.workdps(50):
        w = mpf(1 / np.pi)
        least = -3 * mp.pi * w / 2 if control == "normal_force" else -mpf(3) / 4
        load = float(least * (1 - mpf(part)))
        load = max(load, float(adhesion_least(control)))

        def miss(a: mpf) -> mpf:
            step = mp.sqrt(2 * mp.pi * a * w)
            force = control == "normal_force"
            return (4 * a**3 / 3 - 2 * a * step if force else a * a - step) - mpf(load)

        start = mp.cbrt(9 * mp.pi * w / 8) if control == "normal_force" else mpf("0.5")
        guess = start * (1 + mp.sqrt(mpf(part) + mpf(10) ** -14))
        try:
            a = mp.findroot(miss, (start * (1 + mpf(10) ** -12), guess), solver="secant", tol=1e-40)
        except ValueError:
            a = start
        error = abs(float(a) / float(contact_at(control, load).contact_radius) - 1)
    assert error <= contact_at(control, load).error_estimate < 1


def contact_at(control: str, load: float) -> adhesion.AdhesiveContact:
    return adhesion.solve(mdr.Paraboloid(1.0), 1.0, 1 / np.pi, **{control: load})


def adhesion_least(control: str) -> Array:
    contact = contact_at(control, 1.0)
    return contact.pull_off_force if control == "normal_force" else contact.pull_off_depth


# Dense scans.


def random_contact(draw: Draw) -> tuple[Profile, float, float]:
    """Profile, E* and w at which phi reaches a level of stability at a random radius."""
    kinds = [*PROFILE_GENERATORS, "tabulated", *("truncated_cone", "capped_paraboloid") * 2]
    kind = draw.choice(kinds)
    if kind == "tabulated":
        profile = random_table(draw)
        radius = draw.uniform(0.02, 0.5)
    else:
        profile = profile_from({"kind": kind, **PROFILE_GENERATORS[kind](draw)})
        breaks = [float(b) for b in profile.breaks if b > 0] or [1.0]
        end = float(np.min(profile.domain))
        radius = draw.choice([1.0, breaks[0]]) * 10 ** draw.uniform(-1, 1)
        radius = max(min(radius, 0.9 * end), float(profile.first_radius) * (1 + 1e-6))
    e_star = 10 ** draw.uniform(-3, 3)
    slope = float(profile.dg(np.float64(radius)))
    retraction = radius * slope / draw.choice([0.5, 1.5]) * 10 ** draw.uniform(-0.3, 0.3)
    return profile, e_star, e_star * retraction**2 / (2 * np.pi * radius)


def random_table(draw: Draw) -> Profile:
    """Table with waves, whose slope may fall and rise several times."""
    r = np.linspace(0, 1, 60)
    waves, phase = draw.uniform(2, 12), draw.uniform(0, 6)
    slope = r ** draw.uniform(0.2, 2) * (1 + draw.uniform(0, 0.6) * np.sin(waves * r + phase))
    heights = np.concatenate([[0.0], np.cumsum((slope[1:] + slope[:-1]) / 2)]) / r.size
    return mdr.Tabulated(r, heights, uncertainty=1e-4 * heights[-1])


def loads(profile: Profile, c: float, at: Array, *, of_force: bool) -> tuple[Array, Array]:
    """Loads over E* at contact coordinates, and the sums of the sizes of their parts."""
    step = c * np.sqrt(profile.contact_radius(at))
    step = 2 * profile.contact_radius(at) * step if of_force else step
    whole = profile.reduced_force(at) if of_force else profile.depth(at)
    return whole - step, whole + step


def scanned(profile: Profile) -> Array:
    """Contact coordinates of a dense scan."""
    top = min(np.log10(profile.domain), 12.0)
    breaks, gaps = np.ravel([profile.coordinate_breaks]), np.logspace(-14, -1, 400)
    near = np.multiply.outer(breaks, np.concatenate([1 - gaps, 1 + gaps])).ravel()
    flat = [0.0] if float(profile.first_radius) > 0 else []
    at = np.concatenate([flat, np.logspace(-30, top, 30_000), breaks, near])
    return np.unique(at[at <= profile.domain])


def minima(at: Array, load: Array, size: Array) -> Array:
    """Places of minima; a fall and a rise as small as rounding error are none."""
    rises = np.diff(load) > 0
    turns = np.flatnonzero(rises[1:] != rises[:-1]) + 1
    turns = np.concatenate([[0], turns, [load.size - 1]])
    while turns.size > 2:
        steps = np.abs(np.diff(load[turns])) / np.maximum(size[turns[1:]], size[turns[:-1]])
        k = int(np.argmin(steps))
        if steps[k] > 1e-10:
            break
        turns = np.delete(turns, k + 1 if k == 0 else k if k == turns.size - 2 else [k, k + 1])
    heights = np.concatenate([[np.inf], load[turns], [-np.inf]])
    low = (heights[1:-1] < heights[:-2]) & (heights[1:-1] < heights[2:])
    return at[turns[low]]


def failures(seed: int) -> tuple[list[str], int]:
    """Differences from the scan, and the largest number of minima."""
    draw = Draw(seed)
    profile, e_star, w = random_contact(draw)
    said, most, c = f"{seed}: {profile}, E* {e_star}, w {w}", 0, np.sqrt(2 * np.pi * w / e_star)
    places = scanned(profile)
    with np.errstate(all="ignore"):
        parts = {name: loads(profile, c, places, of_force=name == "normal_force") for name in NAMES}
    try:
        contact = adhesion.solve(profile, e_star, w, indentation_depth=1e-9)
    except mdr.InputError as error:
        force, depth = (parts[name][0] for name in NAMES)
        right = {
            "spreads": force[-1] < force[-2] or "sqrt(r)" in str(error),
            "beyond radius": depth[-1] < 1e-9,
            "pull-off": depth[np.isfinite(depth)].min() >= 0.9e-9,
        }
        return ([] if any(right[cause] for cause in right if cause in str(error)) else [said]), 0
    found = []
    for name, part in parts.items():
        good = part[1] < 1e60
        at, load, size = places[good], part[0][good], part[1][good]
        low, high = contact.curve.stable[name]
        ends = np.unique([at[0], *low, *high[:-1], at[-1]])
        own = minima(ends, *loads(profile, c, ends, of_force=name == "normal_force"))
        lows = minima(at, load, size)
        most = max(most, len(lows))
        if len(lows) != len(own) or not np.allclose(own, lows, rtol=5e-3, atol=1e-29):
            found.append(f"{said}: {name} {own} for {lows}")
            continue
        least = contact.curve.least[name]
        if not -1e-12 * abs(least) <= load.min() - least <= 1e-4 * abs(least) + size[0]:
            found.append(f"{said}: {name} {least} for {load.min()}")
        # The outermost state under loads up to beyond the last maximum.
        tops = contact.curve.load(name, high)
        top = max([least, *tops[:-1]])
        for share in (0.01, 0.3, 0.7, 0.99):
            goal = least + share * (top - least + abs(least))
            if least < goal < min(tops[-1], load[-1]):
                state, _ = contact.curve.outermost(name, np.array([goal]))
                last = np.flatnonzero((load[:-1] < goal) & (load[1:] >= goal))[-1]
                if not at[last] * (1 - 1e-3) <= state[0] <= at[last + 1] * (1 + 1e-3):
                    found.append(f"{said}: {name} {goal} at {state[0]} for {at[last]}")
    return found, most


NAMES = ("normal_force", "indentation_depth")


@pytest.mark.parametrize("group", range(5))
def test_random_contacts_have_the_states_of_a_scan(group: int) -> None:
    results = [failures(seed) for seed in range(20 * group, 20 * group + 20)]
    assert not [line for found, _ in results for line in found]


# Twenty groups take six minutes.
@pytest.mark.long
@pytest.mark.parametrize("group", range(5))
def test_many_random_contacts_have_the_states_of_a_scan(group: int) -> None:
    results = [failures(1000 + seed) for seed in range(100 * group, 100 * group + 100)]
    assert not [line for found, _ in results for line in found]
    assert sum(most > 1 for _, most in results) >= 5


@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
def test_tip_sharper_than_a_root_has_no_contact_without_load(control: str) -> None:
    load: dict[str, Any] = {control: [1e-6, 0.0]}
    with pytest.raises(mdr.InputError, match=r"is not above the pull-off .*, 0: there") as error:
        mdr.adhesion.solve(mdr.Power(0.1, 0.45), 3e9, 1e-12, **load)
    assert error.value.path == ("load", control, 1)


def test_two_minima_give_the_lower_pull_off() -> None:
    """The force has one minimum at the edge of the blunt cap, and another on the body beyond."""
    profile, two = mdr.TruncatedCone(1.0, 0.1), 0
    for w in np.geomspace(1e-4, 1e-1, 30):
        contact = adhesion.solve(profile, 1.0, w, normal_force=100.0)
        at = scanned(profile)
        load, _ = loads(profile, contact.curve.c, at, of_force=True)
        assert contact.pull_off_force == pytest.approx(load.min(), rel=1e-5, abs=0)
        low, high = contact.curve.stable["normal_force"]
        assert low[0] == 0.0
        if low.size > 1:
            top = float(contact.curve.load("normal_force", high[0]))
            least = float(contact.curve.load("normal_force", low).max())
            two += top - least > 1e-6 * abs(least)
            between = (top + least) / 2
            state = adhesion.solve(profile, 1.0, w, normal_force=between)
            assert state.contact_radius > profile.contact_radius(low[1])
            assert state.states == 2 or top - least <= 1e-6 * abs(least)
            assert (state.states > 1) == (
                "several_states" in {notice.code for notice in state.warnings}
            )
    assert two


# Fields.

RADII = np.array([0.0, 0.3, 0.5, 0.69, 0.71, 1.0, 3.0])


def test_pressure_is_that_of_jkr() -> None:
    a, e_star, w = 0.7, 2.0, 0.05
    contact = adhesion.solve(mdr.Paraboloid(1.0), e_star, w, contact_radius=a)
    step = np.sqrt(2 * np.pi * a * w / e_star)
    root = np.sqrt(np.maximum(a**2 - RADII**2, 0))
    with np.errstate(divide="ignore"):
        expected = np.where(
            a > RADII, 2 * e_star * root / np.pi - e_star * step / (np.pi * root), 0.0
        )
    assert np.allclose(fields.pressure(contact, RADII), expected, rtol=1e-12, atol=0)
    assert contact.maximum_pressure == pytest.approx(expected[0], rel=1e-12, abs=0)
    assert np.isneginf(fields.pressure(contact, a))
    shape = 2 / np.pi * step * np.arcsin(a / np.maximum(RADII, a))
    without = fields.normal_displacement(contact.reference, RADII)
    assert np.allclose(
        fields.normal_displacement(contact, RADII), without - shape, rtol=1e-12, atol=0
    )
    load = fields.foundation_load(contact, RADII)
    inside = a > RADII
    assert np.allclose(
        load[inside], e_star * (contact.indentation_depth - RADII[inside] ** 2), atol=0
    )
    assert not load[~inside].any()


@pytest.mark.parametrize("profile", EACH_KIND, ids=lambda profile: profile.kind)
def test_pressure_balances_the_force(profile: Profile) -> None:
    contact = adhesion.solve(profile, 2.0, 0.01, normal_force=[-0.005, 0.1])
    for i, a in enumerate(contact.contact_radius):
        stops = np.unique([0.0, *(float(b) for b in profile.breaks if 0 < b < a), a])
        total = 0.0
        for low, high in pairwise(stops):
            # Substitutions remove the roots at both ends.
            t, weight = np.polynomial.legendre.leggauss(60)
            t, weight = (t + 1) / 2, weight / 2
            angle = np.pi / 2 * t
            r = low + (high - low) * np.sin(angle) ** 2
            dr = (high - low) * np.pi * np.sin(angle) * np.cos(angle) * weight
            total += float(2 * np.pi * (fields.pressure(contact, r)[i] * r * dr).sum())
        assert total == pytest.approx(float(contact.normal_force[i]), abs=2e-4 * 0.1)


@pytest.mark.parametrize("profile", EACH_KIND, ids=lambda profile: profile.kind)
def test_maximum_pressure_is_that_of_many_radii(profile: Profile) -> None:
    contact = adhesion.solve(profile, 2.0, 0.01, normal_force=[-0.005, 0.1])
    for i, (a, most) in enumerate(
        zip(contact.contact_radius, contact.maximum_pressure, strict=True)
    ):
        if np.isfinite(most):
            r = a * np.sin(np.linspace(0, np.pi / 2, 4001)[:-1])
            highest = fields.pressure(contact, r)[i].max()
            assert highest * (1 - 1e-12) <= most <= highest + 1e-4 * abs(highest)


def test_stress_beneath_meets_the_surface_and_the_axis() -> None:
    """sigma_zz = -p on the surface; on the axis it is the integral of the foundation's load."""
    a, e_star, w = 0.7, 2.0, 0.05
    contact = adhesion.solve(mdr.Paraboloid(1.0), e_star, w, contact_radius=[a, 0.9])
    r = np.array([0.1, 0.5, 0.69, 0.8])
    at = subsurface.stress(contact, r, 0.0, 0.0, poissons_ratio=0.3)
    assert np.allclose(at.zz, -fields.pressure(contact, r), rtol=1e-9, atol=1e-9)
    z = np.array([0.2, 1.0])
    at = subsurface.stress(contact, 0.0, 0.0, z, poissons_ratio=0.3)
    step, push = contact.retraction[0], e_star / np.pi

    def kernel(x: float, depth: float) -> float:
        return x * (1 / (x**2 + depth**2) + 2 * depth**2 / (x**2 + depth**2) ** 2)

    for k, depth in enumerate(z):
        smooth = mp.quad(lambda x, depth=depth: 2 * x * kernel(x, depth), [0, a])
        expected = -push * (float(smooth) - step * kernel(a, depth))
        assert at.zz[0, k] == pytest.approx(expected, rel=1e-11, abs=0)
    edge = subsurface.stress(contact, a, 0.0, 0.0, poissons_ratio=0.3)
    assert np.isposinf(edge.zz[0])
    assert np.isposinf(edge.von_mises[0])


def test_fields_of_loads_are_those_of_each() -> None:
    loads, profile = [-0.005, 0.1], mdr.CappedParaboloid(0.4, 3.0, 0.8)
    r = np.array([0.0, 0.2, 0.39, 0.41, 0.6])
    both = fields.pressure(adhesion.solve(profile, 2.0, 0.01, normal_force=loads), r)
    for row, load in zip(both, loads, strict=True):
        one = adhesion.solve(profile, 2.0, 0.01, normal_force=load)
        assert np.array_equal(row, fields.pressure(one, r))


def test_edge_error_grows_towards_the_edge() -> None:
    contact = adhesion.solve(mdr.Paraboloid(1.0), 2.0, 0.05, normal_force=0.1)
    a = float(contact.contact_radius)
    far, near = (fields.edge_error(contact, "pressure", a * (1 - gap)) for gap in (0.1, 1e-8))
    assert 0 < far < 1e-12 < near < 1e-5
    radii = fields.grid(contact, 40)
    assert fields.edge_error(contact, "pressure", radii) < 1e-9


# What is rejected.


@pytest.mark.parametrize("reach", [1e-3, 0.05])
def test_short_range_is_that_of_tabor(reach: float) -> None:
    """For a paraboloid it is (R w^2/(E*^2 z^3))^(1/3), with R = E* = 1."""
    contact = adhesion.solve(
        mdr.Paraboloid(1.0), 1.0, 0.02, normal_force=0.0, range_of_adhesion=reach
    )
    assert contact.tabor_number == pytest.approx(np.cbrt(0.02**2 / reach**3), rel=1e-12, abs=0)
    assert ("jkr_range" in {notice.code for notice in contact.warnings}) == (reach > 0.01)
