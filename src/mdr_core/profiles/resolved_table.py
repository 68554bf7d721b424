"""A table resolved once: its interpolant and its equivalent profile as polynomials."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.abel.stress import StressPanels
from mdr_core.abel.subpanels import Subpanels
from mdr_core.abel.table_transform import resolve
from mdr_core.cached import cached_property
from mdr_core.errors import InputError, Notice
from mdr_core.profiles.table_interpolation import RINGING, Interpolation, interpolate
from mdr_core.typing import Array

# Relative difference below which two radii are equal.
_SAME: Final = 1e-12
# A fall of g by up to this part of its largest value is roughness of the table, and g is taken as
# constant there; a larger one is the shape of the body. A judgement.
_ROUGHNESS: Final = 1e-2
# Fall of the g of a spline, over its largest value, up to which "auto" keeps it. Next to jumps
# of the slope it is larger, in smooth bodies smaller: 2e-4 against 2e-6 in the bodies of the tests,
# from ten intervals on.
_SPLINE_FALLS: Final = 1e-5
# A slope on the axis below this, over the steepest, is interpolation error.
_SMOOTH_TIP: Final = 1e-6
_NO_PLATEAUS: Final = np.empty((0, 2))


@dataclass(frozen=True, eq=False)
class ResolvedTable:
    """Piecewise polynomials of f and of the equivalent profile g; immutable, can be pickled."""

    r: Array
    """Radii of the table [length], shape (k + 1,)."""
    rows: Array
    """Coefficients of the powers 0 to 3 of r - r_i in f, shape (4, k)."""
    panels: Subpanels
    """g from the axis, or the flat's edge, on."""
    domain: float
    """Radius up to which g rises [length]."""
    notices: tuple[Notice, ...]
    plateaus: Array
    """Ends of the intervals of the radius in which g is constant [length], shape (m, 2)."""

    @cached_property
    def breaks(self) -> Array:
        """Radii beyond the first edge between which g is smooth [length], ascending."""
        radii = np.unique(np.append(self.r[1:-1], self.plateaus))
        # A plateau may begin at a point of the table up to rounding.
        apart = np.append(True, np.diff(radii) > _SAME * radii[1:])
        first = self.panels.edges[0]
        return np.asarray(radii[apart & (radii > first) & (radii < self.r[-1])])

    @property
    def smooth_tip(self) -> bool:
        """True where the slope on the axis is no more than the interpolation's error."""
        return bool(self.rows[1, 0] <= _SMOOTH_TIP * self.rows[1].max())

    @cached_property
    def stress(self) -> StressPanels:
        """Panels of the stress kernel."""
        panels = self.panels
        return StressPanels(panels.edges, panels.length, panels.weight, self.smooth_tip)


def resolve_table(
    r: Array, f: Array, interpolation: Interpolation, breaks: Sequence[float]
) -> ResolvedTable:
    """Return the interpolant of a table and its equivalent profile.

    "auto" is a spline, or "pchip" if f or g of the spline falls as it does next to a jump of the
    slope. Where g falls a little it is replaced by a constant; a larger fall ends the domain.

    Parameters
    ----------
    r, f : points of a table that passed `checked_heights` [length], shape (k + 1,).
    interpolation : kind of the polynomials.
    breaks : inner radii of the table that no polynomial spans [length].

    Raises
    ------
    InputError : f falls between two points of "cubic".
    """
    rows, falls = interpolate(r, f, interpolation, breaks)
    if falls.size and interpolation == "cubic":
        raise InputError(
            ("profile",),
            f"f falls at radius {falls[0]:.12g} between the points: use auto or pchip, or declare "
            "a break where slope or curvature jumps",
        )
    notices = []
    spline = interpolation in {"auto", "cubic"} and not falls.size
    if falls.size:
        notices.append(_not_by_spline("f", falls[0]))
        rows, _ = interpolate(r, f, "pchip", breaks)
    panels = _subpanels(r, f, rows, spline=spline)
    dips = panels.dips()
    lowest = _SPLINE_FALLS * panels.at_edges[0].max()
    if interpolation == "auto" and spline and dips.depth.max(initial=0.0) > lowest:
        monotone, _ = interpolate(r, f, "pchip", breaks)
        other = _subpanels(r, f, monotone)
        # A spline rings about a slope discontinuity; where the body itself makes g fall, both do.
        if other.dips().depth.max(initial=0.0) < dips.depth.max() / 2:
            notices.append(_not_by_spline("g", dips.begin[0]))
            rows, spline, panels, dips = monotone, False, other, other.dips()
    domain, plateaus = float(r[-1]), _NO_PLATEAUS
    if dips.top.size:
        # Smaller falls are within the interpolation error of a smooth body.
        noticed = dips.depth > RINGING * panels.at_edges[0].max()
        large = dips.depth > _ROUGHNESS * panels.at_edges[0].max()
        plateaus = np.stack([dips.begin, dips.end], axis=1)
        panels = _subpanels(r, f, rows, plateaus, spline=spline)
        if large.any():
            end = panels.inverse(0, dips.bottom[large].min(keepdims=True))
            domain = float(panels.radius(*end)[0])
        noticed &= dips.begin < domain
        if noticed.any():
            notices.append(_rough(dips.begin[noticed], float(dips.depth[noticed].max())))
    return ResolvedTable(r, rows, panels, domain, tuple(notices), plateaus)


def _subpanels(
    r: Array, f: Array, rows: Array, plateaus: Array = _NO_PLATEAUS, *, spline: bool = False
) -> Subpanels:
    """Transforms of the interpolant, from the axis or the flat's edge on."""
    first = int(np.flatnonzero(f == 0)[-1])
    slope = rows[1:, first:] * np.array([[1.0], [2.0], [3.0]])
    return resolve(r[first:], slope, plateaus, spline=spline)


def _not_by_spline(name: str, radius: float) -> Notice:
    return Notice(
        "interpolation",
        f"{name} of the cubic spline falls at radius {radius:.12g} between the points: the table "
        "is interpolated by pchip; declare a break where slope or curvature jumps",
    )


def _rough(begin: Array, depth: float) -> Notice:
    others = f" and {begin.size - 1} others" if begin.size > 1 else ""
    return Notice(
        "rough_table",
        f"the equivalent profile g decreases beyond radius {begin[0]:.12g}{others}, by up to "
        f"{depth:.2g}: it is taken as constant there, and depths are uncertain by that much; "
        "smooth the heights",
    )
