"""Tables with kinks, noise and near-duplicate points: the result is that of the interpolant."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import normal
from mdr_core.profiles import Tabulated
from tests.oracles.tables import Table
from tests.stability.curves import (
    RTOL,
    Array,
    Curve,
    attempt,
    curve,
    references,
    steps,
)

if TYPE_CHECKING:
    from collections.abc import Callable

#: Relative error limit of tables.
TABLE = 1e-12
A, B, SLOPE, BIG = 1.02, 0.45, 0.3, 1.3
POINTS = np.array([0.15 * i for i in range(9)])


NODES, WEIGHTS = np.polynomial.legendre.leggauss(100)


def naive_force(slope: Callable[[Array], Array]) -> float:
    """2 a^2 int sin^2 t f'(a sin t) dt without break points at the knots."""
    sine = np.sin(np.pi / 4 * (1 + NODES))
    return float(np.pi / 2 * A * A * (WEIGHTS @ (sine**2 * slope(A * sine))))


def of_tables(
    name: str, title: str, distance: str, distances: Array, make: Any, interpolation: str
) -> Curve:
    """Forces of a sequence of tables."""
    ours, truth, naive = [], [], []
    for size in distances:
        r, f = make(size)
        body = Tabulated(r, f, interpolation=interpolation)
        ours.append(float(normal.solve(body, 1.0, contact_radius=A, rtol=RTOL).normal_force))
        with mp.workdps(45):
            exact = Table(
                {"r": list(r), "f": list(f), "interpolation": interpolation, "breaks": ()}
            )
            truth.append(exact.force(mpf(A)))
        naive.append(naive_force(body.df))
    formula = "∫ sin²t f′(a sin t) dt, 100 Gauss points, without break points"
    return curve(name, title, distance, formula, distances, (ours, naive, truth), TABLE)


def kink() -> Curve:
    """Two nearly collinear segments: a cone and a truncated cone."""
    jumps = steps(1.0, 1e-15)
    r = np.array([0.0, B, 1.2])
    ours = []
    for jump in jumps:
        f = np.array([0.0, SLOPE * B, SLOPE * 1.2 + jump * (1.2 - B)])
        body = Tabulated(r, f, interpolation="linear")
        ours.append(float(normal.solve(body, 1.0, contact_radius=A, rtol=RTOL).normal_force))

    def exact(jump: mpf) -> mpf:
        # Slopes of the rounded points.
        ends = [mpf(float(value)) for value in (SLOPE * B, SLOPE * 1.2 + float(jump) * (1.2 - B))]
        first = ends[0] / mpf(B)
        second = (ends[1] - ends[0]) / (mpf(1.2) - mpf(B))
        a, b = mpf(A), mpf(B)
        s = mp.sqrt((a - b) * (a + b))
        return first * mp.pi / 2 * a**2 + (second - first) * (a**2 * mp.acos(b / a) + b * s)

    def naive(jump: float) -> float:
        return naive_force(lambda x: np.where(x > B, SLOPE + jump, SLOPE))

    return curve(
        "table-kink",
        "force of a table with a slope discontinuity",
        "jump in f′",
        "∫ sin²t f′(a sin t) dt, 100 Gauss points",
        jumps,
        (ours, attempt(naive, jumps), references(exact, jumps)),
        TABLE,
    )


def sphere(r: Array) -> Array:
    return np.asarray(r * r / (BIG + np.sqrt(BIG**2 - r * r)))


def duplicate(interpolation: str) -> Curve:
    def make(gap: float) -> tuple[Array, Array]:
        r = np.sort(np.append(POINTS, B * (1 + gap)))
        return r, sphere(r)

    return of_tables(
        f"table-duplicate-{interpolation}",
        f"force of a table with two close points, {interpolation}",
        "gap / radius",
        steps(0.1, 1e-13, 30),
        make,
        interpolation,
    )


def noise(interpolation: str) -> Curve:
    shape = np.random.default_rng(7).standard_normal(POINTS.size - 1)

    def make(size: float) -> tuple[Array, Array]:
        return POINTS, sphere(POINTS) * np.append(1.0, 1 + size * shape)

    return of_tables(
        f"table-noise-{interpolation}",
        f"force of a noisy table, {interpolation}",
        "noise amplitude / f",
        steps(3e-3, 1e-16, 30),
        make,
        interpolation,
    )


CURVES = {
    "kink": kink,
    "duplicate, cubic": partial(duplicate, "cubic"),
    "duplicate, pchip": partial(duplicate, "pchip"),
    "duplicate, linear": partial(duplicate, "linear"),
    "noise, cubic": partial(noise, "cubic"),
    "noise, pchip": partial(noise, "pchip"),
}


@pytest.mark.parametrize("name", CURVES)
def test_result_is_that_of_the_interpolant(name: str) -> None:
    CURVES[name]().holds()
