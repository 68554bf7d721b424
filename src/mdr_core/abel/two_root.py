"""The two-root rule: integrals of F(x)/sqrt(x^2 - r^2) over an annulus.

F itself has a root at a break b. The substitution

    x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y

removes both roots, near or far from each other. The integrand is then analytic in the strip
|Im y| < pi/2 whatever r and b are, so that `mdr_core.quadrature` bounds its error a priori.

Source: notes, §5.
"""

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.elementwise import where
from mdr_core.quadrature import DEFAULT, Analytic, integrate
from mdr_core.typing import Array, Chosen, Flags, Indices, Parameter

# weight(x, s, index) = F(x) s/x with s = sqrt(x^2 - b^2), free of the root of F at b. x and s have
# shape (nodes, k); index (k,) selects their integrals.
Weight = Callable[[Array, Array, Chosen], Array]

_TINY: Final = float(np.finfo(float).tiny)


def inverse_hypot(x: Array, b: Parameter) -> Array:
    """Return sqrt(x^2 - b^2), zero for x < b, accurate next to b.

    >>> inverse_hypot(np.array([0.5, 5.0]), 3.0).tolist()
    [0.0, 4.0]
    """
    return np.sqrt(np.maximum(x - b, 0.0) * (x + b))


def root_difference(upper: Array, square: Array, lower: Array) -> Array:
    """Return upper - lower of two roots from `square`, the difference of their squares.

    In a narrow annulus `lower` is recomputed from the other two, which are more accurate there.
    """
    upper2 = upper * upper
    follows = np.sqrt(np.maximum(upper2 - square, 0.0))
    return square / (upper + where(square < upper2 / 2, follows, lower))


def arcsinh_difference(
    top: Array, cosh_top: Array, bottom: Array, cosh_bottom: Array, square_difference: Array
) -> Array:
    """Return arcsinh(top) - arcsinh(bottom), free of cancellation.

    Source: notes, §4.

    Parameters
    ----------
    top, bottom : top >= bottom >= 0 [1].
    cosh_top, cosh_bottom : sqrt(1 + top^2) and sqrt(1 + bottom^2) [1].
    square_difference : top^2 - bottom^2, or a larger number if bottom = 0 [1].
    """
    gap2 = np.minimum(square_difference, top * top)
    # Both ends vanish only together.
    denominator = np.maximum(top * cosh_bottom + bottom * cosh_top, _TINY)
    return np.arcsinh(np.divide(gap2, denominator, out=denominator))


def two_root_integral(
    weight: Weight,
    b: float,
    r: Array,
    annulus: Annulus,
    *,
    odd: bool,
    rtol: float,
    analytic: Analytic = DEFAULT,
) -> Array:
    """Return the integrals of F(x)/sqrt(x^2 - r^2) over x from max(r, b, c) to a.

    F is analytic for x > b in s = sqrt(x^2 - b^2). At r = b the integral is infinite where the
    weight does not vanish, because F ~ 1/s there.

    Source: notes, §5; mdr-5, Eqs. (5.68), (5.70).

    Parameters
    ----------
    weight : F(x) s/x, analytic in s.
    b, r : break b > 0 and points 0 <= r < a [length], r of shape (m,).
    annulus : a and c in the coordinate s; c <= b stands for c = b.
    odd : True if F is odd in s, which halves the nodes for r < b.
    rtol : relative tolerance, 1e-3 to 1e-14.
    analytic : strip in which the integrand is analytic in y, and its growth.

    Returns
    -------
    Array of shape (m,) [F].

    Examples
    --------
    The arccosh(a/b) of Eq. (5.53), as the integral of F = x/s at the axis; b = 1, a = 2.

    >>> annulus = Annulus(np.array([np.sqrt(3.0)]))
    >>> axis = np.zeros(1)
    >>> value = two_root_integral(lambda x, s, _: x / x, 1.0, axis, annulus, odd=True, rtol=1e-12)
    >>> float(f"{value[0]:.6g}")
    1.31696
    """
    problem = _Problem(weight, annulus, odd, rtol, analytic)
    on_break = r == b
    if np.count_nonzero(on_break):
        on_break &= r > 0
    if not np.count_nonzero(on_break):
        return _two_roots(problem, b, r)
    # Points on the break have a rule of their own; any other radius replaces them here.
    index = on_break.nonzero()[0]
    elsewhere = np.array(r)
    elsewhere[index] /= 2
    result = _two_roots(problem, b, elsewhere)
    result[index] = _coincident_roots(problem, index, r[index])
    return result


class _Problem(NamedTuple):
    """Arguments of `two_root_integral` other than the break and the points."""

    weight: Weight
    annulus: Annulus
    odd: bool
    rtol: float
    analytic: Analytic


def _two_roots(problem: _Problem, b: float, r: Array) -> Array:
    """r != b: x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y."""
    upper, inner, edge = problem.annulus
    signed2 = (b - r) * (b + r)
    above = signed2 < 0
    epsilon = np.sqrt(np.abs(signed2))
    upper2 = upper * upper
    # a^2 - r^2, from the radius where that is exact.
    edge2 = np.maximum(upper2 + signed2, 0.0) if edge is None else (edge - r) * (edge + r)
    start = None
    if inner is None:
        length = np.arcsinh(np.sqrt(np.minimum(edge2, upper2)) / epsilon)
    else:
        width, c = inner.width, np.maximum(inner.radius, b)
        inner2 = (c - r) * (c + r)
        # Next to the break the radii are accurate, in a narrow annulus its width is.
        lower = where(width > upper / 2, inverse_hypot(c, b), upper - width)
        root = np.sqrt(np.maximum(inner2, 0.0, out=inner2))
        # sinh y is the smaller root over epsilon at either end, and cosh y the larger one.
        gap2 = np.minimum(edge2, width * (upper + lower))
        roots = np.sqrt(edge2) * np.where(above & (inner2 == 0), epsilon, lower) + root * upper
        length = np.arcsinh(gap2 / np.maximum(roots, _TINY))
        start = np.arcsinh(np.minimum(root, lower) / epsilon)
    weight, shift, base2 = problem.weight, np.where(above, -signed2, 0.0), b * b

    def h(y: Array, index: Chosen) -> Array:
        # s^2 = |r^2 - b^2| cosh^2 y above the break, |r^2 - b^2| sinh^2 y below it.
        s = np.sinh(y, out=y)
        s *= epsilon[index]
        s *= s
        s += shift[index]
        x = s + base2
        return weight(np.sqrt(x, out=x), np.sqrt(s, out=s), index)

    even: Flags | bool = problem.odd or above
    return integrate(h, length, problem.rtol, start, even=even, analytic=problem.analytic)


def _coincident_roots(problem: _Problem, index: Indices, r: Array) -> Array:
    """r = b: F dx/s = weight ds/s, in log(s) over an annulus, in arcsinh(s/b) from the break.

    `index` selects these points. Infinite where F ~ 1/s and the annulus begins at b.
    """
    upper, inner, _ = problem.annulus.at(index)
    upper = np.full(r.shape, upper)
    if inner is None:
        return _from_break(problem, index, r, upper)
    width, result = np.full(r.shape, inner.width), np.empty_like(r)
    here = (width < upper).nonzero()[0]
    if here.size:
        place, at = index[here], r[here]

        def over_annulus(t: Array, chosen: Chosen) -> Array:
            s = np.exp(t)
            return problem.weight(np.hypot(at[chosen], s), s, place[chosen])

        low = (upper - width)[here]
        length = np.log1p(width[here] / low)
        result[here] = integrate(
            over_annulus, length, problem.rtol, np.log(low), even=False, analytic=problem.analytic
        )
    here = (width >= upper).nonzero()[0]
    if here.size:
        result[here] = _from_break(problem, index[here], r[here], upper[here])
    return result


def _from_break(problem: _Problem, index: Indices, r: Array, upper: Array) -> Array:
    """r = b <= x, in arcsinh(s/b)."""

    def integrand(y: Array, chosen: Chosen) -> Array:
        at = r[chosen]
        x, s = at * np.cosh(y), at * np.sinh(y)
        return problem.weight(x, s, index[chosen]) * x / s

    nothing = np.zeros(r.size)
    length = np.arcsinh(upper / r)
    pole = problem.weight(r[None], nothing[None], index)[0]
    if pole.all():
        return np.full(r.shape, np.inf)
    result = integrate(integrand, length, problem.rtol, even=False, analytic=problem.analytic)
    result[pole != 0] = np.inf
    return result
