"""Fit of modulus, contact point, offset and adhesion to a measured curve.

Source: notes, §15.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mdr_core import curve_segments
from mdr_core.curve_segments import BRANCHES, Drift, phases
from mdr_core.errors import InputError
from mdr_core.estimation import require_fitted
from mdr_core.fit import adhesive
from mdr_core.fit.model import PARAMETERS, Model
from mdr_core.fit.result import Fit, result
from mdr_core.layer import DepthCurve
from mdr_core.layer.equation import require_flat_within
from mdr_core.materials import RIGID, Body, Layer, from_bodies
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices
from mdr_core.validation import (
    as_curve,
    require_finite,
    require_not_negative,
    require_poissons_ratio,
    require_single_positive,
    require_type,
    single,
)


def solve(
    profile: Profile,
    *,
    indentation_depth: ArrayLike,
    normal_force: ArrayLike,
    fit: Sequence[str] = ("e_star", "contact_point"),
    e_star: float | None = None,
    noise: float | None = None,
    body_thickness: float | None = None,
    segment: str | None = None,
    poissons_ratio: float | None = None,
    indenter: Body | Literal["rigid"] = "rigid",
    layer: Layer | None = None,
    time: ArrayLike | None = None,
    drift: Literal["hold"] | None = None,
    drift_rate: float | None = None,
    drift_rate_error: float | None = None,
) -> Fit:
    """Return the parameters of a contact that fit a measured curve best.

    Source: notes, §15.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    indentation_depth, normal_force : the curve, in any order, with or without the approach before
        contact [length], [force], shape (k,).
    fit : parameters to fit, of "e_star", "contact_point", "force_offset" and "work_of_adhesion".
        All but the modulus are zero if they are not fitted. With adhesion the curve must be
        unloading, with or without points after the pull-off. Its points between the least force and
        the pull-off, states that only a stiff instrument holds, are left out.
    e_star : effective modulus, needed unless it is fitted [pressure].
    noise : standard deviation of the forces, by default of the residuals [force].
    body_thickness : see `from_bodies` [length].
    segment : "loading" or "unloading", by the direction of the depth in the order of the curve,
        without holds; by default all points.
    poissons_ratio : Poisson's ratio of the sample [1], for its Young's modulus
        E = (1 - nu^2)/(1/E* - 1/E_i*).
    indenter : the other body, of E_i*.
    layer : elastic layer that is the sample, with Poisson's ratio on a bonded base; not with
        adhesion.
    time : times of the points, non-decreasing, shape (k,). The drift is zero at time 0.
    drift : "hold" to subtract the drift of the depths: the slope of the least-squares line in the
        last hold at a constant force in the lower half of the range, times the time.
    drift_rate, drift_rate_error : drift to subtract, instead of one from a hold [length/time], and
        its standard deviation, 0 by default.

    Returns
    -------
    The parameters with standard errors and correlation, and the residuals.

    Raises
    ------
    InputError : lists of different lengths, too few points in contact, forces that fall with the
        depth, depths beyond the end of the profile, parameters that the curve does not determine,
        or an indenter that is softer than the contact.

    Examples
    --------
    >>> from mdr_core import normal
    >>> from mdr_core.profiles import Paraboloid
    >>> d = np.linspace(-1e-6, 2e-6, 61)
    >>> force = normal.solve(Paraboloid(0.01), 2e9, indentation_depth=np.maximum(d - 3e-7, 0.0))
    >>> found = solve(Paraboloid(0.01), indentation_depth=d, normal_force=force.normal_force)
    >>> print(f"{found.e_star:.6g} {found.contact_point:.6g}")
    2e+09 3e-07
    """
    require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    given = {"indentation_depth": indentation_depth, "normal_force": normal_force}
    depth, force = as_curve("depths", **given)
    if np.ptp(depth) == 0:
        raise InputError(("indentation_depth",), "must hold different depths")
    times = None if time is None else _times(depth, time)
    has_phases = segment is not None or drift == "hold"
    kinds = phases(depth, force, times) if has_phases else np.empty(0, dtype=np.str_)
    subtracted = _drift(depth, force, times, kinds, drift, drift_rate, drift_rate_error)
    drift_error = np.zeros(depth.size)
    if subtracted and times is not None:
        depth, drift_error = depth - subtracted.rate * times, subtracted.error * times
    points = np.arange(depth.size) if segment is None else _of_segment(kinds, segment)
    depth, force, drift_error = depth[points], force[points], drift_error[points]
    _require_rise(depth, force)
    require_fitted(fit, PARAMETERS, {"e_star": e_star})
    for name, value in (("e_star", e_star), ("noise", noise)):
        if value is not None:
            require_single_positive((name,), value)
    if "work_of_adhesion" in fit and profile.is_flat_punch:
        detail = "holds work_of_adhesion, on which only the pull-off of a flat punch depends"
        raise InputError(("fit",), detail)
    if "contact_point" not in fit and depth.max() > profile.largest_loads[0]:
        place = ("indentation_depth", int(points[depth.argmax()]))
        raise InputError(place, "lies beyond the end of the profile: give a longer one")
    if layer is not None and layer.poissons_ratio is None:
        layer = replace(layer, poissons_ratio=poissons_ratio)
    on_layer = None if layer is None else _on_layer(profile, layer, depth, fit, body_thickness)
    touches = np.ones(depth.size, dtype=bool)
    known = e_star, touches, on_layer, noise, body_thickness, drift_error
    model = Model(profile, depth, force, tuple(fit), *known)
    is_adhesive = "work_of_adhesion" in fit
    found = adhesive.solve(model) if is_adhesive else result(model)
    if subtracted:
        found = replace(found, drift_rate=subtracted.rate, drift_rate_error=subtracted.error)
    return found if poissons_ratio is None else _of_sample(found, poissons_ratio, indenter)


def _on_layer(
    profile: Profile,
    layer: Layer,
    depth: Array,
    fit: Sequence[str],
    body_thickness: float | None,
) -> DepthCurve:
    """Return the force over depth on a layer, or an InputError where it cannot be fitted."""
    if "work_of_adhesion" in fit:
        raise InputError(("layer",), "cannot be combined with a fitted work_of_adhesion")
    if body_thickness is not None:
        raise InputError(("layer",), "and body_thickness exclude each other: give one of them")
    require_flat_within(profile, layer, ("layer",))
    return DepthCurve.up_to(profile, layer, max(float(depth.max()), 2 * float(np.ptp(depth))))


def _of_sample(found: Fit, ratio: float, indenter: Body | Literal["rigid"]) -> Fit:
    """Return the fit with Young's modulus of the sample and the two bodies, or an InputError."""
    require_poissons_ratio(("poissons_ratio",), ratio)
    other = 0.0 if indenter == RIGID else found.e_star / from_bodies([indenter, RIGID]).e_star
    if other >= 1:
        raise InputError(
            ("indenter",), "is more compliant than the contact: check it and the units"
        )
    modulus = (1 - ratio) * (1 + ratio) * found.e_star / (1 - other)
    error = 0.0
    if "e_star" in found.fit:
        error = float(found.standard_errors[found.fit.index("e_star")]) / found.e_star
    # The warnings and the error of the model depend on both bodies.
    assumed = found.normal.material
    bodies = from_bodies([indenter, Body(modulus, ratio)], body_thickness=assumed.body_thickness)
    return replace(
        found,
        normal=replace(found.normal, material=replace(bodies, layer=assumed.layer)),
        youngs_modulus=modulus,
        youngs_modulus_error=modulus * error / (1 - other),
    )


def _times(depth: Array, time: ArrayLike) -> Array:
    """Return the times of the points, or an InputError."""
    _, times = as_curve("depths", indentation_depth=depth, time=time)
    if np.any(falls := np.diff(times) < 0):
        detail = "is less than the previous time: sort the points by time"
        raise InputError(("time", int(falls.argmax()) + 1), detail)
    return times


def _drift(
    depth: Array,
    force: Array,
    times: Array | None,
    kinds: NDArray[np.str_],
    drift: str | None,
    rate: float | None,
    error: float | None,
) -> Drift | None:
    """Return the drift to subtract from the depths, None without one.

    Parameters: the curve, `phases`, and see `solve`.
    """
    if rate is None and error is not None:
        raise InputError(("drift_rate_error",), "needs drift_rate: give both or neither")
    if rate is None and drift is None:
        return None
    if times is None:
        raise InputError(("time",), "times of the points are needed for the drift")
    if rate is not None:
        if drift is not None:
            raise InputError(("drift_rate",), "and drift exclude each other: give one of them")
        known = Drift(
            single(("drift_rate",), rate),
            single(("drift_rate_error",), 0.0 if error is None else error),
        )
        require_finite(("drift_rate",), np.asarray(known.rate))
        require_not_negative(("drift_rate_error",), np.asarray(known.error))
        return known
    found = curve_segments.drift(depth, force, times, kinds) if drift == "hold" else None
    if found is None:
        detail = (
            "must be hold, and the curve must have a hold at a constant force in the lower half"
        )
        raise InputError(("drift",), f"{detail} of its range: else give drift_rate")
    return found


def _of_segment(kinds: NDArray[np.str_], segment: str) -> Indices:
    """Return the points of a branch, or an InputError if there are fewer than two."""
    if segment not in BRANCHES:
        raise InputError(("segment",), f"must be one of {', '.join(BRANCHES)}")
    points = np.flatnonzero(kinds == segment)
    if points.size < 2:
        raise InputError(("segment",), f"is not in the curve: there is no {segment}")
    return points


def _require_rise(depth: Array, force: Array) -> None:
    """Raise InputError if the force falls with the depth.

    A fall to a pull-off is valid: its least force is farther from the median than the largest one.
    """
    height, order = force - np.median(force), np.argsort(depth, kind="stable")
    tenth = max(depth.size // 10, 1)
    falls = height[order[-tenth:]].mean() < height[order[:tenth]].mean()
    if falls and height.max() > -height.min():
        detail = (
            "the largest force lies at a small depth: reverse the sign of a separation or height"
        )
        raise InputError(("indentation_depth",), detail)
