"""The more complete models that `verification` solves agree with their own references."""

import numpy as np
import pytest
from verification import compressed_ball, transverse_slip

from tests.oracles import ball_elements


@pytest.mark.parametrize(("nu", "cap"), [(0.0, 0.2), (0.3, 0.1), (0.45, 0.4)])
def test_ball_between_planes_is_that_of_finite_elements(nu: float, cap: float) -> None:
    depth, ratio = compressed_ball.force_ratio(nu, cap)
    hertz = 4 / 3 / (1 - nu**2) * depth**1.5
    found = ball_elements.force(nu, cap, depth)
    assert found == pytest.approx(ratio * hertz, rel=5e-4, abs=0)


def test_small_cap_is_a_half_space() -> None:
    ratios = [compressed_ball.force_ratio(0.45, cap)[1] - 1 for cap in (0.04, 0.02, 0.01)]
    assert ratios == pytest.approx([4 * ratios[2], 2 * ratios[2], ratios[2]], rel=0.02, abs=0)
    assert ratios[2] < 5e-3


@pytest.mark.parametrize("stick", [0.2, 0.5, 0.8])
def test_without_transverse_slip_the_force_is_that_of_cattaneo(stick: float) -> None:
    shift = np.pi / 2 * (1 - stick**2)
    area = (transverse_slip._WIDTH / transverse_slip._COUNT) ** 2
    force = transverse_slip._force(transverse_slip._kernels(0.0), shift) * area
    assert force == pytest.approx(2 * np.pi / 3 * (1 - stick**3), rel=2e-3, abs=0)
    assert transverse_slip.force_ratio(0.0, stick) == 1


@pytest.mark.parametrize("nu", [0.3, 0.5])
@pytest.mark.parametrize("stick", [0.15, 0.2, 0.35, 0.5, 0.8])
def test_displacement_under_a_force_changes_by_less_than_its_estimate(
    nu: float, stick: float
) -> None:
    shift, part = np.pi / 2 * (1 - stick**2), 0.2 * (nu / (4 - 2 * nu)) ** 2
    without = transverse_slip._force(transverse_slip._kernels(0.0), shift)
    kernels = transverse_slip._kernels(nu)
    low, high = (transverse_slip._force(kernels, shift * (1 + sign * part)) for sign in (-1, 1))
    assert low < without < high
