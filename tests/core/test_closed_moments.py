"""Closed moments over intervals of depth and of force, against quadrature in mpmath."""

import mpmath
import numpy as np
import pytest

from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.profiles import Cone, Paraboloid, SphericalTipCone

SLOPE, RADIUS = 0.3, 1.7
BERNSTEIN = (lambda t: (1 - t) ** 2, lambda t: 2 * t * (1 - t), lambda t: t * t)
# Depth and reduced force of a contact radius, mdr-5, Eqs. (5.6), (5.7), (5.47), (5.48).
CASES = [
    pytest.param(Cone(SLOPE), False, lambda x: mpmath.pi / 2 * SLOPE * x, id="cone-depths"),
    pytest.param(Cone(SLOPE), True, lambda x: mpmath.pi / 2 * SLOPE * x**2, id="cone-forces"),
    pytest.param(Paraboloid(RADIUS), False, lambda x: x**2 / RADIUS, id="paraboloid-depths"),
    pytest.param(
        Paraboloid(RADIUS),
        True,
        lambda x: 4 * x**3 / (3 * mpmath.mpf(RADIUS)),
        id="paraboloid-forces",
    ),
]
ENDS = [
    (0.0, 1.0),
    (1e-12, 1.0),
    (1e-3, 1.0),
    (0.5, 1.0),
    (1.0, 1.0 + 1e-9),
    (1e-45, 3e-45),
    (1e45, 2e45),
]


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize(("profile", "over_forces", "normal"), CASES)
def test_moments_over_an_interval(profile, over_forces, normal, ends):
    with mpmath.workdps(60):
        low, high = map(mpmath.mpf, ends)
        span = normal(high) - normal(low)

        def moment(bernstein):
            if over_forces and low == 0 and bernstein is BERNSTEIN[0]:
                return mpmath.inf

            def density(x):
                measure = 1 / (2 * x**2) if over_forces else 2
                return bernstein((normal(x) - normal(low)) / span) * measure

            # A piece for each decade, in which a polynomial is accurate.
            inner = [high / 10**k for k in range(14, 0, -1) if high / 10**k > low]
            return mpmath.quad(density, [low, *inner, high])

        expected = [float(moment(bernstein)) for bernstein in BERNSTEIN]
        given = np.array([float(normal(low))]), np.array([float(span)]), np.array(ends)[:, None]
    found = IntervalMoments(profile, over_forces=over_forces).over(*given)
    assert found.weights[:, 0] == pytest.approx(np.array(expected), rel=2e-15, abs=0)


@pytest.mark.parametrize(("low", "high"), [(0.5, 0.999), (0.9, 0.95)])
def test_moments_next_to_the_equator_of_a_tip(low, high):
    """int B_k(t) 2 dx, t from 0 to 1 with g = x artanh x, up to 0.999 of the tangent radius."""
    profile = SphericalTipCone(10.0, 1.0)
    ends = np.array([[low], [high]]) * float(profile.tangent_radius)
    moments = interval_moments(profile, over_forces=False)
    depth = profile.depth(ends)
    found = moments.over(depth[0], depth[1] - depth[0], ends).weights[:, 0]
    with mpmath.workdps(20):
        start, stop = (mpmath.mpf(float(end)) for end in ends[:, 0])
        bottom, top = (x * mpmath.atanh(x) for x in (start, stop))
        for k, value in enumerate(found.tolist()):

            def density(x, k=k):
                t = (x * mpmath.atanh(x) - bottom) / (top - bottom)
                return 2 * mpmath.binomial(2, k) * t**k * (1 - t) ** (2 - k)

            assert abs(value / mpmath.quad(density, mpmath.linspace(start, stop, 5)) - 1) < 1e-12
