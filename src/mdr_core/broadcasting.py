"""Sweeps over millions of cases, in blocks that fit into the processor's cache.

On arrays larger than the cache every operation is limited by memory bandwidth; on a block only
the first one is.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from mdr_core.errors import InputError
from mdr_core.profiles import Profile
from mdr_core.typing import Parameter

# Cases in a block. Smaller blocks are limited by the interpreter, larger ones by memory bandwidth;
# within a factor of two the time is the same, by measurement.
BLOCK: Final = 65_536

# Doubles, or flags.
_Result = np.ndarray[Any, np.dtype[Any]]


def solve_cases(
    solve: Callable[..., Sequence[_Result]], profile: Profile, values: Sequence[Parameter]
) -> Sequence[_Result]:
    """Return solve(profile, *values), in blocks if there are more cases than fit into one.

    Parameters
    ----------
    solve : returns arrays over the cases of the profile and values that it takes, and leaves these
        unchanged.
    profile : parameters broadcast with the values.
    values : numbers, or arrays over the cases.

    Raises
    ------
    InputError : raised by `solve`, with the index of the case among all.
    """
    columns = (*profile.parameters.values(), *values)
    arrays = [column for column in columns if isinstance(column, np.ndarray)]
    if max((array.size for array in arrays), default=1) > BLOCK:
        try:
            return in_blocks(solve, profile, values)
        except InputError:
            # The index is that within the block.
            pass
    return solve(profile, *values)


def in_blocks(
    solve: Callable[..., Sequence[_Result]],
    profile: Profile,
    values: Sequence[Parameter],
    size: int = BLOCK,
) -> list[_Result]:
    """Return solve(profile, *values), computed in blocks of a size.

    A result that is the same single number in every block stays one. `solve` takes arrays of one
    dimension. Parameters: see `solve_cases`.
    """
    named = profile.parameters
    columns = [*named.values(), *values]
    swept = [
        i for i, column in enumerate(columns) if isinstance(column, np.ndarray) and column.ndim
    ]
    arrays = [columns[i] for i in swept]
    # A second operand, because nditer yields a bare array instead of a tuple for one.
    blocks: Any = np.nditer(
        [0.0, *arrays], ["external_loop", "buffered"], order="C", buffersize=size
    )
    wholes: list[_Result] = []
    start = 0
    for spread, *block in blocks:
        place = slice(start, start + spread.size)
        start = place.stop
        for i, part in zip(swept, block, strict=True):
            columns[i] = part
        parameters = dict(zip(named, columns, strict=False))
        own = with_parameters(profile, parameters) if profile.swept else profile
        results = solve(own, *columns[len(named) :])
        wholes = wholes or [_whole(result, blocks.itersize) for result in results]
        for i, (whole, result) in enumerate(zip(wholes, results, strict=True)):
            if whole.ndim == 0:
                if result.ndim == 0 and result == whole:
                    continue
                wholes[i] = np.full(blocks.itersize, whole)
            wholes[i][place] = result
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    return [whole.reshape(shape) if whole.ndim else whole for whole in wholes]


def _whole(first: _Result, size: int) -> _Result:
    """Array for the result of all blocks, or the single number of the first block."""
    return np.empty(size, first.dtype) if first.ndim else first


def with_parameters(profile: Profile, parameters: Mapping[str, Any]) -> Profile:
    """Return the profile with parameters replaced by parts of its own, which are not checked."""
    if not parameters:
        return profile
    part = object.__new__(type(profile))
    vars(part).update({**profile.parameters, **parameters})
    return part
