"""The two-limit stress kernel of functions known as panels."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.abel.displacement import Branch
from mdr_core.abel.panels import Jumps, bisect
from mdr_core.abel.roots import leg, one_sided
from mdr_core.lazy import cached_property
from mdr_core.quadrature import Analytic, gauss_legendre
from mdr_core.typing import Array, Flags, Indices

_FAR_NODES: Final = 16
# A panel is far when the kernel's root is this many panel lengths away from it.
_FAR: Final = 1.25
_BLOCK: Final = 64
# The axis of the first panel: nearer than this nothing changes for a function smooth there.
_AXIS: Final = 1e-8
# G(0) below this, relative to the largest G, is what an interpolation leaves of a smooth tip.
_TIP: Final = 1e-6
# The panels' polynomials have degree 23.
_POLYNOMIALS: Final = Analytic(growth=12.0, fewest=24)
_NEGLIGIBLE: Final = 1e-16
_EPS: Final = float(np.finfo(float).eps)


@dataclass(frozen=True)
class StressPanels:
    """G = g' on [0, end] as polynomials in s = sqrt(x^2 - b^2), b the panel's own break.

    There the root that G carries at b is gone; what remains of a jump, `pole`/s, is kept apart.
    All arrays have one entry a panel; `coefficients` are Chebyshev, on [start, stop] in s.
    """

    base: Array
    start: Array
    stop: Array
    pole: Array
    coefficients: Array
    error: float

    @cached_property
    def branches(self) -> tuple[Branch, ...]:
        """The panels as stretches for the displacement integrals."""
        return tuple(self._branch(panel) for panel in range(self.base.size))

    def _branch(self, panel: int) -> Branch:
        base, start, stop = (float(part[panel]) for part in (self.base, self.start, self.stop))
        middle, half = (start + stop) / 2, (stop - start) / 2
        pole, row = float(self.pole[panel]), self.coefficients[panel]

        def weight(x: Array, s: Array, _index: Indices) -> Array:
            value = chebyshev.chebval(np.clip((s - middle) / half, -1, 1), row)
            return np.asarray((value * s + pole) / x)

        return Branch(base, weight, float(np.hypot(base, stop)), start=float(np.hypot(base, start)))

    def kernel(
        self,
        a: Array,
        r: Array,
        rtol: float,
        width: Array | None = None,
        inner: Array | None = None,
    ) -> Array:
        """Return int_max(r,c)^a G(x)/sqrt(x^2 - r^2) dx, c = a - width.

        a of shape () or (m,), r of shape (m,), r < a. Source: mdr-5, Eqs. (5.68), (5.70).
        """
        a = np.broadcast_to(a, r.shape)
        width = a if width is None else np.broadcast_to(width, r.shape)
        c = a - width if inner is None else np.broadcast_to(inner, r.shape)
        result = np.empty_like(r)
        for begin in range(0, r.size, _BLOCK):
            part = slice(begin, begin + _BLOCK)
            result[part] = self._block(a[part], r[part], c[part], width[part], rtol)
        return result

    def _block(self, a: Array, r: Array, c: Array, width: Array, rtol: float) -> Array:
        base, start, stop = self.base[:, None], self.start[:, None], self.stop[:, None]
        leg_a, leg_c, leg_r = leg(a, base), leg(c, base), leg(r, base)
        low, high = np.maximum(start, leg_c), np.minimum(stop, leg_a)
        used = (high > np.maximum(low, leg_r)) & (a > base)
        # The root at r inside the panel: the rule starts on it, at y = 0, even in y.
        on_root = leg_r >= low
        shift = (base - r) * (base + r)
        distance = np.where(
            shift > 0, np.sqrt(start * start + np.maximum(shift, 0.0)), start - leg_r
        )
        whole = used & ~on_root & (low == start) & (high == stop)
        far = whole & (distance > _FAR * (stop - start))
        total = self._far(r, far)
        panel, point = np.nonzero(used & ~far)
        bottom = np.where(on_root, 0.0, low)
        with np.errstate(divide="ignore", invalid="ignore"):
            annulus = width * (a + c) / (leg_a + leg_c)
        cut_twice = (low == leg_c) & (high == leg_a) & ~on_root & (leg_c > 0)
        span = np.where(cut_twice, annulus, high - bottom)
        edge = np.where(high == leg_a, a, np.hypot(base, stop))
        near = self._near(
            panel,
            r[point],
            high[panel, point],
            span[panel, point],
            edge[panel, point],
            rtol,
        )
        return np.asarray(total + np.bincount(point, weights=near, minlength=r.size))

    def _far(self, r: Array, far: Array) -> Array:
        """Fixed nodes, shared by all points, for the panels that the root does not touch."""
        panels = np.flatnonzero(far.any(axis=1))
        if not panels.size:
            return np.zeros_like(r)
        x, weights = self._fixed
        x, weights = x[panels][:, :, None], weights[panels][:, :, None]
        mask = far[panels][:, None, :]
        gap = np.where(mask, (x - r) * (x + r), 1.0)
        return np.asarray((np.where(mask, weights, 0.0) / np.sqrt(gap)).sum(axis=(0, 1)))

    @property
    def _fixed(self) -> tuple[Array, Array]:
        """Nodes x and weights G dx of every whole panel, (panels, nodes)."""
        nodes, weights = gauss_legendre(_FAR_NODES)
        half = (self.stop - self.start)[:, None] / 2
        s = self.start[:, None] + half * (1 + nodes)
        x = np.hypot(self.base[:, None], s)
        values = chebyshev.chebvander(nodes, self.coefficients.shape[1] - 1)
        regular = self.coefficients @ values.T
        return x, half * weights * (regular * s + self.pole[:, None]) / x

    def _near(
        self, panel: Indices, r: Array, high: Array, span: Array, edge: Array, rtol: float
    ) -> Array:
        """Two-root rule on each pair of a panel and a point, from high - span to high in s."""
        base, start, stop = self.base[panel], self.start[panel], self.stop[panel]
        middle, half = (start + stop) / 2, (stop - start) / 2
        pole, rows = self.pole[panel], self.coefficients[panel].T

        def weight(x: Array, s: Array, index: Indices) -> Array:
            u = np.clip((s - middle[index]) / half[index], -1, 1)
            value = chebyshev.chebval(u, rows[:, None, index], tensor=False)
            return np.asarray((value * s + pole[index]) / x)

        on_axis = (r == 0) & (base == 0)
        result = one_sided(
            weight,
            base,
            np.where(on_axis, _AXIS * high, r),
            high,
            width=span,
            edge=edge,
            odd=False,
            rtol=rtol,
            analytic=_POLYNOMIALS,
        )
        if on_axis.any():
            # G(0) > 0 is a tip, and the integral of G/x over it infinite.
            left = np.abs(chebyshev.chebval(-1.0, rows))
            tip = left > _TIP * np.abs(self.coefficients).max()
            result[on_axis & tip & (start == 0)] = np.inf
        return result


def stress_panels(
    slope: Callable[[Array, Array], Array], edges: Array, jumps: Jumps
) -> StressPanels:
    """Resolve G = g' between the given edges, each panel in s about its own left edge.

    `slope(base, offset)` is G(base + offset) without the pole of the jump at `base`.

    Source: notes, §5.

    Parameters
    ----------
    edges : the ends of the smooth pieces, ascending [length], shape (k + 1,).
    jumps : of f', at some of the edges.

    Raises
    ------
    AccuracyError : G is not piecewise smooth.

    Examples
    --------
    Eq. (5.38): the integral is (2/R) sqrt(a^2 - r^2) for the paraboloid, g' = 2 x/R, here R = 1.

    >>> none = Jumps(np.empty(0), np.empty(0))
    >>> panels = stress_panels(lambda base, offset: 2 * (base + offset), np.array([0, 2.0]), none)
    >>> value = panels.kernel(np.array([1.0]), np.array([0.0, 0.6]), 1e-12)
    >>> [float(f"{each:.6g}") for each in value]
    [2.0, 1.6]
    """
    base = edges[:-1]
    last = leg(edges[1:], base)
    intervals = np.stack([np.zeros_like(last), last], axis=1)

    def in_s(s: Array, tags: Indices) -> Array:
        b = base[tags]
        offset: Array = s * s / (b + np.hypot(b, s))
        return slope(b, offset)

    def blur(s: Array, tags: Indices) -> Array:
        # x = sqrt(b^2 + s^2) is rounded to eps x, its root s to eps x^2/s.
        return np.asarray(_EPS * (np.square(base[tags]) / s + s))

    # The pressure on the axis holds int G/x and feels G itself there; where G grows towards the
    # axis that pressure is infinite, and elsewhere int G is what counts.
    at_edge = float(np.abs(slope(base[-1:], edges[-1:] - base[-1:]))[0])
    at_tip = float(np.abs(slope(base[:1], edges[1:2]))[0] * edges[1])

    def tip_is_done(high: Array, largest: Array) -> Flags:
        steep = (largest > at_edge) & (high * largest <= _NEGLIGIBLE * at_tip)
        return np.asarray(steep | (largest <= _NEGLIGIBLE * at_edge))

    places, tags, coefficients, error = bisect(
        in_s, intervals, np.arange(base.size), blur, tip_is_done
    )
    pole = np.zeros_like(base)
    pole[np.searchsorted(base, jumps.at)] = jumps.at * jumps.size
    return StressPanels(base[tags], places[:, 0], places[:, 1], pole[tags], coefficients, error)
