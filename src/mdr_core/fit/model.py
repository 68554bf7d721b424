"""Model of a measured curve, F = E* F^(d - d_0; w/E*) + F_0, and its least squares.

The best of many d_0 and w/E* is refined with exact slopes, because the sum of squares may have
several minima. With adhesion F^ is the force of the outermost stable state, as on unloading, and
zero after the pull-off.

Source: notes, §15.
"""

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, pi, sqrt
from typing import ClassVar, Final, Self

import numpy as np

from mdr_core import adhesion, normal
from mdr_core.errors import InputError
from mdr_core.estimation import CurveModel, Parameters, linear
from mdr_core.layer import DepthCurve
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices

PARAMETERS: Final = ("e_star", "contact_point", "force_offset", "work_of_adhesion")
"""Quantities that can be fitted."""
# First trials of the contact point: points of the curve used, about; trials within the curve, and
# trials per decade before it, as the upper part of a curve starts far from its contact.
_POINTS, _WITHIN, _BEFORE = 100, 50, 20
# Distances of these trials before the curve over its length: least, and largest without adhesion
# and with it.
_NEAREST, _FARTHEST, _FARTHEST_ADHESIVE = 1e-3, 1e4, 1.0
# Retractions that are tried first, at the contact radius of the whole range of depths and over it.
_RETRACTIONS: Final = np.logspace(-3, 0.5, 15)
# Depths between which the force with adhesion is linear for the first values.
_GRID: Final = 500
# Smallest c = (2 pi w/E*)^(1/2) over the root of the range of depths. The contact equals the one
# without adhesion to rounding error, and still has its slope in w.
LEAST_C: Final = 1e-6


@dataclass(frozen=True, eq=False)
class Model(CurveModel):
    """Curve, and the model that is fitted to it."""

    profile: Profile
    depth: Array
    force: Array
    fit: tuple[str, ...]
    e_star: float | None
    touches: Flags
    """Points that are not after a pull-off."""
    on_layer: DepthCurve | None
    """Force over depth on a layer, None on a half-space."""
    noise: float | None
    """Known standard deviation of the forces [force]."""
    body_thickness: float | None
    drift_error: Array
    """Standard error of the subtracted drift at each point [length]."""

    argument: ClassVar[str] = "indentation_depth"

    @property
    def deepest(self) -> float:
        """Largest depth on the profile, or of the curve on a layer [length]."""
        if self.on_layer is not None:
            return self.on_layer.deepest
        return float(self.profile.largest_loads[0])

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
        """Smallest w/E* that is fitted [length]."""
        return LEAST_C**2 * float(np.ptp(self.depth)) / (2 * pi)

    def of(self, points: Indices) -> Self:
        """Return the model of a part of the points, in their order."""
        names = "depth", "force", "drift_error", "touches"
        return replace(self, **{name: getattr(self, name)[points] for name in names})

    def require_points(self, touching: int) -> None:
        """Raise InputError unless more points are in contact than parameters are fitted."""
        if touching <= len(self.fit):
            ends = self.profile.largest_loads[0]
            remedy = "measure deeper, or more points"
            if ends < np.ptp(self.depth):
                remedy = f"the profile ends at the depth {ends:.3g}: give a longer one"
            detail = f"too few points are in contact, {touching}: {remedy}"
            raise InputError(("indentation_depth",), detail)

    def reduced(self, pressed: Array, ratio: float) -> Array:
        """Return forces over E*, and their slopes in the depth and in w/E*, shape (3, ...).

        With adhesion, depths below the depth of the least force have the least force.

        Parameters: the depths from first contact, and w/E* [length].
        """
        found = np.zeros((3, *pressed.shape))
        if ratio:
            c = sqrt(2 * pi * ratio)
            # A contact that would spread beyond the profile fits nothing.
            with suppress(InputError):
                curve = adhesion.Curve(self.profile, c)
                ends = np.array([curve.at_pull_off, curve.stable["indentation_depth"][1][-1]])
                held = np.clip(pressed, *curve.load("indentation_depth", ends))
                edge, _ = curve.outermost("indentation_depth", held)
                a = self.profile.contact_radius(edge)
                # dF/dd = 2 E* (a - steep), and dF/dc = -2 E* a^(1/2) steep at the same depth.
                steep = a / curve.excess(0.5, edge)
                by_ratio = -2 * np.sqrt(a) * steep * pi / c
                found[:] = curve.load("normal_force", edge), 2 * (a - steep), by_ratio
        else:
            depth = np.maximum(pressed, 0.0)
            if self.on_layer is not None:
                force, slope = self.on_layer(depth)
            else:
                contact = normal.solve(self.profile, 1.0, indentation_depth=depth)
                force, slope = contact.normal_force, contact.normal_stiffness
            found[:2] = np.where(pressed > 0, [force, slope], 0.0)
        return found

    def at(self, parameters: Parameters) -> tuple[Array, Array]:
        """Return the forces of the model, and their slopes in the fitted parameters."""
        e_star, d0, offset, work = (parameters[name] for name in PARAMETERS)
        ratio = work / e_star
        reduced = self.reduced(self.depth - d0, ratio)
        forces, by_depth, by_ratio = np.where(self.touches, reduced, 0.0) if ratio else reduced
        columns = {
            # At constant w.
            "e_star": forces - ratio * by_ratio,
            "contact_point": -e_star * by_depth,
            "force_offset": np.ones_like(forces),
            "work_of_adhesion": by_ratio,
        }
        slopes = np.reshape([columns[name] for name in self.fit], (len(self.fit), forces.size)).T
        return e_star * forces + offset, slopes

    def linear(self, reduced: Array) -> tuple[Array, Array, Array]:
        """Return the least squares, moduli and offsets for forces over E*, shape (..., k)."""
        return linear(reduced, self.force, self.e_star, with_offset="force_offset" in self.fit)

    @cached_property
    def best(self) -> Parameters:
        """Parameters of the least sum of squares, or an InputError."""
        low, high = float(self.depth.min()), float(self.depth.max())
        if low == high:
            raise InputError(("indentation_depth",), "must hold different depths in contact")
        tried, ratios, limit = np.zeros(1), np.zeros(1), self.farthest
        if "contact_point" in self.fit:
            count = int(_BEFORE * np.log10(self.reach / _NEAREST))
            before = (high - low) * np.geomspace(self.reach, _NEAREST, count)
            tried = np.append(low - before, np.linspace(low, high, _WITHIN, endpoint=False))
            tried = np.append(limit, tried[tried > limit])
        if "work_of_adhesion" in self.fit:
            most = min(high - low, self.deepest)
            reached = normal.solve(self.profile, 1.0, indentation_depth=most)
            ratios = (_RETRACTIONS * (high - low)) ** 2 / (2 * pi * reached.contact_radius)
        some = np.argsort(self.depth)[:: max(1, self.depth.size // _POINTS)]
        coarse = self.of(some)
        pressed = coarse.depth - tried[:, None]
        grid = np.linspace(pressed.min(), pressed.max(), _GRID)

        def forces(ratio: float) -> Array:
            if not ratio:
                return coarse.reduced(pressed, ratio)[0]
            return coarse.touches * np.interp(pressed, grid, coarse.reduced(grid, ratio)[0])

        squares, moduli, offsets = coarse.linear(np.array([*map(forces, ratios.tolist())]))
        at = np.unravel_index(squares.argmin(), squares.shape)
        values = moduli[at], tried[at[1]], offsets[at], ratios[at[0]] * moduli[at]
        start = dict(zip(PARAMETERS, map(float, values), strict=True))
        if start["e_star"] <= 0:
            detail = "does not rise as on this profile: compression is positive, reverse its sign"
            raise InputError(("normal_force",), detail)
        if not self.fit:
            return start
        size = float(np.abs(self.force).max()) or 1.0
        bounds = {
            "e_star": (0.0, inf, start["e_star"]),
            "contact_point": (limit, high, high - low),
            "force_offset": (-inf, inf, size),
            "work_of_adhesion": (
                *(self.least_ratio * start["e_star"], inf, start["work_of_adhesion"]),
            ),
        }
        return self.minimum(start, bounds)
