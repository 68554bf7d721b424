"""Modulus, contact point, offset and adhesion from a measured curve of force over depth.

Least squares of F = E* F^(d - d_0; w/E*) + F_0 with exact slopes, from the best of many d_0 and
w/E*, because the sum of squares may have several minima. With adhesion F^ is that of the outermost
stable state, as on unloading, and zero after the pull-off.

Source: notes, §15.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import inf, pi, sqrt
from typing import ClassVar, Final, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares
from scipy.special import chdtrc, fdtrc, stdtrit

from mdr_core import adhesion, normal, residuals, validity
from mdr_core import layer as layers
from mdr_core.doubles import EPS
from mdr_core.errors import InputError, Notice
from mdr_core.layer import DepthCurve
from mdr_core.materials import RIGID, Body, Layer, Material, from_bodies
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.residuals import FALSE_ALARM, ROUNDING
from mdr_core.typing import Array, Flags
from mdr_core.validation import (
    as_curve,
    require_poissons_ratio,
    require_single_positive,
    require_type,
)

PARAMETERS: Final = ("e_star", "contact_point", "force_offset", "work_of_adhesion")
"""Quantities that can be fitted."""
SEGMENTS: Final = {"loading": 1, "unloading": -1}
"""Branches of a curve, and the direction of the depth on each."""
# Points of the curve at which contact points are tried first, about; of these contact points some
# lie within the curve, and others before it, so many a decade, from a part of its length to a
# multiple of it, without adhesion and with. The upper part of a curve starts far from its contact.
_POINTS, _WITHIN, _BEFORE = 100, 50, 20
_NEAREST, _FARTHEST, _FARTHEST_ADHESIVE = 1e-3, 1e4, 1.0
# Retractions that are tried first, at the contact radius of the whole range of depths and over it.
_RETRACTIONS: Final = np.logspace(-3, 0.5, 15)
# Multiple of the pull-off depth beyond which no point is in contact.
_AFTER: Final = 1.5
# Fewest points after a pull-off: one alone would decide on offset and adhesion.
_DETACHED: Final = 3
# Least c = (2 pi w/E*)^(1/2) over the root of the range of depths, at which the contact is that
# without adhesion to rounding, and has its slope in w; and the sum of squares, over the variance of
# the noise, that w = 0 may cost.
_LEAST_C, _NO_WORSE = 1e-6, 0.1
# Singular value of the slopes, of unit columns, over the largest, at which two parameters have the
# same effect, and the least part of a parameter in that effect. Rounding leaves 1e-16; fits that
# determine their parameters have 1e-6 or more.
_SAME, _PART = 1e-8, 0.1
# Either half of an interval over that by the standard error, or the inverse, if it is lopsided.
_LOPSIDED: Final = 1.5
# Growth of a standard error without a single point: at most 1.9 in curves of six points whose
# noise is white, and 4.6 (median) where one point is taken for the pull-off.
_ONE_POINT: Final = 2.5
# Quantile of a one-sided limit of 95 %.
_LIMIT: Final = 1.645
_Parameters = dict[str, float]
_REMEDIES: Final = {
    "misfit": "the shape, the range of the fit or the model is wrong",
    "two_branches": "loading and unloading differ: give the segment to fit",
    "noise_grows": "two branches sorted by depth, or noise that grows with the force: keep the "
    "order of time, and give the segment",
    "correlated_noise": "neighbouring errors are alike: filtered, drifting or of a wrong shape",
}


@dataclass(frozen=True, eq=False, repr=False)
class Fit(validity.ContactResults):
    """Fitted parameters with their standard errors."""

    fit: tuple[str, ...]
    """Names of the fitted parameters, in the order of `standard_errors` and `correlation`."""
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
    standard_errors: Array
    """Standard deviations of the fitted parameters, shape (n,)."""
    correlation: Array
    """Their correlation, shape (n, n) [1]."""
    residual: Array
    """Measured less fitted forces [force], shape (k,)."""
    noise: float
    """Standard deviation of the forces, as given or by the residuals [force]."""
    misfit: float
    """Probability that residuals of the right shape are as far from noise as these [1]."""
    error_estimate: float
    """Bound on the numerical error of the parameters, over their sizes [1]."""
    notices: tuple[Notice, ...]
    """Warnings about the residuals and the parameters."""
    youngs_modulus: float | None = None
    """E of the sample [pressure], None without its Poisson's ratio."""
    youngs_modulus_error: float | None = None
    """Standard deviation of E by that of E* [pressure]."""
    quantities: ClassVar[tuple[str, ...]] = (
        "fit",
        "e_star",
        "contact_point",
        "force_offset",
        "work_of_adhesion",
        "standard_errors",
        "correlation",
        "noise",
        "misfit",
        "youngs_modulus",
        "youngs_modulus_error",
        "indentation_depth",
        "normal_force",
        "residual",
    )
    method: ClassVar[str] = "least_squares"
    g_star: ClassVar[None] = None

    @property
    def e_star(self) -> float:
        """Effective modulus E* [pressure]."""
        return float(self.normal.e_star)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        return *self.normal.warnings_without_bodies, *self.notices


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
) -> Fit:
    """Return the parameters of a contact that fit a measured curve best.

    Source: notes, §15.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    indentation_depth, normal_force : the curve, in any order, with or without the approach before
        contact [length], [force], shape (k,).
    fit : parameters to fit, of "e_star", "contact_point", "force_offset" and "work_of_adhesion".
        All but the modulus are zero if they are not fitted. A curve with adhesion is that of
        unloading, with or without points after the pull-off. Its points between the least force and
        the pull-off, states that only a stiff instrument holds, are left out.
    e_star : effective modulus, needed unless it is fitted [pressure].
    noise : standard deviation of the forces, by default that of the residuals [force].
    body_thickness : see `from_bodies` [length].
    segment : "loading" or "unloading", by the direction of the depth in the order of the curve; by
        default all points.
    poissons_ratio : Poisson's ratio of the sample [1], for its Young's modulus
        E = (1 - nu^2)/(1/E* - 1/E_i*).
    indenter : the other body, of E_i*.
    layer : elastic layer that is the sample, with Poisson's ratio on a bonded base; not with
        adhesion.

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
    >>> from mdr_core.profiles import Paraboloid
    >>> d = np.linspace(-1e-6, 2e-6, 61)
    >>> force = normal.solve(Paraboloid(0.01), 2e9, indentation_depth=np.maximum(d - 3e-7, 0.0))
    >>> found = solve(Paraboloid(0.01), indentation_depth=d, normal_force=force.normal_force)
    >>> print(f"{found.e_star:.6g} {found.contact_point:.6g}")
    2e+09 3e-07
    """
    require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    depth, force = _curve(indentation_depth, normal_force, segment)
    unknown = [name for name in fit if name not in PARAMETERS]
    if unknown or not fit or len(set(fit)) < len(fit):
        raise InputError(("fit",), f"must hold some of {', '.join(PARAMETERS)}, each once")
    if ("e_star" in fit) == (e_star is not None):
        reason = (
            "is fitted: leave it out" if e_star is not None else "is needed unless it is fitted"
        )
        raise InputError(("e_star",), reason)
    for name, value in (("e_star", e_star), ("noise", noise)):
        if value is not None:
            require_single_positive((name,), value)
    if "work_of_adhesion" in fit and profile.is_flat_punch:
        detail = "holds work_of_adhesion, on which only the pull-off of a flat punch depends"
        raise InputError(("fit",), detail)
    deepest = profile.largest_loads
    if deepest is not None and "contact_point" not in fit and depth.max() > deepest[0]:
        place = ("indentation_depth", int(depth.argmax()))
        raise InputError(place, "lies beyond the end of the profile: give a longer one")
    if layer is not None and layer.poissons_ratio is None:
        layer = replace(layer, poissons_ratio=poissons_ratio)
    curve = None if layer is None else _on_layer(profile, layer, depth, fit, body_thickness)
    touches = np.ones(depth.size, dtype=bool)
    model = _Model(profile, depth, force, tuple(fit), e_star, touches, curve)
    if "work_of_adhesion" in fit:
        result = _with_adhesion(model, noise, body_thickness)
    else:
        result = model.result(model.best(), noise, body_thickness)
    return result if poissons_ratio is None else _of_sample(result, poissons_ratio, indenter)


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
    return DepthCurve.up_to(profile, layer, max(float(depth.max()), 2 * float(np.ptp(depth))))


def _of_sample(found: Fit, ratio: float, indenter: Body | Literal["rigid"]) -> Fit:
    """Return the fit with Young's modulus of the sample, or an InputError."""
    require_poissons_ratio(("poissons_ratio",), ratio)
    other = 0.0
    if indenter != RIGID:
        other = found.e_star / from_bodies([indenter, RIGID]).e_star
    if other >= 1:
        raise InputError(
            ("indenter",), "is more compliant than the contact: check it and the units"
        )
    modulus = (1 - ratio) * (1 + ratio) * found.e_star / (1 - other)
    error = 0.0
    if "e_star" in found.fit:
        error = float(found.standard_errors[found.fit.index("e_star")]) / found.e_star
    return replace(
        found, youngs_modulus=modulus, youngs_modulus_error=modulus * error / (1 - other)
    )


def _with_adhesion(curve: "_Model", noise: float | None, body_thickness: float | None) -> Fit:
    """Return the fit with adhesion, or with w held at 0 where this is as likely."""
    others = tuple(name for name in curve.fit if name != "work_of_adhesion")
    model, found = _adhesive(curve)
    least, free = model.squares(found), model.depth.size - len(curve.fit)
    least = max(least, free * (ROUNDING * float(np.abs(model.force).max())) ** 2)
    without = replace(model, fit=others)
    at_zero = inf
    # Without adhesion a curve of tension alone does not rise.
    with suppress(InputError):
        at_zero = without.squares(without.best())
    if at_zero - least > _NO_WORSE * least / free:
        return model.result(found, noise, body_thickness)
    whole = replace(curve, fit=others)
    values = whole.best()
    held = whole.result(values, noise, body_thickness)
    least_work = curve.least_ratio * held.e_star
    inverse, scale, _ = _inverted(curve.at(values | {"work_of_adhesion": least_work})[1], curve.fit)
    place = curve.fit.index("work_of_adhesion")
    error = held.noise * float(np.linalg.norm(inverse[place]) / scale[place])
    work = _LIMIT * error
    errors = np.insert(held.standard_errors, place, error)
    correlation = np.insert(np.insert(held.correlation, place, 0.0, axis=0), place, 0.0, axis=1)
    correlation[place, place] = 1.0
    message = (
        f"no adhesion is seen: work_of_adhesion is held at 0, and is below {work:.3g} (95 %); the "
        "other standard errors hold for this"
    )
    notices = (*held.notices, Notice("bound", message, work, None))
    return replace(
        held, fit=curve.fit, standard_errors=errors, correlation=correlation, notices=notices
    )


def _inverted(slopes: Array, names: Sequence[str]) -> tuple[Array, Array, Array]:
    """Return the inverse triangle of slopes of unit columns, their sizes, and orthonormal slopes.

    Raises InputError if the curve cannot tell parameters apart.
    """
    scale = np.linalg.norm(slopes, axis=0)
    lost = list(np.array(names)[~(scale > 0)])
    if not lost and np.isfinite(slopes).all():
        q, triangle = np.linalg.qr(slopes / scale)
        _, size, effects = np.linalg.svd(triangle)
        if not size.size or size[-1] >= _SAME * size[0]:
            # A triangle, because the square of the matrix would lose half of the digits.
            return np.linalg.inv(triangle), scale, q
        lost = [name for name, part in zip(names, effects[-1], strict=True) if abs(part) > _PART]
    which = " and ".join(lost or names)
    told = "cannot be told apart: give" if len(lost) > 1 else "has no effect: leave out"
    raise InputError(("indentation_depth",), f"does not determine {which}, which {told} one")


def _curve(
    indentation_depth: ArrayLike, normal_force: ArrayLike, segment: str | None
) -> tuple[Array, Array]:
    """Return depths and forces of a branch, or an InputError."""
    depth, force = as_curve(
        "depths", indentation_depth=indentation_depth, normal_force=normal_force
    )
    if np.ptp(depth) == 0:
        raise InputError(("indentation_depth",), "must hold different depths")
    if segment is not None:
        if segment not in SEGMENTS:
            raise InputError(("segment",), f"must be one of {', '.join(SEGMENTS)}")
        used = residuals.directions(depth) == SEGMENTS[segment]
        if np.sum(used) < 2:
            raise InputError(("segment",), f"is not in the curve: there is no {segment}")
        depth, force = depth[used], force[used]
    # The force falls to a pull-off too, whose least force is farther from most forces than the
    # largest one.
    height, order = force - np.median(force), np.argsort(depth, kind="stable")
    tenth = max(depth.size // 10, 1)
    falls = height[order[-tenth:]].mean() < height[order[:tenth]].mean()
    if falls and height.max() > -height.min():
        detail = (
            "the largest force lies at a small depth: reverse the sign of a separation or height"
        )
        raise InputError(("indentation_depth",), detail)
    return depth, force


def _require_points(touching: int, model: "_Model") -> None:
    if touching <= len(model.fit):
        ends = (model.profile.largest_loads or (inf,))[0]
        remedy = "measure deeper, or more points"
        if ends < np.ptp(model.depth):
            remedy = f"the profile ends at the depth {ends:.3g}: give a longer one"
        detail = f"too few points are in contact, {touching}: {remedy}"
        raise InputError(("indentation_depth",), detail)


def _adhesive(curve: "_Model") -> "tuple[_Model, _Parameters]":
    """Model of the states beyond the least force and of the points after the pull-off, and its fit.

    The latter are all before the largest jump, if they fit the former within their noise; else
    those that also lie well below the pull-off depth that the former show. The former alone leave
    it open in noise, as offset, adhesion and contact point compensate.
    """
    order = np.argsort(curve.depth, kind="stable")
    depth, force = curve.depth[order], curve.force[order]
    least = int(np.argmin(force))
    _require_points(depth.size - 1 - least, curve)

    def without_others(count: int) -> _Model:
        used = np.r_[:count, least + 1 : depth.size]
        return replace(curve, depth=depth[used], force=force[used], touches=used >= count)

    jump = int(np.argmin(np.diff(force[: least + 1]))) + 1 if least else 0
    jump = jump if jump >= _DETACHED else 0
    touching, whole = without_others(0), without_others(jump)
    found = touching.best()
    if not jump:
        return touching, found
    with suppress(InputError):
        joint, free = whole.best(), touching.depth.size - len(curve.fit)
        rounding = free * (ROUNDING * float(np.abs(force).max())) ** 2
        squares = max(touching.squares(found), rounding)
        more = max(whole.squares(joint) - squares, 0.0)
        if fdtrc(jump, free, more / jump / (squares / free)) > FALSE_ALARM:
            return whole, joint
    c = sqrt(2 * pi * found["work_of_adhesion"] / found["e_star"])
    pull_off = adhesion.Curve(curve.profile, c).least["indentation_depth"]
    after = int(np.searchsorted(depth, found["contact_point"] + _AFTER * pull_off))
    after = min(after, jump)
    model = without_others(after if after >= _DETACHED else 0)
    return model, model.best()


def _forces(
    profile: Profile,
    pressed: Array,
    work: float,
    touches: Flags,
    on_layer: DepthCurve | None = None,
) -> tuple[Array, Array, Array]:
    """Forces over E* at depths from first contact, and their slopes in the depth and in w/E*.

    With adhesion the force at less depth than that of the least force is the least.
    """
    if on_layer is not None:
        force, slope = on_layer(np.maximum(pressed, 0.0))
        return force, np.where(pressed > 0, slope, 0.0), np.zeros_like(pressed)
    if not work:
        contact = normal.solve(profile, 1.0, indentation_depth=np.maximum(pressed, 0.0))
        slope = np.where(pressed > 0, contact.normal_stiffness, 0.0)
        return contact.normal_force, slope, np.zeros_like(pressed)
    force, by_depth, by_work = np.zeros((3, *pressed.shape))
    c, at = sqrt(2 * pi * work), np.broadcast_to(touches, pressed.shape)
    # A contact that would spread beyond the profile fits nothing.
    with suppress(InputError):
        curve = adhesion.Curve(profile, c)
        ends = np.array([curve.at_pull_off, curve.stable["indentation_depth"][1][-1]])
        held = np.clip(pressed[at], *curve.load("indentation_depth", ends))
        edge, _ = curve.outermost("indentation_depth", held)
        a = profile.contact_radius(edge)
        # dF/dd = 2 E* (a - steep), and dF/dc = -2 E* a^(1/2) steep at the same depth.
        steep = a / curve.excess(0.5, edge)
        force[at] = curve.load("normal_force", edge)
        by_depth[at], by_work[at] = 2 * (a - steep), -2 * np.sqrt(a) * steep * pi / c
    return force, by_depth, by_work


@dataclass(frozen=True, eq=False)
class _Model:
    """Curve, and the model that is fitted to it."""

    profile: Profile
    depth: Array
    force: Array
    fit: tuple[str, ...]
    e_star: float | None
    touches: Flags
    """Points that are not after a pull-off."""
    on_layer: DepthCurve | None = None
    """Force over depth on a layer, None on a half-space."""

    @property
    def deepest(self) -> float:
        """Largest depth on the profile, or of the curve on a layer [length]."""
        if self.on_layer is not None:
            return self.on_layer.deepest
        return float((self.profile.largest_loads or (inf,))[0])

    @property
    def reach(self) -> float:
        """Distance of the first contact point from the curve, over the length of the curve [1]."""
        return _FARTHEST_ADHESIVE if "work_of_adhesion" in self.fit else _FARTHEST

    @property
    def farthest(self) -> float:
        """First contact point that is tried [length]; the curve has to stay on the profile."""
        before = float(self.depth.min()) - self.reach * float(np.ptp(self.depth))
        return max(before, float(self.depth.max()) - self.deepest)

    @property
    def least_ratio(self) -> float:
        """Least w/E* that is fitted [length]."""
        return _LEAST_C**2 * float(np.ptp(self.depth)) / (2 * pi)

    def best(self) -> _Parameters:
        """Return the parameters of the least sum of squares, or an InputError."""
        low, high = float(self.depth.min()), float(self.depth.max())
        tried, works, limit = np.zeros(1), np.zeros(1), self.farthest
        if "contact_point" in self.fit:
            count = int(_BEFORE * np.log10(self.reach / _NEAREST))
            before = (high - low) * np.geomspace(self.reach, _NEAREST, count)
            tried = np.append(low - before, np.linspace(low, high, _WITHIN, endpoint=False))
            tried = np.append(limit, tried[tried > limit])
        if "work_of_adhesion" in self.fit:
            most = min(high - low, self.deepest)
            reached = normal.solve(self.profile, 1.0, indentation_depth=most)
            works = (_RETRACTIONS * (high - low)) ** 2 / (2 * pi * reached.contact_radius)
        some = np.argsort(self.depth)[:: max(1, self.depth.size // _POINTS)]
        used = {name: getattr(self, name)[some] for name in ("depth", "force", "touches")}
        coarse = replace(self, **used)
        starts: list[tuple[float, _Parameters]] = []
        for work in works.tolist():
            pressed = coarse.depth - tried[:, None]
            forces, *_ = _forces(self.profile, pressed, work, coarse.touches, self.on_layer)
            for point, reduced in zip(tried.tolist(), forces, strict=True):
                squares, modulus, offset = coarse.linear(reduced)
                values = modulus, point, offset, work * modulus
                starts.append((squares, dict(zip(PARAMETERS, values, strict=True))))
        _, start = min(starts, key=lambda each: each[0])
        if start["e_star"] <= 0:
            detail = "does not rise as on this profile: compression is positive, reverse its sign"
            raise InputError(("normal_force",), detail)
        return self.refined(start, limit, high) if self.fit else start

    def squares(self, parameters: _Parameters) -> float:
        """Return the sum of squares of the residuals."""
        return float(np.sum(np.square(self.at(parameters)[0] - self.force)))

    def linear(self, reduced: Array) -> tuple[float, float, float]:
        """Return the least squares, modulus and offset for forces over E*."""
        top = float(np.abs(reduced).max()) or 1.0
        columns = np.column_stack([reduced / top, np.ones_like(reduced)])
        values = np.array([(self.e_star or 0.0) * top, 0.0])
        free = ["e_star" in self.fit, "force_offset" in self.fit]
        values[free], *_ = np.linalg.lstsq(columns[:, free], self.force - columns @ values)
        left = self.force - columns @ values
        return float(left @ left), float(values[0]) / top, float(values[1])

    def refined(self, start: _Parameters, low: float, high: float) -> _Parameters:
        """Return the parameters of the nearest minimum.

        Parameters
        ----------
        start : parameters from which the search starts.
        low, high : limits of the contact point [length].
        """
        size = float(np.abs(self.force).max()) or 1.0
        units = start | {"contact_point": float(np.ptp(self.depth)), "force_offset": size}
        unit = np.array([units[name] for name in self.fit])
        ends = {"contact_point": (low, high), "force_offset": (-inf, inf)}
        ends["work_of_adhesion"] = self.least_ratio * start["e_star"], inf
        bounds = np.transpose([ends.get(name, (0.0, inf)) for name in self.fit]) / unit

        def at(x: Array) -> _Parameters:
            return start | dict(zip(self.fit, (x * unit).tolist(), strict=True))

        def residual(x: Array) -> Array:
            return (self.at(at(x))[0] - self.force) / size

        def jacobian(x: Array) -> Array:
            return self.at(at(x))[1] * unit / size

        first = np.array([start[name] for name in self.fit]) / unit
        try:
            with np.errstate(all="ignore"):
                found = least_squares(
                    *(residual, first, jacobian, bounds),
                    x_scale="jac",
                    ftol=EPS,
                    xtol=EPS,
                    gtol=None,
                )
        except (ValueError, np.linalg.LinAlgError):
            found = None
        if found is None or not np.isfinite(found.x).all():
            detail = "does not determine the parameters: measure deeper, or fit fewer of them"
            raise InputError(("indentation_depth",), detail)
        return at(found.x)

    def at(self, parameters: _Parameters) -> tuple[Array, Array]:
        """Return the forces of the model, and their slopes in the fitted parameters."""
        e_star, d0, offset, work = (parameters[name] for name in PARAMETERS)
        ratio = work / e_star
        pressed = self.depth - d0
        forces, by_depth, by_work = _forces(
            self.profile, pressed, ratio, self.touches, self.on_layer
        )
        columns = {
            # At constant w.
            "e_star": forces - ratio * by_work,
            "contact_point": -e_star * by_depth,
            "force_offset": np.ones_like(forces),
            "work_of_adhesion": by_work,
        }
        slopes = np.reshape([columns[name] for name in self.fit], (len(self.fit), forces.size)).T
        return e_star * forces + offset, slopes

    def result(self, found: _Parameters, noise: float | None, body_thickness: float | None) -> Fit:
        """Return the fit with the best parameters, or an InputError.

        Parameters
        ----------
        found : the parameters.
        noise, body_thickness : see `solve`.
        """
        forces, slopes = self.at(found)
        _require_points(int(np.sum(forces != found["force_offset"])), self)
        residual = self.force - forces
        free = self.depth.size - len(self.fit)
        scatter = float(np.sqrt(np.sum(np.square(residual)) / free))
        inverse, scale, q = _inverted(slopes, self.fit)
        deviations = np.linalg.norm(inverse, axis=1)
        layer = None if self.on_layer is None else self.on_layer.layer
        material = Material(found["e_star"], body_thickness=body_thickness, layer=layer)
        work = found["work_of_adhesion"]
        solve: Callable[..., NormalContact] = normal.solve
        if work:
            solve = partial(adhesion.solve, work_of_adhesion=work)
        if layer is not None:
            solve = layers.solve
        deepest = max(float(self.depth.max()) - found["contact_point"], 0.0)
        contact = solve(self.profile, material, indentation_depth=deepest)
        condition = float(np.linalg.norm(inverse, 2)) if self.fit else 1.0
        interpolated = 0.0 if self.on_layer is None else self.on_layer.error
        # The step of Gauss and Newton to the minimum; the search ends where squares no longer fall.
        step = np.abs(inverse @ (q.T @ residual)).max(initial=0.0)
        unfinished = 2 * float(step / np.linalg.norm(self.force))
        sigma = noise or scatter
        errors = sigma * deviations / scale
        is_noisy = scatter > ROUNDING * float(np.abs(self.force).max())
        code, misfit = self._misfit(slopes, residual, noise)
        return Fit(
            self.fit,
            contact,
            self.depth,
            forces,
            found["contact_point"],
            found["force_offset"],
            work,
            errors,
            (inverse @ inverse.T) / np.multiply.outer(deviations, deviations),
            residual,
            sigma,
            misfit,
            condition * (contact.error_estimate + interpolated) + unfinished,
            (
                *self._doubts(code, misfit),
                *self._open(found, scatter * deviations / scale, scatter if is_noisy else 0.0),
                *self._decided_by_one(inverse / deviations[:, None], q),
            ),
        )

    def _doubts(self, code: str, misfit: float) -> tuple[Notice, ...]:
        """Return the warning about the residuals, if there is one."""
        if misfit >= FALSE_ALARM:
            return ()
        left = " and ".join(name for name in PARAMETERS[2:] if name not in self.fit)
        remedy = f"; fit {left} too, if the curve has them" if left and code == "misfit" else ""
        message = (
            f"the residuals are not noise (probability {misfit:.1g}): {_REMEDIES[code]}, and the "
            f"standard errors do not hold{remedy}"
        )
        return (Notice(code, message, misfit, FALSE_ALARM),)

    def _open(self, found: _Parameters, errors: Array, scatter: float) -> tuple[Notice, ...]:
        """Return the warning that the interval of the contact point is not that of its error.

        At its ends the least squares for a given contact point exceed the minimum by the quantile
        of the F-distribution. Raises InputError if it has no end.
        """
        point, free = found["contact_point"], self.depth.size - len(self.fit)
        if "contact_point" not in self.fit or "work_of_adhesion" in self.fit or not scatter:
            return ()
        quantile = float(stdtrit(free, 0.975))
        half = quantile * float(errors[self.fit.index("contact_point")])
        least = free * scatter**2 * (1 + quantile**2 / free)

        def within(place: float) -> bool:
            pressed = self.depth - place
            reduced, *_ = _forces(self.profile, pressed, 0.0, self.touches, self.on_layer)
            return self.linear(reduced)[0] <= least

        if within(self.farthest):
            detail = (
                "does not determine contact_point: start the curve nearer to it, fit fewer "
                "parameters, or give a longer profile"
            )
            raise InputError(("indentation_depth",), detail)
        ends = [point + sign * half * _LOPSIDED for sign in (-1, 1)]
        nearer = [point + sign * half / _LOPSIDED for sign in (-1, 1)]
        if all(map(within, nearer)) and not any(within(max(end, self.farthest)) for end in ends):
            return ()
        message = (
            "the curve hardly determines contact_point: its interval is lopsided, and those of the "
            "other parameters too; start nearer to the contact point, or fit fewer parameters"
        )
        return (Notice("undetermined", message),)

    def _decided_by_one(self, rows: Array, q: Array) -> tuple[Notice, ...]:
        """Return the warning of a point without which a standard error would grow most.

        Without point i the error of parameter j grows by (1 + (C J^T)_ji^2/(C_jj (1 - h_i)))^(1/2).
        """
        if not self.fit:
            return ()
        rest = np.maximum(1 - np.sum(q * q, axis=1), EPS)
        growth = np.sqrt(1 + np.square(rows @ q.T) / rest)
        place, point = np.unravel_index(int(growth.argmax()), growth.shape)
        largest = float(growth[place, point])
        if largest <= _ONE_POINT:
            return ()
        message = (
            f"{self.fit[place]} rests on one point, at the depth {self.depth[point]:.6g}: without "
            f"it the standard error is {largest:.2g} times as large; measure more points there"
        )
        return (Notice("one_point", message, largest, _ONE_POINT),)

    def _misfit(self, slopes: Array, residual: Array, noise: float | None) -> tuple[str, float]:
        """Return the likeliest fault of the residuals, and the probability of such by chance.

        With a known noise the sum of squares is compared with the distribution of chi^2 as well.
        """
        scale = np.linalg.norm(slopes, axis=0)
        found = residuals.misfit(self.depth, slopes / scale, residual, self.force)
        if noise is not None:
            squares, free = float(np.sum(np.square(residual))), residual.size - len(self.fit)
            by_size = 2 * float(chdtrc(free, squares / noise**2))
            found["misfit"] = min(found.get("misfit", 1.0), by_size)
        return residuals.worst(found)
