"""Wear that cannot be resolved or represented raises an error that names its cause."""

import pytest

from mdr_core import normal
from mdr_core.errors import AccuracyError, InputError
from mdr_core.profiles import Paraboloid, Power
from mdr_core.wear import evolution, limit


@pytest.mark.parametrize("cycles", [2e-309, 1e-250])
def test_too_few_cycles_are_refused(cycles: float) -> None:
    contact = normal.solve(Paraboloid(2.0), 2.3e9, normal_force=1e5)
    with pytest.raises(AccuracyError) as caught:
        _ = evolution.solve(
            contact,
            1.9e9,
            0.4,
            wear_coefficient=1e-13,
            cycles=[cycles],
            tangential_displacement=1e-5,
            resolution=8,
        ).worn_volume
    assert caught.value.path == ("cycles",)


def test_an_annulus_that_is_not_resolved_is_refused() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    with pytest.raises(AccuracyError) as caught:
        evolution.solve(
            contact,
            1.0,
            0.4,
            wear_coefficient=1e-4,
            cycles=[1e7],
            tangential_displacement=0.4 * (1 - 1e-7),
            resolution=8,
        )
    assert caught.value.path == ("resolution",)


def test_a_worn_annulus_without_an_outer_radius_in_doubles_is_refused() -> None:
    """Near full slip the depth grows without bound, and r^0.05 reaches it beyond 1e308."""
    contact = normal.solve(Power(0.0175, 0.05), 4e27, normal_force=[3.43e16])
    force = [0.9999999999 * 38.7 * 3.43e16]
    with pytest.raises(InputError, match="double precision") as caught:
        _ = limit.solve(contact, 4e27, 38.7, tangential_force=force).wear_radius
    assert caught.value.path == ("load", "normal_force", 0)
