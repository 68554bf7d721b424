"""Scenes drawn at random towards every place where digits are lost, a few of each kind."""

from __future__ import annotations

import pytest

from tests.core.random_scenes import Draw, misses, scene

pytestmark = pytest.mark.long

SCENES = 8


@pytest.mark.parametrize("seed", range(10))
def test_fields_are_within_their_tolerance(seed: int) -> None:
    draw = Draw(seed)
    for _ in range(SCENES):
        found = [str(miss) for miss in misses(scene(draw))]
        assert not found, found
