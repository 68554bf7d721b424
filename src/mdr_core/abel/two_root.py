"""The two-root rule: integrals of F(x)/sqrt(x^2 - r^2) over an annulus.

F itself has a root at a break b. The substitution

    x^2 = max(r, b)^2 + |r^2 - b^2| sinh^2 y

removes both roots, near or far from each other. The integrand is then analytic in the strip
|Im y| < pi/2 whatever r and b are, so that pieces of equal length serve all integrals.

Source: notes, §5.
"""

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.elementwise import indices, number, some, where
from mdr_core.quadrature import DEFAULT, Analytic, integrate
from mdr_core.typing import Array, Chosen, Flags, Parameter

# weight(x, s, index) = F(x) s/x with s = sqrt(x^2 - b^2), free of the root of F at b. x and s have
# shape (nodes, k); index (k,) selects their integrals.
Weight = Callable[[Array, Array, Chosen], Array]

_TINY: Final = float(np.finfo(float).tiny)
# Root of |r^2 - b^2| of a radius on the break, over b and the least s of the annulus: its square is
# rounding error.
_NEXT_TO_BREAK: Final = 1e-8
# Rounding error of a difference of contact coordinates.
_ROUNDING: Final = 4 * float(np.finfo(float).eps)


class _Ends(NamedTuple):
    """Ends of annuli m <= x <= a, m = max(b, c), each a number or an array (m,)."""

    upper: Array
    """sqrt(a^2 - b^2) [length]."""
    lower: Array
    """sqrt(m^2 - b^2) [length]."""
    gap2: Array
    """a^2 - m^2 [length^2]."""
    begin: Array
    """m [length]."""
    at_break: Flags | bool
    """True if m = b up to rounding."""
    root_c: Array | None
    """`lower` as accurate as c where c is given; None if there is no c."""


class _Distances(NamedTuple):
    """Differences of squares between points r and the ends of their annuli, each (m,)."""

    break2: Array
    """b^2 - r^2 [length^2]."""
    outer2: Array
    """a^2 - r^2 [length^2]."""
    root: Array | None
    """sqrt(c^2 - r^2), zero for r >= c; None if there is no c [length]."""


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
    rtol: float,
    analytic: Analytic = DEFAULT,
    beyond: Array | None = None,
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
    rtol : relative tolerance, 1e-3 to 1e-14.
    analytic : strip in which the integrand is analytic in y, and its growth.
    beyond : sqrt(r^2 - b^2), if all radii lie beyond the break and it has more digits [length].
        The inner end then has its coordinate.

    Returns
    -------
    Array of shape (m,) [F].

    Examples
    --------
    The arccosh(a/b) of Eq. (5.53), as the integral of F = x/s at the axis; b = 1, a = 2.

    >>> annulus = Annulus(np.array([np.sqrt(3.0)]))
    >>> axis = np.zeros(1)
    >>> value = two_root_integral(lambda x, s, _: x / x, 1.0, axis, annulus, rtol=1e-12)
    >>> float(f"{value[0]:.6g}")
    1.31696
    """
    ends = _ends(b, annulus)
    distances, on_break = _distances(b, r, beyond, ends, annulus)
    infinite = None
    if some(on_break):
        # Infinite where F ~ 1/s and the annulus begins at the break.
        index = indices(on_break & ends.at_break)
        pole = weight(np.full((1, index.size), b), np.zeros((1, index.size)), index)[0] != 0
        infinite = index[pole]
        # Their integrals, which are not used, are short there.
        distances.break2[infinite] = -b * b

    start, length = _interval(distances, ends)
    shift = np.maximum(-distances.break2, 0.0)
    epsilon = np.sqrt(np.abs(distances.break2))

    def h(y: Array, index: Chosen) -> Array:
        # s^2 = |r^2 - b^2| cosh^2 y above the break, |r^2 - b^2| sinh^2 y below it.
        s = np.sinh(y, out=y)
        s *= epsilon[index]
        s *= s
        s += shift[index]
        x = s + b * b
        return weight(np.sqrt(x, out=x), np.sqrt(s, out=s), index)

    result = integrate(h, length, rtol, start, analytic=analytic)
    if infinite is not None:
        result[infinite] = np.inf
    return result


def _ends(b: float, annulus: Annulus) -> _Ends:
    """Ends of annuli, in the forms that are free of cancellation."""
    upper, inner, _ = annulus
    if inner is None:
        return _Ends(upper, number(0.0), upper * upper, number(b), at_break=True, root_c=None)
    width, c = inner.width, np.maximum(inner.radius, b)
    lower = upper - width
    if inner.coordinate is None:
        # Next to the break a given radius is accurate, but one from a load no more than b^2/lower:
        # the difference is as accurate as upper.
        error = _ROUNDING * upper
        root_c = np.minimum(np.maximum(inverse_hypot(c, b), lower - error), lower + error)
    else:
        root_c = inner.coordinate
    # In a narrow annulus its width is accurate.
    lower = where(width > upper / 2, root_c, lower)
    at_break = (width >= upper) | (lower <= 0)
    return _Ends(upper, lower, width * (upper + lower), c, at_break, root_c)


def _distances(
    b: float, r: Array, beyond: Array | None, ends: _Ends, annulus: Annulus
) -> tuple[_Distances, Flags]:
    """Distances of the points, and whether they lie on the break.

    Points on the break take the rule of one just above it.
    """
    upper, edge, root = ends.upper, annulus.outer_radius, None
    if beyond is None:
        break2, on_break = (b - r) * (b + r), r == b
        # a^2 - r^2, from the radius where that is exact.
        outer2 = (
            np.maximum(upper * upper + break2, 0.0) if edge is None else (edge - r) * (edge + r)
        )
    else:
        break2, on_break = -beyond * beyond, beyond == 0
        outer2 = (upper - beyond) * (upper + beyond)
    if ends.root_c is not None:
        # Zero at c itself.
        root = (
            inverse_hypot(ends.begin, r) if beyond is None else inverse_hypot(ends.root_c, beyond)
        )
    if some(on_break):
        least = where(ends.lower > 0, ends.lower, upper)
        break2 = np.where(on_break, -np.square(_NEXT_TO_BREAK * np.minimum(least, b)), break2)
        root = None if root is None else np.where(on_break, ends.lower, root)
    return _Distances(break2, outer2, root), on_break


def _interval(distances: _Distances, ends: _Ends) -> tuple[Array | None, Array]:
    """Start of the interval of y, None for zero, and its length."""
    break2, outer2, root = distances
    upper, epsilon = ends.upper, np.sqrt(np.abs(break2))
    if root is None:
        return None, np.arcsinh(np.sqrt(np.minimum(outer2, ends.gap2)) / epsilon)
    # sinh y is the smaller root over epsilon at either end, and cosh y the larger one.
    roots = np.sqrt(outer2) * np.where(root > 0, ends.lower, epsilon) + root * upper
    covered2 = np.where(root > 0, ends.gap2, outer2)
    length = np.arcsinh(covered2 / np.maximum(roots, _TINY))
    return np.arcsinh(np.minimum(root, ends.lower) / epsilon), length
