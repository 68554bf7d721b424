"""The compiled loop of load histories is in use and bit-identical to its Python source."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
from pathlib import Path
from shutil import which

import numpy as np
import pytest

from mdr_core.history import friction_work, slip_kernel, slip_memory

TEXT = Path(slip_memory.__file__).with_name("slip_kernel.py")


@pytest.mark.skipif(
    which("cc") is None or "MDR_PLAIN" in os.environ, reason="there is no compiled module"
)
def test_the_loop_is_compiled() -> None:
    suffix = Path(slip_kernel.__file__).suffix
    assert suffix in importlib.machinery.EXTENSION_SUFFIXES[-1]


@pytest.mark.parametrize("control", ["random", "constant", "separated"])
def test_compiled_kernel_is_bit_identical_to_python(
    monkeypatch: pytest.MonkeyPatch, control: str
) -> None:
    rng, count = np.random.default_rng(20), 3000
    spread = {"random": (0.3, 0.1), "constant": (0.3, 0.0), "separated": (0.3, 0.4)}[control]
    points = np.array([rng.normal(*spread, count), np.cumsum(rng.normal(0.0, 0.2, count))])
    steps = points, np.arange(count) % 3 > 0
    start = slip_memory.separated(np.zeros((2, 1)))
    compiled = slip_memory.follow(start, *steps)
    swept = friction_work.swept(compiled[0])
    vertices, path = np.tile(compiled[1].vertices, (9, 1)), rng.normal(0.3, 0.2, (4, 9))
    ends = len(compiled[1].vertices) * np.arange(1, 10)
    contacts = slip_memory.Polylines(vertices, ends, path[:2]), path[2:]
    each = slip_memory.moved_each(*contacts)
    specification = importlib.util.spec_from_file_location("plain", TEXT)
    assert specification is not None
    assert specification.loader is not None
    plain = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(plain)
    for module in (slip_memory, friction_work):
        monkeypatch.setattr(module, "kernel", plain)
    tree, line = slip_memory.follow(start, *steps)
    for name in ("parent", "vertices", "top"):
        np.testing.assert_array_equal(getattr(compiled[0], name), getattr(tree, name), name)
    for one, other in zip(compiled[1], line, strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(swept, friction_work.swept(tree))
    for one, other in zip(each, slip_memory.moved_each(*contacts), strict=True):
        np.testing.assert_array_equal(one, other)


def test_pieces_without_room_are_counted() -> None:
    """No path writes beyond the array, however many segments rounding errors add to the front."""
    rng = np.random.default_rng(21)
    normal, tangential = rng.normal(0.3, 0.1, 200), np.cumsum(rng.normal(0.0, 0.2, 200))
    steps = np.array([normal, tangential]), np.zeros(200, dtype=bool)
    tree, _ = slip_memory.follow(slip_memory.separated(np.zeros((2, 1))), *steps)
    before, tops = np.zeros((2, 200)), np.append(-1, tree.top[:-1])
    before[:, 1:] = tree.path[:, :-1]
    counts = [
        slip_kernel.SlipFront(np.empty((6, room))).run(
            tree.parent, tree.vertices, tops, before, tree.path
        )
        for room in (5, 4000)
    ]
    assert counts[0] == counts[1] > 200
