"""Every way to the 1000 numbers of a chart: ours and the peers', each over its resolutions.

What a peer can prepare without knowing the profile (matrices, bases, plans of its grid) is made
beforehand and not counted; with it openAbel is shown as well.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import openabel
from abel import basex, dasch, daun, direct, hansenlaw
from scenes import EDGE, RADII, Array, Scene
from scipy.integrate import quad, quad_vec
from substitutions import both_roots_removed, one_root_removed

from mdr_core import fields, normal, tangential

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Tolerances that ours is asked for.
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13)
BARE = "bare Hertz in NumPy"


@dataclass(frozen=True)
class Way:
    """One method at one resolution."""

    method: str
    resolution: str
    run: Callable[[], Array]
    ours: bool = False

    @property
    def name(self) -> str:
        return f"{self.method}, {self.resolution}"


def ways(scene: Scene, quantity: str) -> Iterator[Way]:
    """All of them, for "pressure" or "traction"."""
    stick = scene.stick if quantity == "traction" else 0.0
    yield Way(BARE, "closed form", _bare)
    yield from _ours(scene, quantity)
    yield from _scipy(scene, stick)
    yield from _tanh_sinh(scene, stick)
    yield from _pyabel(scene, stick)
    yield from _openabel(scene, stick)


def _bare() -> Array:
    return 2 / np.pi * np.sqrt((EDGE - RADII) * (EDGE + RADII))


def _ours(scene: Scene, quantity: str) -> Iterator[Way]:
    known = scene.made()
    table = scene.profile["kind"] == "tabulated"
    route = {"paraboloid": "closed form", "cone": "closed form", "tabulated": "panel moments"}
    method = f"MDR, {route.get(scene.profile['kind'], 'series or quadrature')}"
    for rtol in TOLERANCES:
        asked = f"rtol {rtol:.0e}"
        contact = normal.solve(known, 1.0, contact_radius=EDGE, rtol=rtol)
        yield Way(method, asked, _field(quantity, contact, scene.stick, rtol), ours=True)
        if table:

            def anew(rtol: float = rtol) -> Array:
                """From the points on: the panels are resolved in every call."""
                contact = normal.solve(scene.made(), 1.0, contact_radius=EDGE, rtol=rtol)
                return _field(quantity, contact, scene.stick, rtol)()

            yield Way("MDR, from the points on", asked, anew, ours=True)


def _field(
    quantity: str, contact: normal.NormalContact, stick: float, rtol: float
) -> Callable[[], Array]:
    if quantity == "pressure":
        return lambda: fields.pressure(contact, RADII, rtol=rtol)
    pushed = tangential.solve(contact, 1.0, 1.0, stick_radius=stick)
    return lambda: fields.shear_stress(pushed, RADII, rtol=rtol)


def _scipy(scene: Scene, stick: float) -> Iterator[Way]:
    # The kinks of a table's g' are too many for it: it stops at so many intervals.
    table = scene.scalar is None
    for epsrel in (1e-3, 1e-6) if table else (1e-3, 1e-6, 1e-9, 1e-12):
        for name, form in (
            ("scipy quad_vec, t² = x² − r²", one_root_removed),
            ("scipy quad_vec, x − max(r, b, c) ~ u²", both_roots_removed),
        ):

            def vectors(epsrel: float = epsrel, form: Callable = form) -> Array:
                integrand = form(scene.slope, RADII, EDGE, scene.b, stick)
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

            yield Way(name, f"epsrel {epsrel:.0e}", vectors)
    if scene.scalar is not None:
        for epsrel in (1e-3, 1e-6, 1e-10):
            yield Way(
                "scipy quad, t² = x² − r²",
                f"epsrel {epsrel:.0e}",
                lambda epsrel=epsrel: _loop(scene, stick, epsrel),
            )


def _loop(scene: Scene, stick: float, epsrel: float) -> Array:
    """One call of `quad` for each radius, with the functions of `math`, as is quickest."""
    slope, b, low = scene.scalar, scene.b, max(scene.b, stick)
    found = []
    for r in RADII.tolist():

        def integrand(t: float, r: float = r) -> float:
            x = math.sqrt(t * t + r * r)
            return slope(x, x - b) / x

        start = math.sqrt((low - r) * (low + r)) if low > r else 0.0
        end = math.sqrt((EDGE - r) * (EDGE + r))
        found.append(quad(integrand, start, end, epsabs=0.0, epsrel=epsrel, limit=200)[0])
    return np.array(found) / np.pi


def _tanh_sinh(scene: Scene, stick: float) -> Iterator[Way]:
    for level in range(5):
        nodes = _rule(level)
        yield Way(
            "tanh-sinh in NumPy",
            f"{nodes[0].size} nodes",
            lambda nodes=nodes: _transformed(scene, stick, *nodes),
        )


@cache
def _rule(level: int) -> tuple[Array, Array]:
    """Nodes on [0, 1] as distances from 0, as small as 1e-32, and their weights."""
    step = 1.0 / 2**level
    u = step * np.arange(-int(3.2 / step), int(3.2 / step) + 1)
    v = math.pi / 2 * np.sinh(u)
    return 1 / (1 + np.exp(-2 * v)), step * math.pi / 4 * np.cosh(u) / np.cosh(v) ** 2


def _transformed(scene: Scene, stick: float, nodes: Array, weights: Array) -> Array:
    low = np.maximum(RADII, max(scene.b, stick))
    step = np.multiply.outer(nodes, EDGE - low)
    x = low + step
    values = scene.slope(x, (low - scene.b) + step)
    values /= np.sqrt(((low - RADII) + step) * (x + RADII))
    return (weights @ values) * (EDGE - low) / np.pi


def _grid(points: int) -> Array:
    return np.linspace(0.0, EDGE, points)


def _at_radii(points: int, values: Array) -> Array:
    """The radii are points of grids of 2000, 4000, ... intervals; else in between, linearly."""
    values = np.ravel(values)
    if (points - 1) % 2000:
        return np.interp(RADII, _grid(points), values)
    part = (points - 1) // 2000
    return values[part :: 2 * part]


@cache
def _operator(method: str, points: int) -> Array:
    """The matrix of one of Dasch's methods; PyAbel itself keeps only the last one."""
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
    # Their bases take minutes at 2001 points, and only one is kept at a time.
    "basex": (
        lambda q, dr: basex.basex_transform(q, dr=dr, basis_dir=None, verbose=False),
        (1001,),
    ),
    "daun": (
        lambda q, dr: daun.daun_transform(q, dr=dr, degree=3, basis_dir=None, verbose=False),
        (1001,),
    ),
}


def _pyabel(scene: Scene, stick: float) -> Iterator[Way]:
    """Inverse transforms of the foundation's load, min(q(x), q(c)), zero at a."""
    for name, (transform, sizes) in _PYABEL.items():
        for points in sizes:

            def run(transform: Callable = transform, points: int = points) -> Array:
                g = scene.equivalent_profile(_grid(points))
                if stick:
                    np.maximum(g, g[round(stick * (points - 1))], out=g)
                answer = transform((g[-1] - g)[None], EDGE / (points - 1))
                return _at_radii(points, answer)

            yield Way(f"PyAbel {name}", f"{points} points", run)


@cache
def _plan(points: int, order: int, end: float) -> openabel.Abel:
    return openabel.Abel(points, 2, 0.0, end / (points - 1), method=3, order=order)


def _openabel(scene: Scene, stick: float) -> Iterator[Way]:
    """Its transform of a given derivative, which is g'; under friction up to a less up to c."""
    for order in (2, 5):
        for points in (251, 1001, 2001, 10001):

            def run(order: int = order, points: int = points, plan: Callable = _plan) -> Array:
                x = _grid(points)
                slope = np.ascontiguousarray(scene.slope(x, x - scene.b))
                answer = plan(points, order, EDGE).execute(slope)
                if stick:
                    inside = round(stick * (points - 1)) + 1
                    answer = np.array(answer)
                    answer[:inside] -= plan(inside, order, stick).execute(slope[:inside])
                # It gives -(1/pi) int F'(x)/sqrt(x^2 - r^2) dx of the F' that it is given.
                return -_at_radii(points, answer)

            yield Way(f"openAbel, order {order}", f"{points} points", run)

            def planned(run: Callable = run) -> Array:
                return run(plan=_plan.__wrapped__)

            yield Way(f"openAbel with its plan, order {order}", f"{points} points", planned)
