"""Equivalent profile of a table: the smoothest slope g' >= 0 that the points allow.

The slope is a quintic spline in x/R, with the closed images of jumps of slope and curvature at
declared breaks. Heights that a spline of least roughness meets are interpolated. Otherwise they are
taken as measured: generalised cross-validation, or a stated uncertainty, decides how much of their
scatter is noise, and a non-negative least-squares problem keeps the profile admissible.

Source: notes, §5.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import qr_multiply, solve_triangular
from scipy.optimize import nnls
from scipy.sparse.linalg import spsolve

from mdr_core.errors import InputError
from mdr_core.profiles.table_basis import TableBasis, TableFit, root_mean_square
from mdr_core.profiles.table_points import ROUNDED, TablePoints, cleaned, off_axis, scatter
from mdr_core.typing import Array

# Derivative of the slope whose mean square is the roughness of measured heights: a parabola has
# none.
_ROUGH: Final = 3
# Largest numbers of knots, for heights that are met and for heights that are measured.
_KNOTS, _KNOTS_OF_MEASURED = 200, 80
# Number of radii up to which cross-validation has too few points to tell noise.
_FEW: Final = 12
# Weight of a degree of freedom in cross-validation, against overfitting. Source: kim-gu.
_GCV: Final = 1.2
# Part of the possible degrees of freedom above which no noise is found.
_NO_NOISE: Final = 0.8
# Weights of the roughness that are tried, over the one that halves the smoothest bend.
_WEIGHTS: Final = 10.0 ** np.arange(-14, 6.1, 0.25)
# Relative difference of the scores of cross-validation that is none.
_EQUAL_SCORES: Final = 1e-6
# Increase of the score, times the number of points, up to which a weight is plausible: of a
# likelihood by a factor of e.
_PLAUSIBLE: Final = 2.0
# Part of the largest misfit below which few points leave a slope without roughness open.
_OPEN: Final = 1e-8
# Weight of the points against the roughness of an interpolant.
_HEAVY: Final = 1e6
# Factor by which a sharp tip has to lower the roughness of an interpolant at the first knots to be
# believed, and variances of the noise by which it has to lower the sum of squares.
_SHARPER, _TIP_KNOTS, _SHARPER_MEASURED = 10.0, 4, 12.0
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
    points = cleaned(r, f, breaks)
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
        advice = off_axis(r, f)
        raise InputError(
            ("profile", "f"),
            "no body with a contact area that is a single disc comes near the points: they deviate "
            f"by {100 * largest / points.scale[1]:.2g} % of their height at radius {radius:.3g}; "
            f"{advice and advice + '; else '}"
            "give the part about the highest point alone, or remove a ring, a hole or outliers",
        )
    return found


def _knots(points: TablePoints, most: int) -> Array:
    """Return knots at the axis and at points, every n-th one if there are more than `most`."""
    x = points.x if points.x[0] == 0 else np.append(0.0, points.x)
    if x.size > most:
        x = x[np.unique(np.linspace(0, x.size - 1, most).round().astype(int))]
    return x


def _interpolated(points: TablePoints) -> TableFit:
    """Return the interpolant of least roughness, or the nearest fit if that is not admissible."""
    basis = TableBasis(points, _knots(points, _KNOTS))
    coefficients = _least_roughness(basis)
    # A flat is flat up to rounding errors: g increases there too.
    splines, largest = coefficients[: basis.size - 1], np.abs(coefficients).max()
    rounded = (splines <= 0) & (splines > -_NEGATIVE * largest)
    splines[rounded] = _TINY * largest * basis.places[1:][rounded]
    jumps = coefficients[basis.size - 1 : -2 : 2]
    jumps[np.abs(jumps) < _NEGATIVE * largest] = 0.0
    # Where the slope falls by a step, g' is infinite and negative beyond it.
    falls = min(jumps.min(initial=0.0), coefficients[-1]) < 0
    if falls or basis.slopes(coefficients).min() <= 0:
        return _measured(points, 0.0, sharp=coefficients[-1] > 0)
    # The error of every second point, which is larger than that of all.
    half = np.zeros(points.x.size, dtype=bool)
    half[:: max(2, points.x.size // (_KNOTS // 2))] = half[-1] = True
    spread = np.zeros_like(coefficients)
    if half.sum() > 2:
        coarse = replace(points, x=points.x[half], y=points.y[half], weight=points.weight[half])
        other = TableBasis(coarse, _knots(coarse, _KNOTS))
        found = _least_roughness(other)
        spread = _between(basis, other, found) - coefficients
    return basis.fit(coefficients, spread)


def _between(basis: TableBasis, other: TableBasis, coefficients: Array) -> Array:
    """Return the coefficients, in a basis, of a slope in another one with fewer knots."""
    matrix = BSpline.design_matrix(basis.places, basis.t, basis.degree)
    splines = spsolve(matrix.tocsc(), other.spline(coefficients)(basis.places))
    return np.concatenate([splines[1:], coefficients[other.size - 1 : -1], splines[:1]])


def _least_roughness(basis: TableBasis) -> Array:
    """Return the coefficients of the interpolant whose last derivative jumps least."""
    points = basis.points
    largest = float(np.abs(basis.heights[:, : basis.size - 1]).max())
    jumps = largest * basis.jumps()
    # A height at a small radius is met as accurately, relatively.
    weight = _HEAVY / np.maximum(points.x, points.x[1])
    given = np.full(basis.heights.shape[1], np.nan)
    smooth, sharp = (_solved(basis, weight, jumps, given, sharp=tip) for tip in (False, True))
    roughness = [float(np.linalg.norm(jumps[:_TIP_KNOTS] @ each)) for each in (smooth, sharp)]
    is_sharp = roughness[0] > max(_SHARPER * roughness[1], ROUNDED * largest)
    return sharp if is_sharp else smooth


def _measured(
    points: TablePoints, uncertainty: float | None, *, sharp: bool | None = None
) -> TableFit:
    """Return the smoothest admissible fit within the uncertainty, or the scatter."""
    basis = TableBasis(points, _knots(points, _KNOTS_OF_MEASURED))
    without, with_tip = (_Spectrum(basis, uncertainty, sharp=tip) for tip in (False, True))
    if sharp is None:
        sharp = with_tip.score * (1 + _SHARPER_MEASURED / points.x.size) < without.score
    chosen = with_tip if sharp else without
    coefficients = _by_rows(basis, chosen, np.full(basis.heights.shape[1], np.nan))
    # The posterior of the coefficients. Source: wahba.
    spread = _SPREAD * chosen.sigma * chosen.spread
    used = ~basis.free
    used[-1] = chosen.sharp
    if min(coefficients[used].min(), basis.slopes(coefficients).min()) < _FLOOR:
        coefficients = _not_negative(basis, chosen)
        scatter = root_mean_square(points.weight * basis.deviation(coefficients))
        spread = spread * max(scatter / chosen.sigma, 1.0)
    return basis.fit(coefficients, spread)


def _not_negative(basis: TableBasis, chosen: "_Spectrum") -> Array:
    """Return the coefficients of least misfit and roughness with g' above the floor.

    Source: lawson-hanson, Ch. 23.
    """
    floor, weight = np.zeros(basis.heights.shape[1]), basis.points.weight
    floor[: basis.size - 1] = 4 * _FLOOR * basis.places[1:]
    bound = ~basis.free
    bound[-1] = chosen.sharp
    system = np.vstack([basis.heights * weight[:, None], chosen.rough])
    right = np.concatenate([basis.points.y * weight, np.zeros(len(chosen.rough))])
    right -= system @ floor
    found = floor
    for with_bends in (False, True):
        # A curvature that drops at a break may bring the slope below zero: then it must not drop.
        bound[basis.size : -2 : 2] = with_bends
        free = ~bound
        free[-1] = False
        used = np.hstack([system[:, bound], system[:, free], -system[:, free]])
        factors, _ = nnls(used, right, maxiter=100 * used.shape[1])
        met = np.zeros_like(bound)
        met[bound] = factors[: bound.sum()] == 0
        found = _by_rows(basis, chosen, np.where(met, floor, np.nan))
        # Rounding errors may hide a bound.
        found[bound] = np.maximum(found, floor)[bound]
        if basis.slopes(found).min() > 0:
            break
    return found


def _by_rows(basis: TableBasis, chosen: "_Spectrum", given: Array) -> Array:
    """Return the coefficients of least misfit and roughness of a spectrum, some of them given."""
    return _solved(basis, basis.points.weight, chosen.rough, given, sharp=chosen.sharp)


def _solved(basis: TableBasis, weight: Array, rough: Array, given: Array, *, sharp: bool) -> Array:
    """Return the coefficients of least misfit and roughness, those that are not given, by QR.

    The largest rows come first, so that a small weight of the roughness keeps its digits.
    Source: cox-higham.

    Parameters
    ----------
    weight : of the misfit at each point.
    rough : rows of the roughness.
    given : coefficients that are known, NaN for the others.
    sharp : the slope on the axis is a coefficient; else it is zero.
    """
    system = np.vstack([basis.heights * weight[:, None], rough])
    right = np.concatenate([basis.points.y * weight, np.zeros(len(rough))])
    order = np.argsort(-np.abs(system).max(axis=1), kind="stable")
    free = np.isnan(given)
    free[-1] &= sharp
    result = np.where(np.isnan(given), 0.0, given)
    right = (right - system @ result)[order]
    rotated, triangle, column = qr_multiply(system[order][:, free], right, pivoting=True)
    # Few points leave coefficients open: these are zero.
    size = np.abs(np.diagonal(triangle))
    rank = np.count_nonzero(size > np.finfo(float).eps * size[0])
    known = np.flatnonzero(free)[column[:rank]]
    result[known] = solve_triangular(triangle[:rank, :rank], rotated[:rank])
    return result


class _Spectrum:
    """Solutions of a penalised least-squares problem for every weight of the penalty.

    Slopes without roughness are separated from those that the penalty bends, so that both are as
    accurate as the heights, whatever the weight.

    Source: elden.
    """

    def __init__(self, basis: TableBasis, uncertainty: float | None, *, sharp: bool) -> None:
        points = basis.points
        self.sharp, order = sharp, min(_ROUGH, basis.degree)
        matrix, goal = basis.heights * points.weight[:, None], points.y * points.weight
        smooth, rough = basis.by_roughness(order, sharp=sharp)
        seen, size, right = np.linalg.svd(matrix @ smooth, full_matrices=False)
        # Few points leave directions without misfit and roughness.
        known = size > _OPEN * size[0]
        seen, smooth = seen[:, known], smooth @ (right[known].T / size[known])
        bent = matrix @ rough
        shared = seen.T @ bent
        base, triangle = np.linalg.qr(bent - seen @ shared)
        left, size, right = np.linalg.svd(triangle)
        rough = (rough - smooth @ shared) @ right.T
        size2 = np.zeros(rough.shape[1])
        size2[: size.size] = np.square(size)
        fitted = seen.T @ goal
        goal = goal - seen @ fitted
        part = np.zeros_like(size2)
        part[: size.size] = left.T @ (base.T @ goal)
        rest = float(np.square(goal - base @ (base.T @ goal)).sum())
        weights = size2[0] * _WEIGHTS
        kept = size2 / np.add.outer(weights, size2)
        misfit = np.square((1 - kept) * part).sum(axis=1) + rest
        freedom = fitted.size + kept.sum(axis=1)
        count = points.x.size
        left_over = count - _GCV * freedom
        with np.errstate(divide="ignore", invalid="ignore"):
            score = np.where(left_over > 0, count * misfit / np.square(left_over), np.inf)
        # Of weights that do not matter the one that leaves most open.
        at = int(np.argmax(score <= score.min() * (1 + _EQUAL_SCORES)))
        if uncertainty is not None:
            within = np.flatnonzero(misfit <= (count - freedom) * uncertainty**2)
            at = min(at, int(within[-1])) if within.size else 0
        self.score = float(score.min())
        self.freedom = float(freedom[at])
        self.most = min(float(freedom[0]), count / _GCV)
        self.rough = np.sqrt(weights[at]) * basis.derivative(order)
        """Rows of the roughness."""
        scatter = float(np.sqrt(misfit[at] / max(count - self.freedom, 1.0)))
        self.sigma = max(uncertainty or scatter, 1e-16)
        # The points hardly tell the best weight from a smaller one, which leaves more open.
        plausible = min(at, int(np.argmax(score <= score.min() * (1 + _PLAUSIBLE / count))))
        self.spread = np.hstack([smooth, rough / np.sqrt(size2 + weights[plausible])])
        """Square root of the inverse of the matrix of misfit and roughness."""


def _has_no_noise(points: TablePoints) -> bool:
    """True if the points deviate from a smooth shape by rounding errors, or less than it does."""
    if points.rounded or scatter(points) < ROUNDED:
        return scatter(points) < ROUNDED
    most = min(_KNOTS_OF_MEASURED, points.x.size // 2)
    basis = TableBasis(points, _knots(points, most))
    spectrum = _Spectrum(basis, None, sharp=True)
    return spectrum.freedom > _NO_NOISE * spectrum.most
