"""The stated error of a table covers its true error, whatever its points are."""

from __future__ import annotations

import numpy as np
import pytest

from mdr_core.normal import solve
from mdr_core.profiles import (
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
    """Larger error of depth and force, the stated one, and the codes of warnings."""
    a = PARTS * np.abs(table.r).max()
    a = a[a > 1.001 * table.body.first_radius]
    profile = Tabulated(table.r, table.f, breaks=table.breaks, uncertainty=table.uncertainty)
    found, known = (solve(each, 1.0, contact_radius=a) for each in (profile, table.body))
    names = ("indentation_depth", "normal_force")
    missed = [np.abs(getattr(found, name) / getattr(known, name) - 1) for name in names]
    stated = np.maximum(np.asarray(found.data_error) + found.error_estimate, FLOOR)
    return np.maximum(*missed), stated, {notice.code for notice in found.warnings}


@pytest.mark.parametrize(
    ("first", "count"), [(0, 250), pytest.param(1000, 700, marks=pytest.mark.long)]
)
def test_random_tables_are_covered(first: int, count: int) -> None:
    missed, stated, silent = [], [], 0
    for seed in range(first, first + count):
        off, known, codes = compared(table_campaign.drawn(seed))
        missed.append(off)
        stated.append(known)
        unsaid = (off > 0.05) & (off > 2 * known) & (known < 1)
        silent += bool(unsaid.any()) and "smoothed" not in codes
    ratio = np.concatenate(missed) / np.concatenate(stated)
    assert np.mean(ratio <= 1) >= 0.96
    assert np.mean(ratio <= 3) >= 0.98
    assert silent <= max(1, count // 300)


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


@pytest.mark.parametrize("seed", range(8))
def test_unit_changes_nothing(seed: int) -> None:
    """Few points with a break, as of a flat and a parabola beside it."""
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
