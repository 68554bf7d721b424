"""Cones with a rounded tip: what they have in common, and the tip of a paraboloid."""

from abc import abstractmethod
from dataclasses import dataclass
from math import inf
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.abel.roots import leg, leg_step, one_sided
from mdr_core.profiles.power_kernels import root_step
from mdr_core.profiles.profile import Profile, energy_integral, require_positive
from mdr_core.quadrature import DEFAULT, Analytic
from mdr_core.typing import Array, Parameter

# Just inside the tangent radius, where the tip's own form still holds.
_BELOW: Final = 1 - 2.0**-53


class TippedCone(Profile):
    """A cone of slope t whose tip is rounded up to the tangent radius b."""

    slope: Parameter
    tip_radius: Parameter

    closed_forms: ClassVar[tuple[str, ...]] = ("normal_force", "mean_pressure", "normal_stiffness")

    @property
    @abstractmethod
    def tangent_radius(self) -> Parameter:
        """Radius b where the tip ends in the cone [length]."""

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        return (self.tangent_radius,)

    @property
    def scale(self) -> Parameter:
        """Contact coordinate of the tangent radius."""
        return self.tangent_radius

    @property
    def branches(self) -> tuple[Branch, ...]:
        b = float(np.asarray(self.tangent_radius))
        return (
            Branch(
                0.0,
                lambda x, _s, _index: self.dg(np.minimum(x, b * _BELOW)),
                b,
                tip=2.0,
                pole=self._pole,
            ),
            Branch(b, lambda x, s, _index: self._flank_weight(x, s), behind=self._behind),
        )

    @abstractmethod
    def _tip_energy(self, coordinate: Array) -> Array:
        """Reduced energy up to the tangent radius."""

    @abstractmethod
    def _tip_kernel(
        self, high: Array, r: Array, rtol: float, width: Array, edge: Array, inner: Array
    ) -> Array:
        """The tip's part of the kernel, from max(r, c) to a <= b."""

    @abstractmethod
    def _flank_weight(self, x: Array, s: Array) -> Array:
        """g'(x) s/x beyond the tangent radius."""

    @abstractmethod
    def _flank_force(self, x: Array, s: Array) -> Array:
        """F/E* beyond the tangent radius, s = sqrt(x^2 - b^2)."""

    def _outer(self, coordinate: Array) -> Array:
        """s = sqrt(a^2 - b^2), zero inside the tip."""
        return leg(coordinate, self.tangent_radius)

    @abstractmethod
    def _past(self, coordinate: Array, s: Array) -> Array:
        """How far the contact coordinate is past the tangent radius, of s too, zero inside it."""

    @abstractmethod
    def _outer_step(self, high: Array, width: Array) -> Array:
        """s(a)^2 - s(c)^2 with its digits, for c beyond the tangent radius."""

    @property
    def coordinate_breaks(self) -> Array:
        return np.atleast_1d(np.asarray(self.scale, dtype=float))

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

    @property
    def _behind(self) -> float:
        """s = -`_behind` is the flank's nearest singularity, if any is felt."""
        return inf

    def reduced_energy(self, coordinate: Array) -> Array:
        b = self.tangent_radius

        def density(s: Array) -> Array:
            x = np.hypot(b, s)
            return self._flank_force(x, s) * self._flank_weight(x, s)

        tip = self._tip_energy(np.minimum(coordinate, self.scale))
        return tip + energy_integral(density, self._outer(coordinate), self._energy_scale)

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
        high, r = np.broadcast_arrays(coordinate, radius)
        width = high if width is None else np.broadcast_to(width, high.shape)
        start, b = (
            np.broadcast_to(np.asarray(part, dtype=float), high.shape)
            for part in (self.scale, self.tangent_radius)
        )
        low = high - width
        a = np.broadcast_to(self.contact_radius(high) if edge is None else edge, high.shape)
        c = np.broadcast_to(self.contact_radius(low) if inner is None else inner, high.shape)
        total = np.zeros(high.shape)
        flank = high > start
        # By the radii, if they are what was given: so the tip ends where the flank begins.
        s = self._outer(high) if edge is None else leg(a, b)
        # A narrow annulus that ends on b lies in the tip, though low is b but for rounding.
        inside = (r < b) & ((low < start) | ~flank)
        if inside.any():
            # Of a contact that ends on the flank the tip's part ends at b.
            top = np.where(flank, start, high)[inside]
            # Of a wide annulus the radii have the digits, however small b is next to a.
            within = np.where(
                high > 2 * start,
                start - self.coordinate_from_radius(c),
                width - self._past(high, s),
            )
            step = np.minimum(width, within)[inside]
            end = np.where(flank, b, a)[inside]
            total[inside] = self._tip_kernel(top, r[inside], rtol, step, end, c[inside])
        if flank.any():
            ends = s[flank], a[flank], c[flank]
            total[flank] += self._flank_kernel(
                b[flank], r[flank], high[flank], width[flank], ends, rtol
            )
        total *= modulus
        return total

    def _flank_kernel(
        self,
        b: Array,
        r: Array,
        high: Array,
        width: Array,
        ends: tuple[Array, Array, Array],
        rtol: float,
    ) -> Array:
        upper, edge, inner = ends
        beyond = self._outer(high - width) > 0
        square = self._outer_step(high, np.where(beyond, width, 0.0))
        annulus = np.where(beyond, leg_step(upper, square, leg(inner, b)), upper)
        value = one_sided(
            lambda x, s, _: self._flank_weight(x, s),
            b,
            r,
            upper,
            width=annulus,
            edge=edge,
            inner=inner,
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
        s = leg(x, b)
        flank = self.slope * x * (b / np.maximum(x + s, b) + np.arctan(s / b))
        return np.where(x < b, x * x / self.tip_radius, flank)

    def dg(self, x: Array) -> Array:
        """2 x/R, then t [phi + 2 b/(x + s)]."""
        b = self.tangent_radius
        s = leg(x, b)
        flank = self.slope * (np.arctan(s / b) + 2 * b / np.maximum(x + s, b))
        return np.where(x < b, 2 * x / self.tip_radius, flank)

    def reduced_force(self, coordinate: Array) -> Array:
        """4a^3/(3R), then t [a^2 phi + (4/3) a^2 b/(a + s) + b s/3]."""
        a, b = coordinate, self.tangent_radius
        tip = 4 * a * a * a / (3 * self.tip_radius)
        return np.where(a < b, tip, self._flank_force(np.maximum(a, b), leg(a, b)))

    def _flank_force(self, x: Array, s: Array) -> Array:
        b = self.tangent_radius
        square = x * x * (np.arctan(s / b) + (4 / 3) * b / (x + s))
        return np.asarray(self.slope * (square + b * s / 3))

    def _past(self, coordinate: Array, s: Array) -> Array:
        return np.maximum(coordinate - self.tangent_radius, 0.0)

    def _outer_step(self, high: Array, width: Array) -> Array:
        return width * (2 * high - width)

    def _tip_energy(self, coordinate: Array) -> Array:
        square = coordinate * coordinate
        return np.asarray(8 / 15 * (square * square * coordinate) / np.square(self.tip_radius))

    def _tip_kernel(
        self, high: Array, r: Array, rtol: float, width: Array, edge: Array, inner: Array
    ) -> Array:
        return np.asarray(2 / (np.pi * self.tip_radius) * root_step(edge, r, width, inner))

    def _flank_weight(self, x: Array, s: Array) -> Array:
        b = self.tangent_radius
        return self.slope * (np.arctan(s / b) + 2 * b / (x + s)) * s / x
