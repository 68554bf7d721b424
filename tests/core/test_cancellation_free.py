"""Elementary differences against mpmath."""

import mpmath
import numpy as np
import pytest

from mdr_core.profiles.cancellation_free import atan_gap, tanh_gap

# From underflow of the cube to far beyond the threshold, which is at 0.5.
PLACES = np.concatenate([np.logspace(-50, 2, 105), np.linspace(0.01, 0.6, 119)])


@pytest.mark.parametrize(
    ("difference", "exact"),
    [
        pytest.param(lambda z: atan_gap(z, 1.0), lambda z: z - mpmath.atan(z), id="arctan"),
        pytest.param(tanh_gap, lambda z: z - mpmath.tanh(z), id="tanh"),
    ],
)
def test_differences_lose_no_digits(difference, exact):
    with mpmath.workdps(200):
        expected = [float(exact(mpmath.mpf(float(z)))) for z in PLACES]
    assert difference(PLACES) == pytest.approx(np.array(expected), rel=2e-15, abs=0)
    single = [float(difference(z)) for z in PLACES]
    assert single == difference(PLACES).tolist()
