"""Parameters that fit a curve, and warnings of what their standard errors leave out.

Source: notes, §15.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Final

import numpy as np
from scipy.special import chdtrc, stdtrit

from mdr_core import adhesion, normal, residuals, validity
from mdr_core import layer as layers
from mdr_core.doubles import EPS
from mdr_core.errors import InputError, Notice
from mdr_core.estimation import LeastSquaresFit
from mdr_core.fit.model import PARAMETERS, Model
from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.residuals import ROUNDING
from mdr_core.typing import Array

# Ratio of a half interval to the half from the standard error, or its inverse, if lopsided.
_LOPSIDED: Final = 1.5
# Growth of a standard error if one point is left out: at most 1.9 in curves of six points with
# white noise, and 4.6 (median) where one point is taken for the pull-off.
_ONE_POINT: Final = 2.5
_CAUSES: Final = {
    "misfit": "the shape, the range of the fit or the model is wrong",
    "two_branches": "loading and unloading differ: give the segment to fit",
    "noise_grows": "two branches sorted by depth, or noise that grows with the force: keep the "
    "order of time, and give the segment",
    "correlated_noise": "neighbouring errors are alike: filtered, drifting or of a wrong shape",
}


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Fit(LeastSquaresFit):
    """Fitted parameters with their standard errors."""

    normal: NormalContact
    """Fitted contact at the largest depth."""
    indentation_depth: Array
    """Measured depths, in the coordinate of the curve [length], shape (k,).

    With adhesion those that are fitted, in ascending order.
    """
    normal_force: Array
    """Fitted forces at these depths [force], shape (k,)."""
    contact_point: float
    """Depth d_0 of first contact in the coordinate of the curve [length]."""
    force_offset: float
    """Force F_0 without contact [force]."""
    work_of_adhesion: float
    """Work of adhesion w [force/length], 0 if it is not fitted."""
    youngs_modulus: float | None = None
    """E of the sample [pressure], None without its Poisson's ratio."""
    youngs_modulus_error: float | None = None
    """Standard deviation of E by that of E* [pressure]."""
    drift_rate: float | None = None
    """Subtracted drift rate of the depths [length/time], None without one."""
    drift_rate_error: float | None = None
    """Standard error of the drift rate, included in the other standard errors [length/time]."""
    quantities: ClassVar[tuple[str, ...]] = (
        *("fit", "e_star", "contact_point", "force_offset", "work_of_adhesion"),
        *("standard_errors", "correlation", "noise", "misfit"),
        *("youngs_modulus", "youngs_modulus_error", "drift_rate", "drift_rate_error"),
        *("indentation_depth", "normal_force", "residual"),
    )
    g_star: ClassVar[None] = None

    @property
    def e_star(self) -> float:
        """Effective modulus E* [pressure]."""
        return float(self.normal.e_star)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        found = [each for each in self.normal.warnings_without_bodies if each.code != "accuracy"]
        found += validity.notices([validity.inaccurate(self.error_estimate)])
        return *found, *self.notices


def result(model: Model) -> Fit:
    """Return the fit with the best parameters, or an InputError."""
    found, residual, (forces, _) = model.best, model.residual, model.fitted
    model.require_points(int(np.sum(forces != found["force_offset"])))
    precision, noise = model.precision, model.noise or model.scatter
    effects = noise * precision.effects
    if model.drift_error.any():
        _, by_contact_point = replace(model, fit=("contact_point",)).at(found)
        by_drift = precision.changes(by_contact_point[:, 0] * model.drift_error)
        effects = np.column_stack([effects, by_drift])
    contact = _deepest(model)
    interpolated = 0.0 if model.on_layer is None else model.on_layer.error
    misfit, doubts = _misfit(model)
    return Fit(
        fit=model.fit,
        normal=contact,
        indentation_depth=model.depth,
        normal_force=forces,
        contact_point=found["contact_point"],
        force_offset=found["force_offset"],
        work_of_adhesion=found["work_of_adhesion"],
        effects=effects,
        residual=residual,
        noise=noise,
        misfit=misfit,
        error_estimate=precision.error(contact.error_estimate + interpolated, residual, forces),
        notices=(*doubts, *_open(model), *_decided_by_one(model)),
    )


def _deepest(model: Model) -> NormalContact:
    """Return the contact at the largest depth of the curve."""
    found, layer = model.best, None if model.on_layer is None else model.on_layer.layer
    material = Material(found["e_star"], body_thickness=model.body_thickness, layer=layer)
    depth = max(float(model.depth.max()) - found["contact_point"], 0.0)
    if work := found["work_of_adhesion"]:
        return adhesion.solve(model.profile, material, work, indentation_depth=depth)
    solve = normal.solve if layer is None else layers.solve
    return solve(model.profile, material, indentation_depth=depth)


def _misfit(model: Model) -> tuple[float, tuple[Notice, ...]]:
    """Return the probability of such residuals by chance, and the warning if it is low.

    With a known noise the sum of squares is compared with the distribution of chi^2 as well.
    """
    found = residuals.misfit(model.depth, model.precision.q, model.residual, model.force)
    if model.noise is not None:
        squares = float(np.sum(np.square(model.residual / model.noise)))
        by_size = 2 * float(chdtrc(model.free, squares))
        found["misfit"] = min(found.get("misfit", 1.0), by_size)
    # The work of adhesion is not fitted on a layer, nor under a flat punch.
    is_open = model.on_layer is None and not model.profile.is_flat_punch
    possible = PARAMETERS[2:] if is_open else PARAMETERS[2:3]
    left = " and ".join(name for name in possible if name not in model.fit)
    return residuals.judged(found, _CAUSES, left and f"; fit {left} too, if the curve has them")


def _open(model: Model) -> tuple[Notice, ...]:
    """Return the warning that the interval of the contact point does not follow from its error.

    At its ends the least squares for a given contact point exceed the minimum by the quantile of
    the F-distribution. Raises InputError if it has no end.
    """
    scatter = model.scatter
    is_exact = scatter <= ROUNDING * float(np.abs(model.force).max())
    if "contact_point" not in model.fit or "work_of_adhesion" in model.fit or is_exact:
        return ()
    point, place, free = model.best["contact_point"], model.fit.index("contact_point"), model.free
    quantile = float(stdtrit(free, 0.975))
    half = quantile * scatter * float(model.precision.deviations[place])
    least = free * scatter**2 * (1 + quantile**2 / free)

    far, halves = model.farthest, half * np.multiply.outer([1 / _LOPSIDED, _LOPSIDED], [-1, 1])
    places = np.maximum(np.append(far, point + halves), far)
    reduced = model.reduced(model.depth - places[:, None], 0.0)[0]
    within = model.linear(reduced)[0] <= least
    if within[0]:
        detail = (
            "does not determine contact_point: start the curve nearer to it, fit fewer "
            "parameters, or give a longer profile"
        )
        raise InputError(("indentation_depth",), detail)
    if within[1:3].all() and not within[3:].any():
        return ()
    message = (
        "the curve hardly determines contact_point: its interval is lopsided, and those of the "
        "other parameters too; start nearer to the contact point, or fit fewer parameters"
    )
    return (Notice("undetermined", message),)


def _decided_by_one(model: Model) -> tuple[Notice, ...]:
    """Return the warning of the point whose omission makes a standard error grow most.

    Without point i the error of parameter j grows by (1 + (C J^T)_ji^2/(C_jj (1 - h_i)))^(1/2).
    """
    if not model.fit:
        return ()
    q, inverse = model.precision.q, model.precision.inverse
    rest = np.maximum(1 - np.sum(q**2, axis=1), EPS)
    parts = inverse / np.linalg.norm(inverse, axis=1)[:, None]
    growth = np.sqrt(1 + np.square(parts @ q.T) / rest)
    place, point = np.unravel_index(int(growth.argmax()), growth.shape)
    largest = float(growth[place, point])
    if largest <= _ONE_POINT:
        return ()
    message = (
        f"{model.fit[place]} rests on one point, at the depth {model.depth[point]:.6g}: without "
        f"it the standard error is {largest:.2g} times as large; measure more points there"
    )
    return (Notice("one_point", message, largest, _ONE_POINT),)
