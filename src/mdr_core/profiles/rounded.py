"""Profiles that are smooth at the axis: sphere, ellipsoid, hyperboloid."""

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.abel.polynomial import single
from mdr_core.abel.roots import arc, between
from mdr_core.checks import first_index
from mdr_core.errors import InputError
from mdr_core.profiles.equator import slope_integral_beside, slope_integral_within
from mdr_core.profiles.power_kernels import root_step
from mdr_core.profiles.profile import Profile, require_positive
from mdr_core.profiles.smooth_tip import smooth_tip_kernel
from mdr_core.profiles.stable import atan_gap, tanh_gap
from mdr_core.typing import Array, Chosen, Parameter

_EQUATOR: Final = 17.0
# From here on, a tenth of R before the equator, radii have not the digits for the pole there.
_NEAR_EQUATOR: Final = 1.5
# Up to this v, 0.8 of the radius, a polynomial may be short.
_SHALLOW: Final = 1.1
_CLOSED: Final = ("normal_force", "mean_pressure", "normal_stiffness")


class Spheroid(Profile):
    """Half axes R = `radius` and h = `height`: f = h (1 - sqrt(1 - r^2/R^2)).

    The contact coordinate is v = artanh(a/R): near the equator, a alone has no digits left.
    Source: notes, §2.
    """

    radius: Parameter
    height: Parameter

    closed_forms: ClassVar[tuple[str, ...]] = _CLOSED

    @property
    def domain(self) -> Parameter:
        return self.radius

    @property
    def last_coordinate(self) -> float:
        """Where R - a is down to a few units in the last place of R."""
        return _EQUATOR

    def f(self, radius: Array) -> Array:
        q = np.square(radius / self.radius)
        return np.asarray(self.height * q / (1 + np.sqrt(1 - q)))

    def df(self, radius: Array) -> Array:
        root = np.sqrt((self.radius - radius) * (self.radius + radius))
        return np.asarray(self.height / self.radius * radius / root)

    @property
    def branches(self) -> tuple[Branch, ...]:
        big = float(np.asarray(self.radius))
        return (Branch(0.0, lambda x, _s, _index: self.dg(x), tip=2.0, pole=big),)

    def g(self, x: Array) -> Array:
        return self.depth(self._rapidity(x))

    def dg(self, x: Array) -> Array:
        pole = x * self.radius / ((self.radius - x) * (self.radius + x))
        return np.asarray(self.height / self.radius * (self._rapidity(x) + pole))

    def _rapidity(self, x: Array) -> Array:
        """artanh(x/R), with the digits of R - x."""
        return np.asarray(0.5 * np.log1p(2 * x / (self.radius - x)))

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        outside = np.asarray(contact_radius >= self.radius)
        if outside.any():
            raise InputError(
                ("load", "contact_radius", *first_index(outside)),
                f"must stay below the body's own radius, {self.radius}",
                outside,
            )
        return self._rapidity(contact_radius)

    def contact_radius(self, coordinate: Array) -> Array:
        return self.radius * np.tanh(coordinate)

    def radius_slope(self, coordinate: Array) -> Array:
        return np.asarray(self.radius / np.square(np.cosh(coordinate)))

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        """artanh of the difference of two tanh, while it is small."""
        big = np.asarray(self.radius)
        difference = big * (a - c) / (big * (big - a) + a * (big - c))
        narrow = np.arctanh(np.minimum(difference, 0.5))
        return np.asarray(np.where(difference < 0.5, narrow, s_a - s_c))

    def radius_width(self, s_a: Array, width: Array) -> Array:
        sech = np.cosh(s_a) * np.cosh(s_a - width)
        return np.asarray(self.radius * np.sinh(width) / sech)

    def depth(self, coordinate: Array) -> Array:
        """h v tanh(v)."""
        return self.height * coordinate * np.tanh(coordinate)

    def depth_slope(self, coordinate: Array) -> Array:
        sech = 1 / np.cosh(coordinate)
        return self.height * (np.tanh(coordinate) + coordinate * sech * sech)

    def reduced_force(self, coordinate: Array) -> Array:
        """h R [t^3 + (1 + t^2)(v - t)], t = tanh(v): all terms positive."""
        t = np.tanh(coordinate)
        bracket = t * t * t + (1 + t * t) * tanh_gap(coordinate)
        return self.height * self.radius * bracket

    @property
    def scale(self) -> Parameter:
        return 1.0

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        v = self._rapidity(r)
        if not v.max(initial=0.0) > _NEAR_EQUATOR:
            return super().slip_kernel(c, r, rtol)
        width = self.coordinate_width(r, c, v, self._rapidity(c))
        big, height = self._axes
        return 2 / np.pi * height * slope_integral_within(big, v, width, r, rtol)

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        if not coordinate > _NEAR_EQUATOR:
            return super().outer_displacement(a, r, rtol, coordinate)
        big, height = self._axes
        return 2 / np.pi * height * slope_integral_beside(big, coordinate, r, rtol)

    @property
    def _axes(self) -> tuple[float, float]:
        return float(np.asarray(self.radius)), float(np.asarray(self.height))

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
        kernel = self._by_polynomial(coordinate, radius, rtol, width, edge, inner)
        if kernel is None:
            kernel = sphere_kernel(self.radius, coordinate, radius, rtol, width, edge, inner)
        kernel *= modulus * self.height / self.radius
        return kernel

    def _by_polynomial(
        self,
        v: Array,
        r: Array,
        rtol: float,
        width: Array | None,
        edge: Array | None,
        inner: Array | None,
    ) -> Array | None:
        """The kernel of a shallow contact, None of others."""
        if not single(v, width, edge, inner) or v.item() > _SHALLOW:
            return None
        a = self.contact_radius(v) if edge is None else edge
        gap = None if width is None else self.radius_width(v, width)
        return smooth_tip_kernel(_sphere_slope, self.radius, a, r, rtol, gap, inner)


def _sphere_slope(q: Array) -> Array:
    """artanh(x)/x + 1/(1 - x^2) with q = x^2 > 0: of g' of the unit sphere, over x."""
    x = np.sqrt(q)
    return np.asarray(np.arctanh(x) / x + 1 / (1 - q))


def sphere_kernel(
    big_radius: Parameter,
    v: Array,
    r: Array,
    rtol: float,
    width: Array | None = None,
    edge: Array | None = None,
    inner: Array | None = None,
) -> Array:
    """The pressure kernel of a sphere; edge and annulus in v = artanh(a/R).

    With z = x/sqrt(R^2 - x^2) and z^2 + 1 = (z_r^2 + 1) cosh^2 y both the root at r and the pole
    at R are gone; what g' carries as a pole is elementary:
    P = (1/pi) [sqrt(1 + z_r^2) y + int arcsinh(z)/(z cosh y) dy] from y(c) to y(a).
    """
    square = (big_radius - r) * (big_radius + r)
    tilt2 = r * r / square
    stretch = big_radius / np.sqrt(square)

    def h(y: Array, index: Chosen) -> Array:
        z = np.sinh(y)
        z *= stretch[index]
        z *= z
        z += tilt2[index]
        np.sqrt(z, out=z)
        np.cosh(y, out=y)
        y *= z
        np.arcsinh(z, out=z)
        z /= y
        return z

    top = _sphere_leg(big_radius, v, r, edge)
    if width is None:
        length = np.arcsinh(top)
        smooth = between(h, length, rtol)
    else:
        inmost = v - width
        lower, length = arc(
            top,
            np.cosh(v) / stretch,
            _sphere_leg(big_radius, inmost, r, inner),
            np.maximum(np.cosh(inmost) / stretch, 1.0),
            np.sinh(width) * np.sinh(2 * v - width) / (stretch * stretch),
        )
        smooth = between(h, length, rtol, lower)
    stretch *= length
    smooth += stretch
    smooth /= np.pi
    return smooth


def _sphere_leg(big_radius: Parameter, v: Array, r: Array, edge: Array | None) -> Array:
    """sqrt((a^2 - r^2)/(R^2 - a^2)) with a = R tanh(v), zero for a < r."""
    a = big_radius * np.tanh(v) if edge is None else edge
    root = np.maximum(a - r, 0.0)
    root *= a + r
    np.sqrt(root, out=root)
    root *= np.cosh(v) / big_radius
    return root


@dataclass(frozen=True)
class Sphere(Spheroid):
    """f = R - sqrt(R^2 - r^2), R = `radius` [length], exact. Source: notes, §2."""

    radius: Parameter

    kind: ClassVar[str] = "sphere"
    formula: ClassVar[str] = "radius − √(radius² − r²), contact radius < radius"

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)

    @property
    def height(self) -> Parameter:  # type: ignore[override]
        return self.radius


@dataclass(frozen=True)
class Ellipsoid(Spheroid):
    """f = h (1 - sqrt(1 - r^2/R^2)), semi-axes R = `radius` and h = `height` [length].

    Source: notes, §2.
    """

    radius: Parameter
    height: Parameter

    kind: ClassVar[str] = "ellipsoid"
    formula: ClassVar[str] = "height·(1 − √(1 − r²/radius²)), contact radius < radius"

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)
        require_positive("height", self.height)


@dataclass(frozen=True)
class Hyperboloid(Profile):
    """f = R t^2 (sqrt(1 + r^2/(R t)^2) - 1): tip R = `tip_radius`, asymptote t = `slope`.

    Source: notes, §2; g = t x arctan(x/(R t)).
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "hyperboloid"
    formula: ClassVar[str] = "tip_radius·slope²·(√(1 + r²/(tip_radius·slope)²) − 1)"
    closed_forms: ClassVar[tuple[str, ...]] = _CLOSED

    def __post_init__(self) -> None:
        require_positive("slope", self.slope)
        require_positive("tip_radius", self.tip_radius)

    @property
    def scale(self) -> Parameter:
        """h = R t, where the tip turns into the cone."""
        return self.tip_radius * self.slope

    def f(self, radius: Array) -> Array:
        q = radius / self.scale
        return np.asarray(self.slope * radius * q / (1 + np.hypot(1.0, q)))

    def df(self, radius: Array) -> Array:
        return np.asarray(self.slope * radius / np.hypot(self.scale, radius))

    def g(self, x: Array) -> Array:
        return self.slope * x * np.arctan(x / self.scale)

    def dg(self, x: Array) -> Array:
        q = x / self.scale
        return self.slope * (np.arctan(q) + q / (1 + q * q))

    def reduced_force(self, coordinate: Array) -> Array:
        """t [a^2 arctan(a/h) + h (a - h arctan(a/h))]: all terms positive."""
        a, h = coordinate, self.scale
        return self.slope * (a * a * np.arctan(a / h) + h * atan_gap(a, h))

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
        """x^2 + h^2 = (r^2 + h^2) cosh^2 y removes the root at r and the branch points +-ih."""
        if single(coordinate, width, inner):
            value = smooth_tip_kernel(
                _hyperboloid_slope, self.scale, coordinate, radius, rtol, width, inner
            )
            if value is not None:
                value *= modulus * self.slope
                return value
        a, r, h = coordinate, radius, np.asarray(self.scale)
        rho = np.hypot(h, r)
        leg = root_step(a, r, None)
        top = leg / rho
        r2 = r * r

        def integrand(y: Array, index: Chosen) -> Array:
            x = np.sinh(y)
            x *= rho[index]
            x *= x
            x += r2[index]
            np.sqrt(x, out=x)
            np.cosh(y, out=y)
            y *= rho[index]
            y /= x
            x /= h
            y *= np.arctan(x, out=x)
            return y

        if width is None:
            smooth = between(integrand, np.arcsinh(top), rtol)
            pole = np.arctan(top)
        else:
            step = root_step(a, r, width, inner)
            bottom = np.maximum(leg - step, 0.0) / rho
            difference = width * (2 * a - width) / (rho * rho)
            c = np.maximum(a - width if inner is None else inner, r)
            cosh_top, cosh_bottom = np.hypot(h, a) / rho, np.hypot(h, c) / rho
            lower, length = arc(top, cosh_top, bottom, cosh_bottom, difference)
            smooth = between(integrand, length, rtol, lower)
            pole = np.arctan2(step / rho, 1 + top * bottom)
        smooth += h / rho * pole
        smooth *= modulus * self.slope / np.pi
        return smooth


def _hyperboloid_slope(q: Array) -> Array:
    """arctan(x)/x + 1/(1 + x^2) with q = x^2 > 0: of g' with h = t = 1, over x."""
    x = np.sqrt(q)
    return np.asarray(np.arctan(x) / x + 1 / (1 + q))
