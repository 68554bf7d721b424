"""Sums of powers, with negative terms where the profile stays admissible."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import exp, inf, isfinite, log, pi
from typing import Any, ClassVar

import numpy as np

from mdr_core.doubles import EPS, LOG_RANGE
from mdr_core.elementwise import full, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import Profile
from mdr_core.profiles.power_functions import kappa, power, power_slope
from mdr_core.profiles.power_sums import first_negative_radius
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import single


@dataclass(frozen=True)
class PowerTerm:
    """One term C r^n of a series.

    Parameters
    ----------
    coefficient : C, of either sign [length^(1-n)].
    exponent : n > 0 [1].
    """

    coefficient: float
    exponent: float


@dataclass(frozen=True)
class Series(Profile):
    """Sum of powers f = sum C_i r^n_i; g and F_N/E* are sums over its terms.

    With negative terms the profile ends where f' or g' first falls to zero (notes, §3); contacts
    that reach there are rejected. Source: mdr-5, Eq. (5.24), superposed.

    Parameters
    ----------
    terms : the terms, in any order.

    Raises
    ------
    InputError : no terms, a profile that falls from the axis on, or terms that cancel.
    """

    terms: tuple[PowerTerm, ...]

    kind: ClassVar[str] = "series"
    formula: ClassVar[str] = "Σ coefficientᵢ·r^exponentᵢ"
    closed_forms: ClassVar[tuple[str, ...]] = (*Profile.closed_forms, "elastic_energy")

    def __post_init__(self) -> None:
        path = ("profile", "terms")
        terms: Any = self.terms
        if not (isinstance(terms, tuple | list) and terms):
            raise InputError(path, "at least one term is needed, in a tuple of PowerTerm")
        known = []
        for i, term in enumerate(terms):
            if not isinstance(term, PowerTerm):
                raise InputError((*path, i), "must be a PowerTerm(coefficient, exponent)")
            coefficient = single((*path, i, "coefficient"), term.coefficient)
            if not (isfinite(coefficient) and coefficient != 0):
                raise InputError((*path, i, "coefficient"), "must be finite and not zero")
            exponent = single((*path, i, "exponent"), term.exponent)
            if not 0 < exponent < inf:
                raise InputError((*path, i, "exponent"), "must be positive and finite")
            known.append(PowerTerm(coefficient, exponent))
        vars(self)["terms"] = tuple(known)
        if not self._powers:
            raise InputError(path, "the terms cancel to zero")
        if self._powers[0][0] < 0 or self.domain == 0:
            raise InputError(
                path, "f falls from radius 0: the term of lowest exponent must be positive"
            )

    @cached_property
    def _powers(self) -> tuple[tuple[float, float], ...]:
        """(coefficient, exponent) of each term, by exponent; equal exponents are merged."""
        merged: dict[float, float] = {}
        for term in self.terms:
            merged[term.exponent] = merged.get(term.exponent, 0.0) + term.coefficient
        return tuple((c, n) for n, c in sorted(merged.items()) if c != 0)

    @cached_property
    def _powers_of_g(self) -> tuple[tuple[float, float], ...]:
        """(kappa_n coefficient, exponent) of the terms of g. Source: mdr-5, Eq. (5.25)."""
        return tuple((float(kappa(n)) * c, n) for c, n in self._powers)

    @cached_property
    def flattens(self) -> bool:  # type: ignore[override]  # a constant of other kinds
        """True if a term is negative. See `Profile`."""
        return any(c < 0 for c, _ in self._powers)

    @cached_property
    def domain(self) -> float:
        # f' and g' are multiplied by the radius.
        c, n = np.array(self._powers).T
        size = np.log(np.abs(c)) + np.log(n)
        slopes = (np.array([np.sign(c), each, n]) for each in (size, size + np.log(kappa(n))))
        return min(map(first_negative_radius, slopes))

    def rounding_at(self, coordinate: Array) -> Parameter:
        """The bound includes cancellation between positive and negative terms. See `Profile`."""
        rounding = 4e-14 + 8e-15 * max(self.exponents)
        if not self.flattens:
            return rounding
        terms = np.array(
            [(depth, 2 * n / (n + 1) * depth) for depth, n in self._depths(coordinate)]
        )
        with np.errstate(all="ignore"):
            lost = (np.abs(terms).sum(axis=0) / np.abs(terms.sum(axis=0))).max(axis=0)
        return rounding + 8 * EPS * where(coordinate > 0, lost, 0.0)

    @property
    def scale(self) -> Parameter:
        """Radius at which the terms of the lowest and the highest exponent are about equal."""
        (c, n), (k, m) = self._powers[0], self._powers[-1]
        crossing = (log(abs(c)) - log(abs(k))) / max(m - n, 0.5)
        # Nearly equal exponents leave the radius undetermined.
        return exp(min(max(crossing, -LOG_RANGE), LOG_RANGE))

    def _total(self, parts: Iterable[Array], factor: Array | float = 1.0) -> Array:
        """Sum of factors times terms, which is positive; infinite where a term overflows."""
        # Terms of both signs may overflow.
        with np.errstate(all="ignore"):
            total: Any = sum(parts) * factor
        return where(np.isnan(total), inf, total)

    @property
    def exponents(self) -> tuple[float, ...]:
        return tuple(n for _, n in self._powers)

    def f(self, radius: Array) -> Array:
        return self._total(power(c, radius, n) for c, n in self._powers)

    def df(self, radius: Array) -> Array:
        return self._total(power_slope(c, radius, n) for c, n in self._powers)

    def g(self, x: Array) -> Array:
        return self._total(depth for depth, _ in self._depths(x))

    def dg(self, x: Array) -> Array:
        return self._total(power_slope(c, x, n) for c, n in self._powers_of_g)

    def _depths(self, x: Array) -> Iterator[tuple[Array, float]]:
        """Each term of g [length], and its exponent."""
        return ((power(c, x, n), n) for c, n in self._powers_of_g)

    def reduced_force(self, coordinate: Array) -> Array:
        terms = self._depths(coordinate)
        return self._total((2 * n / (n + 1) * depth for depth, n in terms), coordinate)

    def reduced_energy(self, coordinate: Array) -> Array:
        """sum_ij d_i d_j a n_i n_j (n_i + n_j + 2)/((n_i + 1)(n_j + 1)(n_i + n_j + 1))."""
        with np.errstate(over="ignore", under="ignore"):
            depths = list(self._depths(coordinate))
            pairs = (
                d * e * (n * m * (n + m + 2) / ((n + 1) * (m + 1) * (n + m + 1)))
                for d, n in depths
                for e, m in depths
            )
            return self._total(pairs, coordinate)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        if self.flattens or any(2 < n < 4 for _, n in self._powers):
            return coordinate < 0
        return (
            self._total(n * (n - 3 if n >= 4 else -1) * d for d, n in self._depths(coordinate)) <= 0
        )

    def axis_stress(self, coordinate: Array) -> Array:
        if self.infinite_pressure_radii:
            return full(inf, coordinate)
        slopes = ((power_slope(c, coordinate, n), n) for c, n in self._powers_of_g)
        return self._total(slope / (pi * (n - 1)) for slope, n in slopes)
