"""The slope g'(x) of a table as polynomials, and depth, force and energy as their integrals.

g' carries a root at every radius b of the table, which s = sqrt(x^2 - b^2) removes: on a panel, and
on subpanels of long ones, dg/ds and x dg/ds are polynomials in s about their left edge.

Source: notes, §5.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.interpolation import fit_points
from mdr_core.cached import cached_property
from mdr_core.elementwise import every
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Flags, Indices

# Largest length of a subpanel over its left edge's distance from the next root below, both in x^2.
# The root is then at u = +-0.91i, or farther: n Chebyshev points leave 4.3^-n, and the coefficients
# of the powers of u grow no faster than 1.1^n, so that their sum is stable.
LONGEST: Final = 1.2
# Points in a subpanel of a spline, whose roots are weak.
FEW: Final = 12
# Gauss nodes in a subpanel where the root lies as near as that: they leave 4.3^-32.
_AXIS_NODES: Final = 16
# Newton's method in log u converges quadratically: a step this short is the last one.
_LAST_STEP: Final = 1e-9
# Maximum number of steps: bisection alone needs no more.
_STEPS: Final = 60
# Relative fall of g that is rounding error.
_DIP: Final = 1e-12
# Halvings of the interval between two points of a subpanel, to 4e-15 of it.
_BISECTIONS: Final = 48
# Points evaluated at once: their arrays stay in cache.
_BLOCK: Final = 2048


class Dips(NamedTuple):
    """Intervals of the radius in which g lies below an earlier value, each of shape (m,)."""

    begin: Array
    end: Array
    """Ends [length]; the table's end where g does not reach its earlier value again."""
    top: Array
    bottom: Array
    """Earlier and lowest value of g [length]."""

    @property
    def depth(self) -> Array:
        """Fall of g [length]."""
        return self.top - self.bottom


@dataclass(frozen=True, eq=False)
class Subpanels:
    """Depth g and half force int x dg of a contact as polynomials in u = s/length."""

    edges: Array
    """Ends of the subpanels, from the axis or the flat's edge on [length], shape (k + 1,)."""
    length: Array
    """s at the right end of each subpanel [length], shape (k,)."""
    depth: Array
    """Coefficients of u, u^2, ... of g above its value at the left edge [length], shape (k, n)."""
    half_force: Array
    """Coefficients of u, u^2, ... of int x dg above its left edge [length^2], shape (k, n)."""
    at_edges: Array
    """Depth, half force and energy / E* at each edge, shape (3, k + 1)."""
    error: float
    """Largest of the last coefficients, relative to the largest value of a subpanel."""

    @cached_property
    def _degrees(self) -> Array:
        """n of the powers, from 1 on."""
        return np.arange(1.0, self.depth.shape[1] + 1)

    @cached_property
    def _shares(self) -> Array:
        """n/(m + n) of the powers m and n, shape (m, n)."""
        return self._degrees / np.add.outer(self._degrees, self._degrees)

    def depth_at(self, panel: Indices, s: Array) -> Array:
        """Return g at s in the given subpanels [length], shape (m,)."""
        above = _sum(self.depth, panel, s / self.length[panel])
        return np.asarray(self.at_edges[0, panel] + above)

    def half_force_at(self, panel: Indices, s: Array) -> Array:
        """Return int_0^x y dg(y) at s in the given subpanels [length^2], shape (m,)."""
        above = _sum(self.half_force, panel, s / self.length[panel])
        return np.asarray(self.at_edges[1, panel] + above)

    def energy_at(self, panel: Indices, s: Array) -> Array:
        """Return int F/E* dg at s in the given subpanels [length^3], shape (m,)."""
        powers = (s / self.length[panel])[:, None] ** self._degrees
        depth, half = self.depth[panel] * powers, self.half_force[panel] * powers
        # int (sum h_m u^m) d(sum d_n u^n) = sum h_m d_n n/(m + n) u^(m + n).
        product = (half @ self._shares * depth).sum(axis=1)
        below = self.at_edges[1, panel] * depth.sum(axis=1)
        return np.asarray(self.at_edges[2, panel] + 2 * (below + product))

    def slope_at(self, panel: Indices, s: Array) -> tuple[Array, Array]:
        """Return dg/ds at s in the given subpanels as J + s R: J [1] and R [1/length], (m,).

        J is the jump of f' at the left edge, on the axis the limit of g'.
        """
        length, degrees = self.length[panel], self._degrees
        jump, first = self.depth[panel, 0] / length, 2 * self.depth[panel, 1]
        rest = _sum(self.depth[:, 2:], panel, s / length, degrees[2:])
        return jump, (first + rest) / np.square(length)

    @property
    def weight(self) -> Array:
        """Coefficients of the powers of u, from 0 on, of dg/ds [1], shape (k, n)."""
        return self.depth * self._degrees / self.length[:, None]

    @cached_property
    def over_axis(self) -> Array:
        """int_0^x dg/x at each edge [1], shape (k + 1,); for a profile without a flat."""
        panel = np.arange(self.length.size)
        return np.append(0.0, np.cumsum(self._beyond_edge(panel, self.length)))

    def over_axis_at(self, panel: Indices, s: Array) -> Array:
        """Return int_0^x dg/x at s in the given subpanels [1], shape (m,)."""
        return self.over_axis[panel] + self._beyond_edge(panel, s)

    def _beyond_edge(self, panel: Indices, s: Array) -> Array:
        """Part of `over_axis` beyond the left edge, of which dg/ds vanishes."""
        nodes, weights = gauss_legendre(_AXIS_NODES)
        at = s[:, None] * (1 + nodes) / 2
        x = np.hypot(self.edges[panel, None], at)
        _, rest = self.slope_at(np.repeat(panel, nodes.size), at.ravel())
        return (rest.reshape(at.shape) * at / x) @ weights * s / 2

    def increase(self, panel: Indices, x: Array) -> Array:
        """Return x int max(h', 0)/t dt from 0 to x, h = g'(t)/t, by an upper bound [1/length].

        Infinite where g' jumps. Source: notes, §7.
        """
        # In the first subpanel, next to a spline's end, h' may be large.
        return (self._largest[0] * self.edges[1] + self._largest[panel] * x) * x

    @cached_property
    def _largest(self) -> Array:
        """Largest h'(x)/x in the first subpanel, then that from the second up to each of them."""
        u, degrees = fit_points(FEW)[0], self._degrees
        curved = self.depth[:, 2:] * (degrees * (degrees - 2))[2:]
        own = (curved @ u ** (degrees[2:, None] - 4.0)).max(axis=1) / self.length**4
        own = np.where(self.depth[:, 0] > 0, np.inf, np.maximum(own, 0.0))
        return np.append(own[0], np.maximum.accumulate(own[1:]))

    def dips(self) -> Dips:
        """Return the dips of g, found at a dozen points of each subpanel and its maxima between."""
        u = np.append(fit_points(FEW)[0], 1.0)
        degrees = self._degrees
        # The slope may vanish at the left edge itself.
        ends = np.append(u[0] / 100, u)
        rises = (self.depth * degrees) @ ends ** (degrees[:, None] - 1) > 0
        if rises.all():
            return Dips(*np.empty((4, 0)))
        powers = u ** degrees[:, None]
        g = np.append(0.0, self.at_edges[0, :-1, None] + self.depth @ powers)
        s = np.append(0.0, np.multiply.outer(self.length, u))
        panel = np.append(0, np.repeat(np.arange(self.length.size), u.size))
        at, top = self._maxima(ends, rises)
        place = at * u.size + np.searchsorted(u, top) + 1
        top = top * self.length[at]
        g = np.insert(g, place, self.depth_at(at, top))
        s, panel = np.insert(s, place, top), np.insert(panel, place, at)
        highest = np.maximum.accumulate(g)
        below = g < highest * (1 - _DIP)
        if not below.any():
            return Dips(*np.empty((4, 0)))
        first = np.flatnonzero(below & ~np.append(False, below[:-1]))
        last = np.flatnonzero(below & ~np.append(below[1:], False))
        bottom = np.minimum.reduceat(g, np.stack([first, last], axis=1).ravel())[::2]
        # g is as high again between two points, the first of which may be a left edge.
        after = np.minimum(last + 1, g.size - 1)
        low, high = np.where(panel[after] > panel[last], 0.0, s[last]), s[after]
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            rises = self.depth_at(panel[after], middle) < highest[first]
            low, high = np.where(rises, middle, low), np.where(rises, high, middle)
        end = np.where(after > last, self.radius(panel[after], high), self.edges[-1])
        begin = self.radius(panel[first - 1], s[first - 1])
        return Dips(begin, end, highest[first], np.minimum(bottom, g[last]))

    def _maxima(self, u: Array, rises: Flags) -> tuple[Indices, Array]:
        """Return subpanel and u of the maxima of g between the ascending points u (m,).

        `rises` are the points at which its slope is positive, shape (k, m).
        """
        panel, place = np.nonzero(rises[:, :-1] & ~rises[:, 1:])
        low, high = u[place], u[place + 1]
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            up = _sum(self.depth, panel, middle, self._degrees) > 0
            low, high = np.where(up, middle, low), np.where(up, high, middle)
        return panel, low

    def radius(self, panel: Indices, s: Array) -> Array:
        """Return the radius at s in the given subpanels [length], an edge at its ends."""
        x = np.hypot(self.edges[panel], s)
        return np.where(s == self.length[panel], self.edges[panel + 1], x)

    def inverse(self, quantity: int, target: Array) -> tuple[Indices, Array]:
        """Return subpanel and s at which depth (0) or half force (1) has the given value, (m,).

        Newton's method in log u; a step out of the bracket is replaced by the middle.
        """
        if target.size > _BLOCK:
            blocks = [target[i : i + _BLOCK] for i in range(0, target.size, _BLOCK)]
            panels, places = zip(*(self.inverse(quantity, block) for block in blocks), strict=True)
            return np.concatenate(panels), np.concatenate(places)
        values, rows = self.at_edges[quantity], (self.depth, self.half_force)[quantity]
        panel = values[1:-1].searchsorted(target)
        above, whole = target - values[panel], values[panel + 1] - values[panel]
        positive = (above > 0) & (whole > 0)
        goal, whole = np.where(positive, above, 1.0), np.where(positive, whole, 1.0)
        # Both grow nearly in proportion to x - b, and so to s^2.
        u = np.sqrt(np.minimum(goal / whole, 1.0))
        low, high, done = np.zeros_like(u), np.ones_like(u), ~positive
        terms = rows[panel]
        rises = terms * self._degrees
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            for _ in range(_STEPS):
                powers = _powers(u, rows.shape[1])
                value = np.vecdot(terms, powers)
                moved = u * np.exp(np.log(goal / value) * value / np.vecdot(rises, powers))
                below = value < goal
                low, high = np.where(below, u, low), np.where(below, high, u)
                moved = np.where((moved >= low) & (moved <= high), moved, (low + high) / 2)
                done |= np.abs(moved - u) <= _LAST_STEP * u
                u = moved
                if every(done):
                    break
        return panel, np.where(positive, u, 0.0 * above) * self.length[panel]


def _sum(rows: Array, panel: Indices, u: Array, factors: Array | None = None) -> Array:
    """sum_n f_n c_n u^n, n from 1 on, with the coefficients c of each point's subpanel."""
    if u.size > _BLOCK:
        blocks = [slice(i, i + _BLOCK) for i in range(0, u.size, _BLOCK)]
        return np.concatenate([_sum(rows, panel[part], u[part], factors) for part in blocks])
    terms = rows[panel] if factors is None else rows[panel] * factors
    return np.asarray(np.vecdot(terms, _powers(u, terms.shape[1])))


def _powers(u: Array, count: int) -> Array:
    """Powers of u from 1 to `count`, shape (m, count)."""
    return np.multiply.accumulate(u.repeat(count).reshape(u.size, count), axis=1)
