"""Reference results for partial slip: the tangential problem and the fields over the radius.

A body is a sequence of panels. On each panel the equivalent profile g is smooth in s = sqrt(x^2 -
k^2), where k is the panel's left end: the break of a shape, or zero. Every
integral is taken in s, or in an angle or a hyperbolic angle of s that removes the kernel's
singularity, panel by panel.

Differences such as g(a) - g(c) are formed directly, with `WORK_DIGITS` digits: more than forty
remain for a slip annulus of 1e-16 a and for the last 1e-9 of a rounded edge. The stick radius c is
solved for with the same digits and verified by a change of sign at `SIGN_DIGITS` digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

from tests.oracles.reference import contact_radius, integral
from tests.oracles.shapes import FlatPunch, Monomials, Shape, shape_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

#: Digits of values and their differences, and of quadrature rules.
WORK_DIGITS = 110
RULE_DIGITS = 42
#: Digits to which a root is verified.
SIGN_DIGITS = 75

CONTROLS = ("tangential_force", "tangential_displacement", "stick_radius")
OUTPUTS = (
    "tangential_force",
    "tangential_displacement",
    "stick_radius",
    "slip_width",
    "tangential_stiffness",
    "dissipated_energy",
)


@dataclass(frozen=True)
class Panel:
    """An interval k <= x on which g and dg are smooth in s = sqrt(x^2 - k^2)."""

    k: mpf
    low: mpf
    high: mpf
    g: Callable[[mpf, mpf], mpf]
    dg: Callable[[mpf, mpf], mpf]

    def x(self, s: mpf) -> mpf:
        return mp.sqrt(self.k**2 + s**2) if self.k else s

    def s(self, x: mpf) -> mpf:
        return mp.sqrt((x - self.k) * (x + self.k))

    def equivalent_profile(self, s: mpf) -> mpf:
        return self.g(self.x(s), s)

    def slope(self, s: mpf) -> mpf:
        """dg/ds."""
        x = self.x(s)
        return self.dg(x, s) * s / x

    def ratio(self, s: mpf) -> mpf:
        """dx/ds."""
        return s / self.x(s) if self.k else mpf(1)


class ShapeBody:
    """A shape of the catalogue: one panel, or two with a break between them."""

    def __init__(self, profile: Mapping[str, Any]) -> None:
        self.shape: Shape = shape_of(profile)
        self.g, self.dg, self.force = self.shape.g, self.shape.dg, self.shape.force
        self.f, self.blunt, self.b = self.shape.f, self.shape.blunt, self.shape.b

    def radius(self, control: str, reduced: mpf) -> mpf:
        return contact_radius(self.shape, control, reduced)[0]

    def panels(self, low: mpf, high: mpf) -> Iterator[Panel]:
        shape, b = self.shape, self.shape.b
        if low < b:
            yield Panel(
                mpf(0),
                low,
                min(b, high),
                lambda x, s: shape.inner_g(x),
                lambda x, s: shape.inner_dg(x),
            )
        if high > b:
            start = max(low, b)
            yield Panel(b, start, high, shape.outer_g, shape.outer_dg)

    def integrate(self, fn: Callable[[mpf], mpf], low: mpf, high: mpf) -> mpf:
        """Integrate by the tanh-sinh rule, with integrands at full precision."""
        if low == high:
            return mpf(0)
        width = high - low

        def unit(u: mpf) -> mpf:
            with mp.workdps(WORK_DIGITS):
                return fn(low + width * u)

        with mp.workdps(RULE_DIGITS):
            return width * integral(unit, [mpf(0), mpf(1)])

    def unknown(self, x: mpf) -> Callable[[mpf], tuple[mpf, mpf]]:
        """x and dx/dw for w = log s beyond a break below `x`, else for w = log x."""
        b, limit = self.b, self.shape.limit

        def beyond(w: mpf) -> tuple[mpf, mpf]:
            square = mp.exp(2 * w)
            radius = mp.sqrt(b**2 + square)
            return radius, square / radius

        def plain(w: mpf) -> tuple[mpf, mpf]:
            return mp.exp(w), mp.exp(w)

        def bounded(w: mpf) -> tuple[mpf, mpf]:
            angle = mp.exp(w)
            tangent = mp.tanh(angle)
            return limit * tangent, limit * (1 - tangent**2) * angle

        if 0 < b < x:
            return beyond
        return bounded if mp.isfinite(limit) else plain

    def start(self, x: mpf) -> mpf:
        if 0 < self.b < x:
            return mp.log(self.shape.beyond(x))
        return (
            mp.log(mp.atanh(x / self.shape.limit)) if mp.isfinite(self.shape.limit) else mp.log(x)
        )


def invert(body: ShapeBody, fn: Callable[[mpf], mpf], slope: Callable[[mpf], mpf], goal: mpf,
           upper: mpf) -> mpf:  # fmt: skip
    """The x < upper with fn(x) = goal > 0, by bracketed Newton's method in logarithms."""
    low_break = body.b if not body.blunt else mpf(0)
    top = low_break if low_break and low_break < upper and fn(low_break) >= goal else upper
    radius = body.unknown(top)
    target = mp.log(goal)

    def excess(w: mpf) -> mpf:
        return mp.log(fn(radius(w)[0])) - target

    high = low = body.start(top)
    step = mpf(1)
    while excess(low) > 0:
        low, step = low - step, 2 * step
    root = _newton(excess, lambda w: _log_slope(fn, slope, radius(w)), low, high)
    margin = mpf(10) ** -SIGN_DIGITS
    if not excess(root - margin) < 0 < excess(root + margin):
        raise ArithmeticError("the stick radius is not bracketed to the required digits")
    return radius(root)[0]


def _log_slope(fn: Callable[[mpf], mpf], slope: Callable[[mpf], mpf], at: tuple[mpf, mpf]) -> mpf:
    return slope(at[0]) * at[1] / fn(at[0])


def _newton(excess: Callable[[mpf], mpf], rate: Callable[[mpf], mpf], low: mpf, high: mpf) -> mpf:
    w = high
    for _ in range(500):
        value = excess(w)
        low, high = (low, w) if value > 0 else (w, high)
        moved = w - value / rate(w)
        if not low <= moved <= high:
            moved = (low + high) / 2
        if abs(moved - w) < mpf(10) ** (-SIGN_DIGITS - 5):
            return moved
        w = moved
    raise ArithmeticError("Newton's method did not converge")


@dataclass(frozen=True)
class Setting:
    """Contact (edge a, depth, reduced force) and material; all to `WORK_DIGITS` digits."""

    body: ShapeBody
    a: mpf
    depth: mpf
    n: mpf
    e_star: mpf
    g_star: mpf
    mu: mpf
    #: dL/da and L of the load prescribed in the normal problem.
    load_rate: mpf
    load: mpf

    @property
    def shift(self) -> mpf:
        """mu E*/G*: ratio of tangential to normal displacement."""
        return self.mu * self.e_star / self.g_star

    @property
    def flat_punch(self) -> bool:
        return isinstance(self.body, ShapeBody) and isinstance(self.body.shape, FlatPunch)


@dataclass(frozen=True)
class Material:
    e_star: float
    g_star: float
    mu: float


def setting(profile: Mapping[str, Any], control: str, load: float, material: Material) -> Setting:
    """Return the normal contact under one load (at most one control), at full precision."""
    with mp.workdps(WORK_DIGITS):
        body = ShapeBody(profile)
        e_star, g_star, mu = mpf(material.e_star), mpf(material.g_star), mpf(material.mu)
        given = mpf(load)
        reduced = given / e_star if control == "normal_force" else given
        if isinstance(body, ShapeBody) and isinstance(body.shape, FlatPunch):
            a = body.b
            depth = reduced if control == "indentation_depth" else reduced / (2 * a)
            return Setting(body, a, depth, 2 * a * depth, e_star, g_star, mu, mpf(1), mpf(1))
        a = body.radius(control, reduced)
        rates = {
            "contact_radius": mpf(1),
            "indentation_depth": body.dg(a),
            "normal_force": 2 * a * body.dg(a) * e_star,
        }
        depth, n = body.g(a), body.force(a)
        return Setting(body, a, depth, n, e_star, g_star, mu, rates[control], given)


def stick_radius(at: Setting, control: str, given: mpf) -> mpf:
    """c for |F_x| < mu F_N, |u_x| < u_max, or c itself (Eqs. 5.19, 5.20)."""
    body = at.body
    if control == "stick_radius":
        return given
    if control == "tangential_force":
        rest = at.n - abs(given) / (at.mu * at.e_star)
        return invert(body, body.force, lambda x: 2 * x * body.dg(x), rest, at.a)
    return invert(body, body.g, body.dg, at.depth - abs(given) / at.shift, at.a)


def overlap(at: Setting, c: mpf) -> mpf:
    """int_c^a (g(a) - g(x)) (g(x) - g(c)) dx."""
    body, low = at.body, at.body.g(c)
    if isinstance(body, ShapeBody) and isinstance(body.shape, Monomials):
        return _monomial_overlap(body.shape, at.a, c)
    total = mpf(0)
    for panel in body.panels(max(c, body.b) if body.blunt else c, at.a):

        def density(s: mpf, panel: Panel = panel) -> mpf:
            equivalent_profile = panel.equivalent_profile(s)
            return (at.depth - equivalent_profile) * (equivalent_profile - low) * panel.ratio(s)

        total += body.integrate(density, panel.s(panel.low), panel.s(panel.high))
    return total


def _monomial_overlap(shape: Monomials, a: mpf, c: mpf) -> mpf:
    high, low, terms = shape.g(a), shape.g(c), shape.equivalent_terms

    def power(n: mpf) -> mpf:
        return (a ** (n + 1) - c ** (n + 1)) / (n + 1)

    single = mp.fsum(k * power(n) for k, n in terms)
    double = mp.fsum(k * m * power(n + p) for k, n in terms for m, p in terms)
    return (high + low) * single - double - high * low * (a - c)


@dataclass(frozen=True)
class Answer:
    """Results and their condition numbers with respect to the tangential and the normal load."""

    c: mpf
    values: dict[str, mpf]
    condition: dict[str, mpf]
    condition_load: dict[str, mpf]
    #: d log c / d log of the two prescribed values, with the rate of a, for the fields.
    rates: dict[str, mpf]


def values(at: Setting, c: mpf, *, energy: bool = True) -> dict[str, mpf]:
    """Return the results of partial slip with stick radius c, 0 <= c <= a."""
    body = at.body
    result = {
        "tangential_force": at.mu * at.e_star * (at.n - body.force(c)),
        "tangential_displacement": at.shift * (at.depth - body.g(c)),
        "stick_radius": c,
        "slip_width": at.a - c,
        "tangential_stiffness": 2 * at.g_star * c,
    }
    if energy:
        factor = 2 * (at.mu * at.e_star) ** 2 / at.g_star
        result["dissipated_energy"] = factor * overlap(at, c) if c < at.a else mpf(0)
    return result


def gradients(at: Setting, c: mpf) -> dict[str, tuple[mpf, mpf]]:
    """(d/da, d/dc) of each result; the energy is integrated by parts."""
    body, a = at.body, at.a
    slope_a, slope_c = body.dg(a), body.dg(c)
    step, half = at.depth - body.g(c), (at.n - body.force(c)) / 2
    factor = 2 * (at.mu * at.e_star) ** 2 / at.g_star
    force = 2 * at.mu * at.e_star
    return {
        "tangential_force": (force * a * slope_a, -force * c * slope_c),
        "tangential_displacement": (at.shift * slope_a, -at.shift * slope_c),
        "stick_radius": (mpf(0), mpf(1)),
        "slip_width": (mpf(1), mpf(-1)),
        "tangential_stiffness": (mpf(0), 2 * at.g_star),
        "dissipated_energy": (
            factor * slope_a * (a * step - half),
            -factor * slope_c * (half - c * step),
        ),
    }


def solve(at: Setting, control: str, given: float, *, energy: bool = True) -> Answer:
    """Return all results for one prescribed tangential quantity below full slip."""
    with mp.workdps(WORK_DIGITS):
        c = stick_radius(at, control, mpf(given))
        if c == at.a:
            zero = values(at, c, energy=energy)
            return Answer(c, zero, {}, {}, {})
        result, slopes = values(at, c, energy=energy), gradients(at, c)
        own_a, own_c = slopes[control]
        own = result[control]
        condition, condition_load = {}, {}
        for name, value in result.items():
            to_a, to_c = slopes[name]
            condition[name] = abs(to_c / own_c * own / value)
            total = to_a - to_c * own_a / own_c
            condition_load[name] = abs(total / at.load_rate * at.load / value)
        rates = {
            "c_given": own / own_c,
            "a_load": at.load / at.load_rate,
            "c_load": -own_a / own_c * at.load / at.load_rate,
        }
        if given < 0:
            for name in CONTROLS[:2]:
                result[name] = -result[name]
        return Answer(c, result, condition, condition_load, rates)


def flat_answer(at: Setting, control: str, given: float) -> dict[str, mpf]:
    """Return the results of a flat punch: full stick or full slip (Eq. 5.33, text at 5.31)."""
    with mp.workdps(WORK_DIGITS):
        stiffness, bound = 2 * at.g_star * at.a, at.mu * at.e_star * at.n
        force = mpf(given) if control == "tangential_force" else mpf(given) * stiffness
        sliding = abs(force) >= bound
        shift = mpf(given) if control == "tangential_displacement" else force / stiffness
        if sliding:
            force = mp.sign(force) * bound
        dissipated = bound * (abs(shift) - bound / stiffness) if sliding else mpf(0)
        answers = (force, shift, mpf(0) if sliding else at.a, at.a if sliding else mpf(0))
        rest = (mpf(0) if sliding else stiffness, dissipated)
        return dict(zip(OUTPUTS, (*answers, *rest), strict=True))


def full_slip(at: Setting, displacement: float) -> dict[str, mpf]:
    """Return the results beyond u_max: in full slip, the excess work is dissipated."""
    with mp.workdps(WORK_DIGITS):
        edge = at.body.b if at.body.blunt else mpf(0)
        result = values(at, edge)
        force, reach = at.mu * at.e_star * at.n, at.shift * at.depth
        sign = 1 if displacement > 0 else -1
        dissipated = result["dissipated_energy"] + force * (abs(mpf(displacement)) - reach)
        answers = (sign * force, mpf(displacement), mpf(0), at.a, mpf(0), dissipated)
        return dict(zip(OUTPUTS, answers, strict=True))


def _abel(body: ShapeBody, panel: Panel, r: mpf) -> mpf:
    """int g'(x)/sqrt(x^2 - r^2) dx over a panel that begins at or beyond r."""
    square = (r - panel.k) * (r + panel.k)
    low, high = panel.s(panel.low), panel.s(panel.high)
    if square == 0:
        return body.integrate(lambda s: panel.slope(s) / s, low, high)
    k = mp.sqrt(abs(square))
    if square > 0:
        begin = mpf(0) if low <= k else mp.acosh(low / k)
        end = mp.acosh(high / k)
        return body.integrate(lambda y: panel.slope(k * mp.cosh(y)), begin, end)
    begin, end = mp.asinh(low / k), mp.asinh(high / k)
    return body.integrate(lambda y: panel.slope(k * mp.sinh(y)), begin, end)


def _singular(at: Setting, c: mpf, r: mpf) -> bool:
    """True if the traction is infinite: at a convex slope discontinuity that slips, or at a tip."""
    body = at.body
    if not isinstance(body, ShapeBody) or not c <= r < at.a:
        return False
    tip = r == 0 and body.b == 0 and body.shape.tip_exponent <= 1
    return tip or (body.shape.jump and r == body.b)


def traction(at: Setting, c: mpf, r: mpf) -> mpf:
    """(E*/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx: p for c = 0, tau/mu else (Eq. 5.18)."""
    with mp.workdps(WORK_DIGITS):
        if r >= at.a or c >= at.a:
            return mpf(0)
        if _singular(at, c, r):
            return mp.inf
        body = at.body
        low = max(r, c, body.b) if body.blunt else max(r, c)
        total = mp.fsum(_abel(body, panel, r) for panel in body.panels(low, at.a))
        return at.e_star / mp.pi * total


def _back(body: ShapeBody, panel: Panel, r: mpf, density: Callable[[mpf], mpf]) -> mpf:
    """int density(s)/sqrt(r^2 - x^2) dx over a panel that ends at or below r."""
    reach = panel.s(r)
    begin = mp.asin(panel.s(panel.low) / reach)
    end = mp.pi / 2 if panel.high == r else mp.asin(panel.s(panel.high) / reach)

    def turned(angle: mpf) -> mpf:
        s = reach * mp.sin(angle)
        return density(s) * panel.ratio(s)

    return body.integrate(turned, begin, end)


def slip(at: Setting, c: mpf, r: mpf) -> mpf:
    """-(mu E*/G*) (2/pi) int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx (Eq. 5.40), 0 outside c..a."""
    with mp.workdps(WORK_DIGITS):
        body = at.body
        low = max(c, body.b) if body.blunt else c
        if r <= low or r > at.a:
            return mpf(0)
        base = body.g(c)
        total = mp.fsum(
            _back(body, panel, r, lambda s, panel=panel: panel.equivalent_profile(s) - base)
            for panel in body.panels(low, r)
        )
        return -at.shift * 2 / mp.pi * total


def displacement(at: Setting, r: mpf) -> mpf:
    """d - f(r) inside, (2/pi) int_0^a (d - g(x))/sqrt(r^2 - x^2) dx outside (Eq. 5.75)."""
    with mp.workdps(WORK_DIGITS):
        if r <= at.a:
            return at.depth - at.body.f(r)
        body, low = at.body, at.body.b if at.body.blunt else mpf(0)
        total = at.depth * mp.asin(low / r)
        for panel in body.panels(low, at.a):
            total += _back(
                body, panel, r, lambda s, panel=panel: at.depth - panel.equivalent_profile(s)
            )
        return total * 2 / mp.pi


def foundation(at: Setting, c: mpf, x: mpf) -> tuple[mpf, mpf]:
    """q(x) and q_x(x) of Eq. (5.23), for a positive force."""
    with mp.workdps(WORK_DIGITS):
        if x > at.a:
            return mpf(0), mpf(0)
        load = at.e_star * (at.depth - at.body.g(x))
        held = at.mu * at.e_star * (at.depth - at.body.g(c))
        return load, held if x <= c else at.mu * load
