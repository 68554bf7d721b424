"""The back transform: from the equivalent profile, or a displacement of it, to the surface."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Final

import numpy as np

from mdr_core.abel.panels import Function, find_breaks
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Flags, Indices

_LOW: Final = 16
_HIGH: Final = 24
# No tolerance below what the sums' rounding allows.
_FLOOR: Final = 1e-15
# Multiples of a break at which the first stretches are cut.
_TURNS: Final = 4.0 ** np.arange(12)
# An interval this narrow holds a jump or a needle: its share of the error is kept.
_NARROW: Final = 1e-15


@dataclass(frozen=True)
class _Stretches:
    """Stretches of angle to integrate: x^2 = base^2 + reach^2 sin^2(psi), one entry each."""

    point: Indices
    base: Array
    reach: Array
    low: Array
    high: Array

    def chosen(self, which: Flags) -> "_Stretches":
        return _Stretches(
            self.point[which],
            self.base[which],
            self.reach[which],
            self.low[which],
            self.high[which],
        )

    def halves(self) -> "_Stretches":
        middle = (self.low + self.high) / 2
        return _Stretches(
            np.tile(self.point, 2),
            np.tile(self.base, 2),
            np.tile(self.reach, 2),
            np.concatenate([self.low, middle]),
            np.concatenate([middle, self.high]),
        )

    def integrals(self, g: Function, points: int) -> Array:
        """int g(x) (s/x) dpsi, s = reach sin(psi), of every stretch by one rule."""
        nodes, weights = gauss_legendre(points)
        half = (self.high - self.low)[:, None] / 2
        s = self.reach[:, None] * np.sin(self.low[:, None] + half * (1 + nodes))
        x = np.hypot(self.base[:, None], s)
        values = g(x.ravel()).reshape(x.shape) * s / np.where(x > 0, x, 1.0)
        return np.asarray((values * weights * half).sum(axis=1))


def back(
    g: Function,
    r: Array,
    breaks: Sequence[float] | None = None,
    *,
    upper: float = inf,
    rtol: float = 1e-12,
) -> tuple[Array, float]:
    """Return f(r) = (2/pi) int_0^min(r,upper) g(x)/sqrt(r^2 - x^2) dx, and its error bound.

    With g the equivalent profile this is the profile; with g = d - g_0 up to `upper` = a it is
    the surface displacement outside the contact. Behind each break b, s = sqrt(x^2 - b^2) takes
    out the root that g carries there, s = sqrt(r^2 - b^2) sin(psi) the one at r.

    Source: mdr-5, Eqs. (5.41), (5.75).

    Parameters
    ----------
    g : vectorised, piecewise smooth in x.
    r : radii, > 0, shape (m,) [length]. At r = 0 the value is g(0).
    breaks : where g is not smooth [length]; None to have the places found.
    rtol : relative accuracy asked for.

    Returns
    -------
    f(r), shape (m,), and a bound on its error relative to (2/pi) int |g|/sqrt(r^2 - x^2) dx: the
    summed differences of two rules, of which the better one's value is given.

    Examples
    --------
    Eq. (5.75) takes g = x^2/R back to the paraboloid f = r^2/(2R), here R = 2.

    >>> f, error = back(lambda x: x**2 / 2.0, np.array([1.0, 2.0]))
    >>> [float(f"{value:.6g}") for value in f]
    [0.25, 1.0]
    """
    end = float(min(upper, r.max(initial=0.0)))
    if breaks is None:
        breaks = find_breaks(g, end) if end > 0 else ()
    waiting = _first_stretches(r, sorted({0.0, *map(float, breaks)}), upper)
    total, error = np.zeros_like(r), np.zeros_like(r)
    size = np.bincount(waiting.point, weights=np.abs(waiting.integrals(g, _HIGH)), minlength=r.size)
    while waiting.point.size:
        better = waiting.integrals(g, _HIGH)
        doubt = np.abs(better - waiting.integrals(g, _LOW))
        allowed = max(rtol / 4, _FLOOR) * size[waiting.point]
        narrow = waiting.high - waiting.low < _NARROW
        good = (doubt <= allowed) | narrow
        kept = waiting.point[good]
        total += np.bincount(kept, weights=better[good], minlength=r.size)
        error += np.bincount(kept, weights=doubt[good], minlength=r.size)
        waiting = waiting.chosen(~good).halves()
    on_axis = r == 0
    if on_axis.any():
        total[on_axis] = np.pi / 2 * g(np.zeros(1))[0]
    relative = float((error / np.where(size > 0, size, 1.0)).max(initial=0.0))
    return 2 / np.pi * total, relative + _FLOOR


def _first_stretches(r: Array, bases: list[float], upper: float) -> _Stretches:
    """Stretches for each point and each smooth piece of g below it.

    Behind a break far below the point, x = sqrt(base^2 + s^2) turns at s = base: the stretch is
    cut there and at multiples, or both rules would overlook it alike.
    """
    parts = []
    for base, stop in zip(bases, [*bases[1:], inf], strict=True):
        end = np.minimum(r, min(stop, upper))
        point = np.flatnonzero(end > base)
        far, end = r[point], end[point]
        reach = np.sqrt((far - base) * (far + base))
        high = np.arctan2(np.sqrt((end - base) * (end + base)), np.sqrt((far - end) * (far + end)))
        low = np.zeros_like(far)
        for turn in base * _TURNS if base > 0 else ():
            cut = np.clip(np.arcsin(np.minimum(turn / reach, 1.0)), low, high)
            some = cut > low
            parts.append(_Stretches(point, np.full_like(far, base), reach, low, cut).chosen(some))
            low = cut
        rest = _Stretches(point, np.full_like(far, base), reach, low, high)
        parts.append(rest.chosen(high > low))
    return _Stretches(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("point", "base", "reach", "low", "high")
        )
    )
