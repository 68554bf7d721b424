"""Equivalent profile of a table: the likeliest admissible slope g' for the points.

The slope is a quintic spline in x/R, with the closed images of jumps of slope and curvature at
declared breaks. Its third derivative is a random process of unknown size, and the heights deviate
by a noise that is stated or unknown. One restricted likelihood decides on both sizes, on a process
that grows towards the axis or not, and on jumps of the slope at the axis and at breaks. Heights
without noise are the limit of a noise of rounding errors. A non-negative least-squares problem
keeps the profile admissible. The error of the data is that of all likely choices together.

Source: notes, §5.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.linalg import lstsq
from scipy.optimize import nnls
from scipy.special import stdtrit

from mdr_core.doubles import ADJACENT, EPS
from mdr_core.errors import InputError
from mdr_core.profiles.table_basis import TableBasis, TableFit, root_mean_square
from mdr_core.profiles.table_points import TablePoints, cleaned, off_axis
from mdr_core.typing import Array, Flags, Indices

# Weights of the roughness, over the one that halves the smoothest bend: to a parabola.
_WEIGHTS: Final = 10.0 ** np.arange(-40, 6.1, 0.5)
# Place of the smallest weight in a problem of rows, 1e-21: its root has no digits to spare.
_LEAST: Final = 38
# Smallest weight that is preferred among equally likely ones: its root has digits to spare.
_RESOLVED: Final = 1e-10
# Distance over the step there from which the roughness grows towards the axis or, if < 0, the end,
# as at a fine tip or next to the equator of a sphere; an even roughness is infinite.
_GRADINGS: Final = (np.inf, 0.1, -0.1)
# Twice the logarithm of the odds against one jump of the slope, e to 1.
_JUMP: Final = 2.0
# Likelihood over the largest one below which a choice has no share in the error.
_NEGLIGIBLE: Final = 1e-2
# Change of twice the logarithm of the likelihood that decides nothing: 5 % of the odds.
_SAME: Final = 0.1
# Smallest jump of the slope over the mean slope: a smaller one replaces a higher derivative's.
_LEAST_JUMP: Final = 2e-2
# Largest possible deviation of a slope or curvature, over the mean slope of the table.
_LARGEST: Final = 10.0
# Singular values of directions that the points do not show, over the largest.
_UNSEEN: Final = 1e-8
# Standard deviation of heights that are met, over their range: rounding errors of the fit, by
# trial with 50 to 500 points of r^2 and r^3.
_LEAST_SIGMA: Final = 32 * ADJACENT
# Lowest g'/x, over that of the paraboloid through the last point: g increases strictly.
_FLOOR: Final = 1e-9
# Largest noise over the errors of the digits, root mean square, at which these are the noise and
# weight the points.
_ROUNDED: Final = 2.0
# Share of the excess of a residual in the error of the data, by trial: of random tables the error
# covers 97.2 % with a share of 1, 97.7 % with this, and 98.0 % with 2, whose median is 6 % wider.
_EXCESS: Final = 1.5
# Quantile of the error of the data: two standard deviations of a normal distribution.
_QUANTILE: Final = 0.97725
# Deviation from the points, root mean square over the height, from which the shape has no contact
# area that is a single disc.
_NO_DISC: Final = 0.025


def fit_table(
    r: Array, f: Array, breaks: Sequence[float] = (), uncertainty: float | None = None
) -> TableFit:
    """Return the likeliest admissible equivalent profile of points.

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
    relative = None if uncertainty is None else uncertainty / points.scale[1]
    found = _likeliest(_weighted(points, relative), relative)
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


def _weighted(points: TablePoints, uncertainty: float | None) -> TableBasis:
    """Return the splines of the points, which their digits weight where these are the noise."""
    basis = TableBasis(points)
    if uncertainty is None and np.ptp(points.rounding) > 0:
        most = _Model(basis, None, np.ones(1 + len(points.breaks), dtype=bool), np.inf)
        _, excess = _admissible(basis, most)
        if excess * most.sigma[most.at] < _ROUNDED * root_mean_square(points.rounding):
            return TableBasis(points.by_digits)
    return basis


def _likeliest(basis: TableBasis, uncertainty: float | None) -> TableFit:
    """Return the likeliest admissible fit.

    Parameters
    ----------
    uncertainty : standard uncertainty of the heights over their range; None to estimate it.
    """

    def models(jumps: Flags) -> "list[_Model]":
        return [_Model(basis, uncertainty, jumps, grading) for grading in _GRADINGS]

    tried = models(np.zeros(1 + len(basis.points.breaks), dtype=bool))
    before, best = None, min(tried, key=lambda each: each.least)
    while best is not before:
        for i in np.flatnonzero(~best.jumps):
            tried += models(best.jumps | (np.arange(best.jumps.size) == i))
        jumping = [each for each in tried if each.smallest_jump > _LEAST_JUMP]
        seen = sorted(jumping, key=lambda each: each.least)
        before, best = best, seen[0]
    found: list[tuple[float, Array, _Model, float]] = []
    for each in seen:
        if found and each.least >= min(score for score, *_ in found):
            break
        coefficients, excess = _admissible(basis, each)
        # A deviation that no admissible shape removes is noise.
        score = each.least + 2 * max(each.left_over, 1) * np.log(excess)
        found.append((score, coefficients, each, excess))
    _, coefficients, best, excess = min(found, key=lambda fit: fit[0])
    blind = bool(basis.points.x[0] > basis.knots[1] / 2)
    return basis.fit(coefficients, *_spread(tried, best, excess, blind=blind))


def _admissible(basis: TableBasis, chosen: "_Model") -> tuple[Array, float]:
    """Return the coefficients of a fit with g' > 0, and its deviation over the noise, 1 or more."""
    coefficients = _by_rows(basis, chosen, chosen.given)
    splines, jumps = coefficients[: basis.size - 1], coefficients[basis.size - 1 : -2 : 2]
    floor = _FLOOR
    if chosen.sigma[chosen.at] < _FLOOR:
        # Exact heights: a flat is flat up to rounding errors, and a smooth profile has no jumps.
        given, floor = chosen.given, 0.0
        flat = np.flatnonzero(np.abs(splines) < _FLOOR)
        given[flat] = ADJACENT * basis.places[1:][flat]
        given[basis.size - 1 : -2 : 2][np.abs(jumps) < _FLOOR] = 0.0
        coefficients = _by_rows(basis, chosen, given)
        jumps = coefficients[basis.size - 1 : -2 : 2]
    # Where the slope falls by a step, g' is infinite and negative beyond it.
    falls = min(jumps.min(initial=0.0), coefficients[-1]) < 0
    if not falls and basis.slopes(coefficients).min() > floor:
        return coefficients, 1.0
    coefficients, off = _not_negative(basis, chosen)
    if off > _NO_DISC:
        # Most shapes are admissible at the likeliest weight of less noise.
        score = np.where(chosen.sigma < _NO_DISC / 4, chosen.score, np.inf)
        chosen.at = int(np.argmin(score))
        coefficients, off = _not_negative(basis, chosen)
    return coefficients, max(off / chosen.sigma[chosen.at], 1.0)


def _spread(
    tried: "list[_Model]", best: "_Model", excess: float, *, blind: bool
) -> tuple[Array, float, int]:
    """Return possible deviations of the coefficients (columns, n), odds, and the deciding point.

    The deviations are those of the posterior of all models and weights, to two standard deviations,
    or to Student's quantile where the noise is estimated from the points; and for each point its
    influence times a share of the excess of its residual, when it is left out, over the expected
    one. The odds are those of the tip, sharp or smooth, that was not chosen.

    Parameters
    ----------
    blind : True without a point on the axis, which alone tells a sharp tip from a smooth one.
    """
    least = {
        sharp: min(each.least for each in tried if not blind or each.jumps[0] == sharp)
        for sharp in {bool(each.jumps[0]) for each in tried}
    }
    odds = [np.exp((least[bool(each.jumps[0])] - each.score) / 2) for each in tried]
    total, center = sum(each.sum() for each in odds), best.mean(np.array([best.at]))
    left_out = best.excess()
    parts, rival = [_EXCESS * left_out], 0.0
    if excess > 1:
        at = np.array([best.at])
        noisier = best.weights.searchsorted(best.weights[at] * excess**2, side="right") - 1
        amount = np.square(excess * best.sigma[at] / best.sigma[noisier])
        parts.append(best.posterior(noisier, amount))
    for each, own in zip(tried, odds, strict=True):
        rival += own.sum() / total * (each.jumps[0] != best.jumps[0])
        likely = np.flatnonzero(own > _NEGLIGIBLE)
        if likely.size:
            share = own[likely] / total
            off = each.mean(likely) - center
            parts += [each.posterior(likely, share), 2 * off * np.sqrt(share)]
    # Few points leave a jump open without bound, but no admissible slope is that large.
    spread = np.hstack(parts)
    spread *= _LARGEST / np.abs(spread).max(axis=0).clip(_LARGEST)
    spread = np.asarray(np.linalg.qr(spread.T, mode="r")).T
    return spread, float(rival), int(np.argmax(np.linalg.norm(left_out, axis=0)))


def _not_negative(basis: TableBasis, chosen: "_Model") -> tuple[Array, float]:
    """Return the coefficients of least misfit and roughness with g' > 0, and their misfit.

    Source: lawson-hanson, Ch. 23.
    """
    floor, (heights, goal) = np.zeros(basis.heights.shape[1]), basis.weighted
    floor[: basis.size - 1] = 4 * _FLOOR * basis.places[1:]
    system = np.vstack([heights, chosen.rows])
    right = np.append(goal, np.zeros(len(chosen.rows))) - system @ floor
    closed = ~np.isnan(chosen.given)
    bound, found = ~closed, floor
    bound[-2] = False
    for with_bends in (False, True):
        # A curvature that drops at a break may bring the slope below zero: then it must not drop.
        bound[basis.size : -2 : 2] = with_bends
        free = ~bound & ~closed
        used = np.hstack([system[:, bound], system[:, free], -system[:, free]])
        factors, _ = nnls(used, right, maxiter=100 * used.shape[1])
        met = np.zeros_like(bound)
        met[bound] = factors[: bound.sum()] == 0
        found = _by_rows(basis, chosen, np.where(met, floor, chosen.given))
        # Rounding errors may hide a bound.
        found[bound] = np.maximum(found, floor)[bound]
        if basis.slopes(found).min() > 0:
            break
    return found, root_mean_square(basis.points.weight * basis.deviation(found))


def _by_rows(basis: TableBasis, chosen: "_Model", given: Array) -> Array:
    """Return the coefficients of least misfit and roughness, by QR.

    The largest rows come first, so that a small weight of the roughness keeps its digits.
    Source: cox-higham.

    Parameters
    ----------
    given : coefficients that are known, NaN for the others.
    """
    heights, goal = basis.weighted
    system = np.vstack([heights, chosen.rows])
    right = np.append(goal, np.zeros(len(chosen.rows)))
    order = np.argsort(-np.abs(system).max(axis=1), kind="stable")
    free = np.isnan(given)
    result = np.where(free, 0.0, given)
    right = (right - system @ result)[order]
    # A few points leave coefficients undetermined: the least norm keeps them small.
    result[free] = lstsq(system[order][:, free], right, EPS, lapack_driver="gelsy")[0]
    return result


class _Model:
    """Likelihood and solutions of a penalised least-squares problem for every weight.

    Slopes without roughness, of which nothing is known beforehand, are separated from those that
    are rough, so that both are as accurate as the heights, whatever the weight.

    Source: elden; wahba.

    Parameters
    ----------
    uncertainty : standard uncertainty of the heights over their range; None to estimate it.
    jumps : True where the slope may jump: at the axis, and at each break.
    grading : see `TableBasis.grading`.
    """

    def __init__(
        self, basis: TableBasis, uncertainty: float | None, jumps: Flags, grading: float
    ) -> None:
        self.basis, self.jumps, count = basis, jumps, basis.points.x.size
        grade = basis.grading(grading)
        self.graded = basis.roughness * np.reshape(grade, (-1, 1))
        smooth, rough = basis.by_roughness
        self.turn, triangle = basis.triangle
        bent = triangle[:, smooth.shape[1] :] / grade
        used = np.append(np.flatnonzero(jumps), np.arange(jumps.size, smooth.shape[1]))
        goal = self.turn.T @ basis.weighted[1]
        seen, sizes, right = np.linalg.svd(triangle[:, used])
        # Few points leave directions open.
        known = int(np.sum(sizes > _UNSEEN * sizes[0]))
        self.seen, beside, sizes = seen[:, :known], seen[:, known:], sizes[:known]
        self.smooth = smooth[:, used] @ (right[:known].T / sizes)
        base, triangle = np.linalg.qr(beside.T @ bent)
        left, self.size, right = np.linalg.svd(triangle)
        self.left, self.left_over, kept = beside @ base @ left, count - known, self.size.size
        turned = (rough / grade - self.smooth @ (self.seen.T @ bent)) @ right.T
        self.rough, self.open = turned[:, :kept], turned[:, kept:]
        self.fitted = self.seen.T @ goal
        self.part = self.left.T @ goal
        rest = basis.weighted[1] - self.turn @ (self.seen @ self.fitted + self.left @ self.part)
        self.rest = rest * (kept < self.left_over)
        self.weights = max(float(np.square(self.size).max(initial=0.0)), _UNSEEN**2) * _WEIGHTS
        share = self.weights[:, None] / np.add.outer(self.weights, np.square(self.size))
        whole = share @ np.square(self.part) + np.square(self.rest).sum()
        variance = least = 0 * whole + max(uncertainty or 0.0, _LEAST_SIGMA) ** 2
        freedom = max(self.left_over, 1)
        if uncertainty is None:
            least = max(basis.points.least, _LEAST_SIGMA) ** 2
            variance = np.maximum(whole / freedom, least)
        self.sigma = np.sqrt(variance)
        # A noise that is estimated from the points is itself uncertain.
        self.deviations = np.where(variance > least, stdtrit(freedom, _QUANTILE), 2.0)
        self.score = (
            whole / variance
            + self.left_over * np.log(2 * np.pi * variance)
            - np.log(share).sum(axis=1)
            + 2 * np.log(sizes).sum()
            + _JUMP * jumps.sum()
            + variance / _NO_DISC**2
        )
        """-2 log of the likelihood; its last term makes a noise that is rejected unlikely."""
        if self.left_over == 0:
            # No point is left to tell the roughness: it is that of the unit.
            unit = np.arange(whole.size) == np.argmin(np.abs(np.log(variance / self.weights)))
            self.score = np.where(unit, self.score, np.inf)
        self.least = float(self.score.min())
        # Heights that are met tell no weight from another: a large one adds rounding errors.
        best = whole[np.argmin(self.score)]
        met = (variance <= _LEAST_SIGMA**2) & (whole <= best + _SAME * variance)
        likely = np.flatnonzero((self.score <= self.least + _SAME) | met)
        self.at = int(likely[min(int(np.sum(_WEIGHTS[likely] < _RESOLVED)), likely.size - 1)])

    @property
    def smallest_jump(self) -> float:
        """Smallest jump of the slope over the mean slope of the table; infinite without one."""
        jumps = self.mean(np.array([self.at]))[self.basis.closed(~self.jumps), 0]
        return float(np.abs(jumps).min(initial=np.inf))

    @property
    def given(self) -> Array:
        """Coefficients of the slopes that do not jump, zero, NaN for the others."""
        given = np.full(self.basis.heights.shape[1], np.nan)
        given[self.basis.closed(self.jumps)] = 0.0
        return given

    @property
    def rows(self) -> Array:
        """Rows of the roughness."""
        return np.sqrt(max(self.weights[self.at], self.weights[_LEAST])) * self.graded

    def mean(self, at: Indices) -> Array:
        """Coefficients for weights of the roughness, shape (columns, n)."""
        bent = self.size / np.add.outer(self.weights[at], np.square(self.size)) * self.part
        return (self.smooth @ self.fitted)[:, None] + self.rough @ bent.T

    def posterior(self, at: Indices, share: Array) -> Array:
        """Possible deviations of the coefficients, for a mixture of weights. Source: wahba."""
        size2 = np.append(np.square(self.size), np.zeros(self.open.shape[1]))
        variance = np.square(self.deviations[at] * self.sigma[at]) * share
        bent = np.sqrt(variance @ (1 / np.add.outer(self.weights[at], size2)))
        smooth = np.sqrt(variance.sum()) * self.smooth
        return np.hstack([smooth, np.hstack([self.rough, self.open]) * bent])

    def excess(self) -> Array:
        """Influence of each point times the excess of its residual if left out. Source: rippa."""
        sum2 = np.square(self.size) + self.weights[self.at]
        share = self.weights[self.at] / sum2
        seen, left = self.turn @ self.seen, self.turn @ self.left
        influence = self.smooth @ seen.T + self.rough * (self.size / sum2) @ left.T
        outside = 1 - np.square(seen).sum(axis=1) - np.square(left).sum(axis=1)
        # A point that only the columns can fit has a residual of rounding errors.
        outside = np.where(outside > _UNSEEN, outside, 0.0)
        left[np.linalg.norm(left, axis=1) < _UNSEEN] = 0.0
        residual = np.where(outside > 0, self.rest, 0.0) + left @ (share * self.part)
        own = np.maximum(np.square(left) @ share + outside, np.finfo(float).tiny)
        over = np.square(residual / own) - self.sigma[self.at] ** 2 / own
        return influence * np.sqrt(np.maximum(over, 0.0))
