"""Moments of the slope g' over the contact against complex kernels, for stresses beneath it.

With zeta = z + i x, rho = sqrt(r^2 + zeta^2) and u = rho + zeta they are Im int_c^a g'(x) K dx for

    K = 1/rho, zeta/rho^3, 1/(rho u), 1/rho^3, 1/u, 1/u^2, 1/(rho u^2).

On a branch, in s = sqrt(x^2 - b^2), the kernels are singular at s_0 = sqrt((r + i z)^2 - b^2) = p +
i q alone, which s = p + q sinh(t) moves to t = i pi/2, however close to the surface the point is.
The values of g' are needed on the real axis only.

Source: notes, §14.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import inf, log, sqrt
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.quadrature import composite_rule, graded_rule, halvings_towards
from mdr_core.typing import Array, Indices

# Number of kernels.
KERNELS: Final = 7
# Longest panel of a substituted variable: the nearest singularity lies pi/2 beside the axis, or
# log(2) beyond an end.
_PANEL: Final = 2.0
# Powers of s up to this one are resolved by such a panel.
_STEEP: Final = 8.0
# Nodes of a panel, and a bound on the error that they leave, of the largest stress: at least 2.5
# times the largest of all kinds at 400 points near edges, axis and surface.
_NODES: Final = ((8, 2e-5), (10, 5e-8), (12, 1.5e-11), (16, 0.0))
# The substitution about s_0 begins at this part of |s_0|: below it g' alone needs resolution.
_SPLIT: Final = 0.5
# Part of the tolerance that may be left out next to the axis.
_NEGLIGIBLE: Final = 1e-3
# Part of the contact radius from which an annulus is narrow.
_NARROW: Final = 1e-2
# Nodes times points evaluated at once, so that temporaries stay in the processor's cache.
_BLOCK: Final = 8_192


class Span(NamedTuple):
    """Annulus c <= x <= a of a slope, each number to its own accuracy [length]."""

    a: float
    c: float
    width: float
    """a - c, accurate however narrow the annulus."""
    root: float | None
    """sqrt(a^2 - b^2) behind a flat of radius b, accurate however narrow the rest."""


@dataclass(frozen=True)
class Smooth:
    """A branch of g', and the distance in s over which it changes next to s = 0."""

    branch: Branch
    near: float
    """Infinite where g' is analytic at s = 0 on the scale of the branch, zero for a power."""


class _Points(NamedTuple):
    """Points in a half-space, radii and depths > 0, shape (m,)."""

    r: Array
    z: Array


def edge_moments(x: float, weight: float, r: Array, z: Array) -> Array:
    """Return the moments of a slope that is a single step of g by `weight` at x, shape (7, m).

    Parameters
    ----------
    x, weight : radius and height of the step [length].
    r, z : radii and depths [length], shape (m,).
    """
    square = (r - x) * (r + x) + z * z
    return _sums(square, np.full((1, 1), x), z, np.full((1, 1), weight))


def slope_moments(branches: Sequence[Smooth], span: Span, r: Array, z: Array, rtol: float) -> Array:
    """Return the moments of g' over an annulus, shape (7, m).

    Parameters
    ----------
    branches : intervals of g', ascending.
    span : ends of the annulus.
    r, z : radii and depths [length], z > 0, shape (m,).
    rtol : tolerance, relative to the moment of |g'| |K|.
    """
    total = np.zeros((KERNELS, r.size))
    for smooth in branches:
        branch = smooth.branch
        begin = max(branch.base, branch.start, span.c)
        end = min(branch.stop, span.a)
        if end > begin:
            total += _branch(smooth, begin, end, span, _Points(r, z), rtol)
    return total


def _branch(
    smooth: Smooth, begin: float, end: float, span: Span, points: _Points, rtol: float
) -> Array:
    """The part of one branch between two radii: below the split of each point, and above it."""
    base, (r, z) = smooth.branch.base, points
    s_begin, s_end = (sqrt((x - base) * (x + base)) for x in (begin, end))
    if end == span.a and span.root is not None:
        s_end = span.root
    both = begin == span.c and end == span.a
    step = span.width * (begin + end) / (s_begin + s_end) if both else s_end - s_begin
    at = r + 1j * z
    root = np.sqrt((at - base) * (at + base)) if base > 0 else at
    # Distances of s_0 from both ends, of a narrow annulus by its width.
    from_begin = ((at - begin) * (at + begin) / (root + s_begin)).real
    from_end = ((at - end) * (at + end) / (root + s_end)).real
    if both and step < _NARROW * s_end:
        nearer = np.abs(from_begin) < np.abs(from_end)
        from_begin, from_end = (
            np.where(nearer, from_begin, from_end + step),
            np.where(nearer, from_begin - step, from_end),
        )
    lowest = s_begin if smooth.near == inf else _SPLIT * np.abs(root)
    split = np.clip(np.broadcast_to(lowest, r.shape), s_begin, s_end)
    whole = split == s_begin
    low = np.where(whole, -from_begin, split - root.real) / root.imag
    high = -from_end / root.imag
    length = _arcsinh_step(low, high, np.where(whole, step, s_end - split) / root.imag)
    length[split == s_end] = 0.0
    ends = _Ends(s_begin, s_end, split, np.arcsinh(high), length)
    integrals = _Integrals(smooth, root.real, root.imag, z, ends)
    total = np.zeros((KERNELS, r.size))
    integrals.add_above(total, rtol)
    integrals.add_below(total, rtol)
    return total


class _Ends(NamedTuple):
    """Ends of the integrals of a branch, over s and in t; arrays of shape (m,)."""

    s_begin: float
    s_end: float
    split: Array
    top: Array
    """t at s_end."""
    length: Array
    """t at s_end less t at the split."""


@dataclass(frozen=True)
class _Integrals:
    """Integrals over one branch, for points at s_0 = p + i q and the depth z; shape (m,)."""

    smooth: Smooth
    p: Array
    q: Array
    z: Array
    ends: _Ends

    def add_above(self, total: Array, rtol: float) -> None:
        """Add the part above the split, in s = p + q sinh(t)."""
        length, branch = self.ends.length, self.smooth.branch
        far = np.hypot(self.p, self.q) > 2 * self.ends.s_end
        steep = max(1.0, branch.steepness / _STEEP)
        for away in (False, True):
            index = np.flatnonzero((length > 0) & (far == away))
            for group, count in _groups(length[index] * steep):
                part = index[group]
                rule = composite_rule(_nodes(rtol), count)
                if branch.pole < inf:
                    halvings = halvings_towards(self._distance_of_pole(part) * count) + 1
                    rule = graded_rule(_nodes(rtol), halvings, count)
                _fill(total, part, rule, partial(self._above, away=away))

    def _above(self, nodes: Array, weights: Array, index: Indices, *, away: bool) -> Array:
        branch, p, q, z = self.smooth.branch, self.p[index], self.q[index], self.z[index]
        step = nodes[:, None] * self.ends.length[index]
        top = self.ends.top[index]
        sinh = np.sinh(top - step)
        if away:
            # From far away the ends differ by less than the rounding of p.
            s = self.ends.s_end - 2 * q * np.cosh(top - step / 2) * np.sinh(step / 2)
        else:
            s = p + q * sinh
        s = np.clip(s, self.ends.s_begin, self.ends.s_end)
        x = np.sqrt(branch.base * branch.base + s * s) if branch.base > 0 else s
        square = 2 * z * z - q * (sinh * (p + s) + q)
        run = q * np.sqrt(1 + sinh * sinh) * self.ends.length[index]
        return _sums(square, x, z, branch.weight(x, s, index) * run * weights[:, None])

    def _distance_of_pole(self, index: Indices) -> float:
        """Smallest distance of the pole of g' beyond the upper end, in parts of the length."""
        base, pole = self.smooth.branch.base, self.smooth.branch.pole
        at = sqrt((pole - base) * (pole + base))
        gap = np.arcsinh((at - self.p[index]) / self.q[index]) - self.ends.top[index]
        return float((gap / self.ends.length[index]).min())

    def add_below(self, total: Array, rtol: float) -> None:
        """Add the part below the split, in y = arcsinh(s/near), or log(s) for powers."""
        s_begin, split = self.ends.s_begin, self.ends.split
        index = np.flatnonzero(split > s_begin)
        if not index.size:
            return
        branch, near = self.smooth.branch, self.smooth.near
        upper = split[index]
        if near > 0:
            low = np.full(upper.shape, s_begin / near)
            length = _arcsinh_step(low, upper / near, (upper - s_begin) / near)
            top = np.arcsinh(upper / near)
        else:
            reach = -log(_NEGLIGIBLE * rtol) / (1 + branch.tip)
            with np.errstate(divide="ignore"):
                length = np.minimum(np.log1p((upper - s_begin) / s_begin), reach)
            top = np.log(upper)
        steep = max(1.0, branch.steepness / _STEEP)
        for group, count in _groups(length * steep):
            below = partial(self._below, length[group], top[group], index[group])
            part = np.zeros((KERNELS, group.size))
            _fill(part, np.arange(group.size), composite_rule(_nodes(rtol), count), below)
            total[:, index[group]] += part

    def _below(
        self,
        length: Array,
        top: Array,
        points: Indices,
        nodes: Array,
        weights: Array,
        index: Indices,
    ) -> Array:
        branch, near = self.smooth.branch, self.smooth.near
        p, q, z = (part[points[index]] for part in (self.p, self.q, self.z))
        y = top[index] - nodes[:, None] * length[index]
        s, run = (near * np.sinh(y), near * np.cosh(y)) if near > 0 else (np.exp(y),) * 2
        x = np.sqrt(branch.base * branch.base + s * s) if branch.base > 0 else s
        square = (p - q) * (p + q) + 2 * z * z - s * s
        mass = branch.weight(x, s, points[index]) * run * length[index] * weights[:, None]
        return _sums(square, x, z, mass)


def _groups(length: Array) -> list[tuple[Indices, int]]:
    """Integrals with the same number of panels."""
    count = np.maximum(np.ceil(length / _PANEL), 1).astype(int)
    return [(np.flatnonzero(count == one), int(one)) for one in np.unique(count)]


def _nodes(rtol: float) -> int:
    return next(count for count, error in _NODES if rtol >= error)


def rule_error(rtol: float) -> float:
    """Return a bound on the error of the moments for a tolerance, of the largest stress."""
    return next(error for _, error in _NODES if rtol >= error)


def _fill(
    total: Array,
    index: Indices,
    rule: tuple[Array, Array],
    values: Callable[[Array, Array, Indices], Array],
) -> None:
    """Add a rule's sums in blocks that stay in the cache."""
    nodes, weights = rule
    step = max(_BLOCK // nodes.size, 1)
    for start in range(0, index.size, step):
        part = index[start : start + step]
        total[:, part] += values(nodes, weights, part)


def _sums(square: Array, x: Array, z: Array, mass: Array) -> Array:
    """Sums of mass Im K over the nodes, from Re rho^2; shape (7, m)."""
    rho = np.empty(np.broadcast_shapes(square.shape, x.shape), dtype=complex)
    rho.real, rho.imag = square, 2 * x * z
    np.sqrt(rho, out=rho)
    zeta = np.empty_like(rho)
    zeta.real, zeta.imag = z, x
    inverse, second = 1 / rho, 1 / (rho + zeta)
    mixed, cube = inverse * second, inverse * inverse * inverse
    kernels = inverse, zeta * cube, mixed, cube, second, second * second, mixed * second
    return np.stack([np.sum(mass * kernel.imag, axis=0) for kernel in kernels])


def _arcsinh_step(low: Array, high: Array, step: Array) -> Array:
    """arcsinh(high) - arcsinh(low), as accurate as step = high - low."""
    beside = low * high > 0
    root_low, root_high = np.hypot(1, low), np.hypot(1, high)
    total = np.where(beside, high * root_low + low * root_high, 1.0)
    near = np.arcsinh(step * (low + high) / total)
    return np.where(beside, near, np.arcsinh(high) - np.arcsinh(low))
