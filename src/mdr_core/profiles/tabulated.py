"""Profiles through the points of a table: piecewise cubic, with closed panel moments."""

from itertools import pairwise
from math import floor, inf, log10
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.abel.displacement import Branch, slope_integral
from mdr_core.abel.panels import Jumps
from mdr_core.abel.resolved import smooth_panels, stress_panels
from mdr_core.abel.roots import leg
from mdr_core.abel.stress import StressPanels
from mdr_core.errors import InputError
from mdr_core.lazy import cached_property
from mdr_core.profiles.behind_flat import BehindFlat
from mdr_core.profiles.table_moments import TableSlope
from mdr_core.profiles.table_points import (
    RINGING,
    Interpolation,
    check_points,
    interpolate,
    refuse_first,
)
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Parameter

# Places in each panel where the sign of g' is looked at.
_LOOKS: Final = np.array([0.02, 0.25, 0.5, 0.75, 0.98])
# A slope on the axis below this, relative to the steepest, is the interpolation's.
_TIP: Final = 1e-6
# Nearer to each other than this part of the radius, two points tell no slope or curvature that
# the stress next to them could be had from.
_CLOSEST: Final = 9e-6
_ENERGY_POINTS: Final = 10
# A bound on what the closed moments of one panel lose; by far not reached.
_ACCURACY: Final = 1e-11
# So many panels are taken as one where g' is smooth enough for the tolerance: each of them still
# holds two of the places where that is looked at.
_TOGETHER: Final = 8
# Kinks of g' larger than this, over the tolerance, are felt.
_FELT: Final = 300.0
_DECADE_ROUNDING: Final = 1e-6
# At the rim of a narrow contact g' counts where its polynomial is worst.
_MARGIN: Final = 8.0


class Tabulated(BehindFlat):
    """The profile through (r_i, f_i), interpolated, never extrapolated.

    Parameters
    ----------
    r, f : radii from 0 on, increasing, and the profile there, f(0) = 0 [length], shape (k,).
    interpolation : "cubic" (not-a-knot), "pchip" or "linear".
    breaks : radii of the table where slope or curvature jumps; nothing is interpolated across.

    Raises
    ------
    InputError : a table that is not one, or not admissible (notes, §3): the radius
        is named where f falls, or where g' and with it the pressure turns negative.

    Source: notes, §5.
    """

    kind: ClassVar[str] = "tabulated"
    formula: ClassVar[str] = "through the points (r, f): cubic (not-a-knot), pchip or linear"
    closed_forms: ClassVar[tuple[str, ...]] = ("indentation_depth", "normal_stiffness")
    rounding = 1e-11

    def __init__(
        self,
        r: ArrayLike,
        f: ArrayLike,
        interpolation: Interpolation = "cubic",
        breaks: tuple[float, ...] = (),
    ) -> None:
        self.r = np.asarray(r, dtype=float)
        self.values = np.asarray(f, dtype=float)
        self.interpolation = interpolation
        self._breaks = tuple(float(b) for b in breaks)
        check_points(self.r, self.values)
        for i, b in enumerate(self._breaks):
            if b not in self.r[1:-1]:
                raise InputError(("profile", "breaks", i), "must be an inner radius of the table")
        self._check_admissible()

    @property
    def normal_method(self) -> str:
        return "panel_moments"

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return self._breaks

    @property
    def domain(self) -> float:
        return float(self.r[-1])

    @cached_property
    def flat_radius(self) -> float:  # type: ignore[override]
        """Radius b up to which f = 0; the contact coordinate is sqrt(a^2 - b^2)."""
        return float(self.r[np.flatnonzero(self.values == 0)[-1]])

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        """The tip of a table that starts as a cone, and every kink."""
        slopes = self._slope.coefficients[0]
        tip = (0.0,) if slopes[0] > _TIP * slopes.max() else ()
        return (*tip, *self._jumps.at.tolist())

    @property
    def last_coordinate(self) -> float:
        return float(leg(np.asarray(self.domain), self.flat_radius))

    @property
    def scale(self) -> float:
        return self.last_coordinate / 2

    # Without a flat the contact coordinate is the radius itself.

    def contact_radius(self, coordinate: Array) -> Array:
        if self.flat_radius == 0:
            return coordinate
        return np.minimum(super().contact_radius(coordinate), self.domain)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        if self.flat_radius == 0:
            return contact_radius
        return super().coordinate_from_radius(contact_radius)

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        return a - c if self.flat_radius == 0 else super().coordinate_width(a, c, s_a, s_c)

    def radius_width(self, s_a: Array, width: Array) -> Array:
        return width if self.flat_radius == 0 else super().radius_width(s_a, width)

    @property
    def coordinate_breaks(self) -> Array:
        inner = self.r[1:-1]
        return leg(inner[inner > self.flat_radius], self.flat_radius)

    def _offset(self, coordinate: Array) -> tuple[Array, Array]:
        """The flat's radius and a - b, with the digits of the coordinate."""
        b = np.full(np.shape(coordinate), self.flat_radius)
        with np.errstate(invalid="ignore"):
            offset = np.square(coordinate) / (b + self.contact_radius(coordinate))
        return b, np.where(coordinate > 0, offset, 0.0)

    def depth(self, coordinate: Array) -> Array:
        radius = self.contact_radius(coordinate)
        return np.asarray(radius * self._slope.transform(*self._offset(coordinate)))

    def depth_slope(self, coordinate: Array) -> Array:
        """g'(a) da/ds, where the pole of g' at the flat's edge cancels."""
        s = np.atleast_1d(coordinate).ravel()
        if not self.flat_radius:
            return self._slope.source.transform(s).reshape(np.shape(coordinate))
        a = self.contact_radius(s)
        base, offset = self._offset(s)
        # On the panel behind the flat, J b/s times s/a is left of the jump at b.
        behind = np.searchsorted(self.r, self.flat_radius, side="right")
        first = a <= self.r[behind]
        slope = self._slope.source.transform(np.where(first, base, a), np.where(first, offset, 0.0))
        edge = float(self._slope.steps[behind - 1]) * self.flat_radius
        total = slope * (s / a) + np.where(first, edge / a, 0.0)
        return np.asarray(total.reshape(np.shape(coordinate)))

    def depth_slope_behind(self, coordinate: Array, start: Array, past: Array) -> Array:
        """The root that a node's kink leaves in the slope is that of the distance from it."""
        place, start, past = (
            np.ravel(part) for part in np.broadcast_arrays(coordinate, start, past)
        )
        nodes, slope = self.coordinate_breaks, self._slope.source
        behind = np.flatnonzero(np.isin(start, nodes))
        if not behind.size or slope.jumps is None:
            return self.depth_slope(coordinate)
        result = self.depth_slope(place)
        start, past, place = start[behind], past[behind], place[behind]
        panel = np.searchsorted(nodes, start) + self.r.size - 1 - nodes.size
        node, radius = self.r[panel], self.contact_radius(place)
        stretch = (place / radius) if self.flat_radius else 1.0
        gap = past * (2 * start + past) / (radius + node) if self.flat_radius else past
        root = slope.jumps[panel] / np.sqrt(np.where(gap > 0, gap, np.inf)) / np.sqrt(radius + node)
        result[behind] = stretch * (slope.transform(node, gap) + root)
        return result.reshape(np.shape(coordinate))

    @cached_property
    def _cubics(self) -> Array:
        """Coefficients (4, panels) of f in r - r_i, ascending, segment by segment."""
        cuts = np.searchsorted(self.r, sorted({0.0, *self._breaks, self.domain}))
        parts = [
            interpolate(self.r[i : j + 1], self.values[i : j + 1], self.interpolation)
            for i, j in pairwise(cuts)
        ]
        return np.concatenate(parts, axis=1)

    @cached_property
    def _slope(self) -> TableSlope:
        """f' as quadratics in r - r_i."""
        cubics = self._cubics
        return TableSlope(self.r, cubics[1:] * np.array([[1.0], [2.0], [3.0]]))

    @cached_property
    def _jumps(self) -> Jumps:
        """Where f' jumps."""
        steps = self._slope.steps
        return Jumps(self.r[:-1][steps != 0], steps[steps != 0])

    def _check_admissible(self) -> None:
        slope = self._slope
        fall = slope.first_negative(RINGING)
        if fall is not None:
            raise InputError(
                ("profile",),
                f"f falls at radius {fall:.12g} between the points: declare a break where slope "
                "or curvature jumps, or use pchip",
            )
        if (self._jumps.size < 0).any():
            radius = self._jumps.at[self._jumps.size < 0][0]
            raise InputError(
                ("profile",),
                f"the slope drops at radius {radius:.12g}: the pressure there would be negative",
            )
        if slope.source_is_positive(RINGING):
            return
        x = (self.r[:-1, None] + np.diff(self.r)[:, None] * _LOOKS).ravel()
        slopes = self.dg(x)
        bad = slopes < -RINGING * np.abs(slopes[np.isfinite(slopes)]).max()
        if bad.any():
            raise InputError(
                ("profile",),
                f"g falls at radius {x[bad][0]:.12g}: the contact would not stay one disc and the "
                "pressure there would be negative",
            )

    def _panel(self, radius: Array) -> Array:
        return np.clip(np.searchsorted(self.r, radius, side="right") - 1, 0, self.r.size - 2)

    def f(self, radius: Array) -> Array:
        self._require_inside(radius)
        index = self._panel(radius)
        u = radius - self.r[index]
        c = self._cubics[:, index]
        return np.asarray(c[0] + u * (c[1] + u * (c[2] + u * c[3])))

    def df(self, radius: Array) -> Array:
        self._require_inside(radius)
        index = self._panel(radius)
        return self._slope.at(radius - self.r[index], index)

    def g(self, x: Array) -> Array:
        self._require_inside(x)
        return np.asarray(x * self._slope.transform(x))

    def dg(self, x: Array) -> Array:
        self._require_inside(x)
        return self._slope.source.transform(np.asarray(x, dtype=float))

    def _require_inside(self, radius: Array) -> None:
        if np.any(np.asarray(radius) > self.domain):
            raise InputError(("profile", "r"), f"the table ends at radius {self.domain:.12g}")

    def reduced_force(self, coordinate: Array) -> Array:
        """2 int_0^a r^2 f'/sqrt(a^2 - r^2) dr. Source: notes, §1."""
        return 2 * self._slope.transform(*self._offset(coordinate), weighted=True)

    def reduced_energy(self, coordinate: Array) -> Array:
        """d^2 a - 2 d int g dx + int g^2 dx, the integrals summed up over whole panels once."""
        a = np.asarray(self.contact_radius(coordinate), dtype=float).ravel()
        panel = np.clip(np.searchsorted(self.r, a) - 1, 0, self.r.size - 2)
        first, second = self._integrals(self.r[panel], a)
        done = self._panel_sums[:, panel]
        d = self.g(a)
        energy = d * d * a - 2 * d * (done[0] + first) + (done[1] + second)
        return np.asarray(energy.reshape(np.shape(coordinate)))

    @cached_property
    def _panel_sums(self) -> Array:
        """int g dx and int g^2 dx from the axis to each panel's left end (2, panels)."""
        parts = np.stack(self._integrals(self.r[:-2], self.r[1:-1]))
        return np.concatenate([np.zeros((2, 1)), np.cumsum(parts, axis=1)], axis=1)

    def _integrals(self, left: Array, right: Array) -> tuple[Array, Array]:
        """int g dx and int g^2 dx within panels: g is smooth in s about the left end."""
        nodes, weights = gauss_legendre(_ENERGY_POINTS)
        leg = np.sqrt((right - left) * (right + left))[:, None]
        s = leg * (1 + nodes) / 2
        x = np.minimum(np.hypot(left[:, None], s), right[:, None])
        step = leg / 2 * weights * s / np.where(x > 0, x, 1.0)
        g = self.g(x)
        return (step * g).sum(axis=1), (step * g * g).sum(axis=1)

    @property
    def tip_pressure(self) -> float:
        return max(float(self._slope.coefficients[0, 0]) / 2, 0.0)

    @property
    def branches(self) -> tuple[Branch, ...]:
        return self._stress.branches

    # The displacements feel kinks no more than the stresses do.

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        branches = self.panels(rtol).branches
        return 2 / np.pi * slope_integral(branches, c, r, r, rtol, outside=False)

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        del coordinate
        branches, axis = self.panels(rtol).branches, np.zeros_like(r)
        return 2 / np.pi * slope_integral(branches, axis, a, r, rtol, outside=True)

    @cached_property
    def _stress(self) -> StressPanels:
        self._refuse_close_points()
        source = self._slope.source
        return stress_panels(source.transform, self.r, self._jumps, _ACCURACY, source.kinks())

    def _refuse_close_points(self) -> None:
        close = np.append(False, np.diff(self.r) < _CLOSEST * self.r[1:])
        told = f"at {self.r[np.argmax(close)]:.12g} closer than {_CLOSEST:g} of the radius to"
        detail = f"{told} the one before: the stress next to them has no digits, leave one out"
        refuse_first("r", close, detail)

    @cached_property
    def _merged(self) -> dict[int, StressPanels | None]:
        """What `panels` has found out, by the decade of the tolerance."""
        return {}

    @cached_property
    def _largest_kink(self) -> float:
        """Of g' between two panels, relative to g'."""
        return inf if self._jumps.at.size else float(self._slope.source.kinks().max())

    def panels(self, rtol: float) -> StressPanels:
        """Several panels in one, where no kink between them is felt at this tolerance."""
        decade = floor(log10(rtol) + _DECADE_ROUNDING)
        accuracy = 10.0**decade / _MARGIN
        few = self.r.size <= _TOGETHER
        if few or accuracy < _ACCURACY or self._largest_kink > _FELT * accuracy:
            return self._stress
        if decade not in self._merged:
            self._refuse_close_points()
            # Near the axis g' may be small: there a kink is felt that is not farther out.
            near, far = self.r[:_TOGETHER], self.r[_TOGETHER:-1:_TOGETHER]
            edges = np.concatenate([near, far, self.r[-1:]])
            slope = self._slope.source.to(accuracy).transform
            found = smooth_panels(slope, edges, accuracy, self._largest_kink)
            self._merged[decade] = found
        return self._merged[decade] or self._stress

    def pressure_kernel(
        self,
        coordinate: Array,
        radius: Array,
        rtol: float,
        width: Array | None = None,
        edge: Array | None = None,
        modulus: float = 1.0,
        inner: Array | None = None,
    ) -> Array:
        a = self.contact_radius(coordinate) if edge is None else edge
        span = None if width is None else self.radius_width(coordinate, width)
        value = self.panels(rtol).kernel(a, radius, rtol, span, inner)
        value *= modulus / np.pi
        return value
