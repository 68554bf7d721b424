"""The generic route: everything from f' and the breaks alone, whatever else a kind may know."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mdr_core import abel

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

RTOL = 1e-13


class GenericRoute:
    """g, N and p/E* of a profile of which only f' is known, up to `upper`."""

    def __init__(
        self, slope: Callable[[Array], Array], upper: float, breaks: Sequence[float] = ()
    ) -> None:
        inner = sorted(float(b) for b in breaks if 0 < b < upper)
        self.slope = abel.resolve(slope, upper, inner)
        self.edges = np.array([0.0, *sorted({*inner, *self.slope.found}), upper])
        self.jumps = abel.jumps_at(self.slope, inner)

    @cached_property
    def source(self) -> abel.Panels:
        return abel.slope_source(self.slope)

    @cached_property
    def stress(self) -> abel.StressPanels:
        return abel.stress_panels(self.regular, self.edges, self.jumps)

    def regular(self, base: Array, offset: Array) -> Array:
        smooth = abel.forward_slope(self.source, base, offset)
        return smooth + self.jumps.contribution(base, offset)

    def g(self, x: Array) -> Array:
        return abel.forward(self.slope, np.asarray(x, dtype=float))

    def force(self, x: Array) -> Array:
        return abel.forward_moment(self.slope, np.asarray(x, dtype=float))

    def pressure(self, radius: Array, width: Array | None = None) -> Array:
        """p/E* of the contact of radius `upper`."""
        edge = np.asarray(self.edges[-1])
        r = np.asarray(radius, dtype=float)
        return self.stress.kernel(edge, r, RTOL, width) / np.pi
