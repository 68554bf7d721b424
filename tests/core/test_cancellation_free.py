"""Elementary differences against mpmath."""

import mpmath
import numpy as np
import pytest

from mdr_core.profiles.cancellation_free import atan_gap, tanh_gap

THRESHOLD = 0.4
# From underflow of the cube to far beyond the threshold.
PLACES = np.concatenate([np.logspace(-50, 2, 105), np.linspace(0.01, 0.6, 119)])
# Below the threshold, roundings of the square, the two polynomials, weighted by the shares of their
# terms, the quotient and the two products: 10.4 for arctan, fewer for tanh.
ROUNDINGS = 11
UNIT = 2.0**-53


@pytest.mark.parametrize(
    ("difference", "function", "library"),
    [
        # Units in the last place by which functions may err on any processor: tolerances of NumPy's
        # own tests, umath-validation-set-arctan.csv and -tanh.csv.
        pytest.param(lambda z: atan_gap(z, 1.0), "atan", 1, id="arctan"),
        pytest.param(tanh_gap, "tanh", 2, id="tanh"),
    ],
)
def test_differences_lose_no_digits(difference, function, library):
    with mpmath.workdps(200):
        values = [getattr(mpmath, function)(z) for z in PLACES.tolist()]
        expected = np.array(
            [float(z - value) for z, value in zip(PLACES.tolist(), values, strict=True)]
        )
    subtracted = library * np.spacing(np.array(values, float)) + UNIT * expected
    bound = np.where(PLACES < THRESHOLD, ROUNDINGS * UNIT * expected, subtracted)
    result = difference(PLACES)
    assert np.all(np.abs(result - expected) <= bound)
    single = [float(difference(z)) for z in PLACES]
    assert single == result.tolist()
