"""The wear limit has the book's closed forms and is a fixed point."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from numpy.polynomial import Chebyshev

from mdr_core import normal
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Ellipsoid,
    Hyperboloid,
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
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr_core.quadrature import gauss_legendre
from mdr_core.wear import limit

E_STAR, G_STAR, MU = 1.0, 0.8, 0.5
#: Each with contact radius 1 and a worn annulus well inside the profile.
PROFILES: tuple[Profile, ...] = (
    Paraboloid(1.3),
    Cone(0.4),
    Power(0.3, 3.5),
    Series((PowerTerm(0.2, 1.0), PowerTerm(0.3, 3.2))),
    Sphere(2.5),
    Ellipsoid(2.0, 0.4),
    Hyperboloid(0.4, 1.5),
    RoundedPunch(0.5, 1.7),
    TruncatedCone(0.5, 0.35),
    TruncatedParaboloid(0.5, 1.9),
    RoundedCone(0.3, 1.7),
    SphericalTipCone(0.3, 1.7),
    CappedParaboloid(0.6, 3.0, 1.1),
    Tabulated([0.0, 0.5, 0.9, 1.3, 1.9], [0.0, 0.1, 0.35, 0.8, 1.9]),
)
PAIRS = (
    ("indentation_depth", "tangential_displacement"),
    ("normal_force", "tangential_force"),
    ("indentation_depth", "tangential_force"),
    ("normal_force", "tangential_displacement"),
)


def kind_of(profile: Profile) -> str:
    return profile.kind


def constant_depth_limit(profile: Profile, displacement: Any, depth: float | None = None) -> Any:
    """Contact radius 1 unless a depth is given; the amplitude is a fraction of u_max."""
    d = float(profile.g(np.array([1.0]))[0]) if depth is None else depth
    contact = normal.solve(profile, E_STAR, indentation_depth=d)
    amplitude = np.asarray(displacement) * (MU * E_STAR / G_STAR * d)
    return limit.solve(contact, G_STAR, MU, tangential_displacement=amplitude)


def codes(wear: limit.LimitingWear) -> set[str]:
    return {notice.code for notice in wear.warnings}


@pytest.mark.parametrize("part", [0.999, 0.75, 0.3, 0.02])
def test_equations_5_85_to_5_88_paraboloid(part: float) -> None:
    depth, big = 0.3, 1.3
    wear = constant_depth_limit(Paraboloid(big), part, depth)
    with mp.workdps(40):
        d, R = mpf(depth), mpf(big)
        c = mp.sqrt(R * d * (1 - mpf(part)))
        a = mp.sqrt(R * d)

        def shape(r: mpf) -> mpf:
            bracket = (d - r**2 / (2 * R)) * mp.asin(c / r)
            return d - 2 / mp.pi * bracket - c * r / (mp.pi * R) * mp.sqrt(1 - c**2 / r**2)

        outer = mp.findroot(lambda r: shape(r) - r**2 / (2 * R), (a, mp.sqrt(2) * a), "anderson")
        phi, w = mp.acos(c / outer), mp.sqrt(outer**2 - c**2)
        volume = 2 * d * (outer**2 * phi - c * w)
        volume -= (outer**4 * phi + c * (outer**2 - 2 * c**2) * w) / (2 * R)
        # Eq. (5.87) holds in units of a and d.
        scaled = shape(mpf(float(a))) / d
    assert float(wear.stick_radius) == pytest.approx(float(c), rel=1e-13, abs=0)
    assert float(wear.wear_radius) == pytest.approx(float(outer), rel=1e-14, abs=0)
    assert float(wear.worn_volume) == pytest.approx(float(volume), rel=1e-12, abs=0)
    r = [float(c + (outer - c) * q) for q in (0.1, 0.5, 0.9)]
    expected = [float(shape(mpf(x))) for x in r]
    assert wear.limiting_profile(r) == pytest.approx(expected, rel=1e-12, abs=0)
    at = wear.limiting_profile(float(a))[0] / depth
    assert at == pytest.approx(float(scaled), rel=1e-12, abs=0)


def test_equation_5_89_the_wear_radius_without_a_stick_zone() -> None:
    wear = constant_depth_limit(Paraboloid(1.3), [1 - 1e-12, 1.0, 2.0], 0.3)
    ratio = wear.wear_radius / wear.tangential_contact.normal.contact_radius
    assert ratio == pytest.approx([2**0.5] * 3, rel=1e-6, abs=0)
    assert ratio[1:] == pytest.approx([2**0.5] * 2, rel=1e-14, abs=0)


def test_equation_5_90_and_its_warning() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, normal_force=4 / 3)
    wear = limit.solve(contact, 1.0, 1.0, tangential_displacement=0.75)
    d, w = float(wear.indentation_depth), 0.75
    assert 4 / 3 * (d - w) ** 0.5 * (d + w / 2) == pytest.approx(4 / 3, rel=1e-13, abs=0)
    # Values of the closed form; the limit of the load path is a different one.
    assert (round(float(wear.stick_radius), 3), round(d, 3)) == (0.648, 1.169)
    assert "path_dependent" in codes(wear)
    # Without a stick zone Eq. (5.90) is not used.
    sliding = limit.solve(contact, 1.0, 1.0, tangential_displacement=2.0)
    assert "endless_wear" in codes(sliding)
    assert "path_dependent" not in codes(sliding)


@pytest.mark.parametrize("profile", PROFILES, ids=kind_of)
@pytest.mark.parametrize("part", [0.9, 0.3])
def test_the_limit_is_a_fixed_point(profile: Profile, part: float) -> None:
    """Eq. (5.74) of the worn shape is g for x < c and d beyond, so the wear adds d - g to g.

    In s = sqrt(r^2 - c^2) the worn depth is smooth between breaks, and its transform is x int
    (dW/ds)(X sin t) dt, X = sqrt(x^2 - c^2).
    """
    wear = constant_depth_limit(profile, part)
    c, outer, d = (float(v) for v in (wear.stick_radius, wear.wear_radius, wear.indentation_depth))
    breaks = [float(b) for b in (*profile.breaks, *getattr(profile, "r", ()))]
    end = min([b for b in breaks if b > c * (1 + 1e-9)] + [outer])
    # Polynomials in s resolve sqrt(c^2 + s^2) only up to this.
    S = min(((end - c) * (end + c)) ** 0.5, 3 * c)

    def worn(s: Any) -> Any:
        return wear.worn_depth(np.hypot(c, s))

    worn_slope = Chebyshev.interpolate(worn, 40, domain=[0, S]).deriv()
    nodes, weights = gauss_legendre(60)
    turn = (1 + nodes) * np.pi / 4
    for X in S * np.array([0.2, 0.6, 0.95]):
        x = np.hypot(c, X)
        added = x * np.pi / 4 * (weights @ worn_slope(X * np.sin(turn)))
        assert added == pytest.approx(d - float(profile.g(np.array([x]))[0]), rel=1e-8, abs=0)


@pytest.mark.parametrize("profile", PROFILES, ids=kind_of)
def test_the_volume_is_the_integral_of_the_worn_depth(profile: Profile) -> None:
    wear = constant_depth_limit(profile, [0.97, 0.5, 1e-2, 1e-4])
    breaks = [float(b) for b in (*profile.breaks, *getattr(profile, "r", ()))]
    nodes, weights = gauss_legendre(80)
    for index, volume in enumerate(wear.worn_volume):
        c, outer = float(wear.stick_radius[index]), float(wear.wear_radius[index])
        stops = [c, *sorted(b for b in breaks if c < b < outer), outer]
        total = 0.0
        for low, high in pairwise(stops):
            # The substitution r^2 = low^2 + v^2 removes the root at c and at each break.
            top = ((high - low) * (high + low)) ** 0.5
            v = top * (1 + nodes) / 2
            depth = wear.worn_depth(np.hypot(low, v))[index]
            total += float(np.pi * top * (weights @ (depth * v)))
        # The rounding error of r affects the width r - c of a narrow annulus.
        lost = 1e-15 * c / (outer - c)
        assert total == pytest.approx(float(volume), rel=1e-8 + 10 * lost, abs=0)


@pytest.mark.parametrize("profile", PROFILES, ids=kind_of)
def test_narrow_worn_annulus_is_half_wider_than_the_slip_annulus(profile: Profile) -> None:
    """For linear g: w = (3/2)(d - g(c))/g'(c), V = (16/15) sqrt(2c) w^(3/2) (d - g)."""
    wear = constant_depth_limit(profile, [1e-6, 1e-12, 1e-100])
    w, c, step = wear.wear_width, wear.stick_radius, wear.stick_zone.step
    assert w / wear.tangential_contact.slip_width == pytest.approx(1.5, rel=1e-4, abs=0)
    volume = 16 / 15 * np.sqrt(2 * c) * w**1.5 * step
    assert wear.worn_volume == pytest.approx(volume, rel=1e-4, abs=0)
    assert (wear.worn_volume / volume)[1:] == pytest.approx(1.0, rel=1e-10, abs=0)


@settings(max_examples=150, deadline=None)
@given(
    profile=st.sampled_from(PROFILES),
    part=st.floats(1e-9, 1.0),
    places=st.lists(st.just(0.0) | st.floats(1e-100, 1.7), min_size=1, max_size=20),
)
def test_wear_never_adds_material(profile: Profile, part: float, places: list[float]) -> None:
    wear = constant_depth_limit(profile, part)
    edge, outer = float(wear.stick_radius), float(wear.wear_radius)
    r = np.array([*places, edge, outer, *(edge + (outer - edge) * np.linspace(0, 1, 9))])
    worn = wear.worn_depth(r)
    outside = ((r <= edge) & (edge > 0)) | (r >= outer)
    assert (worn >= 0).all()
    assert (worn[outside] == 0).all()
    assert (worn[~outside] <= float(wear.indentation_depth)).all()
    assert (wear.pressure(r)[r > edge] == 0).all()
    assert (wear.pressure(r)[r < edge] > 0).all()
    assert edge <= float(wear.tangential_contact.normal.contact_radius) <= outer * (1 + 1e-15)


@pytest.mark.parametrize(("control", "amplitude"), PAIRS)
@pytest.mark.parametrize("length", [2.0**-30, 2.0**10])
def test_results_scale_with_units(control: str, amplitude: str, length: float) -> None:
    pressure = 2.0**20

    def limit_in(unit: float, modulus: float) -> limit.LimitingWear:
        units = {
            "indentation_depth": unit,
            "tangential_displacement": unit,
            "normal_force": modulus * unit**2,
            "tangential_force": modulus * unit**2,
        }
        load = {"indentation_depth": 0.2, "normal_force": 0.3}[control] * units[control]
        size = {"tangential_displacement": 0.03, "tangential_force": 0.04}[amplitude]
        contact = normal.solve(RoundedPunch(0.5 * unit, 1.7 * unit), modulus, **{control: load})
        return limit.solve(contact, 0.8 * modulus, MU, **{amplitude: size * units[amplitude]})

    one, other = limit_in(1.0, 1.0), limit_in(length, pressure)
    factors = {"wear_radius": length, "wear_width": length, "worn_volume": length**3}
    factors |= {"normal_force": pressure * length**2, "indentation_depth": length}
    for name, factor in factors.items():
        expected = pytest.approx(float(getattr(one, name)) * factor, rel=1e-13, abs=0)
        assert float(getattr(other, name)) == expected, name
    r = np.array([0.3, 0.7, 0.95])
    assert other.worn_depth(length * r) == pytest.approx(
        length * one.worn_depth(r), rel=1e-12, abs=0
    )


@pytest.mark.parametrize(("control", "amplitude"), PAIRS)
def test_forces_are_those_of_the_stick_zone(control: str, amplitude: str) -> None:
    """The limiting pressure integrates to F_N, and the stick zone carries F_x = 2 G* c u_x."""
    load = {"indentation_depth": 0.2, "normal_force": 0.3}[control]
    size = {"tangential_displacement": 0.03, "tangential_force": 0.03}[amplitude]
    contact = normal.solve(Paraboloid(1.3), E_STAR, **{control: load})
    wear = limit.solve(contact, G_STAR, MU, **{amplitude: size})
    c = float(wear.stick_radius)
    nodes, weights = gauss_legendre(60)
    turn = (1 + nodes) * np.pi / 4
    p = wear.pressure(c * np.sin(turn))
    total = np.pi / 4 * 2 * np.pi * c * c * (weights @ (p * np.sin(turn) * np.cos(turn)))
    assert total == pytest.approx(float(wear.normal_force), rel=1e-12, abs=0)
    carried = 2 * G_STAR * c * float(wear.tangential_displacement)
    assert carried == pytest.approx(float(wear.tangential_force), rel=1e-14, abs=0)
    assert float(getattr(wear, control)) == load
    assert float(getattr(wear, amplitude)) == size
    # No point of the stick zone exceeds the friction limit: mu p >= tau = F_x/(2 pi c s).
    tau = float(wear.tangential_force) / (2 * np.pi * c * c * np.cos(turn))
    assert (MU * p >= tau * (1 - 1e-12)).all()


def test_zero_load_among_others_on_a_table_wears_nothing() -> None:
    table = Tabulated((0.0, 1.0, 2.0), (0.0, 0.3, 0.8))
    contact = normal.solve(table, E_STAR, normal_force=[0.1, 0.0])
    worn = limit.solve(contact, G_STAR, MU, tangential_force=[0.01, 0.0])
    assert worn.worn_volume[0] > 0
    assert worn.worn_volume[1] == 0
