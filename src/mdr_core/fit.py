"""Modulus, contact point and offset from a measured curve of force over depth.

Least squares of F = E* F^(d - d_0) + F_0 with the exact slope dF^/dd = 2 a: linear in E* and F_0,
and searched in d_0, because the sum of squares may have several minima.

Source: notes, §15.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Final, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike
from scipy.special import chdtrc, fdtrc

from mdr_core import normal, validity
from mdr_core.errors import InputError, Notice
from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array
from mdr_core.validation import (
    FINITE,
    as_numbers,
    first_index,
    require_single_positive,
    require_type,
)

PARAMETERS: Final = ("e_star", "contact_point", "force_offset")
"""Quantities that can be fitted."""
# Contact points that are tried first, part of the range of depths before the first of them, and
# points of the curve that are used there.
_TRIED, _BEFORE, _USED = 120, 1.0, 100
# Minima of these from which the search starts, and its largest number of steps.
_STARTS, _STEPS = 3, 100
# Relative change of the contact point over the range of depths that is rounding error.
_CONVERGED: Final = 1e-13
# Points in contact, at least, in addition to the parameters.
_SPARE: Final = 2
# Polynomials over the depth that the residuals of a right shape do not contain, and the probability
# of a warning that is false.
_DEGREES, _FALSE_ALARM = 8, 0.01
# Fall of the force below that before contact, over its rise, that is adhesion.
_DIP: Final = 0.1
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
    """Measured depths, in the coordinate of the curve [length], shape (k,)."""
    normal_force: Array
    """Fitted forces at these depths [force], shape (k,)."""
    contact_point: float
    """Depth d_0 of first contact in the coordinate of the curve [length]."""
    force_offset: float
    """Force F_0 without contact [force]."""
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
    slips_from: ClassVar[float] = np.inf

    @property
    def e_star(self) -> float:
        """Effective modulus E* [pressure]."""
        return float(self.normal.e_star)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        found = list(self.normal.warnings_without_bodies)
        if self.misfit < _FALSE_ALARM:
            measured = self.normal_force + self.residual
            before = measured[self.indentation_depth.argmin()]
            remedy = "" if "force_offset" in self.fit else "; fit the force_offset too"
            if before - measured.min() > _DIP * (measured.max() - before):
                remedy = "; the force falls below that before contact: the fit leaves out adhesion"
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
    rtol: float = 1e-10,
) -> Fit:
    """Return modulus, contact point and force offset that fit a measured curve best.

    Source: notes, §15.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    indentation_depth, normal_force : the curve, in any order, with or without the approach before
        contact [length], [force], shape (k,).
    fit : parameters to fit, of "e_star", "contact_point" and "force_offset". The contact point and
        the offset are zero if they are not fitted.
    e_star : effective modulus, needed unless it is fitted [pressure].
    noise : standard deviation of the forces, by default that of the residuals [force].
    body_thickness : see `from_bodies` [length].
    rtol : accuracy required of the contact at the largest depth, 1e-13 to 1e-3.

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
    model = _Model(profile, depth, force, tuple(fit), e_star)
    deepest = profile.largest_loads
    if deepest is not None and "contact_point" not in fit and depth.max() > deepest[0]:
        place = ("indentation_depth", int(depth.argmax()))
        raise InputError(place, "lies beyond the end of the profile: give a longer one")
    return model.result(model.contact_point(), noise, body_thickness, rtol)


def _curve(indentation_depth: ArrayLike, normal_force: ArrayLike) -> tuple[Array, Array]:
    """Return depths and forces, or an InputError."""
    depth = np.atleast_1d(as_numbers(("indentation_depth",), indentation_depth))
    force = np.atleast_1d(as_numbers(("normal_force",), normal_force))
    for name, values in (("indentation_depth", depth), ("normal_force", force)):
        if not np.isfinite(values).all():
            raise InputError((name, *first_index(~np.isfinite(values))), FINITE)
    if depth.shape != force.shape:
        raise InputError(("normal_force",), f"has {force.size} values for {depth.size} depths")
    if np.ptp(depth) == 0:
        raise InputError(("indentation_depth",), "must hold different depths")
    return depth, force


class _Point(NamedTuple):
    """Best linear parameters for a contact point, with slopes and residuals of the forces."""

    parameters: dict[str, float]
    slopes: Array
    residual: Array

    @property
    def squares(self) -> float:
        return float(np.sum(np.square(self.residual)))


@dataclass(frozen=True, eq=False)
class _Model:
    """Curve, and the model whose linear parameters follow from a contact point."""

    profile: Profile
    depth: Array
    force: Array
    fit: tuple[str, ...]
    e_star: float | None

    def contact_point(self) -> float:
        """Return the contact point of the least sum of squares."""
        if "contact_point" not in self.fit:
            return 0.0
        low, high = float(self.depth.min()), float(self.depth.max())
        start = low - _BEFORE * (high - low)
        if self.profile.largest_loads is not None:
            # The curve has to stay on the profile.
            start = max(start, high - float(self.profile.largest_loads[0]))
        some = np.argsort(self.depth)[:: max(1, self.depth.size // _USED)]
        coarse = _Model(self.profile, self.depth[some], self.force[some], self.fit, self.e_star)
        tried = np.linspace(start, high, _TRIED, endpoint=False)
        pressed = np.maximum(coarse.depth - tried[:, None], 0.0)
        reduced = normal.solve(self.profile, 1.0, indentation_depth=pressed).normal_force
        squares = np.array([np.sum(np.square(coarse.linear(row)[1])) for row in reduced])
        inner = np.pad(squares, 1, constant_values=np.inf)
        minima = np.flatnonzero((squares <= inner[:-2]) & (squares <= inner[2:]))
        best = minima[np.argsort(squares[minima])][:_STARTS]
        found = [coarse.refined(float(tried[i]), start, high) for i in best]
        return self.refined(min(found, key=lambda d0: coarse.at(d0).squares), start, high)

    def refined(self, d0: float, low: float, high: float) -> float:
        """Return the contact point of the nearest minimum by the Gauss-Newton method."""
        span, here = high - low, self.at(d0)
        for _ in range(_STEPS):
            scale = np.linalg.norm(here.slopes, axis=0)
            scale = np.where(scale > 0, scale, 1.0)
            change, *_ = np.linalg.lstsq(here.slopes / scale, here.residual, rcond=None)
            step = float((change / scale)[self.fit.index("contact_point")])
            # Half of a step that leads too far.
            while abs(step) > _CONVERGED * span:
                moved = min(max(d0 + step, low), high - _CONVERGED * span)
                there = self.at(moved)
                if there.squares < here.squares:
                    break
                step /= 2
            else:
                break
            d0, here = moved, there
        return d0

    def linear(self, reduced: Array) -> tuple[dict[str, float], Array]:
        """Return the best modulus and offset for forces over E*, and the residuals."""
        columns = {"e_star": reduced, "force_offset": np.ones_like(reduced)}
        fitted = [name for name in columns if name in self.fit]
        goal = self.force if self.e_star is None else self.force - self.e_star * reduced
        known = {"e_star": self.e_star or 0.0, "force_offset": 0.0}
        if not fitted:
            return known, goal
        matrix = np.column_stack([columns[name] for name in fitted])
        scale = np.maximum(np.abs(matrix).max(axis=0), np.finfo(float).tiny)
        solved, *_ = np.linalg.lstsq(matrix / scale, goal, rcond=None)
        return known | dict(zip(fitted, (solved / scale).tolist(), strict=True)), (
            goal - matrix / scale @ solved
        )

    def at(self, d0: float) -> _Point:
        """Return the best fit with a contact point."""
        pressed = np.maximum(self.depth - d0, 0.0)
        contact = normal.solve(self.profile, 1.0, indentation_depth=pressed)
        linear, residual = self.linear(contact.normal_force)
        columns = {
            "e_star": contact.normal_force,
            "contact_point": -linear["e_star"] * contact.normal_stiffness * (self.depth > d0),
            "force_offset": np.ones_like(pressed),
        }
        slopes = np.column_stack([columns[name] for name in self.fit])
        return _Point(linear, slopes, residual)

    def result(
        self, d0: float, noise: float | None, body_thickness: float | None, rtol: float
    ) -> Fit:
        """Return the fit at the contact point, or an InputError."""
        parameters, slopes, residual = self.at(d0)
        touching = int(np.sum(self.depth > d0))
        if touching < len(self.fit) + _SPARE:
            ends = (self.profile.largest_loads or (np.inf,))[0]
            remedy = "measure deeper, or more points"
            if ends < np.ptp(self.depth):
                remedy = f"the profile ends at the depth {ends:.3g}: give a longer one"
            detail = f"too few points are in contact, {touching}: {remedy}"
            raise InputError(("indentation_depth",), detail)
        if parameters["e_star"] <= 0:
            detail = "falls with the depth: a compressive force is positive, reverse its sign"
            raise InputError(("normal_force",), detail)
        free = self.depth.size - len(self.fit)
        scatter = float(np.sqrt(np.sum(np.square(residual)) / free))
        scale = np.linalg.norm(slopes, axis=0)
        # The inverse of a triangle, because the square of the matrix would lose half of the digits.
        inverse = np.linalg.inv(np.linalg.qr(slopes / scale, mode="r"))
        deviations = np.linalg.norm(inverse, axis=1)
        contact = normal.solve(
            self.profile,
            Material(parameters["e_star"], body_thickness=body_thickness),
            indentation_depth=max(float(self.depth.max()) - d0, 0.0),
            rtol=rtol,
        )
        condition = float(np.linalg.norm(inverse, 2))
        sigma = noise or scatter
        return Fit(
            self.fit,
            contact,
            self.depth,
            self.force - residual,
            d0,
            parameters["force_offset"],
            sigma * deviations / scale,
            (inverse @ inverse.T) / np.multiply.outer(deviations, deviations),
            residual,
            sigma,
            self._misfit(slopes / scale, residual, noise),
            condition * contact.error_estimate,
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
        basis, _ = np.linalg.qr(np.hstack([slopes, legendre.legvander(rank, degrees)[:, 1:]]))
        left = residual - basis @ (basis.T @ residual)
        free = count - basis.shape[1]
        rest = float(np.sum(np.square(left)))
        ratio = (squares - rest) / degrees / max(rest / free, np.finfo(float).tiny)
        return min(float(fdtrc(degrees, free, ratio)), by_size)
