"""Loads of the foundation and their moments, from which the stresses beneath a contact follow.

With zeta = z + i x, rho = sqrt(r^2 + zeta^2) and u = rho + zeta they are Im int k(x) g'(x) K dx for

    K = 1/rho, zeta/rho^3, 1/(rho u), 1/rho^3, 1/u, 1/u^2, 1/(rho u^2),

k = 1 for the normal load, and the slope of q_x over q for the tangential load.

The contact is cut into pieces on which k g' is smooth, and pieces are merged in pairs into blocks.
A block acts like masses at a few nodes on points that are far from it. On points that are near a
piece, it is integrated by a substitution that moves their singularity away.

Source: notes, §14.
"""

from collections.abc import Iterator
from math import hypot, inf, sqrt
from typing import Final, NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from mdr_core.abel.displacement import Branch
from mdr_core.profiles import Cone, Paraboloid
from mdr_core.quadrature import composite_rule, gauss_legendre
from mdr_core.subsurface.annuli import Contact, annuli_of, normal_of
from mdr_core.typing import Array, Chosen, Indices

# Number of the kernels K.
_KERNELS: Final = 7
# Longest panel in t: the nearest singularity lies pi/2 beside the axis, or log(2) beyond an end.
_PANEL: Final = 2.0
# Nodes of a panel.
_NODES: Final = 14
# Nodes of a block, and the least distance of a far singularity from it over its length, both in
# x^2: interpolation errs by 5.8^-n.
_JOINED, _FAR = 18, 1.0
# Powers of s up to this one are resolved on a piece that doubles s.
_STEEP: Final = 8.0
# First piece next to the axis of a power, over the contact radius: what it leaves out is rounding
# error beyond 1e16 times this distance.
_NEAREST: Final = 1e-32
# Replaces a distance of zero from a node.
_TINY: Final = 1e-290
# Nodes times points evaluated at once: larger complex arrays leave the cache, and those above
# 128 kB are allocated anew.
_BLOCK: Final = 4_096


class _Blocks(NamedTuple):
    """Parts low <= x <= high of the contact, n of the same number of pieces, as masses at nodes."""

    low: Array
    high: Array
    width: Array
    """high^2 - low^2, accurate however narrow, shape (n,); the last block may be empty."""
    offset: Array
    """x^2 - low^2 of the nodes, shape (nodes, n)."""
    x: Array
    mass: Array
    """Of q and q_x, if there is one, shape (1 or 2, nodes, n)."""


class Foundation:
    """Loads of the foundation under a single load, as they act on body 1 or 2."""

    def __init__(self, contact: Contact, body: int) -> None:
        normal, annuli, sign = normal_of(contact), annuli_of(contact), 1 if body == 2 else -1
        self.profile, self.modulus = normal.profile, float(normal.e_star) / np.pi
        self.annuli = annuli._replace(slope=sign * annuli.slope, rate=sign * annuli.rate)
        self.loaded = bool(normal.loaded)
        if not self.loaded:
            return
        if self.profile.has_no_partial_slip:
            # The slope of g is a single step at the contact radius.
            a, zero = self.annuli.radius, np.zeros((1, 1))
            k = np.append(1.0, self.annuli.slope)[: 1 + self.annuli.sheared, None, None]
            mass = k * float(normal.indentation_depth)
            self._levels = [_Blocks(a, a, zero[0], zero, a[:, None], mass)]
            return
        self._pieces = self._cut(float(normal.coordinate))
        low, high, base, s_low, s_high, step = self._pieces
        u, shares = (part[:, None] for part in composite_rule(_NODES, 1))
        past = step * u
        s = s_low + past
        x = np.sqrt(base**2 + s * s)
        mass = self._slopes(x, s, slice(None)) * (step * shares)
        width, offset = step * (s_low + s_high), past * (s_low + s)
        self._levels = [_Blocks(low, high, width, offset, x, mass)]
        while self._levels[-1].low.size > 1:
            self._levels[-1] = _paired(self._levels[-1])
            self._levels.append(_merged(self._levels[-1]))

    def _cut(self, coordinate: float) -> Array:
        """Pieces low <= x <= high on which k g' is smooth in s = sqrt(x^2 - b^2), ascending.

        low, high, b, s(low), s(high) and their difference, however narrow; shape (6, n) [length].
        """
        radius, width = self.annuli.radius, self.annuli.width
        self._panels, self._branches = self.profile.panels, self.profile.branches
        starts = np.array([max(branch.base, branch.start) for branch in self._branches])
        ends = [starts[starts < radius[-1]], radius[radius > starts[0]]]
        if self._panels is None or self.annuli.rate.any():
            ends += [self._cuts(branch) for branch in self._branches]
        cuts = np.unique(np.concatenate(ends))
        low, high = cuts[:-1], cuts[1:]
        self._owner = np.searchsorted(starts, low, side="right") - 1
        self._part = part = np.searchsorted(radius, high)
        base = np.array([branch.base for branch in self._branches])[self._owner]
        s_low, s_high = (np.sqrt((x - base) * (x + base)) for x in (low, high))
        if base[-1] == starts[0] > 0:
            # The coordinate is sqrt(a^2 - b^2), accurate however narrow the annulus around a flat.
            s_high[-1] = coordinate
        # An annulus may be too narrow for its radii to resolve it.
        narrow = (np.append(0.0, radius)[part] == low) & (radius[part] == high)
        step = np.where(narrow, width[part] * (low + high) / (s_low + s_high), s_high - s_low)
        return np.array([low, high, base, s_low, s_high, step])

    def _cuts(self, branch: Branch) -> list[float]:
        """Radii between which k g' of a branch changes over more than their distance."""
        base, curved = branch.base, bool(self.annuli.rate.any())
        ends = max(base, branch.start), min(branch.stop, self.annuli.radius[-1]), branch.pole
        s, last, pole = (sqrt(max(x - base, 0.0) * (x + base)) for x in ends)
        near = min(base, branch.behind) if base > 0 else _NEAREST * last
        ended = min(branch.stop, branch.pole) < inf or isinstance(self.profile, Cone | Paraboloid)
        if base == 0 and ended and not curved:
            near = inf
        growth = min(1.0, _STEEP / (branch.steepness + curved))
        found = []
        while s < last:
            found.append(sqrt(base * base + s * s))
            s += min(growth * hypot(near, s), (pole - s) / 2)
        return found

    def _slopes(self, x: Array, s: Array, index: Chosen) -> Array:
        """k dg/ds at nodes x, s (nodes, m) of the pieces `index` (m,), shape (1 or 2, nodes, m)."""
        owner, part = self._owner[index], self._part[index]
        if self._panels is not None:
            u = np.minimum(s / self._panels.length[owner], 1.0)
            found = polynomial.polyval(u, self._panels.weight.T[:, owner], tensor=False)
        else:
            found = np.empty_like(x)
            for number, branch in enumerate(self._branches):
                own = owner == number
                if own.all():
                    found = branch.weight(x, s, slice(0, 1))
                    break
                found[:, own] = branch.weight(x[:, own], s[:, own], slice(0, 1))
        if not self.annuli.sheared:
            return np.asarray(found[None])
        _, _, slope, rate, inverse = self.annuli
        k = slope[part] + rate[part] * (0.5 / x if inverse else 2 * x)
        return np.stack([found, k * found])

    def moments(self, r: Array, z: Array) -> Array:
        """Return the moments of q and q_x, if there is one, at points, z > 0, (1 or 2, 7, m)."""
        total = np.zeros((1 + self.annuli.sheared, _KERNELS, r.size))
        point, block = np.arange(r.size), np.zeros(r.size, dtype=int)
        for size, level in reversed(list(enumerate(self._levels))):
            at_r, at_z, high = r[point], z[point], level.high[block]
            width = level.width[block]
            # Re w less the square of either end; the nearer one is accurate in a narrow annulus.
            above_low, above_high = (
                (at_r - x) * (at_r + x) - at_z * at_z for x in (level.low[block], high)
            )
            nearer = np.abs(above_low) < np.abs(above_high)
            above_low = np.where(nearer, above_low, above_high + width)
            gap = np.maximum(np.maximum(-above_low, above_low - width), 0.0)
            far = np.hypot(gap, 2 * at_r * at_z) >= _FAR * width
            for part in _in_cache(np.flatnonzero(far & (high > 0)), len(level.x)):
                depth, own = at_z[part], block[part]
                square = above_low[part] + 2 * depth * depth - level.offset[:, own]
                _add(total, point[part], square, level.x[:, own], depth, level.mass[..., own])
            point, block = point[~far], block[~far]
            if size:
                point = np.repeat(point, 2)
                block = (2 * block[:, None] + np.arange(2)).ravel()
        if point.size:
            self._add_near(total, point, block, (r[point], z[point]))
        return total

    def _add_near(
        self, total: Array, point: Indices, index: Indices, place: tuple[Array, Array]
    ) -> None:
        """Add the moments of pieces at points near them, in s = p + q sinh(t)."""
        low, high, base, s_low, s_high, step = self._pieces[:, index]
        at = place[0] + 1j * place[1]
        root = np.sqrt((at - base) * (at + base))
        p, q = root.real, root.imag
        # Distances of s_0 from both ends, in a narrow annulus by its width.
        past_low = ((at - low) * (at + low) / (root + s_low)).real
        past_high = ((at - high) * (at + high) / (root + s_high)).real
        nearer = np.abs(past_low) < np.abs(past_high)
        bottom = np.arcsinh(-np.where(nearer, past_low, past_high + step) / q)
        top = np.arcsinh(-np.where(nearer, past_low - step, past_high) / q)
        length = top - bottom
        count = np.maximum(np.ceil(length / _PANEL), 1).astype(int)
        for panels in np.unique(count):
            u, shares = (part[:, None] for part in composite_rule(_NODES, int(panels)))
            for part in _in_cache(np.flatnonzero(count == panels), u.size):
                sinh = np.sinh(top[part] - u * length[part])
                s = np.maximum(p[part] + q[part] * sinh, s_low[part])
                np.minimum(s, s_high[part], out=s)
                x = np.sqrt(base[part] ** 2 + s * s)
                depth = place[1][part]
                square = 2 * depth * depth - q[part] * (sinh * (p[part] + s) + q[part])
                run = q[part] * np.sqrt(1 + sinh * sinh) * length[part] * shares
                mass = self._slopes(x, s, index[part]) * run
                _add(total, point[part], square, x, depth, mass)


def _paired(blocks: _Blocks) -> _Blocks:
    """An even number of blocks, the last of which may be empty."""
    if blocks.low.size % 2 == 0:
        return blocks
    return _Blocks(*(np.append(part, np.zeros_like(part[..., :1]), -1) for part in blocks))


def _merged(blocks: _Blocks) -> _Blocks:
    """Neighbours as one block: Im K/x is interpolated between its nodes in x^2."""
    low, high = (_Blocks(*(part[..., i::2] for part in blocks)) for i in (0, 1))
    width = low.width + high.width
    at, weights = gauss_legendre(_JOINED)
    place = (1 + at[:, None]) / 2
    known = np.concatenate([low.offset, low.width + high.offset]) / width
    # Barycentric weights of Gauss points, whose signs alternate.
    signed = np.sqrt((1 - at) * (1 + at) * weights) * (-1.0) ** np.arange(_JOINED)
    shares = signed[:, None, None] / (known - place[..., None] + _TINY)
    shares /= shares.sum(axis=0)
    mass = np.concatenate([low.mass * low.x, high.mass * high.x], axis=1)
    offset = place * width
    x = np.sqrt(low.low**2 + offset)
    top = np.maximum(low.high, high.high)
    return _Blocks(low.low, top, width, offset, x, np.einsum("jin,kin->kjn", shares, mass) / x)


def _in_cache(index: Indices, nodes: int) -> Iterator[Indices]:
    step = max(_BLOCK // nodes, 1)
    return (index[start : start + step] for start in range(0, index.size, step))


def _add(total: Array, point: Indices, square: Array, x: Array, z: Array, mass: Array) -> None:
    """Add sums of mass Im K over nodes, from Re rho^2 there (nodes, m), at points (m,)."""
    zeta = z + 1j * x
    rho = np.sqrt(square + 2j * (x * z))
    inverse, second = 1 / rho, 1 / (rho + zeta)
    mixed, cube = inverse * second, inverse * inverse * inverse
    kernels = [inverse, zeta * cube, mixed, cube, second]
    if len(total) > 1:
        kernels += [second * second, mixed * second]
    for number, kernel in enumerate(kernels):
        sums = np.einsum("knm,nm->km", mass, kernel.imag)
        for row, each in zip(total[:, number], sums, strict=True):
            np.add.at(row, point, each)
