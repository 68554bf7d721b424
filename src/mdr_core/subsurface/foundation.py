"""Loads of the foundation and their moments, from which the stresses beneath a contact follow.

With zeta = z + i x, rho = sqrt(r^2 + zeta^2) and u = rho + zeta they are int (1 + i m) g' Im K dx
for

    K = 1/rho, zeta/rho^3, 1/(rho u), 1/rho^3, 1/u, 1/u^2, 1/(rho u^2),

m = dq_x/dq = +-mu k, k the slope of the anchors: the real part belongs to the normal load, the
imaginary part to the tangential load. The kernels are singular at x^2 = w = (r + i z)^2.

Source: notes, §12.
"""

from math import ceil, inf, log2, prod
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from numpy.polynomial import legendre

from mdr_core import tangential
from mdr_core.abel.displacement import Branch
from mdr_core.doubles import EPS
from mdr_core.elementwise import in_blocks
from mdr_core.errors import InputError
from mdr_core.fields.traction import Traction, tractions
from mdr_core.history import ContactState
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Paraboloid
from mdr_core.quadrature import NODES, PIECE, STEEP, composite_rule, gauss_legendre
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Chosen, Indices, Numbers
from mdr_core.validation import require_representable, require_type

Contact: TypeAlias = NormalContact | TangentialContact | ContactState

# Smallest distance of a far singularity from the middle of a block in x^2, over its length:
# interpolation errs by 5^-n.
_FAR: Final = 1.3
_AT: Final = gauss_legendre(NODES)[0]
# From values of Legendre polynomials to values of Lagrange's polynomials at the nodes.
_TO_NODES: Final = np.linalg.inv(legendre.legvander(_AT, NODES - 1))


class _Blocks(NamedTuple):
    """Parts low <= x <= high of the contact, n of the same number of pieces, as masses at nodes."""

    low: Array
    high: Array
    width: Array
    """high^2 - low^2, accurate however narrow, shape (n,)."""
    past: Array
    """x^2 - low^2 of the nodes, shape (nodes, n)."""
    x: Array
    mass: Numbers


class Foundation:
    """Loads of the foundation under a single load, as they act on body 1 or 2."""

    def __init__(self, load: Traction, body: int) -> None:
        self.load, profile = load, load.profile
        self.friction = (1 if body == 2 else -1) * load.modulus / load.e_star
        """mu, with the sign of the traction on the body [1]."""
        self._slope = self.friction * load.slope
        # Smallest radius at which q_x has a slope, infinite if it has none.
        self.slips_from = load.radius[:-1][load.slope != 0].min(initial=inf)
        self.sheared = bool(self.slips_from < inf)
        self.loaded = bool(load.coordinate[-1] > 0)
        # The kernel 1/rho^3 must be representable.
        require_representable(("profile",), np.asarray(self.loaded), load.radius[-1] ** 3)
        radii = map(float, profile.infinite_pressure_radii)
        self.infinite_radii = [b for b in radii if self.loaded and b <= load.radius[-1]]
        if profile.is_flat_punch:
            # The slope of g is a single step at the contact radius.
            a, zero = load.radius[-1:], np.zeros((1, 1))
            mass = load.coordinate[-1:] + 1j * self._slope * load.width
            self._levels = [_Blocks(a, a, zero[0], zero, a[:, None], mass[:, None])]
        elif self.loaded:
            self._levels = [self._pieces()]
            while self._levels[-1].low.size > 1:
                self._levels.append(_merged(self._levels[-1]))

    def _pieces(self) -> _Blocks:
        """Pieces on which k g' is smooth in s = sqrt(x^2 - b^2), and empty ones: 2^n in all."""
        load, a = self.load, self.load.radius[-1]
        inner, outer = load.radius[:-1], load.radius[1:]
        # A branch that starts at the contact edge is empty, unless it is the first one.
        every = load.profile.branches
        branches = [b for b in every if max(b.base, b.start) < a] or every[:1]
        starts = np.array([max(branch.base, branch.start) for branch in branches])
        cuts = [self._cuts(branch) for branch in branches]
        low = np.unique(np.concatenate([starts[:1], inner[inner > starts[0]], *cuts]))
        low = np.append(low, np.full(2 ** ceil(log2(low.size)) - low.size, a))
        high = np.append(low[1:], a)
        self._owner = np.searchsorted(starts, low, side="right") - 1
        self._part = part = np.searchsorted(outer, high)
        self._base = base = np.array([branch.base for branch in branches])[self._owner]
        # An annulus may be too narrow for its radii to resolve it.
        whole = (inner[part] == low) & (outer[part] == high)
        width = np.where(whole, load.width[part], high - low) * (high + low)
        s_low = np.sqrt((low - base) * (low + base))
        s_high = np.sqrt(s_low * s_low + width)
        self._ends = np.array([s_low, s_high])
        u, shares = (part[:, None] for part in composite_rule(NODES, 1))
        step = width / (s_low + s_high)
        s = s_low + step * u
        x = np.sqrt(base * base + s * s)
        mass = self._slopes(x, s, slice(None)) * (step * shares)
        return _Blocks(low, high, width, step * u * (s_low + s), x, mass)

    def _cuts(self, branch: Branch) -> list[float]:
        """Radii between which k g' of a branch is smooth."""
        base, profile = branch.base, self.load.profile
        start, stop = max(base, branch.start), min(branch.stop, self.load.radius[-1])
        smooth = min(branch.stop, branch.pole) < inf or isinstance(profile, Cone | Paraboloid)
        first = inf if smooth else EPS * stop
        near = min(base, branch.opposite_singularity) or first
        return branch.cuts(start, stop, near, min(1.0, STEEP / branch.steepness))

    def _slopes(self, x: Array, s: Array, index: Chosen) -> Numbers:
        """(1 + i k) dg/ds at nodes x, s (nodes, m) of the pieces `index` (m,)."""
        found = self.load.profile.branch_weights(x, s, self._owner[index])
        if not self.sheared:
            return found
        return found * (1 + 1j * self._slope[self._part[index]])

    def moments(self, r: Array, z: Array) -> Numbers:
        """Return the moments of q + i q_x at points, z > 0, shape (7, m)."""
        total = np.zeros((7, r.size), dtype=self._levels[0].mass.dtype)
        point, block = np.arange(r.size), np.zeros(r.size, dtype=int)
        for level in reversed(self._levels):
            if level.low.size > 1:
                point, block = np.repeat(point, 2), np.repeat(2 * block, 2)
                block[1::2] += 1
            at, width = r[point] + 1j * z[point], level.width[block]
            # w less the squares of both ends; the nearer one is accurate in a narrow annulus.
            low, high = ((at - x) * (at + x) for x in (level.low[block], level.high[block]))
            nearer = np.abs(low) < np.abs(high)
            low, high = np.where(nearer, (low, low - width), (high + width, high))
            far = np.abs(low - width / 2) >= _FAR * width
            index = np.flatnonzero(far)
            for part in (index[rows] for rows in in_blocks(index.size, len(level.x))):
                own, place = block[part], point[part]
                square = low.real[part] - level.past[:, own]
                _add(total, place, square, level.x[:, own], z[place], level.mass[:, own])
            point, block, low, high = (part[~far] for part in (point, block, low, high))
        if point.size:
            self._add_near(total, point, block, z[point], np.array([low, high]))
        return total + 0j

    def _add_near(
        self, total: Numbers, point: Indices, index: Indices, z: Array, above: Numbers
    ) -> None:
        """Add moments of pieces near points, from w less the squares of their ends (2, m)."""
        base, (s_low, s_high) = self._base[index], self._ends[:, index]
        # s = p + q sinh(t), with the singularity p + i q.
        root = np.sqrt(above[0] + s_low * s_low)
        # Rounding may put a singularity that is far nearer to the axis than the piece on the line:
        # then any q serves that is small beside s.
        p, q = root.real, np.where(root.imag == 0, EPS * s_low, root.imag)
        bottom, top = np.arcsinh(-(above / (root + self._ends[:, index])).real / q)
        count = np.maximum(np.ceil((top - bottom) / PIECE), 1).astype(int)
        for panels in np.unique(count):
            u, shares = (part[:, None] for part in composite_rule(NODES, int(panels)))
            same = np.flatnonzero(count == panels)
            for part in (same[rows] for rows in in_blocks(same.size, u.size)):
                length = top[part] - bottom[part]
                sinh = np.sinh(top[part] - u * length)
                s = np.minimum(np.maximum(p[part] + q[part] * sinh, s_low[part]), s_high[part])
                x = np.sqrt(base[part] ** 2 + s * s)
                square = -q[part] * (sinh * (p[part] + s) + q[part])
                run = q[part] * np.sqrt(1 + sinh * sinh) * length * shares
                mass = self._slopes(x, s, index[part]) * run
                _add(total, point[part], square, x, z[part], mass)


def foundations(contact: Contact, body: int) -> tuple[list[Foundation], tuple[int, ...]]:
    """Return the foundation under each load, as it acts on body 1 or 2, and the loads' shape."""
    if body not in (1, 2):
        raise InputError(("body",), "must be 1 or 2")
    require_type("contact", contact, Contact, "a contact, or the state of a load history")
    if isinstance(contact, NormalContact):
        # Without a tangential force the whole contact sticks, whatever G* and mu are.
        contact = tangential.solve(contact, contact.e_star, 1.0, tangential_force=0.0)
    shape, traction = tractions(contact)
    return [Foundation(traction(load), body) for load in range(prod(shape))], shape


def _merged(blocks: _Blocks) -> _Blocks:
    """Neighbours as one block: Im K/x is interpolated between its nodes in x^2."""
    low, high = (_Blocks(*(part[..., i::2] for part in blocks)) for i in (0, 1))
    width = low.width + high.width
    past = (1 + _AT[:, None]) / 2 * width
    x = np.sqrt(low.low**2 + past)
    known = np.concatenate([low.past, low.width + high.past]) / np.where(width > 0, width, 1.0)
    shares = legendre.legvander(2 * known - 1, NODES - 1) @ _TO_NODES
    mass = np.concatenate([low.mass * low.x, high.mass * high.x])
    mass = np.einsum("in,ink->kn", mass, shares) / x
    return _Blocks(low.low, high.high, width, past, x, mass)


def _add(total: Numbers, point: Indices, square: Array, x: Array, z: Array, mass: Numbers) -> None:
    """Add sums of mass Im K over nodes, from Re w - x^2 there (nodes, m), at points (m,)."""
    zeta = z + 1j * x
    # The imaginary part is positive, so that the root never changes its sheet.
    rho = np.sqrt(square + 2 * z * zeta)
    inverse, second = 1 / rho, 1 / (rho + zeta)
    mixed, cube = inverse * second, inverse * inverse * inverse
    kernels = [inverse, zeta * cube, mixed, cube, second]
    if np.iscomplexobj(mass):
        kernels += [second * second, mixed * second]
    for row, kernel in zip(total, kernels, strict=False):
        np.add.at(row, point, np.einsum("nm,nm->m", mass, kernel.imag))
