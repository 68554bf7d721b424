"""Numbers of every type, of Python or of NumPy, give the results of the doubles that they equal."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mdr_core import history, impact, normal
from mdr_core.materials import Body, from_bodies
from mdr_core.profiles import Paraboloid, PowerTerm, Profile, RoundedCone, Series, SphericalTipCone


def results(number: Callable[[int], Any]) -> list[float]:
    """Results of contacts and of an impact, whose arguments are whole numbers of one type."""
    two, three = number(2), number(3)
    bodies = from_bodies([Body(two, number(0)), Body(three, number(0))])
    series = Series((PowerTerm(three, two),))
    kinds: list[Profile] = [RoundedCone(two, three), SphericalTipCone(two, three), series]
    found = [float(normal.solve(each, bodies, normal_force=two).contact_radius) for each in kinds]
    masses = {"normal_mass": three, "tangential_mass": two}
    speeds = {"normal_velocity": two, "tangential_velocity": three}
    hit = impact.solve(Paraboloid(three), two, two, number(1), **masses, **speeds)
    return [*found, float(hit.tangential_rebound_velocity)]


@pytest.mark.parametrize("number", [int, np.int8, np.uint8, np.float32, np.array], ids=str)
def test_type_of_a_number_does_not_matter(number: Callable[[int], Any]) -> None:
    assert results(number) == pytest.approx(results(float), rel=1e-14, abs=0)


@pytest.mark.parametrize("number", [np.float32, np.array], ids=str)
def test_contacts_of_any_number_are_joined(number: Callable[[float], Any]) -> None:
    state = history.unloaded(Paraboloid(number(2.0)), 1.0, 1.0, 0.5)
    assert len(history.join(state, state)) == 2
