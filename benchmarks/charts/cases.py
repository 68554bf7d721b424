"""Contacts of the pressure and traction charts, as seen by every method.

All have a = 1, E* = 1 and, for the traction, friction coefficient 1, so that pressure and traction
are the integrals (1/pi) int g'(x)/sqrt(x^2 - r^2) dx over [r, a] and [max(r, c), a]. The radii are
(2i + 1)/2000: points of the grids that end at a, but never at the axis, break, c or a.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp, mpf
from scipy.interpolate import CubicSpline
from scipy.special import gamma
from tests.core.comparison import profile_from
from tests.oracles import reference
from tests.oracles.shapes import Shape, shape_of

if TYPE_CHECKING:
    from mdr_core.profiles import Profile

Array = np.ndarray
#: Slope g' as a function of x and x - b; the distance from the break b avoids cancellation.
Slope = Callable[[Array, Array], Array]

RADII = (2 * np.arange(1000) + 1) / 2000
EDGE = 1.0


@dataclass(frozen=True)
class Case:
    """One contact: the product's request, and the integrand as a user of a reference code writes
    it.
    """

    name: str
    profile: dict[str, Any]
    stick: float
    slope: Slope
    """g' for arrays."""
    scalar: Callable[[float, float], float] | None
    """g' of a scalar, by the functions of `math`; None if only arrays are supported."""
    equivalent_profile: Callable[[Array], Array]
    """g."""
    b: float = 0.0
    spacing: int = 4
    """Stride of the radii that are checked, in addition to those next to b, c, axis and a."""
    body: dict[str, Any] | None = None
    """The body behind the points of a table."""

    def product_profile(self) -> Profile:
        return profile_from(self.profile)

    def reference_values(self, quantity: str) -> Array:
        """Pressure or traction at the checked radii as sums of two doubles."""
        with mp.workdps(reference.QUAD_DIGITS):
            values = self._kernels(EDGE)
            if quantity == "traction":
                inside = self._kernels(self.stick)
                values = [high - low for high, low in zip(values, inside, strict=True)]
            high = [float(value) for value in values]
            low = [float(value - mpf(top)) for value, top in zip(values, high, strict=True)]
        return np.array([high, low])

    @cached_property
    def checked(self) -> Array:
        """Indices of the checked radii."""
        indices = [
            0,
            *(round(1000 * r) + i for r in (self.b, self.stick, EDGE) for i in (-2, -1, 0)),
        ]
        inside = [i for i in indices if 0 <= i < RADII.size]
        return np.union1d(np.arange(0, RADII.size, self.spacing), inside)

    @cached_property
    def _exact(self) -> Shape:
        return shape_of(self.body or self.profile)

    def _kernels(self, end: float) -> list[mpf]:
        """(1/pi) int_r^end g'/sqrt(x^2 - r^2) dx at the checked radii."""
        edge, shape = mpf(end), self._exact
        return [
            mpf(0) if r >= end else reference.pressure(shape, mpf(r), edge)
            for r in RADII[self.checked].tolist()
        ]


def errors(answer: Array, reference_values: Array, checked: Array) -> tuple[float, float]:
    """Largest and median relative error at the checked radii."""
    high, low = reference_values
    error = np.abs(((answer[checked] - high) - low) / high)
    error[~np.isfinite(error)] = np.inf
    return float(error.max()), float(np.median(error))


def _power(n: float) -> tuple[Slope, Callable[[float, float], float], Callable[[Array], Array]]:
    factor = math.sqrt(math.pi) * float(gamma(n / 2 + 1) / gamma((n + 1) / 2))
    return (
        lambda x, _above: factor * n * x ** (n - 1),
        lambda x, _above: factor * n * x ** (n - 1),
        lambda x: factor * x**n,
    )


def _rounded(b: float, stick: float) -> Case:
    def slope(x: Array, above: Array) -> Array:
        s = np.sqrt(np.maximum(above, 0.0) * (x + b))
        return 2 * s - b * np.arctan(s / b)

    def scalar(x: float, above: float) -> float:
        s = math.sqrt(max(above, 0.0) * (x + b))
        return 2 * s - b * math.atan(s / b)

    def equivalent_profile(x: Array) -> Array:
        s = np.sqrt(np.maximum(x - b, 0.0) * (x + b))
        return x * (s - b * np.arctan(s / b))

    fields = {"kind": "rounded_punch", "flat_radius": b, "rounding_radius": 1.0}
    return Case(f"rounded punch b/a = {b}", fields, stick, slope, scalar, equivalent_profile, b)


def _sphere(radius: float) -> Case:
    def slope(x: Array, _above: Array) -> Array:
        return np.arctanh(x / radius) + x * radius / ((radius - x) * (radius + x))

    def scalar(x: float, _above: float) -> float:
        return math.atanh(x / radius) + x * radius / ((radius - x) * (radius + x))

    def equivalent_profile(x: Array) -> Array:
        return x * np.arctanh(x / radius)

    fields = {"kind": "sphere", "radius": radius}
    return Case("exact sphere a/R = 0.5", fields, 0.7, slope, scalar, equivalent_profile)


#: Points of the rule by which g' is computed from the table's spline.
TABLE_RULE = 64


def _table(points: int) -> Case:
    """A sphere of radius 2, sampled."""
    r = np.linspace(0.0, 1.25, points)
    f = r * r / (2 + np.sqrt((2 - r) * (2 + r)))
    nodes, weights = np.polynomial.legendre.leggauss(TABLE_RULE)
    angle = math.pi / 4 * (nodes + 1)
    sine, weights = np.sin(angle), math.pi / 4 * weights

    def slope(x: Array, _above: Array) -> Array:
        """int_0^(pi/2) (f' + rho f'') dt with rho = x sin t, of the spline through the points."""
        spline = CubicSpline(r, f)
        rho = np.multiply.outer(sine, np.ravel(x))
        values = spline(rho, 1) + rho * spline(rho, 2)
        return (weights @ values).reshape(np.shape(x))

    def equivalent_profile(x: Array) -> Array:
        rho = np.multiply.outer(sine, np.ravel(x))
        return x * (weights @ CubicSpline(r, f)(rho, 1)).reshape(np.shape(x))

    fields = {"kind": "tabulated", "r": r.tolist(), "f": f.tolist()}
    name, body = f"table of {points} points", {"kind": "sphere", "radius": 2.0}
    return Case(name, fields, 0.7, slope, None, equivalent_profile, body=body)


def _cone() -> Case:
    half_pi = math.pi / 2
    return Case(
        "cone",
        {"kind": "cone", "slope": 1.0},
        0.7,
        lambda x, _above: np.full_like(x, half_pi),
        lambda _x, _above: half_pi,
        lambda x: half_pi * x,
    )


def cases() -> list[Case]:
    """All seven cases."""
    slope, scalar, equivalent_profile = _power(1.5)
    return [
        Case(
            "paraboloid",
            {"kind": "paraboloid", "radius": 1.0},
            0.7,
            lambda x, _above: 2 * x,
            lambda x, _above: 2 * x,
            lambda x: x * x,
        ),
        _cone(),
        _sphere(2.0),
        _rounded(0.5, 0.75),
        _rounded(0.95, 0.975),
        Case(
            "power law n = 1.5",
            {"kind": "power", "coefficient": 1.0, "exponent": 1.5},
            0.7,
            slope,
            scalar,
            equivalent_profile,
        ),
        _table(200),
    ]
