"""Exact transforms of a table's interpolant.

A table represents its interpolant, a piecewise cubic polynomial with double coefficients, which are
taken as exact rationals. They come from scipy: per segment between declared breaks,
``CubicSpline(bc_type="not-a-knot")`` (two points: a line; three: the parabola through them, as in
scipy), ``PchipInterpolator``, or straight lines.

With f' = sum_j H(r - x_j) (A_j + B_j r + C_j r^2) over the knots x_j, every transform is a sum of
the elementary moments I_k = int_{x_j}^x r^k/sqrt(x^2 - r^2) dr.
"""

from __future__ import annotations

import bisect
import functools
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp, mpf
from scipy.interpolate import CubicSpline, PchipInterpolator

from tests.oracles.reference import solve_increasing

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

#: Digits: the sums over knots lose about fifteen by cancellation.
TABLE_DIGITS = 64
#: Gauss-Legendre rule and longest subpanel: the nearest singularity is at a distance of pi/2.
POINTS = 30
PIECE = mpf("1.8")

Row = tuple[mpf, mpf, mpf, mpf]


def segments(profile: Mapping[str, Any]) -> Iterator[slice]:
    """Index ranges between declared breaks, both ends included."""
    r = list(profile["r"])
    ends = [0, *(r.index(b) for b in profile.get("breaks", ())), len(r) - 1]
    for low, high in itertools.pairwise(ends):
        yield slice(low, high + 1)


def _chords(r: np.ndarray, f: np.ndarray) -> list[Row]:
    return [
        (mpf(0), mpf(0), (mpf(f1) - mpf(f0)) / (mpf(r1) - mpf(r0)), mpf(f0))
        for (r0, f0), (r1, f1) in itertools.pairwise(zip(r.tolist(), f.tolist(), strict=True))
    ]


def local_coefficients(profile: Mapping[str, Any]) -> list[Row]:
    """Coefficients of u^3, u^2, u, 1 on each panel, u = r - (its left end)."""
    r, f = np.array(profile["r"]), np.array(profile["f"])
    rows: list[Row] = []
    for part in segments(profile):
        if profile["interpolation"] == "linear":
            rows += _chords(r[part], f[part])
            continue
        if profile["interpolation"] == "pchip":
            piece = PchipInterpolator(r[part], f[part])
        else:
            piece = CubicSpline(r[part], f[part], bc_type="not-a-knot")
        rows += [tuple(map(mpf, column)) for column in piece.c.T.tolist()]
    return rows


class Table:
    """The interpolant and its transforms, at the ``mp.dps`` of its construction."""

    def __init__(self, profile: Mapping[str, Any]) -> None:
        self.knots = [mpf(r) for r in profile["r"]]
        self.local = local_coefficients(profile)
        slopes = [
            (p - 2 * q * x + 3 * c * x**2, 2 * q - 6 * c * x, 3 * c)
            for x, (c, q, p, _) in zip(self.knots, self.local, strict=False)
        ]
        zero = (mpf(0), mpf(0), mpf(0))
        self.jumps = [
            tuple(new - old for new, old in zip(right, left, strict=True))
            for left, right in itertools.pairwise([zero, *slopes])
        ]
        self.kinks = [
            a + b * x + c * x**2 for x, (a, b, c) in zip(self.knots, self.jumps, strict=False)
        ]
        self.rule = _legendre(POINTS, mp.dps)
        self._slopes: dict[tuple[int, mpf], list[tuple[mpf, mpf, mpf]]] = {}

    def panel(self, x: mpf) -> int:
        """Number of the panel with knot_i < x <= knot_{i+1}."""
        return max(bisect.bisect_left(self.knots, x) - 1, 0)

    def f(self, r: mpf) -> mpf:
        i = self.panel(r)
        return mp.polyval(list(self.local[i])[::-1], r - self.knots[i], asc=True)

    def df(self, r: mpf) -> mpf:
        i = self.panel(r)
        c, q, p, _ = self.local[i]
        return mp.polyval([p, 2 * q, 3 * c], r - self.knots[i], asc=True)

    def _angles(self, x: mpf, own: mpf | None) -> tuple[list[mpf], list[mpf]]:
        """sqrt(x^2 - x_j^2) and arccos(x_j/x) of the knots below x; `own` is the last root."""
        below = self.knots[: self.panel(x) + 1]
        roots = [mp.sqrt((x - k) * (x + k)) for k in below]
        if own is not None:
            roots[-1] = own
        return roots, [mp.atan2(s, k) for s, k in zip(roots, below, strict=True)]

    def g(self, x: mpf) -> mpf:
        roots, angles = self._angles(x, None)
        total = mpf(0)
        for k, s, phi, (a, b, c) in zip(self.knots, roots, angles, self.jumps, strict=False):
            total += a * phi + b * s + c * (x**2 * phi + k * s) / 2
        return x * total

    def dg(self, x: mpf, own: mpf | None = None) -> mpf:
        """Sum of the moments of f' + r f'', and a root for each slope discontinuity."""
        roots, angles = self._angles(x, own)
        total = mpf(0)
        rows = zip(self.knots, roots, angles, self.jumps, self.kinks, strict=False)
        for k, s, phi, (a, b, c), kink in rows:
            total += (a + 3 * c * x**2 / 2) * phi + (2 * b + 3 * c * k / 2) * s
            if k:
                total += kink * k / s
        return total

    def force(self, a: mpf) -> mpf:
        """N = 2 int_0^a r^2 f'/sqrt(a^2 - r^2) dr."""
        roots, angles = self._angles(a, None)
        total = mpf(0)
        for k, s, phi, (c0, c1, c2) in zip(self.knots, roots, angles, self.jumps, strict=False):
            second = (a**2 * phi + k * s) / 2
            third = s * (2 * a**2 + k**2) / 3
            fourth = (k**3 * s + 3 * a**2 * second) / 4
            total += c0 * second + c1 * third + c2 * fourth
        return 2 * total

    def contact_radius(self, control: str, reduced: mpf) -> mpf:
        """Radius for a prescribed depth, F_N/E* or radius."""
        if control == "contact_radius":
            return reduced
        fn = self.g if control == "indentation_depth" else self.force
        # First radius of contact: beyond a flat, where g and N are zero.
        flat = next(k for k, jump in zip(self.knots, self.jumps, strict=False) if any(jump))
        width = self.knots[-1] - flat

        def radius_of(w: mpf) -> mpf:
            return flat + width / (1 + mp.exp(-w))

        return radius_of(solve_increasing(lambda w: fn(radius_of(w)), reduced, mpf(0)))

    def pieces(self, low: mpf, high: mpf, fn: Callable[[mpf], mpf]) -> mpf:
        """Gauss-Legendre integral over subpanels no longer than `PIECE`."""
        count = int(mp.ceil((high - low) / PIECE)) or 1
        step = (high - low) / count
        return mp.fsum(
            w * step * fn(low + step * (i + u)) for i in range(count) for u, w in self.rule
        )

    def _panels(self, low: mpf, high: mpf) -> Iterator[tuple[int, mpf]]:
        """Panels between two radii, with s = sqrt(x^2 - x_i^2) at each panel's end."""
        for i in range(self.panel(low), self.panel(high) + 1):
            end = min(self.knots[i + 1], high)
            if end > max(low, self.knots[i]):
                yield i, mp.sqrt((end - self.knots[i]) * (end + self.knots[i]))

    def _sampled(self, i: int, top: mpf) -> list[tuple[mpf, mpf, mpf]]:
        """(s, weight, dg/ds) on a panel; independent of r if r is far below it."""
        key = (i, top)
        if key not in self._slopes:
            # Distance of the preceding knot's root from the panel's left end.
            near = mp.sqrt(self.knots[i] ** 2 - self.knots[i - 1] ** 2) if i else top
            ends = [top]
            while ends[-1] > 2 * near:
                ends.append(ends[-1] / 4)
            self._slopes[key] = [
                (low + (high - low) * u, (high - low) * w, self._slope(i, low + (high - low) * u))
                for high, low in itertools.pairwise([*ends, mpf(0)])
                for u, w in self.rule
            ]
        return self._slopes[key]

    def _slope(self, i: int, s: mpf) -> mpf:
        x = mp.sqrt(self.knots[i] ** 2 + s**2)
        return self.dg(x, s) * s / x

    def pressure(self, r: mpf, a: mpf) -> mpf:
        """p/E* at 0 < r < a, r not at a knot: the substitution of ``reference`` on every panel."""
        total = mpf(0)
        home = self.panel(r)
        for i, top in self._panels(r, a):
            square = (r - self.knots[i]) * (r + self.knots[i])
            k = mp.sqrt(abs(square))
            if i > home + 2:
                total += mp.fsum(w * y / mp.hypot(s, k) for s, w, y in self._sampled(i, top))
            else:
                root, inverse = (mp.cosh, mp.acosh) if square > 0 else (mp.sinh, mp.asinh)
                total += self.pieces(
                    mpf(0),
                    inverse(top / k),
                    lambda y, i=i, k=k, root=root: self._slope(i, k * root(y)),
                )
        return total / mp.pi

    def energy(self, a: mpf) -> mpf:
        """U/E* = int_0^a (d - g)^2 dx, panel by panel in s."""
        d = self.g(a)
        total = mpf(0)
        for i, top in self._panels(mpf(0), a):
            for u, w in self.rule:
                s = top * u
                x = mp.sqrt(self.knots[i] ** 2 + s**2)
                total += top * w * (d - self.g(x)) ** 2 * s / x
        return total


@functools.cache
def _legendre(count: int, digits: int) -> list[tuple[mpf, mpf]]:
    """Gauss-Legendre nodes and weights on [0, 1], by Newton's method starting from numpy's."""
    rule = []
    for start in np.polynomial.legendre.leggauss(count)[0].tolist():
        x = mpf(start)
        for _ in range(4):
            previous, value = mpf(1), x
            for n in range(2, count + 1):
                previous, value = value, ((2 * n - 1) * x * value - (n - 1) * previous) / n
            slope = count * (x * value - previous) / (x**2 - 1)
            x -= value / slope
        rule.append(((1 + x) / 2, 1 / ((1 - x**2) * slope**2)))
    return rule
