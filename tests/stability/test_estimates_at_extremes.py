"""Error estimates hold for bodies with two very different lengths.

The bodies have very flat caps, tips with steep flanks, or contact edges within a few rounding
errors of a flat. The estimate must cover the rounding error of the loads under any control.
"""

from __future__ import annotations

from math import nextafter
from typing import Any

import pytest
from mpmath import mp, mpf

from mdr_core import normal, tangential
from mdr_core.profiles import CappedParaboloid, Power
from tests.core.comparison import profile_from
from tests.oracles.slip_reference import Material, setting, solve

MU = 0.4
MATERIAL = Material(1.0, 1.0, MU)
#: Fractions of full slip, from incipient slip to the onset of full slip.
FRACTIONS = (1e-12, 0.3, 1 - 1e-4, 1 - 1e-8, 1 - 1e-12)
CAP: dict[str, Any] = {"kind": "capped_paraboloid", "cap_radius": 1.0, "radius": 1.0}
TIP: dict[str, Any] = {
    "kind": "spherical_tip_cone",
    "slope": 30.0,
    "tip_radius": 1.0005554013202422,
}
PUNCH: dict[str, Any] = {"kind": "rounded_punch", "flat_radius": 1.0, "rounding_radius": 2.0}
TRUNCATED: dict[str, Any] = {"kind": "truncated_cone", "flat_radius": 1.0, "slope": 0.3}
#: g' falls to zero.
SERIES: dict[str, Any] = {
    "kind": "series",
    "terms": [{"coefficient": 1.0, "exponent": 2.0}, {"coefficient": -0.25, "exponent": 3.0}],
}
CASES = {
    "cap 1e8, outside": (CAP | {"tip_radius": 1e8}, 1.5),
    "cap 1e8, next to the edge": (CAP | {"tip_radius": 1e8}, 1 + 1e-14),
    "cap 1e12": (CAP | {"tip_radius": 1e12}, 10.0),
    "steep flank": (TIP, 1 + 1e-14),
    "rounded edge": (PUNCH, 1 + 4.5e-16),
    "edge": (PUNCH, 1 + 1e-12),
    "sharp edge": (TRUNCATED, 1 + 1e-14),
}


@pytest.mark.parametrize("control", ["contact_radius", "indentation_depth", "normal_force"])
@pytest.mark.parametrize("name", CASES)
def test_error_within_estimate(name: str, control: str) -> None:
    shape, radius = CASES[name]
    profile = profile_from(shape)
    load = float(getattr(normal.solve(profile, 1.0, contact_radius=radius), control))
    contact = normal.solve(profile, 1.0, **{control: load})
    at = setting(shape, control, load, MATERIAL)
    limits = {
        "tangential_force": MU * float(contact.normal_force),
        "tangential_displacement": MU * float(contact.indentation_depth),
    }
    for push, limit in limits.items():
        for part in FRACTIONS:
            result = tangential.solve(contact, 1.0, MU, **{push: limit * part})
            exact = solve(at, push, limit * part, energy=False).values
            for answer, truth in exact.items():
                error = abs(mpf(float(getattr(result, answer))) / truth - 1)
                assert error <= result.error_estimate, (push, part, answer)


#: Ratio of the radii of a cap, contact radius and stick radius.
CAPS = [(1e5, 1.7, 0.3), (1e9, 1.7, 0.3), (1e9, 1 + 1e-7, 1 - 1e-4)]


@pytest.mark.parametrize("control", ["contact_radius", "indentation_depth", "normal_force"])
@pytest.mark.parametrize(("ratio", "a", "c"), CAPS)
def test_stick_radius_within_a_flat_cap(ratio: float, a: float, c: float, control: str) -> None:
    """The contact coordinate of a is far larger than a itself."""
    shape = CAP | {"tip_radius": ratio}
    load = float(getattr(normal.solve(profile_from(shape), 1.0, contact_radius=a), control))
    contact = normal.solve(profile_from(shape), 1.0, **{control: load})
    result = tangential.solve(contact, 1.0, MU, stick_radius=c)
    exact = solve(setting(shape, control, load, MATERIAL), "stick_radius", c, energy=False).values
    errors = [abs(mpf(float(getattr(result, key))) / truth - 1) for key, truth in exact.items()]
    assert max(errors) <= result.error_estimate <= 1e-11 + 1e-14 * ratio


@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
@pytest.mark.parametrize("part", [0.5, 0.99, 0.998, 1 - 1e-5, 1 - 1e-7])
def test_contact_radius_where_the_slope_of_g_vanishes(part: float, control: str) -> None:
    """Its condition number is inversely proportional to g'."""
    profile = profile_from(SERIES)
    a = part * float(profile.domain)
    load = float(getattr(normal.solve(profile, 1.0, contact_radius=a), control))
    contact = normal.solve(profile, 1.0, **{control: load})
    given = float(contact.contact_radius) * (1 - 2e-5)
    result = tangential.solve(contact, 1.0, MU, stick_radius=given)
    with mp.workdps(40):
        # F_N/E* and d are sums of terms C_n x^(n + 1) and C_n x^n.
        of_force = control == "normal_force"
        kappa = [
            (n, mp.sqrt(mp.pi) * mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2))
            for n in (mpf(2), mpf(3))
        ]
        terms = [
            (n, k * mpf(each["coefficient"]))
            for (n, k), each in zip(kappa, SERIES["terms"], strict=True)
        ]

        def force(x: mpf) -> mpf:
            return mp.fsum(2 * n / (n + 1) * k * x ** (n + 1) for n, k in terms)

        def depth(x: mpf) -> mpf:
            return mp.fsum(k * x**n for n, k in terms)

        end = terms[0][0] * terms[0][1] / (-terms[1][0] * terms[1][1])
        loaded = force if of_force else depth
        exact, high = mpf(a) / 2, end
        while high - exact > 1e-35:
            middle = (exact + high) / 2
            exact, high = (middle, high) if loaded(middle) < load else (exact, middle)
        truths = {
            "slip_width": exact - mpf(given),
            "tangential_force": mpf(MU) * (force(exact) - force(mpf(given))),
        }
        error = abs(mpf(float(contact.contact_radius)) / exact - 1)
        errors = [
            abs(mpf(float(getattr(result, key))) / truth - 1) for key, truth in truths.items()
        ]
        condition = 1 + load / (exact * mp.diff(loaded, exact))
    assert error <= contact.error_estimate <= 1e-12 * condition
    # a/(a - c) = 5e4.
    assert max(errors) <= result.error_estimate <= 1e-5 * condition


@pytest.mark.parametrize("exponent", [2.0, 10.0, 100.0])
def test_stick_radius_one_rounding_before_full_slip(exponent: float) -> None:
    """A force that is mu F_N in double precision is full slip; the next lower one is not."""
    friction, force = 0.4563097552438412, 7.493860291067043
    contact = normal.solve(Power(0.1, exponent), 1.0, normal_force=force)
    full = tangential.solve(contact, 0.9, friction, tangential_force=friction * force)
    assert str(full.regime) == "full_slip"
    push = nextafter(friction * force, 0.0)
    with mp.workdps(40):
        left = 1 - mpf(push) / (mpf(friction) * mpf(force))
        exact = left ** (1 / mpf(exponent + 1))
    result = tangential.solve(contact, 0.9, friction, tangential_force=push)
    error = abs(float(result.stick_radius / contact.contact_radius) / exact - 1)
    assert error <= result.error_estimate <= 2


def test_full_slip_without_rounding_is_exact() -> None:
    for friction, force in ((0.5, 3.0), (0.3, 10.0)):
        # 0.3 x 10 rounds upwards: the force exceeds friction by less than its rounding.
        contact = normal.solve(Power(0.1, 10.0), 1.0, normal_force=force)
        result = tangential.solve(contact, 0.9, friction, tangential_force=friction * force)
        assert str(result.regime) == "full_slip"
        assert result.error_estimate < 1e-11


@pytest.mark.parametrize("gap", [1e-6, 1e-12, 1e-14, 0.0])
def test_contact_within_the_edge_of_a_cap_is_exact(gap: float) -> None:
    """g' jumps at the edge, but a prescribed radius has not reached it."""
    contact = normal.solve(CappedParaboloid(1.0, 1000.0, 10.0), 1.0, contact_radius=1 - gap)
    assert tangential.solve(contact, 0.9, 0.3, stick_radius=0.9).error_estimate < 1e-11
