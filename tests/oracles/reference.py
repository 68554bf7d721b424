"""Reference results by mpmath: quadrature of f', and equivalent, faster closed forms.

``quad_*`` are the definitions: g from f' (Eq. 5.74), d = g(a), N = F_N/E* = 2 int x g' dx in terms
of f', all in the angle r = x sin t and split at the break. ``state`` and ``pressure`` are stored in
the bank; they use the closed forms of ``shapes``, which ``test_proofs`` compares with ``quad_*``.
All arguments are mpf converted from the exact doubles of a case.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

from tests.oracles.shapes import FlatPunch, Monomials, Shape, shape_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

#: Digits of closed forms: sphere and rounded punch lose up to about 30 by cancellation.
CLOSED_DIGITS = 80
#: Digits of quadrature.
QUAD_DIGITS = 50
#: Largest accepted relative error estimate of a quadrature.
QUAD_BOUND = mpf(10) ** -34

#: Digits of every root, verified by a change of sign.
ROOT_DIGITS = 42

CONTROLS = ("indentation_depth", "normal_force", "contact_radius")
OUTPUTS = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "mean_pressure",
    "normal_stiffness",
    "elastic_energy",
)


def integral(fn: Callable[[mpf], mpf], points: list[mpf]) -> mpf:
    """Integrate by the tanh-sinh rule; raise if the requested digits are not reached.

    mpmath's stopping rule is absolute, so each piece is first scaled to unit width and height.
    """
    total, doubt = mpf(0), mpf(0)
    for low, high in itertools.pairwise(points):
        width = high - low
        height = max(abs(fn(low + width * u)) for u in (mpf(1) / 8, mpf(1) / 2, mpf(15) / 16))
        if height == 0:
            continue

        def unit(u: mpf, low: mpf = low, width: mpf = width, height: mpf = height) -> mpf:
            return fn(low + width * u) / height

        value, error = mp.quad(unit, [0, 1], error=True, maxdegree=10)
        total += value * width * height
        doubt += error * width * height
    if doubt > QUAD_BOUND * abs(total):
        raise ArithmeticError(f"quadrature error {mp.nstr(doubt / total, 3)}")
    return total


def _over_angle(shape: Shape, x: mpf, weight: Callable[[mpf], mpf]) -> mpf:
    """int_0^{pi/2} weight(sin t) f'(x sin t) dt, with t = v^m for tips sharper than r."""
    m = 1 if shape.tip_exponent >= 1 else int(mp.ceil(2 / shape.tip_exponent))

    def integrand(v: mpf) -> mpf:
        sine = mp.sin(v**m)
        return weight(sine) * shape.df(x * sine) * m * v ** (m - 1)

    ends = [mpf(0), (mp.pi / 2) ** (mpf(1) / m)]
    if 0 < shape.b < x:
        ends.insert(1, mp.atan2(shape.b, shape.beyond(x)) ** (mpf(1) / m))
    if shape.blunt:
        ends = ends[1:]
    return integral(integrand, ends)


def quad_g(shape: Shape, x: mpf) -> mpf:
    """g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr, Eq. (5.74)."""
    if shape.blunt and x <= shape.b:
        return mpf(0)
    return x * _over_angle(shape, x, lambda sine: mpf(1))


def quad_dg(shape: Shape, x: mpf) -> mpf:
    """g'(x), the numerical derivative of ``quad_g``."""
    return mp.diff(lambda y: quad_g(shape, y), x)


def quad_force(shape: Shape, a: mpf) -> mpf:
    """N(a) = F_N/E* = 2 a^2 int_0^{pi/2} sin^2 t f'(a sin t) dt."""
    if shape.blunt and a <= shape.b:
        return mpf(0)
    return 2 * a**2 * _over_angle(shape, a, lambda sine: sine**2)


def energy(shape: Shape, a: mpf, s: mpf | None = None) -> mpf:
    """U/E* = int_0^a (d - g)^2 dx: elastic energy of the foundation springs."""
    d = shape.g(a, s)
    b = shape.b
    top = s if s is not None else (shape.beyond(a) if a > b else mpf(0))

    def inner(x: mpf) -> mpf:
        return (d - shape.inner_g(x)) ** 2

    def outer(v: mpf) -> mpf:
        x = mp.sqrt(b**2 + v**2)
        return (d - shape.outer_g(x, v)) ** 2 * v / x

    if isinstance(shape, Monomials):
        return _monomial_energy(shape, a)
    if b == 0:
        return integral(lambda x: (d - shape.g(x)) ** 2, [mpf(0), a])
    if a <= b:
        return integral(inner, [mpf(0), a])
    below = d**2 * b if shape.blunt else integral(inner, [mpf(0), b])
    return below + integral(outer, [mpf(0), top])


def _monomial_energy(shape: Monomials, a: mpf) -> mpf:
    d = shape.g(a)
    single = mp.fsum(c * a ** (n + 1) / (n + 1) for c, n in shape.equivalent_terms)
    double = mp.fsum(
        c1 * c2 * a ** (n1 + n2 + 1) / (n1 + n2 + 1)
        for c1, n1 in shape.equivalent_terms
        for c2, n2 in shape.equivalent_terms
    )
    return d**2 * a - 2 * d * single + double


def solve_increasing(fn: Callable[[mpf], mpf], target: mpf, start: mpf) -> mpf:
    """Return w with fn(w) = target for an increasing positive fn, verified by a change of sign."""
    goal = mp.log(target)

    def excess(w: mpf) -> mpf:
        return mp.log(fn(w)) - goal

    step, low, high = mpf(1), start, start
    while excess(low) > 0:
        low, step = low - step, 2 * step
    step = mpf(1)
    while excess(high) < 0:
        high, step = high + step, 2 * step
        if step > 1e6:
            raise ArithmeticError("the load exceeds that of the largest contact")
    root = low
    if low != high:
        # The residual is not checked: the change of sign below is the stronger test.
        root = mp.findroot(
            excess,
            (low, high),
            solver="anderson",
            tol=mpf(10) ** (-mp.dps + 15),
            maxsteps=400,
            verify=False,
        )
    margin = mpf(10) ** -ROOT_DIGITS
    if not excess(root - margin) < 0 < excess(root + margin):
        raise ArithmeticError("the root is not bracketed to the required digits")
    return root


def contact_radius(shape: Shape, control: str, reduced: mpf) -> tuple[mpf, mpf | None]:
    """Return the radius (and s = sqrt(a^2 - b^2) if blunt) for a depth, F_N/E* or radius."""
    if control == "contact_radius":
        return reduced, (shape.beyond(reduced) if shape.blunt else None)
    fn = shape.g if control == "indentation_depth" else shape.force
    start = mp.log(shape.b) if shape.b > 0 else mpf(0)
    if isinstance(shape, Monomials) and control == "indentation_depth":
        c, n = shape.equivalent_terms[0]
        start = mp.log(abs(reduced / c)) / n
    return shape.radius_of(solve_increasing(lambda w: fn(*shape.radius_of(w)), reduced, start))


@dataclass(frozen=True)
class State:
    """Results of a case and their relative condition numbers with respect to the load."""

    values: dict[str, mpf]
    condition: dict[str, mpf]


def _flat_punch_state(shape: FlatPunch, control: str, load: mpf, e_star: mpf) -> State:
    a = shape.b
    depth = load if control == "indentation_depth" else load / (2 * a * e_star)
    force = 2 * a * depth * e_star
    values = (
        depth,
        force,
        a,
        force / (mp.pi * a**2),
        2 * a * e_star,
        a * depth**2 * e_star,
    )
    powers = (1, 1, 0, 1, 0, 2)
    return State(
        dict(zip(OUTPUTS, values, strict=True)),
        dict(zip(OUTPUTS, map(mpf, powers), strict=True)),
    )


def elasticities(shape: Shape, a: mpf, s: mpf | None, u: mpf) -> dict[str, mpf]:
    """d log(output)/d log(a), from d' = g', N' = 2 a g' and U' = N g'."""
    slope, d, n = shape.dg(a, s), shape.g(a, s), shape.force(a, s)
    force = 2 * a**2 * slope / n
    rates = (a * slope / d, force, mpf(1), force - 2, mpf(1), a * n * slope / u)
    return dict(zip(OUTPUTS, rates, strict=True))


def state(profile: Mapping[str, Any], control: str, load: float, e_star: float) -> State:
    """Return all results of the normal problem for one load."""
    with mp.workdps(CLOSED_DIGITS):
        shape, given, modulus = shape_of(profile), mpf(load), mpf(e_star)
        if isinstance(shape, FlatPunch):
            return _flat_punch_state(shape, control, given, modulus)
        reduced = given / modulus if control == "normal_force" else given
        a, s = contact_radius(shape, control, reduced)
        d, n = shape.g(a, s), shape.force(a, s)
        with mp.workdps(QUAD_DIGITS):
            u = energy(shape, a, s)
        values = (d, modulus * n, a, modulus * n / (mp.pi * a**2), 2 * modulus * a, modulus * u)
        rates = elasticities(shape, a, s, u)
        return State(
            dict(zip(OUTPUTS, values, strict=True)),
            {name: abs(rate / rates[control]) for name, rate in rates.items()},
        )


def _pressure_beyond(shape: Shape, r: mpf, top: mpf) -> mpf:
    """int g' dx/sqrt(x^2 - r^2) over max(r, b) < x < a, where s(a) = ``top``.

    In terms of s the integral is dg/ds ds/sqrt(s^2 - (r^2 - b^2)). The substitution s = k cosh y or
    k sinh y removes the singularity, and dg/ds is smooth where g' is not.
    """
    b = shape.b

    def slope(s: mpf) -> mpf:
        x = mp.sqrt(b**2 + s**2)
        return shape.outer_dg(x, s) * s / x

    k = mp.sqrt(abs((r - b) * (r + b)))
    if k == 0:
        return integral(lambda s: slope(s) / s, [mpf(0), top])
    if r > b:
        return integral(lambda y: slope(k * mp.cosh(y)), [mpf(0), mp.acosh(top / k)])
    return integral(lambda y: slope(k * mp.sinh(y)), [mpf(0), mp.asinh(top / k)])


def _pressure_below(shape: Shape, r: mpf, end: mpf) -> mpf:
    """Return the integral of g'/sqrt(x^2 - r^2) over r < x < end <= b."""
    if r == 0:
        return integral(lambda x: shape.inner_dg(x) / x, [mpf(0), end])
    return integral(lambda y: shape.inner_dg(r * mp.cosh(y)), [mpf(0), mp.acosh(end / r)])


def pressure(shape: Shape, r: mpf, a: mpf, s: mpf | None = None, depth: mpf | None = None) -> mpf:
    """Return p(r)/E* = (1/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx (Eq. 5.79)."""
    if r >= a:
        return mpf(0) if not isinstance(shape, FlatPunch) or r > a else mp.inf
    if isinstance(shape, FlatPunch):
        return depth / (mp.pi * mp.sqrt((a - r) * (a + r)))
    if isinstance(shape, Monomials) and r == 0:
        if shape.tip_exponent <= 1:
            return mp.inf
        return mp.fsum(c * n * a ** (n - 1) / (n - 1) for c, n in shape.equivalent_terms) / mp.pi
    if shape.jump and r == shape.b:
        return mp.inf
    total = mpf(0)
    if r < shape.b and not shape.blunt:
        total += _pressure_below(shape, r, min(a, shape.b))
    if a > shape.b:
        total += _pressure_beyond(shape, r, shape.beyond(a) if s is None else s)
    return total / mp.pi
