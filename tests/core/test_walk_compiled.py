"""The compiled loop of the histories is in use, and is the same text as the one that is read."""

import importlib.machinery
import importlib.util
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mdr_core.history import memory, slots, walk

TEXT = Path(memory.__file__).with_name("walk.py")


def test_the_loop_is_compiled() -> None:
    assert Path(walk.__file__).suffix in importlib.machinery.EXTENSION_SUFFIXES[-1]


def test_the_compiler_is_told_the_same_places() -> None:
    text = Path(slots.__file__).with_suffix(".pxd").read_text()
    told = dict(re.findall(r"^ +([A-Z_]+) = (\d+)$", text, re.MULTILINE))
    read = {name: str(value) for name, value in vars(slots).items() if name.isupper()}
    assert told == read


@pytest.mark.parametrize("record", [memory.walk, memory.slips])
def test_compiled_and_read_give_the_same_digits(
    monkeypatch: pytest.MonkeyPatch, record: Callable[..., object]
) -> None:
    rng = np.random.default_rng(20)
    steps = 3000
    level = rng.normal(0.3, 0.4, steps)
    shift = np.cumsum(rng.normal(0.0, 0.2, steps))
    way = memory.gap(0.0, 0.0), level, shift, np.arange(steps) % 3 > 0
    compiled = record(*way)
    spec = importlib.util.spec_from_file_location("walk_as_read", TEXT)
    assert spec is not None
    assert spec.loader is not None
    read = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(read)
    monkeypatch.setattr(memory, "walking", read)
    plain = record(*way)
    for name, ours in arrays(compiled).items():
        np.testing.assert_array_equal(ours, arrays(plain)[name], err_msg=name)


def arrays(result: object) -> dict[str, np.ndarray]:
    if isinstance(result, tuple):
        tree, pieces = result
        return arrays(tree) | pieces._asdict()
    named = vars(result)
    return {name: part for name, part in named.items() if isinstance(part, np.ndarray)}
