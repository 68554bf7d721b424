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
from typing import ClassVar, Final

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike
from scipy.optimize import least_squares
from scipy.special import chdtrc, fdtrc

from mdr_core import adhesion, normal, validity
from mdr_core import layer as layers
from mdr_core.doubles import EPS, TINY
from mdr_core.errors import InputError, Notice
from mdr_core.layer import DepthCurve
from mdr_core.materials import Layer, Material
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags
from mdr_core.validation import (
    as_curve,
    require_single_positive,
    require_type,
)

PARAMETERS: Final = ("e_star", "contact_point", "force_offset", "work_of_adhesion")
"""Quantities that can be fitted."""
# Contact points that are tried first, at points of the curve of about this number.
_TRIED: Final = 100
# Retractions that are tried first, at the contact radius of the whole range of depths and over it.
_RETRACTIONS: Final = np.logspace(-3, 0.5, 15)
# Multiple of the pull-off depth beyond which no point is in contact.
_AFTER: Final = 1.5
# Polynomials over the depth that the residuals of a right shape do not contain, and the probability
# of a warning that is false.
_DEGREES, _FALSE_ALARM = 8, 0.01
_Parameters = dict[str, float]
# Scatter over the largest force that is rounding error.
_ROUNDING: Final = 1e-11


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
    """Bound on the numerical error of the parameters, over their standard errors or sizes [1]."""
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
        found = list(self.normal.warnings_without_bodies)
        if self.misfit < _FALSE_ALARM:
            left = " and ".join(name for name in PARAMETERS[2:] if name not in self.fit)
            remedy = f"; fit {left} too, if the curve has them" if left else ""
            message = (
                f"the residuals are not noise (probability {self.misfit:.1g}): the shape, the "
                "range of the fit or the model is wrong, and the standard errors do not hold"
                f"{remedy}"
            )
            found.append(Notice("misfit", message, self.misfit, _FALSE_ALARM))
        return tuple(found)


def solve(
    profile: Profile,
    *,
    indentation_depth: ArrayLike,
    normal_force: ArrayLike,
    fit: Sequence[str] = ("e_star", "contact_point"),
    e_star: float | None = None,
    noise: float | None = None,
    body_thickness: float | None = None,
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
    layer : elastic layer that is the sample, with its Poisson's ratio on a bonded base; not with
        adhesion.

    Returns
    -------
    The parameters with standard errors and correlation, and the residuals.

    Raises
    ------
    InputError : lists of different lengths, too few points in contact, forces that fall with the
        depth, or depths beyond the end of the profile.

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
    depth, force = _curve(indentation_depth, normal_force)
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
    if "work_of_adhesion" in fit and profile.has_no_partial_slip:
        detail = "holds work_of_adhesion, on which only the pull-off of a flat punch depends"
        raise InputError(("fit",), detail)
    if layer is not None and "work_of_adhesion" in fit:
        raise InputError(("layer",), "cannot be combined with a fitted work_of_adhesion")
    if layer is not None and body_thickness is not None:
        raise InputError(("layer",), "and body_thickness exclude each other: give one of them")
    deepest = profile.largest_loads
    if deepest is not None and "contact_point" not in fit and depth.max() > deepest[0]:
        place = ("indentation_depth", int(depth.argmax()))
        raise InputError(place, "lies beyond the end of the profile: give a longer one")
    curve = None
    if layer is not None:
        curve = DepthCurve.up_to(profile, layer, max(float(depth.max()), 2 * float(np.ptp(depth))))
    touches = np.ones(depth.size, dtype=bool)
    model = _Model(profile, depth, force, tuple(fit), e_star, touches, curve)
    model, found = _adhesive(model) if "work_of_adhesion" in fit else (model, model.best())
    return model.result(found, noise, body_thickness)


def _curve(indentation_depth: ArrayLike, normal_force: ArrayLike) -> tuple[Array, Array]:
    """Return depths and forces, or an InputError."""
    depth, force = as_curve(
        "depths", indentation_depth=indentation_depth, normal_force=normal_force
    )
    if np.ptp(depth) == 0:
        raise InputError(("indentation_depth",), "must hold different depths")
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
    touching, whole = without_others(0), without_others(jump)
    found = touching.best()
    if not jump:
        return touching, found
    with suppress(InputError):
        joint, free = whole.best(), touching.depth.size - len(curve.fit)
        rounding = free * (_ROUNDING * float(np.abs(force).max())) ** 2
        squares = max(touching.squares(found), rounding)
        more = max(whole.squares(joint) - squares, 0.0)
        if fdtrc(jump, free, more / jump / (squares / free)) > _FALSE_ALARM:
            return whole, joint
    c = sqrt(2 * pi * found["work_of_adhesion"] / found["e_star"])
    pull_off = adhesion.Curve(curve.profile, c).least["indentation_depth"]
    after = int(np.searchsorted(depth, found["contact_point"] + _AFTER * pull_off))
    model = without_others(min(after, jump))
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

    def best(self) -> _Parameters:
        """Return the parameters of the least sum of squares, or an InputError."""
        low, high = float(self.depth.min()), float(self.depth.max())
        limits, tried, works = (0.0, 0.0), np.zeros(1), np.zeros(1)
        deepest = (
            inf if self.profile.largest_loads is None else float(self.profile.largest_loads[0])
        )
        if self.on_layer is not None:
            deepest = self.on_layer.deepest
        if "contact_point" in self.fit:
            # From as far before the curve as it is long; the curve has to stay on the profile.
            limits = max(2 * low - high, high - deepest), high
            tried = np.linspace(*limits, _TRIED, endpoint=False)
        if "work_of_adhesion" in self.fit:
            reach = normal.solve(self.profile, 1.0, indentation_depth=min(high - low, deepest))
            works = (_RETRACTIONS * (high - low)) ** 2 / (2 * pi * reach.contact_radius)
        some = np.argsort(self.depth)[:: max(1, self.depth.size // _TRIED)]
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
        return self.refined(start, *limits)

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
        units = start | {"contact_point": high - low, "force_offset": size}
        unit = np.array([units[name] for name in self.fit])
        ends = {"contact_point": (low, high), "force_offset": (-inf, inf)}
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
        slopes = np.column_stack([columns[name] for name in self.fit])
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
        scale = np.linalg.norm(slopes, axis=0)
        # The inverse of a triangle, because the square of the matrix would lose half of the digits.
        inverse = np.linalg.inv(np.linalg.qr(slopes / scale, mode="r"))
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
        condition = float(np.linalg.norm(inverse, 2))
        interpolated = 0.0 if self.on_layer is None else self.on_layer.error
        sigma = noise or scatter
        return Fit(
            self.fit,
            contact,
            self.depth,
            forces,
            found["contact_point"],
            found["force_offset"],
            work,
            sigma * deviations / scale,
            (inverse @ inverse.T) / np.multiply.outer(deviations, deviations),
            residual,
            sigma,
            self._misfit(slopes / scale, residual, noise),
            condition * (contact.error_estimate + interpolated),
        )

    def _misfit(self, slopes: Array, residual: Array, noise: float | None) -> float:
        """Probability of residuals like these by chance.

        Polynomials of the order of the depths are fitted beside the parameters: their part in the
        sum of squares has the F-distribution, or, of known noise, the whole that of chi^2.
        """
        if np.abs(residual).max() <= _ROUNDING * np.abs(self.force).max():
            return 1.0
        count, fitted = slopes.shape
        squares = float(np.sum(np.square(residual)))
        by_size = 1.0
        if noise is not None:
            by_size = 2 * float(chdtrc(count - fitted, squares / noise**2))
        # In the order of the depth, so that uneven spacing changes nothing.
        rank = np.empty(count)
        rank[np.argsort(self.depth, kind="stable")] = np.linspace(-1, 1, count)
        degrees = min(_DEGREES, (count - fitted) // 3)
        if not degrees:
            return by_size
        basis, _ = np.linalg.qr(np.hstack([slopes, legendre.legvander(rank, degrees)[:, 1:]]))
        left = residual - basis @ (basis.T @ residual)
        free = count - basis.shape[1]
        rest = float(np.sum(np.square(left)))
        ratio = (squares - rest) / degrees / max(rest / free, TINY)
        return min(float(fdtrc(degrees, free, ratio)), by_size)
