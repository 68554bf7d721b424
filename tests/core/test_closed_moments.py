"""Moments are accurate beside the equator of a steep tip, and where g stops rising."""

import mpmath
import numpy as np
import pytest

from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.profiles import PowerTerm, Series, SphericalTipCone

BERNSTEIN = (lambda t: (1 - t) ** 2, lambda t: 2 * t * (1 - t), lambda t: t * t)


@pytest.mark.parametrize(
    ("slope", "low", "high"),
    [(10.0, 0.5, 0.999), (10.0, 0.9, 0.95), (1e2, 0.999, 1.0), (1e3, 0.999999, 1.0)],
)
def test_moments_next_to_the_equator_of_a_tip(slope, low, high):
    """int B_k(t) 2 dx over v = artanh x, t from 0 to 1 with g = x artanh x, up to the flank."""
    profile = SphericalTipCone(slope, 1.0)
    ends = np.array([[low], [high]]) * float(profile.flank_start)
    moments = interval_moments(profile, over_forces=False)
    depth = profile.depth(ends)
    found = moments.over(depth[0], depth[1] - depth[0], ends).weights[:, 0]
    # A radius is rounded relative to itself, its distance from the equator relative to less.
    tolerance = 1e-12 + np.finfo(float).eps / float(1 - ends[1, 0])
    with mpmath.workdps(20):
        start, stop = (mpmath.atanh(float(end)) for end in ends[:, 0])
        bottom, top = (v * mpmath.tanh(v) for v in (start, stop))
        for k, value in enumerate(found.tolist()):

            def density(v, k=k):
                t = (v * mpmath.tanh(v) - bottom) / (top - bottom)
                weight = mpmath.binomial(2, k) * t**k * (1 - t) ** (2 - k)
                return 2 * weight * mpmath.sech(v) ** 2

            exact = mpmath.quad(density, mpmath.linspace(start, stop, 5))
            assert abs(value / exact - 1) < tolerance


@pytest.mark.parametrize("slope", [10, 100])
@pytest.mark.parametrize("ratio", [1.001, 1.1, 1.29, 1.5, 2.4])
def test_moments_on_the_flank_of_a_steep_spherical_tip(ratio, slope):
    """int B_k 2 dx from b on, where the sphere continues to s = -h, h = b/slope."""
    profile = SphericalTipCone(float(slope), 1.0)
    ends = np.array([[1.0], [ratio]]) * float(profile.flank_start)
    depth = profile.depth(ends)
    moments = interval_moments(profile, over_forces=False)
    found = moments.over(depth[0], depth[1] - depth[0], ends).weights[:, 0]
    with mpmath.workdps(20):
        h = 1 / mpmath.sqrt(1 + slope**2)
        b = slope * h

        def g(s):
            x = mpmath.hypot(b, s)
            return x * (mpmath.log((1 + x) / (h + s)) + slope * mpmath.atan(s / b))

        end = mpmath.sqrt((mpmath.mpf(float(ends[1, 0])) - b) * (float(ends[1, 0]) + b))
        bottom, top = g(mpmath.mpf(0)), g(end)
        for k, value in enumerate(found.tolist()):

            def density(s, k=k):
                t = (g(s) - bottom) / (top - bottom)
                dx = 2 * s / mpmath.hypot(b, s)
                return dx * mpmath.binomial(2, k) * t**k * (1 - t) ** (2 - k)

            places = [0, *(end / 4**i for i in range(4, -1, -1))]
            assert abs(value / mpmath.quad(density, places) - 1) < 1e-12


def test_moments_of_a_narrow_interval_where_the_slope_falls_to_zero():
    """int B_k(t) 2 dx over 1e-8 of the radius, 1e-7 from the end of a series."""
    profile = Series((PowerTerm(1.0, 2.0), PowerTerm(-0.1, 4.0)))
    high = profile.domain * (1 - 1e-7)
    ends = np.array([[high * (1 - 1e-8)], [high]])
    with mpmath.workdps(40):

        def g(x):
            return 2 * x**2 - mpmath.mpf(8) / 3 * mpmath.mpf(-profile.terms[1].coefficient) * x**4

        start, stop = (mpmath.mpf(float(end)) for end in ends[:, 0])
        span = g(stop) - g(start)
        expected = [
            2 * mpmath.quad(lambda x, b=b: b((g(x) - g(start)) / span), [start, stop])
            for b in BERNSTEIN
        ]
        given = np.array([float(g(start))]), np.array([float(span)]), ends
        found = IntervalMoments(profile, over_forces=False).over(*given)
    assert found.weights[:, 0] == pytest.approx(np.array(expected, dtype=float), rel=1e-6, abs=0)
