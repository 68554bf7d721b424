"""Integrals along arcs: many at once, each cut in halves until what is left out is small."""

from collections.abc import Callable
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Indices

_POINTS: Final = 16
# A piece that was halved so often ends at a point where nothing is smooth.
_ROUNDS: Final = 24
# The same for what has kinks all over.
_FEW_ROUNDS: Final = 5
_FINEST: Final = 1e-12
# Halving leaves half of what a jump hides, and all of what is rounding: after so many rounds in a
# row that leave more than this, nothing more is to be had.
_LEFT: Final = 0.75
_STALLED_ROUNDS: Final = 3
# Sums over a table's knots carry more rounding.
_ROUGHEST: Final = 1e-10
# Degrees of the coefficients that are compared, and how much what is missing may exceed them.
_COMPARED: Final = (6, 7, 14, 15)
_SAFE: Final = 16.0
_SLOWLY: Final = 32.0
# Pieces at once: bounds the memory.
_BLOCK: Final = 1024


class Integral(NamedTuple):
    """One integral for each owner, with what may be missing of each."""

    value: Array
    missing: Array


def integrate(
    function: Callable[[Indices, Array], Array],
    ends: tuple[Indices, Array, Array],
    goal: float,
    *,
    rough: bool,
    smooth: bool = True,
) -> Integral:
    """Return the integrals of function(owner, at), positive, summed by owner.

    `ends` are owners, and the ends of their pieces; function takes owners of shape (m, 1) and
    places of shape (m, n). Where the ends are `rough`, nodes crowd there: roots do no harm.
    What is not `smooth` in between is trusted less. A piece that may miss more than `goal` of the
    largest integral is halved.
    """
    owner, low, high = ends
    count = int(owner.max(initial=-1)) + 1
    value, missing = np.zeros(count), np.zeros(count)
    goal = max(goal, _FINEST if smooth else _ROUGHEST)
    rounds = _ROUNDS if smooth else _FEW_ROUNDS
    left, stalled = np.inf, 0
    for round_ in range(rounds):
        total, tail = _pieces(function, owner, low, high, rough=rough, smooth=smooth)
        largest = float(np.max(value + np.bincount(owner, total, count), initial=0.0))
        good = (tail <= goal * largest) | ~(tail > 0)
        before, left = left, float(tail[~good].sum())
        stalled = stalled + 1 if left > _LEFT * before else 0
        good |= (round_ == rounds - 1) | (stalled == _STALLED_ROUNDS)
        value += np.bincount(owner[good], total[good], count)
        missing += np.bincount(owner[good], tail[good], count)
        if good.all():
            break
        owner, low, high = owner[~good], low[~good], high[~good]
        middle = (low + high) / 2
        owner = np.concatenate([owner, owner])
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return Integral(value, missing)


def _pieces(
    function: Callable[[Indices, Array], Array],
    owner: Indices,
    low: Array,
    high: Array,
    *,
    rough: bool,
    smooth: bool,
) -> tuple[Array, Array]:
    """Integral over each piece, and what may be missing.

    The rule is exact for twice as many polynomials as it has nodes. From the eighth to the last
    coefficients fall by some factor, and the first that it misses are as far behind again, twice.
    Those of a root fall slowly, and ever more so: then nothing is counted on.
    """
    share, weights, last = _rule(rough=rough)
    total, tail = np.empty(owner.size), np.empty(owner.size)
    for start in range(0, owner.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        span = (high[part] - low[part])[:, None]
        values = function(owner[part][:, None], low[part][:, None] + span * share)
        values = values * np.abs(span)
        total[part] = (values * weights).sum(axis=1)
        earlier, later = np.abs(values @ last).reshape(-1, 2, 2).sum(axis=2).T
        falls = later / np.where(earlier > later, earlier, np.where(later > 0, later, 1.0))
        tail[part] = _SAFE * later * (np.minimum(_SLOWLY * falls, 1.0) if smooth else 1.0)
    return total, tail


@lru_cache(maxsize=2)
def _rule(*, rough: bool) -> tuple[Array, Array, Array]:
    nodes, weights = gauss_legendre(_POINTS)
    weights = weights / 2
    polynomials = legendre.legvander(nodes, _POINTS - 1)[:, _COMPARED]
    share = (1 + nodes) / 2
    density = 6 * share * (1 - share) if rough else np.ones_like(share)
    place = share * share * (3 - 2 * share) if rough else share
    return place, weights * density, polynomials * (weights * density)[:, None]
