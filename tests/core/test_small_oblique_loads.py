"""Loads far smaller than friction keep their accuracy beside the normal load."""

from functools import partial

import numpy as np
import pytest

from mdr_core.errors import AccuracyError
from mdr_core.history import cycles, solve
from mdr_core.profiles import Cone, FlatPunch, Paraboloid, Profile, RoundedPunch, Sphere

MU, E_STAR, G_STAR = 0.3, 1.0, 0.8
PROFILES = [Paraboloid(1.7), Cone(0.3), Sphere(2.0), RoundedPunch(0.5, 3.0)]
# Loading, unloading with slip that cuts the first segments, reloading.
NORMAL = np.array([0.5, 1.0, 0.6, 0.9, 0.4, 0.8])
TANGENTIAL = np.array([0.3, -0.2, 0.5, 0.1, -0.4, 0.2])
RESULTS = ("tangential_displacement", "tangential_force", "tangential_energy", "dissipated_energy")


@pytest.mark.parametrize("part", [0.3, 1e-3, 1e-9, 1e-15, 1e-40])
@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.kind)
def test_oblique_loading_sticks(profile: Profile, part: float) -> None:
    """Forces in proportion: u_x = (E*/G*) (F_x/F_N) d, since every spring sticks. Notes, §10."""
    result = solve(
        profile, E_STAR, G_STAR, MU, normal_force=[0.01], tangential_force=[part * MU * 0.01]
    )
    expected = E_STAR / G_STAR * part * MU * result.indentation_depth[0]
    assert result.tangential_displacement[0] == pytest.approx(expected, rel=1e-13, abs=0)
    assert result.dissipated_energy[0] == 0
    assert result.regime[0] == "stick"


@pytest.mark.parametrize("control", ["forces", "displacements"])
@pytest.mark.parametrize("profile", [*PROFILES, FlatPunch(1.0)], ids=lambda profile: profile.kind)
def test_results_have_a_limit_at_small_amplitudes(profile: Profile, control: str) -> None:
    """Loads a thousandth as large have results of the same ratios, up to the size of the larger."""

    def scaled(amplitude: float) -> list[np.ndarray]:
        if control == "forces":
            path = {
                "normal_force": 0.01 * NORMAL,
                "tangential_force": 0.01 * amplitude * TANGENTIAL,
            }
        else:
            path = {
                "indentation_depth": 0.01 * NORMAL,
                "tangential_displacement": 0.01 * amplitude * TANGENTIAL,
            }
        found = solve(profile, E_STAR, G_STAR, MU, **path)
        powers = 1, 1, 2, 2
        return [
            getattr(found, name) / amplitude**n for name, n in zip(RESULTS, powers, strict=True)
        ]

    for small, large in zip(scaled(1e-7), scaled(1e-4), strict=True):
        assert small == pytest.approx(large, rel=1e-3, abs=1e-4 * np.abs(large).max())


def test_cycles_within_rounding_errors_have_no_stiffness() -> None:
    """F_x below the last digit of mu F_N would have the stiffness 0 or infinity, not 2 a G*."""
    for normal, control in ("normal_force", "force"), ("indentation_depth", "displacement"):
        given = partial(cycles, FlatPunch(1.0), 1.0, 1.0, 1.0, **{normal: 1e6})
        for amplitude in (1e-9, 1e-11):
            with pytest.raises(AccuracyError, match="rounding errors"):
                given(**{f"tangential_{control}": amplitude})
        found = given(**{f"tangential_{control}": 1e-6})
        assert found.error_estimate < 0.1
        assert found.secant_stiffness == pytest.approx(2.0, rel=found.error_estimate, abs=0)


@pytest.mark.parametrize("shift", (1e-12 * np.arange(1, 20)).tolist())
def test_error_estimate_of_a_force_before_full_slip_at_a_small_depth(shift: float) -> None:
    """The largest force belongs to the smallest shift. A cone: F_x = 2 U (1 - U/2) F_N(1)."""
    path = {"indentation_depth": [1, 1, 1e-5, 1e-5]}
    found = solve(Cone(1.0), 1, 1, 1, **path, tangential_displacement=[0, shift, shift, 1e-5])
    expected = 2 * shift * (1 - shift / 2) * found.normal_force[1]
    room = found.error_estimate * found.tangential_force.max()
    assert found.tangential_force[1] == pytest.approx(expected, rel=0, abs=room)
    assert room < 1e-3 * expected


@pytest.mark.parametrize("shift", (1e-9 * np.arange(1, 20)).tolist())
def test_error_estimate_of_the_work_of_a_small_shift_as_the_load_is_removed(shift: float) -> None:
    """Each spring slips back: work U^2 (1 - w)^2/2, 2 dx = 4 dw/pi. Later the contact sticks."""
    path = {"indentation_depth": [1, -1, 1], "tangential_displacement": [shift, shift, 0.5]}
    found = solve(Cone(1.0), 1, 1, 1, **path)
    expected = shift**2 * 2 / (3 * np.pi)
    assert found.error_estimate < 1e-5
    assert found.dissipated_energy[-1] == pytest.approx(expected, rel=found.error_estimate, abs=0)
