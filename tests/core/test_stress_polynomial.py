"""Stresses by a short polynomial, against the reference and where there must be none.

The weight is positive, so that what the polynomial lacks relatively the stress lacks at most.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal, tangential
from mdr_core.abel.polynomial import COARSE, Inner, economised
from tests.core.comparison import profile_from
from tests.core.evaluations import counted
from tests.oracles import reference
from tests.oracles.shapes import shape_of

Profile = dict[str, Any]


def rounded(b: float) -> Profile:
    return {"kind": "rounded_punch", "flat_radius": b, "rounding_radius": 2.0}


def power(n: float) -> Profile:
    return {"kind": "power", "coefficient": 0.3, "exponent": n}


#: Of a contact of radius 1; what is short of 1 is next to where no polynomial serves.
PROFILES: dict[str, Profile] = {
    "rounded 0.33": rounded(0.33),
    "rounded 0.5": rounded(0.5),
    "rounded 0.95": rounded(0.95),
    "rounded 0.99999": rounded(0.99999),
    "truncated cone": {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.3},
    "truncated paraboloid": {"kind": "truncated_paraboloid", "flat_radius": 0.6, "radius": 3.0},
    "sphere 2": {"kind": "sphere", "radius": 2.0},
    "sphere 1.27": {"kind": "sphere", "radius": 1.27},
    "sphere 1e6": {"kind": "sphere", "radius": 1e6},
    "ellipsoid": {"kind": "ellipsoid", "radius": 3.0, "height": 0.7},
    "hyperboloid 4": {"kind": "hyperboloid", "slope": 0.4, "tip_radius": 10.0},
    "hyperboloid 0.6": {"kind": "hyperboloid", "slope": 0.4, "tip_radius": 1.5},
}
#: Over an annulus only: all of it is their own series.
POWERS = {f"power {n}": power(n) for n in (0.4, 1.5, 2.7, 6.0, 9.5)}
SMOOTH = ("sphere", "ellipsoid", "hyperboloid")
TOLERANCES = (1e-3, 1e-5, 1e-6, 1e-7, 1e-8)
TIGHT = (1e-9, 1e-10, 1e-12)
ROUNDING = 2e-14
#: So many radii that a polynomial is worth it behind a flat.
MANY = np.concatenate([(np.arange(200) + 0.5) / 200, 1 - np.geomspace(1e-12, 1e-3, 8)])


def checked(name: str, c: float) -> np.ndarray:
    """Places next to the axis, the break, the stick edge and the edge, and in between."""
    b = (PROFILES | POWERS)[name].get("flat_radius", 0.0)
    near = [x * (1 + side) for x in (b, c) if x for side in (-1e-3, -1e-9, 1e-9, 1e-3)]
    # The reference is a difference, of two that are infinite on the axis of a power.
    axis = [] if name in POWERS else [0.0]
    r = np.array([*axis, 1e-6, 0.2, 0.45, 0.8, 0.97, 1 - 1e-6, 1 - 1e-12, *near])
    return np.unique(r[(r >= 0) & (r < 1)])


@cache
def truth(name: str, stick: float | None) -> tuple[mpf, ...]:
    """(1/pi) int g'/sqrt(x^2 - r^2) dx over max(r, c) < x < 1 at the checked radii."""
    shape, c = shape_of((PROFILES | POWERS)[name]), mpf(stick or 0.0)
    with mp.workdps(reference.QUAD_DIGITS):
        found = []
        for r in checked(name, stick or 0.0).tolist():
            whole = reference.pressure(shape, mpf(r), mpf(1))
            found.append(whole - reference.pressure(shape, mpf(r), c) if r < c else whole)
        return tuple(found)


def worst(name: str, stick: float | None, rtol: float) -> tuple[float, int]:
    """Largest relative error at the checked radii, and the values of an integrand it took."""
    given = (PROFILES | POWERS)[name]
    contact = normal.solve(profile_from(given), 1.0, contact_radius=1.0, rtol=rtol)
    places = checked(name, stick or 0.0)
    r = np.concatenate([places, MANY])
    with counted() as count:
        if stick is None:
            values = fields.pressure(contact, r, rtol=rtol)
        else:
            pushed = tangential.solve(contact, 1.0, 1.0, stick_radius=stick)
            values = fields.shear_stress(pushed, r, rtol=rtol)
    pairs = zip(values[: places.size].tolist(), truth(name, stick), strict=True)
    return max(float(abs(mpf(value) / exact - 1)) for value, exact in pairs), count.integrand


@pytest.mark.parametrize("rtol", TOLERANCES)
@pytest.mark.parametrize("name", PROFILES)
def test_a_coarse_pressure_is_as_good_as_asked(name: str, rtol: float) -> None:
    error, _ = worst(name, None, rtol)
    assert error <= rtol


@pytest.mark.parametrize("part", [0.02, 0.5, 0.999, 1 - 1e-9])
@pytest.mark.parametrize("name", [*PROFILES, *POWERS])
def test_a_coarse_shear_stress_is_as_good_as_asked(name: str, part: float) -> None:
    """Over annuli from wide to so narrow that a difference of pressures has no digits."""
    low = max((PROFILES | POWERS)[name].get("flat_radius", 0.0), 0.19 if name in POWERS else 0.0)
    stick = low + part * (1 - low)
    for rtol in TOLERANCES:
        error, _ = worst(name, stick, rtol)
        assert error <= rtol, rtol


@pytest.mark.parametrize("rtol", TIGHT)
@pytest.mark.parametrize("name", [name for name in PROFILES if name.startswith(SMOOTH)])
def test_of_a_smooth_tip_to_rounding(name: str, rtol: float) -> None:
    """Where a polynomial serves tighter tolerances it is cut off at rounding."""
    for stick in (None, 0.02, 0.7, 1 - 1e-9):
        error, taken = worst(name, stick, rtol)
        assert error <= (rtol if taken else ROUNDING), stick


def test_no_node_is_taken() -> None:
    for name in ("rounded 0.5", "rounded 0.95", "truncated cone", "sphere 2", "hyperboloid 4"):
        for stick in (None, 0.97):
            assert worst(name, stick, 1e-3)[1] == 0, name
    for name in POWERS:
        assert worst(name, 0.7, 1e-3)[1] == 0, name


def test_few_radii_behind_a_flat_take_the_nodes() -> None:
    """They have their nodes in the time in which a polynomial is set up, and agree with it."""
    contact = normal.solve(profile_from(rounded(0.5)), 1.0, contact_radius=1.0, rtol=1e-5)
    with counted() as count:
        few = fields.pressure(contact, MANY[::20], rtol=1e-5)
    assert count.integrand > 0
    assert few == pytest.approx(fields.pressure(contact, MANY, rtol=1e-5)[::20], rel=2e-5)


@pytest.mark.parametrize("odd", [True, False])
@pytest.mark.parametrize("rtol", [1e-3, 1e-5, COARSE, 1e-8])
def test_what_is_left_out_is_less_than_asked(rtol: float, *, odd: bool) -> None:
    """delta = 0 leaves int_c^1 s^(p-1) w(s^2/2) ds, whose parts are elementary; c = 1/2."""
    found = economised(lambda q: 1 / (2 - q), (0.0, 0.5), rtol, odd=odd)
    assert found is not None
    leg = 0.5 if odd else 0.25
    inner = Inner(np.array([leg]), 0.25, 0.75)
    arc = None if odd else np.array([np.log(2)])
    (value,) = found.between(np.zeros(1), np.array([1 - leg]), 1.0, arc, inner)
    with mp.workdps(30):
        exact = mp.quad(lambda s: s ** (0 if odd else -1) / (2 - s * s / 2), [mpf(1) / 2, 1])
        assert abs(mpf(value) / exact - 1) <= rtol


def test_there_is_none_where_it_would_be_long() -> None:
    assert economised(lambda q: 1 / (1 + 1e3 * q), (0.0, 1.0), 1e-3, odd=True) is None
    assert economised(lambda q: 1 / (1 + q), (0.0, 1.0), 1e-13, odd=True) is None


def test_many_contacts_at_once_share_no_polynomial() -> None:
    r = np.linspace(0, 0.9, 200)
    for name, coordinate in (("sphere 2", 0.54), ("rounded 0.5", 0.8)):
        profile = profile_from(PROFILES[name])
        many = profile.pressure_kernel(np.full(r.size, coordinate), r, 1e-13)
        with counted() as count:
            one = profile.pressure_kernel(np.array([coordinate]), r, 1e-3)
        assert count.integrand == 0
        assert one == pytest.approx(many, rel=1e-3)
