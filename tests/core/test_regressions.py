"""Mended defects of the core stay mended."""

from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.special import gamma

from mdr_core import fields, history, normal, profiles, tangential
from mdr_core.errors import InputError
from tests.core.comparison import profile_from
from tests.oracles import reference, slip_reference
from tests.oracles.shapes import shape_of


def test_inverse_near_a_jump() -> None:
    """A cap 1e12 times flatter than its flank: the force nearly jumps at b."""
    profile = profiles.CappedParaboloid(1e-5, 1e8, 1e-5)
    bare = profiles.TruncatedParaboloid(1e-5, 1e-5)
    contact = normal.solve(profile, 1.0, normal_force=0.1)
    expected = normal.solve(bare, 1.0, normal_force=0.1)
    np.testing.assert_allclose(contact.contact_radius, expected.contact_radius, rtol=1e-11)
    np.testing.assert_allclose(contact.indentation_depth, expected.indentation_depth, rtol=1e-11)


@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
def test_inverse_at_the_resolution_of_doubles(control: str) -> None:
    """The contact exceeds the flat by less than the resolution of a double."""
    cone = profiles.TruncatedCone(1.0, 1.0)
    contact = normal.solve(cone, 1.0, **{control: [1e-70, 0.0, 1e-40]})
    np.testing.assert_allclose(contact.contact_radius, 1.0, rtol=1e-15)
    # The flat of a table is flat up to rounding errors of its heights. Three points beyond the
    # edge distinguish a jump of the slope from a jump of the curvature.
    table = profiles.Tabulated(
        [0.0, 0.5, 1.0, 1.5, 2.0, 3.0], [0.0, 0.0, 0.0, 0.5, 1.0, 2.0], (1.0,)
    )
    contact = normal.solve(table, 1.0, **{control: [1e-9, 1e-7]})
    np.testing.assert_allclose(contact.contact_radius, 1.0, rtol=1e-12)


def test_single_load_broadcasts_over_many_cases() -> None:
    radii = np.array([1.0, 2.0, 4.0])
    contact = normal.solve(profiles.Paraboloid(radii), 1.0, contact_radius=0.5)
    np.testing.assert_array_equal(contact.indentation_depth, 0.25 / radii)
    np.testing.assert_array_equal(contact.contact_radius, [0.5, 0.5, 0.5])
    contact = normal.solve(profiles.FlatPunch(2.0), radii, indentation_depth=0.5)
    np.testing.assert_array_equal(contact.indentation_depth, [0.5, 0.5, 0.5])


def test_error_of_a_sweep_names_a_single_radius() -> None:
    spheres = profiles.Sphere(np.array([3.0, 1.0, 2.0]))
    with pytest.raises(InputError, match=r"beyond radius 0\.99999999, ") as refused:
        normal.solve(spheres, 1.0, contact_radius=[0.5, 1.5, 0.5])
    assert refused.value.path == ("load", "contact_radius", 1)


@pytest.mark.parametrize(
    ("profile", "e_star", "load"),
    [
        (profiles.Power(1.0, 0.05), 1.0, {"indentation_depth": 1e-20}),
        (profiles.Power(1.0, 0.05), 1.0, {"indentation_depth": 1e50}),
        (profiles.Power(1.0, 100.0), 1.0, {"contact_radius": 1e-5}),
        (profiles.Power(1.0, 100.0), 1.0, {"contact_radius": 1e5}),
        (profiles.Series((profiles.PowerTerm(1.0, 0.05),)), 1.0, {"indentation_depth": 1e-20}),
        (profiles.Series((profiles.PowerTerm(1.0, 0.05),)), 1.0, {"indentation_depth": 1e50}),
        (profiles.Paraboloid(1e-50), 1e50, {"contact_radius": 1e50}),
        # The distance of the edge from the flat, half of the square of the load, has few digits.
        (profiles.TruncatedParaboloid(1.0, 1.0), 1.0, {"indentation_depth": 1e-160}),
        (profiles.TruncatedParaboloid(1.0, 1.0), 1.0, {"normal_force": 1e-157}),
        (profiles.TruncatedCone(1.0, 1.0), 1.0, {"indentation_depth": 1e-160}),
    ],
)
def test_overflowing_results_are_rejected(
    profile: profiles.Profile, e_star: float, load: dict[str, float]
) -> None:
    ((name, value),) = load.items()
    with pytest.raises(InputError, match="range of double precision") as refused:
        normal.solve(profile, e_star, **{name: [0.0, value]})
    assert refused.value.path == ("load", name, 1)
    with pytest.raises(InputError, match="range of double precision") as refused:
        normal.solve(profile, e_star, **load)
    assert refused.value.path == ("load", name)


def test_vanishing_term_is_infinite_on_the_axis() -> None:
    terms = (25.5, 45.9), (956.4, 45.9), (1e-50, 0.05)
    steep = profiles.Series(tuple(profiles.PowerTerm(*term) for term in terms))
    contact = normal.solve(steep, 1e-30, normal_force=956.38)
    assert np.isposinf(fields.pressure(contact, [0.0]))[0]
    falling = profiles.Series((profiles.PowerTerm(1.0, 0.3), profiles.PowerTerm(-0.1, 0.8)))
    contact = normal.solve(falling, 1.0, contact_radius=1.0)
    assert np.isposinf(fields.pressure(contact, [0.0]))[0]


@pytest.mark.parametrize(
    ("r", "f"),
    [
        (
            [0.0, 4.349008035645129, 12.794348419728783, 21.239688803812435],
            [0.0, 2.898909693608899e23, 2.508941949940395e24, 6.914337350227033e24],
        ),
        (
            [0.0, 619408.8728553505, 6323081.964333784, 6360559.956224398, 12064233.04770283],
            [0.0, 1163.0436519809396, 121198.93225145369, 122639.92387535935, 441205.184147737],
        ),
    ],
)
def test_smooth_tip_of_a_table_has_no_negative_load(r: list[float], f: list[float]) -> None:
    contact = normal.solve(profiles.Tabulated(r, f), 1.0, contact_radius=[1e-50, 1e-40, 1e-20])
    assert np.all(contact.indentation_depth > 0)
    assert np.all(contact.normal_force > 0)


def test_energy_of_a_steep_spherical_tip() -> None:
    """Reference: U = int F dd, evaluated by mpmath with 80 digits."""
    profile = profiles.SphericalTipCone(36.851049199772795, 1.2186817316243246)
    contact = normal.solve(profile, 1.0, contact_radius=1.3934346624194924)
    np.testing.assert_allclose(contact.elastic_energy, 923.66399577036218, rtol=1e-13)


def test_contact_radius_that_rounds_to_the_cap_radius() -> None:
    """The contact radius rounds to the cap radius, the contact coordinate does not."""
    profile = profiles.CappedParaboloid(
        2.1010641645242467e-09, 1.7830536818613786e-06, 3.8937973377132814e-13
    )
    contact = normal.solve(profile, 1.0, indentation_depth=2.475995259375248e-12)
    assert contact.contact_radius == profile.cap_radius
    stick = 2.101064151496657e-09
    tangential_load = tangential.solve(contact, 0.8, 0.3, stick_radius=stick)
    np.testing.assert_allclose(tangential_load.slip_width, profile.cap_radius - stick, rtol=1e-6)


def test_error_estimate_of_a_cancelling_series() -> None:
    """Reference: closed forms with 80 digits. The terms cancel to a thousandth."""
    terms = profiles.PowerTerm(1.0, 2.0), profiles.PowerTerm(-0.999, 2.001)
    contact = normal.solve(profiles.Series(terms), 1.0, contact_radius=0.5)
    miss = abs(contact.indentation_depth / 7.4970565808317638242e-4 - 1)
    assert miss <= contact.error_estimate
    assert contact.error_estimate > 1e-12


@pytest.mark.parametrize("force", [1e-7, 1e-6, 1e-4])
def test_small_loads_on_a_table_with_a_sharp_flat(force: float) -> None:
    r, f = np.array([0.0, 0.5, 0.7, 1.0, 1.4]), np.array([0.0, 0.0, 0.06, 0.15, 0.27])
    table = profiles.Tabulated(r, f, breaks=(0.5,))
    result = normal.solve(table, 1.0, normal_force=force)
    # A truncated cone: g = t x arccos(b/x) and F_N/E* = t (a^2 arccos(b/a) + b s) beyond b.
    exact = normal.solve(profiles.TruncatedCone(0.5, 0.3), 1.0, normal_force=force)
    # The contact radius does not resolve its distance from the flat, of which the estimate warns.
    assert float(result.indentation_depth) == pytest.approx(
        float(exact.indentation_depth), rel=result.error_estimate, abs=0
    )
    assert result.error_estimate < 1e-14 / force**2 + 1e-11


def test_traction_of_a_power_near_the_axis() -> None:
    """Near the axis the kernel becomes constant."""
    contact = normal.solve(profiles.Power(1.0, 1.7), 1.0, contact_radius=1.0)
    tangential_load = tangential.solve(contact, 1.0, 0.3, stick_radius=0.5)
    result = fields.shear_stress(tangential_load, [0.0, 1e-50, 1e-40, 1e-30])
    # Eq. (5.70) at r = 0: (mu E* n kappa C/pi) (1 - c^(n - 1))/(n - 1).
    n, kappa = 1.7, float(np.sqrt(np.pi) * gamma(1.85) / gamma(1.35))
    expected = 0.3 * n * kappa / np.pi * (1 - 0.5 ** (n - 1)) / (n - 1)
    np.testing.assert_allclose(result, expected, rtol=1e-13)


@pytest.mark.parametrize("ratio", [2e8, 1e18])
def test_far_field_is_that_of_a_point_force(ratio: float) -> None:
    """F_N/(pi E* r); the next term is (a/r)^2. Rounding once moved nodes past the equator."""
    contact = normal.solve(profiles.Ellipsoid(1e-10, 2.6), 3.0, indentation_depth=1e-9)
    r = ratio * float(contact.contact_radius)
    result = float(fields.normal_displacement(contact, [r])[0])
    assert result == pytest.approx(
        float(contact.normal_force) / (3.0 * np.pi * r), rel=1e-13, abs=0
    )


def test_dissipated_energy_with_a_steep_flank() -> None:
    """int_c^a (g(a) - g)(g - g(c)) dx of a cap 1e10 times flatter than its flank, by mpmath."""
    b, flat, steep = 0.01, 1e8, 0.01
    contact = normal.solve(profiles.CappedParaboloid(b, flat, steep), 1.0, contact_radius=0.02)
    c = b * (1 - 1e-3)
    dissipated = tangential.solve(contact, 1.0, 0.3, stick_radius=c).dissipated_energy
    with mpmath.workdps(40):
        edge = mpmath.mpf(b)

        def g(x: mpmath.mpf) -> mpmath.mpf:
            beyond = x * mpmath.sqrt(x * x - edge**2) if x > edge else mpmath.mpf(0)
            return x * x / flat + (1 / mpmath.mpf(steep) - 1 / mpmath.mpf(flat)) * beyond

        low, high = mpmath.mpf(c), mpmath.mpf(0.02)
        moment = mpmath.quad(lambda x: (g(high) - g(x)) * (g(x) - g(low)), [low, edge, high])
        expected = float(2 * mpmath.mpf(0.3) ** 2 * moment)
    assert float(dissipated) == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    "profile",
    [
        profiles.RoundedCone(0.8884695252708683, 1.6191688208283352),
        profiles.SphericalTipCone(0.8884695252708683, 1.6191688208283352),
        profiles.CappedParaboloid(0.7, 2.0, 0.3),
    ],
)
def test_incipient_slip_of_a_contact_that_ends_at_a_break(profile: profiles.Profile) -> None:
    """A ring of force F_x at the edge: tau(0) = F_x/(2 pi a^2), and F_x = 2 mu E* a g'(a) width.

    The slip annulus lies below the break, so g'(a) is the slope below it.
    """
    a = float(profile.breaks[0])
    contact = normal.solve(profile, 1.0, contact_radius=a)
    force = 1e-200 * float(contact.normal_force)
    result = tangential.solve(contact, 0.8, 0.5, tangential_force=force)
    slope = float(profile.dg(np.array([a * (1 - 2e-16)]))[0])
    assert float(result.slip_width) == pytest.approx(force / (a * slope), rel=1e-14, abs=0)
    stress = float(fields.shear_stress(result, [0.0])[0])
    assert stress == pytest.approx(force / (2 * np.pi * a * a), rel=1e-10, abs=0)


@pytest.mark.parametrize("shape", [profiles.RoundedCone, profiles.SphericalTipCone])
def test_pressure_on_the_axis_of_a_small_tip(
    shape: type[profiles.RoundedCone | profiles.SphericalTipCone],
) -> None:
    """p(0) = (E*/pi) int_0^a g'(x)/x dx; tips of small slope t are equivalent: b = R t."""
    slope = 1e-15
    contact = normal.solve(shape(slope, 1.0), 1.0, indentation_depth=1e-6)
    with mpmath.workdps(40):
        b, a = mpmath.mpf(slope), mpmath.mpf(float(contact.contact_radius))

        def flank(log_x: mpmath.mpf) -> mpmath.mpf:
            x = mpmath.exp(log_x)
            s = mpmath.sqrt((x - b) * (x + b))
            return b * (mpmath.atan(s / b) + 2 * b / (x + s))

        stretches = [mpmath.log(b) + n for n in range(int(mpmath.log(a / b)) + 1)]
        total = 2 * b + mpmath.quad(flank, [*stretches, mpmath.log(a)])
        expected = float(total / mpmath.pi)
    assert float(fields.pressure(contact, [0.0])[0]) == pytest.approx(expected, rel=1e-9, abs=0)


def test_slip_near_the_axis_in_full_slip() -> None:
    """In full slip everything slips by u_x - mu (E*/G*) d; the pole at R is far away."""
    contact = normal.solve(profiles.SphericalTipCone(1e5, 1e16), 1.0, indentation_depth=1.1)
    result = tangential.solve(contact, 0.8, 0.5, tangential_displacement=3.0)
    lag = 3.0 - 0.5 / 0.8 * 1.1
    assert fields.slip(result, [0.0, 1e-50]) == pytest.approx(-lag, rel=1e-14, abs=0)


@pytest.mark.parametrize(("slope", "part"), [(30.0, 1.5), (1e3, 1 + 1e-9), (1e4, 1e4)])
def test_pressure_of_a_steep_spherical_tip_cone(slope: float, part: float) -> None:
    """The sphere ends next to its equator; the next singularity lies close to the tangent point."""
    given = {"kind": "spherical_tip_cone", "slope": slope, "tip_radius": 1.0}
    profile = profiles.SphericalTipCone(slope, 1.0)
    a = part * float(profile.flank_start)
    contact = normal.solve(profile, 1.0, contact_radius=a)
    radii = [0.0, 0.5 * float(profile.flank_start), 0.9999 * a]
    at = slip_reference.setting(given, "contact_radius", a, slip_reference.Material(1.0, 1.0, 1.0))
    with mpmath.workdps(40):
        exact = [float(slip_reference.traction(at, mpmath.mpf(0), mpmath.mpf(r))) for r in radii]
    # Fewer radii may take fewer nodes.
    for part_of in (slice(3), *(slice(i, i + 1) for i in range(3))):
        result = fields.pressure(contact, radii[part_of])
        assert result == pytest.approx(exact[part_of], rel=1e-11, abs=0)


@pytest.mark.parametrize("slope", [3.0, 30.0, 300.0])
def test_displacement_outside_a_steep_spherical_tip_cone(slope: float) -> None:
    """The sphere ends next to its equator and causes a near singularity beyond the cone's tip."""
    b = 0.3
    given = {"kind": "spherical_tip_cone", "slope": slope, "tip_radius": b * np.hypot(1, 1 / slope)}
    contact = normal.solve(profile_from(given), 1.0, contact_radius=1.0)
    tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=0.05)
    inside, outside = [0.2, 0.301, 0.7, 0.99999], [1 + 1e-9, 1.1, 2.5, 40.0]
    at = slip_reference.setting(
        given, "contact_radius", 1.0, slip_reference.Material(1.0, 1.0, 1.0)
    )
    with mpmath.workdps(40):
        slips = [float(slip_reference.slip(at, mpmath.mpf(0.05), mpmath.mpf(r))) for r in inside]
        beside = [float(slip_reference.displacement(at, mpmath.mpf(r))) for r in outside]
    result = fields.slip(tangential_contact, inside)
    np.testing.assert_allclose(result, slips, rtol=1e-11)
    result = fields.normal_displacement(contact, outside)
    np.testing.assert_allclose(result, beside, rtol=1e-11)


@pytest.mark.parametrize("gap", [1e-2, 3e-4, 1e-6])
def test_shear_stress_of_a_narrow_annulus_is_exact(gap: float) -> None:
    """g' grows linearly in s; next to its double zero, the selected rule was once too coarse."""
    b, c = 1 - gap, 1 - 0.4 * gap
    given = {"kind": "rounded_punch", "flat_radius": b, "rounding_radius": 2.0}
    contact = normal.solve(profile_from(given), 1.0, contact_radius=1.0)
    tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
    places = [0.0, 0.34, 0.9, b - 0.1 * gap, 1 - 0.7 * gap, 1 - 0.2 * gap]
    # One by one, since neighbouring radii would share a rule.
    result = [fields.shear_stress(tangential_contact, [r]).item() for r in places]
    shape, ends = shape_of(given), (mpmath.mpf(1), mpmath.mpf(c))
    with mpmath.workdps(reference.QUAD_DIGITS):
        for r, tau in zip(map(mpmath.mpf, places), result, strict=True):
            parts = [reference.pressure(shape, r, end) for end in ends if r < end]
            exact = parts[0] - sum(parts[1:])
            # The width of the annulus carries its own rounding error.
            assert abs(mpmath.mpf(tau) / exact - 1) <= 1e-12 + 4e-16 / gap, r


@pytest.mark.every(2)
@pytest.mark.parametrize(
    ("given", "b"),
    [
        ({"kind": "rounded_cone", "slope": 0.25, "tip_radius": 1.0}, 0.25),
        ({"kind": "spherical_tip_cone", "slope": 0.75, "tip_radius": 0.5}, 0.3),
        ({"kind": "capped_paraboloid", "cap_radius": 0.3, "tip_radius": 7.0, "radius": 0.4}, 0.3),
        ({"kind": "rounded_punch", "flat_radius": 1e-4, "rounding_radius": 7.0}, 1e-4),
        ({"kind": "truncated_cone", "flat_radius": 1e-4, "slope": 0.1}, 1e-4),
    ],
)
def test_traction_with_stick_edge_next_to_a_break(given: dict[str, Any], b: float) -> None:
    """The distance of the stick edge from the break once suffered cancellation for wide annuli."""
    profile = profile_from(given)
    at = slip_reference.setting(
        given, "contact_radius", 1.0, slip_reference.Material(1.0, 1.0, 1.0)
    )
    for gap in (1e-8, 1e-12):
        c = b * (1 + gap)
        radii = [c * (1 + part * gap) for part in (-3.0, -1.5, -0.3, -0.001, 0.001, 1.0)]
        contact = normal.solve(profile, 1.0, contact_radius=1.0)
        tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
        result = fields.shear_stress(tangential_contact, radii)
        with mpmath.workdps(40):
            exact = [slip_reference.traction(at, mpmath.mpf(c), mpmath.mpf(r)) for r in radii]
        np.testing.assert_allclose(result, [float(tau) for tau in exact], rtol=1e-11)


@pytest.mark.parametrize("part", [0.1, 1.4])
def test_stresses_of_a_contact_edge_next_to_its_tip(part: float) -> None:
    """The end of the tip and the start of the flank once differed in the last digit."""
    given = {"kind": "spherical_tip_cone", "slope": 0.75, "tip_radius": 0.5}
    at = slip_reference.Material(1.0, 1.0, 1.0)
    for gap in (1e-6, 1e-8, 1e-10):
        a = 0.3 * (1 + gap)
        c = a - part * (a - 0.3)
        contact = normal.solve(profile_from(given), 1.0, contact_radius=a)
        tangential_contact = tangential.solve(contact, 1.0, 1.0, stick_radius=c)
        radii = [0.0, 0.1, 0.3 * (1 - 20 * gap), 0.3 * (1 - gap), 0.3 * (1 + gap / 3)]
        setting = slip_reference.setting(given, "contact_radius", a, at)
        for stick, result in (
            (0.0, fields.pressure(contact, radii)),
            (c, fields.shear_stress(tangential_contact, radii)),
        ):
            with mpmath.workdps(40):
                edge = mpmath.mpf(stick)
                exact = [slip_reference.traction(setting, edge, mpmath.mpf(r)) for r in radii]
            # The stress falls with the root of the gap, the rounding error of g' does not.
            rtol = 1e-12 + 2 * np.finfo(float).eps / np.sqrt(gap)
            np.testing.assert_allclose(result, [float(value) for value in exact], rtol=rtol)


def test_polyline_after_arcs_has_no_negative_segment() -> None:
    """The last segment of the polyline once had a negative length, due to its rounded start."""
    way = history.solve(
        profiles.Paraboloid(5e16),
        3e16,
        3e29,
        8e5,
        normal_force=6.5e29,
        tangential_displacement=[-7e-183, -3e16, 2e29, -2e-216, -6e-230],
    )
    state = way.state
    assert state.tangential_displacement == pytest.approx(-6e-230, rel=1e-14, abs=0)
    assert np.all(np.abs(state.slope) <= 1)
    radii = [0.0, 0.5 * state.contact_radius, 0.9 * state.contact_radius]
    # Full slip, backwards at last and far beyond the elastic range: full slip remains.
    traction = fields.shear_stress(state, radii)
    pressed = normal.solve(profiles.Paraboloid(5e16), 3e16, normal_force=6.5e29)
    np.testing.assert_allclose(traction, -8e5 * fields.pressure(pressed, radii), rtol=1e-9)


def test_arc_of_zero_length() -> None:
    """Depths that differ by rounding error once caused zero-length steps and inaccurate corners."""
    material = 1.0, 10.0, 0.5
    depth = 1 + np.array([0.0, 4.0, 0.0, 4.0]) * 2.0**-52
    # The force is far below the friction limit, so slip is negligible.
    push = 1e-8 * np.array([0.0, 1.0, -1.0, 0.5])
    body = profiles.Paraboloid(1.0)
    way = history.solve(body, *material, indentation_depth=depth, tangential_force=push)
    # F_x = 2 G* a u_x.
    np.testing.assert_allclose(way.tangential_displacement, push / 20, rtol=1e-6)
    assert np.all(way.dissipation >= 0)
