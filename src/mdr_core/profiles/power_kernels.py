"""Powers of the radius and their stress integrals, at every scale and down to the tip.

Source: notes, §4 and §5.
"""

from collections.abc import Iterable
from functools import lru_cache
from math import ceil, exp, log, log2
from typing import Final

import numpy as np

from mdr_core.abel.polynomial import (
    COARSE,
    Inner,
    StressPolynomial,
    economised,
    end,
    interval,
    single,
)
from mdr_core.abel.roots import between
from mdr_core.profiles.moment_series import moment_series
from mdr_core.profiles.profile import NOWHERE, ORDINARY
from mdr_core.quadrature import Analytic
from mdr_core.typing import Array, Chosen, Parameter

_TINY: Final = 1e-290
_HUGE: Final = 1e290
_LOG_ORDINARY: Final = 500.0
# Above this power the integral lies next to the contact's edge: what is exp(-42) of it is lost.
STEEP: Final = 64.0
_ROUNDING_LOG: Final = 42.0
# Of c/a: on wider annuli no polynomial is short.
_WIDE: Final = 0.2
# Parts of an octave in which powers share their rules.
_GROWTHS: Final = 8
# So small a part of the stick radius is the axis to it: its square is far below rounding.
_INMOST: Final = 1e-100
# The exponents for which NumPy does not raise.
_EXACT: Final = ((2.0, np.square), (0.5, np.sqrt), (-1.0, np.reciprocal))


def raised(base: Parameter, exponent: Parameter) -> Array:
    """base^exponent, the same for one number as for each of many.

    C's pow and NumPy's round differently, and NumPy squares and takes roots where a single
    exponent stands for all: here one scene is raised like each scene of a sweep.
    """
    result = np.asarray(np.power(base, exponent))
    if np.ndim(exponent):
        for special, exact in _EXACT:
            there = exponent == special
            if np.any(there):
                result = np.where(there, exact(base), result)
    return result


def ordinary_radii(powers: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Radii at which the square of each C r^n, times a length or two, is surely a double."""
    reach = min(
        (_LOG_ORDINARY - 2 * abs(log(abs(c)))) / (2 * exponent + 2) for c, exponent in powers
    )
    if reach <= 0:
        return NOWHERE
    return max(exp(-reach), ORDINARY[0]), min(exp(min(reach, _LOG_ORDINARY)), ORDINARY[1])


def power(coefficient: Parameter, r: Array, exponent: Parameter) -> Array:
    """C r^n, also where r^n alone leaves the range of doubles."""
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        bare = raised(r, exponent)
        extreme = (r > 0) & ((bare < _TINY) | (bare > _HUGE))
        direct = np.asarray(coefficient * np.where(extreme, 1.0, bare))
        if not extreme.any():
            return direct
        scale = raised(np.abs(coefficient), 1 / np.asarray(exponent))
        scaled = np.sign(coefficient) * raised(r * scale, exponent)
    return np.asarray(np.where(extreme, scaled, direct))


def power_slope(coefficient: Parameter, r: Array, exponent: Parameter) -> Array:
    """C n r^(n-1), infinite at r = 0 for n < 1."""
    n = exponent if isinstance(exponent, float) else np.asarray(exponent, dtype=float)
    with np.errstate(divide="ignore", over="ignore", under="ignore", invalid="ignore"):
        bare = raised(r, n - 1)
        if bare.size == 1 and _TINY <= bare.item() <= _HUGE:
            return np.asarray(coefficient * n * bare)
        extreme = (r > 0) & ((bare < _TINY) | (bare > _HUGE))
        direct = np.asarray(coefficient * n * bare)
        if not extreme.any():
            return direct
        scaled = n * power(coefficient, r, n) / np.where(r > 0, r, 1.0)
    return np.asarray(np.where(extreme, scaled, direct))


def power_root(value: Array, coefficient: Parameter, exponent: Parameter) -> Array:
    """(value / C)^(1/n), the quotient never formed where it could leave the range (n >= 1).

    The rounding of 1/n is felt as log(value) eps/n; one step of Newton's method takes it out.
    """
    n = np.asarray(exponent, dtype=float)
    c = np.asarray(coefficient, dtype=float)
    with np.errstate(divide="ignore", over="ignore", under="ignore", invalid="ignore"):
        split = raised(value, 1 / n) / raised(c, 1 / n)
        root = np.where(n < 1, raised(value / c, 1 / n), split)
        miss = (value - power(c, root, n)) / np.where(value > 0, value, 1.0)
        polished = root * (1 + miss / n)
    return np.asarray(np.where((value > 0) & np.isfinite(root), polished, root))


def power_stick(a: Array, ratio: Array, rest: Array, exponent: Array) -> tuple[Array, Array]:
    """c and a - c where 1 - (c/a)^m = ratio = 1 - rest, with the digits of both.

    Source: mdr-5, Eqs. (5.29), (5.31); notes, §4.
    """
    with np.errstate(divide="ignore"):
        exact = np.where(ratio < 0.5, np.log1p(-np.minimum(ratio, 0.5)), np.log(rest))
    e = exact / exponent
    return np.asarray(a * np.exp(e)), np.asarray(-a * np.expm1(e))


def power_step(a: Array, width: Array, c: Array, exponent: Array) -> Array:
    """1 - (c/a)^m [1], from the width while the annulus is narrow, else from c itself."""
    safe = np.where(a > 0, a, 1.0)
    part = np.minimum(width / safe, 0.5)
    with np.errstate(divide="ignore"):
        log_ratio_ = np.where(width < safe / 2, np.log1p(-part), np.log(c / safe))
    return np.asarray(-np.expm1(exponent * log_ratio_))


def root_step(a: Array, r: Array, width: Array | None, inner: Array | None = None) -> Array:
    """sqrt(a^2 - r^2) - sqrt(c^2 - r^2), the second term for r < c only.

    c = a - width, or `inner` where it is known by itself.
    """
    return roots(a, r, width, inner)[0]


def roots(
    a: Array, r: Array, width: Array | None, inner: Array | None = None
) -> tuple[Array, Array | None]:
    """That difference, and its second term by itself."""
    root_a = a - r
    root_a *= a + r
    np.sqrt(root_a, out=root_a)
    if width is None:
        return root_a, None
    c = a - width if inner is None else inner
    root_c = np.maximum(c - r, 0.0)
    root_c *= c + r
    np.sqrt(root_c, out=root_c)
    return np.asarray(np.where(c > r, width * (a + c) / (root_a + root_c), root_a)), root_c


def odd_moment(
    polynomial: StressPolynomial,
    unit: float,
    a: Array,
    r: Array,
    width: Array | None,
    inner: Array | None = None,
) -> Array:
    """int_max(r,c)^a w(x/l) / sqrt(x^2 - r^2) dx of an odd polynomial w, l^2 = `unit`."""
    delta = r * r
    delta /= -unit
    step, lower = roots(a, r, width, inner)
    upper2 = (a * a).item() / unit
    if width is None or lower is None:
        return polynomial.between(delta, step, upper2, None, None)
    c = a - width if inner is None else inner
    below = Inner(lower, (c * c).item() / unit, (width * (a + c)).item() / unit)
    return polynomial.between(delta, step, upper2, None, below)


def log_ratio(a: Array, r: Array, width: Array | None, inner: Array | None = None) -> Array:
    """arccosh(a/r) - arccosh(c/r), c = a - width, without the infinite difference at r = 0."""
    root_a = np.sqrt((a - r) * (a + r))
    if width is None:
        low, root_low, step = r, np.zeros(1), (a - r) + root_a
    else:
        low = np.maximum(r, a - width if inner is None else inner)
        root_low = np.sqrt((low - r) * (low + r))
        step = np.minimum(a - r, width) + root_step(a, r, width, inner)
    with np.errstate(divide="ignore"):
        return np.asarray(np.log1p(step / (low + root_low)))


def power_moment(
    m: float,
    a: Array,
    r: Array,
    rtol: float,
    width: Array | None,
    inner: Array | None = None,
) -> Array:
    """int_max(r,c)^a (x/a)^m / sqrt(x^2 - r^2) dx [1], c = a - width.

    All of it is a hypergeometric function; over an annulus x = r cosh(y) leaves (cosh y)^m, smooth
    in the strip, and on the axis the integral is elementary.
    """
    if m == 0:
        return log_ratio(a, r, width, inner)
    if m == 1:
        return root_step(a, r, width, inner) / a
    series = _by_series(m, a, r, rtol, width, inner)
    if series is not None:
        return series
    if m > STEEP:
        width, inner = _felt_part(m, a, width, inner)
    c = None if width is None else a - width if inner is None else inner
    # So far inside c the radius changes nothing, and its square leaves the range of doubles.
    on_axis = r == 0 if c is None else r <= _INMOST * c
    any_on_axis = np.count_nonzero(on_axis) > 0
    safe = np.where(on_axis, a / 2, r) if any_on_axis else r
    ratio = safe / a
    # A little more stands for all powers next to it: the rules' limits are found once.
    growth = 2.0 ** (ceil(log2(max(abs(m), 1.0)) * _GROWTHS) / _GROWTHS)
    analytic = Analytic(growth=growth)

    def h(y: Array, index: Chosen) -> Array:
        np.cosh(y, out=y)
        y *= ratio[index]
        y **= m
        return y

    leg2 = (a - safe) * (a + safe)
    if width is None or c is None:
        value = between(h, np.arcsinh(np.sqrt(leg2) / safe), rtol, analytic=analytic)
    else:
        low = np.maximum(c, safe)
        root = np.sqrt((low - safe) * (low + safe))
        gap2 = np.minimum(width * (2 * a - width), leg2)
        length = np.arcsinh(gap2 / (np.sqrt(leg2) * low + root * a))
        value = between(h, length, rtol, np.arcsinh(root / safe), analytic=analytic)
    if any_on_axis:
        value[on_axis] = np.broadcast_to(_axis_moment(m, a, width), value.shape)[on_axis]
    return value


def _by_series(
    m: float, a: Array, r: Array, rtol: float, width: Array | None, inner: Array | None
) -> Array | None:
    """The moment without a node, None where no series is short."""
    if width is None:
        series = moment_series(m, rtol)
        return None if series is None else series.at(a, r)
    if rtol < COARSE or not single(a, width, inner):
        return None
    ratio = ((a - width if inner is None else inner) / a).item()
    if ratio < _WIDE:
        return None
    polynomial = _over_annulus(m, interval(1 / (ratio * ratio)), rtol)
    if polynomial is None:
        return None
    edge = a.item()
    return odd_moment(polynomial, edge * edge, a, r, width, inner) / edge


@lru_cache(maxsize=256)
def _over_annulus(m: float, number: int, rtol: float) -> StressPolynomial | None:
    """x^m for 1/end(number) <= x^2 <= 1."""
    return economised(lambda q: q ** ((m - 1) / 2), (1 / end(number), 1.0), rtol, odd=True)


def felt_from(edge: Array, exponent: float) -> Array:
    """Radius below which nothing is felt of a steep power that ends at the edge; zero if gentle."""
    if exponent <= STEEP:
        return np.zeros_like(edge)
    return np.asarray(edge * np.exp(-(_ROUNDING_LOG + log(exponent)) / exponent))


def _felt_part(
    m: float, a: Array, width: Array | None, inner: Array | None
) -> tuple[Array, Array | None]:
    """Width and inner edge of the part of an annulus in which (x/a)^m is more than rounding."""
    felt = -a * np.expm1(-(_ROUNDING_LOG + log(m)) / m)
    if width is None:
        return felt, None
    c = a - width if inner is None else inner
    return np.minimum(width, felt), np.where(width < felt, c, a - felt)


def _axis_moment(m: float, a: Array, width: Array | None) -> Array:
    """int_c^a (x/a)^m dx/x, infinite for c = 0 and m <= 0."""
    if width is None:
        return np.full_like(a, 1 / m if m > 0 else np.inf)
    with np.errstate(divide="ignore"):
        log_c = np.log1p(-width / a)
        return np.asarray(-np.expm1(m * log_c) / m)
