"""Sweeps, where loads and parameters of a profile are arrays over the cases."""

from collections.abc import Callable, Mapping
from math import prod
from typing import Any, Final

import numpy as np

from mdr_core.errors import InputError
from mdr_core.profiles import Profile
from mdr_core.typing import Parameter

BLOCK: Final = 65_536
"""Cases in a block, whose arrays fit into the processor's cache.

A million contacts in partial slip take two thirds of the time so.
"""


def with_parameters(profile: Profile, parameters: Mapping[str, Any]) -> Profile:
    """Return the profile with some parameters replaced, without a check."""
    if not parameters:
        return profile
    part = object.__new__(type(profile))
    vars(part).update({**profile.parameters, **parameters})
    return part


def solve_in_blocks(
    function: Callable[..., tuple[Any, ...]], profile: Profile, *columns: Parameter
) -> tuple[Any, ...]:
    """Return function(profile, *columns), arrays over the cases, computed in blocks of them.

    A result that is the same single number in every block stays one. An InputError has the index
    of the case among all.
    """
    named = profile.parameters
    arrays = [each for each in (*named.values(), *columns) if isinstance(each, np.ndarray)]
    shapes = {each.shape for each in arrays if each.ndim}
    if len(shapes) != 1 or max(each.size for each in arrays) <= BLOCK:
        return function(profile, *columns)
    (shape,) = shapes

    def part(column: Any, place: slice) -> Any:
        return np.ravel(column)[place] if np.ndim(column) else column

    found: list[Any] = []
    for start in range(0, prod(shape), BLOCK):
        place = slice(start, start + BLOCK)
        block = with_parameters(profile, {name: part(named[name], place) for name in profile.swept})
        try:
            results = function(block, *(part(column, place) for column in columns))
        except InputError:
            return function(profile, *columns)
        found = found or [np.empty(shape, each.dtype) if each.ndim else each for each in results]
        for i, (whole, result) in enumerate(zip(found, results, strict=True)):
            if not whole.ndim and (result.ndim or result != whole):
                found[i] = np.full(shape, whole)
            if found[i].ndim:
                found[i].reshape(-1)[place] = result
    return tuple(found)
