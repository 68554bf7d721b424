"""State of the worn annulus, and the quantities that follow from it.

A slipping point has |s| = mu (E*/G*) sigma, sigma = (2/pi) int_c^r gamma(x)/sqrt(r^2 - x^2) dx with
gamma(x) = g(x) - (d - D), and wears by dh/dN = kappa p sigma. D is the displacement amplitude
divided by mu E*/G*. In full slip c = 0, and sigma is D - d larger. Source: notes, §11.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.doubles import TINY
from mdr_core.typing import Array
from mdr_core.wear.initial_state import TILT_TERMS, InitialState

# The tilt's points, and the maps from its values there to its terms and on to terms of its slope.
_ORDERS: Final = np.arange(TILT_TERMS)[:, None]
_POINTS: Final = chebyshev.chebpts1(TILT_TERMS)[:, None]
_TO_SERIES: Final = np.linalg.inv(chebyshev.chebvander(_POINTS[:, 0], TILT_TERMS - 1))
_DERIVATIVE: Final = np.pad(chebyshev.chebder(np.eye(TILT_TERMS)), ((0, 1), (0, 0)))


@dataclass(frozen=True)
class AnnulusState:
    """The worn annulus at several numbers of cycles: (k,), and (n, k) at the nodes."""

    initial: InitialState
    vector: Array
    """Numbers of the integrator, in `InitialState.units`."""

    @cached_property
    def _numbers(self) -> tuple[Array, Array, Array]:
        """Wear at the inner nodes; b, c - c_0, w_c or d - d_0; terms of the tilt."""
        inner = self.initial.maps.squares.size - 1
        numbers = self.vector * self.initial.units
        return numbers[:inner], numbers[inner : inner + 3], numbers[inner + 3 :]

    @cached_property
    def end(self) -> Array:
        """b = sqrt(a^2 - c^2)."""
        return self._numbers[1][0]

    @cached_property
    def stick_shift(self) -> Array:
        """c - c_0, without the rounding error of c in a narrow annulus."""
        return self._numbers[1][1]

    @property
    def retained_wear(self) -> Array:
        """w_c = g(c) - g_0(c): wear that the springs keep when a growing stick zone gets there.

        It is d - d_0 if the stick zone does not grow.
        """
        return self._numbers[1][2]

    @cached_property
    def stick_radius(self) -> Array:
        """c [length]: it moves where one force and one displacement are constant."""
        return self.initial.stick + self.stick_shift

    @property
    def depth_increase(self) -> Array:
        """d - d_0."""
        return self.retained_wear + (self._stick_rise if self.initial.stick_grows else 0.0)

    @cached_property
    def _stick_rise(self) -> Array:
        """g_0(c) - g_0(c_0)."""
        return -self.initial.rise(self.stick_shift, -self.stick_shift[None])[0]

    @cached_property
    def reduced_amplitude(self) -> Array:
        """gamma(a), which is the depth D, or d in full slip."""
        if self.initial.constant_displacement:
            return np.full(self.end.shape, self.initial.step)
        rise = self._stick_rise if self.initial.stick_shrinks else 0.0
        return self.initial.step + self.depth_increase - rise

    @cached_property
    def x(self) -> Array:
        """Radii of the nodes; the last one is a."""
        return np.sqrt(self.stick_radius**2 + self.end**2 * self.initial.maps.squares)

    @cached_property
    def offset(self) -> Array:
        """x - c."""
        both = np.maximum(self.x + self.stick_radius, TINY)
        return np.asarray(self.end**2 * self.initial.maps.squares / both)

    @cached_property
    def lever(self) -> Array:
        """gamma/omega: x, and b in full slip."""
        return self.end[None] if self.initial.full_slip else self.x

    @property
    def growth(self) -> Array:
        """a - a_0."""
        return np.asarray(self.stick_shift + self.offset[-1] - self.initial.width)

    @cached_property
    def unworn(self) -> Array:
        """omega of the unworn shape: (g_0(x) - g_0(c))/x."""
        return self.initial.rise(self.stick_shift, self.offset) / self.lever

    @cached_property
    def tilt(self) -> tuple[Array, Array]:
        """Tilt C(r) = -(2/pi) int arccos(c/r) dw_c at the contact's edge, and its slope.

        A growing stick zone tilts the surface outside, by a Chebyshev series in 1/r from a_0 to the
        largest contact radius.
        """
        if not self.initial.stick_grows:
            return np.zeros(self.end.shape), np.zeros(self.end.shape)
        terms, basis = self._numbers[2], self.tilt_basis
        first, most = float(self.initial.normal.contact_radius), self.initial.largest_growth
        slope = 2 * first * (first + most) / (self.x[-1] ** 2 * most)
        return (basis * terms).sum(axis=0), slope * (basis * (_DERIVATIVE @ terms)).sum(axis=0)

    @cached_property
    def tilt_basis(self) -> Array:
        """Values of the tilt's terms at the contact's edge, (m, k)."""
        first, most = float(self.initial.normal.contact_radius), self.initial.largest_growth
        place = np.minimum(2 * self.growth * (first + most) / (self.x[-1] * most) - 1, 1.0)
        return np.asarray(np.cos(_ORDERS * np.arccos(np.maximum(place, -1.0))))

    @property
    def tilt_rates(self) -> Array:
        """Terms of dC/dw_c."""
        first, most = float(self.initial.normal.contact_radius), self.initial.largest_growth
        share = (1 + _POINTS) / 2 * most / (first + most)
        offset = self.initial.width + share * first / (1 - share) - self.stick_shift
        c = self.stick_radius
        return np.asarray(
            _TO_SERIES @ (-2 / np.pi * np.arctan2(np.sqrt(offset * (offset + 2 * c)), c))
        )

    @cached_property
    def worn(self) -> Array:
        """(sigma - S_0)/s, S_0 being sigma of the unworn shape.

        While the stick edge rests, it is the worn depth divided by s.
        """
        last = self.tilt[0] / self.end if self.initial.stick_grows else 0 * self.end
        return np.concatenate([self._numbers[0], last[None]])

    @cached_property
    def worn_omega(self) -> Array:
        """omega minus its value for the unworn shape."""
        return np.asarray(self.initial.maps.from_slip @ self.worn)

    @cached_property
    def gamma(self) -> Array:
        """g(x) - (d - D)."""
        return self.lever * (self.unworn + self.worn_omega)

    @cached_property
    def stress(self) -> Array:
        """p/E* at the nodes."""
        return np.asarray(self.initial.maps.to_pressure @ self.gamma) / self.end

    @cached_property
    def slip(self) -> Array:
        """v = sigma/s, and sigma/b in full slip."""
        v = self.initial.maps.to_slip @ self.unworn + self.worn
        if self.initial.full_slip:
            v += (self.initial.depth_unit - self.reduced_amplitude) / self.end
        return np.asarray(v)

    @cached_property
    def worn_integral(self) -> Array:
        """int_c^a (gamma - gamma_0) dx."""
        return np.asarray(self.end**2 * (self.initial.maps.mean @ self.worn_omega))

    @cached_property
    def force(self) -> Array:
        """F_N/(2 E*): F_N0(a) and a w(a) - int_c^a w dx, w = g - g_0.

        In full slip it is int (d - g) dx at the nodes: worn depths far above the elastic ones
        cancel in g_0 and w.
        """
        if self.initial.full_slip:
            mean = self.initial.maps.mean @ self.gamma
            return np.asarray(self.end * (self.gamma[-1] - mean))
        unworn = self.initial.unworn_force(self.growth)
        return np.asarray(unworn + self.x[-1] ** 2 * self.worn_omega[-1] - self.worn_integral)
