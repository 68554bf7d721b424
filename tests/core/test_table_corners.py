"""Fields of a table are right next to knots, edge, breaks and the last radius."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.sparse import csr_matrix

from mdr_core import fields, history, tangential
from mdr_core.abel.slope_pieces import heights
from mdr_core.errors import InputError
from mdr_core.normal import solve
from mdr_core.profiles import Sphere, Tabulated, TruncatedCone, TruncatedParaboloid
from tests.oracles import instrument_tables

END, EDGE = 0.6, 0.5
#: Error of 200 exact points of a sphere.
SAMPLED = 1e-12


def sphere(r: np.ndarray) -> np.ndarray:
    return np.asarray(r * r / (1 + np.sqrt(1 - r * r)))


@pytest.mark.parametrize("grading", [1, 1.5])
@pytest.mark.parametrize("a", [EDGE, 0.0301])
def test_pressure_next_to_knots_and_edge(grading: float, a: float) -> None:
    r = END * np.linspace(0, 1, 200) ** grading
    knots = r[(r > 0.2 * a) & (r < a)][[0, -1]]
    radii = [float(np.nextafter(x, side)) for x in knots for side in (0.0, 1.0)]
    radii += [x * (1 + step) for x in knots.tolist() for step in (-1e-6, 1e-6, 1e-9)]
    radii += [0.0, *(a * part for part in (0.7123, 0.91, 1 - 1e-3, 1 - 1e-9))]
    found, expected = (
        fields.pressure(solve(body, 1.0, contact_radius=a), radii)
        for body in (Tabulated(r, sphere(r)), Sphere(1.0))
    )
    assert found == pytest.approx(expected, rel=1e-8, abs=SAMPLED * expected.max() * 1e3)


@pytest.mark.parametrize("place", [-1e-3, -1e-13, 0, 1e-13, 1e-6, 1e-3])
def test_stick_edge_next_to_a_knot(place: float) -> None:
    r = END * np.linspace(0, 1, 201)
    c = float(r[80] * (1 + place))
    radii = [0.3 * c, c * (1 - 1e-2), c * (1 - 1e-6), c * (1 + 1e-6), 0.47]
    found, expected = (
        fields.shear_stress(
            tangential.solve(solve(body, 1.0, contact_radius=EDGE), 1.0, 1.0, stick_radius=c),
            radii,
        )
        for body in (Tabulated(r, sphere(r)), Sphere(1.0))
    )
    assert found == pytest.approx(expected, rel=1e-9, abs=0)


def test_long_table_converges_to_its_body() -> None:
    r = np.linspace(0, END, 6001)
    contact = solve(Tabulated(r, sphere(r)), 1.0, contact_radius=EDGE)
    # The exact sphere: g = x artanh(x).
    assert contact.indentation_depth == pytest.approx(EDGE * np.arctanh(EDGE), rel=SAMPLED, abs=0)
    radii = np.linspace(0.0, 0.45, 7)
    expected = fields.pressure(solve(Sphere(1.0), 1.0, contact_radius=EDGE), radii)
    assert fields.pressure(contact, radii) == pytest.approx(expected, rel=1e-9, abs=0)


def test_displacements_of_a_table() -> None:
    """In full slip the slip is the shape itself; outside the contact: [johnson] Eq. (3.42)."""
    r = np.linspace(0, END, 200)
    profile = Tabulated(r, sphere(r))
    inside = np.linspace(0.01, EDGE, 50)
    result = profile.slip_integral(np.zeros_like(inside), inside)
    assert result == pytest.approx(sphere(inside), rel=1e-6, abs=0)
    contact = solve(Tabulated(r, r * r / 2), 1.0, contact_radius=EDGE)
    outside = EDGE * (1 + np.geomspace(1e-6, 10, 50))
    root = np.sqrt((outside - EDGE) * (outside + EDGE))
    expected = (2 * EDGE**2 - outside**2) * np.arcsin(EDGE / outside) + EDGE * root
    result = fields.normal_displacement(contact, outside)
    assert result == pytest.approx(expected / np.pi, rel=1e-6, abs=0)


@pytest.mark.parametrize("c", [1e-12, 1e-6, 1e-3, 0.05, 0.3])
def test_traction_on_the_axis_of_a_sticking_tip(c: float) -> None:
    """The stress is finite if slip does not reach a tip: for a cone, (1/2) ln(a/c)."""
    contact = solve(Tabulated([0, 0.5, 1.5], [0, 0.5, 1.5]), 1.0, contact_radius=1.0)
    tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
    result = fields.shear_stress(tangential_contact, [0.0])
    assert result[0] == pytest.approx(-np.log(c) / 2, rel=1e-12, abs=0)


@pytest.mark.parametrize("tabulated", [True, False])
@pytest.mark.parametrize("force", [1e-6, 1e-2])
@pytest.mark.parametrize("part", [0.5, 0.999])
def test_stresses_next_to_a_flat(*, force: float, part: float, tabulated: bool) -> None:
    """Truncated paraboloid, R = 1: g' dx = (2s^2 + b^2)/x ds, F/E* = 2s (2s^2 + 3b^2)/3."""
    b, r, radii = 0.25, np.array([0.0, 0.25, 0.5, 0.75, 1.0]), [0.0, 0.1, 0.2, 0.2499]
    table = Tabulated(r, np.maximum(r * r - b * b, 0) / 2, (b,))
    body = table if tabulated else TruncatedParaboloid(b, 1.0)
    contact = solve(body, 1.0, normal_force=force)
    partial = tangential.solve(contact, 1.0, 1.0, tangential_force=part * force)
    found = fields.pressure(contact, radii), fields.shear_stress(partial, radii)
    # Contact and stick radii hardly resolve their distances from the flat, 1e-10 and 1e-15.
    least = 1e-9 if force < 1e-4 else 1e-11
    bound = max(least, 10 * contact.error_estimate, 10 * partial.error_estimate)
    assert bound <= (1e-2 if force < 1e-4 else 1e-9)

    def root(load: mpf) -> mpf:
        return mp.findroot(lambda s: 2 * s * (2 * s * s + 3 * b * b) / 3 - load, load / (2 * b * b))

    with mp.workdps(40):
        outer, inner = root(mpf(force)), root(mpf(force) - mpf(part * force))
        for low, values in zip((mpf(0), inner), found, strict=True):
            for x, value in zip(radii, values, strict=True):
                square = mpf(b) ** 2 - mpf(x) ** 2
                true = mp.quad(
                    lambda s, k=square: (
                        (2 * s * s + b * b) / mp.sqrt((s * s + b * b) * (s * s + k))
                    ),
                    [low, (low + outer) / 2, outer],
                )
                assert value == pytest.approx(float(true / mp.pi), rel=bound, abs=0)


def test_rounded_radii_on_a_long_flat_weight_the_heights() -> None:
    # Most heights are equal, and their errors zero: the slope of a truncated cone remains.
    r = np.round(np.linspace(0.0, 1.0, 25) ** 2, 5)
    f = np.maximum(r - 0.5, 0.0)
    table = Tabulated(r, f, breaks=[0.5])
    cone = TruncatedCone(0.5, 1.0)
    forces = [float(solve(each, 1.0, contact_radius=0.8).normal_force) for each in (table, cone)]
    assert forces[0] == pytest.approx(forces[1], rel=1e-2, abs=0)


@pytest.mark.parametrize("seed", [900012, 900035])
def test_no_pressure_exceeds_the_maximum(seed: int) -> None:
    """The rounded heights give a slope for which g'/x rises on the axis, by 3e-6 and 7e-6."""
    points = instrument_tables.drawn(seed, most=300)
    table = Tabulated(points.r, points.f)
    contact = solve(table, 1.0, contact_radius=0.02 * table.domain)
    pressure = fields.pressure(contact, np.linspace(0, 0.9, 200) * contact.contact_radius)
    assert pressure.max() <= (1 + 1e-12) * float(contact.maximum_pressure)


@pytest.mark.parametrize("upwards", [False, True])
@pytest.mark.parametrize(("first", "last"), [(0.0, 0.8), (0.0, 0.7), (-0.2, 0.7)])
def test_scan_not_measured_from_its_axis_is_told_the_axis(
    first: float, last: float, *, upwards: bool
) -> None:
    axis, position = 0.4, np.linspace(first, last, 81)
    height = (position - axis) ** 2 / 2
    with pytest.raises(InputError) as error:
        Tabulated(position, 1 - height if upwards else height)
    assert "subtract that of the axis, near 0.4" in error.value.detail
    assert ("reverse the sign of the heights" in error.value.detail) == upwards


def test_history_next_to_the_edge_of_a_flat() -> None:
    """Contacts beyond the edge by less than the spacing of doubles, and by 1e-5 of the edge."""
    b, end = 0.0522589871276889, 0.160067550986061
    assert b / end * end != b
    r = np.union1d(np.linspace(0.0, end, 41), [b])
    table, cone = Tabulated(r, np.maximum(r - b, 0.0), breaks=[b]), TruncatedCone(b, 1.0)
    path = {"normal_force": [1e-12, 1e-4, 9e-5, 2e-4], "tangential_force": [0, 5e-7, -6e-11, 2e-5]}
    found, expected = (
        history.solve(each, 1.0, 0.9, 0.1, **path).tangential_energy for each in (table, cone)
    )
    # The third load is a remainder of the second: energies have digits of the largest of the path.
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-12 * expected.max())


@pytest.mark.parametrize(
    "controls",
    [
        ("normal_force", "tangential_displacement"),
        ("indentation_depth", "tangential_force"),
        ("indentation_depth", "tangential_displacement"),
    ],
)
def test_small_steps_of_a_history_next_to_the_edge_of_a_flat(controls: tuple[str, str]) -> None:
    """The load, not the rounded radius, places the contact 1e-4 beyond the edge."""
    r, cone = np.linspace(0.0, 1.0, 21), TruncatedCone(0.5, 0.1)
    table = Tabulated(r, np.maximum(r - 0.5, 0.0) / 10, breaks=[0.5], uncertainty=0.0)
    scale = float(getattr(solve(cone, 1.0, contact_radius=0.50005), controls[0]))
    path = {
        controls[0]: scale * np.array([1.0, 1 - 1e-6, 1 - 1e-3, 1.0]),
        controls[1]: 0.3 * scale * np.array([0.0, 1e-7, 1e-6, 0.01]),
    }
    found, expected = (history.solve(each, 1.0, 1.0, 0.3, **path) for each in (table, cone))
    for name in ("tangential_force", "tangential_displacement", "dissipated_energy"):
        ours, right = getattr(found, name), getattr(expected, name)
        assert ours == pytest.approx(right, rel=0, abs=1e-11 * np.abs(right).max())


@pytest.mark.parametrize("count", [40, 200])
def test_work_of_friction_over_a_nearly_flat_part(count: int) -> None:
    """W = (2 mu^2 E*^2/G*) int_0^a (d - g) g dx by Gauss's rule on each piece of the slope."""
    r = np.linspace(0.0, 1.5, count)
    table = Tabulated(r, r * r / 200 + 2 * np.maximum(r - 0.52, 0.0))
    contact = solve(table, 1.0, indentation_depth=0.028)
    force, a = 0.3 * float(contact.normal_force), float(contact.contact_radius)
    ends = np.append(table.fit.pieces.edges[table.fit.pieces.edges < a], a)[:, None]
    nodes, weights = np.polynomial.legendre.leggauss(24)
    half = np.diff(ends, axis=0) / 2
    g = table.g(np.ravel(ends[:-1] + half * (1 + nodes)))
    expected = 2 * 0.3**2 / 0.8 * np.ravel(half * weights) @ ((0.028 - g) * g)
    slid = tangential.solve(contact, 0.8, 0.3, tangential_force=force)
    path = {"indentation_depth": [0.028] * 2, "tangential_force": [0.0, force]}
    followed = history.solve(table, 1.0, 0.8, 0.3, **path)
    assert float(slid.dissipated_energy) == pytest.approx(expected, rel=1e-12, abs=0)
    assert followed.dissipated_energy[1] == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.parametrize("breaks", [[1.0], [1.0, 1.0]])
def test_table_of_three_points_with_a_break(breaks: list[float]) -> None:
    table = Tabulated([0.0, 1.0, 2.0], [0.0, 0.0, 1.0], breaks=breaks)
    contact = solve(table, 1.0, contact_radius=1.5)
    assert float(contact.indentation_depth) > 0
    assert np.isfinite(fields.pressure(contact, [0.0, 0.5, 1.2])).all()


def test_depth_just_beyond_a_break_of_few_points() -> None:
    """Newton's steps can lead from one side of the break to the other and back."""
    r = [0.0, 0.00677896346046757, 0.0657986089008723, 0.218283503583321, 0.255485577995918]
    f = [0.0, 7.26415265443211e-07, 6.87301849555073e-05, 0.000792528154780227]
    table = Tabulated(
        [*r, 0.476484650709328],
        [*f, 0.00110882851505726, 0.00545299844501481],
        breaks=[0.0477689933031986],
    )
    depth = 1.8069165676637576e-05
    contact = solve(table, 1.0, indentation_depth=depth)
    assert table.g(contact.contact_radius) == pytest.approx(depth, rel=1e-12, abs=0)


def test_nodes_stay_in_their_piece() -> None:
    """Rounding errors do not lead beyond a first piece far thinner than the others."""
    knots = np.array([0.0, 5.63e-15, 1.126e-9, 2.252e-9, 0.292, 1.0])
    seen: list[np.ndarray] = []

    def basis(x: np.ndarray) -> csr_matrix:
        seen.append(x)
        return csr_matrix(np.ones((x.size, 1)))

    # g' = 1 is a cone: f = (2/pi) r.
    found = heights(knots, knots[1:], basis)[:, 0]
    assert found == pytest.approx(2 / np.pi * knots[1:], rel=1e-9, abs=0)
    assert all(0 < x.min() <= x.max() <= 1 for x in seen)


@pytest.mark.parametrize("part", [1e-2, 1e-5, 1e-8])
def test_work_of_friction_where_noise_leaves_a_flat(part: float) -> None:
    """W = (2 mu^2 E*^2/G*) int_c^a (g(a) - g) (g - g(c)) dx, both factors as integrals of g'."""
    r = np.linspace(0.0, 3.0, 251)
    noise = np.random.default_rng(5).normal(0.0, 2e-5, r.size)
    table = Tabulated(r, 0.02 * np.square(np.maximum(r - 1.0, 0.0)) + noise)
    contact = solve(table, 1.0, contact_radius=0.178)
    moved = 0.3 * part * float(contact.indentation_depth)
    found = tangential.solve(contact, 1.0, 0.3, tangential_displacement=moved)
    c, edges = float(found.stick_radius), table.fit.pieces.edges
    ends = np.concatenate([[c], edges[(edges > c) & (edges < 0.178)], [0.178]])[:, None, None]
    nodes, weights = (each[:, None] for each in np.polynomial.legendre.leggauss(24))
    half = np.diff(ends, axis=0) / 2
    x = ends[:-1] + half * (1 + nodes)

    def rise(low: np.ndarray, high: np.ndarray) -> np.ndarray:
        at = low + (high - low) / 2 * (1 + nodes[:, 0])
        return np.asarray((high - low) / 2 * (table.dg(at) @ weights))

    whole = rise(ends[:-1], ends[1:])
    below = np.cumsum(whole, axis=0) - whole + rise(ends[:-1], x)
    above = np.cumsum(whole[::-1], axis=0)[::-1] - whole + rise(x, ends[1:])
    expected = 2 * 0.3**2 * float(np.sum(half * weights * below * above))
    # Next to no slip the stick radius has fewer digits.
    assert float(found.dissipated_energy) == pytest.approx(expected, rel=1e-6, abs=0)


@pytest.mark.parametrize("place", [2.5e-4, 3e-4, 4e-4])
def test_pressure_is_infinite_from_a_declared_corner_on(place: float) -> None:
    # The corners lie between the points or on them.
    r = np.linspace(0.0, 1e-3, 40)
    table = Tabulated(r, r**2 / 0.02 + 0.1 * np.maximum(r - place, 0.0), breaks=[place])
    for radius in (place * (1 + 1e-3), [place * (1 - 1e-3), place * (1 + 1e-3)]):
        largest = solve(table, 1e9, contact_radius=radius).maximum_pressure
        assert np.isinf(largest).tolist() == np.greater(radius, place).tolist()


def test_step_from_a_nearly_flat_part_stays_in_the_table() -> None:
    """Where g hardly rises, a step of Newton's method exceeds the range of doubles."""
    r = [0.0, 0.0054013732, 0.009343405, 0.010802746, 0.01620412]
    f = [1.0889754e-08, 9.9424136e-08, 2.4869352e-07, 1.2475936e-06, 6.0230374e-06]
    table, depth = Tabulated(r, f, uncertainty=4.8372163167661616e-08), 2.1738860903574165e-08
    contact = solve(table, 1.0, indentation_depth=depth)
    assert table.g(contact.contact_radius) == pytest.approx(depth, rel=1e-12, abs=0)


@pytest.mark.parametrize("unit", [1e-45, 1e-30, 1e30, 1e45])
def test_table_in_any_unit_has_the_same_contact(unit: float) -> None:
    r = np.linspace(0.0, 1.0, 40)
    f = r * r / 2 + r**4 / 10

    def loads(unit: float) -> list[float]:
        profile = Tabulated(unit * r, unit * f)
        contact = solve(profile, 1.0, contact_radius=0.7 * unit)
        scaled = (
            (contact.indentation_depth, 1),
            (contact.normal_force, 2),
            (contact.elastic_energy, 3),
        )
        return [float(value / unit**power) for value, power in scaled]

    assert loads(unit) == pytest.approx(loads(1.0), rel=1e-13, abs=0)
