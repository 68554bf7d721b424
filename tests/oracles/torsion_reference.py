"""Reference results for torsion with slip, in mpmath.

Rotation, torque and second moment are integrals over dg with closed kernels,

    P = int_c^a K(c/x) dg/x,    M = (8 mu E*/(3 pi)) int_c^a x^2 w(c/x) dg,    int_0^a x^2 dg,

where K(q) has the complementary modulus, and w(q) = q^3 K(q) + 3 int_q^1 y^2 K(y) dy is reduced by
parts to the one integral int_q^1 K dy. The core has no kernel w. Every integral is taken by Gauss's
rule with 48 nodes in ln x, or beyond a break b in arcsinh(sqrt(x^2 - b^2)/b), on pieces no longer
than their distance from a singularity.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf
from mpmath.calculus.quadrature import GaussLegendre

from tests.oracles.shapes import Ellipsoid, Monomials, SphericalTipCone, shape_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from tests.oracles.shapes import Shape

#: Digits of all evaluations: 25 remain in an annulus of 1e-14 a.
DIGITS = 40
#: q up to which 60 terms of a series in q^2 leave these digits.
_SMALL = mpf("0.45")
#: Degree of the rule of mpmath with 48 nodes.
_DEGREE = 5
#: x/a at which an integral to the axis is cut: the rest of x^2 dg is below 1e-20 of it.
_AXIS = mpf(10) ** -20


@lru_cache(maxsize=2)
def _rule(prec: int) -> list[tuple[mpf, mpf]]:
    return list(GaussLegendre(mp).calc_nodes(_DEGREE, prec))


def _nodes(low: mpf, high: mpf, cuts: list[mpf], step: mpf) -> Iterator[tuple[mpf, mpf]]:
    """Nodes and weights on pieces between the ends and the cuts, no longer than the step."""
    ends = sorted([low, high, *(cut for cut in cuts if low < cut < high)])
    for start, end in pairwise(ends):
        pieces = max(1, int(mp.ceil((end - start) / step)))
        half = (end - start) / pieces / 2
        for piece in range(pieces):
            for node, weight in _rule(mp.prec):
                yield start + half * (2 * piece + 1 + node), half * weight


def first_kind(q: mpf) -> mpf:
    """K(q), the complete elliptic integral with the complementary modulus q."""
    return mp.ellipk(1 - q * q)


def second_kind(q: mpf) -> mpf:
    """E(q), likewise."""
    return mp.ellipe(1 - q * q)


@lru_cache(maxsize=100_000)
def integral_of_first_kind(q: mpf) -> mpf:
    """int_q^1 K dy, by quadrature or, for small q, as pi^2/4 less a series.

    K = sum a_n q^2n (ln(4/q) - b_n), with the coefficients of Byrd and Friedman, 900.06.
    """
    if q > _SMALL:
        pieces = _nodes(mp.log(q), mpf(0), [], 1)
        return mp.fsum(weight * mp.exp(v) * first_kind(mp.exp(v)) for v, weight in pieces)
    total, term, a, b, n = mp.pi**2 / 4, mpf(1), mpf(1), mpf(0), 0
    while abs(term) > mp.eps:
        odd = 2 * n + 1
        term = a * q**odd / odd * (mp.log(4 / q) - b + mpf(1) / odd)
        total -= term
        n += 1
        a *= (mpf(2 * n - 1) / (2 * n)) ** 2
        b += mpf(2) / ((2 * n - 1) * 2 * n)
    return total


def torque_kernel(q: mpf) -> mpf:
    """w(q) = (3/4) [int_q^1 K dy + q (K + E)] - q^3 K/2."""
    k = first_kind(q)
    return 3 * (integral_of_first_kind(q) + q * (k + second_kind(q))) / 4 - q**3 * k / 2


class Twist:
    """Torsion of a contact of a radius with a profile, as the `profile` member of a request."""

    def __init__(self, profile: Mapping[str, Any], radius: mpf) -> None:
        self.shape: Shape = shape_of(profile)
        self.radius = mpf(radius)

    def rotation(self, c: mpf) -> mpf:
        """P(c) [1]."""
        return self._over(c, lambda x: first_kind(c / x) / x)

    def moment(self, c: mpf) -> mpf:
        """Torque over 8 mu E*/(3 pi) [length^3]."""
        return self._over(c, lambda x: x * x * torque_kernel(c / x))

    def second_moment(self) -> mpf:
        """int x^2 dg [length^3]."""
        return self._over(_AXIS * self.radius, lambda x: x * x)

    def work(self, c: mpf) -> mpf:
        """int_c^a y^2 P(y) (P(c) - P(y)) dy [length^3]."""
        whole, total = self.rotation(c), mpf(0)
        for x, s, weight, _ in self._places(c):
            part = self.rotation(x)
            total += weight * s * x * x * part * (whole - part)
        return total

    def _over(self, c: mpf, kernel: Callable[[mpf], mpf]) -> mpf:
        """int_c^a kernel dg."""
        shape = self.shape
        return mp.fsum(
            weight * s * kernel(x) * (shape.outer_dg(x, s) if beyond else shape.inner_dg(x))
            for x, s, weight, beyond in self._places(c)
            if beyond or not shape.blunt
        )

    def _places(self, c: mpf) -> Iterator[tuple[mpf, mpf, mpf, bool]]:
        """x, s = dx/dv, weight of dv, and whether x lies beyond the break."""
        shape, b, a = self.shape, self.shape.b, self.radius
        step = mpf(1)
        if isinstance(shape, Monomials):
            step = min(step, 6 / max(n for _, n in shape.terms))
        tip = b == 0 or c < b
        if tip:
            end = a if b == 0 else min(a, b)
            for v, weight in _nodes(mp.log(c), mp.log(end), self._poles(), step):
                yield mp.exp(v), mp.exp(v), weight, b == 0
        if b > 0 and a > b:
            low = mpf(0) if tip else mp.asinh(shape.beyond(c) / b)
            cuts = []
            if isinstance(shape, SphericalTipCone):
                # Singular at s = -h.
                cuts = [mp.asinh(shape.h / b * mpf(2) ** k) for k in range(-4, 60)]
            for v, weight in _nodes(low, mp.asinh(shape.beyond(a) / b), cuts, step):
                yield b * mp.cosh(v), b * mp.sinh(v), weight, True

    def _poles(self) -> list[mpf]:
        """Cuts next to the equator of a spheroid, where g' has a pole."""
        tip = self.shape.tip if isinstance(self.shape, SphericalTipCone) else self.shape
        if not isinstance(tip, Ellipsoid):
            return []
        return [mp.log(tip.limit * (1 - mpf(2) ** -k)) for k in range(1, 40)]
