"""Difficult tables: radii next to a node, nearly equal radii, kinks, and long tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.interpolate import CubicSpline

from mdr_core import fields, tangential
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact, solve
from mdr_core.profiles import Tabulated, TruncatedParaboloid
from mdr_core.profiles.table_interpolation import interpolate
from tests.oracles.tables import TABLE_DIGITS, Table

INTERPOLANT = 1e-12
INTERPOLATIONS = ("cubic", "pchip", "linear")
END, EDGE = 0.6, 0.5
#: A step of h = 1e-4 leaves h^3, h^2 and h in the slope, and half an order less in its transforms.
SAMPLED = {"cubic": 1e-9, "pchip": 1e-6, "linear": 1e-4}


def sphere(r: np.ndarray) -> np.ndarray:
    return np.asarray(r * r / (1 + np.sqrt(1 - r * r)))


def worst_pressure(r: np.ndarray, kind: Any, a: float, radii: list[float]) -> float:
    """Largest error of p relative to the transform of the interpolant, at each radius."""
    f = sphere(r)
    contact = solve(Tabulated(r, f, kind), 1.0, contact_radius=a, rtol=1e-11)
    result = fields.pressure(contact, radii, rtol=1e-11)
    with mp.workdps(TABLE_DIGITS):
        exact = Table({"r": r.tolist(), "f": f.tolist(), "interpolation": kind})
        truth = [exact.pressure(mpf(x), mpf(a)) for x in radii]
        return max(
            float(abs(mpf(float(p)) / true - 1)) for p, true in zip(result, truth, strict=True)
        )


@pytest.mark.every(15)
@pytest.mark.parametrize("kind", INTERPOLATIONS)
@pytest.mark.parametrize("grading", [1, 2])
@pytest.mark.parametrize("a", [EDGE, 0.0301])
def test_pressure_next_to_nodes_and_edge(kind: Any, grading: int, a: float) -> None:
    r = END * np.linspace(0, 1, 22) ** grading
    # A cubic's slope on the axis is rounding error, and so is the pressure close to it.
    inner = r[(r > 0.02) & (r < a)][[0, -1]] if a == EDGE else np.array([])
    radii = [float(np.nextafter(x, side)) for x in inner for side in (0.0, 1.0)]
    radii += [x * (1 + step) for x in inner.tolist() for step in (-1e-6, 1e-6, 1e-9)]
    radii += [a * part for part in (0.7123, 0.91, 1 - 1e-3, 1 - 1e-9)]
    assert worst_pressure(r, kind, a, radii) <= INTERPOLANT


@pytest.mark.parametrize("kind", INTERPOLATIONS)
def test_pressure_on_either_side_of_a_node_next_to_the_edge(kind: Any) -> None:
    """The interval between radius and node is as short as that between node and edge."""
    r = END * np.linspace(0, 1, 4) ** 1.5
    node = float(r[2])
    radii = [node * (1 - part * 1e-9) for part in (1.0, 10.0, 100.0)] + [node * (1 + 1e-8)]
    assert worst_pressure(r, kind, node * (1 + 1e-6), radii) <= INTERPOLANT


@pytest.mark.every(15)
@pytest.mark.parametrize("kind", INTERPOLATIONS)
@pytest.mark.parametrize("gap", [1e-12, 1e-9, 1e-5, 1e-2])
def test_pressure_where_two_radii_nearly_agree(kind: Any, gap: float) -> None:
    r = np.linspace(0, END, 22)
    twin = r[10] * (1 + gap)
    r = np.sort(np.append(r, twin))
    radii = [0.1, 0.2, r[10] * (1 - gap / 3), r[10] * (1 + gap / 3), twin * (1 + gap / 3), 0.47]
    assert worst_pressure(r, kind, EDGE, [float(x) for x in radii]) <= INTERPOLANT


def long_contact(points: int, kind: Any) -> NormalContact:
    r = np.linspace(0, END, points)
    return solve(Tabulated(r, sphere(r), kind), 1.0, contact_radius=EDGE, rtol=1e-10)


@pytest.mark.parametrize("kind", INTERPOLATIONS)
def test_long_table_converges_to_its_body(kind: Any) -> None:
    contact = long_contact(6001, kind)
    # The exact sphere: g = x artanh(x).
    assert contact.indentation_depth == pytest.approx(
        EDGE * np.arctanh(EDGE), rel=SAMPLED[kind], abs=0
    )
    radii = np.linspace(0.001, 0.45, 7) + 1e-5
    pressure = fields.pressure(contact, radii)
    with mp.workdps(30):
        truth = [
            mp.quad(
                lambda u, r=r: mp.atanh(mp.hypot(r, u)) / mp.hypot(r, u) + 1 / (1 - r * r - u * u),
                [0, mp.sqrt((EDGE - r) * (EDGE + r))],
            )
            / mp.pi
            for r in map(mpf, radii.tolist())
        ]
    error = np.abs(pressure / np.array([float(p) for p in truth]) - 1)
    # At the first points the pressure has the logarithmic singularity of a nonzero slope.
    assert error[1:].max() <= SAMPLED[kind]


def test_distant_panels_are_merged() -> None:
    """Pairs of a block and a radius grow with the logarithm of the number of points."""
    counts = []
    for points in (201, 3201):
        profile = Tabulated(np.linspace(0, END, points), np.linspace(0, END, points) ** 2)
        blocks = profile.resolved.stress._multipoles
        place = np.linspace(0, EDGE, 1000, endpoint=False)
        low, high = blocks.far_from(place, 0, blocks.edge.size)
        counts.append(int((high - low).sum()))
    assert counts[1] <= 2 * counts[0]


def test_displacements_of_a_table() -> None:
    """In full slip the slip is the shape itself; outside the contact: [johnson] Eq. (3.42)."""
    r = np.linspace(0, END, 200)
    profile = Tabulated(r, sphere(r))
    inside = np.linspace(0.01, EDGE, 50)
    result = profile.slip_kernel(np.zeros_like(inside), inside, 1e-6)
    assert result == pytest.approx(sphere(inside), rel=1e-6, abs=0)
    contact = solve(Tabulated(r, r * r / 2), 1.0, contact_radius=EDGE)
    outside = EDGE * (1 + np.geomspace(1e-6, 10, 50))
    root = np.sqrt((outside - EDGE) * (outside + EDGE))
    expected = (2 * EDGE**2 - outside**2) * np.arcsin(EDGE / outside) + EDGE * root
    result = fields.normal_displacement(contact, outside, rtol=1e-6)
    assert result == pytest.approx(expected / np.pi, rel=1e-6, abs=0)


@pytest.mark.parametrize("points", [3, 4, 5, 40])
@pytest.mark.parametrize("tip", [1e-3, -1e-12])
def test_cubic_interpolant_is_that_of_scipy(points: int, tip: float) -> None:
    """Bit-identical, but clamped where the interpolant alone would decrease at the tip."""
    r = END * np.linspace(0, 1, points) ** 1.3
    f = sphere(r)
    f += (tip - CubicSpline(r, f).c[2, 0]) * r
    expected = CubicSpline(r, f).c
    assert expected[2, 0] == pytest.approx(tip, rel=1e-2, abs=0)
    if tip < 0:
        expected = CubicSpline(r, f, bc_type=((1, np.zeros(())), "not-a-knot")).c
        expected[2, 0] = 0.0
    np.testing.assert_array_equal(interpolate(r, f, "cubic")[0], expected[::-1])


@pytest.mark.parametrize(
    ("r", "f", "path", "message"),
    [
        ([0, 1, np.nan, 3], [0, 1, 2, 3], ("r", 2), "finite"),
        ([0, 1, 2, np.inf], [0, 1, 2, 3], ("r", 3), "finite"),
        ([0, 1, 2, 3], [0, 1, np.inf, np.inf], ("f", 2), "finite"),
        ([0, 1, 2, 3], [0, 1, np.nan, 3], ("f", 2), "finite"),
        ([1, 2, 3, 4], [0, 1, 2, 3], ("r", 0), "radius 0"),
        ([0, 1, 2, 3], [1, 1, 2, 3], ("f", 0), "f = 0"),
        ([0, 1, 1, 3], [0, 1, 2, 3], ("r", 2), "increase"),
        ([0, 1, 2, 3], [0, 1, 0.5, 3], ("f", 2), "falls before radius 2"),
        ([0, 1, 2, 3], [0, 0, 0, 0], ("f",), "zero everywhere"),
        ([0, 1, 2], [0, 1, 2, 3], ("f",), "4 values for 3 radii"),
        ([0], [0], ("r",), "two points"),
    ],
)
def test_invalid_point_is_rejected_with_its_index(r: Any, f: Any, path: Any, message: str) -> None:
    with pytest.raises(InputError, match=message) as refused:
        Tabulated(r, f)
    assert refused.value.path == ("profile", *path)


@pytest.mark.parametrize("c", [1e-12, 1e-6, 1e-3, 0.05, 0.3])
def test_traction_on_the_axis_of_a_sticking_tip(c: float) -> None:
    """The stress is finite if slip does not reach a tip: for a cone, (1/2) ln(a/c)."""
    contact = solve(Tabulated([0, 0.5, 1.5], [0, 0.5, 1.5], "linear"), 1.0, contact_radius=1.0)
    tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
    result = fields.shear_stress(tangential_contact, [0.0])
    assert result[0] == pytest.approx(-np.log(c) / 2, rel=INTERPOLANT, abs=0)


@pytest.mark.parametrize("tabulated", [True, False])
@pytest.mark.parametrize("force", [1e-14, 1e-10, 1e-6, 1e-2])
@pytest.mark.parametrize("part", [0.5, 0.999, 0.999999])
def test_stresses_next_to_a_flat(*, force: float, part: float, tabulated: bool) -> None:
    """Truncated paraboloid, R = 1: g' dx = (2s^2 + b^2)/x ds, F/E* = 2s (2s^2 + 3b^2)/3."""
    b, r, radii = 0.25, np.array([0.0, 0.25, 0.5, 0.75, 1.0]), [0.0, 0.1, 0.2, 0.2499]
    table = Tabulated(r, np.maximum(r * r - b * b, 0) / 2, "cubic", (b,))
    body = table if tabulated else TruncatedParaboloid(b, 1.0)
    contact = solve(body, 1.0, normal_force=force)
    partial = tangential.solve(contact, 1.0, 1.0, tangential_force=part * force)
    found = fields.pressure(contact, radii), fields.shear_stress(partial, radii)

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
                assert value == pytest.approx(float(true / mp.pi), rel=1e-11, abs=0)


@pytest.mark.every(10)
@pytest.mark.parametrize("kind", INTERPOLATIONS)
@pytest.mark.parametrize("place", [-1e-3, -1e-13, 0, 1e-13, 1e-6, 1e-3])
def test_stick_edge_next_to_a_node(kind: Any, place: float) -> None:
    """The panel with c is integrated from c on, in powers where these are accurate enough."""
    r = END * np.linspace(0, 1, 14)
    c = r[5] * (1 + place)
    contact = solve(Tabulated(r, sphere(r), kind), 1.0, contact_radius=EDGE, rtol=1e-11)
    tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=float(c))
    radii = [0.3 * c, c * (1 - 1e-2), c * (1 - 1e-6), c * (1 + 1e-6), 0.47]
    result = fields.shear_stress(tangential_contact, radii, rtol=1e-11)
    with mp.workdps(TABLE_DIGITS):
        exact = Table({"r": r.tolist(), "f": sphere(r).tolist(), "interpolation": kind})
        for x, value in zip(map(mpf, radii), result, strict=True):
            true = exact.pressure(x, mpf(EDGE))
            true -= exact.pressure(x, mpf(float(c))) if x < c else 0
            assert abs(mpf(float(value)) / true - 1) <= INTERPOLANT


@pytest.mark.parametrize("flat", [0.0, 0.1])
@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9])
def test_incipient_slip_next_to_a_kink(flat: float, gap: float) -> None:
    """Beyond a kink the slope depends on the root of the distance, which r cannot resolve."""
    r = END * np.linspace(0, 1, 13)
    f = np.maximum(r - flat, 0.0) ** 2
    profile = Tabulated(r, f, "linear")
    node = float(r[8])
    for above, below in ((1.0, 1.0), (1.0, 0.01), (0.01, 1.0), (1.0, -0.3)):
        a, c = node * (1 + above * gap), node * (1 - below * gap)
        contact = solve(profile, 1.0, contact_radius=a)
        tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
        with mp.workdps(TABLE_DIGITS):
            exact = Table({"r": r.tolist(), "f": f.tolist(), "interpolation": "linear"})
            depth = exact.g(mpf(a)) - exact.g(mpf(c))
            force = exact.force(mpf(a)) - exact.force(mpf(c))
        # With a flat the distance from the kink suffers cancellation, and the estimate covers it.
        rel = 1e-11 if flat == 0.0 else tangential_contact.error_estimate
        assert float(tangential_contact.tangential_displacement) == pytest.approx(
            float(depth), rel=rel, abs=0
        )
        assert float(tangential_contact.tangential_force) == pytest.approx(
            float(force), rel=rel, abs=0
        )


@pytest.mark.parametrize("kind", INTERPOLATIONS)
def test_tables_in_other_units_have_the_same_digits(kind: Any) -> None:
    """A slope removed on the axis puts an equation without a length among the spline's."""
    r = np.linspace(0.0, 3.0, 60)
    # Rounded heights, so that the spline has a slope on the axis.
    f = np.round(np.log1p(r * r), 5)
    exact = solve(Tabulated(tuple(r), tuple(f), kind), 1.0, contact_radius=0.2)
    for unit in (2.0**-20, 2.0**10, 2.0**20):
        result = solve(
            Tabulated(tuple(unit * r), tuple(unit * f), kind), 1.0, contact_radius=0.2 * unit
        )
        assert float(result.indentation_depth) == unit * float(exact.indentation_depth)
        assert float(result.normal_force) == unit**2 * float(exact.normal_force)
        assert float(result.maximum_pressure) == float(exact.maximum_pressure)


def test_table_is_defined_up_to_its_last_radius() -> None:
    r, f = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 1.0, 4.0, 9.0])
    body = Tabulated(r, f, "linear")
    assert body.f(np.array([2.5, 3.0])).tolist() == [6.5, 9.0]
    with pytest.raises(InputError, match="ends at radius 3"):
        body.f(np.array([2.5, np.nextafter(3.0, 4.0)]))


@pytest.mark.parametrize("place", [0.0, 3.0, 1.5])
def test_break_that_is_no_inner_radius_is_rejected(place: float) -> None:
    r = np.array([0.0, 1.0, 2.0, 3.0])
    with pytest.raises(InputError, match="inner radius") as raised:
        Tabulated(r, r**2, breaks=(1.0, place))
    assert raised.value.path == ("profile", "breaks", 1)
