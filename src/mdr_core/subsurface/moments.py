"""Moments of the slope g' over the contact against complex kernels, for stresses beneath it.

With zeta = z + i x, rho = sqrt(r^2 + zeta^2) and u = rho + zeta they are Im int_c^a g'(x) K dx for

    K = 1/rho, zeta/rho^3, 1/(rho u), 1/rho^3, 1/u, 1/u^2, 1/(rho u^2).

In x^2 the kernels are singular at w = (r + i z)^2 alone. The annulus is cut into pieces on which
g' is smooth, and pieces are merged in pairs into blocks. A block that is far from w acts like
masses at a few nodes. On a piece that is near, s = sqrt(x^2 - b^2) = p + q sinh(t) moves the
singularity p + i q = sqrt(w - b^2) to t = i pi/2, however close to the surface the point is. The
values of g' are needed on the real axis only.

Source: notes, §14.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot, inf, sqrt
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.abel.two_root import Weight
from mdr_core.quadrature import composite_rule, gauss_legendre
from mdr_core.typing import Array, Indices

# Number of kernels.
KERNELS: Final = 7
# Longest panel in t: the nearest singularity lies pi/2 beside the axis, or log(2) beyond an end.
_PANEL: Final = 2.0
# Powers of s up to this one are resolved on a piece that doubles s.
_STEEP: Final = 8.0
# Nodes of a panel and of a block by tolerance, and a bound on the error that they leave, of the
# largest stress: at least 2.5 times the largest of all kinds at 400 points near edges, axis and
# surface.
_NODES: Final = ((8, 10, 2e-5), (10, 12, 5e-8), (12, 16, 1.5e-11), (16, 20, 0.0))
# Least distance of a far singularity from a block, over its length, both in x^2: interpolation
# between n nodes of the block errs by 5.8^-n.
_FAR: Final = 1.0
# Part of the tolerance that may be left out next to the axis.
_NEGLIGIBLE: Final = 1e-3
# Distance of a point at the origin from it, over the contact radius.
_ORIGIN: Final = 1e-34
# Replaces a distance of zero from a node.
_TINY: Final = 1e-290
# Nodes times points evaluated at once: larger complex arrays leave the cache, and those above
# 128 kB are allocated anew.
_BLOCK: Final = 4_096


class Span(NamedTuple):
    """Annulus c <= x <= a of a slope, each number to its own accuracy [length]."""

    a: float
    c: float
    width: float
    """a - c, accurate however narrow the annulus."""
    flat: float = 0.0
    """Radius b of the body's flat [length]."""
    root: float = 0.0
    """sqrt(a^2 - b^2), accurate however narrow the rest."""


class Smooth(NamedTuple):
    """A branch of g', and the distance in s over which it changes next to s = 0."""

    branch: Branch
    near: float
    """Infinite where g' is analytic at s = 0 on the scale of the branch, zero for a power."""


class _Piece(NamedTuple):
    """Interval of a branch on which g' is smooth."""

    weight: Weight
    base: float
    s_low: float
    s_high: float
    step: float
    """s_high - s_low, accurate however narrow."""


class Block(NamedTuple):
    """Part low <= x <= high of an annulus, as masses at a few nodes."""

    low: float
    high: float
    width: float
    """high^2 - low^2, accurate however narrow."""
    offset: Array
    """x^2 - low^2 of the nodes, shape (nodes, 1)."""
    x: Array
    mass: Array
    parts: "tuple[Block, Block] | _Piece | None"
    """The halves of a block that was merged, or the piece."""


def step_block(x: float, height: float) -> Block:
    """Return the block of a slope that is a single step of g at the radius x."""
    one = np.full((1, 1), x)
    return Block(x, x, 0.0, np.zeros((1, 1)), one, np.full((1, 1), height), None)


def blocks(branches: Sequence[Smooth], span: Span, rtol: float, nearest: float) -> Block | None:
    """Return the blocks of g' over an annulus, as their root; None where g' vanishes.

    Parameters
    ----------
    branches : intervals of g', ascending.
    span : ends of the annulus.
    rtol : tolerance, relative to the moment of |g'| |K|.
    nearest : least distance of the points from the origin [length].
    """
    nodes, joined, _ = _rule(rtol)
    level = [block for smooth in branches for block in _leaves(smooth, span, nodes, nearest, rtol)]
    while len(level) > 1:
        merged = [_merged(*pair, joined) for pair in zip(level[::2], level[1::2], strict=False)]
        level = merged + level[2 * len(merged) :]
    return level[0] if level else None


def moments(root: Block, r: Array, z: Array, rtol: float) -> Array:
    """Return the moments at points in the body, shape (7, m).

    Parameters
    ----------
    root : blocks of g'.
    r, z : radii and depths [length], z > 0, shape (m,).
    rtol : tolerance of the blocks.
    """
    total = np.zeros((KERNELS, r.size))
    waiting = [(root, np.arange(r.size))]
    while waiting:
        block, index = waiting.pop()
        at_r, at_z = r[index], z[index]
        # Re w less the square of either end; the nearer one is accurate in a narrow annulus.
        above_low, above_high = (
            (at_r - x) * (at_r + x) - at_z * at_z for x in (block.low, block.high)
        )
        nearer = np.abs(above_low) < np.abs(above_high)
        above_low = np.where(nearer, above_low, above_high + block.width)
        gap = np.maximum(np.maximum(-above_low, above_low - block.width), 0.0)
        far = np.hypot(gap, 2 * at_r * at_z) >= _FAR * block.width
        for part in _in_cache(np.flatnonzero(far), block.x.size):
            depth = at_z[part]
            square = above_low[part] + 2 * depth * depth - block.offset
            total[:, index[part]] += _sums(square, block.x, depth, block.mass)
        near = index[~far]
        if near.size and isinstance(block.parts, _Piece):
            _add_near(total, block, block.parts, near, (r[near], z[near]), _rule(rtol)[0])
        elif near.size and block.parts:
            waiting += [(half, near) for half in block.parts if isinstance(half, Block)]
    return total


def rule_error(rtol: float) -> float:
    """Return a bound on the error of the moments for a tolerance, of the largest stress."""
    return _rule(rtol)[2]


def _rule(rtol: float) -> tuple[int, int, float]:
    return next(rule for rule in _NODES if rtol >= rule[2])


def _leaves(smooth: Smooth, span: Span, nodes: int, nearest: float, rtol: float) -> Iterator[Block]:
    """The part of a branch in an annulus, cut where g' changes over less than the rest."""
    branch, base = smooth.branch, smooth.branch.base
    begin, end = max(base, branch.start, span.c), min(branch.stop, span.a)
    if not end > begin:
        return
    first, last = (sqrt((x - base) * (x + base)) for x in (begin, end))
    if end == span.a and base == span.flat > 0:
        last = span.root
    # What is left out next to the axis is a small part of that next to the points.
    left_out = (_NEGLIGIBLE * rtol) ** (1 / (1 + branch.tip))
    near = smooth.near or left_out * min(last, max(nearest, _ORIGIN * span.a))
    growth = min(1.0, _STEEP / branch.steepness)
    pole = sqrt((branch.pole - base) * (branch.pole + base)) if branch.pole < inf else inf
    cuts = [first]
    while cuts[-1] < last:
        at = cuts[-1]
        cuts.append(min(at + min(growth * hypot(near, at), (pole - at) / 2), last))
    x = [begin, *(hypot(base, s) for s in cuts[1:-1]), end]
    u, shares = composite_rule(nodes, 1)
    for (low, high), (s_low, s_high) in zip(pairwise(x), pairwise(cuts), strict=True):
        step = s_high - s_low
        if low == span.c and high == span.a:
            step = span.width * (low + high) / (s_low + s_high)
        past = step * u[:, None]
        s = s_low + past
        radius = np.sqrt(base * base + s * s)
        mass = branch.weight(radius, s, slice(0, 1)) * step * shares[:, None]
        piece = _Piece(branch.weight, base, s_low, s_high, step)
        yield Block(low, high, step * (s_low + s_high), past * (s_low + s), radius, mass, piece)


def _merged(low: Block, high: Block, nodes: int) -> Block:
    """Two neighbours as one block: Im K/x is interpolated between its nodes in x^2."""
    width = low.width + high.width
    at, weights = gauss_legendre(nodes)
    place = (1 + at) / 2
    known = np.concatenate([low.offset, low.width + high.offset]) / width
    # Barycentric weights of Gauss points, whose signs alternate.
    shares = np.sqrt((1 - at) * (1 + at) * weights) * (-1.0) ** np.arange(nodes)
    shares = shares / (known - place + _TINY)
    shares /= shares.sum(axis=1, keepdims=True)
    mass = np.concatenate([low.mass * low.x, high.mass * high.x])
    offset = place[:, None] * width
    x = np.sqrt(low.low * low.low + offset)
    return Block(low.low, high.high, width, offset, x, shares.T @ mass / x, (low, high))


def _add_near(
    total: Array,
    block: Block,
    piece: _Piece,
    index: Indices,
    place: tuple[Array, Array],
    nodes: int,
) -> None:
    """Add the moments of a piece at points near it, in s = p + q sinh(t)."""
    weight, base, s_low, s_high, step = piece
    r, z = place
    at = r + 1j * z
    root = np.sqrt((at - base) * (at + base)) if base > 0 else at
    p, q = root.real, root.imag
    # Distances of s_0 from both ends, in a narrow annulus by its width.
    past_low = ((at - block.low) * (at + block.low) / (root + s_low)).real
    past_high = ((at - block.high) * (at + block.high) / (root + s_high)).real
    nearer = np.abs(past_low) < np.abs(past_high)
    low = -np.where(nearer, past_low, past_high + step) / q
    high = -np.where(nearer, past_low - step, past_high) / q
    top, length = np.arcsinh(high), _arcsinh_step(low, high, step / q)
    count = np.maximum(np.ceil(length / _PANEL), 1).astype(int)
    for panels in np.unique(count):
        u, shares = (part[:, None] for part in composite_rule(nodes, int(panels)))
        for part in _in_cache(np.flatnonzero(count == panels), u.size):
            sinh = np.sinh(top[part] - u * length[part])
            s = np.clip(p[part] + q[part] * sinh, s_low, s_high)
            x = np.sqrt(base * base + s * s) if base > 0 else s
            depth = z[part]
            square = 2 * depth * depth - q[part] * (sinh * (p[part] + s) + q[part])
            run = q[part] * np.sqrt(1 + sinh * sinh) * length[part]
            mass = weight(x, s, part) * run * shares
            total[:, index[part]] += _sums(square, x, depth, mass)


def _in_cache(index: Indices, nodes: int) -> Iterator[Indices]:
    step = max(_BLOCK // nodes, 1)
    return (index[start : start + step] for start in range(0, index.size, step))


def _sums(square: Array, x: Array, z: Array, mass: Array) -> Array:
    """Sums of mass Im K over the nodes, from Re rho^2; shape (7, m)."""
    # The root of rho^2 in real numbers takes half the time of a complex one.
    imaginary = 2 * x * z
    larger = np.sqrt((np.hypot(square, imaginary) + np.abs(square)) / 2)
    smaller = imaginary / (2 * larger)
    rho, zeta = np.empty((2, *larger.shape), dtype=complex)
    rho.real = np.where(square < 0, smaller, larger)
    rho.imag = np.where(square < 0, larger, smaller)
    zeta.real, zeta.imag = z, x
    inverse, second = 1 / rho, 1 / (rho + zeta)
    mixed, cube = inverse * second, inverse * inverse * inverse
    kernels = inverse, zeta * cube, mixed, cube, second, second * second, mixed * second
    mass = np.broadcast_to(mass, larger.shape)
    return np.stack([np.einsum("nm,nm->m", mass, kernel.imag) for kernel in kernels])


def _arcsinh_step(low: Array, high: Array, step: Array) -> Array:
    """arcsinh(high) - arcsinh(low), as accurate as step = high - low."""
    beside = low * high > 0
    root_low, root_high = np.hypot(1, low), np.hypot(1, high)
    total = np.where(beside, high * root_low + low * root_high, 1.0)
    near = np.arcsinh(step * (low + high) / total)
    return np.where(beside, near, np.arcsinh(high) - np.arcsinh(low))
