"""Equivalent profile of a table: the likeliest admissible slope g' for the points.

The slope is a quintic spline in x/R, with the closed images of jumps of slope and curvature at
declared breaks. It is a smooth process of unknown roughness, the points deviate by a noise that is
unknown or stated, and their likelihood decides on both, on the scale of the roughness, and on jumps
of the slope at the axis and at breaks. Points that are met are those of which the noise is that of
rounding. A non-negative least-squares problem keeps the profile admissible.

Source: notes, §5.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.linalg import qr_multiply, solve_triangular
from scipy.optimize import nnls
from scipy.special import stdtrit

from mdr_core.doubles import ADJACENT, EPS
from mdr_core.errors import InputError
from mdr_core.profiles.table_basis import TableBasis, TableFit, root_mean_square
from mdr_core.profiles.table_points import TablePoints, cleaned, off_axis
from mdr_core.typing import Array, Flags, Indices

# Weights of the roughness that are tried, over the one that halves the smoothest bend.
_WEIGHTS: Final = 10.0 ** np.arange(-40, 6.1, 0.5)
# Of these, the lowest that a fit by rows resolves, and one that it resolves well.
_LEAST_WEIGHT, _RESOLVED = 1e-21, 1e-10
# Twice the logarithm of the odds against a jump of the slope, and odds that are negligible.
_JUMP, _NEGLIGIBLE = 2.0, 1e-3
# Increase of twice the logarithm of the likelihood that tells nothing.
_SAME: Final = 0.1
# Smallest jump of the slope, over the mean slope of the table.
_LEAST_JUMP: Final = 1e-3
# Singular values of directions that the points do not see, over the largest.
_UNSEEN: Final = 1e-8
# Standard deviation of heights that are met, over their range: rounding errors of the fit.
_LEAST_SIGMA: Final = 32 * ADJACENT
# Quantile of the error that is estimated: two standard deviations.
_QUANTILE: Final = 0.97725
# Lowest g'/x, over that of the paraboloid through the last point: g increases strictly.
_FLOOR: Final = 1e-9
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
    found = _likeliest(points, None if uncertainty is None else uncertainty / points.scale[1])
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


def _likeliest(points: TablePoints, uncertainty: float | None) -> TableFit:
    """Return the likeliest admissible fit.

    Parameters
    ----------
    uncertainty : of the heights over their range; None to estimate it.
    """
    basis = TableBasis(points)
    none = np.zeros(1 + len(points.breaks), dtype=bool)
    tried = [_Model(basis, uncertainty, none)]
    best = tried[0]
    for _ in none:
        one_more = [best.jumps | (np.arange(none.size) == i) for i in np.flatnonzero(~best.jumps)]
        tried += [_Model(basis, uncertainty, jumps) for jumps in one_more]
        # A jump that no one sees makes up for one of a higher derivative.
        seen = [each for each in tried if each.smallest_jump > _LEAST_JUMP]
        before, best = best, min(seen, key=lambda each: each.least)
        if best is before:
            break
    found, least = None, np.inf
    for each in sorted(seen, key=lambda each: each.least):
        if each.least >= least:
            break
        coefficients, noise = _admissible(basis, each)
        # What no admissible shape meets is noise.
        score = each.least + 2 * max(each.left_over, 1) * np.log(noise)
        if found is None or score < least:
            found, least, best, more = coefficients, score, each, noise
    spread = _spread(tried, best, blind=points.x[0] > 0)
    if more > 1:
        noisier = best.weights.searchsorted(best.weights[best.at] * more**2, side="right") - 1
        amount = np.square(more * best.sigma[best.at] / best.sigma[noisier])
        spread = np.hstack([spread, best.posterior(np.array([noisier]), amount)])
    return basis.fit(found, spread)


def _admissible(basis: TableBasis, chosen: "_Model") -> tuple[Array, float]:
    """Return the coefficients of a fit with g' > 0, and its deviation over the noise, 1 or more."""
    coefficients = _by_rows(basis, chosen, chosen.given)
    splines, jumps = coefficients[: basis.size - 1], coefficients[basis.size - 1 : -2 : 2]
    floor = _FLOOR
    if chosen.sigma[chosen.at] < _FLOOR:
        # A flat that is met is flat up to rounding errors, and what is smooth has no jumps.
        flat = np.abs(splines) < _FLOOR
        splines[flat] = (ADJACENT * basis.places[1:])[flat]
        jumps[np.abs(jumps) < _FLOOR] = 0.0
        floor = 0.0
    # Where the slope falls by a step, g' is infinite and negative beyond it.
    if min(jumps.min(initial=0.0), coefficients[-1]) >= 0:
        if basis.slopes(coefficients).min() > floor:
            return coefficients, 1.0
    weight = basis.points.weight
    coefficients = _not_negative(basis, chosen)
    off = root_mean_square(weight * basis.deviation(coefficients))
    if off > _NO_DISC:
        # The likeliest weight of less noise, with which most shapes are admissible.
        chosen.at = int(np.argmin(np.where(chosen.sigma < _NO_DISC / 4, chosen.score, np.inf)))
        coefficients = _not_negative(basis, chosen)
        off = root_mean_square(weight * basis.deviation(coefficients))
    return coefficients, max(off / chosen.sigma[chosen.at], 1.0)


def _spread(tried: "list[_Model]", best: "_Model", *, blind: bool) -> Array:
    """Return possible deviations of the coefficients, shape (columns, n).

    Two standard deviations of the posterior of all models and weights, and the influence of each
    point times the excess of its leave-one-out residual over the one expected.

    Parameters
    ----------
    blind : without a point on the axis, which alone tells a sharp tip from one that is smooth.
    """
    least = min(each.least for each in tried)
    of_tip = [
        min((each.least for each in tried if each.jumps[0] == sharp), default=np.inf)
        for sharp in (False, True)
    ]
    odds = [
        np.exp(((of_tip[int(each.jumps[0])] if blind else least) - each.score) / 2)
        for each in tried
    ]
    total, center = sum(each.sum() for each in odds), best.mean(np.array([best.at]))
    parts = [2 * best.excess()]
    for each, own in zip(tried, odds, strict=True):
        likely = np.flatnonzero(own > _NEGLIGIBLE)
        if likely.size:
            share = own[likely] / total
            off = each.mean(likely) - center
            parts += [each.posterior(likely, share), 2 * off * np.sqrt(share)]
    return np.linalg.qr(np.hstack(parts).T, mode="r").T


def _not_negative(basis: TableBasis, chosen: "_Model") -> Array:
    """Return the coefficients of least misfit and roughness with g' above the floor.

    Source: lawson-hanson, Ch. 23.
    """
    floor, weight = np.zeros(basis.heights.shape[1]), basis.points.weight
    floor[: basis.size - 1] = 4 * _FLOOR * basis.places[1:]
    closed = ~np.isnan(chosen.given)
    system = np.vstack([basis.heights * weight[:, None], chosen.rows])
    right = np.append(basis.points.y * weight, np.zeros(len(chosen.rows)))
    right -= system @ floor
    bound, found = ~basis.free & ~closed, floor
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
    return found


def _by_rows(basis: TableBasis, chosen: "_Model", given: Array) -> Array:
    """Return the coefficients of least misfit and roughness, by QR.

    The largest rows come first, so that a small weight of the roughness keeps its digits.
    Source: cox-higham.

    Parameters
    ----------
    given : coefficients that are known, NaN for the others.
    """
    weight = basis.points.weight
    system = np.vstack([basis.heights * weight[:, None], chosen.rows])
    right = np.append(basis.points.y * weight, np.zeros(len(chosen.rows)))
    order = np.argsort(-np.abs(system).max(axis=1), kind="stable")
    free = np.isnan(given)
    result = np.where(free, 0.0, given)
    right = (right - system @ result)[order]
    rotated, triangle, column = qr_multiply(system[order][:, free], right, pivoting=True)
    # Few points leave coefficients open: these are zero.
    size = np.abs(np.diagonal(triangle))
    rank = np.count_nonzero(size > EPS * size[0])
    known = np.flatnonzero(free)[column[:rank]]
    result[known] = solve_triangular(triangle[:rank, :rank], rotated[:rank])
    return result


class _Model:
    """Penalised least-squares problem for every weight of the roughness, with its likelihood.

    Slopes without roughness, of which nothing is known beforehand, are separated from those that
    are rough, so that both are as accurate as the heights, whatever the weight.

    Source: elden, wahba.

    Parameters
    ----------
    jumps : see `TableBasis.by_roughness`.
    """

    def __init__(self, basis: TableBasis, uncertainty: float | None, jumps: Flags) -> None:
        self.basis, self.jumps = basis, jumps
        matrix, goal = basis.weighted
        smooth, rough = basis.by_roughness(jumps)
        self.seen, sizes, right = np.linalg.svd(matrix @ smooth, full_matrices=False)
        # Few points leave directions open.
        known = sizes > _UNSEEN * sizes[0]
        self.seen, sizes = self.seen[:, known], sizes[known]
        self.smooth = smooth @ (right[known].T / sizes)
        bent = matrix @ rough
        shared = self.seen.T @ bent
        base, triangle = np.linalg.qr(bent - self.seen @ shared)
        left, size, right = np.linalg.svd(triangle)
        self.left_over = max(basis.points.x.size - sizes.size, 0)
        kept = min(size.size, self.left_over)
        self.left, self.size = base @ left[:, :kept], size[:kept]
        turned = (rough - self.smooth @ shared) @ right.T
        self.rough, self.open = turned[:, :kept], turned[:, kept:]
        self.fitted = self.seen.T @ goal
        goal = goal - self.seen @ self.fitted
        self.part = self.left.T @ goal
        self.rest = (goal - self.left @ self.part) * (kept < self.left_over)
        size2 = np.square(self.size)
        self.weights = max(float(np.square(size).max(initial=0.0)), _UNSEEN**2) * _WEIGHTS
        share = self.weights[:, None] / np.add.outer(self.weights, size2)
        whole = share @ np.square(self.part) + np.square(self.rest).sum()
        least = max(basis.points.rounding, _LEAST_SIGMA)
        self.stated = uncertainty is not None
        if uncertainty is None:
            self.sigma = np.sqrt(np.maximum(whole / max(self.left_over, 1), least**2))
        else:
            self.sigma = np.full(whole.size, max(uncertainty, _LEAST_SIGMA))
        variance = np.square(self.sigma)
        self.score = (
            whole / variance
            + self.left_over * np.log(2 * np.pi * variance)
            - np.log(share).sum(axis=1)
            + 2 * np.log(sizes).sum()
            + _JUMP * jumps.sum()
            + variance / _NO_DISC**2
        )
        """-2 log of the likelihood, for unit densities of what is not rough."""
        if self.left_over == 0:
            # No point is left to tell the roughness: it is that of the unit.
            unit = np.arange(whole.size) == np.argmin(np.abs(np.log(variance / self.weights)))
            self.score = np.where(unit, self.score, np.inf)
        self.least = float(self.score.min())
        # Points that are met tell no small weight from another: take one that rows resolve.
        likely = np.flatnonzero(self.score <= self.least + _SAME)
        self.at = int(likely[min(np.sum(_WEIGHTS[likely] < _RESOLVED), likely.size - 1)])

    @property
    def smallest_jump(self) -> float:
        """Smallest of the jumps of the slope, over the mean slope of the table."""
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
        weight = max(self.weights[self.at], self.weights[-1] / _WEIGHTS[-1] * _LEAST_WEIGHT)
        return np.sqrt(weight) * self.basis.roughness

    def mean(self, at: Indices) -> Array:
        """Coefficients for weights of the roughness, shape (columns, n)."""
        bent = self.size / np.add.outer(self.weights[at], np.square(self.size)) * self.part
        return (self.smooth @ self.fitted)[:, None] + self.rough @ bent.T

    def posterior(self, at: Indices, share: Array) -> Array:
        """Possible deviations of the coefficients, for a mixture of weights. Source: wahba."""
        size2 = np.concatenate([np.square(self.size), np.zeros(self.open.shape[1])])
        variance = np.square(self.sigma[at]) * share
        bent = np.sqrt(variance @ (1 / np.add.outer(self.weights[at], size2)))
        smooth = np.sqrt(variance.sum()) * self.smooth
        quantile = 2.0 if self.stated else stdtrit(max(self.left_over, 1), _QUANTILE)
        return quantile * np.hstack([smooth, np.hstack([self.rough, self.open]) * bent])

    def excess(self) -> Array:
        """Influence of each point times the excess of its residual when it is left out."""
        sum2 = np.square(self.size) + self.weights[self.at]
        share = self.weights[self.at] / sum2
        influence = self.smooth @ self.seen.T + self.rough * (self.size / sum2) @ self.left.T
        residual = self.rest + self.left @ (share * self.part)
        outside = 1 - np.square(self.seen).sum(axis=1) - np.square(self.left).sum(axis=1)
        own = np.square(self.left) @ share + np.where(outside > _UNSEEN, outside, 0.0)
        own = np.maximum(own, np.finfo(float).tiny)
        over = np.square(residual / own) - self.sigma[self.at] ** 2 / own
        return influence * np.sqrt(np.maximum(over, 0.0))
