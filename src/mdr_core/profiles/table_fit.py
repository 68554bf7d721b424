"""Equivalent profile of a table: the smoothest slope g' >= 0 that the points allow.

The slope is a quintic spline in x/R, with the closed images of jumps of slope and curvature at
declared breaks, of least roughness and misfit. Heights without noise are met. For the others
generalised cross-validation, or a stated uncertainty, decides how much of their scatter is noise. A
non-negative least-squares problem keeps the profile admissible.

Source: notes, §5.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.linalg import qr_multiply, solve_triangular
from scipy.optimize import nnls

from mdr_core.doubles import ADJACENT, EPS
from mdr_core.errors import InputError
from mdr_core.profiles.table_basis import TableBasis, TableFit, root_mean_square
from mdr_core.profiles.table_points import EXACT_SCATTER, TablePoints, cleaned, off_axis, scatter
from mdr_core.typing import Array

# Weights of the roughness that are tried, over the one that halves the smoothest bend.
_WEIGHTS: Final = 10.0 ** np.arange(-20, 6.1, 0.5)
# Number of these weights for heights that are met, up to 1e-6: beyond, rounding errors of the
# roughness enter the profile, and 200 points of r^2 are met to 1e-11 instead of 1e-13.
_WEIGHTS_OF_EXACT: Final = 29
# Number of radii up to which cross-validation has too few points to tell noise.
_FEW: Final = 12
# Weight of a degree of freedom in cross-validation, against overfitting. Source: kim-gu.
_GCV: Final = 1.2
# Increase of the score, times the number of points, up to which a weight is plausible: of a
# likelihood by a factor of e.
_PLAUSIBLE: Final = 2.0
# Factor by which a sharp tip has to lower the sum of squares that a slope without roughness leaves
# of heights that are met, and variances of the noise by which it has to lower that of others.
_SHARPER, _SHARPER_MEASURED = 100.0, 12.0
# Lowest g'/x, over that of the paraboloid through the last point: g increases strictly.
_FLOOR: Final = 1e-9
# Deviation from the points, root mean square over the height, from which the shape has no contact
# area that is a single disc.
_NO_DISC: Final = 0.025
# Standard deviations in the estimate of the error of the data.
_SPREAD: Final = 2.0
# Standard deviation of heights that are met, over their range: rounding errors of the fit. With
# `ADJACENT`, by trial, 50 to 500 points of r^2 and r^3 err by up to 27 times the estimate.
_LEAST_SIGMA: Final = 32 * ADJACENT


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
    if uncertainty is None and (points.x.size <= _FEW or scatter(points) < EXACT_SCATTER):
        uncertainty = 0.0
    relative = None if uncertainty is None else uncertainty / points.scale[1]
    found = _nearest(points, relative)
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


def _nearest(points: TablePoints, uncertainty: float | None) -> TableFit:
    """Return the smoothest admissible fit within the uncertainty, or the scatter.

    Parameters
    ----------
    uncertainty : of the heights over their range; 0 to meet them, None to estimate it.
    """
    basis = TableBasis(points)
    chosen = _Spectrum(basis, uncertainty, sharp=False)
    # A tip that lowers rounding errors is none.
    if chosen.score > EXACT_SCATTER**2:
        sharp = _Spectrum(basis, uncertainty, sharp=True)
        factor = _SHARPER if uncertainty == 0 else 1 + _SHARPER_MEASURED / points.x.size
        if sharp.score * factor < chosen.score:
            chosen = sharp
    coefficients = _by_rows(basis, chosen, np.full(basis.heights.shape[1], np.nan))
    # The posterior of the coefficients. Source: wahba.
    spread = _SPREAD * chosen.sigma * chosen.spread
    splines, jumps = coefficients[: basis.size - 1], coefficients[basis.size - 1 : -2 : 2]
    floor = _FLOOR
    if uncertainty == 0:
        # A flat that is met is flat up to rounding errors, and what is smooth has no jumps.
        flat = np.abs(splines) < _FLOOR
        splines[flat] = (ADJACENT * basis.places[1:])[flat]
        jumps[np.abs(jumps) < _FLOOR] = 0.0
        # Exact heights may leave a slope as near zero as rounding allows.
        floor = 0.0
        coefficients[-1] *= abs(coefficients[-1]) > EXACT_SCATTER
    # Where the slope falls by a step, g' is infinite and negative beyond it.
    falls = min(jumps.min(initial=0.0), coefficients[-1]) < 0
    if falls or basis.slopes(coefficients).min() <= floor:
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
    """Return the coefficients of least misfit and roughness of a spectrum, by QR.

    The largest rows come first, so that a small weight of the roughness keeps its digits.
    Source: cox-higham.

    Parameters
    ----------
    given : coefficients that are known, NaN for the others.
    """
    weight = basis.points.weight
    system = np.vstack([basis.heights * weight[:, None], chosen.rough])
    right = np.concatenate([basis.points.y * weight, np.zeros(len(chosen.rough))])
    order = np.argsort(-np.abs(system).max(axis=1), kind="stable")
    free = np.isnan(given)
    free[-1] &= chosen.sharp
    result = np.where(np.isnan(given), 0.0, given)
    right = (right - system @ result)[order]
    rotated, triangle, column = qr_multiply(system[order][:, free], right, pivoting=True)
    # Few points leave coefficients open: these are zero.
    size = np.abs(np.diagonal(triangle))
    rank = np.count_nonzero(size > EPS * size[0])
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
        points, self.sharp = basis.points, sharp
        matrix, goal = basis.heights * points.weight[:, None], points.y * points.weight
        smooth, rough = basis.by_roughness(sharp=sharp)
        seen, size, right = np.linalg.svd(matrix @ smooth, full_matrices=False)
        # Few points leave directions without misfit and roughness.
        known = size > EXACT_SCATTER * size[0]
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
        # Where few points leave all bends open, there is no smoothest one.
        weights = max(size2[0], EXACT_SCATTER**2 * float(np.square(bent).sum())) * _WEIGHTS
        left_out = weights[:, None] / np.add.outer(weights, size2)
        misfit = np.square(left_out * part).sum(axis=1) + rest
        freedom = fitted.size + (1 - left_out).sum(axis=1)
        count = points.x.size
        left_over = count - _GCV * freedom
        with np.errstate(divide="ignore", invalid="ignore"):
            score = np.where(left_over > 0, count * misfit / np.square(left_over), np.inf)
        at = best = int(np.argmin(score))
        if uncertainty is not None:
            allowed = np.maximum(count - freedom, 1.0) * max(uncertainty, ADJACENT) ** 2
            within = np.append(0, np.flatnonzero(misfit <= allowed))
            at = min(int(within[-1]), best if uncertainty else _WEIGHTS_OF_EXACT - 1)
        whole = left_out @ np.square(part) + rest
        # Few points that are met leave cross-validation nothing to judge a tip by.
        self.score = float(whole[-1] if uncertainty == 0 else score.min())
        self.rough = np.sqrt(weights[at]) * basis.roughness
        """Rows of the roughness."""
        likely = best if uncertainty == 0 else at
        # Of noise and roughness together. Source: wahba.
        scatter = float(np.sqrt(whole[likely] / max(count - fitted.size, 1)))
        self.sigma = max(uncertainty or scatter, _LEAST_SIGMA)
        # The points hardly tell the best weight from a smaller one, which leaves more open.
        plausible = min(likely, int(np.argmax(score <= score.min() * (1 + _PLAUSIBLE / count))))
        self.spread = np.hstack([smooth, rough / np.sqrt(size2 + weights[plausible])])
        """Square root of the inverse of the matrix of misfit and roughness."""
