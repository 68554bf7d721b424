"""The two-root rule: integrals of F(x)/sqrt(x^2 - r^2) over an annulus.

F itself has a root at a break b. The substitution

    x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y

removes both roots, near or far from each other. The integrand is then analytic in the strip
|Im y| < pi/2 whatever r and b are, so that pieces of equal length serve all integrals.

Source: notes, §5.
"""

from collections.abc import Callable

import numpy as np

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.doubles import TINY
from mdr_core.elementwise import some, where
from mdr_core.quadrature import STEEP, integrate
from mdr_core.typing import Array, Indices

# weight(x, s) = F(x) s/x with s = sqrt(x^2 - b^2), free of the root of F at b.
Weight = Callable[[Array, Array], Array]


def two_root_integral(
    weight: Weight,
    b: float,
    r: Array,
    annulus: Annulus,
    *,
    growth: float = STEEP,
    beyond: Array | None = None,
) -> Array:
    """Return the integrals of F(x)/sqrt(x^2 - r^2) over x from max(r, b, c) to a.

    F is analytic for x > b in s = sqrt(x^2 - b^2). At r = b the integral is infinite where the
    weight does not vanish, because F ~ 1/s there.

    Source: notes, §5; mdr-5, Eqs. (5.68), (5.70).

    Parameters
    ----------
    weight : F(x) s/x, analytic in s.
    b, r : break b >= 0 and points 0 <= r < a [length], r of shape (m,).
    annulus : a and c in the coordinate s; c <= b stands for c = b.
    growth : of the integrand, see `integrate`.
    beyond : sqrt(r^2 - b^2), if all radii lie beyond the break and it has more digits [length].

    Returns
    -------
    Array of shape (m,) [F].

    Examples
    --------
    The arccosh(a/b) of Eq. (5.53), as the integral of F = x/s at the axis; b = 1, a = 2.

    >>> top = np.array([np.sqrt(3.0)])
    >>> annulus = Annulus(top, top, np.zeros(1))
    >>> axis = np.zeros(1)
    >>> value = two_root_integral(lambda x, s: x / x, 1.0, axis, annulus)
    >>> float(f"{value[0]:.6g}")
    1.31696
    """
    upper, width, c, edge, coordinate = annulus
    break2, on_break = (b - r) * (b + r), r == b
    # a^2 - r^2, from the radius where that is exact.
    outer2 = np.maximum(upper * upper + break2, 0.0) if edge is None else (edge - r) * (edge + r)
    begin = np.maximum(c, b)
    wide = inverse_hypot(begin, b) if coordinate is None else coordinate
    lower = where(width > upper / 2, wide, upper - width)
    # sqrt(c^2 - r^2), zero for r >= c.
    root = inverse_hypot(begin, r)
    if beyond is not None:
        break2, on_break = -beyond * beyond, beyond == 0
        outer2 = (upper - beyond) * (upper + beyond)
        root = inverse_hypot(lower, beyond)
    if some(on_break):
        # Points on the break take the rule of one just above it, by the rounding error of b^2 and
        # of the least s^2 of the annulus.
        above = 1e-8 * np.minimum(where(lower > 0, lower, upper), b)
        break2 = np.where(on_break, -above * above, break2)
        root = np.where(on_break, lower, root)

    epsilon, shift = np.sqrt(np.abs(break2)), np.maximum(-break2, 0.0)
    # sinh y is the smaller root over epsilon at either end, and cosh y the larger one.
    roots = np.sqrt(outer2) * np.where(root > 0, lower, epsilon) + root * upper
    covered2 = np.where(root > 0, width * (upper + lower), outer2)
    length = np.arcsinh(covered2 / np.maximum(roots, TINY))
    start = np.arcsinh(np.minimum(root, lower) / epsilon)

    def h(y: Array, index: Indices) -> Array:
        # s^2 = |r^2 - b^2| cosh^2 y above the break, |r^2 - b^2| sinh^2 y below it.
        s = np.sinh(y, out=y)
        s *= epsilon[index]
        s *= s
        s += shift[index]
        x = s + b * b
        return weight(np.sqrt(x, out=x), np.sqrt(s, out=s))

    result = integrate(h, length, start, growth=growth)
    # Infinite where F ~ 1/s and the annulus begins at the break.
    pole = on_break & (lower <= 0)
    if some(pole) and weight(np.array([b]), np.zeros(1)) != 0:
        result[pole] = np.inf
    return result
