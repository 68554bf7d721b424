"""Sums of powers, with negative terms where the profile stays admissible."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import copysign, exp, inf, isfinite, log
from typing import ClassVar, Final

import numpy as np
from scipy.optimize import brentq

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
from mdr_core.profiles.profile import LARGEST_HELD, SMALLEST_HELD, Profile, refuse_load
from mdr_core.profiles.stable import kappa
from mdr_core.typing import Array, Parameter

# Bound on the logarithm of a starting radius: no power of it leaves the range of doubles soon.
_FARTHEST: Final = 70.0
_LOG_LARGEST: Final = 700.0
_EPS: Final = float(np.finfo(float).eps)
# Radii at which it is looked how much the terms cancel.
_PLACES: Final = 257
# Terms that are larger than their sum by no more than this leave it the tolerance.
_LITTLE: Final = 2.0
_FINEST: Final = 1e-15
# Radii beyond have no double.
_LOG_FARTHEST: Final = 690.0


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
        slope_f = tuple((c * n, n - 1) for c, n in self._powers)
        slope_g = tuple((c * n * float(kappa(n)), n - 1) for c, n in self._powers)
        return min(_first_fall(slope_f), _first_fall(slope_g))

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
        low, high = _log_bounds(self._powers)
        end = min(high, log(self.domain)) if self.domain < inf else high
        places = np.linspace(min(low, end - 1), end, _PLACES)
        depth = tuple((c * float(kappa(n)), n) for c, n in self._powers)
        force = tuple((c * n / (n + 1), n) for c, n in depth)
        return max(_worst_cancelling(part, places) for part in (depth, force))

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
        depth = _without_zeros((c * float(kappa(n)), n) for c, n in self._powers)
        force = _without_zeros((c * 2 * n / (n + 1), n + 1) for c, n in depth)
        if not force:
            return inf, inf
        last = min(log(self.domain), _LOG_FARTHEST) if self.domain < inf else _LOG_FARTHEST
        low = max(_log_radius_of(part, log(SMALLEST_HELD), last) for part in (depth, force))
        high = min(_log_radius_of(part, log(LARGEST_HELD), last) for part in (depth, force))
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
        return self._superposed(lambda term: term.slip_kernel(c, r, rtol))

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        if self.steepness <= STEEP:
            return super().outer_displacement(a, r, rtol, coordinate)
        return self._superposed(lambda term: term.outer_displacement(a, r, rtol, coordinate))

    def _superposed(self, answer: Callable[[Power], Array]) -> Array:
        """The sum of what each power answers by itself."""
        return np.asarray(sum(copysign(1, c) * answer(Power(abs(c), n)) for c, n in self._powers))

    @property
    def branches(self) -> tuple[Branch, ...]:
        reach = 1e-17 ** max(1.0, 1 / self._powers[0][1])
        return (
            Branch(
                0.0,
                lambda x, _s, _index: self.dg(x),
                reach=max(reach, 1e-280),
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
        def summed(tolerance: float) -> tuple[Array, float]:
            """The sum of the terms, each to the tolerance, and how much larger they are than it."""
            total = np.zeros(np.broadcast_shapes(coordinate.shape, radius.shape))
            size = np.zeros(total.shape)
            for c, n in self._powers:
                scale = modulus * kappa(n) / np.pi * power_slope(c, coordinate, n)
                moment = power_moment(n - 1, coordinate, radius, tolerance, width, inner)
                term = scale * np.where(np.isinf(moment), 0.0, moment)
                total += term
                size += np.abs(term)
            if all(c > 0 for c, _ in self._powers):
                return total, 1.0
            with np.errstate(divide="ignore", invalid="ignore"):
                return total, float(np.nanmax(size / np.abs(total), initial=1.0))

        total, lost = summed(rtol)
        if lost > _LITTLE:
            total, _ = summed(max(rtol / lost, _FINEST))
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


def _log_radius_of(powers: tuple[tuple[float, float], ...], goal: float, last: float) -> float:
    """The logarithm of the radius where log(sum c r^e) = goal, within the range of doubles."""

    def excess(u: float) -> float:
        top = max(log(abs(c)) + e * u for c, e in powers)
        rest = _sign_at(powers, u)
        return top - goal + (log(rest) if rest > 0 else -LARGEST_HELD)

    if excess(last) <= 0:
        return last
    if excess(-_LOG_FARTHEST) >= 0:
        return -_LOG_FARTHEST
    return float(brentq(excess, -_LOG_FARTHEST, last, xtol=1e-6))


def _without_zeros(powers: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """The terms whose coefficient has not sunk below the smallest double."""
    return tuple((c, e) for c, e in powers if c != 0)


def _first_fall(powers: tuple[tuple[float, float], ...]) -> float:
    """Smallest r >= 0 beyond which sum c r^e, ascending in e, falls below zero, or infinity."""
    if powers[0][0] < 0:
        return 0.0
    ends = [*_log_roots(powers), inf]
    for start, end in pairwise(ends):
        middle = start + 1 if end == inf else (start + end) / 2
        if _sign_at(powers, middle) < 0:
            return exp(start) if start < _LOG_LARGEST else inf
    return inf


def _sign_at(powers: tuple[tuple[float, float], ...], u: float) -> float:
    """Sum of c r^e at r = exp(u), over its largest term: its sign, always within range."""
    logs = [log(abs(c)) + e * u for c, e in powers]
    top = max(logs)
    return sum(copysign(exp(part - top), c) for part, (c, _) in zip(logs, powers, strict=True))


def _log_roots(powers: tuple[tuple[float, float], ...]) -> list[float]:
    """All u where sum c exp(e u) vanishes and changes sign, ascending.

    Divided by its lowest power and differentiated, the sum loses one term (Rolle): between the
    roots of that derivative it is monotone, so each stretch holds at most one root.
    """
    if len(powers) == 1:
        return []
    lowest = powers[0][1]
    derivative = tuple((c * (e - lowest), e - lowest) for c, e in powers[1:])
    low, high = _log_bounds(powers)
    turns = [low, *(u for u in _log_roots(derivative) if low < u < high), high]
    return [
        float(brentq(lambda u: _sign_at(powers, u), start, end, xtol=1e-15))
        for start, end in pairwise(turns)
        if _sign_at(powers, start) * _sign_at(powers, end) < 0
    ]


def _worst_cancelling(powers: tuple[tuple[float, float], ...], places: Array) -> float:
    """Largest sum |c| r^e / |sum c r^e| - 1 over log(r)."""
    sizes = np.array([log(abs(c)) + e * places for c, e in powers])
    terms = np.exp(sizes - sizes.max(axis=0))
    total = np.abs((terms * np.sign([[c] for c, _ in powers])).sum(axis=0))
    return float((terms.sum(axis=0) / np.maximum(total, _EPS)).max() - 1)


def _log_bounds(powers: tuple[tuple[float, float], ...]) -> tuple[float, float]:
    """Logarithms of radii within which every root lies.

    Below the first the lowest power outweighs all others together, above the second the highest.
    """
    count = log(len(powers))

    def crossing(one: tuple[float, float], other: tuple[float, float]) -> float:
        return (log(abs(one[0])) - log(abs(other[0])) - count) / (other[1] - one[1])

    low = min(crossing(powers[0], other) for other in powers[1:])
    high = max(crossing(powers[-1], other) for other in powers[:-1])
    return low - 1, high + 1
