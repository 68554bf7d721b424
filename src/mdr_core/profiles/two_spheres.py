"""Exact gap of two spheres, or of a ball in a spherical socket."""

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.errors import InputError
from mdr_core.profiles.base import Profile
from mdr_core.profiles.spheroids import Spheroid
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import as_numbers, require_finite

# a/R of the ball beyond which a half-space in a socket is not an estimate: the contact covers 62
# to 70 degrees of the ball. Source: notes, §8.
_CONFORMING: Final = 0.85
# a/R up to which the pressure in a socket falls from the axis: in the limit of equal radii a h'(a)
# is h(a) at 5^(-1/2) = 0.447, where the sum of (2k + 2)(2k - 1) t^2k from k = 1 on is 2. Source:
# notes, §7.
_SHALLOW: Final = 0.44


@dataclass(frozen=True)
class TwoSpheres(Spheroid):
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
        "sum of radius − √(radius² − r²) over both spheres, a socket subtracted; "
        "in a socket contact radius ≤ 0.85 of the ball's radius"
    )
    closed_forms: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        path = ("profile", "radii")
        radii = as_numbers(path, self.radii)
        if radii.shape != (2,):
            raise InputError(path, "must be two numbers")
        require_finite(path, radii)
        vars(self)["radii"] = tuple(radii.tolist())
        if self.radius <= 0 or self.radius + self.other == 0:
            detail = "radii are not 0, and a ball is smaller than its socket: 1/R1 + 1/R2 > 0"
            raise InputError(path, detail)

    @property
    def radius(self) -> float:  # type: ignore[override]  # a field of the other spheroids
        """Radius of the smaller body, a ball [length]."""
        return min(self.radii, key=abs)

    @property
    def other(self) -> float:
        """Radius of the other body, negative for a socket [length]."""
        first, second = self.radii
        return second if first == self.radius else first

    @property
    def body_radii(self) -> tuple[Parameter, Parameter]:
        return self.radii

    @property
    def domain(self) -> Parameter:
        return super().domain if self.other > 0 else _CONFORMING * self.radius

    @property
    def end(self) -> tuple[str, str]:
        reason = "more than 60 degrees of the ball, where a half-space describes nothing"
        return super().end if self.other > 0 else (reason, "use a model of conforming contact")

    @property
    def scale(self) -> Parameter:
        # At the equator the load is infinite.
        return self.radius / 2

    def f(self, radius: Array) -> Array:
        root, other, both = self._roots(radius)
        bodies = (self.radius + root) * (self.other + other)
        return radius * (radius * (self.radius + self.other + both) / bodies)

    def df(self, radius: Array) -> Array:
        root, other, both = self._roots(radius)
        return radius * both / (root * other)

    def _roots(self, r: Array) -> tuple[Array, Array, Array]:
        """sqrt(R^2 - r^2) of both bodies, with the sign of R, and their sum [length]."""
        small, large = self.radius, self.other
        root, other = (np.sqrt((abs(R) - r) * (abs(R) + r)) for R in (small, large))
        if large > 0:
            return root, other, root + other
        return root, -other, (small - large) * ((small + large) / (root + other))

    def g(self, x: Array) -> Array:
        return x * self._artanh_sum(x)

    def dg(self, x: Array) -> Array:
        """artanh(x/R_1) + artanh(x/R_2) + x (R_1 + R_2)(R_1 R_2 - x^2)/prod (R_i^2 - x^2)."""
        small, large = self.radius, self.other
        inner, outer = ((R - x) * (R + x) for R in (small, large))
        # (R_1 R_2 - x^2)/inner, free of cancellation next to the equator of equal balls.
        rest = (small * (large - small) + inner) / inner
        return self._artanh_sum(x) + x * rest * ((small + large) / outer)

    def _artanh_sum(self, x: Array) -> Array:
        """artanh(x/R_1) + artanh(x/R_2) as one logarithm, free of cancellation [1]."""
        small, large = self.radius, self.other
        return 0.5 * np.log1p(2 * x * ((small + large) / ((small - x) * (large - x))))

    def reduced_force(self, coordinate: Array) -> Array:
        """2 int_0^a x g'(x) dx by parts: closed forms cancel, and g' has double poles."""
        return 2 * (coordinate * self.g(coordinate) - self._integral(self.g, coordinate))

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        return Profile.pressure_kernel(self, annulus, radius)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate <= _SHALLOW * self.radius
