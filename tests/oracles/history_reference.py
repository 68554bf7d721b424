"""Exact results for histories of depth and displacement, from single springs in mpmath.

A spring whose first contact is at the depth w is followed through the whole history. In each load
step it is out of contact, comes into contact, stays or separates, and sticks or slips forward or
backward: its *branch*. While the branches of all steps are equal, its loads are linear in w, and
every condition that decides a branch is a linear inequality in w. Springs with equal branches
therefore form an interval of depths, and bisection finds all intervals reliably. On each interval
the tangential load is linear, and the energies are quadratic polynomials of w = g(x). Their
integrals over x need only int dx = x, int g dx = x g - N/2 and int g^2 dx at the interval ends.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

from tests.oracles import slip_reference as slip
from tests.oracles.shapes import FlatPunch
from tests.oracles.slip_reference import (
    WORK_DIGITS,
    Material,
    Setting,
    ShapeBody,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Path = Sequence[tuple[float, float]]

#: Interval ends are resolved to this many digits of the largest depth.
FRONT_DIGITS = 48
#: Relative tolerance of a quadratic at a fourth point.
LINEAR = mpf(10) ** -40
#: A spring that separates without slip reaches zero up to rounding error, which is not slip.
ROUNDING = mpf(10) ** -80
#: Upper bound on the number of intervals of any load path here.
MAX_FRONTS = 1000

Branches = tuple[int, ...]


@dataclass(frozen=True)
class SpringHistory:
    """Load and cumulative dissipated energy of the spring of depth w after each load step."""

    load: tuple[mpf, ...]
    dissipated: tuple[mpf, ...]
    branches: Branches


def follow(w: mpf, path: Path, material: Material) -> SpringHistory:
    """Follow one spring from (0, 0) along straight load steps to the points of `path`."""
    limit, g_star = mpf(material.mu) * mpf(material.e_star), mpf(material.g_star)
    q = dissipated = d = u = mpf(0)
    loads, dissipated_energies, branches = [], [], []
    for point in path:
        new_d, new_u = mpf(point[0]), mpf(point[1])
        q, one, branch = _load_step(q, w, (d, u), (new_d, new_u), (limit, g_star))
        dissipated += one
        d, u = new_d, new_u
        loads.append(q)
        dissipated_energies.append(dissipated)
        branches.append(branch)
    return SpringHistory(tuple(loads), tuple(dissipated_energies), tuple(branches))


def _load_step(
    q: mpf, w: mpf, begin: tuple[mpf, mpf], end: tuple[mpf, mpf], constants: tuple[mpf, mpf]
) -> tuple[mpf, mpf, int]:
    (d, u), (new_d, new_u) = begin, end
    limit, g_star = constants
    if max(d, new_d) <= w:
        return mpf(0), mpf(0), 0
    first, last, kind = max(d - w, mpf(0)), max(new_d - w, mpf(0)), 1
    span = mpf(1)
    if d <= w:
        span, kind = (new_d - w) / (new_d - d), 4
    elif new_d <= w:
        span, kind = (d - w) / (d - new_d), 7
    trial = q + g_star * (new_u - u) * span
    if abs(trial) <= limit * last + ROUNDING * limit * max(d, new_d):
        return trial, mpf(0), kind
    sign = 1 if trial > 0 else -1
    excess, room = abs(trial) - limit * last, limit * first - sign * q
    # Slip starts where the growing load meets the changing limit, and lasts until the end.
    onset = limit * (first + (last - first) * room / (room + excess))
    return sign * limit * last, excess / g_star * (onset + limit * last) / 2, kind + (sign % 3)


def fronts(path: Path, material: Material) -> list[mpf]:
    """Ends of the depth intervals over which the branches agree, from 0 to the largest depth."""
    top = max(mpf(d) for d, _ in path)
    floor = top * mpf(10) ** -FRONT_DIGITS

    @functools.cache
    def branches(w: mpf) -> Branches:
        return follow(w, path, material).branches

    result = [mpf(0)]
    waiting = [(floor, top - floor)]
    while waiting:
        low, high = waiting.pop()
        if branches(low) == branches(high):
            continue
        if high - low <= floor:
            result.append((low + high) / 2)
            continue
        middle = (low + high) / 2
        waiting += [(middle, high), (low, middle)]
        if len(result) > MAX_FRONTS:
            raise ArithmeticError("a branch depends on rounding error")
    return [*result, top]


@dataclass(frozen=True)
class Sample:
    """Sums over the foundation after a load step; the dissipated energy is that since the start."""

    normal_force: mpf
    tangential_force: mpf
    tangential_energy: mpf
    dissipated_energy: mpf


@dataclass(frozen=True)
class _Moments:
    """int_0^x of 1, g and g^2."""

    zeroth: mpf
    first: mpf
    second: mpf


def _moments(body: ShapeBody, w: mpf) -> _Moments:
    edge = body.b if body.blunt else mpf(0)
    if w == 0:
        return _Moments(edge, mpf(0), mpf(0))
    x = body.radius("indentation_depth", w)
    g, n = body.g(x), body.force(x)
    at = Setting(body, x, g, n, mpf(1), mpf(1), mpf(1), mpf(1), mpf(1))
    first = x * g - n / 2
    return _Moments(x, first, g * first - slip.overlap(at, edge))


def _quadratic(points: Sequence[tuple[mpf, mpf]]) -> tuple[mpf, mpf, mpf]:
    """Coefficients of 1, w, w^2 through three points, checked at a fourth."""
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = points
    first = (y1 - y0) / (x1 - x0)
    second = ((y2 - y0) / (x2 - x0) - first) / (x2 - x1)
    size = max(abs(y) for _, y in points)
    guess = y0 + (x3 - x0) * (first + second * (x3 - x1))
    if abs(guess - y3) > LINEAR * size:
        raise ArithmeticError("the springs of an interval do not follow one polynomial")
    return y0 - first * x0 + second * x0 * x1, first - second * (x0 + x1), second


def _parts(histories: Sequence[SpringHistory], step: int) -> tuple[list[mpf], list[mpf], list[mpf]]:
    loads = [life.load[step] for life in histories]
    return loads, [q * q for q in loads], [life.dissipated[step] for life in histories]


def history(profile: Mapping[str, Any], path: Path, material: Material) -> list[Sample]:
    """Exact sums after each load step of a path of (depth, displacement) from (0, 0)."""
    with mp.workdps(WORK_DIGITS):
        body = ShapeBody(profile)
        if isinstance(body, ShapeBody) and isinstance(body.shape, FlatPunch):
            return _punch(body, path, material)
        return _sums(body, path, material)


def _sums(body: ShapeBody, path: Path, material: Material) -> list[Sample]:
    e_star, g_star = mpf(material.e_star), mpf(material.g_star)
    totals = [[mpf(0)] * 3 for _ in path]
    borders = fronts(path, material)
    # Between intervals lies a gap as narrow as the resolution of the fronts.
    margin = borders[-1] * mpf(10) ** (1 - FRONT_DIGITS)
    moments = [_moments(body, w) for w in borders]
    for number, (low, high) in enumerate(itertools.pairwise(borders)):
        if high - low < 100 * margin:
            continue
        below, above = moments[number], moments[number + 1]
        steps = (
            above.zeroth - below.zeroth,
            above.first - below.first,
            above.second - below.second,
        )
        inside = [low + margin, (low + high) / 2, high - margin, low + (high - low) / 3]
        histories = [follow(w, path, material) for w in inside]
        for step, total in enumerate(totals):
            for index, values in enumerate(_parts(histories, step)):
                parts = _quadratic(list(zip(inside, values, strict=True)))
                total[index] += 2 * mp.fdot(parts, steps)
    if body.blunt:
        # All springs under the flat are identical to the first one.
        life = follow(mpf(0), path, material)
        for step, total in enumerate(totals):
            for index, (value,) in enumerate(_parts([life], step)):
                total[index] += 2 * body.b * value
    bearing = [_bearing(body, mpf(d)) for d, _ in path]
    return [
        Sample(e_star * n, force, squares / (2 * g_star), dissipated)
        for n, (force, squares, dissipated) in zip(bearing, totals, strict=True)
    ]


def _bearing(body: ShapeBody, depth: mpf) -> mpf:
    return body.force(body.radius("indentation_depth", depth)) if depth > 0 else mpf(0)


def _punch(body: ShapeBody, path: Path, material: Material) -> list[Sample]:
    """All springs of a flat punch are identical."""
    width = 2 * body.b
    life = follow(mpf(0), path, material)
    return [
        Sample(
            width * mpf(material.e_star) * max(mpf(d), mpf(0)),
            width * q,
            width * q**2 / (2 * mpf(material.g_star)),
            width * dissipated,
        )
        for (d, _), q, dissipated in zip(path, life.load, life.dissipated, strict=True)
    ]
