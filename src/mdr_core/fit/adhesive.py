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
from mdr_core.doubles import TINY
from mdr_core.errors import InputError, Notice
from mdr_core.estimation import Precision
from mdr_core.fit.model import LEAST_C, Model
from mdr_core.fit.result import Fit, result
from mdr_core.residuals import ROUNDING
from mdr_core.typing import Array

# Multiple of the pull-off depth beyond which no point is in contact.
_AFTER: Final = 1.5
# Standard errors of the contact point by which the depth of the least force may be in error.
_NEAR: Final = 2.0
# Fewest points after a pull-off: one alone would decide on offset and adhesion.
_DETACHED: Final = 3
# Pull-off force over the noise, below which the largest jump may be due to noise.
_SEEN: Final = 3.0
# Increase of the sum of squares, over the variance of the noise, up to which w = 0 is as likely.
_NO_WORSE: Final = 0.1
# Increase of this sum up to which it determines the error of w, which slopes underestimate.
_FAR: Final = 9.0
# Probability by chance, below which points do not belong to a fit. Each curve has several tests.
_CHANCE: Final = 1e-4
# Bisections of the logarithm of the largest work of adhesion.
_HALVINGS: Final = 12
# Quantile of a one-sided limit of 95 %.
_LIMIT: Final = 1.645


def solve(curve: Model) -> Fit:
    """Return the fit, with a warning if its offset and the adhesion compensate each other."""
    model = _touching(curve)
    fit = _fit(curve, model)
    error = fit.standard_errors[fit.fit.index("work_of_adhesion")]
    is_told = not model.touches.all() or fit.work_of_adhesion > _LIMIT * error
    if "force_offset" not in fit.fit or is_told:
        return fit
    message = (
        "the curve hardly determines force_offset beside work_of_adhesion: include at least "
        f"{_DETACHED} points after the pull-off, or leave force_offset out of the fit"
    )
    return replace(fit, notices=(*fit.notices, Notice("undetermined", message)))


def _fit(curve: Model, model: Model) -> Fit:
    """Return the fit with adhesion, or with w held at 0 where this is as likely."""
    without, excess, place = _without_adhesion(model), inf, model.fit.index("work_of_adhesion")
    variance = _least(model) / model.free
    # Without adhesion a curve of tension alone does not rise.
    with suppress(InputError):
        excess = (without.squares - _least(model)) / variance
    if excess > _NO_WORSE:
        fit = result(model)
        growth = fit.work_of_adhesion / sqrt(excess) / fit.standard_errors[place]
        if excess > _FAR or growth <= 1:
            return fit
        changes = sqrt(growth**2 - 1) * fit.correlation[place] * fit.standard_errors
        return replace(fit, effects=np.column_stack([fit.effects, changes]))
    whole = _without_adhesion(curve)
    # The points that are left out may show adhesion.
    if not _is_noise(without, whole):
        return result(model)
    held = result(whole)
    work, changes = _largest(without, without.squares + variance * _LIMIT**2)
    changes = np.insert(changes, place, work) / _LIMIT
    effects = np.column_stack([np.insert(held.effects, place, 0.0, axis=0), changes])
    message = f"no adhesion is seen: work_of_adhesion is held at 0, and is below {work:.3g} (95 %)"
    return replace(
        held,
        fit=curve.fit,
        effects=effects,
        notices=(*held.notices, Notice("bound", message, work, None)),
    )


def _largest(model: Model, limit: float) -> tuple[float, Array]:
    """Return the largest w within a limit of squares, and how it changes the other parameters.

    At w = 0 the slopes in w and in the contact point of a cone are proportional: to the first order
    both would be open.
    """
    low, high, changes = 0.0, -2 * log10(LEAST_C), np.zeros(len(model.fit))
    unit = model.least_ratio * model.best["e_star"]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        forces, slopes = model.at(model.best | {"work_of_adhesion": unit * 10**middle})
        squares, left = inf, model.force - forces
        with suppress(InputError):
            precision = Precision.of(slopes, model.fit, "indentation_depth")
            squares = float(np.sum(np.square(left - precision.q @ (precision.q.T @ left))))
        if squares > limit:
            high = middle
        else:
            low, changes = middle, precision.changes(left)
    return unit * 10**low, changes


def _without_adhesion(model: Model) -> Model:
    return replace(model, fit=tuple(name for name in model.fit if name != "work_of_adhesion"))


def _is_noise(model: Model, more: Model) -> bool:
    """Return True if a model of more points leaves no more than their noise."""
    added = max(more.depth.size - model.depth.size, 1)
    squares = _least(model)
    increase = max(more.squares - squares, 0.0) / squares * model.free / added
    return bool(fdtrc(added, model.free, increase) > _CHANCE)


def _least(model: Model) -> float:
    """Return the sum of squares, or the sum for residuals of rounding error if it is larger.

    It is a divisor, and zero forces have no rounding error.
    """
    rounding = ROUNDING * float(np.abs(model.force).max())
    return max(model.squares, model.free * rounding**2, TINY)


def _states(model: Model) -> adhesion.Curve:
    c = sqrt(2 * pi * model.best["work_of_adhesion"] / model.best["e_star"])
    return adhesion.Curve(model.profile, c)


def _least_stable(model: Model) -> float:
    """Return the depth of the least force, less the error of the contact point.

    The least of noisy forces is low by chance: leaving out the points up to it would bias the fit.
    Near the depth of the least force the force hardly changes.
    """
    states = _states(model)
    depth = float(states.load("indentation_depth", states.at_pull_off))
    depth += model.best["contact_point"]
    if "contact_point" not in model.fit:
        return depth
    deviation = float(model.precision.deviations[model.fit.index("contact_point")])
    return depth - _NEAR * model.scatter * deviation


def _touching(curve: Model) -> Model:
    """Return the model of the states beyond the least force and after the pull-off.

    Points after the pull-off are all before the largest jump, if they fit the other states within
    the noise; else those well below the pull-off depth of a fit of these, or below the contact
    point of a fit without adhesion. In noise, states in contact alone do not determine the pull-off
    depth, because offset, adhesion and contact point compensate.
    """
    curve = curve.of(np.argsort(curve.depth, kind="stable"))
    depth, force = curve.depth, curve.force
    least = int(np.argmin(force)) + 1
    curve.require_points(depth.size - least)

    def extended(model: Model, count: int, first: int) -> Model:
        """Return a model of more points, of which the first `count` are after the pull-off.

        The given model is returned if they are not within the noise.
        """
        used = np.r_[:count, first : depth.size]
        more = replace(curve.of(used), touches=used >= count)
        with suppress(InputError):
            return more if _is_noise(model, more) else model
        return model

    jump = int(np.argmin(np.diff(force[:least]))) + 1 if least > 1 else 0
    model = beyond = curve.of(np.arange(least, depth.size))
    if jump >= _DETACHED:
        whole = extended(beyond, jump, least)
        drop = -whole.best["e_star"] * _states(whole).least["normal_force"]
        model = whole if drop > _SEEN * whole.scatter else beyond
    if model is beyond:
        pull_off = _states(beyond).least["indentation_depth"]
        ends = [beyond.best["contact_point"] + _AFTER * pull_off]
        # Noise that hides the pull-off leaves the contact point open, unless adhesion is left out.
        without = _without_adhesion(curve)
        with suppress(InputError):
            ends.append(_least_stable(without))
        for after in np.searchsorted(depth, ends).tolist():
            if model is beyond and after >= _DETACHED:
                model = extended(beyond, after, max(after, least))
    count = int(np.sum(~model.touches))
    near = int(np.searchsorted(depth, _least_stable(model)))
    first = max(near, jump, count)
    return extended(model, count, first) if first < least else model
