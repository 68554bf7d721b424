"""Equivalent profile of a table: the smoothest slope g' >= 0 that the points allow.

The slope is a quintic spline in x/R, with the closed images of jumps of slope and curvature at
declared breaks. Heights that a spline of least roughness meets are interpolated. Otherwise they are
taken as measured: generalised cross-validation, or a stated uncertainty, decides how much of their
scatter is noise, and a non-negative least-squares problem keeps the profile admissible.

Source: notes, §5.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from scipy.interpolate import BSpline, PPoly
from scipy.linalg import solve_triangular
from scipy.optimize import nnls
from scipy.sparse.linalg import spsolve

from mdr_core.abel.slope_pieces import heights
from mdr_core.cached import cached_property
from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags

# Largest degree of the slope: the error of 20 points of a sphere is a tenth of that of a cubic.
_DEGREE: Final = 5
# Diagonal of a triangle, over the largest, that is rounding error.
_SINGULAR: Final = 1e-15
# Weight against what few points leave open, beside the roughness.
_FEWEST: Final = 1e-6
# Derivative of the slope whose mean square is the roughness of measured heights: a parabola has
# none.
_ROUGH: Final = 3
# Largest numbers of knots, for heights that are met and for heights that are measured.
_KNOTS, _KNOTS_OF_MEASURED = 200, 80
# Number of radii up to which cross-validation has too few points to tell noise.
_FEW: Final = 12
# Weight of a degree of freedom in cross-validation, against overfitting. Source: kim-gu.
_GCV: Final = 1.2
# Part of the possible degrees of freedom above which no noise is found, and scatter, over the
# height, that is rounding error.
_NO_NOISE, _ROUNDED = 0.8, 1e-8
# Neighbours on each side from which a height is predicted.
_NEIGHBOURS: Final = 3
# Rounded numbers: largest unit over the step between neighbours, remainder that is rounding error,
# and part of a unit within which a number is a multiple.
_FINEST_STEP, _EQUAL, _OF_UNIT = 0.05, 1e-9, 0.05
# Smallest error of a rounded height, over that of most.
_LEAST_ERROR: Final = 1e-2
# Ratios of the weights of roughness and misfit that are tried.
_WEIGHTS: Final = 10.0 ** np.arange(-16, 16.1, 0.25)
# Weight of the points against the roughness of an interpolant.
_HEAVY: Final = 1e6
# Factor by which a sharp tip has to lower the roughness of an interpolant at the first knots to be
# believed, and variances of the noise by which it has to lower the sum of squares.
_SHARPER, _TIP_KNOTS, _SHARPER_MEASURED = 10.0, 4, 12.0
# Gaps between radii that are merged, over their mean spacing at equal radii.
_SAME: Final = 1e-2
# Lowest g'/x, over that of the paraboloid through the last point: g increases strictly.
_FLOOR: Final = 1e-9
# Part of the largest slope that keeps the slope of a flat positive.
_TINY: Final = 1e-15
# Part of the largest slope up to which a negative one of an interpolant is rounding error.
_NEGATIVE: Final = 1e-9
# Deviation from the points, root mean square over the height, from which the shape has no contact
# area that is a single disc.
_NO_DISC: Final = 0.025
# Standard deviations in the estimate of the error of the data.
_SPREAD: Final = 2.0
# Points of a piece at which the sign of an interpolant is tested.
_TESTED: Final = 8


@dataclass(frozen=True, eq=False)
class TableFit:
    """Slope of a table's equivalent profile, and what the points leave open. Dimensional."""

    edges: Array
    """Knots [length], shape (k + 1,)."""
    rows: Array
    """Coefficients of g' by powers of the distance from the knot below, shape (6, k)."""
    flanks: tuple[tuple[float, float, float], ...]
    """Break [length], jump of the slope [1] and of the curvature [1/length]."""
    rms: float
    """Root mean square of the deviation from the points [length]."""
    largest: tuple[float, float]
    """Largest deviation and its radius [length]."""
    spread: tuple[BSpline, BSpline]
    """Possible deviations of g and of its integral, as functions of a over the last radius."""
    scale: tuple[float, float]
    """Last radius and height of the table [length]."""

    def spread_at(self, radius: Array) -> tuple[Array, Array, Array]:
        """Sizes of the errors of g, int_0^a x g' dx and int_0^a g dx that the points leave open."""
        end, height = self.scale
        a = np.ravel(radius) / end
        depth, moment = (each(a).reshape(a.size, -1) for each in self.spread)
        errors = depth, a[:, None] * depth - moment, moment
        units = height, end * height, end * height
        return tuple(
            (unit * np.sqrt(np.square(error).sum(axis=1))).reshape(np.shape(radius))
            for unit, error in zip(units, errors, strict=True)
        )


@dataclass(frozen=True, eq=False)
class _Points:
    """Points of a table over its last radius and its height, ascending; equal radii merged."""

    x: Array
    y: Array
    weight: Array
    """Weight of the deviation: square root of the number of points that were merged."""
    breaks: tuple[float, ...]
    offset_known: bool
    """True if the first point lies on the axis."""
    rounded: bool
    """True if radii or heights show that they are rounded; the weights are those of that error."""
    scale: tuple[float, float]
    """Last radius and height [length]."""


def fit_table(
    r: Array, f: Array, breaks: Sequence[float] = (), uncertainty: float | None = None
) -> TableFit:
    """Return the smoothest admissible equivalent profile through points, or near them.

    Parameters
    ----------
    r, f : radii, of any sign and order, and heights that rise away from the axis [length], (k,).
    breaks : radii where slope or curvature jumps [length].
    uncertainty : standard uncertainty of the heights [length]; 0 for none, None to estimate it.

    Raises
    ------
    InputError : points of no body whose contact area is a single disc.
    """
    points = _cleaned(np.abs(r), f, breaks)
    if uncertainty is None:
        exact = points.x.size <= _FEW or _has_no_noise(points)
    else:
        exact = uncertainty == 0
    if exact:
        found = _interpolated(points)
    else:
        found = _measured(points, uncertainty and uncertainty / points.scale[1])
    if found.rms > _NO_DISC * points.scale[1]:
        largest, radius = found.largest
        raise InputError(
            ("profile", "f"),
            "no body with a contact area that is a single disc comes near the points: they deviate "
            f"by {100 * largest / points.scale[1]:.2g} % of their height at radius {radius:.3g}; "
            "give the part about the highest point alone, or remove a ring, a hole or outliers",
        )
    return found


def _cleaned(r: Array, f: Array, breaks: Sequence[float]) -> _Points:
    """Sort the points and merge those whose radii differ by less than the spacing resolves."""
    end, height = float(r.max()), float(f.max() - f.min())
    x, y = given = r / end, (f - f.min()) / height
    order = np.argsort(x, kind="stable")
    x, y = x[order], y[order]
    new = np.append(True, np.diff(x) > _SAME * x[1:] / x.size)
    group = np.cumsum(new) - 1
    count = np.bincount(group)
    x, y = np.bincount(group, x) / count, np.bincount(group, y) / count
    x[-1] = 1.0
    curved = np.square(x) - np.mean(np.square(x))
    if y @ curved <= 0:
        raise InputError(
            ("profile", "f"), "the heights fall away from the axis: reverse their sign"
        )
    weight = np.sqrt(count)
    of_radius, of_height = _rounding(*given, x.size) if x.size > 2 else (0.0, 0.0)
    rounded = max(of_radius, of_height) > _ROUNDED
    if rounded:
        # An error of the radius is one of the height on a slope.
        error = np.hypot(of_radius * np.gradient(y, x), of_height)
        typical = float(np.median(error))
        weight = weight * typical / np.maximum(error, _LEAST_ERROR * typical)
    scaled = tuple(b / end for b in breaks)
    return _Points(x, y, weight, scaled, bool(x[0] == 0), rounded, (end, height))


class _Basis:
    """B-splines of the slope and the images of jumps at breaks, with their heights at the points.

    Columns: the splines but the first, two jumps for each break, the offset of the heights, and the
    first spline, which is the slope on the axis.
    """

    def __init__(self, points: _Points, knots: Array) -> None:
        self.degree = k = min(max(points.x.size - 2 - 2 * len(points.breaks), 1), _DEGREE)
        self.points, self.knots = points, knots
        self.t = np.concatenate([[0.0] * k, knots, [1.0] * k])
        self.size = self.t.size - k - 1
        x = points.x
        splines = heights(knots, x, lambda at: BSpline.design_matrix(at, self.t, k))
        past = [np.maximum(x - b, 0.0) for b in points.breaks]
        jumps = [column for each in past for column in (each, each * each / 2)]
        self.heights = np.column_stack([splines[:, 1:], *jumps, np.ones_like(x), splines[:, 0]])

    @cached_property
    def places(self) -> Array:
        """Coefficients of the slope x."""
        return np.array([self.t[i + 1 : i + 1 + self.degree].mean() for i in range(self.size)])

    @property
    def free(self) -> Flags:
        """Columns whose coefficients may be negative: jumps of the curvature and the offset."""
        free = np.zeros(self.heights.shape[1], dtype=bool)
        free[self.size : -2 : 2] = True
        free[-2] = True
        return free

    def padded(self, splines: Array) -> Array:
        """Return rows over the splines (n, size) as rows over all columns."""
        rest = np.zeros((len(splines), self.heights.shape[1] - self.size))
        return np.hstack([splines[:, 1:], rest, splines[:, :1]])

    def _differences(self, order: int) -> Array:
        """Coefficients of a derivative of the splines."""
        k, t, rows = self.degree, self.t, np.eye(self.size)
        for o in range(1, order + 1):
            span = t[k + 1 : k + 1 + self.size - o] - t[o : self.size]
            rows = np.diff(rows, axis=0) * ((k - o + 1) / span)[:, None]
        return rows

    def derivative(self, order: int) -> Array:
        """Coefficients of a derivative, weighted by the root of the support of its splines."""
        inner, degree = self.t[order : self.t.size - order], self.degree - order
        support = (inner[degree + 1 :] - inner[: self.size - order]) / (degree + 1)
        return self.padded(self._differences(order) * np.sqrt(support)[:, None])

    def jumps(self) -> Array:
        """Jumps of the last derivative at the inner knots, times its power of their spacing."""
        spacing = (self.knots[2:] - self.knots[:-2]) / 2
        steps = np.diff(self._differences(self.degree), axis=0)
        return self.padded(steps * spacing[:, None] ** self.degree)

    def spline(self, coefficients: Array) -> BSpline:
        """Slope, or several, of coefficients over all columns."""
        splines = np.concatenate([coefficients[-1:], coefficients[: self.size - 1]])
        return BSpline(self.t, splines, self.degree)

    def deviation(self, coefficients: Array) -> Array:
        """Heights less those of the points."""
        return self.heights @ coefficients - self.points.y

    def fit(self, coefficients: Array, spread: Array) -> TableFit:
        """Return the fit of coefficients; `spread` are possible deviations of them."""
        end, height = self.points.scale
        polynomials: Any = PPoly.from_spline(self.spline(coefficients).tck)
        rows = polynomials.c[::-1, np.diff(polynomials.x) > 0]
        rows[0, 0] = coefficients[-1]
        powers = height / end * end ** -np.arange(float(len(rows)))[:, None]
        jumps = coefficients[self.size - 1 : -2].reshape(-1, 2) * [height / end, height / end**2]
        flanks = tuple(
            (b * end, slope, bend)
            for b, (slope, bend) in zip(self.points.breaks, jumps.tolist(), strict=True)
            if slope or bend
        )
        off = self.deviation(coefficients)
        worst = int(np.argmax(np.abs(off)))
        possible = self.spline(spread)
        return TableFit(
            self.knots * end,
            rows * powers,
            flanks,
            height * _mean(off * np.minimum(self.points.weight, 1.0)),
            (height * float(abs(off[worst])), end * float(self.points.x[worst])),
            (possible.antiderivative(), possible.antiderivative(2)),
            self.points.scale,
        )


def _mean(off: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(off))))


def _knots(points: _Points, most: int) -> Array:
    """Return knots at the axis and at points, every n-th one if there are more than `most`."""
    x = points.x if points.x[0] == 0 else np.append(0.0, points.x)
    if x.size > most:
        x = x[np.unique(np.linspace(0, x.size - 1, most).round().astype(int))]
    return x


def _interpolated(points: _Points) -> TableFit:
    """Return the interpolant of least roughness, or the nearest fit if that is not admissible."""
    basis = _Basis(points, _knots(points, _KNOTS))
    coefficients = _least_roughness(basis)
    # A flat is flat up to rounding errors: g increases there too.
    splines, largest = coefficients[: basis.size - 1], np.abs(coefficients).max()
    rounded = (splines <= 0) & (splines > -_NEGATIVE * largest)
    splines[rounded] = _TINY * largest * basis.places[1:][rounded]
    jumps = coefficients[basis.size - 1 : -2 : 2]
    jumps[np.abs(jumps) < _NEGATIVE * largest] = 0.0
    # Where the slope falls by a step, g' is infinite and negative beyond it.
    if _slopes(basis, coefficients).min() <= 0 or jumps.min(initial=0.0) < 0:
        return _measured(points, 0.0, sharp=coefficients[-1] > 0)
    # The error of every second point, which is larger than that of all.
    half = np.zeros(points.x.size, dtype=bool)
    half[:: max(2, points.x.size // (_KNOTS // 2))] = half[-1] = True
    spread = np.zeros_like(coefficients)
    if half.sum() > 2:
        coarse = replace(points, x=points.x[half], y=points.y[half], weight=points.weight[half])
        other = _Basis(coarse, _knots(coarse, _KNOTS))
        found = _least_roughness(other)
        spread = _between(basis, other, found) - coefficients
    return basis.fit(coefficients, spread)


def _between(basis: _Basis, other: _Basis, coefficients: Array) -> Array:
    """Return the coefficients, in a basis, of a slope in another one with fewer knots."""
    matrix = BSpline.design_matrix(basis.places, basis.t, basis.degree)
    splines = spsolve(matrix.tocsc(), other.spline(coefficients)(basis.places))
    return np.concatenate([splines[1:], coefficients[other.size - 1 : -1], splines[:1]])


def _least_roughness(basis: _Basis) -> Array:
    """Return the coefficients of the interpolant whose last derivative jumps least."""
    points, rows = basis.points, basis.heights
    inner = points.x > 0
    # A height at a small radius is met as accurately, relatively.
    weight = _HEAVY / points.x[inner]
    largest = float(np.abs(basis.heights[:, : basis.size - 1]).max())
    jumps = largest * basis.jumps()
    goal = points.y
    used = np.ones(rows.shape[1], dtype=bool)
    if points.offset_known:
        goal = goal - points.y[0]
        used[-2] = False
    system = np.vstack([rows[inner] * weight[:, None], jumps])[:, used]
    right = np.concatenate([goal[inner] * weight, np.zeros(len(jumps))])
    size = system.shape[1]
    triangle = _triangle(system)
    scale = np.abs(np.diag(triangle))
    if len(system) < size or scale.min() <= _SINGULAR * scale.max():
        # Few points leave coefficients open: a jump of the slope explains more than all else.
        rest = _FEWEST * np.eye(size)
        rest[range(basis.size - 1, size - 2, 2)] *= _FEWEST
        system, right = np.vstack([system, rest]), np.append(right, np.zeros(size))
        triangle = _triangle(system)

    def solved(count: int) -> Array:
        """Solution by the first columns; the last one is the slope on the axis."""
        own, part = triangle[:count, :count], system[:, :count]
        # The points outweigh the roughness: a step of refinement gives their digits back.
        found = np.zeros(size)
        for _ in range(2):
            gradient = part.T @ (right - part @ found[:count])
            found[:count] += solve_triangular(own, solve_triangular(own, gradient, trans="T"))
        return found

    smooth, sharp = solved(size - 1), solved(size)
    next_to_tip = jumps[:_TIP_KNOTS, used]
    roughness = [float(np.linalg.norm(next_to_tip @ each)) for each in (smooth, sharp)]
    is_sharp = roughness[0] > max(_SHARPER * roughness[1], _ROUNDED * largest)
    found = sharp if is_sharp else smooth
    result = np.zeros(rows.shape[1])
    result[used] = found
    if points.offset_known:
        result[-2] = points.y[0]
    return result


def _triangle(system: Array) -> Array:
    """Triangle of the QR decomposition."""
    return np.asarray(np.linalg.qr(system, mode="r"))


def _slopes(basis: _Basis, coefficients: Array) -> Array:
    """Return g' at places in every piece."""
    knots = basis.knots
    x = (knots[:-1, None] + np.diff(knots)[:, None] * (np.arange(_TESTED) + 0.5) / _TESTED).ravel()
    x = np.append(x, 1.0)
    slope = basis.spline(coefficients)(x)
    for b, (jump, bend) in zip(
        basis.points.breaks, coefficients[basis.size - 1 : -2].reshape(-1, 2), strict=True
    ):
        past = x > b
        s = np.sqrt((x[past] - b) * (x[past] + b))
        angle = np.arctan2(s, b)
        slope[past] += jump * (angle + b / s) + bend * (2 * s - b * angle)
    return slope


def _measured(points: _Points, uncertainty: float | None, *, sharp: bool | None = None) -> TableFit:
    """Return the smoothest admissible fit within the uncertainty, or the scatter."""
    basis = _Basis(points, _knots(points, _KNOTS_OF_MEASURED))
    rough = basis.derivative(min(_ROUGH, basis.degree))
    without, with_tip = (_Spectrum(basis, rough, uncertainty, sharp=tip) for tip in (False, True))
    if sharp is None:
        sharp = with_tip.score * (1 + _SHARPER_MEASURED / points.x.size) < without.score
    chosen = with_tip if sharp else without
    coefficients, spread = chosen.coefficients, chosen.deviations()
    used = ~basis.free
    used[-1] = chosen.sharp
    if min(coefficients[used].min(), _slopes(basis, coefficients).min()) < _FLOOR:
        coefficients = _not_negative(basis, rough, chosen)
        scatter = _mean(points.weight * basis.deviation(coefficients))
        spread = spread * max(scatter / chosen.sigma, 1.0)
    return basis.fit(coefficients, spread)


def _not_negative(basis: _Basis, rough: Array, chosen: "_Spectrum") -> Array:
    """Return the fit of the same weight of roughness with g' above the floor."""
    points = basis.points
    result = np.zeros(basis.heights.shape[1])
    result[: basis.size - 1] = 4 * _FLOOR * basis.places[1:]
    used = np.ones(result.size, dtype=bool)
    used[-1] = chosen.sharp
    rough = np.sqrt(chosen.weight) * rough
    system = np.vstack([basis.heights * points.weight[:, None], rough])[:, used]
    right = np.concatenate([-basis.deviation(result) * points.weight, -rough @ result])
    reduced = _triangle(np.column_stack([system, right]))
    floor, size = result, int(used.sum())
    for only_offset in (False, True):
        # A curvature that drops at a break may bring the slope below zero: then it must not drop.
        free = basis.free[used]
        free[: basis.size - 1 + 2 * len(points.breaks)] &= not only_offset
        columns = np.hstack([reduced[:, :-1], -reduced[:, :-1][:, free]])
        found, _ = nnls(columns, reduced[:, -1], maxiter=100 * columns.shape[1])
        found[:size][free] -= found[size:]
        result = floor.copy()
        result[used] += found[:size]
        if _slopes(basis, result).min() > 0:
            break
    return result


class _Spectrum:
    """Solutions of a penalised least-squares problem for every weight of the penalty."""

    def __init__(
        self, basis: _Basis, rough: Array, uncertainty: float | None, *, sharp: bool
    ) -> None:
        self.basis, self.sharp = basis, sharp
        points = basis.points
        last = None if sharp else -1
        matrix, rough = (basis.heights * points.weight[:, None])[:, :last], rough[:, :last]
        # One triangle for both, so that their squares are those of a sine and a cosine.
        balance = np.linalg.norm(matrix) / np.linalg.norm(rough)
        # Few points leave directions without misfit and roughness.
        ridge = _FEWEST**2 * float(np.linalg.norm(matrix)) * np.eye(matrix.shape[1])
        triangle = _triangle(np.vstack([matrix, balance * rough, ridge]))
        inverse = solve_triangular(triangle, np.eye(len(triangle)))
        left, cosine, right = np.linalg.svd(matrix @ inverse, full_matrices=False)
        part = left.T @ (points.y * points.weight)
        self._inverse = inverse @ right.T
        sine2 = np.square(balance * rough @ self._inverse).sum(axis=0)
        cosine2 = np.square(cosine)
        rest = max(
            float(np.sum(np.square(points.y * points.weight)) - np.sum(np.square(part))), 0.0
        )
        penalty = np.multiply.outer(_WEIGHTS, sine2)
        kept = cosine2 / (cosine2 + penalty)
        misfit = np.square(penalty / (cosine2 + penalty) * part).sum(axis=1) + rest
        freedom = kept.sum(axis=1)
        count = points.x.size
        left_over = count - _GCV * freedom
        with np.errstate(divide="ignore", invalid="ignore"):
            score = np.where(left_over > 0, count * misfit / np.square(left_over), np.inf)
        at = int(np.argmin(score)) if np.isfinite(score).any() else 0
        if uncertainty is not None:
            within = np.flatnonzero(misfit <= (count - freedom) * uncertainty**2)
            at = min(at, int(within[-1])) if within.size else 0
        self.score = float(score.min())
        self.freedom = float(freedom[at])
        self.most = min(float(freedom[0]), count / _GCV)
        self.weight = float(_WEIGHTS[at] * balance**2)
        scatter = float(np.sqrt(misfit[at] / max(count - self.freedom, 1.0)))
        self.sigma = max(uncertainty or scatter, 1e-16)
        self._root = np.sqrt(kept[at]) / np.maximum(cosine, 1e-300)
        found = self._inverse @ (kept[at] / np.maximum(cosine, 1e-300) * part)
        self.coefficients = found if sharp else np.append(found, 0.0)

    def deviations(self) -> Array:
        """Square root of the posterior covariance of the coefficients. Source: wahba."""
        spread = _SPREAD * self.sigma * self._inverse * self._root
        return spread if self.sharp else np.vstack([spread, np.zeros(spread.shape[1])])


def _scatter(points: _Points) -> float:
    """Median deviation of the points from the polynomial through their neighbours, over its norm.

    Neither smooth shapes nor a few kinks have one; noise and rounding have.
    """
    x, y = points.x, points.y
    around = np.delete(np.arange(-_NEIGHBOURS, _NEIGHBOURS + 1), _NEIGHBOURS)
    own = np.arange(_NEIGHBOURS, x.size - _NEIGHBOURS)
    near = own[:, None] + around
    gaps = x[near][:, :, None] - x[near][:, None, :]
    gaps[:, range(around.size), range(around.size)] = 1.0
    to_own = x[own, None] - x[near]
    weights = to_own.prod(axis=1)[:, None] / (to_own * gaps.prod(axis=2))
    off = y[own] - (weights * y[near]).sum(axis=1)
    return float(np.median(np.abs(off) / np.sqrt(1 + np.square(weights).sum(axis=1))))


def _has_no_noise(points: _Points) -> bool:
    """True if the points deviate from a smooth shape by rounding errors, or less than it does."""
    if points.rounded or _scatter(points) < _ROUNDED:
        return _scatter(points) < _ROUNDED
    most = min(_KNOTS_OF_MEASURED, points.x.size // 2)
    basis = _Basis(points, _knots(points, most))
    spectrum = _Spectrum(basis, basis.derivative(_ROUGH), None, sharp=True)
    return spectrum.freedom > _NO_NOISE * spectrum.most


def _rounding(x: Array, y: Array, count: int) -> tuple[float, float]:
    """Standard errors of radii and heights that are multiples of a unit, zero if they are not.

    `count` radii differ. On an even grid the unit is the spacing, which is no rounding.
    """
    found = []
    for values, steps in ((x, 1 / count), (y, 1.0)):
        unit = _common_unit(values)
        found.append(unit / np.sqrt(12) if unit < _FINEST_STEP * steps else 0.0)
    return found[0], found[1]


def _common_unit(values: Array) -> float:
    """Largest number of which all values are multiples up to rounding, by Euclid's algorithm."""
    unit = 0.0
    for value in np.unique(values).tolist():
        rest = value
        while rest > _EQUAL:
            unit, rest = rest, abs(unit - rest * round(unit / rest))
    parts = values / unit
    return unit if np.abs(parts - parts.round()).max() < _OF_UNIT else 0.0
