"""The singular integrals: forward and back Abel transforms, and the two-limit stress kernel.

Nothing here knows any physics. Two substitutions make every integrand analytic in the strip
|Im y| < pi/2, whatever the parameters, so that `mdr_core.quadrature` knows its error beforehand:

* two real roots, r and b (the point tested and the nearest break below):
  x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y removes both, near or far from each other;
* a real and an imaginary root, r and i h, for functions smooth at the axis: no tip to resolve.

Source: notes, §5.
"""

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.polynomial import Inner, StressPolynomial
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

# Evenness of no more integrals than these is not worth a call.
_FEW: Final = 400
_TINY: Final = float(np.finfo(float).tiny)


def leg(x: Array, b: Parameter) -> Array:
    """sqrt(x^2 - b^2), zero for x < b, with the digits of x - b.

    >>> leg(np.array([0.5, 5.0]), 3.0).tolist()
    [0.0, 4.0]
    """
    return np.asarray(np.sqrt(np.maximum(x - b, 0.0) * (x + b)))


def leg_step(upper: Array, square: Array, lower: Array) -> Array:
    """upper - lower of two legs, from the difference of their squares.

    Of a narrow annulus `lower` follows from the other two, whose digits it need not have.
    """
    upper2 = upper * upper
    follows = np.sqrt(np.maximum(upper2 - square, 0.0))
    return np.asarray(square / (upper + np.where(square < upper2 / 2, follows, lower)))


def arc(
    top: Array, cosh_top: Array, bottom: Array, cosh_bottom: Array, square_difference: Array
) -> tuple[Array, Array]:
    """arcsinh(bottom) and arcsinh(top) - arcsinh(bottom), with the digits of a short arc.

    The cosines of both ends are known to whoever asks, and top^2 - bottom^2 with its digits; it
    may be larger where bottom = 0. Source: notes, §4.
    """
    gap2 = np.minimum(square_difference, top * top)
    # Both ends are zero together only.
    denominator = np.maximum(top * cosh_bottom + bottom * cosh_top, _TINY)
    return np.arcsinh(bottom), np.arcsinh(np.divide(gap2, denominator, out=denominator))


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
    polynomial: tuple[StressPolynomial, float] | None = None,
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
    polynomial : what stands for F s/x to the tolerance, and its unit of s^2 [length^2].

    Examples
    --------
    The arccosh(a/b) of Eq. (5.53), as the integral of F = x/s at the axis; b = 1, a = 2.

    >>> upper = np.array([np.sqrt(3.0)])
    >>> axis = np.zeros(1)
    >>> value = one_sided(lambda x, s, _: x / x, 1.0, axis, upper, odd=True, rtol=1e-12)
    >>> float(f"{value[0]:.6g}")
    1.31696
    """
    problem = _OneSided(weight, upper, width, edge, inner, odd, rtol, analytic, polynomial)
    on_break = r == b
    if np.count_nonzero(on_break):
        on_break &= r > 0
    if not np.count_nonzero(on_break):
        return _two_roots(problem, b, r)
    # The few points on the break have a rule of their own; elsewhere stands in for them meanwhile.
    index = on_break.nonzero()[0]
    elsewhere = np.array(r)
    elsewhere[index] /= 2
    result = _two_roots(problem, b, elsewhere)
    result[index] = _coincident_roots(problem, index, r[index])
    return result


class _OneSided(NamedTuple):
    """What `one_sided` was asked, but for the break and the points."""

    weight: Weight
    upper: Array
    width: Array | None
    edge: Array | None
    inner: Array | None
    odd: bool
    rtol: float
    analytic: Analytic
    polynomial: tuple[StressPolynomial, float] | None


def _coincident_roots(problem: _OneSided, index: Indices, r: Array) -> Array:
    """r = b: F dx/s = weight ds/s, in log(s) over an annulus, in arcsinh(s/b) from the break on.

    `index` says which of all points these are. Infinite where F ~ 1/s and the stretch starts at b.
    """
    upper = _picked(problem.upper, index)
    if problem.width is None:
        return _from_break(problem, index, r, upper)
    result = np.empty_like(r)
    width = np.broadcast_to(_picked(problem.width, index), r.shape)
    upper = np.broadcast_to(upper, r.shape)
    apart = width < upper
    here = apart.nonzero()[0]
    if here.size:
        place, at = index[here], r[here]

        def over_annulus(t: Array, chosen: Chosen) -> Array:
            s = np.exp(t)
            return problem.weight(np.hypot(at[chosen], s), s, place[chosen])

        low = (upper - width)[here]
        length = np.log1p(width[here] / low)
        result[here] = integrate_plain(
            over_annulus, np.log(low), length, problem.rtol, problem.analytic
        )
    here = (~apart).nonzero()[0]
    if here.size:
        result[here] = _from_break(problem, index[here], r[here], upper[here])
    return result


def _from_break(problem: _OneSided, index: Indices, r: Array, upper: Array) -> Array:
    """r = b <= x, in arcsinh(s/b)."""

    def integrand(y: Array, chosen: Chosen) -> Array:
        at = r[chosen]
        x, s = at * np.cosh(y), at * np.sinh(y)
        return np.asarray(problem.weight(x, s, index[chosen]) * x / s)

    nothing = np.zeros(r.size)
    result = integrate_plain(
        integrand, nothing, np.arcsinh(upper / r), problem.rtol, problem.analytic
    )
    pole = problem.weight(r[None], nothing[None], index)[0]
    result[pole != 0] = np.inf
    return result


def _picked(part: Array, index: Indices) -> Array:
    return part if part.size == 1 else part[index]


class _Stretch(NamedTuple):
    """The stretch of x that each point sees, from max(r, b, c) to a; `lower` is None for c <= b."""

    signed2: Array
    """b^2 - r^2."""
    epsilon: Array
    """|b^2 - r^2|^(1/2)."""
    above: Flags
    """r > b."""
    edge2: Array
    """a^2 - r^2."""
    lower: Array | None
    """sqrt(c^2 - b^2)."""
    root: Array | None
    """sqrt(c^2 - r^2), zero for c < r."""
    gap2: Array
    """a^2 less the largest of b^2, c^2 and r^2."""
    length: Array
    """Its length in y."""


def _stretch(problem: _OneSided, b: Parameter, r: Array) -> _Stretch:
    upper, width, edge = problem.upper, problem.width, problem.edge
    signed2 = (b - r) * (b + r)
    above = signed2 < 0
    epsilon = np.sqrt(np.abs(signed2))
    upper2 = upper * upper
    # a^2 - r^2, and c^2 - r^2 below: above the break they are the lesser legs, as r is than b.
    edge2 = np.maximum(upper2 + signed2, 0.0) if edge is None else (edge - r) * (edge + r)
    if width is None:
        gap2 = np.minimum(edge2, upper2)
        length = np.arcsinh(np.sqrt(gap2) / epsilon)
        return _Stretch(signed2, epsilon, above, edge2, None, None, gap2, length)
    lower = upper - width
    if problem.inner is None:
        inner2 = lower * lower + signed2
    else:
        c = np.maximum(problem.inner, b)
        inner2 = (c - r) * (c + r)
        # Next to the break the radii have the digits, in a narrow annulus its width.
        lower = np.where(width > upper / 2, leg(c, b), lower)
    root = np.sqrt(np.maximum(inner2, 0.0, out=inner2))
    # a^2 less the larger of c^2 and r^2, and its arc: the cosines are the other legs.
    on_root = above & (inner2 == 0)
    gap2 = np.minimum(edge2, width * (upper + lower))
    legs = np.sqrt(edge2) * np.where(on_root, epsilon, lower) + root * upper
    length = np.arcsinh(gap2 / np.maximum(legs, _TINY))
    return _Stretch(signed2, epsilon, above, edge2, lower, root, gap2, length)


def _two_roots(problem: _OneSided, b: Parameter, r: Array) -> Array:
    """r != b: x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y."""
    weight, seen = problem.weight, _stretch(problem, b, r)
    if problem.polynomial is not None:
        return _closed(problem, *problem.polynomial, seen)
    epsilon, above = seen.epsilon, seen.above
    shift = np.abs(seen.signed2) * above
    base2 = np.asarray(b * b)
    each = base2.size > 1

    def h(y: Array, index: Chosen) -> Array:
        # s^2 = |r^2 - b^2| (sinh^2 y + 1) above the break, without the 1 below it.
        s = np.sinh(y, out=y)
        s *= epsilon[index]
        s *= s
        s += shift[index]
        x = s + (base2[index] if each else base2)
        return weight(np.sqrt(x, out=x), np.sqrt(s, out=s), index)

    even: Flags | bool = problem.odd or above
    start = None
    if seen.lower is not None and seen.root is not None:
        start = np.arcsinh(np.minimum(seen.root, seen.lower) / epsilon)
    return between(h, seen.length, problem.rtol, start, even=even, analytic=problem.analytic)


def _closed(problem: _OneSided, polynomial: StressPolynomial, unit: float, seen: _Stretch) -> Array:
    """The weight as a polynomial: what s e grows by, and the arc, carry all of the integral."""
    upper, lower, root = problem.upper, seen.lower, seen.root
    upper2 = (upper * upper).item()
    delta = seen.signed2 / unit
    step = np.sqrt(seen.edge2)
    step *= upper
    inner = None
    if problem.width is not None and lower is not None and root is not None:
        leg = root * lower
        gap2 = (problem.width * (upper + lower)).item()
        inner = Inner(leg / unit, (lower * lower).item() / unit, gap2 / unit)
        # The difference of s e at the two ends, with the digits of a narrow annulus.
        step += leg
        np.divide(root * root + upper2, np.maximum(step, _TINY, out=step), out=step)
        step *= seen.gap2
    step /= unit
    return polynomial.between(delta, step, upper2 / unit, seen.length, inner)


def between(
    h: Integrand,
    length: Array,
    rtol: float,
    lower: Array | None = None,
    *,
    even: Flags | bool = True,
    analytic: Analytic = DEFAULT,
) -> Array:
    """Return the integrals of h over [lower, lower + length]; from zero where no `lower` is given.

    h is analytic in the strip, and even where `even` says so: there an integral from zero
    takes half the nodes.

    Source: notes, §5.
    """
    whole = even if lower is None else even & (lower == 0)
    if whole is True:
        return integrate_even(h, length, rtol, analytic)
    count = np.count_nonzero(whole)
    if count == length.size:
        return integrate_even(h, length, rtol, analytic)
    if lower is None:
        lower = np.zeros_like(length)
    if count <= _FEW:
        return integrate_plain(h, lower, length, rtol, analytic)
    result = np.empty_like(length)
    index = np.flatnonzero(whole)
    result[index] = integrate_even(_chosen(h, index), length[index], rtol, analytic)
    index = np.flatnonzero(~whole)
    rest = lower[index], length[index]
    result[index] = integrate_plain(_chosen(h, index), *rest, rtol, analytic)
    return result


def _chosen(h: Integrand, chosen: Indices) -> Integrand:
    """The integrand of the chosen integrals alone."""
    return lambda y, index: h(y, chosen[index])
