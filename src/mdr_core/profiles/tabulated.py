"""Profile through the points of a table."""

from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.displacement import Branch
from mdr_core.abel.stress import StressPanels
from mdr_core.abel.two_root import inverse_hypot
from mdr_core.cached import cached_property
from mdr_core.elementwise import full, number
from mdr_core.errors import InputError, Notice
from mdr_core.profiles.resolved_table import resolve_table
from mdr_core.profiles.table_interpolation import Interpolation, checked_heights
from mdr_core.profiles.truncated import FlatEnded
from mdr_core.typing import Array, Flags, Indices, Parameter
from mdr_core.validation import require_inside

# Bound on the error of the sums over the panels: several times the largest in the bank of tables.
_ROUNDING: Final = 1e-12
# The increase of g'(x)/x is found at a dozen points of each panel, and may be larger between them.
_MARGIN: Final = 1.5


class Tabulated(FlatEnded):
    """Profile through (r_i, f_i), interpolated, never extrapolated.

    Parameters
    ----------
    r, f : radii from 0 on, increasing, and the profile there, f(0) = 0 [length], shape (k,).
    interpolation : "cubic" (not-a-knot spline), "pchip", "linear" or "auto": "cubic", or
        "pchip" with the warning `interpolation` if the spline decreases between the points by more
        than that of a smooth body.
    breaks : radii of the table where slope or curvature jumps; polynomials end there.

    Raises
    ------
    InputError : not a table of a profile that rises from f(0) = 0, or a spline that falls.

    Source: notes, §5.
    """

    kind: ClassVar[str] = "tabulated"
    formula: ClassVar[str] = "through the points (r, f): auto, cubic (not-a-knot), pchip or linear"
    closed_forms: ClassVar[tuple[str, ...]] = ("indentation_depth", "normal_stiffness")

    def __init__(
        self,
        r: ArrayLike,
        f: ArrayLike,
        interpolation: Interpolation = "auto",
        breaks: tuple[float, ...] = (),
    ) -> None:
        self.r = np.array(r, dtype=float)
        self.values = checked_heights(self.r, np.array(f, dtype=float))
        # A resolved table may be kept and used again.
        self.r.flags.writeable = self.values.flags.writeable = False
        self.interpolation = interpolation
        self._breaks = tuple(float(b) for b in breaks)
        for i, b in enumerate(self._breaks):
            if b not in self.r[1:-1]:
                raise InputError(("profile", "breaks", i), "must be an inner radius of the table")
        self.flat_radius = float(self.r[self.values == 0][-1])
        self.resolved = resolve_table(self.r, self.values, interpolation, self._breaks)
        self.rounding = max(_ROUNDING, self.resolved.panels.error)

    @property
    def normal_method(self) -> str:
        return "panel_moments"

    @property
    def notices(self) -> tuple[Notice, ...]:
        return self.resolved.notices

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return self._breaks

    @property
    def domain(self) -> float:
        return self.resolved.domain

    @cached_property
    def last_coordinate(self) -> float:
        return float(inverse_hypot(number(self.domain), self.flat_radius))

    @property
    def scale(self) -> float:
        return self.last_coordinate / 2

    @cached_property
    def coordinate_breaks(self) -> Array:
        return inverse_hypot(self.resolved.breaks, self.flat_radius)

    @property
    def coordinate_plateaus(self) -> Array:
        return inverse_hypot(self.resolved.plateaus, self.flat_radius)

    @cached_property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        panels = self.resolved.panels
        radii = panels.edges[:-1][panels.depth[:, 0] > 0]
        return tuple(radii[radii > 0].tolist() if self.resolved.smooth_tip else radii.tolist())

    @property
    def tip_pressure(self) -> float:
        return float(self.resolved.rows[1, 0]) / 2

    def contact_radius(self, coordinate: Array) -> Array:
        if self.flat_radius == 0:
            return coordinate
        return np.minimum(super().contact_radius(coordinate), self.domain)

    def radius_slope(self, coordinate: Array) -> Array:
        return super().radius_slope(coordinate) if self.flat_radius > 0 else full(1.0, coordinate)

    # The shape, by its polynomials between the points.

    def f(self, radius: Array) -> Array:
        u, (c0, c1, c2, c3) = self._polynomial(radius)
        return c0 + u * (c1 + u * (c2 + u * c3))

    def df(self, radius: Array) -> Array:
        u, (_, c1, c2, c3) = self._polynomial(radius)
        return c1 + u * (2 * c2 + u * (3 * c3))

    def _polynomial(self, radius: Array) -> tuple[Array, Array]:
        """Distance from the point below, and the coefficients (4, ...) of f."""
        self._require_inside(radius)
        panel = np.searchsorted(self.r[1:-1], radius, side="right")
        return radius - self.r[panel], self.resolved.rows[:, panel]

    def _require_inside(self, radius: Array) -> None:
        if np.any(radius > self.r[-1]):
            raise InputError(("profile", "r"), f"the table ends at radius {self.r[-1]:.12g}")

    # The equivalent profile, by its polynomials in s = sqrt(x^2 - b^2), b the radius below.

    def g(self, x: Array) -> Array:
        self._require_inside(x)
        place = _located(self.resolved.panels.edges, x)
        return self.resolved.panels.depth_at(*place).reshape(np.shape(x))

    def dg(self, x: Array) -> Array:
        self._require_inside(x)
        place = np.ravel(x)
        panel, s = _located(self.resolved.panels.edges, place)
        jump, rest = self.resolved.panels.slope_at(panel, s)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where((panel == 0) & (self.flat_radius == 0), 1.0, place / s)
            slope = np.where(jump == 0, 0.0, jump * ratio) + place * rest
        return np.where(place < self.flat_radius, 0.0, slope).reshape(np.shape(x))

    def depth(self, coordinate: Array) -> Array:
        place = _located(self._edges, coordinate)
        return self.resolved.panels.depth_at(*place).reshape(np.shape(coordinate))

    def reduced_force(self, coordinate: Array) -> Array:
        place = _located(self._edges, coordinate)
        half = self.resolved.panels.half_force_at(*place)
        return 2 * half.reshape(np.shape(coordinate))

    def reduced_energy(self, coordinate: Array) -> Array:
        place = _located(self._edges, coordinate)
        return self.resolved.panels.energy_at(*place).reshape(np.shape(coordinate))

    def depth_slope(self, coordinate: Array) -> Array:
        panel, s = _located(self._edges, coordinate)
        slope = self._slope_at_coordinate(np.ravel(coordinate), panel, s)
        return slope.reshape(np.shape(coordinate))

    def depth_slope_beyond(self, coordinate: Array, start: Array, past: Array) -> Array:
        """Parameters: see `Profile`."""
        place, start, past = map(np.ravel, np.broadcast_arrays(coordinate, start, past))
        panel, s = _located(self._edges, place)
        # Beside a slope discontinuity s follows from the distance: the coordinate is too coarse.
        s = np.where(self._edges[panel] == start, np.sqrt(past * (2 * start + past)), s)
        return self._slope_at_coordinate(place, panel, s).reshape(np.shape(coordinate))

    def _slope_at_coordinate(self, coordinate: Array, panel: Indices, s: Array) -> Array:
        """Slope of the depth; where it is infinite, at a discontinuity, its limit from below."""
        jump, rest = self.resolved.panels.slope_at(panel, s)
        # In the first subpanel s is the coordinate itself.
        ratio = np.where(panel == 0, 1.0, coordinate / np.where(s > 0, s, np.inf))
        return jump * ratio + coordinate * rest

    @cached_property
    def _edges(self) -> Array:
        """Contact coordinates of the subpanels' edges."""
        return inverse_hypot(self.resolved.panels.edges, self.flat_radius)

    def coordinate_from_depth(self, depth: Array) -> Array:
        return self._inverse(0, depth, "indentation_depth")

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        return self._inverse(1, reduced_force / 2, "normal_force")

    def _inverse(self, quantity: int, target: Array, load: str) -> Array:
        require_inside(load, target > self._limits[quantity], self.domain)
        panel, s = self.resolved.panels.inverse(quantity, np.ravel(target))
        found = np.minimum(np.hypot(self._edges[panel], s), self.last_coordinate)
        return found.reshape(np.shape(target))

    @cached_property
    def _limits(self) -> tuple[float, float]:
        """Depth and half force of the largest contact."""
        panels, place = self.resolved.panels, _located(self._edges, np.array(self.last_coordinate))
        return float(panels.depth_at(*place)[0]), float(panels.half_force_at(*place)[0])

    def falls_from_axis(self, coordinate: Array) -> Flags:
        """By an upper bound of the increase of g'(x)/x on the panels. See `Profile`."""
        if self.flat_radius > 0:
            return coordinate < 0
        panels, (panel, s) = self.resolved.panels, _located(self._edges, coordinate)
        _, height = panels.slope_at(panel, s)
        return (height > 0) & (_MARGIN * panels.increase(panel, coordinate) <= height)

    def axis_stress(self, coordinate: Array, rtol: float) -> Array:
        """Stress integral at the axis, in closed form. Parameters: see `Profile`."""
        del rtol
        place = _located(self._edges, coordinate)
        stress = self.resolved.panels.over_axis_at(*place) / np.pi
        return stress.reshape(coordinate.shape)[()]

    @property
    def branches(self) -> tuple[Branch, ...]:
        return self.resolved.stress.branches

    @property
    def panels(self) -> StressPanels:
        return self.resolved.stress

    def _kernel(
        self, annulus: Annulus, radius: Array, rtol: float, beyond: Array | None = None
    ) -> Array:
        del rtol
        outer, inner, _ = annulus
        if inner is None or inner.coordinate is None:
            roots = outer, outer - (outer if inner is None else inner.width)
        else:
            roots = outer, inner.coordinate
        return self.resolved.stress.kernel(self.radial(annulus), roots, radius, beyond) / np.pi


def _located(edges: Array, place: Array) -> tuple[Indices, Array]:
    """Subpanel of each place and s there, shape (m,)."""
    place = np.asarray(place).ravel()
    panel = edges[1:-1].searchsorted(place, side="right")
    return panel, inverse_hypot(place, edges[panel])
