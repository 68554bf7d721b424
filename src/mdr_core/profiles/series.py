"""Sums of powers, with negative terms where the profile stays admissible."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import copysign, exp, inf, isfinite, log
from typing import ClassVar, Final

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.errors import InputError
from mdr_core.lazy import cached_property
from mdr_core.profiles.power import Power
from mdr_core.profiles.power_kernels import (
    STEEP,
    ordinary_radii,
    power,
    power_moment,
    power_slope,
)
from mdr_core.profiles.power_sums import (
    LOG_FARTHEST,
    LogTerms,
    cancelling,
    first_fall,
    log_radius_of,
    log_terms,
)
from mdr_core.profiles.profile import LARGEST_HELD, SMALLEST_HELD, Profile, refuse_load
from mdr_core.profiles.stable import kappa
from mdr_core.typing import Array, Parameter

# Bound on the logarithm of a starting radius: no power of it leaves the range of doubles soon.
_FARTHEST: Final = 70.0
_EPS: Final = float(np.finfo(float).eps)
# Terms that are larger than their sum by no more than this leave it the tolerance.
_LITTLE: Final = 2.0
_FINEST: Final = 1e-15


@dataclass(frozen=True)
class PowerTerm:
    """One term C r^n: `coefficient` [length^(1-n)], of either sign; `exponent` > 0 [1]."""

    coefficient: float
    exponent: float


@dataclass(frozen=True)
class Series(Profile):
    """f = sum of C_i r^n_i over `terms`. Source: mdr-5, Eq. (5.24), superposed.

    Negative terms are accepted; the profile then ends where f' or g' first falls to zero
    (notes, §3), and a contact that reaches there is refused.
    """

    terms: tuple[PowerTerm, ...]

    kind: ClassVar[str] = "series"
    formula: ClassVar[str] = "Σ coefficientᵢ·r^exponentᵢ"
    closed_forms: ClassVar[tuple[str, ...]] = (
        "normal_force",
        "mean_pressure",
        "normal_stiffness",
        "elastic_energy",
    )

    def __post_init__(self) -> None:
        if not self.terms:
            raise InputError(("profile", "terms"), "at least one term is needed")
        for i, term in enumerate(self.terms):
            if not (isfinite(term.coefficient) and term.coefficient != 0):
                raise InputError(
                    ("profile", "terms", i, "coefficient"), "must be finite and not zero"
                )
            if not 0 < term.exponent < inf:
                raise InputError(("profile", "terms", i, "exponent"), "must be positive and finite")
        if not self._powers:
            raise InputError(("profile", "terms"), "the terms cancel each other: nothing is left")
        if self.domain == 0:
            raise InputError(
                ("profile", "terms"), "f falls from radius 0 on: the leading term is not positive"
            )

    @cached_property
    def _powers(self) -> tuple[tuple[float, float], ...]:
        """(coefficient, exponent), ascending in the exponent, equal ones added up."""
        merged: dict[float, float] = {}
        for term in self.terms:
            merged[term.exponent] = merged.get(term.exponent, 0.0) + term.coefficient
        return tuple((c, n) for n, c in sorted(merged.items()) if c != 0)

    @cached_property
    def domain(self) -> float:
        if all(c > 0 for c, _ in self._powers):
            return inf
        # Of the slopes times the radius.
        slope_f = log_terms(self._powers, lambda n: n)
        slope_g = log_terms(self._powers, lambda n: n * _kappa(n))
        return min(first_fall(slope_f), first_fall(slope_g))

    @property
    def last_coordinate(self) -> float | None:
        return None if self.domain == inf else self.domain

    @cached_property
    def ordinary_coordinates(self) -> tuple[float, float]:
        return ordinary_radii(self._powers)

    @property
    def rounding(self) -> float:  # type: ignore[override]
        return 4e-14 + 4e-15 * max(n for _, n in self._powers) + 8 * _EPS * self._cancelling

    @cached_property
    def _cancelling(self) -> float:
        """Largest sum of the terms' sizes over their total, in depth or force, less one [1]."""
        if all(c > 0 for c, _ in self._powers):
            return 0.0
        last = log(self.domain) if self.domain < inf else LOG_FARTHEST
        return max(cancelling(terms, last) for terms in (self._depth_terms, self._force_terms))

    @property
    def _depth_terms(self) -> LogTerms:
        return log_terms(self._powers, _kappa)

    @property
    def _force_terms(self) -> LogTerms:
        """Of F_N/E*, over a."""
        return log_terms(self._powers, lambda n: _kappa(n) * 2 * n / (n + 1))

    def f(self, radius: Array) -> Array:
        return _total(power(c, radius, n) for c, n in self._powers)

    def df(self, radius: Array) -> Array:
        return _total(power_slope(c, radius, n) for c, n in self._powers)

    def g(self, x: Array) -> Array:
        return _total(kappa(n) * power(c, x, n) for c, n in self._powers)

    def dg(self, x: Array) -> Array:
        return _total(kappa(n) * power_slope(c, x, n) for c, n in self._powers)

    def reduced_force(self, coordinate: Array) -> Array:
        parts = (2 * n / (n + 1) * kappa(n) * power(c, coordinate, n) for c, n in self._powers)
        with np.errstate(over="ignore"):
            return _total(parts) * coordinate

    def coordinate_from_depth(self, depth: Array) -> None:
        """No closed form; a depth whose force has no digits is refused."""
        low, high = self._held_depths
        refuse_load("indentation_depth", (depth > 0) & ~((depth >= low) & (depth <= high)))

    def coordinate_from_reduced_force(self, reduced_force: Array) -> None:
        """No closed form; a force whose depth has no digits is refused."""
        low, high = self._held_forces
        outside = ~((reduced_force >= low) & (reduced_force <= high))
        refuse_load("normal_force", (reduced_force > 0) & outside)

    @cached_property
    def _held_depths(self) -> tuple[float, float]:
        return self._loads_between(self.depth)

    @cached_property
    def _held_forces(self) -> tuple[float, float]:
        return self._loads_between(self.reduced_force)

    def _loads_between(self, load: Callable[[Array], Array]) -> tuple[float, float]:
        """Loads under which depth and force are doubles with all their digits.

        A load beyond the profile's end is refused for that, not here.
        """
        depth = self._depth_terms
        force = tuple(term._replace(exponent=term.exponent + 1) for term in self._force_terms)
        last = min(log(self.domain), LOG_FARTHEST) if self.domain < inf else LOG_FARTHEST
        low = max(log_radius_of(terms, log(SMALLEST_HELD), last) for terms in (depth, force))
        high = min(log_radius_of(terms, log(LARGEST_HELD), last) for terms in (depth, force))
        ends = load(np.array([exp(low), exp(high)]))
        return float(ends[0]), float(ends[1]) if high < last else inf

    def reduced_energy(self, coordinate: Array) -> Array:
        """sum_ij d_i d_j a n_i n_j (n_i + n_j + 2)/((n_i + 1)(n_j + 1)(n_i + n_j + 1))."""
        depths = [(kappa(n) * power(c, coordinate, n), n) for c, n in self._powers]
        total = np.zeros_like(coordinate)
        with np.errstate(over="ignore", invalid="ignore"):
            for d_i, n in depths:
                for d_j, m in depths:
                    factor = n * m * (n + m + 2) / ((n + 1) * (m + 1) * (n + m + 1))
                    total += factor * d_i * d_j
            return _within_range(total) * coordinate

    @property
    def scale(self) -> Parameter:
        """About where the first and the last term are equal: a start for the inverse.

        Nearly equal exponents would put it out of the range of doubles.
        """
        (c, n), (k, m) = self._powers[0], self._powers[-1]
        crossing = (log(abs(c)) - log(abs(k))) / max(m - n, 0.5)
        return exp(min(max(crossing, -_FARTHEST), _FARTHEST))

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        if self.steepness <= STEEP and self.tip_exponent == 1:
            return super().slip_kernel(c, r, rtol)
        # The gentle ones are felt all over, the steep ones at the edge alone, the sharp at the tip.
        return self._superposed(
            lambda c_i, n, tolerance: Power(c_i, n).slip_kernel(c, r, tolerance), rtol
        )

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        if self.steepness <= STEEP:
            return super().outer_displacement(a, r, rtol, coordinate)
        return self._superposed(
            lambda c, n, tolerance: Power(c, n).outer_displacement(a, r, tolerance, coordinate),
            rtol,
        )

    def _superposed(self, answer: Callable[[float, float, float], Array], rtol: float) -> Array:
        """The sum of what each power, of a positive coefficient, answers by itself.

        `answer` takes a tolerance too: where the terms cancel, each is found more exactly.
        """
        total, lost = self._summed(answer, rtol)
        if lost > _LITTLE:
            total, _ = self._summed(answer, max(rtol / lost, _FINEST))
        return total

    def _summed(
        self, answer: Callable[[float, float, float], Array], rtol: float
    ) -> tuple[Array, float]:
        """The sum to a tolerance of its terms, and how much larger these are than it."""
        total = size = np.zeros(())
        for c, n in self._powers:
            term = answer(abs(c), n, rtol)
            total = total + copysign(1, c) * term
            size = size + term
        if all(c > 0 for c, _ in self._powers):
            return total, 1.0
        with np.errstate(divide="ignore", invalid="ignore"):
            return total, float(np.nanmax(np.abs(size) / np.abs(total), initial=1.0))

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (
            Branch(
                0.0,
                lambda x, _s, _index: self.dg(x),
                tip=self._powers[0][1],
                tip_size=1 + self._cancelling,
                of_powers=True,
                steepness=self.steepness,
            ),
        )

    @property
    def tip_exponent(self) -> float:
        return min(1.0, self._powers[0][1])

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        return (0.0,) if self._powers[0][1] <= 1 else ()

    @property
    def steepness(self) -> float:
        return max(3.5, *(n for _, n in self._powers))

    @property
    def tip_pressure(self) -> Parameter:
        c, n = self._powers[0]
        return inf if n < 1 else c / 2 if n == 1 else 0.0

    def pressure_kernel(
        self,
        coordinate: Array,
        radius: Array,
        rtol: float,
        width: Array | None = None,
        edge: Array | None = None,
        modulus: float = 1.0,
        inner: Array | None = None,
    ) -> Array:
        def pressure(c: float, n: float, tolerance: float) -> Array:
            scale = modulus * kappa(n) / np.pi * power_slope(c, coordinate, n)
            moment = power_moment(n - 1, coordinate, radius, tolerance, width, inner)
            return np.asarray(scale * np.where(np.isinf(moment), 0.0, moment))

        total = self._superposed(pressure, rtol)
        if width is None and self.infinite_pressure_radii:
            # Next to the first term all others are small there, whatever their factors.
            return np.where(radius == 0, copysign(inf, modulus), total)
        return total


def _total(parts: Iterable[Array]) -> Array:
    """The sum of the terms, of which the total is positive."""
    with np.errstate(over="ignore", invalid="ignore"):
        return _within_range(np.asarray(sum(parts)))


def _within_range(total: Array) -> Array:
    """The positive total; where its terms overflow against each other, infinity."""
    return np.where(np.isnan(total), inf, total)


def _kappa(exponent: float) -> float:
    return float(kappa(exponent))
