"""Force and depth of a table err by no more than its points allow."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.interpolate import CubicSpline

from mdr_core import normal
from mdr_core.profiles import Tabulated
from tests.stability.curves import Array, Curve, curve, steps

if TYPE_CHECKING:
    from collections.abc import Callable

A, BIG, END = 1.02, 1.3, 1.2
#: Numbers of points.
SIZES = np.unique(np.round(np.geomspace(40, 2000, 32)).astype(int))
NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


def sphere(r: Array) -> Array:
    return np.asarray(r * r / (BIG + np.sqrt(BIG**2 - r * r)))


def force() -> mpf:
    """F_N/E* = (a^2 + R^2) artanh(a/R) - a R of the sphere itself."""
    with mp.workdps(40):
        a, big = mpf(A), mpf(BIG)
        return (a**2 + big**2) * mp.atanh(a / big) - a * big


def by_spline(r: Array, f: Array) -> float:
    """2 a^2 int sin^2 t f'(a sin t) dt of the cubic spline through the heights."""
    sine = np.sin(np.pi / 4 * (1 + NODES))
    slope = CubicSpline(r, f)(A * sine, 1)
    return float(np.pi / 2 * A * A * (WEIGHTS @ (sine**2 * slope)))


def forces(
    name: str,
    title: str,
    distance: str,
    values: Array,
    points: Callable[[float], tuple[Array, Array]],
    bound: float | Array,
) -> Curve:
    """Forces of a sequence of tables of the sphere, against the sphere itself."""
    ours, naive = [], []
    for value in values:
        r, f = points(value)
        contact = normal.solve(Tabulated(r, f), 1.0, contact_radius=A)
        ours.append(float(contact.normal_force))
        naive.append(by_spline(r, f))
    formula = "∫ sin²t f′(a sin t) dt of a cubic spline of f"
    return curve(
        name, title, distance, formula, values, (ours, naive, [force()] * values.size), bound
    )


def uniform(distance: float) -> Array:
    return END * np.linspace(0.0, 1.0, round(1 / distance))


def exact(distance: float) -> tuple[Array, Array]:
    r = uniform(distance)
    return r, sphere(r)


def rounded(distance: float) -> tuple[Array, Array]:
    r = uniform(distance)
    return r, np.round(sphere(r), 6)


def noisy(distance: float) -> tuple[Array, Array]:
    r, f = exact(distance)
    return r, f + 1e-3 * f[-1] * np.random.default_rng(r.size).standard_normal(r.size)


def duplicate(gap: float) -> tuple[Array, Array]:
    r = np.sort(np.append(0.03 * np.arange(41), 0.45 * (1 + gap)))
    return r, sphere(r)


TITLE = "force of a table of a sphere, {}, against the number of points"
CURVES = {
    # The error of a spline of degree five falls with the sixth power of the spacing of its knots,
    # of which there are 120.
    "exact": lambda: forces(
        "table-exact",
        TITLE.format("exact heights"),
        "1/points",
        1 / SIZES,
        exact,
        np.maximum(1e-6 * (40 / SIZES) ** 6.0, 1e-10),
    ),
    "rounded": partial(
        forces, "table-rounded", TITLE.format("six decimals"), "1/points", 1 / SIZES, rounded, 2e-5
    ),
    "noisy": partial(
        forces, "table-noisy", TITLE.format("noise of 0.1 %"), "1/points", 1 / SIZES, noisy, 2e-2
    ),
    "duplicate": partial(
        forces,
        "table-duplicate",
        "force of a table with two close points",
        "gap / radius",
        steps(0.03, 1e-13, 30),
        duplicate,
        1e-6,
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("name", CURVES)
def test_force_is_that_of_the_body(name: str) -> None:
    CURVES[name]().holds()
