"""Queries of wear that no number answers are refused, never answered by NaN or a crash."""

import pytest

from mdr_core import normal
from mdr_core.errors import AccuracyError, InputError
from mdr_core.profiles import Paraboloid, Power
from mdr_core.wear import evolution, limit


@pytest.mark.parametrize(
    ("shift", "cycles", "place"),
    [(1e-30, 1e6, "oscillation"), (1e-5, 2e-309, "cycles"), (1e-5, 1e-250, "cycles")],
)
def test_what_cannot_be_resolved_is_refused(shift: float, cycles: float, place: str) -> None:
    """And what would have to change is pointed at."""
    contact = normal.solve(Paraboloid(2.0), 2.3e9, normal_force=1e5)
    with pytest.raises(AccuracyError) as caught:
        _ = evolution.solve(
            contact,
            1.9e9,
            0.4,
            wear_coefficient=1e-13,
            cycles=[cycles],
            tangential_displacement=shift,
            resolution=8,
        ).worn_volume
    assert caught.value.path == (place,)


def test_an_annulus_that_is_not_resolved_asks_for_more_nodes() -> None:
    contact = normal.solve(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    found = evolution.solve(
        contact,
        1.0,
        0.4,
        wear_coefficient=1e-4,
        cycles=[1e7],
        tangential_displacement=0.4 * (1 - 1e-7),
        resolution=8,
    )
    with pytest.raises(AccuracyError) as caught:
        _ = found.error_estimate
    assert caught.value.path == ("resolution",)


def test_a_rim_beyond_the_range_of_doubles_is_refused() -> None:
    needle = Power(2.843502911765493e65, 0.6)
    contact = normal.solve(needle, 5.96e-8, indentation_depth=9.24e8)
    with pytest.raises(InputError, match="leaves the range"):
        limit.solve(contact, 1.0, 0.0606, tangential_displacement=[0.0, 1e-90])
