"""Surface displacements as integrals of g' over the contact.

Integrated by parts, both transforms have positive integrands, free of cancellation:
int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx = int_c^r g'(x) arccos(x/r) dx, and outside the contact
int_0^a (g(a) - g(x))/sqrt(r^2 - x^2) dx = int_0^a g'(x) arcsin(x/r) dx.

Source: notes, §7.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import asinh, inf, pi, sqrt
from typing import Final

import numpy as np

from mdr_core.abel.two_root import Weight
from mdr_core.doubles import LARGEST, LOG_RANGE
from mdr_core.quadrature import integrate, reach_of_power
from mdr_core.typing import Array, Indices

STEEPNESS: Final = 3.5
"""Power up to which every rule resolves g: that of flanks, caps and their sums, with room."""


@dataclass(frozen=True)
class Branch:
    """Interval base <= x <= stop on which weight(x, s) = g'(x) s/x is analytic in s.

    s = sqrt(x^2 - base^2), and the interval may begin only at `start`. At the axis g has an
    exponent of at least `tip`, and elsewhere one of up to about `steepness`. g' is infinite at
    the radius `pole` beyond `stop`, and not analytic at s = -`opposite_singularity`.
    """

    base: float
    weight: Weight
    stop: float = inf
    start: float = 0.0
    tip: float = 1.0
    steepness: float = STEEPNESS
    pole: float = inf
    opposite_singularity: float = inf

    def cuts(self, low: float, high: float, near: float, growth: float = 1.0) -> list[float]:
        """Return radii from `low` on, between which the weight is resolved up to `high`.

        Parameters
        ----------
        low, high : ends of the interval, base <= low <= high < pole [length].
        near : distance in s from s = 0 to a singularity below [length].
        growth : of s + near from one radius to the next [1].
        """
        found: list[float] = []
        ends = low, high, self.pole
        s, last, pole = (sqrt(max(x - self.base, 0.0) * (x + self.base)) for x in ends)
        while s < last:
            found.append(sqrt(self.base**2 + s * s) if found else low)
            s += min(growth * (s + near), (pole - s) / 2)
        return found


def smooth_parts(branches: Iterable[Branch], high: float) -> Iterator[Branch]:
    """Return parts of branches up to `high`, no longer than their distance from a singularity."""
    for branch in branches:
        near = branch.opposite_singularity
        if branch.base and asinh(near / branch.base) > pi / 2:
            near = inf
        start = max(branch.base, branch.start)
        cuts = branch.cuts(start, min(branch.stop, high), near) if start < high else []
        if len(cuts) == 1:
            yield branch
        else:
            for low, stop in pairwise([*cuts, branch.stop]):
                yield replace(branch, start=low, stop=stop)


# K(x, sqrt(r^2 - x^2)), by which the slope is multiplied.
Kernel = Callable[[Array, Array], Array]


def arccosine(x: Array, root: Array) -> Array:
    """Return arccos(x/r), root = sqrt(r^2 - x^2), x > 0."""
    return np.arctan(root / x)


def arccosine_growth(x: Array, root: Array) -> Array:
    """Return d arccos(x/r)/dr = x/(r sqrt(r^2 - x^2)), root = sqrt(r^2 - x^2)."""
    return np.asarray(x / (np.maximum(root, 1 / LARGEST) * np.hypot(x, root)))


def arcsine(x: Array, root: Array) -> Array:
    """Return arcsin(x/r), root = sqrt(r^2 - x^2) > 0."""
    return np.arctan(x / root)


def slope_integral(
    branches: Sequence[Branch],
    low: Array,
    high: Array,
    r: Array,
    *kernels: Kernel,
    width: Array | None = None,
    degree: float = 0.0,
) -> Array:
    """Return int_low^high g'(x) K(x, sqrt(r^2 - x^2)) dx, one row for each kernel K (k, m).

    Source: mdr-5, Eqs. (5.41), (5.75), integrated by parts; notes, §7.

    Parameters
    ----------
    branches : intervals of g', ascending.
    low, high, r : 0 <= low <= high <= r [length], shape (m,).
    kernels : K of each integral.
    width : r - low, where it has more digits than the difference; high = r [length].
    degree : power of x by which the kernels grow, where it exceeds one.
    """
    total = np.zeros((len(kernels), r.size))
    for branch in smooth_parts(branches, high.max(initial=0.0)):
        start = np.maximum(low, max(branch.base, branch.start))
        end = np.minimum(high, branch.stop)
        # An annulus may be narrower than the rounding error of its radii.
        narrow = False if width is None else (start == low) & (low < branch.stop) & (width > 0)
        index = np.flatnonzero((end > start) | narrow)
        if index.size:
            start, end, far = start[index], end[index], r[index]
            s_low, s_high, s_r = places = start, end, far
            # The square of a small radius underflows.
            if branch.base:
                s_low, s_high, s_r = (
                    np.sqrt((x - branch.base) * (x + branch.base)) for x in places
                )
            root_low, root_high = (np.sqrt((far - x) * (far + x)) for x in (start, end))
            if width is not None:
                own = np.sqrt(width * (2 * low + width))[index]
                root_low = np.where(start == low[index], own, root_low)
                from_base = (start == low[index]) & (start == branch.base)
                s_r = np.where(from_base, own, s_r)
                s_high = np.where(from_base & (end == far), own, s_high)
            ends = s_low, s_high, s_r, root_low, root_high
            total[:, index] += _branch(branch, ends, kernels, degree)
    return total


def _branch(
    branch: Branch, ends: tuple[Array, ...], kernels: Sequence[Kernel], degree: float
) -> Array:
    """Integrals in tan(alpha/2), s = s_r cos(alpha), above half of s_r, and in log(s) below it.

    The ends are s at both ends and at r, and sqrt(r^2 - x^2) at both ends.
    """
    base, (s_low, s_high, s_r, root_low, root_high) = branch.base, ends
    split = np.minimum(np.maximum(s_r / 2, s_low), s_high)
    # Relative to r, where a narrow interval is accurate.
    top = root_high / (s_high + s_r)
    root_split = np.where(split > s_low, np.sqrt((s_r - split) * (s_r + split)), root_low)
    # The roots distinguish the ends of an interval that is too narrow for s to resolve.
    upper = (split < s_high) | (split <= s_low)
    span = np.where(upper, root_split / (split + s_r) - top, 0.0)
    growth = branch.steepness + max(degree, 1.0)

    def above(y: Array, index: Indices) -> Array:
        # -y = tan(alpha/2), so that the powers rise with y.
        run = 2 / (1 + y * y)
        s, root = s_r[index] * (run - 1), s_r[index] * (-y * run)
        x = np.hypot(base, s)
        slope = branch.weight(x, s) * root * run
        return np.array([slope * kernel(x, root) for kernel in kernels])

    total = integrate(above, span, -top - span, growth=growth)
    index = np.flatnonzero(split > s_low)
    if not index.size:
        return total
    with np.errstate(divide="ignore"):
        change = np.log if base == 0 else np.arcsinh
        scale = base or 1.0
        upper, lower = (change(end[index] / scale) for end in (split, s_low))
    if base == 0:
        # Under a needle the end of the power's reach may not be representable.
        reach = np.maximum(upper - reach_of_power(branch.tip), -LOG_RANGE)
        lower = np.maximum(lower, reach)
    far = s_r[index]

    def below(y: Array, index: Indices) -> Array:
        s, run = (base * np.sinh(y), base * np.cosh(y)) if base > 0 else (np.exp(y), np.exp(y))
        x = np.hypot(base, s)
        root = np.sqrt((far[index] - s) * (far[index] + s))
        slope = branch.weight(x, s) * run
        return np.array([slope * kernel(x, root) for kernel in kernels])

    total[:, index] += integrate(below, upper - lower, lower, growth=growth)
    return total
