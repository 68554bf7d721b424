"""Fit of an unloading curve with adhesion, or with the work of adhesion held at 0.

Source: notes, §15.
"""

from contextlib import suppress
from dataclasses import replace
from math import inf, log10, pi, sqrt
from typing import Final

import numpy as np
from scipy.special import fdtrc

from mdr_core import adhesion
from mdr_core.errors import InputError, Notice
from mdr_core.estimation import Precision
from mdr_core.fit.model import LEAST_C, Model, Parameters
from mdr_core.fit.result import Fit, both, result
from mdr_core.residuals import ROUNDING
from mdr_core.typing import Array

# Multiple of the pull-off depth beyond which no point is in contact.
_AFTER: Final = 1.5
# Standard errors of the contact point, within which points are at the depth of the least force.
_NEAR: Final = 2.0
# Fewest points after a pull-off: one alone would decide on offset and adhesion.
_DETACHED: Final = 3
# Pull-off force over the noise, below which the largest jump may be due to noise.
_SEEN: Final = 3.0
# Increase of the sum of squares, over the variance of the noise, up to which w = 0 is as likely.
_NO_WORSE: Final = 0.1
# Increase up to which the error of w follows from the increase: by the slopes it is too small.
_FAR: Final = 9.0
# Probability by chance, below which points do not belong to a fit. Each curve has several tests.
_CHANCE: Final = 1e-4
# Bisections of the logarithm of the largest work of adhesion.
_HALVINGS: Final = 12
# Quantile of a one-sided limit of 95 %.
_LIMIT: Final = 1.645


def solve(curve: Model) -> Fit:
    """Return the fit, with a warning if its offset and the adhesion compensate each other."""
    model, found = _touching(curve)
    fit = _fit(curve, model, found)
    error = fit.standard_errors[fit.fit.index("work_of_adhesion")]
    is_told = not model.touches.all() or fit.work_of_adhesion > _LIMIT * error
    if "force_offset" not in fit.fit or is_told:
        return fit
    message = (
        "the curve hardly determines force_offset beside work_of_adhesion: include at least "
        f"{_DETACHED} points after the pull-off, or leave force_offset out of the fit"
    )
    return replace(fit, notices=(*fit.notices, Notice("undetermined", message)))


def _fit(curve: Model, model: Model, found: Parameters) -> Fit:
    """Return the fit with adhesion, or with w held at 0 where this is as likely."""
    least = max(model.squares(found), _rounding(model))
    without, at_zero = _without_adhesion(model), inf
    # Without adhesion a curve of tension alone does not rise.
    with suppress(InputError):
        at_zero = without.squares(zero := without.best())
    excess, place = (at_zero - least) / least * model.free, curve.fit.index("work_of_adhesion")
    if excess > _NO_WORSE:
        fit = result(model, found)
        errors, correlation = fit.standard_errors, fit.correlation
        growth = found["work_of_adhesion"] / sqrt(excess) / errors[place]
        if excess > _FAR or growth <= 1:
            return fit
        changes = sqrt(growth**2 - 1) * correlation[place] * errors
        errors, correlation = both(errors, correlation, changes)
        return replace(fit, standard_errors=errors, correlation=correlation)
    whole = _without_adhesion(curve)
    # The points that are left out may show adhesion.
    if not _is_noise(without, zero, whole, values := whole.best()):
        return result(model, found)
    held = result(whole, values)
    limit = at_zero + least / model.free * _LIMIT**2
    work, changes = _largest(without, zero, limit)
    errors, correlation = both(
        np.insert(held.standard_errors, place, 0.0),
        np.insert(np.insert(held.correlation, place, 0.0, axis=0), place, 0.0, axis=1),
        np.insert(changes, place, work) / _LIMIT,
    )
    message = f"no adhesion is seen: work_of_adhesion is held at 0, and is below {work:.3g} (95 %)"
    return replace(
        held,
        fit=curve.fit,
        standard_errors=errors,
        correlation=correlation,
        notices=(*held.notices, Notice("bound", message, work, None)),
    )


def _largest(model: Model, zero: Parameters, limit: float) -> tuple[float, Array]:
    """Return the largest w within a limit of squares, and how it changes the other parameters.

    At w = 0 the slopes in w and in the contact point of a cone are proportional: to the first order
    both would be open.
    """
    low, high, changes = 0.0, -2 * log10(LEAST_C), np.zeros(len(model.fit))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        work = model.least_ratio * zero["e_star"] * 10**middle
        forces, slopes = model.at(zero | {"work_of_adhesion": work})
        squares, left = inf, model.force - forces
        with suppress(InputError):
            precision = Precision.of(slopes, model.fit, "indentation_depth")
            squares = float(np.sum(np.square(left - precision.q @ (precision.q.T @ left))))
        if squares > limit:
            high = middle
        else:
            low, changes = middle, precision.changes(left)
    return model.least_ratio * zero["e_star"] * 10**low, changes


def _without_adhesion(model: Model) -> Model:
    return replace(model, fit=tuple(name for name in model.fit if name != "work_of_adhesion"))


def _is_noise(model: Model, found: Parameters, more: Model, joint: Parameters) -> bool:
    """Return True if a model of more points, with its fit, leaves no more than their noise."""
    added = max(more.depth.size - model.depth.size, 1)
    squares = max(model.squares(found), _rounding(model))
    increase = max(more.squares(joint) - squares, 0.0) / squares * model.free / added
    return bool(fdtrc(added, model.free, increase) > _CHANCE)


def _rounding(model: Model) -> float:
    """Return the sum of squares of residuals that are rounding error."""
    return model.free * (ROUNDING * float(np.abs(model.force).max())) ** 2


def _states(model: Model, found: Parameters) -> adhesion.Curve:
    c = sqrt(2 * pi * found["work_of_adhesion"] / found["e_star"])
    return adhesion.Curve(model.profile, c)


def _least_stable(model: Model, found: Parameters) -> float:
    """Return the depth of the least force, less the error of the contact point.

    To leave out points up to the least of noisy forces, which is low by chance, would bias the fit.
    About the depth of the least force the force hardly changes.
    """
    states = _states(model, found)
    depth = found["contact_point"] + float(states.load("indentation_depth", states.at_pull_off))
    if "contact_point" not in model.fit:
        return depth
    deviations = Precision.of(model.at(found)[1], model.fit, "indentation_depth").deviations
    scatter = sqrt(model.squares(found) / model.free)
    return depth - _NEAR * scatter * float(deviations[model.fit.index("contact_point")])


def _touching(curve: Model) -> tuple[Model, Parameters]:
    """Return the model of the states beyond the least force and after the pull-off, and its fit.

    Points after the pull-off are all before the largest jump, if they fit the other states within
    the noise; else those well below the pull-off depth of a fit of these, or below the contact
    point of a fit without adhesion. States in contact alone leave the pull-off depth open in noise,
    as offset, adhesion and contact point compensate.
    """
    order = np.argsort(curve.depth, kind="stable")
    depth, force, drift_error = (
        each[order] for each in (curve.depth, curve.force, curve.drift_error)
    )
    least = int(np.argmin(force)) + 1
    curve.require_points(depth.size - least)

    def with_detached(count: int, first: int) -> Model:
        used = np.r_[:count, first : depth.size]
        return replace(
            curve,
            depth=depth[used],
            force=force[used],
            drift_error=drift_error[used],
            touches=used >= count,
        )

    def extended(
        model: Model, found: Parameters, count: int, first: int
    ) -> tuple[Model, Parameters]:
        """Return a model of more points, if these are within the noise, or the given one."""
        more = with_detached(count, first)
        with suppress(InputError):
            if _is_noise(model, found, more, joint := more.best()):
                return more, joint
        return model, found

    jump = int(np.argmin(np.diff(force[:least]))) + 1 if least > 1 else 0
    model = with_detached(0, least)
    found = model.best()
    if jump >= _DETACHED:
        whole, joint = extended(model, found, jump, least)
        drop = -joint["e_star"] * _states(curve, joint).least["normal_force"]
        if whole is not model and drop > _SEEN * sqrt(whole.squares(joint) / whole.free):
            model, found = whole, joint
    if model.touches.all():
        pull_off = _states(curve, found).least["indentation_depth"]
        ends = [found["contact_point"] + _AFTER * pull_off]
        # Noise that hides the pull-off leaves the contact point open, unless adhesion is left out.
        without = _without_adhesion(curve)
        with suppress(InputError):
            ends.append(_least_stable(without, without.best()))
        for after in np.searchsorted(depth, ends).tolist():
            if model.touches.all() and after >= _DETACHED:
                model, found = extended(model, found, after, max(after, least))
    count = int(np.sum(~model.touches))
    near = int(np.searchsorted(depth, _least_stable(model, found)))
    first = max(near, jump, count)
    return extended(model, found, count, first) if first < least else (model, found)
