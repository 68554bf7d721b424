"""Abel transform of a function that is quadratic between the radii of a table.

Next to a point x, the integral over a panel is that of the same polynomial from the panel's left
end to x less that from its right end to x. With r = end + (x - end) y each of them has the weight
1/sqrt(1 - y) and a smooth positive remainder: both are free of cancellation, however narrow the
panel and however far from the axis. Panels farther below are summed as multipoles.

Source: notes, §5.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.abel.multipole import Multipoles, add, multipoles, pairs, panel_sums
from mdr_core.cached import cached_property
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Indices

# Gauss's rule for int_0^1 h(y)/sqrt(1 - y) dy: h = 1/sqrt(1 + e y), e <= 1, is singular beyond
# y = -1, so that n nodes leave (3 + sqrt(8))^-2n, here 5e-16.
_NODES, _WEIGHTS = (part[10:] for part in gauss_legendre(20))
_Y: Final = 1 - np.square(_NODES)
# For the powers 0 to 2 of y (3, nodes).
_RULE: Final = 2 * _WEIGHTS * _Y ** np.arange(3)[:, None]
# Points in a panel that become masses.
_MASSES: Final = 16
# Powers of a block in the far field: they leave 7.3^-15 = 1e-13 of the block's part, and 1e-14 of
# the whole in the bank of tables.
_POWERS: Final = 15
# Jumps of the function within rounding, over its largest terms on both sides.
_ROUNDING: Final = 256 * float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class PiecewiseQuadratic:
    """F(r) = c0 + c1 u + c2 u^2 + impulse delta(u), u = r - left edge, on each panel."""

    edges: Array
    """Ends of the panels, ascending from the axis [length], shape (k + 1,)."""
    coefficients: Array
    """c0, c1 and c2, shape (3, k)."""
    impulses: Array
    """Weights of Dirac impulses at the left edges, shape (k,)."""

    def transform(self, base: Array, offset: Array) -> Array:
        """Return int_0^x F dr/sqrt(x^2 - r^2) at ascending x = base + offset, shape (m,).

        Next to an edge `base` only the offset carries the distance from it. An impulse at `base`
        itself is left out, whatever the offset.
        """
        place = base + offset
        far = self._multipoles
        low, high = far.far_from(place, 0, self.edges.size)
        total = far.sums(base, offset, low, high)
        # A point may lie above an edge by less than the rounding of its radius.
        begin = np.searchsorted(place, self.edges[:-1])
        end = np.maximum(low[: begin.size], begin)
        for panels, counts, point in pairs(begin, end):
            add(total, point, self._near(panels, counts, base[point], offset[point]))
        return total

    @cached_property
    def _multipoles(self) -> Multipoles:
        nodes, weights = gauss_legendre(_MASSES)
        left, right = self.edges[:-1], self.edges[1:]
        width, share = right - left, (1 + nodes)[:, None] / 2
        u, c0, c1, c2 = width * share, *self.coefficients
        masses = (c0 + u * (c1 + u * c2)) * width * weights[:, None] / 2
        # Distance from the right end over the length, both in x^2.
        v = (1 - share) * (right + left + u) / (right + left)
        sums = panel_sums(v, masses, _POWERS)
        sums += panel_sums(np.ones((1, 1)), self.impulses[None], _POWERS)
        return multipoles(self.edges, sums, above=True)

    def _near(self, panels: slice, counts: Indices, base: Array, offset: Array) -> Array:
        """Integral over the part of each panel that lies below its points."""
        left, right = (part[panels].repeat(counts) for part in (self.edges[:-1], self.edges[1:]))
        above = (base - left) + offset
        c = self.coefficients[:, panels].repeat(counts, axis=1)
        total = _from_end(c, left, np.maximum(above, 0.0))
        over = np.flatnonzero((base - right) + offset > 0)
        # Continue the polynomial beyond the panel, and subtract what lies there.
        u = (right - left)[over]
        c0, c1, c2 = c.take(over, axis=1)
        moved = np.stack([c0 + u * (c1 + u * c2), c1 + 2 * u * c2, c2])
        total[over] -= _from_end(moved, right[over], ((base - right) + offset)[over])
        impulse = self.impulses[panels].repeat(counts)
        seen = np.flatnonzero((impulse != 0) & (above > 0) & (base != left))
        gap = above[seen]
        total[seen] += impulse[seen] / np.sqrt(gap) / np.sqrt(2 * left[seen] + gap)
        return total


def _from_end(c: Array, end: Array, above: Array) -> Array:
    """int_end^x (c0 + c1 u + c2 u^2) dr/sqrt(x^2 - r^2), u = r - end, x = end + above.

    With u = y above the other root is that of 2 end + above (1 + y), smooth in y.
    """
    span = 2 * end + above
    part = above / np.where(span > 0, span, 1.0)
    root = np.multiply.outer(_Y, part)
    root += 1
    np.sqrt(root, out=root)
    np.divide(1.0, root, out=root)
    m0, m1, m2 = (_RULE @ root) * c
    return np.asarray((m0 + above * (m1 + above * m2)) * np.sqrt(part))


def slope_source(edges: Array, slope: Array) -> tuple[PiecewiseQuadratic, Array]:
    """Return (r f')' for a slope f' that is quadratic on each panel, and the jumps of f'.

    Source: notes, §1.

    Parameters
    ----------
    edges : ends of the panels, ascending from the axis [length], shape (k + 1,).
    slope : coefficients of the powers 0 to 2 of the distance from the left edge, shape (3, k).

    Returns
    -------
    The transform of the first is g', but for the poles of the jumps at the left edges, shape (k,);
    the slope is zero below the first edge.
    """
    left, width = edges[:-1], edges[1:] - edges[:-1]
    c0, c1, c2 = slope
    at_right = c0 + width * (c1 + width * c2)
    terms = np.abs(c0) + width * (np.abs(c1) + width * np.abs(c2))
    jumps = c0 - np.append(0.0, at_right[:-1])
    jumps[np.abs(jumps) <= _ROUNDING * np.maximum(terms, np.append(0.0, terms[:-1]))] = 0.0
    rows = np.stack([c0 + left * c1, 2 * (c1 + left * c2), 3 * c2])
    return PiecewiseQuadratic(edges, rows, jumps * left), jumps
