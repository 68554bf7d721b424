"""B-splines of a table's slope g', with the images of jumps at declared breaks.

Source: notes, §5.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.interpolate import BSpline, PPoly
from scipy.sparse import csr_array

from mdr_core.abel.slope_pieces import SlopePieces, heights
from mdr_core.profiles.table_points import TablePoints
from mdr_core.profiles.truncated import RoundedPunch, Truncated, TruncatedCone
from mdr_core.typing import Array, Flags, Indices

# Largest degree of the slope: the error of 20 points of a sphere is a tenth of that of a cubic.
_DEGREE: Final = 5
# Derivative of the slope whose mean square is the roughness: that of a parabola is zero.
_ROUGH: Final = 3
# Largest number of points that are knots, and the power of their share by which the step between
# knots grows beyond it, by trial: 2000 points of a sphere err by 6e-11, and a hyperboloid whose tip
# lies within the first of 1000 radii by 4e-4.
_KNOTS, _GROWTH = 130, 1.6
# Least radius of a knot over the last one: the third derivative over a smaller step would be
# rounding error of the heights.
_LEAST_KNOT: Final = 1e-5
# Knot next to the axis, over the first one at a point: a tip that is finer than the step between
# the points is smooth in as many random tables as with 0.1 or 0.3, and more than without.
_TIP: Final = 0.2
# Points of a piece at which the sign of an interpolant is tested.
_TESTED: Final = 8


@dataclass(frozen=True, eq=False)
class TableFit:
    """Slope of a table's equivalent profile, and what the points leave open. Dimensional."""

    pieces: SlopePieces
    """Slope g' without the images of jumps."""
    jumps: list[float]
    """Jumps of the slope [1] and of the curvature [1/length], in turn, at each declared break."""
    rms: float
    """Root mean square of the deviation from the points [length]."""
    largest: tuple[float, float]
    """Largest deviation and its radius [length]."""
    spread: tuple[BSpline, BSpline, BSpline]
    """Possible deviations of g', g and its integral, as functions of a over the last radius."""
    spread_of_jumps: tuple[tuple[Truncated, Array], ...]
    """Images of unit jumps over the last radius, and possible deviations of the jumps, (n,)."""
    scale: tuple[float, float]
    """Last radius and height of the table [length]."""
    rival: float
    """Probability of a tip of the other kind, sharp or smooth [1]."""
    deciding: float
    """Radius of the point without which the profile would change most [length]."""

    def spread_at(self, radius: Array) -> tuple[Array, Array, Array]:
        """Sizes of the errors of g, int_0^a x g' dx and int_0^a g dx that the points leave open."""
        end, height = self.scale
        a = np.ravel(radius) / end
        depth, moment = (each(a).reshape(a.size, -1) for each in self.spread[1:])
        for shape, jump in self.spread_of_jumps:
            own = shape.g(a)
            depth = depth + np.outer(own, jump)
            moment = moment + np.outer(a * own - shape.force_within(a) / 2, jump)
        errors = depth, a[:, None] * depth - moment, moment
        units = height, end * height, end * height
        return tuple(
            (unit * np.sqrt(np.square(error).sum(axis=1))).reshape(np.shape(radius))
            for unit, error in zip(units, errors, strict=True)
        )

    def spread_of(self, radius: Array, kernel: Array) -> Array:
        """Sizes of the errors of sum_j kernel_ij g'(radius_ij) that the points leave open, (m,).

        Parameters
        ----------
        radius, kernel : radii and their factors, shape (m, n).
        """
        (end, height), slope = self.scale, self.spread[0]
        x, rows = radius / end, np.arange(0, radius.size + 1, radius.shape[1])
        sums = csr_array((kernel.ravel(), np.arange(radius.size), rows))
        basis = BSpline.design_matrix(np.minimum(x.ravel(), 1.0), slope.t, slope.k)
        error = (sums @ basis).toarray() @ slope.c.reshape(slope.c.shape[0], -1)
        for shape, jump in self.spread_of_jumps:
            error = error + np.outer((kernel * shape.dg(x)).sum(axis=1), jump)
        return np.asarray(height / end * np.sqrt(np.square(error).sum(axis=1)))


class TableBasis:
    """B-splines of the slope and the images of jumps at breaks, with their heights at the points.

    Columns: the splines but the first, two jumps for each break, the offset of the heights, and the
    first spline, which is the slope on the axis.
    """

    def __init__(self, points: TablePoints) -> None:
        x = np.append(0.0, points.x[points.distinct & (points.x > _LEAST_KNOT)])
        count = x.size - (points.x[0] > 0)
        self.degree = k = min(max(count - 2 - 2 * len(points.breaks), 2), _DEGREE)
        self.order = min(_ROUGH, k)
        share = np.linspace(0, 1, min(x.size, _KNOTS))
        # Of more points the nearest to the tip are knots, and from there the step grows.
        places = share * (share.size - 1) + share**_GROWTH * (x.size - share.size)
        knots = x[places.round().astype(int)]
        if _TIP * knots[1] > _LEAST_KNOT:
            knots = np.insert(knots, 1, _TIP * knots[1])
        self.points, self.knots = points, knots
        self.t = np.concatenate([[0.0] * k, knots, [1.0] * k])
        self.size = self.t.size - k - 1
        x = points.x
        splines = heights(knots, x, lambda at: BSpline.design_matrix(at, self.t, k))
        self.shapes = [
            kind(b, 1.0) for b in points.breaks for kind in (TruncatedCone, RoundedPunch)
        ]
        jumps = [shape.f(x) for shape in self.shapes]
        self.heights = np.column_stack([splines[:, 1:], *jumps, np.ones_like(x), splines[:, 0]])

        self.weighted = self.heights * points.weight[:, None], points.y * points.weight
        """Heights of the columns, and of the points, times the weights of the points."""

    @cached_property
    def triangle(self) -> tuple[Array, Array]:
        """Orthogonal columns (points, n) and triangle of the heights of `by_roughness`, weighted.

        A product with heights before the triangle has no cancellation: their coefficients rise.
        """
        return np.linalg.qr(self.weighted[0] @ np.hstack(self.by_roughness))

    @cached_property
    def places(self) -> Array:
        """Coefficients of the slope x."""
        return sliding_window_view(self.t[1:-1], self.degree).mean(axis=1)

    def closed(self, jumps: Flags) -> Indices:
        """Columns of the slopes that do not jump; `jumps` at the axis and at each break."""
        return np.append(-1, np.arange(self.size - 1, self.heights.shape[1] - 2, 2))[~jumps]

    def padded(self, splines: Array) -> Array:
        """Return rows over the splines (n, size) as rows over all columns."""
        rest = np.zeros((len(splines), self.heights.shape[1] - self.size))
        return np.hstack([splines[:, 1:], rest, splines[:, :1]])

    @cached_property
    def _spans(self) -> list[Array]:
        """Steps by which differences of coefficients are divided, for each derivative."""
        k, t, size = self.degree, self.t, self.size
        return [
            (t[k + 1 : k + 1 + size - o] - t[o:size]) / (k - o + 1)
            for o in range(1, self.order + 1)
        ]

    @cached_property
    def roughness(self) -> Array:
        """Rows of which the sum of squares is the roughness, from the end to the axis.

        Coefficients of the rough derivative, weighted by the root of the support of its splines.
        """
        rows = np.eye(self.size)
        for span in self._spans:
            rows = np.diff(rows, axis=0) / span[:, None]
        return self.padded(rows * np.sqrt(self._spans[-1])[:, None])[::-1]

    def grading(self, share: float) -> Array | float:
        """Weight of each row of a roughness that grows towards the axis or, if < 0, the end.

        Parameters
        ----------
        share : distance from which it grows over the step there; infinite for an even one.
        """
        if np.isinf(share):
            return 1.0
        o, x = self.order, self.knots
        place = sliding_window_view(self.t[o:-o], self.degree - o + 2).mean(axis=1)[::-1]
        start = abs(share) * (x[1] if share > 0 else x[-1] - x[-2])
        return (((place if share > 0 else 1 - place) + start) / (1 + start)) ** (o - 0.5)

    @cached_property
    def by_roughness(self) -> tuple[Array, Array]:
        """Coefficients (columns, n) of what has no roughness, and of the others.

        The first have jumps of the slope at the axis and at each break before them. Each of the
        others has one row of the roughness that is 1.
        """
        first, *others = self._spans
        slopes = sliding_window_view(self.t[2:-2], self.degree - 1).mean(axis=1)
        square = np.append(0.0, np.cumsum(2 * slopes * first))
        powers = np.stack([np.ones(self.size), self.places, square])[: self.order]
        # Higher derivatives are zero at the end and the slope on the axis: sums of one sign.
        rough = np.diag(1 / np.sqrt(others[-1]))
        for span in others[::-1]:
            rough = np.cumsum((span[:, None] * rough)[::-1], axis=0)[::-1]
            rough = np.pad(rough, ((0, 1), (0, 0)))
        rough = np.pad(np.cumsum(first[:, None] * rough, axis=0), ((1, 0), (0, 0)))
        rough *= (-1.0) ** (self.order - 1)
        smooth = self.padded(powers)
        own = np.eye(self.heights.shape[1])[self.size - 1 : -1]
        ordered = np.vstack([smooth[:1], own[:-1:2], smooth[1:], own[1::2], own[-1:]])
        # The largest come first, so that the small ones keep their digits in decompositions.
        return ordered.T, self.padded(rough.T).T[:, ::-1]

    def spline(self, coefficients: Array) -> BSpline:
        """Slope, or several, of coefficients over all columns."""
        splines = np.concatenate([coefficients[-1:], coefficients[: self.size - 1]])
        return BSpline(self.t, splines, self.degree)

    def slopes(self, coefficients: Array) -> Array:
        """Return g' at places in every piece."""
        knots = self.knots
        share = (np.arange(_TESTED) + 0.5) / _TESTED
        x = np.append((knots[:-1, None] + np.diff(knots)[:, None] * share).ravel(), 1.0)
        slope = self.spline(coefficients)(x)
        for shape, jump in zip(self.shapes, coefficients[self.size - 1 : -2], strict=True):
            if jump != 0:
                slope += jump * shape.dg(x)
        return slope

    def deviation(self, coefficients: Array) -> Array:
        """Heights less those of the points."""
        return self.heights @ coefficients - self.points.y

    def fit(self, coefficients: Array, spread: Array, rival: float, point: int) -> TableFit:
        """Return the fit of coefficients. Parameters: see `TableFit`."""
        end, height = self.points.scale
        polynomials: Any = PPoly.from_spline(self.spline(coefficients).tck)
        rows = polynomials.c[::-1, np.diff(polynomials.x) > 0]
        rows[0, 0] = coefficients[-1]
        powers = height / end * end ** -np.arange(float(len(rows)))[:, None]
        jumps = coefficients[self.size - 1 : -2].reshape(-1, 2) * [height / end, height / end**2]
        off = self.deviation(coefficients)
        worst = int(np.argmax(np.abs(off)))
        possible = self.spline(spread)
        many = spread.reshape(len(spread), -1)
        return TableFit(
            SlopePieces(self.knots * end, rows * powers),
            jumps.ravel().tolist(),
            height * root_mean_square(off * np.minimum(self.points.weight, 1.0)),
            (height * float(abs(off[worst])), end * float(self.points.x[worst])),
            (possible, possible.antiderivative(), possible.antiderivative(2)),
            tuple(zip(self.shapes, many[self.size - 1 : -2], strict=True)),
            self.points.scale,
            rival,
            end * float(self.points.x[point]),
        )


def root_mean_square(off: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(off))))
