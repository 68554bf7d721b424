"""The singular integrals: forward and back Abel transforms, and the two-limit stress kernel.

Nothing here knows any physics. Two substitutions make every integrand analytic in the strip
|Im y| < pi/2, whatever the parameters, so that `mdr_core.quadrature` knows its error beforehand:

* two real roots, r and b (the point tested and the nearest break below):
  x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y removes both, near or far from each other;
* a real and an imaginary root, r and i h, for functions smooth at the axis: no tip to resolve.

Source: notes, §5.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from mdr_core.quadrature import (
    DEFAULT,
    Analytic,
    Integrand,
    integrate_even,
    integrate_plain,
)
from mdr_core.typing import Array, Chosen, Flags, Indices, Parameter

# weight(x, s, index) = F(x) s / x with s = sqrt(x^2 - b^2): free of the root that F carries at b.
# x and s have shape (nodes, k), index (k,) says to which integrals they belong.
Weight = Callable[[Array, Array, Chosen], Array]

# Where evenness would help no more than one integral in so many, it is not worth a call.
_FEW: Final = 8


def leg(x: Array, b: Parameter) -> Array:
    """sqrt(x^2 - b^2), zero for x < b, with the digits of x - b.

    >>> leg(np.array([0.5, 5.0]), 3.0).tolist()
    [0.0, 4.0]
    """
    return np.asarray(np.sqrt(np.maximum(x - b, 0.0) * (x + b)))


def asinh_difference(high: Array, low: Array, square_difference: Array) -> Array:
    """arcsinh(high) - arcsinh(low), given high^2 - low^2 with its digits. Source: notes, §4."""
    denominator = high * np.hypot(1.0, low) + low * np.hypot(1.0, high)
    with np.errstate(invalid="ignore"):
        ratio = square_difference / denominator
    return np.asarray(np.arcsinh(np.where(denominator > 0, ratio, 0.0)))


def one_sided(
    weight: Weight,
    b: Parameter,
    r: Array,
    upper: Array,
    *,
    width: Array | None = None,
    edge: Array | None = None,
    inner: Array | None = None,
    odd: bool,
    rtol: float,
    analytic: Analytic = DEFAULT,
) -> Array:
    """Return the integrals of F(x) / sqrt(x^2 - r^2) over x from max(r, b, c) to a.

    F is analytic for x > b in s = sqrt(x^2 - b^2); the ends are given in that coordinate,
    `upper` = sqrt(a^2 - b^2), `width` = upper - sqrt(c^2 - b^2) (None where c <= b), because
    there the digits of a narrow annulus survive.

    At r = b the integral is infinite where the weight does not vanish: F ~ 1/s there.

    Source: notes, §5 (two-root rule); mdr-5, Eqs. (5.68), (5.70).

    Parameters
    ----------
    weight : F(x) s / x, analytic in s.
    b, r : the break, b > 0, and the points, r < a, r >= 0. [length], shape (m,)
    edge, inner : a and c themselves where they are known as radii: near them, a - r and c - r
        are then exact.
    odd : F is an odd function of s, which halves the work for r < b.
    rtol : relative tolerance, 1e-3 to 1e-14.
    analytic : where F s/x is analytic in y, if not in the whole strip, and how it grows.

    Examples
    --------
    The arccosh(a/b) of Eq. (5.53), as the integral of F = x/s at the axis; b = 1, a = 2.

    >>> upper = np.array([np.sqrt(3.0)])
    >>> axis = np.zeros(1)
    >>> value = one_sided(lambda x, s, _: x / x, 1.0, axis, upper, odd=True, rtol=1e-12)
    >>> float(f"{value[0]:.6g}")
    1.31696
    """
    problem = _OneSided(weight, upper, width, edge, inner, odd, rtol, analytic)
    on_break = r == b
    if on_break.any():
        on_break &= r > 0
    if not on_break.any():
        return _two_roots(problem, b, r)
    # The few points on the break have a rule of their own; elsewhere stands in for them meanwhile.
    result = _two_roots(problem, b, np.where(on_break, np.asarray(b) / 2, r))
    index = np.flatnonzero(on_break)
    at = np.broadcast_to(b, r.shape)[index]
    result[index] = _coincident_roots(problem.picked(index, r.shape), at, r[index])
    return result


@dataclass(frozen=True)
class _OneSided:
    """What `one_sided` was asked, but for the break and the points."""

    weight: Weight
    upper: Array
    width: Array | None
    edge: Array | None
    inner: Array | None
    odd: bool
    rtol: float
    analytic: Analytic

    def picked(self, index: Indices, shape: tuple[int, ...]) -> "_OneSided":
        """The same for some of the points."""

        def pick(part: Array | None) -> Array | None:
            return None if part is None else np.broadcast_to(part, shape)[index]

        return replace(
            self,
            weight=lambda x, s, chosen: self.weight(x, s, index[chosen]),
            upper=np.broadcast_to(self.upper, shape)[index],
            width=pick(self.width),
            edge=pick(self.edge),
            inner=pick(self.inner),
        )


def _coincident_roots(problem: _OneSided, b: Parameter, r: Array) -> Array:
    """r = b: F dx/s = weight ds/s, in log(s) over an annulus, in arcsinh(s/b) from the break on.

    Infinite where F ~ 1/s and the stretch starts at b.
    """
    weight, upper = problem.weight, problem.upper
    width = upper if problem.width is None else problem.width
    result = np.empty_like(r)
    apart = width < upper
    index = np.flatnonzero(apart)
    if index.size:
        low = (upper - width)[index]

        def over_annulus(t: Array, chosen: Chosen) -> Array:
            s = np.exp(t)
            return weight(np.hypot(r[index[chosen]], s), s, index[chosen])

        length = np.log1p(width[index] / low)
        result[index] = integrate_plain(
            over_annulus, np.log(low), length, problem.rtol, problem.analytic
        )
    index = np.flatnonzero(~apart)
    if index.size:

        def from_break(y: Array, chosen: Chosen) -> Array:
            at = r[index[chosen]]
            x, s = at * np.cosh(y), at * np.sinh(y)
            return np.asarray(weight(x, s, index[chosen]) * x / s)

        length = np.arcsinh(upper[index] / r[index])
        nothing = np.zeros(index.size)
        result[index] = integrate_plain(from_break, nothing, length, problem.rtol, problem.analytic)
        pole = weight(r[None, index], nothing[None], index)[0]
        result[index[pole != 0]] = np.inf
    return result


def _two_roots(problem: _OneSided, b: Parameter, r: Array) -> Array:
    """r != b: x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y."""
    weight, upper, width, edge = problem.weight, problem.upper, problem.width, problem.edge
    rtol, analytic = problem.rtol, problem.analytic
    distance2 = np.abs(r - b) * (r + b)
    above = r > b
    shift = np.where(above, distance2, 0.0)
    base2 = np.where(above, r * r, np.square(b))
    epsilon = np.sqrt(distance2)

    def h(y: Array, index: Chosen) -> Array:
        leg = np.sinh(y)
        leg *= epsilon[index]
        leg *= leg
        x = np.sqrt(leg + base2[index])
        leg += shift[index]
        return weight(x, np.sqrt(leg, out=leg), index)

    if edge is None:
        top2 = np.maximum(upper * upper - shift, 0.0)
    else:
        top2 = np.where(above, (edge - r) * (edge + r), upper * upper)
    top = np.sqrt(top2) / epsilon
    even = problem.odd | above
    if width is None:
        return between(h, top, even, rtol, analytic=analytic)
    lower = upper - width
    if problem.inner is None:
        bottom2 = np.maximum(lower * lower - shift, 0.0)
    else:
        c = problem.inner
        bottom2 = np.where(above, np.maximum(c - r, 0.0) * (c + r), lower * lower)
    bottom = np.sqrt(bottom2) / epsilon
    square_difference = width * (upper + lower) / distance2
    return between(h, top, even, rtol, bottom, square_difference, analytic)


def between(
    h: Integrand,
    top: Array,
    even: Flags,
    rtol: float,
    bottom: Array | None = None,
    square_difference: Array | None = None,
    analytic: Analytic = DEFAULT,
) -> Array:
    """Return the integrals of h over [arcsinh(bottom), arcsinh(top)].

    h is analytic in the strip, and even where `even` says so: there an integral from zero
    takes half the nodes. `square_difference` = top^2 - bottom^2, with its digits, is needed
    with `bottom`; both are left out for integrals from zero.

    Source: notes, §5.
    """
    upper = np.arcsinh(top)
    whole = even if bottom is None else even & (bottom == 0)
    count = np.count_nonzero(whole)
    if count == whole.size:
        return integrate_even(h, upper, rtol, analytic)
    if bottom is None or square_difference is None:
        lower, length = np.zeros_like(upper), upper
    else:
        gap2 = np.where(bottom > 0, square_difference, top * top)
        lower, length = np.arcsinh(bottom), asinh_difference(top, bottom, gap2)
    if count * _FEW <= whole.size:
        return integrate_plain(h, lower, length, rtol, analytic)
    result = np.empty_like(top)
    index = np.flatnonzero(whole)
    result[index] = integrate_even(_chosen(h, index), upper[index], rtol, analytic)
    index = np.flatnonzero(~whole)
    rest = lower[index], length[index]
    result[index] = integrate_plain(_chosen(h, index), *rest, rtol, analytic)
    return result


def _chosen(h: Integrand, chosen: Indices) -> Integrand:
    """The integrand of the chosen integrals alone."""
    return lambda y, index: h(y, chosen[index])
