"""Fit of an unloading curve with adhesion, or with the work of adhesion held at 0.

Source: notes, §15.
"""

from contextlib import suppress
from dataclasses import replace
from math import inf, pi, sqrt
from typing import Final

import numpy as np
from scipy.special import fdtrc

from mdr_core import adhesion
from mdr_core.errors import InputError, Notice
from mdr_core.estimation import Precision
from mdr_core.fit.model import Model, Parameters
from mdr_core.fit.result import Fit, result
from mdr_core.residuals import FALSE_ALARM, ROUNDING

# Multiple of the pull-off depth beyond which no point is in contact.
_AFTER: Final = 1.5
# Standard errors of the contact point, within which points are at the depth of the least force.
_NEAR: Final = 2.0
# Fewest points after a pull-off: one alone would decide on offset and adhesion.
_DETACHED: Final = 3
# Increase of the sum of squares, over the variance of the noise, up to which w = 0 is as likely.
_NO_WORSE: Final = 0.1
# Quantile of a one-sided limit of 95 %.
_LIMIT: Final = 1.645


def solve(curve: Model) -> Fit:
    """Return the fit with adhesion, or with w held at 0 where this is as likely."""
    model, found = _touching(curve)
    least = max(model.squares(found), _rounding(model))
    others = tuple(name for name in curve.fit if name != "work_of_adhesion")
    without, at_zero = replace(model, fit=others), inf
    # Without adhesion a curve of tension alone does not rise.
    with suppress(InputError):
        at_zero = without.squares(without.best())
    if at_zero - least > _NO_WORSE * least / model.free:
        return result(model, found)
    whole = replace(curve, fit=others)
    values = whole.best()
    held = result(whole, values)
    values["work_of_adhesion"] = curve.least_ratio * held.e_star
    _, slopes = curve.at(values)
    place, count = curve.fit.index("work_of_adhesion"), len(curve.fit)
    deviations = Precision.of(slopes, curve.fit, "indentation_depth").deviations
    error = held.noise * float(deviations[place])
    work, correlation = _LIMIT * error, np.eye(count)
    rest = np.arange(count) != place
    correlation[np.ix_(rest, rest)] = held.correlation
    message = (
        f"no adhesion is seen: work_of_adhesion is held at 0, and is below {work:.3g} (95 %); the "
        "other standard errors hold for this"
    )
    return replace(
        held,
        fit=curve.fit,
        standard_errors=np.insert(held.standard_errors, place, error),
        correlation=correlation,
        notices=(*held.notices, Notice("bound", message, work, None)),
    )


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

    The latter are all before the largest jump, if they fit the former within their noise; else
    those that also lie well below the pull-off depth that the former show. The former alone leave
    it open in noise, as offset, adhesion and contact point compensate.
    """
    order = np.argsort(curve.depth, kind="stable")
    depth, force, drift_error = (
        each[order] for each in (curve.depth, curve.force, curve.drift_error)
    )
    least = int(np.argmin(force)) + 1
    curve.require_points(depth.size - least)

    def with_detached(count: int) -> Model:
        used = np.r_[:count, least : depth.size]
        return replace(
            curve,
            depth=depth[used],
            force=force[used],
            drift_error=drift_error[used],
            touches=used >= count,
        )

    jump = int(np.argmin(np.diff(force[:least]))) + 1 if least > 1 else 0
    touching = with_detached(0)
    found = touching.best()
    near = int(np.searchsorted(depth, _least_stable(touching, found)))
    if max(near, jump) < least:
        least = max(near, jump)
        touching = with_detached(0)
        found = touching.best()
    if jump < _DETACHED:
        return touching, found
    with suppress(InputError):
        whole, free = with_detached(jump), touching.free
        joint = whole.best()
        squares = max(touching.squares(found), _rounding(touching))
        more = max(whole.squares(joint) - squares, 0.0)
        if fdtrc(jump, free, more / jump / (squares / free)) > FALSE_ALARM:
            return whole, joint
    pull_off = _states(curve, found).least["indentation_depth"]
    after = int(np.searchsorted(depth, found["contact_point"] + _AFTER * pull_off))
    after = min(after, jump)
    if after < _DETACHED:
        return touching, found
    model = with_detached(after)
    return model, model.best()
