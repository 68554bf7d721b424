"""Sweeps over millions of scenes, block by block.

Every operation on arrays that are larger than the processor's cache waits for the memory. On
blocks that fit only the first one does: checks and temporaries cost next to nothing.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final

import numpy as np

from mdr_core.profiles import Profile
from mdr_core.typing import Array, Parameter

# A handful of doubles of each scene is at hand at once: some megabytes. Fewer scenes would wait
# for Python, more for the memory; by measurement it hardly matters within a factor of two.
BLOCK: Final = 65_536

# Doubles, or flags.
_Answer = np.ndarray[Any, np.dtype[Any]]


def scene_by_scene(
    size: int, answer: Callable[..., Array], profile: Profile, values: Sequence[Parameter]
) -> Array:
    """Return answer(profile, *values), in blocks if it is of more than a few scenes."""
    if size <= BLOCK:
        return answer(profile, *values)
    (found,) = in_blocks(lambda *parts: (answer(*parts),), profile, values)
    return found


def in_blocks(
    solve: Callable[..., Sequence[_Answer]], profile: Profile, values: Sequence[Parameter]
) -> list[_Answer]:
    """Return what solve(profile, *values) does, which works scene by scene, block by block.

    The profile's parameters and the values are broadcast and handed over in blocks with one
    dimension, not to be written to; what has no dimension is handed over as it is, and a result
    without dimension stays one as long as it is the same for all blocks.
    """
    named = profile.parameters
    columns = [*named.values(), *values]
    swept = [
        i for i, column in enumerate(columns) if isinstance(column, np.ndarray) and column.ndim
    ]
    arrays = [columns[i] for i in swept]
    # Always one operand more: a single one would come without a tuple around it.
    walk: Any = np.nditer(
        [0.0, *arrays], ["external_loop", "buffered"], order="C", buffersize=BLOCK
    )
    size, same_profile = walk.itersize, not any(i < len(named) for i in swept)
    gathered: list[_Gathered] = []
    start = 0
    for spread, *block in walk:
        place = slice(start, start + spread.size)
        start = place.stop
        for i, part in zip(swept, block, strict=True):
            columns[i] = part
        alike = profile if same_profile else alike_with(profile, zip(named, columns, strict=False))
        answers = solve(alike, *columns[len(named) :])
        gathered = gathered or [_Gathered(answer, size) for answer in answers]
        for whole, answer in zip(gathered, answers, strict=True):
            whole.put(place, answer)
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    return [whole.shaped(shape) for whole in gathered]


def alike_with(profile: Profile, named: Iterable[tuple[str, Any]]) -> Profile:
    """Return the profile with other parameters, parts of those that it has checked."""
    part = object.__new__(type(profile))
    vars(part).update(named)
    return part


class _Gathered:
    """One answer of all blocks: a single number as long as all of them give the same."""

    def __init__(self, first: _Answer, size: int) -> None:
        self.values = np.empty(size, first.dtype) if first.ndim else first
        self.size = size

    def put(self, place: slice, part: _Answer) -> None:
        if self.values.ndim == 0:
            if part.ndim == 0 and part == self.values:
                return
            self.values = np.full(self.size, self.values)
        self.values[place] = part

    def shaped(self, shape: tuple[int, ...]) -> _Answer:
        return self.values.reshape(shape) if self.values.ndim else self.values
