"""Methods for the 1000 values of a chart: MDR and the reference codes, each over its resolutions.

Preparations of a reference code that are independent of the profile (matrices, bases, grid plans)
are made in advance and not timed; openAbel is also shown with its plan included.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import openabel
from abel import basex, dasch, daun, direct, hansenlaw
from cases import EDGE, RADII, Array, Case
from scipy.integrate import quad, quad_vec
from substitutions import both_roots_removed, one_root_removed

from mdr_core import fields, normal, tangential

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

BARE = "bare Hertz in NumPy"


@dataclass(frozen=True)
class MethodRun:
    """One method at one resolution."""

    method: str
    resolution: str
    run: Callable[[], Array]
    is_mdr: bool = False

    @property
    def name(self) -> str:
        return f"{self.method}, {self.resolution}"


def method_runs(case: Case, quantity: str) -> Iterator[MethodRun]:
    """All methods for "pressure" or "traction"."""
    stick = case.stick if quantity == "traction" else 0.0
    yield MethodRun(BARE, "closed form", _bare)
    yield from _mdr(case, quantity)
    yield from _scipy(case, stick)
    yield from _tanh_sinh(case, stick)
    yield from _pyabel(case, stick)
    yield from _openabel(case, stick)


def _bare() -> Array:
    return 2 / np.pi * np.sqrt((EDGE - RADII) * (EDGE + RADII))


def _mdr(case: Case, quantity: str) -> Iterator[MethodRun]:
    known = case.product_profile()
    table = case.profile["kind"] == "tabulated"
    route = {"paraboloid": "closed form", "cone": "closed form", "tabulated": "piecewise moments"}
    method = f"MDR, {route.get(case.profile['kind'], 'series or quadrature')}"
    contact = normal.solve(known, 1.0, contact_radius=EDGE)
    yield MethodRun(method, "rounding error", _field(quantity, contact, case.stick), is_mdr=True)
    if table:

        def with_setup() -> Array:
            """Includes the fit of the points in every call."""
            contact = normal.solve(case.product_profile(), 1.0, contact_radius=EDGE)
            return _field(quantity, contact, case.stick)()

        yield MethodRun("MDR, incl. table setup", "rounding error", with_setup, is_mdr=True)


def _field(quantity: str, contact: normal.NormalContact, stick: float) -> Callable[[], Array]:
    if quantity == "pressure":
        return lambda: fields.pressure(contact, RADII)
    pushed = tangential.solve(contact, 1.0, 1.0, stick_radius=stick)
    return lambda: fields.shear_stress(pushed, RADII)


def _scipy(case: Case, stick: float) -> Iterator[MethodRun]:
    # A table's g' has too many kinks for quad_vec, which stops at this number of intervals.
    table = case.scalar is None
    for epsrel in (1e-3, 1e-6) if table else (1e-3, 1e-6, 1e-9, 1e-12):
        for name, form in (
            ("scipy quad_vec, t² = x² − r²", one_root_removed),
            ("scipy quad_vec, x − max(r, b, c) ~ u²", both_roots_removed),
        ):

            def vectors(epsrel: float = epsrel, form: Callable = form) -> Array:
                integrand = form(case.slope, RADII, EDGE, case.b, stick)
                value, _ = quad_vec(
                    integrand,
                    0.0,
                    1.0,
                    epsabs=0.0,
                    epsrel=epsrel,
                    norm="max",
                    limit=20 if table else 10_000,
                )
                return value / np.pi

            yield MethodRun(name, f"epsrel {epsrel:.0e}", vectors)
    if case.scalar is not None:
        for epsrel in (1e-3, 1e-6, 1e-10):
            yield MethodRun(
                "scipy quad, t² = x² − r²",
                f"epsrel {epsrel:.0e}",
                lambda epsrel=epsrel: _loop(case, stick, epsrel),
            )


def _loop(case: Case, stick: float, epsrel: float) -> Array:
    """One call of `quad` per radius, with the functions of `math`, which is fastest."""
    slope, b, low = case.scalar, case.b, max(case.b, stick)
    found = []
    for r in RADII.tolist():

        def integrand(t: float, r: float = r) -> float:
            x = math.sqrt(t * t + r * r)
            return slope(x, x - b) / x

        start = math.sqrt((low - r) * (low + r)) if low > r else 0.0
        end = math.sqrt((EDGE - r) * (EDGE + r))
        found.append(quad(integrand, start, end, epsabs=0.0, epsrel=epsrel, limit=200)[0])
    return np.array(found) / np.pi


def _tanh_sinh(case: Case, stick: float) -> Iterator[MethodRun]:
    for level in range(5):
        nodes = _rule(level)
        yield MethodRun(
            "tanh-sinh in NumPy",
            f"{nodes[0].size} nodes",
            lambda nodes=nodes: _transformed(case, stick, *nodes),
        )


@cache
def _rule(level: int) -> tuple[Array, Array]:
    """Nodes on [0, 1] as distances from 0, as small as 1e-32, and their weights."""
    step = 1.0 / 2**level
    u = step * np.arange(-int(3.2 / step), int(3.2 / step) + 1)
    v = math.pi / 2 * np.sinh(u)
    return 1 / (1 + np.exp(-2 * v)), step * math.pi / 4 * np.cosh(u) / np.cosh(v) ** 2


def _transformed(case: Case, stick: float, nodes: Array, weights: Array) -> Array:
    low = np.maximum(RADII, max(case.b, stick))
    step = np.multiply.outer(nodes, EDGE - low)
    x = low + step
    values = case.slope(x, (low - case.b) + step)
    values /= np.sqrt(((low - RADII) + step) * (x + RADII))
    return (weights @ values) * (EDGE - low) / np.pi


def _grid(points: int) -> Array:
    return np.linspace(0.0, EDGE, points)


def _at_radii(points: int, values: Array) -> Array:
    """The radii are points of grids of 2000, 4000, ... intervals; otherwise interpolate."""
    values = np.ravel(values)
    if (points - 1) % 2000:
        return np.interp(RADII, _grid(points), values)
    part = (points - 1) // 2000
    return values[part :: 2 * part]


@cache
def _operator(method: str, points: int) -> Array:
    """Matrix of one of Dasch's methods; PyAbel itself caches only the last one."""
    return dasch.get_bs_cached(method, points, basis_dir=None)


def _dasch(method: str) -> Callable[[Array, float], Array]:
    return lambda q, dr: dasch.dasch_transform(q, _operator(method, q.shape[-1])) / dr


_PYABEL: dict[str, tuple[Callable[[Array, float], Array], tuple[int, ...]]] = {
    "two_point": (_dasch("two_point"), (251, 1001, 2001)),
    "three_point": (_dasch("three_point"), (251, 1001, 2001)),
    "hansenlaw": (
        lambda q, dr: hansenlaw.hansenlaw_transform(q, dr=dr),
        (251, 1001, 2001, 10001),
    ),
    "direct": (lambda q, dr: direct.direct_transform(q, dr=dr), (251, 1001, 2001)),
    # Their bases take minutes at 2001 points, and only one is cached.
    "basex": (
        lambda q, dr: basex.basex_transform(q, dr=dr, basis_dir=None, verbose=False),
        (1001,),
    ),
    "daun": (
        lambda q, dr: daun.daun_transform(q, dr=dr, degree=3, basis_dir=None, verbose=False),
        (1001,),
    ),
}


def _pyabel(case: Case, stick: float) -> Iterator[MethodRun]:
    """Inverse transforms of the foundation's load min(q(x), q(c)), which vanishes at a."""
    for name, (transform, sizes) in _PYABEL.items():
        for points in sizes:

            def run(transform: Callable = transform, points: int = points) -> Array:
                g = case.equivalent_profile(_grid(points))
                if stick:
                    np.maximum(g, g[round(stick * (points - 1))], out=g)
                answer = transform((g[-1] - g)[None], EDGE / (points - 1))
                return _at_radii(points, answer)

            yield MethodRun(f"PyAbel {name}", f"{points} points", run)


@cache
def _plan(points: int, order: int, end: float) -> openabel.Abel:
    return openabel.Abel(points, 2, 0.0, end / (points - 1), method=3, order=order)


def _openabel(case: Case, stick: float) -> Iterator[MethodRun]:
    """Its transform of a given derivative, here g'; in partial slip the difference for a and c."""
    for order in (2, 5):
        for points in (251, 1001, 2001, 10001):

            def run(order: int = order, points: int = points, plan: Callable = _plan) -> Array:
                x = _grid(points)
                slope = np.ascontiguousarray(case.slope(x, x - case.b))
                answer = plan(points, order, EDGE).execute(slope)
                if stick:
                    inside = round(stick * (points - 1)) + 1
                    answer = np.array(answer)
                    answer[:inside] -= plan(inside, order, stick).execute(slope[:inside])
                # openAbel computes -(1/pi) int F'(x)/sqrt(x^2 - r^2) dx from a given F'.
                return -_at_radii(points, answer)

            yield MethodRun(f"openAbel, order {order}", f"{points} points", run)

            def planned(run: Callable = run) -> Array:
                return run(plan=_plan.__wrapped__)

            yield MethodRun(f"openAbel incl. plan, order {order}", f"{points} points", planned)
