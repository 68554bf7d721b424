"""Tables of known bodies: accepted by default, with the error order of their interpolation."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields
from mdr_core.normal import solve
from mdr_core.profiles import Tabulated

if TYPE_CHECKING:
    from collections.abc import Callable

    Array = np.ndarray

#: End of the tables, a contact radius that is not a table point, and a radius inside it.
END, A, R = 0.7, 0.531, 0.317
#: Orders of the error in depth and force, and in the pressure: a spline's slope has an error of
#: O(h^3), which an integral averages by half an order. The error of the slope is h^3 f""/6 times
#: the Bernoulli polynomial B_3, and that of the depth sqrt(a/2) h^3.5 f""/6 times 0.039: relative
#: to (h/a)^3.5, 0.5 for r^6 and less for the other bodies.
OF_LOAD, OF_PRESSURE = 3.5, 3.0


class Body(NamedTuple):
    """f as a function of double radii, f' and (r f')' as functions of mpmath radii."""

    f: Callable[[Array], Array]
    df: Callable[[mpf], mpf]
    source: Callable[[mpf], mpf]


def power(n: float) -> Body:
    return Body(lambda r: r**n, lambda r: n * r ** (n - 1), lambda r: n * n * r ** (n - 1))


BODIES = {
    "hyperboloid": Body(
        lambda r: r * r / (1 + np.sqrt(1 + r * r)),
        lambda r: r / mp.sqrt(1 + r * r),
        lambda r: (2 * r + r**3) / (1 + r * r) ** mpf("1.5"),
    ),
    "sphere": Body(
        lambda r: r * r / (1 + np.sqrt(1 - r * r)),
        lambda r: r / mp.sqrt(1 - r * r),
        lambda r: (2 * r - r**3) / (1 - r * r) ** mpf("1.5"),
    ),
    "logarithm": Body(
        lambda r: np.log1p(r * r),
        lambda r: 2 * r / (1 + r * r),
        lambda r: 4 * r / (1 + r * r) ** 2,
    ),
    "tanh^2": Body(
        lambda r: np.tanh(r) ** 2,
        lambda r: 2 * mp.tanh(r) * mp.sech(r) ** 2,
        lambda r: 2 * mp.sech(r) ** 2 * (mp.tanh(r) + r * (mp.sech(r) ** 2 - 2 * mp.tanh(r) ** 2)),
    ),
    "gaussian": Body(
        lambda r: -np.expm1(-r * r),
        lambda r: 2 * r * mp.exp(-r * r),
        lambda r: 4 * r * (1 - r * r) * mp.exp(-r * r),
    ),
    "cosh": Body(lambda r: 2 * np.sinh(r / 2) ** 2, mp.sinh, lambda r: mp.sinh(r) + r * mp.cosh(r)),
    "cos": Body(lambda r: 2 * np.sin(r / 2) ** 2, mp.sin, lambda r: mp.sin(r) + r * mp.cos(r)),
    **{f"r^{n}": power(n) for n in (1.5, 2.5, 3, 4, 6)},
}


@pytest.mark.every(4)
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_error_order_of_a_smooth_table(body: Body) -> None:
    a = mpf(A)
    with mp.workdps(20):
        depth = float(a * mp.quad(lambda t: body.df(a * mp.sin(t)), [0, mp.pi / 2]))
        mean = mp.quad(lambda t: mp.sin(t) ** 2 * body.df(a * mp.sin(t)), [0, mp.pi / 2])
        force = float(2 * a * a * mean)
    # int_R^A g'/sqrt(x^2 - R^2) dx in y = sqrt(x^2 - R^2), g' = int (r f')' dt, r = x sin t.
    root = mp.sqrt((a - R) * (a + R))

    def slope_over_x(y: mpf) -> mpf:
        x = mp.hypot(R, y)
        return mp.quad(lambda t: body.source(x * mp.sin(t)), [0, mp.pi / 2], maxdegree=4) / x

    pressure = float(mp.quad(slope_over_x, [0, root], maxdegree=4) / mp.pi)
    for intervals in (10, 20, 50, 100, 400):
        r = np.linspace(0, END, intervals + 1)
        contact = solve(Tabulated(r, body.f(r)), 1.0, contact_radius=A)
        assert not {notice.code for notice in contact.warnings} & {"interpolation", "rough_table"}
        step = END / intervals / A
        assert contact.indentation_depth == pytest.approx(depth, rel=step**OF_LOAD, abs=0)
        assert contact.normal_force == pytest.approx(force, rel=step**OF_LOAD, abs=0)
        result = fields.pressure(contact, [R])[0]
        assert abs(result - pressure) <= step**OF_PRESSURE * float(contact.mean_pressure)
