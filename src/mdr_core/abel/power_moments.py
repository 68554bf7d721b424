"""Stress integrals of powers of the radius: int_max(r,c)^a x^m / sqrt(x^2 - r^2) dx.

The coordinate of every annulus here is the radius. Source: notes, §5.
"""

from math import ceil, inf, log, log2
from typing import Final

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.two_root import arcsinh_difference, inverse_hypot
from mdr_core.quadrature import Analytic, integrate
from mdr_core.typing import Array, Chosen

# (x/a)^m is below rounding error for log(a/x) > (42 + log m)/m.
_ROUNDING_LOG: Final = 42.0
# Parts of an octave within which exponents share the nodes of their rules.
_GROWTHS: Final = 8
# Part of c below which a radius is on the axis: its square is far below rounding error.
_AXIS: Final = 1e-30


def root_step(annulus: Annulus, r: Array) -> Array:
    """Return sqrt(a^2 - r^2) - sqrt(c^2 - r^2), the second term for r < c only [length]."""
    a, inner, _ = annulus
    root_a = np.sqrt((a - r) * (a + r))
    if inner is None:
        return root_a
    width, c, _ = inner
    root_c = inverse_hypot(c, r)
    return np.where(c > r, width * (a + c) / (root_a + root_c), root_a)


def log_ratio(annulus: Annulus, r: Array) -> Array:
    """Return arccosh(a/r) - arccosh(c/r) [1], also at r = 0."""
    a, inner, _ = annulus
    if inner is None:
        low, root_low, step = r, np.zeros(1), (a - r) + np.sqrt((a - r) * (a + r))
    else:
        low = np.maximum(r, inner.radius)
        root_low = np.sqrt((low - r) * (low + r))
        step = np.minimum(a - r, inner.width) + root_step(annulus, r)
    with np.errstate(divide="ignore"):
        return np.log1p(step / (low + root_low))


def power_moment(m: float, annulus: Annulus, r: Array, rtol: float) -> Array:
    """Return int_max(r,c)^a (x/a)^m / sqrt(x^2 - r^2) dx [1], m > -1.

    x = r cosh(y) leaves (cosh y)^m, analytic in the strip; on the axis the integral is
    elementary.

    Parameters
    ----------
    m : exponent [1].
    annulus : a and c as radii [length].
    r : radii 0 <= r < a [length], shape (m,).
    rtol : relative tolerance.
    """
    if m == 0:
        return log_ratio(annulus, r)
    if m == 1:
        return root_step(annulus, r) / annulus.outer
    a, inner, _ = annulus
    on_axis = r == 0 if inner is None else r <= _AXIS * inner.radius
    any_on_axis = np.count_nonzero(on_axis) > 0
    safe = np.where(on_axis, a / 2, r) if any_on_axis else r
    ratio = safe / a
    # Neighbouring exponents share the rule of a slightly larger one.
    growth = 2.0 ** (ceil(log2(max(abs(m), 1.0)) * _GROWTHS) / _GROWTHS)

    def h(y: Array, index: Chosen) -> Array:
        return (ratio[index] * np.cosh(y)) ** m

    root2 = (a - safe) * (a + safe)
    start = None
    if inner is None:
        length = np.arcsinh(np.sqrt(root2) / safe)
    else:
        width, low = inner.width, np.maximum(inner.radius, safe)
        root = np.sqrt((low - safe) * (low + safe))
        gap2 = np.minimum(width * (2 * a - width), root2)
        ends = np.sqrt(root2) / safe, a / safe, root / safe, low / safe
        length = arcsinh_difference(*ends, gap2 / (safe * safe))
        start = np.arcsinh(root / safe)
    # A steep power is significant only next to the edge: cosh y < 2 cosh(Y) e^(y-Y).
    longest = (_ROUNDING_LOG + log(m)) / m + log(2) if m > 1 else inf
    if longest < inf and np.any(length > longest):
        top = length if start is None else start + length
        length = np.minimum(length, longest)
        start = top - length
    value = integrate(h, length, rtol, start, analytic=Analytic(growth=growth))
    if any_on_axis:
        value[on_axis] = _axis_moment(m, annulus.at(on_axis))
    return value


def _axis_moment(m: float, annulus: Annulus) -> Array:
    """int_c^a (x/a)^m dx/x, infinite for c = 0 and m < 0."""
    a, inner, _ = annulus
    if inner is None:
        return np.full_like(a, 1 / m if m > 0 else np.inf)
    with np.errstate(divide="ignore"):
        return -np.expm1(m * np.log1p(-inner.width / a)) / m
