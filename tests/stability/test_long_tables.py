"""Tables of up to thousands of points: sums over the knots are free of cancellation."""

from __future__ import annotations

from functools import cache, partial

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import normal
from mdr_core.profiles import Tabulated
from tests.oracles.tables import Table
from tests.stability.curves import RTOL, Array, Curve, curve

TABLE = 1e-12
A, BIG = 1.02, 1.3
#: Numbers of points.
SIZES = np.unique(np.round(np.geomspace(8, 2000, 33)).astype(int))


def points(count: int) -> tuple[Array, Array]:
    r = 1.2 * np.arange(count) / (count - 1)
    return r, r * r / (BIG + np.sqrt(BIG**2 - r * r))


def trapezoids(r: Array, f: Array, weight: int) -> float:
    """Trapezoidal rule for int f'(r) (r/a)^weight / sqrt(a^2 - r^2) dr."""
    inside = r < A
    slope = np.gradient(f, r)[inside]
    x = r[inside]
    return float(np.trapezoid(slope * x**weight / np.sqrt(A * A - x * x), x))


@cache
def references() -> list[dict[str, mpf]]:
    """Exact depth and force of each table's interpolant."""
    result = []
    with mp.workdps(40):
        for count in SIZES:
            r, f = points(int(count))
            exact = Table({"r": list(r), "f": list(f), "interpolation": "cubic", "breaks": ()})
            answers = {"indentation_depth": exact.g(mpf(A)), "normal_force": exact.force(mpf(A))}
            result.append(answers)
    return result


def over_sizes(answer: str) -> Curve:
    ours, naive = [], []
    for count in SIZES:
        r, f = points(int(count))
        contact = normal.solve(Tabulated(r, f, "cubic"), 1.0, contact_radius=A, rtol=RTOL)
        ours.append(float(getattr(contact, answer)))
        depth = answer == "indentation_depth"
        naive.append(A * trapezoids(r, f, 0) if depth else 2 * trapezoids(r, f, 2))
    return curve(
        f"long-tables-{answer.replace('_', '-')}",
        f"{answer.replace('_', ' ')} of a tabulated sphere against the number of points",
        "1/points",
        "trapezoids over the points",
        1 / SIZES,
        (ours, naive, [each[answer] for each in references()]),
        TABLE,
    )


CURVES = {
    "depth": partial(over_sizes, "indentation_depth"),
    "force": partial(over_sizes, "normal_force"),
}


@pytest.mark.every(2)
@pytest.mark.parametrize("name", CURVES)
def test_number_of_points(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    # With few points the trapezoidal rule cannot converge.
    assert sweep.naive.min() >= 1e-4
