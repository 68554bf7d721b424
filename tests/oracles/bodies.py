"""True bodies that tables sample: heights, and depth, force and pressure of the contact itself.

A body is a sum of the shapes of `shapes` and of two more: everything of a contact is linear in f
(notes, §2). Heights are computed in mpmath and rounded once, so that exact points are exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from mpmath import mp, mpf

from tests.oracles.reference import QUAD_DIGITS, pressure
from tests.oracles.shapes import Monomials, Shape, TruncatedCone, shape_of

if TYPE_CHECKING:
    from collections.abc import Callable

    Array = np.ndarray

#: Digits of every value; cancellation and quadrature leave more than 20, see `test_body_proofs`.
DIGITS = 30


class Quadrature(Shape):
    """A smooth body, given by f, f' and r f'': the transforms in r = x sin t by Gauss's rule."""

    def __init__(self, f: Callable[..., mpf], df: Callable[..., mpf], bend: Callable[..., mpf]):
        super().__init__()
        self._f, self._df, self._bend = f, df, bend

    def f(self, r: mpf) -> mpf:
        return self._f(r)

    def df(self, r: mpf) -> mpf:
        return self._df(r)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return x * _quarter(lambda sine: self._df(x * sine))

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return _quarter(lambda sine: self._df(x * sine) + self._bend(x * sine))

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        return 2 * a * a * _quarter(lambda sine: sine * sine * self._df(a * sine))


def _quarter(fn: Callable[[mpf], mpf]) -> mpf:
    return mp.quad(lambda t: fn(mp.sin(t)), [0, mp.pi / 2], method="gauss-legendre")


class AreaFunction(Shape):
    """Indenter of the area function A(h) = c0 h² + c1 h + flat: a hyperboloid cut off at A = flat.

    With k = √(π/c0), w = c1/(2 c0 k) and s² = r² − b², π b² = flat: f = k (√(w² + s²) − w) and
    g = k x arctan(s/w), from f' = k r/√(w² − b² + r²).
    """

    def __init__(self, c0: float, c1: float, flat: float) -> None:
        super().__init__()
        self.k = mp.sqrt(mp.pi / c0)
        self.w = c1 / (2 * c0 * self.k)
        self.b = mp.sqrt(flat / mp.pi)
        self.blunt = self.jump = flat > 0

    def f(self, r: mpf) -> mpf:
        return self.k * (mp.hypot(self.w, self.beyond(r)) - self.w) if r > self.b else mpf(0)

    def df(self, r: mpf) -> mpf:
        return self.k * r / mp.hypot(self.w, self.beyond(r)) if r > self.b else mpf(0)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return self.k * x * mp.atan2(s, self.w)

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return self.k * (mp.atan2(s, self.w) + self.w * x * x / (s * (self.w**2 + s * s)))

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        angle = mp.atan2(s, self.w)
        return self.k * ((2 * a * a - s * s - self.w**2) * angle + self.w * s)


def _kind(kind: str, **parameters: float) -> Callable[[], tuple[Shape, ...]]:
    return lambda: (shape_of({"kind": kind, **parameters}),)


def _power(n: float) -> Callable[[], tuple[Shape, ...]]:
    return lambda: (Monomials([(mpf(1), mpf(n))]),)


def _smooth(
    f: Callable[..., mpf], df: Callable[..., mpf], bend: Callable[..., mpf]
) -> Callable[[], tuple[Shape, ...]]:
    return lambda: (Quadrature(f, df, bend),)


@dataclass(frozen=True)
class Body:
    """A body of about unit size, E* = 1.

    Parameters
    ----------
    make : returns the shapes whose sum is the body, in the current precision.
    end : last radius of its tables.
    kinks : radii where slope or curvature jumps.
    sharp : True for a slope on the axis.
    """

    make: Callable[[], tuple[Shape, ...]]
    end: float
    kinks: tuple[float, ...] = ()
    sharp: bool = False

    @property
    def parts(self) -> tuple[Shape, ...]:
        return _parts(self.make)

    def f(self, radius: Array) -> Array:
        """Heights, correctly rounded."""
        with mp.workdps(DIGITS):
            values = [
                float(mp.fsum(part.f(mpf(r)) for part in self.parts))
                for r in np.abs(np.asarray(radius, dtype=float)).ravel().tolist()
            ]
        return np.array(values).reshape(np.shape(radius))

    def df(self, radius: float) -> float:
        with mp.workdps(DIGITS):
            return float(mp.fsum(part.df(mpf(radius)) for part in self.parts))

    def depth(self, a: float) -> float:
        return float(self._sum("g", a))

    def force(self, a: float) -> float:
        return float(self._sum("force", a))

    def pressure(self, r: float, a: float) -> float:
        """p(r)/E* under a contact of radius a."""
        with mp.workdps(QUAD_DIGITS):
            return float(mp.fsum(pressure(part, mpf(r), mpf(a)) for part in self.parts))

    def radius(self, quantity: str, value: float) -> float:
        """Contact radius for a depth ("g") or a reduced force ("force")."""
        with mp.workdps(DIGITS):
            low, high = mpf(max(self.flat, 1e-9)), mpf(self.end)
            for _ in range(100):
                middle = (low + high) / 2
                below = self._sum(quantity, middle) < value
                low, high = (middle, high) if below else (low, middle)
            return float(high)

    @property
    def flat(self) -> float:
        """Radius of the flat end, zero if there is none."""
        return min(float(part.b) if part.blunt else 0.0 for part in self.parts)

    def _sum(self, quantity: str, radius: float | mpf) -> mpf:
        with mp.workdps(DIGITS):
            return mp.fsum(getattr(part, quantity)(mpf(radius)) for part in self.parts)


@cache
def _parts(make: Callable[[], tuple[Shape, ...]]) -> tuple[Shape, ...]:
    with mp.workdps(DIGITS):
        return make()


#: Kinks of the bodies below.
B, EDGE = 0.3, 0.25

SMOOTH = {
    "sphere": Body(_kind("sphere", radius=1.0), 0.7),
    "flat sphere": Body(_kind("sphere", radius=20.0), 1.0),
    "paraboloid": Body(_kind("paraboloid", radius=1.0), 1.0),
    "ellipsoid": Body(_kind("ellipsoid", radius=1.25, height=0.5), 1.0),
    "hyperboloid": Body(_kind("hyperboloid", slope=1.0, tip_radius=1.0), 0.8),
    "blunted cone": Body(_kind("hyperboloid", slope=0.3, tip_radius=0.3), 1.0),
    "tip of an area function": Body(lambda: (AreaFunction(24.5, 2.0, 0.0),), 1.0),
    "tanh^2": Body(
        _smooth(
            lambda r: mp.tanh(r) ** 2,
            lambda r: 2 * mp.tanh(r) * mp.sech(r) ** 2,
            lambda r: 2 * r * mp.sech(r) ** 2 * (1 - 3 * mp.tanh(r) ** 2),
        ),
        0.8,
    ),
    "logarithm": Body(
        _smooth(
            lambda r: mp.log1p(r * r),
            lambda r: 2 * r / (1 + r * r),
            lambda r: 2 * r * (1 - r * r) / (1 + r * r) ** 2,
        ),
        0.8,
    ),
    "gaussian": Body(
        _smooth(
            lambda r: -mp.expm1(-r * r),
            lambda r: 2 * r * mp.exp(-r * r),
            lambda r: 2 * r * (1 - 2 * r * r) * mp.exp(-r * r),
        ),
        0.7,
    ),
    "cosh": Body(
        _smooth(lambda r: 2 * mp.sinh(r / 2) ** 2, mp.sinh, lambda r: r * mp.cosh(r)), 1.0
    ),
    "cosine": Body(_smooth(lambda r: 2 * mp.sin(r / 2) ** 2, mp.sin, lambda r: r * mp.cos(r)), 1.0),
    **{f"r^{n}": Body(_power(n), 1.0) for n in (2.5, 3.0, 4.0, 6.0)},
}
SHARP = {
    "cone": Body(_kind("cone", slope=0.2), 1.0, sharp=True),
    "r^1.2": Body(_power(1.2), 1.0, sharp=True),
    "r^1.5": Body(_power(1.5), 1.0, sharp=True),
    "cone and paraboloid": Body(
        lambda: (Monomials([(mpf(0.1), mpf(1)), (mpf(0.4), mpf(2))]),), 1.0, sharp=True
    ),
}
KINKED = {
    "rounded punch": Body(_kind("rounded_punch", flat_radius=B, rounding_radius=1.0), 0.8, (B,)),
    "truncated cone": Body(_kind("truncated_cone", flat_radius=B, slope=0.2), 0.8, (B,)),
    "worn ball": Body(_kind("truncated_paraboloid", flat_radius=B, radius=1.0), 0.8, (B,)),
    "capped paraboloid": Body(
        _kind("capped_paraboloid", cap_radius=B, tip_radius=3.0, radius=1.0), 0.8, (B,)
    ),
    # The tip radius makes the tangent point EDGE.
    "rounded cone": Body(_kind("rounded_cone", slope=0.25, tip_radius=1.0), 0.8, (EDGE,)),
    "spherical tip": Body(_kind("spherical_tip_cone", slope=0.75, tip_radius=0.5), 0.8, (B,)),
    "double cone": Body(
        lambda: (Monomials([(mpf(0.1), mpf(1))]), TruncatedCone(mpf(B), mpf(0.2))),
        0.8,
        (B,),
        sharp=True,
    ),
    "worn area function": Body(lambda: (AreaFunction(24.5, 2.0, mp.pi * mpf(B) ** 2),), 0.8, (B,)),
}
BODIES = SMOOTH | SHARP | KINKED
