"""Exact gap of two spheres, or of a ball in a spherical socket."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.doubles import EPS
from mdr_core.errors import InputError
from mdr_core.profiles.base import Profile
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.profiles.spheroids import END, SHALLOW
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import require_finite, single

# a/R of the ball beyond which its half-space in a socket is no estimate: the contact covers 62 to
# 70 degrees of the ball. Source: notes, §8.
_CONFORMING: Final = 0.85
# a/R up to which the pressure in a socket falls from the axis, as in `SHALLOW`: for equal radii a
# h'(a) is h(a) at 0.4448, the root of the sum of (2k + 2)(2k - 1) t^2k from k = 1 on less 2.
_SHALLOW_SOCKET: Final = 0.44


@dataclass(frozen=True)
class TwoSpheres(Profile):
    """Gap of two spheres, f = sum R_i - sqrt(R_i^2 - r^2), where R < 0 is the radius of a socket.

    g(x) = x artanh(x/R_1) + x artanh(x/R_2). A contact in a socket is rejected beyond 0.85 of the
    radius of the ball. Source: notes, §2 and §8.

    Parameters
    ----------
    radii : R_1 of the first body and R_2 of the second one [length], 1/R_1 + 1/R_2 > 0.

    Raises
    ------
    InputError : not two finite numbers, zero, or a ball that is not smaller than its socket.
    """

    radii: tuple[float, float]

    kind: ClassVar[str] = "two_spheres"
    formula: ClassVar[str] = (
        "Σ sign(Rᵢ)·(|Rᵢ| − √(Rᵢ² − r²)), R < 0 for a socket, contact radius < |Rᵢ|, "
        "in a socket at most 0.85 R of the ball"
    )
    closed_forms: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        path = ("profile", "radii")
        if not isinstance(self.radii, (tuple, list)) or len(self.radii) != 2:
            raise InputError(path, "must be two numbers")
        radii = tuple(single((*path, i), radius) for i, radius in enumerate(self.radii))
        require_finite(path, np.array(radii))
        vars(self)["radii"] = radii
        small, large = self._by_size
        if small <= 0 or small + large == 0:
            detail = "radii are not 0, and a ball is smaller than its socket: 1/R1 + 1/R2 > 0"
            raise InputError(path, detail)

    @cached_property
    def _by_size(self) -> tuple[float, float]:
        """Radius of the smaller body, a ball, and of the other one, negative for a socket."""
        small, large = sorted(self.radii, key=abs)
        return small, large

    @property
    def is_socket(self) -> bool:
        """True if the larger body is a socket."""
        return self._by_size[1] < 0

    @property
    def body_radii(self) -> tuple[Parameter, Parameter]:
        return self.radii

    @property
    def domain(self) -> Parameter:
        return self.pole * (_CONFORMING if self.is_socket else END)

    @property
    def end(self) -> tuple[str, str]:
        reason = "more than 60 degrees of the ball, where a half-space describes nothing"
        return (reason, "use a model of a conforming_contact") if self.is_socket else super().end

    @property
    def scale(self) -> Parameter:
        # At the radius itself the load is infinite.
        return self.pole / 2

    @property
    def pole(self) -> float:
        return self._by_size[0]

    @property
    def steepens(self) -> bool:
        return True

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (Branch(0.0, lambda x, _: self.dg(x), pole=self.pole),)

    def rounding_at(self, coordinate: Array) -> Parameter:
        """Next to the equator that of R - a. See `Profile`."""
        return self.rounding + EPS / 2 * self.pole / (self.pole - coordinate)

    def f(self, radius: Array) -> Array:
        small, large = self._by_size
        root, other, both = self._roots(radius)
        return radius * (radius * (small + large + both) / ((small + root) * (large + other)))

    def df(self, radius: Array) -> Array:
        root, other, both = self._roots(radius)
        return radius * both / (root * other)

    def _roots(self, r: Array) -> tuple[Array, Array, Array]:
        """sqrt(R^2 - r^2) of both bodies, with the sign of R, and their sum [length]."""
        small, large = self._by_size
        root, other = (np.sqrt((abs(R) - r) * (abs(R) + r)) for R in (small, large))
        if self.is_socket:
            return root, -other, (small - large) * ((small + large) / (root + other))
        return root, other, root + other

    def g(self, x: Array) -> Array:
        """x artanh(x/R_1) + x artanh(x/R_2), as one logarithm. See `Profile`."""
        small, large = self._by_size
        return 0.5 * x * np.log1p(2 * x * ((small + large) / ((small - x) * (large - x))))

    def dg(self, x: Array) -> Array:
        """artanh(x/R_1) + artanh(x/R_2) + x (R_1 + R_2)(R_1 R_2 - x^2)/prod (R_i^2 - x^2)."""
        small, large = self._by_size
        inner, outer = ((R - x) * (R + x) for R in (small, large))
        # R_1 R_2 - x^2, free of cancellation next to the equator of equal balls.
        rest = (small * (large - small) + inner) / inner
        logarithm = np.log1p(2 * x * ((small + large) / ((small - x) * (large - x))))
        return 0.5 * logarithm + x * rest * ((small + large) / outer)

    def reduced_force(self, coordinate: Array) -> Array:
        """2 int_0^a x g'(x) dx, because closed forms cancel in a socket. See `Profile`."""
        return self._integral(lambda x: 2 * x * self.dg(x), coordinate)

    def reduced_energy(self, coordinate: Array) -> Array:
        depth = self.depth(coordinate)
        return self._integral(lambda x: np.square(depth - self.g(x)), coordinate)

    def axis_stress(self, coordinate: Array) -> Array:
        return self._integral(lambda x: self.dg(x) / x, coordinate) / np.pi

    def _integral(self, density: Callable[[Array], Array], coordinate: Array) -> Array:
        """int_0^a density(x) dx over v = artanh(x/R), which resolves the pole at the equator."""
        v = 0.5 * np.log1p(2 * coordinate / (self.pole - coordinate))

        def over_v(v: Array) -> Array:
            return density(self.pole * np.tanh(v)) * (self.pole / np.square(np.cosh(v)))

        return power_law_integral(over_v, v, 1.0)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate <= (_SHALLOW_SOCKET if self.is_socket else SHALLOW) * self.pole
