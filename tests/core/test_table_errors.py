"""The stated error of a table covers its true error, whatever its points are."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from mdr_core import adhesion, fields
from mdr_core.errors import InputError
from mdr_core.normal import solve
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedCone,
    RoundedPunch,
    Sphere,
    SphericalTipCone,
    Tabulated,
)
from tests.oracles import table_campaign
from tests.oracles.table_campaign import PARTS, Table

Array = np.ndarray
#: Rounding errors of the true body, which no estimate contains.
FLOOR = 1e-12


def compared(table: Table) -> tuple[Array, Array, set[str]]:
    """Return the larger relative error of depth and force, the stated one, and warning codes."""
    a = PARTS * np.abs(table.r).max()
    a = a[a > 1.001 * table.body.first_radius]
    profile = Tabulated(table.r, table.f, breaks=table.breaks, uncertainty=table.uncertainty)
    found, known = (solve(each, 1.0, contact_radius=a) for each in (profile, table.body))
    names = ("indentation_depth", "normal_force")
    missed = [np.abs(1 - getattr(known, name) / getattr(found, name)) for name in names]
    stated = np.maximum(np.asarray(found.data_error) + found.error_estimate, FLOOR)
    return np.maximum(*missed), stated, {notice.code for notice in found.warnings}


@pytest.mark.long
def test_random_tables_are_covered() -> None:
    missed, stated, silent = [], [], 0
    for seed in range(1000, 1700):
        off, known, codes = compared(table_campaign.drawn(seed))
        missed.append(off)
        stated.append(known)
        unsaid = (off > 0.05) & (off > 2 * known) & (known < 1)
        silent += bool(unsaid.any()) and "smoothed" not in codes
    ratio = np.concatenate(missed) / np.concatenate(stated)
    assert np.mean(ratio <= 1) >= 0.96
    assert np.mean(ratio <= 3) >= 0.99
    assert silent <= 2


def test_axis_point_within_rounding_is_on_the_axis() -> None:
    for k in range(3, 40):
        r = np.arange(-k * 0.1, (k + 0.5) * 0.1, 0.1)
        off, stated, _ = compared(Table(Paraboloid(1.0), "exact", r, r * r / 2, (), None))
        assert (off <= stated).all()


@pytest.mark.parametrize("body", [Paraboloid(2.0), Sphere(1.3), Cone(0.2), Power(1.0, 1.5)])
@pytest.mark.parametrize("least", [1e-12, 1e-9, 1e-6, 1e-4])
@pytest.mark.parametrize("axis", [True, False])
def test_geometric_radii(body: Profile, least: float, *, axis: bool) -> None:
    r = np.append([0.0] if axis else [], np.geomspace(least, 1, 60))
    off, stated, _ = compared(Table(body, "exact", r, np.asarray(body.f(r)), (), None))
    assert (off <= 3 * stated).all()
    assert off.max() <= 1e-2


def test_random_bodies_at_geometric_radii_are_covered() -> None:
    ratio = []
    for seed in range(80):
        random = np.random.default_rng(seed)
        body, breaks = table_campaign.bodies(random, 1.0)[seed % 10]
        r = np.geomspace(10 ** random.uniform(-12, -4), 1, int(random.integers(20, 200)))
        off, stated, _ = compared(Table(body, "exact", r, np.asarray(body.f(r)), breaks, None))
        ratio += (off / stated).tolist()
    assert np.mean(np.less_equal(ratio, 1)) >= 0.96
    assert np.mean(np.less_equal(ratio, 3)) >= 0.98


@pytest.mark.parametrize("seed", range(8))
def test_unit_changes_nothing(seed: int) -> None:
    """Few points with a break, such as a flat and a parabola beside it."""
    random = np.random.default_rng(seed)
    count, end = int(random.integers(5, 13)), 10 ** random.uniform(-3, 1)
    r = end * np.r_[0, np.sort(random.uniform(0, 1, count - 2)), 1]
    b = float(r[random.integers(1, count - 2)])
    f = np.square(np.maximum(r - b, 0.0)) / end
    forces = []
    for unit in (1.0, 1e3, 1e6, 1e-3):
        table = Tabulated(unit * r, unit * f, breaks=(unit * b,))
        a = unit * (b + (end - b) * np.array([0.1, 0.5, 0.9]))
        forces.append(solve(table, 1.0, contact_radius=a).normal_force / unit**2)
    for other in forces[1:]:
        assert other == pytest.approx(forces[0], rel=1e-9, abs=0)


def test_unit_changes_no_stated_error() -> None:
    """A point that only the columns can fit has no residual but rounding errors."""
    r = np.array(
        [0, 0.013528061738703648, 0.041138443103225154, 0.07884822479149367, 0.12510081145737495]
    )
    f = np.array([0, 0, 6.402514224275244e-06, 0.0008395520350751366, 0.003771253806364244])
    stated = []
    for unit in (1.0, 1e3, 1e6):
        table = Tabulated(unit * r, unit * f, breaks=(unit * r[2],))
        contact = solve(table, 1.0, contact_radius=unit * 0.0464)
        stated.append(float(np.asarray(contact.data_error)))
    assert stated == pytest.approx([stated[0]] * 3, rel=1e-6, abs=0)


def test_round_numbers_are_not_rounded() -> None:
    """1, 2, 5, 10, ... have one digit each, and no error of half of it."""
    r = np.append(np.outer([0.01, 0.1, 1.0], [1, 2, 5]).round(2), 10.0)
    off, stated, codes = compared(Table(Paraboloid(1.0), "exact", r, r * r / 2, (), None))
    assert (off <= stated).all()
    assert stated.max() < 0.02
    assert "smoothed" not in codes


def test_rounded_points_of_an_undeclared_edge_are_a_body() -> None:
    """What no admissible shape comes near is not rounding, and the digits weight no points."""
    r = np.array([-25.54, -17.03, -8.513, 0.0, 8.513, 17.03, 25.54])
    f = np.array([5.603, 2.075, 0.1585, -0.002895, 0.1703, 2.07, 5.603])
    body = CappedParaboloid(10.205823804, 204.31949304, 51.079873260)
    off, stated, _ = compared(Table(body, "digits", r, f, (), None))
    assert (off <= stated).all()


@pytest.mark.parametrize(
    ("body", "b"),
    [
        (SphericalTipCone(0.5, 0.3 * np.hypot(1, 0.5) / 0.5), 0.3),
        (RoundedPunch(0.3, 2.0), 0.3),
        (RoundedCone(0.5, 0.6), 0.3),
    ],
)
@pytest.mark.parametrize("count", [20, 57, 199, 200])
def test_break_of_the_curvature_shows_no_jump_of_the_slope(
    body: Profile, b: float, count: int
) -> None:
    r = np.linspace(0, 1, count)
    assert not Tabulated(r, np.asarray(body.f(r)), breaks=(b,)).infinite_pressure_radii


def test_tip_of_a_long_table_in_even_heights_is_covered() -> None:
    """A = 24.5 h^2 + 40 h: the first of the radii lies far beyond the tip of 2.3 nm."""
    body = Hyperboloid(np.sqrt(np.pi / 24.5), 40 / (2 * np.pi))
    h = np.linspace(0, 2000, 201)
    r = np.sqrt((24.5 * h * h + 40 * h) / np.pi)
    a = np.array([3.0, 8.0, 30.0])
    found, known = (solve(each, 1.0, contact_radius=a) for each in (Tabulated(r, h), body))
    missed = np.abs(found.normal_force / known.normal_force - 1)
    assert (missed <= np.asarray(found.data_error)).all()


@pytest.mark.long
def test_pressures_of_random_tables_are_covered() -> None:
    """On the axis and at 0.3 of the contact radius, where both pressures are finite."""
    ratios = []
    for seed in range(80):
        table = table_campaign.drawn(seed)
        a = float(0.6 * np.abs(table.r).max())
        if a <= 1.001 * table.body.first_radius:
            continue
        profile = Tabulated(table.r, table.f, breaks=table.breaks, uncertainty=table.uncertainty)
        found, known = (solve(each, 1.0, contact_radius=a) for each in (profile, table.body))
        if not np.isfinite(found.maximum_pressure):
            continue
        stated = max(float(np.asarray(found.pressure_data_error)), 1e-9)
        pair = np.array([fields.pressure(each, [0.0, 0.3 * a]) for each in (found, known)])
        pair = pair[:, np.isfinite(pair).all(axis=0)] / float(found.maximum_pressure)
        ratios += (np.abs(pair[0] - pair[1]) / stated).tolist()
    assert len(ratios) > 80
    assert np.mean(np.less_equal(ratios, 1)) >= 0.93


def test_pull_off_of_a_noisy_ball_is_covered() -> None:
    """-(3/2) pi w R."""
    r, covered = np.linspace(0, 1, 40), []
    for seed in range(20):
        noise = 1e-3 * np.random.default_rng(seed).standard_normal(r.size)
        contact = adhesion.solve(Tabulated(r, r * r / 2 + noise), 1.0, 1e-3, contact_radius=0.5)
        missed = abs(float(contact.pull_off_force) / (-1.5 * np.pi * 1e-3) - 1)
        covered.append(missed <= float(np.asarray(contact.pull_off_data_error)))
    assert np.mean(covered) >= 0.9


def test_rival_tip_is_named() -> None:
    """Points of a hyperboloid far beyond its tip do not show that it is smooth."""
    r = np.linspace(0.0, 1.0, 12)
    codes = {each.code for each in solve(Tabulated(r[1:], r[1:]), 1.0, contact_radius=0.5).warnings}
    assert "tip" in codes
    assert "plastic" not in codes
    exact = solve(Tabulated(r, r), 1.0, contact_radius=0.5)
    assert {"plastic", "tip"} & {each.code for each in exact.warnings} == {"plastic"}


def test_tip_within_the_first_radius_is_not_sharp_for_certain() -> None:
    """A = 24.5 h^2 + 40 h in steps of 2 nm: the tip of 2.3 nm, the first of the radii 7.5 nm."""
    body, h = Hyperboloid(np.sqrt(np.pi / 24.5), 40 / (2 * np.pi)), np.linspace(0, 2000, 1001)
    tip = Tabulated(np.sqrt((24.5 * h * h + 40 * h) / np.pi).round(3), h)
    found, known = (solve(each, 1.0, indentation_depth=[5.0, 10.0]) for each in (tip, body))
    assert {"plastic", "tip"} & {each.code for each in found.warnings} == {"tip"}
    missed = np.abs(found.normal_force / known.normal_force - 1)
    assert (missed <= np.asarray(found.data_error)).all()
    assert missed.max() < 0.01


#: C0, C1, ... of a calibrated Berkovich tip [nm]: negative between 2.3 and 3.4 nm alone.
CALIBRATED = (24.5, 2460.555732, -185073.933454, 2197392.23639, -5682984.151049, 3678718.2292)


def test_area_function_with_negative_coefficients() -> None:
    with pytest.raises(InputError, match=r"A\(h\) .* below the height 3\.\d") as refused:
        Tabulated.from_area_coefficients(CALIBRATED, 400.0)
    assert refused.value.path == ("profile", "lowest_height")
    tip = Tabulated.from_area_coefficients(CALIBRATED, 400.0, 10.0)
    # 100 nm deep, E* = 69.6 GPa.
    assert 0.00195 < solve(tip, 69.6e-9, indentation_depth=100.0).normal_force < 0.00211


@pytest.mark.parametrize("seed", range(5))
def test_calibrated_area_functions_are_covered(seed: int) -> None:
    """Fits of six coefficients to a Berkovich tip of a known radius, with errors of 1 %.

    F_N/(2 E*) = int_0^h(a) r^2 / sqrt(a^2 - r^2) dh, with pi r^2 = A(h).
    """
    random = np.random.default_rng(seed)
    radius, h = random.uniform(20, 150), np.geomspace(15, 1000, 40)

    def known(h: Array) -> Array:
        return 24.5 * h * h + 2 * np.pi * radius * h

    area = known(h) * (1 + 0.01 * random.standard_normal(h.size))
    coefficients = np.linalg.lstsq(_terms(h) / area[:, None], np.ones_like(h))[0]
    tip = Tabulated.from_area_coefficients(coefficients.tolist(), 1000.0, 15.0)
    # Below the lowest height the tip is as sharp as the known one.
    share = (_terms(np.array([15.0])) @ coefficients).item() / known(15.0)
    a, force = np.array([150.0, 400.0]), []
    for end in a.tolist():
        top = brentq(
            lambda z, end=end: float(_terms(z) @ coefficients) - np.pi * end**2,
            15,
            1000,
            xtol=1e-12,
        )
        # z = h(a) (1 - t^2) removes the singularity at the edge.
        t, weights = np.polynomial.legendre.leggauss(400)
        t, weights = (t + 1) / 2, weights / 2
        z = top * (1 - t * t)
        square = np.where(z > 15, _terms(z) @ coefficients, share * known(z)) / np.pi
        force.append(2 * top * weights @ (2 * t * square / np.sqrt(end**2 - square)))
    found = solve(tip, 1.0, contact_radius=a)
    missed = np.abs(found.normal_force / np.array(force) - 1)
    assert (missed <= np.asarray(found.data_error)).all()


def _terms(h: Array) -> Array:
    """h^2, h, h^(1/2), ..., of which A(h) is a sum, shape (..., 6)."""
    return np.stack([np.power(h, 2.0 ** (1 - i)) for i in range(6)], axis=-1)
