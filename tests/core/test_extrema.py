"""The maximum of a field is not below any of its values, and equals the value at its place."""

from math import acosh, cosh, gamma, hypot, inf, pi, sqrt
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from mdr_core import adhesion, fields, normal, tangential
from mdr_core.extrema import largest_stress
from mdr_core.profiles import (
    Cone,
    FlatPunch,
    Paraboloid,
    Power,
    PowerTerm,
    Profile,
    RoundedCone,
    RoundedPunch,
    Series,
    Sphere,
    SphericalTipCone,
    Tabulated,
    TruncatedParaboloid,
)
from tests.core.comparison import profile_from
from tests.oracles import reference
from tests.oracles.shapes import Shape, shape_of

E_STAR, G_STAR, MU = 2.0, 1.7, 0.4


def test_maximum_pressure_of_hertz() -> None:
    R, force = 3.0, np.array([1e-6, 1e-3, 1.0])
    contact = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    # [johnson] Eq. (4.24).
    expected = (6 * force * E_STAR**2 / (pi**3 * R**2)) ** (1 / 3)
    assert contact.maximum_pressure == pytest.approx(expected, rel=1e-14, abs=0)


@pytest.mark.parametrize("exponent", [1.7, 2.001, 3.3, 60.0])
def test_maximum_pressure_of_powers(exponent: float) -> None:
    """(n kappa C/pi) int_t^1 x^(n-1)/sqrt(x^2 - t^2) dx at its largest, a^(n-1) times."""

    def negative(t: float) -> float:
        part = quad(lambda s: hypot(s, t) ** (exponent - 2), 0.0, sqrt(1 - t * t), epsabs=0.0)
        return -part[0] / pi

    places = np.linspace(0.0, 0.999, 200)
    near = places[np.argmin([negative(t) for t in places])]
    bounds = max(near - 0.01, 0.0), min(near + 0.01, 1.0)
    found = minimize_scalar(negative, bounds=bounds, method="bounded", options={"xatol": 1e-9})
    height = -min(found.fun, negative(0.0))
    profile, a = Power(3.0, exponent), np.array([0.2, 0.7])
    contact = normal.solve(profile, E_STAR, contact_radius=a)
    expected = E_STAR * profile.dg(a) * height
    assert contact.maximum_pressure == pytest.approx(expected, rel=1e-9, abs=0)
    swept = Power(3.0, np.array([exponent, exponent]))
    many = normal.solve(swept, E_STAR, contact_radius=a)
    assert many.maximum_pressure == pytest.approx(expected, rel=1e-9, abs=0)


@pytest.mark.parametrize("part", [0.0, 1e-9, 0.5, 0.999, 1.0])
def test_maximum_shear_stress_of_hertz_at_the_stick_edge(part: float) -> None:
    contact = normal.solve(Paraboloid(3.0), E_STAR, normal_force=1.0)
    tangential_contact = tangential.solve(contact, G_STAR, MU, tangential_force=-part * MU * 1.0)
    # Eq. (5.16) in Eq. (5.38): 1 - (c/a)^2 without cancellation.
    with mp.workdps(40):
        root = mp.sqrt(1 - (1 - mpf(part)) ** (mpf(2) / 3))
    expected = MU * float(contact.maximum_pressure) * float(root)
    assert float(tangential_contact.maximum_shear_stress) == pytest.approx(
        expected, rel=1e-12, abs=0
    )


@pytest.mark.parametrize("part", [1e-30, 1e-3, 0.05, 0.0501, "root", "golden", 0.63])
def test_maximum_pressure_of_a_sphere(part: float | str) -> None:
    # p(0) = (E*/pi) [artanh z + chi_2(z)] at z = a/R.
    with mp.workdps(40):
        golden = mp.log((1 + mp.sqrt(5)) / 2)
        # Lewin, Polylogarithms and Associated Functions, 1981, section 1.8.
        known = {
            "root": (mp.sqrt(2) - 1, mp.pi**2 / 16 - mp.log(1 + mp.sqrt(2)) ** 2 / 4),
            "golden": ((mp.sqrt(5) - 1) / 2, mp.pi**2 / 12 - 3 * golden**2 / 4),
        }
        z = known[part][0] if isinstance(part, str) else mpf(part)
        series = mp.nsum(lambda k: z ** (2 * k + 1) / (2 * k + 1) ** 2, [0, mp.inf])
        chi = known[part][1] if isinstance(part, str) else series
        expected = E_STAR * float((mp.atanh(z) + chi) / mp.pi)
    contact = normal.solve(Sphere(3.0), E_STAR, contact_radius=3 * float(z))
    assert float(contact.maximum_pressure) == pytest.approx(expected, rel=4e-15, abs=0)


@pytest.mark.parametrize(
    "profile",
    [Sphere(1.0), Power(0.3, 6.0), RoundedPunch(0.3, 1.0), RoundedPunch(0.499, 10.0)],
    ids=lambda profile: profile.kind,
)
def test_maximum_is_not_exceeded_on_a_dense_grid(profile: Profile) -> None:
    contact = normal.solve(profile, E_STAR, contact_radius=0.5)
    tangential_contact = tangential.solve(contact, G_STAR, MU, stick_radius=0.4995)
    edge = 0.5 * (1 - np.geomspace(1e-9, 1.0, 20_001))
    radii = np.concatenate([edge, 0.499 + 0.001 * np.linspace(0, 1, 20_001), [0.4995]])
    for largest, field in (
        (contact.maximum_pressure, fields.pressure(contact, radii)),
        (tangential_contact.maximum_shear_stress, fields.shear_stress(tangential_contact, radii)),
    ):
        assert float(largest) >= field.max() * (1 - 1e-12)
        # A grid this dense comes close to any smooth maximum.
        assert float(largest) == pytest.approx(field.max(), rel=1e-6, abs=0)


STEEP = [{"coefficient": 1.0, "exponent": 100.0}, {"coefficient": 0.3, "exponent": 170.0}]
#: Maxima on the axis, at the contact edge, beyond a flat and next to a tangent point.
PEAKS = [
    ({"kind": "sphere", "radius": 1.0}, 0.3),
    ({"kind": "sphere", "radius": 1.0}, 0.95),
    ({"kind": "sphere", "radius": 1.0}, 1 - 2.0**-20),
    ({"kind": "two_spheres", "radii": [1.0, 3.0]}, 0.95),
    ({"kind": "two_spheres", "radii": [1.0, -1.001]}, 0.44),
    ({"kind": "two_spheres", "radii": [1.0, -1.001]}, 0.8),
    ({"kind": "ellipsoid", "radius": 1.0, "height": 3.0}, 0.999),
    ({"kind": "power", "coefficient": 1.0, "exponent": 1.3}, 0.5),
    ({"kind": "power", "coefficient": 1.0, "exponent": 2.01}, 0.5),
    ({"kind": "power", "coefficient": 1.0, "exponent": 100.0}, 0.5),
    ({"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 1.0}, 0.5001),
    ({"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 1.0}, 50.0),
    # Hardly more than the pressure in the middle, next to a logarithm.
    ({"kind": "rounded_punch", "flat_radius": 1.2e-6, "rounding_radius": 1.0}, 1.0),
    ({"kind": "rounded_punch", "flat_radius": 1.3e-6, "rounding_radius": 1.0}, 1.0),
    # Two hundredths of the contact radius from the edge.
    ({"kind": "series", "terms": STEEP}, 2.0),
    ({"kind": "rounded_cone", "slope": 0.2, "tip_radius": 1.0}, 0.7),
    ({"kind": "spherical_tip_cone", "slope": 3.0, "tip_radius": 1.0}, 1.7),
    ({"kind": "hyperboloid", "slope": 0.2, "tip_radius": 1.0}, 0.7),
]


def reference_maximum(shape: Shape, a: float, near: float, spacing: float) -> mpf:
    """Local maximum of the reference pressure over E*, by successive parabolic interpolation."""

    def pressure(r: mpf) -> mpf:
        return reference.pressure(shape, r, mpf(a))

    with mp.workdps(40):
        r, step = mpf(near), mpf(spacing) / 8
        if near == 0:
            return pressure(r)
        for _ in range(4):
            low, mid, high = pressure(r - step), pressure(r), pressure(r + step)
            r += step * (high - low) / (2 * (2 * mid - low - high))
            step /= 16
        return pressure(r)


@pytest.mark.parametrize(("fields_of", "a"), PEAKS)
def test_maximum_pressure_against_mpmath(fields_of: dict[str, Any], a: float) -> None:
    contact = normal.solve(profile_from(fields_of), E_STAR, contact_radius=a)
    radii = np.sort(
        np.append(np.linspace(0, a, 1001)[:-1], a * (1 - np.geomspace(1e-9, 0.1, 1000)))
    )
    place = int(np.argmax(fields.pressure(contact, radii)))
    spacing = float(radii[place] - radii[place - 1])
    expected = E_STAR * reference_maximum(shape_of(fields_of), a, float(radii[place]), spacing)
    error = abs(mpf(float(contact.maximum_pressure)) / expected - 1)
    assert error <= contact.error_estimate


def test_cusp_on_the_axis_takes_few_evaluations(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pressure falls from p(0) = (1/pi) sum kappa C n/(n - 1) a^(n-1) like r^0.03."""
    calls: list[None] = []

    def counted(*given: Any) -> Any:
        calls.append(None)
        return kernel(*given)

    kernel, terms = Series.pressure_kernel_at, {1.03: 0.3, 3.0: 1.0}
    monkeypatch.setattr(Series, "pressure_kernel_at", counted)
    a, expected = np.array([1e-3, 1.0]), np.zeros(2)
    for n, coefficient in terms.items():
        kappa = sqrt(pi) * gamma(n / 2 + 1) / gamma((n + 1) / 2)
        expected += kappa * coefficient * n / (n - 1) * a ** (n - 1) / pi
    profile = Series(tuple(PowerTerm(c, n) for n, c in terms.items()))
    contact = normal.solve(profile, 1.0, contact_radius=a)
    assert contact.maximum_pressure == pytest.approx(expected, rel=1e-12, abs=0)
    assert len(calls) < 30


@pytest.mark.parametrize("seed", range(6))
def test_maximum_of_a_noisy_table(seed: int) -> None:
    rng = np.random.default_rng(seed)
    r = np.linspace(0, 1, 40)
    height = (np.sqrt(1 + r * r) - 1) * (1 + 1e-4 * rng.standard_normal(40))
    contact = normal.solve(Tabulated(r, height), E_STAR, contact_radius=0.8)
    steps = np.outer([-1, 1], np.geomspace(1e-9, 1e-2, 12)).ravel()
    near = np.add.outer(r[r < 0.8], steps).ravel()
    radii = np.append(near[(near >= 0) & (near < 0.8)], np.linspace(0, 0.8, 5001)[:-1])
    assert float(contact.maximum_pressure) >= fields.pressure(contact, radii).max() * (1 - 1e-10)


@pytest.mark.parametrize("profile", [Sphere(1.0), SphericalTipCone(1.0, 0.5)])
def test_no_load_has_no_pressure_beside_others(profile: Profile) -> None:
    assert normal.solve(profile, E_STAR, contact_radius=[0.0, 0.1]).maximum_pressure[0] == 0.0


@pytest.mark.parametrize("profile", [Sphere(1.0), RoundedPunch(0.3, 1.0)], ids=lambda p: p.kind)
def test_maxima_of_many_loads_match_single_loads(profile: Profile) -> None:
    radii = np.linspace(0.31, 0.99, 30)
    together = normal.solve(profile, E_STAR, contact_radius=radii).maximum_pressure
    alone = [float(normal.solve(profile, E_STAR, contact_radius=a).maximum_pressure) for a in radii]
    # Many loads are summed in a different order.
    assert together.tolist() == pytest.approx(alone, rel=2e-15, abs=0)


B, R = 0.5, 4.0
# Root of y tanh(y) = 1.
LAPLACE = 1.1996786402577339


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("s", [1e-7, 1e-10, 1e-15, 1e-40])
def test_largest_stress_just_beyond_a_flat(s: float, share: float) -> None:
    """Where s << b, dg/ds = s^2 f''/b, so that the stress is that of a plane punch with a round
    edge, (f''/(pi b)) int_max(t, c)^s u^2/sqrt(u^2 - t^2) du in the coordinate t of the radius.

    It is largest at t = max(c, s/cosh(y)), y tanh(y) = 1, for c = 0 with the value
    f'' s^2 y/(2 pi b). From s = 1e-8 b on no radius in double precision lies beyond the flat.
    """
    profile, bend = RoundedPunch(B, R), 1 / R
    edge, stick = (np.array([t * t / (B + hypot(B, t))]) for t in (s, share * s))
    contact = normal.solve(profile, E_STAR, indentation_depth=profile.depth(edge))
    pressure = E_STAR * bend / B * s * s * LAPLACE / (2 * pi)
    assert contact.maximum_pressure == pytest.approx(pressure, rel=1e-12, abs=0)
    found = largest_stress(profile, edge, np.array([True]), (edge - stick, stick))
    t = max(share, 1 / cosh(LAPLACE))
    shear = bend / B * s * s * (sqrt(1 - t * t) + t * t * acosh(1 / t)) / (2 * pi)
    assert found == pytest.approx(shear, rel=1e-12, abs=0)


@pytest.mark.parametrize("part", [0.01, 0.5, 0.9999, 0.99999])
@pytest.mark.parametrize("beyond", [1e-9, 1e-3, 0.5])
def test_maximum_shear_stress_of_a_truncated_paraboloid(beyond: float, part: float) -> None:
    """At the stick edge, (mu E*/(pi R)) int_c^a (x^2 + s^2)/sqrt(x^2 - c^2) dx/s, with the root
    s = sqrt(x^2 - b^2) in place of the radius, which near full slip resolves c - b no more."""
    profile = TruncatedParaboloid(B, R)
    contact = normal.solve(profile, E_STAR, contact_radius=B * (1 + beyond))
    limit = MU * E_STAR / G_STAR * contact.indentation_depth
    pushed = tangential.solve(contact, G_STAR, MU, tangential_displacement=part * limit)
    with mp.workdps(30):
        b, outer = mpf(B), mpf(float(contact.coordinate))
        width = mpf(float(pushed.width))
        inner = outer - width if width < outer / 2 else mpf(float(pushed.stick_coordinate))
        a, c = (mp.sqrt(x * (2 * b + x)) for x in (outer, inner))
        top = mp.acosh(a / c)

        def density(y: mpf) -> mpf:
            s2 = (c * mp.cosh(y)) ** 2
            return (b * b + 2 * s2) / mp.sqrt(b * b + s2)

        integral = mp.quad(density, [top * k / 8 for k in range(9)])
        expected = float(integral * MU * E_STAR / (mp.pi * R))
    assert float(pushed.maximum_shear_stress) == pytest.approx(expected, rel=1e-13, abs=0)


def test_pressure_is_unbounded_at_tips_and_edges() -> None:
    for profile in (Cone(0.1), FlatPunch(1.0)):
        contact = normal.solve(profile, E_STAR, indentation_depth=[0.0, 0.1])
        assert contact.maximum_pressure.tolist() == [0.0, inf]


def test_shear_stress_is_unbounded_where_slip_reaches_a_sharp_edge() -> None:
    contact = normal.solve(Cone(0.1), E_STAR, contact_radius=1.0)
    tangential_contact = tangential.solve(contact, G_STAR, MU, stick_radius=[0.5, 0.0])
    stress = tangential_contact.maximum_shear_stress
    # Eq. (5.53) at the stick edge: (mu E* t/2) arccosh(a/c).
    assert stress[0] == pytest.approx(MU * E_STAR * 0.05 * np.arccosh(2.0), rel=1e-12, abs=0)
    assert stress[1] == inf
    flat = normal.solve(FlatPunch(1.0), E_STAR, normal_force=1.0)
    for force, expected in ((0.0, 0.0), (0.1, inf)):
        tangential_contact = tangential.solve(flat, G_STAR, MU, tangential_force=force)
        assert float(tangential_contact.maximum_shear_stress) == expected


def _punch_pressure(r: mpf, edge: mpf) -> mpf:
    """p(r) pi R/(E* b) under a rounded punch with b = 1, by mdr-5, Eq. (5.70)."""

    def weight(s: mpf) -> mpf:
        return (2 * s - mp.atan(s)) * s / mp.hypot(s, 1)

    if r < 1:
        return mp.quad(lambda s: weight(s) / mp.sqrt(s * s + 1 - r * r), [0, edge])
    start = mp.sqrt(r * r - 1)

    def beyond(v: mpf) -> mpf:
        s = mp.hypot(v, start)
        return weight(s) / s

    return mp.quad(beyond, [0, mp.sqrt(edge * edge - start * start)])


@pytest.mark.parametrize("edge", [3e-5, 0.02, 0.3, 0.7, 1.0, 1.9, 6.0, 40.0, 3e4, 2e6])
def test_maximum_pressure_of_rounded_punches(edge: float) -> None:
    """Against a search in mpmath: at the peak the error of the radius has no effect."""

    def height(share: float) -> float:
        # Up to 1 a part of the flat, beyond it a part of the edge's coordinate.
        r = mpf(share) if share < 1 else mp.hypot(1, (share - 1) * edge)
        return -float(_punch_pressure(r, mpf(edge)))

    with mp.workdps(20):
        shares = np.linspace(0.0, 1.95, 40)
        at = int(np.clip(np.argmin([height(share) for share in shares]), 1, 38))
        around = shares[at - 1], shares[at + 1]
        found = minimize_scalar(height, bounds=around, method="bounded", options={"xatol": 1e-9})
    edge_of_profile = np.float64(0.7 * edge * edge / (1 + hypot(1, edge)))
    profile = RoundedPunch(0.7, 5.0)
    result = largest_stress(profile, edge_of_profile, edge_of_profile > 0)
    assert result == pytest.approx(-found.fun / pi * 0.7 / 5.0, rel=1e-13, abs=0)


@pytest.mark.parametrize("ratio", [1 + 1e-12, 1.1, 3.0, 1e3, 1e9, 1e20, 1e45])
@pytest.mark.parametrize("kind", [RoundedCone, SphericalTipCone])
def test_maximum_pressure_of_rounded_cones(
    kind: type[RoundedCone | SphericalTipCone], ratio: float
) -> None:
    # Under a shallow slope both tips are paraboloids.
    slope, tip_radius = 1e-9, 3e-2
    a = ratio * slope * tip_radius
    contact = normal.solve(kind(slope, tip_radius), E_STAR, contact_radius=a)
    # With x = b cosh(y), the stress of mdr-5, Eq. (5.68), at r = 0.
    with mp.workdps(30):
        end = mp.acosh(mpf(a) / (mpf(slope) * mpf(tip_radius)))
        flank = mp.quad(
            lambda y: mp.tanh(y) * (mp.atan(mp.sinh(y)) + 2 * mp.exp(-y)),
            [0, *(stop for stop in (2, 10, 40) if stop < end), end],
        )
        expected = float(E_STAR * mpf(slope) * (2 + flank) / mp.pi)
    assert float(contact.maximum_pressure) == pytest.approx(expected, rel=1e-13, abs=0)


@pytest.mark.parametrize("beyond", [1e-5, 1e-3, 0.2])
def test_largest_pressure_of_an_adhesive_contact_just_beyond_a_flat(beyond: float) -> None:
    """The tension at the edge outweighs the peak of the pressure, and the axis bears the most."""
    a = B * (1 + beyond)
    contact = adhesion.solve(RoundedPunch(B, 2.0), 1.0, 1e-8, contact_radius=a)
    radii = np.append(np.linspace(0, B, 2001), B + (a - B) * np.linspace(0, 1, 2001)[:-1])
    sampled = fields.pressure(contact, radii).max()
    assert float(contact.maximum_pressure) == pytest.approx(sampled, rel=1e-5, abs=0)
    assert float(contact.maximum_pressure) >= sampled - 1e-12 * abs(sampled)
