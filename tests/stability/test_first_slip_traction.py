"""Pressure kernel of an annulus c < x < a as c -> a: incipient slip.

The difference of two single-limit kernels is dominated by rounding error there. The kernel
therefore takes the annulus width in the profile's contact coordinate, and so does the reference.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import abel
from tests.core.comparison import EPS, profile_from
from tests.oracles.shapes import shape_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from mdr_core.profiles import Profile

BOUND = 1e-11
RTOL = 1e-13
WIDTHS = (1e-3, 1e-6, 1e-9, 1e-12, 1e-14)
#: Radii well inside the annulus, and as fractions of it from c (0) to a (1), also just inside c.
INSIDE = (0.0, 1e-9, 0.5, 0.9)
FRACTIONS = (-1.0, -1e-3, 0.3, 0.9)

SHAPES: dict[str, dict[str, Any]] = {
    "rounded punch": {"kind": "rounded_punch", "flat_radius": 0.95, "rounding_radius": 2.0},
    "cone": {"kind": "cone", "slope": 0.3},
    "sphere": {"kind": "sphere", "radius": 1.3},
    "hyperboloid": {"kind": "hyperboloid", "slope": 0.4, "tip_radius": 1.3},
    "power 1.5": {"kind": "power", "coefficient": 0.7, "exponent": 1.5},
    "capped paraboloid": {
        "kind": "capped_paraboloid",
        "cap_radius": 0.6,
        "tip_radius": 3.0,
        "radius": 1.1,
    },
    "paraboloid": {"kind": "paraboloid", "radius": 1.3},
    "truncated cone": {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.3},
    "rounded cone": {"kind": "rounded_cone", "slope": 0.4, "tip_radius": 1.5},
    "spherical-tip cone": {"kind": "spherical_tip_cone", "slope": 0.5, "tip_radius": 1.0},
}
#: Contact edge.
A = 1.02


class Annulus:
    """Exact coordinate and width of an annulus, and its kernel integral."""

    def __init__(self, name: str) -> None:
        self.kind = SHAPES[name]["kind"]
        self.body = shape_of(SHAPES[name])

    def radius(self, coordinate: mpf) -> mpf:
        """Radius from the profile's contact coordinate, in mpmath."""
        if self.kind in {"rounded_punch", "truncated_cone"}:
            return mp.sqrt(self.body.b**2 + coordinate**2)
        return coordinate

    def slope(self, x: mpf) -> mpf:
        return self.body.dg(x)

    def kernel(self, coordinate: mpf, width: mpf, r: mpf) -> mpf:
        a, c = self.radius(coordinate), self.radius(coordinate - width)
        low = max(c, r)
        length, gap = a - low, low - r

        def integrand(v: mpf) -> mpf:
            step = length * v * v
            x = low + step
            return self.slope(x) * 2 * v * length / mp.sqrt((gap + step) * (x + r))

        ends = sorted({mpf(0), min(mp.sqrt(gap / length), mpf(1)), mpf(1)})
        return mp.quad(integrand, ends) / mp.pi


@pytest.mark.every(9)
@pytest.mark.parametrize("relative", WIDTHS)
@pytest.mark.parametrize("name", SHAPES)
def test_narrow_annulus(name: str, relative: float) -> None:
    profile = profile_of(name)
    coordinate = float(profile.coordinate_from_radius(np.array(A)))
    width = relative * coordinate
    with mp.workdps(40):
        truth = Annulus(name)
        a = float(truth.radius(mpf(coordinate)))
        c = float(truth.radius(mpf(coordinate) - mpf(width)))
        places = [a * part for part in INSIDE] + [c + (a - c) * part for part in FRACTIONS]
        # The edge follows from the coordinate; the radius must lie inside by more than rounding
        # error.
        r = np.array(sorted({p for p in places if p < a * (1 - 4 * EPS)}))
        result = kernel(profile, coordinate, width, r)
        for radius, value in zip(r, result, strict=True):
            check(
                truth.kernel,
                tuple(map(mpf, (coordinate, width, float(radius)))),
                float(value),
            )


def check(exact: Callable[..., mpf], arguments: tuple[mpf, ...], value: float) -> None:
    """Assert the bound, including the effect of rounding the coordinate and the radius."""
    truth = exact(*arguments)
    s, w, r = arguments
    error, doubt = abs(mpf(value) / truth - 1), mpf(0)
    # Only next to the edges does the effect exceed the bound.
    if error > BOUND:
        eps = mpf(8 * EPS)
        nearby = [exact(s * (1 + eps), w, r), exact(s, w, r * (1 - eps))]
        doubt = sum(abs(one / truth - 1) for one in nearby)
    assert error <= BOUND + doubt, (float(r), float(w), float(error), float(doubt))


def profile_of(name: str) -> Profile:
    return profile_from(SHAPES[name])


def kernel(profile: Profile, coordinate: float, width: float, r: np.ndarray) -> np.ndarray:
    def full(value: float) -> np.ndarray:
        return np.full(r.shape, value)

    c = float(profile.contact_radius(np.array(coordinate - width)))
    annulus = abel.annulus.Annulus(full(coordinate), full(width), full(c))
    return profile.pressure_kernel(annulus, r, RTOL)


@pytest.mark.parametrize("name", SHAPES)
def test_wide_annulus_equals_difference_of_kernels(name: str) -> None:
    """Jäger's superposition: for c well below a, the difference is well-conditioned."""
    profile = profile_of(name)
    high = float(profile.coordinate_from_radius(np.array(A)))
    for ratio in (0.9, 0.7):
        low = high * ratio
        c = float(profile.contact_radius(np.array(low)))
        r = np.array([0.0, 0.2, 0.5, 0.9]) * c
        # The full kernel is infinite at the tip of a cone or of a spline.
        r = r[1:] if name in {"cone", "table"} else r
        ones = np.ones_like(r)
        annulus = kernel(profile, high, high - low, r)
        whole = profile.pressure_kernel(abel.annulus.whole(high * ones), r, RTOL)
        inner = profile.pressure_kernel(abel.annulus.whole((high - (high - low)) * ones), r, RTOL)
        # The cancelled part is at most about ten times the difference.
        assert np.allclose(annulus, whole - inner, rtol=1e-11, atol=1e-14 * whole.max())


@pytest.mark.parametrize("name", SHAPES)
def test_annulus_over_the_whole_contact(name: str) -> None:
    profile = profile_of(name)
    high = float(profile.coordinate_from_radius(np.array(A)))
    r = np.array([1e-9, 0.3, 0.97, 0.9999]) * A
    whole = profile.pressure_kernel(abel.annulus.whole(np.full(r.shape, high)), r, RTOL)
    assert np.allclose(kernel(profile, high, high, r), whole, rtol=1e-12, atol=0)
