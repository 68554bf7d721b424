"""Panels of a slope times the radius, or over it, for the same kernel of the stress."""

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.abel.interpolation import chebyshev_points
from mdr_core.abel.pieces import DEGREE
from mdr_core.abel.stress import StressPanels
from mdr_core.typing import Array

# The factor is known by its values at these points of a piece.
_POINTS, _TO_COEFFICIENTS = chebyshev_points(DEGREE + 1)
_AT_POINTS: Final = np.asarray(chebyshev.chebvander(_POINTS, DEGREE).T, dtype=float)


def times_radius(panels: StressPanels) -> StressPanels:
    """Return the panels of x G.

    Examples
    --------
    Eq. (5.38): to the cone's G = 1 belongs arccosh(a/r), to x G the paraboloid's root.

    >>> from mdr_core.abel import Jumps, stress_panels
    >>> none = Jumps(np.empty(0), np.empty(0))
    >>> one = stress_panels(lambda base, offset: 0 * base + 1.0, np.array([0.0, 2.0]), none)
    >>> value = times_radius(one).kernel(np.array([1.0]), np.array([0.6]), 1e-12)
    >>> float(f"{value[0]:.6g}")
    0.8
    """
    s, x, base, pole = _places(panels)
    # What is left of pole x/s beyond its part at the break.
    value = panels.coefficients @ _AT_POINTS * x + pole * s / (x + base)
    return replace(panels, coefficients=value @ _TO_COEFFICIENTS.T, pole=panels.pole * panels.base)


def over_radius(panels: StressPanels) -> StressPanels:
    """Return the panels of G/x, of which the first, at the axis, is not to be used."""
    s, x, base, pole = _places(panels)
    outside = np.where(base > 0, base, 1.0)
    value = panels.coefficients @ _AT_POINTS / x - pole * s / (x * outside * (x + base))
    return replace(
        panels, coefficients=value @ _TO_COEFFICIENTS.T, pole=panels.pole / outside[:, 0]
    )


def _places(panels: StressPanels) -> tuple[Array, Array, Array, Array]:
    """s and x at the points of each piece, its base and its pole."""
    base, pole = panels.base[:, None], panels.pole[:, None]
    middle, half = (panels.start + panels.stop) / 2, (panels.stop - panels.start) / 2
    s = middle[:, None] + half[:, None] * _POINTS
    return s, np.hypot(base, s), base, pole
