"""Reference results for the limit of fretting wear, Eqs. (5.80)-(5.90), for any shape.

Everything follows from the limiting equivalent profile of Eq. (5.82), g = g_0 for x < c and g = d
for c < x < r_out. The force is its integral, the shape its inverse transform, and the outer radius
the root at which that transform meets the initial shape. The pressure is the transform of its slope
with the jump at c. Panels, digits and quadrature are as in partial slip; condition numbers are
difference quotients for inputs that differ in the 30th digit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from mpmath import mp, mpf

from tests.oracles.slip_reference import (
    SIGN_DIGITS,
    WORK_DIGITS,
    Material,
    Panel,
    Setting,
    ShapeBody,
    _abel,
    invert,
    setting,
    stick_radius,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from typing import Any

OUTPUTS = (
    "stick_radius",
    "wear_width",
    "wear_radius",
    "indentation_depth",
    "normal_force",
    "tangential_displacement",
    "tangential_force",
    "worn_volume",
)
FIELDS = ("worn_depth", "limiting_profile", "pressure")
#: Inputs that differ in this digit have worn annuli that differ by less than `CLOSE`.
NUDGE_DIGITS = 30
CLOSE = mpf(10) ** -18


@dataclass(frozen=True)
class Limit:
    """The stick edge c, d - g(c), and the width of the worn annulus."""

    at: Setting
    c: mpf
    step: mpf
    width: mpf

    @property
    def depth(self) -> mpf:
        return self.at.body.g(self.c) + self.step


def stick_edge(at: Setting, control: str, name: str, given: mpf) -> tuple[mpf, mpf]:
    """c and d - g(c) from the constant load (`control`) and the oscillating one (`name`)."""
    body = at.body
    rest = {
        "tangential_displacement": at.depth - given / at.shift,
        "tangential_force": at.n - given / (at.mu * at.e_star),
    }
    if rest[name] <= 0:
        raise ArithmeticError("no stick zone remains")
    if control == "indentation_depth" and name == "tangential_displacement":
        # Eq. (5.80): c keeps its initial value.
        return stick_radius(at, name, given), given / at.shift
    if control == "normal_force" and name == "tangential_force":
        # F_N(c) = F_N - F_x/mu is constant, and all of F_x acts inside c.
        c = stick_radius(at, name, given)
        return c, given / (2 * at.mu * at.e_star * c)
    if control == "normal_force":
        # Eq. (5.90) for any shape.
        step = given / at.shift
        c = invert(
            body,
            lambda x: body.force(x) + 2 * x * step,
            lambda x: 2 * x * body.dg(x) + 2 * step,
            at.n,
            at.a,
        )
        return c, step
    share = given / (2 * at.mu * at.e_star)
    c = _largest(body, at, share)
    return c, share / c


def _largest(body: ShapeBody, at: Setting, share: mpf) -> mpf:
    """The largest c < a with c (d - g(c)) = share.

    Starting from above, c -> g^-1(d - share/c) decreases monotonically towards the root: c (d - g)
    at the root is at most its value with any larger factor c. Newton's method follows close to it.
    """
    c = at.a
    for _ in range(400):
        goal = at.depth - share / c
        if goal <= 0:
            raise ArithmeticError("no stick zone remains")
        lower = invert(body, body.g, body.dg, goal, at.a)
        near = (c - lower) < c * mpf(10) ** -6
        c = lower
        if near:
            break
    for _ in range(40):
        miss = c * (at.depth - body.g(c)) - share
        moved = c - miss / (at.depth - body.g(c) - c * body.dg(c))
        done, c = abs(moved - c) < c * mpf(10) ** -SIGN_DIGITS, moved
        if done:
            return c
    raise ArithmeticError("the largest stick radius did not converge")


def _parts(at: Setting, c: mpf, r: mpf, density: Callable[[mpf], mpf], *, root: int) -> mpf:
    """int_c^r density(g(x)) sqrt(r^2 - x^2)^root dx, root = 1 or -1, panel by panel."""
    total = mpf(0)
    for panel in _whole(at.body, c, r):
        reach = panel.s(r)
        begin = mp.asin(panel.s(panel.low) / reach)
        end = mp.pi / 2 if panel.high == r else mp.asin(panel.s(panel.high) / reach)

        def turned(angle: mpf, panel: Panel = panel, reach: mpf = reach) -> mpf:
            s = reach * mp.sin(angle)
            weight = (reach * mp.cos(angle)) ** (root + 1)
            return density(panel.equivalent_profile(s)) * panel.ratio(s) * weight

        total += at.body.integrate(turned, begin, end)
    return total


def _zero(_x: mpf, _s: mpf) -> mpf:
    return mpf(0)


def _whole(body: ShapeBody, low: mpf, high: mpf) -> Iterator[Panel]:
    """All panels, including the flat of a blunt shape, where g = 0 and the integrand is nonzero."""
    if body.blunt and low < body.b:
        yield Panel(mpf(0), low, min(body.b, high), _zero, _zero)
        low = body.b
    if high > low:
        yield from body.panels(low, high)


def worn_depth(limit: Limit, r: mpf) -> mpf:
    """(2/pi) int_c^r (d - g)/sqrt(r^2 - x^2) dx (Eqs. 5.75, 5.82), 0 outside the worn annulus."""
    with mp.workdps(WORK_DIGITS):
        if not limit.c < r < limit.c + limit.width:
            return mpf(0)
        return _worn(limit.at, limit.c, limit.step, r)


def _worn(at: Setting, c: mpf, step: mpf, r: mpf) -> mpf:
    """In the form step - (g - g(c)): the first term is elementary, the second vanishes at c."""
    base = at.body.g(c)
    rises = _parts(at, c, r, lambda equivalent_profile: equivalent_profile - base, root=-1)
    return 2 / mp.pi * (step * mp.acos(c / r) - rises)


def _volume(at: Setting, c: mpf, step: mpf, r: mpf) -> mpf:
    """4 int_c^r (d - g) sqrt(r^2 - x^2) dx = 2 pi int (worn depth) r dr, in exchanged order."""
    base, angle = at.body.g(c), mp.acos(c / r)
    rises = _parts(at, c, r, lambda equivalent_profile: equivalent_profile - base, root=1)
    return 4 * (step * (r**2 * angle - c * mp.sqrt((r - c) * (r + c))) / 2 - rises)


def worn_annulus_width(at: Setting, c: mpf, step: mpf, near: mpf | None = None) -> mpf:
    """Width at which the worn depth returns to zero, by a bracketed secant method in log(width).

    `near` is a known width within `CLOSE` of it.
    """

    def worn(w: mpf) -> mpf:
        return _worn(at, c, step, c + mp.exp(w)) / step

    if near is not None:
        ends = mp.log(near) - CLOSE, mp.log(near) + CLOSE
        if worn(ends[0]) > 0 > worn(ends[1]):
            return mp.exp(_illinois(worn, *ends))
    low = high = mp.log(at.a - c) if at.a > c else mp.log(step)
    stride = mpf(1) / 4
    while worn(low) < 0:
        low -= stride
        stride *= 2
    stride = mpf(1) / 4
    end = mp.log(_end(at) - c)
    while True:
        high = min(high + stride, end)
        if worn(high) < 0:
            break
        if high == end:
            raise ArithmeticError("the worn annulus reaches beyond the profile's end")
        stride *= 2
    return mp.exp(_illinois(worn, low, high))


def _end(at: Setting) -> mpf:
    return at.body.shape.limit


def _illinois(fn: Callable[[mpf], mpf], low: mpf, high: mpf) -> mpf:
    """Root of a decreasing fn to 40 digits, the precision of the quadrature rule."""
    at_low, at_high = fn(low), fn(high)
    side = 0
    for _ in range(200):
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        value = fn(middle)
        if value > 0:
            low, at_low = middle, value
            at_high = at_high / 2 if side == 1 else at_high
            side = 1
        else:
            high, at_high = middle, value
            at_low = at_low / 2 if side == -1 else at_low
            side = -1
        if abs(value) < mpf(10) ** -40:
            return middle
    raise ArithmeticError("the outer edge of the worn annulus did not converge")


def solve(profile: Mapping[str, Any], control: str, load: mpf, material: Material,
          name: str, given: mpf, near: mpf | None = None) -> Limit:  # fmt: skip
    with mp.workdps(WORK_DIGITS):
        at = setting(profile, control, load, material)
        c, step = stick_edge(at, control, name, mpf(given))
        return Limit(at, c, step, worn_annulus_width(at, c, step, near))


def answers(limit: Limit) -> dict[str, mpf]:
    with mp.workdps(WORK_DIGITS):
        at, c, r = limit.at, limit.c, limit.c + limit.width
        result = (
            c,
            limit.width,
            r,
            limit.depth,
            at.e_star * (at.body.force(c) + 2 * c * limit.step),
            at.shift * limit.step,
            2 * at.g_star * c * at.shift * limit.step,
            _volume(at, c, limit.step, r),
        )
        return dict(zip(OUTPUTS, result, strict=True))


def pressure(limit: Limit, r: mpf) -> mpf:
    """(E*/pi) [int_r^c g'/sqrt(x^2 - r^2) dx + (d - g(c))/sqrt(c^2 - r^2)]: Eq. (5.79) for q."""
    with mp.workdps(WORK_DIGITS):
        at, c = limit.at, limit.c
        if r >= c:
            return mp.inf if r == c else mpf(0)
        body = at.body
        low = max(r, body.b) if body.blunt else r
        shape = getattr(body, "shape", None)
        if shape is not None and (
            (r == 0 and body.b == 0 and shape.tip_exponent <= 1) or (shape.jump and r == body.b < c)
        ):
            return mp.inf
        inner = mp.fsum(_abel(body, panel, r) for panel in body.panels(low, c) if c > low)
        return at.e_star / mp.pi * (inner + limit.step / mp.sqrt((c - r) * (c + r)))


def field(limit: Limit, name: str, r: mpf) -> mpf:
    if name == "pressure":
        return pressure(limit, r)
    worn = worn_depth(limit, r)
    with mp.workdps(WORK_DIGITS):
        return worn + limit.at.body.f(r) if name == "limiting_profile" else worn
