"""State of the worn annulus, and the quantities that follow from it.

All in the units of `InitialState`.

A slipping point has |s| = mu (E*/G*) sigma, sigma = (2/pi) int_c^r gamma(x)/sqrt(r^2 - x^2) dx with
gamma(x) = g(x) - (d - D), and wears by dh/dN = kappa p sigma. D is the displacement amplitude
divided by mu E*/G*. In full slip c = 0, and sigma is D - d larger. Source: notes, §11.
"""

from dataclasses import dataclass, field
from functools import cached_property
from math import acos
from typing import Final, Self

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.typing import Array
from mdr_core.wear.initial_state import TILT_TERMS, InitialState

# The tilt's points, the map from values there to its terms, and from terms to those of its slope.
_POINTS: Final = chebyshev.chebpts1(TILT_TERMS)
_TO_SERIES: Final = np.linalg.inv(chebyshev.chebvander(_POINTS, TILT_TERMS - 1))
_DERIVATIVE: Final = np.pad(chebyshev.chebder(np.eye(TILT_TERMS)), ((0, 1), (0, 0)))


@dataclass(frozen=True)
class AnnulusState:
    """The worn annulus at one number of cycles."""

    initial: InitialState
    inner_worn: Array
    """(sigma - S_0)/s at all nodes but the last, S_0 being sigma of the unworn shape."""
    end: float
    """b = sqrt(a^2 - c^2)."""
    stick_shift: float
    """c - c_0, without the rounding error of c in a narrow annulus."""
    retained_wear: float
    """w_c = g(c) - g_0(c): wear that the springs keep when a growing stick zone gets there. Where
    it does not grow, d - d_0."""
    tilt_terms: Array
    """Where the stick zone grows, the tilt C(r) = -(2/pi) int arccos(c/r) dw_c of the surface
    outside as a Chebyshev series in 1/r, from a_0 to the largest contact radius; else empty."""
    trail: Array = field(default_factory=lambda: np.empty((2, 0)))
    """Radii c that a growing stick zone has passed, and the wear w_c that the springs keep there;
    the last of them is the stick edge. Shape (2, k)."""

    @classmethod
    def of(cls, initial: InitialState, vector: Array) -> Self:
        """Return the state of a vector of the integrator: the numbers above, one after another."""
        inner, tilted = initial.parts
        end, stick_shift, retained_wear = vector[inner:tilted].tolist()
        worn, tilt = vector[:inner], vector[tilted:]
        return cls(initial, worn, end, stick_shift, retained_wear, tilt)

    @property
    def stick(self) -> float:
        """c."""
        return self.initial.stick + self.stick_shift

    @property
    def passed(self) -> tuple[Array, Array]:
        """Middle radii of the intervals of the trail, and the steps of w_c over them."""
        radius, worn = self.trail
        return (radius[1:] + radius[:-1]) / 2, np.diff(worn)

    @property
    def depth_increase(self) -> float:
        """d - d_0."""
        return self.retained_wear + (self._stick_rise if self.initial.stick_grows else 0.0)

    @cached_property
    def _stick_rise(self) -> float:
        """g_0(c) - g_0(c_0)."""
        return -float(self.initial.rise(self.stick_shift, np.array([-self.stick_shift]))[0])

    @cached_property
    def reduced_amplitude(self) -> float:
        """gamma(a): D, and d in full slip."""
        if self.initial.constant_displacement:
            return self.initial.step
        rise = self._stick_rise if self.initial.stick_shrinks else 0.0
        return self.initial.step + self.depth_increase - rise

    @cached_property
    def x(self) -> Array:
        """Radii of the nodes; the last one is a."""
        return np.sqrt(self.stick**2 + self.end**2 * self.initial.maps.squares)

    @cached_property
    def offset(self) -> Array:
        """x - c."""
        return np.asarray(self.end**2 * self.initial.maps.squares / (self.x + self.stick))

    @cached_property
    def lever(self) -> Array:
        """gamma/omega: x, and b in full slip."""
        return np.full(self.x.shape, self.end) if self.initial.full_slip else self.x

    @cached_property
    def growth(self) -> float:
        """a - a_0."""
        return self.stick_shift + float(self.offset[-1]) - self.initial.width

    @cached_property
    def unworn(self) -> Array:
        """omega of the unworn shape: (g_0(x) - g_0(c))/x."""
        return self.initial.rise(self.stick_shift, self.offset) / self.lever

    @cached_property
    def tilt(self) -> tuple[float, float]:
        """C at the contact's edge, and its slope."""
        if not self.initial.stick_grows:
            return 0.0, 0.0
        value, slope = (terms @ self.tilt_terms for terms in self.tilt_basis)
        return float(value), float(slope)

    @cached_property
    def tilt_basis(self) -> tuple[Array, Array]:
        """Values of the terms of C at the contact's edge, and their slopes."""
        most, growth = self.initial.largest_growth, self.growth
        first = self.initial.stick + self.initial.width
        radius, stop = first + growth, first + most
        slope = 2 * first * stop / (radius**2 * most)
        place = min(max(2 * growth * stop / (radius * most) - 1, -1.0), 1.0)
        values = np.cos(np.arange(TILT_TERMS) * acos(place))
        return np.asarray(values), np.asarray(slope * (values @ _DERIVATIVE))

    @cached_property
    def tilt_rates(self) -> Array:
        """Terms of dC/dw_c."""
        most, width = self.initial.largest_growth, self.initial.width
        first = self.initial.stick + width
        share = (1 + _POINTS) / 2 * most / (first + most)
        offset = width + share * first / (1 - share) - self.stick_shift
        values = -2 / np.pi * np.arctan2(np.sqrt(offset * (offset + 2 * self.stick)), self.stick)
        return np.asarray(_TO_SERIES @ values)

    @cached_property
    def worn(self) -> Array:
        """(sigma - S_0)/s: while the stick edge rests, the worn depth divided by s."""
        return np.append(self.inner_worn, self.tilt[0] / self.end)

    @cached_property
    def worn_omega(self) -> Array:
        """omega without that of the unworn shape."""
        return np.asarray(self.initial.maps.from_slip @ self.worn)

    @cached_property
    def omega(self) -> Array:
        """gamma/x."""
        return self.unworn + self.worn_omega

    @cached_property
    def gamma(self) -> Array:
        """g(x) - (d - D)."""
        return self.lever * self.omega

    @cached_property
    def pressure(self) -> Array:
        """p/E* at the nodes."""
        return np.asarray(self.initial.maps.to_pressure @ self.gamma) / self.end

    @cached_property
    def slip(self) -> Array:
        """v = sigma/s, and sigma/b in full slip."""
        v = self.initial.maps.to_slip @ self.unworn + self.worn
        if self.initial.full_slip:
            v += (1.0 - self.reduced_amplitude) / self.end
        return np.asarray(v)

    @cached_property
    def worn_integral(self) -> float:
        """int_c^a (gamma - gamma_0) dx."""
        return float(self.end**2 * (self.initial.maps.mean @ self.worn_omega))

    @cached_property
    def force(self) -> float:
        """F_N/(2 E*): F_N0(a) and a w(a) - int_c^a w dx, w = g - g_0.

        In full slip it is int (d - g) dx at the nodes: worn depths far above the elastic ones
        cancel in g_0 and w.
        """
        if self.initial.full_slip:
            mean = float(self.initial.maps.mean @ self.omega)
            return float(self.end * self.gamma[-1]) - self.end**2 * mean
        unworn = self.initial.unworn_force(self.growth)
        return unworn + float(self.x[-1] ** 2 * self.worn_omega[-1]) - self.worn_integral

    def spring_wear(self, x: Array) -> Array:
        """Return gamma - gamma_0 at radii x, clipped to those of the annulus."""
        squares = (x - self.stick) * (x + self.stick) / self.end**2
        lever = self.end if self.initial.full_slip else x
        return np.asarray(lever * self.initial.maps.at(self.worn_omega, np.clip(squares, 0.0, 1.0)))
