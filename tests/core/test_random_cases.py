"""Random contacts biased towards cancellation keep their accuracy."""

from __future__ import annotations

import pytest

from tests.core.random_cases import Draw, misses, scene

pytestmark = pytest.mark.long

CASES = 8


@pytest.mark.parametrize("seed", range(10))
def test_fields_meet_the_tolerance(seed: int) -> None:
    draw = Draw(seed)
    for _ in range(CASES):
        result = [str(miss) for miss in misses(scene(draw))]
        assert not result, result
