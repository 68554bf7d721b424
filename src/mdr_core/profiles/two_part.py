"""Profiles that change their character at a radius b inside a possible contact."""

from abc import abstractmethod
from dataclasses import dataclass
from math import inf
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.abel.roots import one_sided
from mdr_core.errors import InputError
from mdr_core.profiles.power_kernels import root_step
from mdr_core.profiles.profile import Profile, energy_integral, require_positive
from mdr_core.profiles.rounded import Sphere, sphere_kernel
from mdr_core.profiles.stable import atanh_gap
from mdr_core.quadrature import DEFAULT, Analytic
from mdr_core.typing import Array, Parameter

_OUT_OF_REACH: Final = 1e150
# Just inside the tangent radius, where the tip's own form still holds.
_BELOW: Final = 1 - 2.0**-53
_EPS: Final = float(np.finfo(float).eps)
_CLOSED: Final = ("normal_force", "mean_pressure", "normal_stiffness")


def _leg(x: Array, b: Parameter) -> Array:
    """sqrt(x^2 - b^2), zero for x < b."""
    return np.asarray(np.sqrt(np.maximum(x - b, 0.0) * (x + b)))


class TippedCone(Profile):
    """A cone of slope t whose tip is rounded up to the tangent radius b."""

    slope: Parameter
    tip_radius: Parameter

    @property
    @abstractmethod
    def tangent_radius(self) -> Parameter:
        """Radius b where the tip ends in the cone [length]."""

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.tangent_radius,)

    @property
    def scale(self) -> Parameter:
        return self.tangent_radius

    @property
    def branches(self) -> tuple[Branch, ...]:
        b = float(np.asarray(self.tangent_radius))
        return (
            Branch(
                0.0,
                lambda x, _s, _index: self.dg(np.minimum(x, b * _BELOW)),
                b,
                pole=self._pole,
            ),
            Branch(b, lambda x, s, _index: self._flank_weight(x, s)),
        )

    @abstractmethod
    def _tip_energy(self, a: Array) -> Array:
        """Reduced energy for a <= b."""

    @abstractmethod
    def _tip_kernel(self, a: Array, r: Array, rtol: float, width: Array, c: Array) -> Array:
        """The tip's part of the kernel, from max(r, c) to a <= b."""

    @abstractmethod
    def _flank_weight(self, x: Array, s: Array) -> Array:
        """g'(x) s/x beyond the tangent radius."""

    @property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self.tangent_radius, dtype=float))

    @property
    def _flank_analytic(self) -> Analytic:
        """Where the flank's weight is analytic in y."""
        return DEFAULT

    @property
    def _energy_scale(self) -> Parameter:
        """Distance in s of the flank's nearest singularity."""
        return self.tangent_radius

    @property
    def _pole(self) -> float:
        """Radius beyond the tip's end where its own g' is infinite."""
        return inf

    def reduced_energy(self, coordinate: Array) -> Array:
        b = self.tangent_radius

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            return self.reduced_force(x) * self._flank_weight(x, s)

        tip = self._tip_energy(np.minimum(coordinate, b))
        return tip + energy_integral(density, _leg(coordinate, b), self._energy_scale)

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
        a, r = np.broadcast_arrays(coordinate, radius)
        width = a if width is None else np.broadcast_to(width, a.shape)
        b = np.broadcast_to(np.asarray(self.tangent_radius, dtype=float), a.shape)
        c = a - width if inner is None else np.broadcast_to(inner, a.shape)
        total = np.zeros(a.shape)
        inside = (r < b) & (c < b)
        if inside.any():
            low, high = c[inside], np.minimum(a, b)[inside]
            step = np.where(a[inside] < b[inside], width[inside], high - low)
            total[inside] = self._tip_kernel(high, r[inside], rtol, step, low)
        flank = a > b
        if flank.any():
            total[flank] += self._flank_kernel(
                b[flank], r[flank], a[flank], c[flank], width[flank], rtol
            )
        total *= modulus
        return total

    def _flank_kernel(
        self, b: Array, r: Array, a: Array, c: Array, width: Array, rtol: float
    ) -> Array:
        upper, lower = _leg(a, b), _leg(c, b)
        annulus = np.where(c > b, width * (a + c) / (upper + lower), upper)
        value = one_sided(
            lambda x, s, _: self._flank_weight(x, s),
            b,
            r,
            upper,
            width=annulus,
            edge=a,
            inner=c,
            odd=False,
            rtol=rtol,
            analytic=self._flank_analytic,
        )
        return value / np.pi


@dataclass(frozen=True)
class RoundedCone(TippedCone):
    """r^2/(2R) up to b = R t, then its tangent cone: t = `slope`, R = `tip_radius`.

    Source: notes, §2.
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "rounded_cone"
    formula: ClassVar[str] = "r²/(2·tip_radius) for r ≤ b = tip_radius·slope, then slope·(r − b/2)"
    closed_forms: ClassVar[tuple[str, ...]] = _CLOSED

    def __post_init__(self) -> None:
        require_positive("slope", self.slope)
        require_positive("tip_radius", self.tip_radius)

    @property
    def tangent_radius(self) -> Parameter:
        return self.tip_radius * self.slope

    def f(self, radius: Array) -> Array:
        b = self.tangent_radius
        tip = radius * radius / (2 * self.tip_radius)
        return np.where(radius < b, tip, self.slope * (radius - b / 2))

    def df(self, radius: Array) -> Array:
        return np.minimum(radius / self.tip_radius, self.slope)

    def g(self, x: Array) -> Array:
        """x^2/R, then t x [b/(x + s) + phi]."""
        b = self.tangent_radius
        s = _leg(x, b)
        flank = self.slope * x * (b / np.maximum(x + s, b) + np.arctan(s / b))
        return np.where(x < b, x * x / self.tip_radius, flank)

    def dg(self, x: Array) -> Array:
        """2 x/R, then t [phi + 2 b/(x + s)]."""
        b = self.tangent_radius
        s = _leg(x, b)
        flank = self.slope * (np.arctan(s / b) + 2 * b / np.maximum(x + s, b))
        return np.where(x < b, 2 * x / self.tip_radius, flank)

    def reduced_force(self, coordinate: Array) -> Array:
        """4a^3/(3R), then t [a^2 phi + (4/3) a^2 b/(a + s) + b s/3]."""
        a, b = coordinate, self.tangent_radius
        s = _leg(a, b)
        square = a * a * (np.arctan(s / b) + (4 / 3) * b / np.maximum(a + s, b))
        flank = self.slope * (square + b * s / 3)
        return np.where(a < b, 4 * a * a * a / (3 * self.tip_radius), flank)

    def _tip_energy(self, a: Array) -> Array:
        return np.asarray(8 / 15 * a**5 / np.square(self.tip_radius))

    def _tip_kernel(self, a: Array, r: Array, rtol: float, width: Array, c: Array) -> Array:
        return np.asarray(2 / (np.pi * self.tip_radius) * root_step(a, r, width, c))

    def _flank_weight(self, x: Array, s: Array) -> Array:
        b = self.tangent_radius
        return self.slope * (np.arctan(s / b) + 2 * b / (x + s)) * s / x


@dataclass(frozen=True)
class SphericalTipCone(TippedCone):
    """A sphere R = `tip_radius` up to b = R t/sqrt(1 + t^2), then its tangent cone, t = `slope`.

    With h = sqrt(R^2 - b^2): every term below is positive. Source: notes, §2,
    rearranged with L = ln((R + x)/(h + s)) = artanh(tau).
    """

    slope: Parameter
    tip_radius: Parameter

    kind: ClassVar[str] = "spherical_tip_cone"
    formula: ClassVar[str] = (
        "sphere of tip_radius for r ≤ b = tip_radius·slope/√(1 + slope²), then its tangent cone"
    )
    closed_forms: ClassVar[tuple[str, ...]] = _CLOSED

    def __post_init__(self) -> None:
        require_positive("slope", self.slope)
        require_positive("tip_radius", self.tip_radius)

    @property
    def tangent_radius(self) -> Parameter:
        return self.tip_radius * self.slope / np.hypot(1.0, self.slope)

    @property
    def _height(self) -> Parameter:
        """h = sqrt(R^2 - b^2), the tangent point's distance below the sphere's centre."""
        return self.tip_radius / np.hypot(1.0, self.slope)

    def f(self, radius: Array) -> Array:
        b, big = self.tangent_radius, self.tip_radius
        inner = np.minimum(radius, b)
        tip = inner * inner / (big + np.sqrt((big - inner) * (big + inner)))
        return tip + self.slope * np.maximum(radius - b, 0.0)

    def df(self, radius: Array) -> Array:
        big = self.tip_radius
        inner = np.minimum(radius, self.tangent_radius)
        tip = inner / np.sqrt((big - inner) * (big + inner))
        return np.asarray(np.where(radius < self.tangent_radius, tip, self.slope))

    @property
    def _flank_analytic(self) -> Analytic:
        """The sphere goes on behind the tangent point: a singularity at s = -h, y < 0."""
        behind = float(np.min(np.arcsinh(1 / np.asarray(self.slope))))
        return Analytic(strip=min(DEFAULT.strip, 0.9 * behind))

    @property
    def _pole(self) -> float:
        return float(np.asarray(self.tip_radius))

    @property
    def steepness(self) -> float:
        """The sphere's equator lies at b sqrt(1 + t^2)/t, the nearer the steeper the cone."""
        return 3.5 * (1 + 4 * float(np.max(np.square(self.slope))))

    @property
    def _energy_scale(self) -> Parameter:
        return np.minimum(self.tangent_radius, self._height)

    @property
    def rounding(self) -> float:  # type: ignore[override]
        # A steep cone touches its sphere near the equator, where a has few digits of R - a.
        return float(3e-14 + 4 * _EPS * np.square(np.max(self.slope)))

    def _tau(self, x: Array, s: Array) -> Array:
        """tanh(L) = b^2 (R h + x s)/((R^2 + s^2)(x h + s R))."""
        b, big, h = self.tangent_radius, self.tip_radius, self._height
        return np.asarray(b * b * (big * h + x * s) / ((big * big + s * s) * (x * h + s * big)))

    def g(self, x: Array) -> Array:
        """x artanh(x/R), then x (L + t phi)."""
        b, big = self.tangent_radius, self.tip_radius
        outer = np.maximum(x, b)
        s = _leg(outer, b)
        flank = np.arctanh(self._tau(outer, s)) + self.slope * np.arctan(s / b)
        return np.where(x < b, x * np.arctanh(np.minimum(x, b) / big), x * flank)

    def dg(self, x: Array) -> Array:
        """artanh(x/R) + x R/(R^2 - x^2), then L + t phi + t b R/(x h + s R)."""
        b, big = self.tangent_radius, self.tip_radius
        inner, outer = np.minimum(x, b), np.maximum(x, b)
        tip = np.arctanh(inner / big) + inner * big / ((big - inner) * (big + inner))
        return np.where(x < b, tip, self._flank_slope(outer, _leg(outer, b)))

    def _flank_slope(self, x: Array, s: Array) -> Array:
        b, big, h = self.tangent_radius, self.tip_radius, self._height
        t = self.slope
        turn = np.arctanh(self._tau(x, s)) + t * np.arctan(s / b)
        return np.asarray(turn + t * b * big / (x * h + s * big))

    def reduced_force(self, coordinate: Array) -> Array:
        """Sphere, then b^4/(R a + h s) + (R^2 + a^2)(artanh(tau) - tau) + t (a^2 phi + b s)."""
        a, b, big, h = coordinate, self.tangent_radius, self.tip_radius, self._height
        inner, outer = np.minimum(a, b), np.maximum(a, b)
        tip = inner * inner * inner / big + (big * big + inner * inner) * atanh_gap(inner / big)
        s = _leg(outer, b)
        sphere = b**4 / (big * outer + h * s)
        sphere = sphere + (big * big + outer * outer) * atanh_gap(self._tau(outer, s))
        flank = sphere + self.slope * (outer * outer * np.arctan(s / b) + b * s)
        return np.where(a < b, tip, flank)

    def _tip_energy(self, a: Array) -> Array:
        tip = Sphere(self.tip_radius)
        return tip.reduced_energy(tip.coordinate_from_radius(a))

    def _tip_kernel(self, a: Array, r: Array, rtol: float, width: Array, c: Array) -> Array:
        big = self.tip_radius
        step = np.arctanh(big * width / (big * big - a * c))
        return sphere_kernel(big, np.arctanh(a / big), r, rtol, step, a, c)

    def _flank_weight(self, x: Array, s: Array) -> Array:
        return self._flank_slope(x, s) * s / x


@dataclass(frozen=True)
class CappedParaboloid(Profile):
    """r^2/(2 R1) up to b, then k (r^2 - b^2)/2 more, k = 1/R2 - 1/R1 >= 0.

    b = `cap_radius`, R1 = `tip_radius`, R2 = `radius` <= R1 [length]: with R2 > R1 the slope
    would drop at b and the pressure there fall to minus infinity. The contact coordinate is
    a up to b and b + sqrt(a^2 - b^2) beyond. Source: notes, §2 and §3.
    """

    cap_radius: Parameter
    tip_radius: Parameter
    radius: Parameter

    kind: ClassVar[str] = "capped_paraboloid"
    formula: ClassVar[str] = (
        "r²/(2·tip_radius) for r ≤ cap_radius, then "
        "+ (1/radius − 1/tip_radius)·(r² − cap_radius²)/2"
    )
    closed_forms: ClassVar[tuple[str, ...]] = _CLOSED

    def __post_init__(self) -> None:
        require_positive("cap_radius", self.cap_radius)
        require_positive("tip_radius", self.tip_radius)
        require_positive("radius", self.radius)
        if np.any(np.asarray(self.radius) > np.asarray(self.tip_radius)):
            raise InputError(
                ("profile", "radius"),
                "must not exceed tip_radius: the slope would drop at radius "
                f"{self.cap_radius}, where the pressure falls below zero",
            )

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.cap_radius,)

    @property
    def scale(self) -> Parameter:
        return self.cap_radius

    @property
    def _kink(self) -> Parameter:
        """k = 1/R2 - 1/R1 [1/length]."""
        return (self.tip_radius - self.radius) / (self.tip_radius * self.radius)

    @property
    def _break(self) -> Parameter:
        """b, out of reach where the radii are equal and nothing changes there."""
        return np.where(np.asarray(self._kink) > 0, self.cap_radius, _OUT_OF_REACH)[()]

    @property
    def infinite_pressure_radii(self) -> tuple[float, ...]:
        return (float(np.min(self._break)),)

    @property
    def rounding(self) -> float:  # type: ignore[override]
        # The coordinate is rounded to eps b, however little s the flank needs to bear the load.
        return float(3e-14 + _EPS * np.max(self.tip_radius / np.asarray(self.radius)))

    def f(self, radius: Array) -> Array:
        outer = _leg(radius, self._break)
        return radius * radius / (2 * self.tip_radius) + self._kink * outer * outer / 2

    def df(self, radius: Array) -> Array:
        return np.where(radius < self._break, radius / self.tip_radius, radius / self.radius)

    def g(self, x: Array) -> Array:
        return x * x / self.tip_radius + self._kink * x * _leg(x, self._break)

    def dg(self, x: Array) -> Array:
        s = _leg(x, self._break)
        with np.errstate(divide="ignore", invalid="ignore"):
            outer = np.where(x < self._break, 0.0, self._kink * (s + x * x / s))
        return 2 * x / self.tip_radius + np.where(np.asarray(self._kink) > 0, outer, 0.0)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        b = self._break
        return np.minimum(contact_radius, b) + _leg(contact_radius, b)

    @property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self._break, dtype=float))

    def radius_slope(self, coordinate: Array) -> Array:
        beyond = self._outer(coordinate) / np.maximum(self.contact_radius(coordinate), self._break)
        return np.where(coordinate < self._break, 1.0, beyond)

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        b = self._break
        beyond = (a - c) * (a + c) / np.where(s_a + s_c > 2 * b, s_a + s_c - 2 * b, 1.0)
        across = (s_a - b) + (b - np.minimum(s_c, b))
        return np.where(a <= b, a - c, np.where(c >= b, beyond, across))

    def radius_width(self, s_a: Array, width: Array) -> Array:
        low = s_a - width
        ends = self.contact_radius(s_a), self.contact_radius(low)
        return self._annulus(s_a, low, width, *ends)

    def _outer(self, coordinate: Array) -> Array:
        """s = sqrt(a^2 - b^2), zero inside the cap."""
        return np.maximum(coordinate - self._break, 0.0)

    def contact_radius(self, coordinate: Array) -> Array:
        return np.asarray(np.hypot(np.minimum(coordinate, self._break), self._outer(coordinate)))

    def depth(self, coordinate: Array) -> Array:
        """a^2/R1 + k a s."""
        a = self.contact_radius(coordinate)
        return a * a / self.tip_radius + self._kink * a * self._outer(coordinate)

    def depth_slope(self, coordinate: Array) -> Array:
        a, s = self.contact_radius(coordinate), self._outer(coordinate)
        cap = 2 * np.where(coordinate < self._break, coordinate, s) / self.tip_radius
        with np.errstate(divide="ignore", invalid="ignore"):
            kink = self._kink * (s * s + a * a) / a
        return cap + np.where(coordinate < self._break, 0.0, kink)

    def reduced_force(self, coordinate: Array) -> Array:
        """4a^3/(3 R1) + (2/3) k s (2a^2 + b^2)."""
        a, s, b = self.contact_radius(coordinate), self._outer(coordinate), self._break
        cap = 4 * a * a * a / (3 * self.tip_radius)
        return cap + (2 / 3) * self._kink * s * (2 * a * a + b * b)

    def reduced_energy(self, coordinate: Array) -> Array:
        b = self._break

        def density(s: Array) -> Array:
            return self.reduced_force(b + s) * self.depth_slope(b + s)

        cap = 8 / 15 * np.minimum(coordinate, b) ** 5 / np.square(self.tip_radius)
        outer = self._outer(coordinate)
        return cap + energy_integral(density, outer, b) if outer.any() else cap

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
        b = self._break
        coordinate = np.broadcast_to(coordinate, radius.shape)
        a, s = self.contact_radius(coordinate), self._outer(coordinate)
        a = a if edge is None else edge
        low = 0 * coordinate if width is None else coordinate - width
        c, s_c = self.contact_radius(low), self._outer(low)
        annulus = None if width is None else self._annulus(coordinate, low, width, a, c)
        total = np.asarray(2 / (np.pi * self.tip_radius) * root_step(a, radius, annulus, inner))
        outer = s > 0
        if outer.any() and self._kink > 0:
            step = s if width is None else np.where(s_c > 0, width, s)
            step = step[outer]
            total[outer] += (
                self._kink
                / np.pi
                * one_sided(
                    lambda x, leg, _: (x * x + leg * leg) / x,
                    b,
                    radius[outer],
                    s[outer],
                    width=step,
                    edge=None if edge is None else np.broadcast_to(edge, s.shape)[outer],
                    inner=None if inner is None else np.broadcast_to(inner, s.shape)[outer],
                    odd=True,
                    rtol=rtol,
                )
            )
        total *= modulus
        return total

    @property
    def branches(self) -> tuple[Branch, ...]:
        b, tip, kink = float(np.asarray(self._break)), self.tip_radius, self._kink
        return (
            Branch(0.0, lambda x, _s, _index: 2 * x / tip, b),
            Branch(b, lambda x, s, _index: 2 * s / tip + kink * (x * x + s * s) / x),
        )

    def _annulus(self, high: Array, low: Array, width: Array, a: Array, c: Array) -> Array:
        """a - c with its digits, from the coordinates and their difference."""
        b = self._break
        s, s_c = self._outer(high), self._outer(low)
        beyond = width * (s + s_c) / np.where(a + c > 0, a + c, 1.0)
        across = s * s / (a + b) + (b - np.minimum(low, b))
        return np.where(high <= b, width, np.where(low >= b, beyond, across))
