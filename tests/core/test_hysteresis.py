"""G*, mu and their intervals are found from a measured hysteresis loop."""

from __future__ import annotations

import numpy as np
import pytest

from mdr_core import history, hysteresis, normal
from mdr_core.errors import InputError
from mdr_core.profiles import Cone, FlatPunch, Paraboloid, Power, Profile, RoundedPunch

G_STAR, MU = 1.6e9, 0.3
KINDS: list[Profile] = [Paraboloid(0.01), Cone(0.05), Power(40.0, 2.5), RoundedPunch(1e-4, 0.01)]


def measured(profile: Profile, part: float, points: int = 81) -> tuple[normal.NormalContact, ...]:
    """A contact under 10 N, and a loop whose amplitude is a part of that of full slip."""
    contact = normal.solve(profile, 2e9, normal_force=10.0)
    whole = MU * 2e9 / G_STAR * float(contact.indentation_depth)
    u = part * whole * np.sin(np.linspace(0.5, 4.5, points) * np.pi)
    path = {
        "normal_force": np.full(points + 1, 10.0),
        "tangential_displacement": np.append(0.0, u),
    }
    return contact, u, history.solve(profile, 2e9, G_STAR, MU, **path).tangential_force[1:]


@pytest.mark.parametrize("part", [0.3, 0.8, 3.0])
@pytest.mark.parametrize("profile", KINDS, ids=lambda each: each.kind)
def test_exact_loops(profile: Profile, part: float) -> None:
    _, u, force = measured(profile, part)
    for moved, offset, scale in ((0.0, 0.0, 1.0), (7e-5, 0.4, 1e-9)):
        contact = normal.solve(profile, 2e9 * scale, normal_force=10.0 * scale)
        found = hysteresis.solve(
            contact,
            tangential_displacement=u + moved,
            tangential_force=(force + offset) * scale,
        )
        assert found.g_star == pytest.approx(G_STAR * scale, rel=1e-9, abs=0)
        assert found.friction_coefficient == pytest.approx(MU, rel=1e-9, abs=0)
        assert found.force_offset == pytest.approx(offset * scale, rel=1e-9, abs=1e-9 * scale)


@pytest.mark.parametrize("profile", KINDS[:2], ids=lambda each: each.kind)
def test_intervals_of_95_per_cent_contain_the_parameters(profile: Profile) -> None:
    contact, u, force = measured(profile, 0.8)
    random, inside, trials = np.random.default_rng(5), np.zeros(3), 200
    for _ in range(trials):
        noisy = force + random.normal(0.0, 0.02 * force.max(), force.size)
        found = hysteresis.solve(contact, tangential_displacement=u, tangential_force=noisy)
        inside += np.abs(np.array(found[:3]) - [G_STAR, MU, 0.0]) < 1.96 * found.standard_errors
    # Five standard deviations of the count on either side.
    assert np.all(np.abs(inside / trials - 0.95) < 5 * np.sqrt(0.95 * 0.05 / trials))


def test_what_does_not_determine_the_parameters_is_rejected() -> None:
    contact, u, force = measured(Paraboloid(0.01), 0.8)
    loop = {"tangential_displacement": u, "tangential_force": force}
    stuck = normal.solve(FlatPunch(0.01), 2e9, normal_force=10.0)
    for given, changed, match in (
        (contact, {"tangential_force": -force}, "rise with the displacement"),
        (contact, {"tangential_force": force[1:]}, "has 80 values for 81"),
        (contact, {"tangential_displacement": np.ones(81)}, "6 points of a loop"),
        (contact, {"tangential_force": np.append(force[1:], np.nan)}, "finite"),
        (stuck, {"tangential_force": 3e7 * u}, "leaves G\\* or mu open"),
        (normal.solve(Paraboloid(1.0), 1.0, normal_force=[1.0, 2.0]), {}, "single normal load"),
    ):
        with pytest.raises(InputError, match=match):
            hysteresis.solve(given, **loop | changed)
