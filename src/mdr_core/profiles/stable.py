"""Elementary differences in forms that keep their digits.

Source: notes, §4.
"""

from functools import lru_cache
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import gamma

from mdr_core.typing import Array, Parameter

_THRESHOLD: Final = 0.5
_TERMS: Final = 15


def _economised(sign: float) -> tuple[float, ...]:
    """Coefficients in u of sum_k (sign u)^k / (2k + 3), economised on 0 <= u <= 1/4."""
    k = np.arange(60)
    points = chebyshev.chebpts1(_TERMS)
    u = (points + 1) / 8
    values = ((sign * u[:, None]) ** k / (2 * k + 3)).sum(axis=1)
    fitted = np.linalg.solve(chebyshev.chebvander(points, _TERMS - 1), values)
    cheb = chebyshev.Chebyshev(fitted, domain=[0, 0.25])
    return tuple(cheb.convert(kind=np.polynomial.Polynomial, domain=[-1, 1], window=[-1, 1]).coef)


_ATAN: Final = _economised(-1.0)
_ATANH: Final = _economised(1.0)


def _horner(coefficients: tuple[float, ...], u: Array) -> Array:
    value = np.full_like(u, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        value *= u
        value += coefficient
    return value


# E_2, E_4, ...: Gamma(w + 3/4)/Gamma(w + 1/4) = sqrt(w) exp(-sum_k E_2k / (k 4^(2k+1) w^2k)),
# from dlmf, 5.11.8 and 24.4.31.
_EULER_NUMBERS: Final = (-1, 5, -61, 1385, -50521, 2702765, -199360981)
_GAMMA_LIMIT: Final = 20.0


def atan_gap(s: Array, b: Parameter) -> Array:
    """s - b arctan(s/b) for s >= 0, b > 0 [length]: s^3/(3 b^2) for small s."""
    s = np.asarray(s, dtype=float)
    z = s / b
    small = z < _THRESHOLD
    u = np.square(np.minimum(z, _THRESHOLD))
    return np.asarray(np.where(small, s * u * _horner(_ATAN, u), s - b * np.arctan(z)))


def atanh_gap(t: Array) -> Array:
    """artanh(t) - t for 0 <= t < 1 [1]: t^3/3 for small t."""
    t = np.asarray(t, dtype=float)
    small = t < _THRESHOLD
    u = np.square(np.minimum(t, _THRESHOLD))
    return np.asarray(np.where(small, t * u * _horner(_ATANH, u), np.arctanh(t) - t))


def tanh_gap(v: Array) -> Array:
    """v - tanh(v) for v >= 0 [1]: v^3/3 for small v, v - 1 for large."""
    t = np.tanh(v)
    with np.errstate(divide="ignore"):
        small = atanh_gap(np.where(v < 1.0, t, 0.0))
    return np.asarray(np.where(v < 1.0, small, v - t))


def kappa(exponent: Parameter) -> Array:
    """kappa_n = sqrt(pi) Gamma(n/2 + 1) / Gamma((n + 1)/2) [1].

    Source: mdr-5, Eq. (5.25).
    """
    return _single_kappa(exponent) if isinstance(exponent, float) else _kappa(exponent)


@lru_cache(maxsize=256)
def _single_kappa(exponent: float) -> Array:
    """Computed once: it takes as long as the stress at a hundred radii."""
    value = _kappa(exponent)
    value.flags.writeable = False
    return value


def _kappa(exponent: Parameter) -> Array:
    n = np.asarray(exponent, dtype=float)
    small = np.minimum(n, _GAMMA_LIMIT)
    direct = gamma(small / 2 + 1) / gamma((small + 1) / 2)
    # Beyond, Gamma loses digits and overflows, its ratio does not.
    w = np.maximum(n, _GAMMA_LIMIT) / 2 + 0.25
    log_tail = np.zeros_like(w)
    for k, euler in reversed(list(enumerate(_EULER_NUMBERS, start=1))):
        log_tail = (log_tail - euler / (k * 4.0 ** (2 * k + 1))) / (w * w)
    ratio = np.where(n > _GAMMA_LIMIT, np.sqrt(w) * np.exp(log_tail), direct)
    return np.asarray(np.sqrt(np.pi) * ratio)
