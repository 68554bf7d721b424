"""The stress integral of a power in its series, against the hypergeometric function."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal
from mdr_core.profiles.moment_series import moment_series
from tests.core.comparison import profile_from
from tests.oracles import reference
from tests.oracles.shapes import shape_of

#: Both halves, where they meet, and next to axis and edge.
PLACES = np.concatenate(
    [np.geomspace(1e-12, 0.1, 12), np.linspace(0.15, 0.999, 40), [0.70710678, 0.7071068, 1 - 1e-12]]
)
POWERS = (-0.97, -0.5, -0.4, 0.3, 0.5, 0.75, 1.5, 1.7, 2.4, 3.0, 3.4, 4.5, 5.0, 5.7)
#: Two parts that may cancel to an eighth, each a sum of twenty terms.
ROUNDING = 2e-14


def exact(m: float, rho: float) -> mpf:
    """u 2F1(1, (1 - m)/2; 3/2; u^2), u^2 = 1 - rho^2. Source: dlmf, Eq. (15.8.1)."""
    with mp.workdps(40):
        u2 = (1 - mpf(rho)) * (1 + mpf(rho))
        return mp.sqrt(u2) * mp.hyp2f1(1, (1 - mpf(m)) / 2, mpf(3) / 2, u2)


def test_the_reference_is_the_integral() -> None:
    with mp.workdps(30):
        rho, m = mpf("0.3"), mpf("0.5")
        whole = mp.quad(lambda y: (rho * mp.cosh(y)) ** m, [0, mp.acosh(1 / rho)])
        assert mp.almosteq(whole, exact(0.5, 0.3), rel_eps=mpf("1e-16"))


@pytest.mark.parametrize("m", POWERS)
def test_the_series_keep_what_is_asked(m: float) -> None:
    truth = [exact(m, rho) for rho in PLACES.tolist()]
    for rtol in (1e-3, 1e-5, 1e-7, 1e-9, 1e-10, 1e-11, 1e-12):
        series = moment_series(m, rtol)
        assert series is not None
        found = series.at(np.full(1, 2.0), 2 * PLACES)
        errors = [abs(mpf(v) / t - 1) for v, t in zip(found.tolist(), truth, strict=True)]
        assert max(errors) <= rtol + ROUNDING, rtol


@pytest.mark.parametrize("m", POWERS)
def test_the_series_hold_on_the_axis(m: float) -> None:
    series = moment_series(m, 1e-12)
    assert series is not None
    (value,) = series.at(np.ones(1), np.zeros(1))
    assert value == (pytest.approx(1 / m, rel=1e-12) if m > 0 else np.inf)


@pytest.mark.parametrize("m", [-0.01, 0.0, 0.01, 2.0, 1.999, 4.0, 30.0])
def test_where_the_parts_cancel_there_is_no_series(m: float) -> None:
    assert moment_series(m, 1e-6) is None


@pytest.mark.parametrize("rtol", [1e-3, 1e-4, 1e-6, 1e-8, 1e-10])
def test_terms_that_cancel_leave_the_sum_its_tolerance(rtol: float) -> None:
    """At the edge the second takes 0.97 of the first away from g'."""
    terms = [{"coefficient": 1.0, "exponent": 2.5}, {"coefficient": -0.6, "exponent": 3.5}]
    given = {"kind": "series", "terms": terms}
    shape, places = shape_of(given), [0.02, 0.4, 0.75, 0.95, 0.999]
    contact = normal.solve(profile_from(given), 1.0, contact_radius=1.0, rtol=rtol)
    found = fields.pressure(contact, places, rtol=rtol).tolist()
    with mp.workdps(40):
        for r, p in zip(places, found, strict=True):
            exact = reference.pressure(shape, mpf(r), mpf(1))
            assert abs(mpf(p) / exact - 1) <= rtol, r
