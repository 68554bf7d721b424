"""Histories under mixed control would not follow the arcs between their loads.

Two load steps are known up to integrals, which mpmath evaluates; all others must satisfy the energy
balance. Chords approximate the arcs: the estimate bounds their error and is at most 1e-5, as
documented for `solve`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf
from numpy.polynomial.legendre import leggauss

from mdr_core import history, normal
from tests.core.comparison import profile_from
from tests.core.test_history_paths import DEPTH, FULL_SLIP, MATERIAL, PROFILES

if TYPE_CHECKING:
    from collections.abc import Callable


MU, E_STAR, G_STAR = MATERIAL.mu, MATERIAL.e_star, MATERIAL.g_star
#: Converts tangential coordinates to displacements, and an integral of line loads to an energy.
COMPLIANCE = MU * E_STAR / G_STAR
DIGITS = 20
#: Largest error estimate of a load path with nonlinear load steps at the default tolerance.
_LARGEST_ERROR = 1e-5

B = mpf(0.6)
#: g(x), g' as a function of x - b, I = 2 int x g' dx in closed form, and the radius b of the flat.
SHAPES: dict[str, tuple[Callable[[mpf], mpf], Callable[[mpf], mpf], Callable[[mpf], mpf], mpf]] = {
    "paraboloid": (
        lambda x: x * x / mpf(1.3),
        lambda x: 2 * x / mpf(1.3),
        lambda x: 4 * x**3 / (3 * mpf(1.3)),
        mpf(0),
    ),
    "cone": (
        lambda x: mp.pi / 2 * mpf(0.3) * x,
        lambda _: mp.pi / 2 * mpf(0.3),
        lambda x: mp.pi / 2 * mpf(0.3) * x * x,
        mpf(0),
    ),
    "power4": (
        lambda x: mpf(8) / 3 * mpf(0.4) * x**4,
        lambda x: mpf(32) / 3 * mpf(0.4) * x**3,
        lambda x: mpf(64) / 15 * mpf(0.4) * x**5,
        mpf(0),
    ),
    "truncated-cone": (
        lambda x: mpf(0.3) * x * mp.acos(B / x),
        lambda gap: mpf(0.3) * (mp.acos(B / (B + gap)) + B / mp.sqrt(gap * (2 * B + gap))),
        lambda x: mpf(0.3) * (x * x * mp.acos(B / x) + B * mp.sqrt((x - B) * (x + B))),
        B,
    ),
}


class Shape:
    """g, I = F_N/E* and their inverses, in mpmath."""

    def __init__(self, name: str) -> None:
        self.g, self.slope, self.force, self.flat = SHAPES[name]

    def over(self, density: Callable[[mpf], mpf], low: mpf, high: mpf) -> mpf:
        """int density(x) g'(x) dx; the square root beyond a flat is removed by x = b + t^2."""
        b = self.flat
        ends = [mp.sqrt(end - b) for end in (low, high)]
        return mp.quad(lambda t: density(b + t * t) * self.slope(t * t) * 2 * t, ends)

    def radius(self, depth: float) -> mpf:
        """x of a depth."""
        return self.root(lambda x: self.g(x) - mpf(depth), self.flat, mpf(2))

    @staticmethod
    def root(function: Callable[[mpf], mpf], low: mpf, high: mpf) -> mpf:
        """Root of a function within a bracket."""
        return mp.findroot(function, (low, high), solver="illinois", verify=False, maxsteps=60)


def overlap(shape: Shape, front: mpf, edge: mpf) -> mpf:
    """R = 2 int (x - x(front)) dw."""
    return shape.over(lambda x: 2 * (x - front), front, edge)


@pytest.fixture(autouse=True)
def _precise() -> Any:
    with mp.workdps(DIGITS):
        yield


def near(value: mpf, result: history.LoadHistory) -> Any:
    assert result.error_estimate < _LARGEST_ERROR
    return pytest.approx(float(value), rel=result.error_estimate, abs=0)


@pytest.mark.long
@pytest.mark.parametrize("name", SHAPES)
def test_normal_force_and_displacement_grow_together(name: str) -> None:
    """Springs in first contact follow the arc, up to where it is as steep as the friction limit."""
    shape = Shape(name)
    a1, a2 = (shape.radius(part * DEPTH) for part in (0.3, 1.0))
    i1, i2 = shape.force(a1), shape.force(a2)
    turn = (2 * a1 + 3 * a2) / 5
    rate = 1 / (2 * turn)
    shift = rate * (i2 - i1)

    def eta(x: mpf) -> mpf:
        return shape.g(x) - rate * (shape.force(x) - i1)

    goal = eta(a2)
    assert goal > shape.g(a1)
    c = shape.root(lambda x: eta(x) - goal, a1, turn)
    carried = rate * shape.over(lambda x: 4 * x * x, a1, c) + i2 - shape.force(c)

    def stored(x: mpf) -> mpf:
        # int v^2 dx = -int x d(v^2), without a boundary term at the edge.
        v = shift - rate * (shape.force(x) - i1) if x < c else shape.g(a2) - shape.g(x)
        return 2 * x * v * (2 * x * rate if x < c else 1)

    square = shape.over(stored, a1, c) + shape.over(stored, c, a2)

    def dissipated(x: mpf) -> mpf:
        # Both behave like roots at the reversal: the front is as far below it as the load is above.
        front = shape.root(lambda y: eta(y) - eta(x), a1, turn)
        return overlap(shape, front, x) * (2 * x * rate - 1)

    with mp.workdps(12):
        energy = shape.over(dissipated, turn * (1 + mpf(10) ** -9), a2)
    for sign in (1, -1):
        result = solve(
            name,
            normal_force=[float(i1) * E_STAR, float(i2) * E_STAR],
            tangential_displacement=[0.0, sign * float(shift) * COMPLIANCE],
        )
        assert sign * result.tangential_force[1] == near(MU * E_STAR * carried, result)
        assert result.tangential_energy[1] == near(MU * E_STAR * COMPLIANCE * square, result)
        assert result.dissipation[1] == near(MU * E_STAR * COMPLIANCE * energy, result)
        assert result.dissipation[0] == 0
        assert result.regime.tolist() == ["stick", "partial_slip"]
        assert result.slip_fronts[-1] == pytest.approx(float(c), rel=1e-9, abs=0)


@pytest.mark.long
@pytest.mark.parametrize("name", SHAPES)
def test_depth_and_tangential_force_grow_together(name: str) -> None:
    """Initial slip, then stick from where the arc is no steeper than the friction limit."""
    shape = Shape(name)
    a1, a2 = (shape.radius(part * DEPTH) for part in (0.5, 1.0))
    d1, d2 = shape.g(a1), shape.g(a2)
    turn = (a1 + a2) / 2
    rate = 2 * turn

    def eta(x: mpf) -> mpf:
        return shape.force(x) - rate * (shape.g(x) - d1)

    c = shape.root(lambda x: shape.force(x) - eta(turn), shape.flat, a1)
    anchor = shape.g(turn) - shape.g(c) + rate * shape.over(lambda x: 1 / (2 * x), turn, a2)

    def dissipated(x: mpf) -> mpf:
        front = shape.root(lambda y: shape.force(y) - eta(x), shape.flat, a1)
        return overlap(shape, front, x) * (rate - 2 * x) / (2 * front)

    with mp.workdps(12):
        energy = shape.over(dissipated, a1, turn)
    for sign in (1, -1):
        result = solve(
            name,
            indentation_depth=[float(d1), float(d2)],
            tangential_force=[0.0, sign * float(rate * (d2 - d1)) * MU * E_STAR],
        )
        assert sign * result.tangential_displacement[1] == near(COMPLIANCE * anchor, result)
        assert result.dissipation[1] == near(MU * E_STAR * COMPLIANCE * energy, result)
        assert result.regime.tolist() == ["stick", "stick"]


def random_path(name: str, control: str, steps: int, seed: int) -> dict[str, Any]:
    """A random path under mixed control within the friction limit."""
    random = np.random.default_rng(seed)
    d = random.uniform(0.4, 1.0, steps) * DEPTH
    if control == "normal_force":
        force = normal.solve(profile_from(PROFILES[name]), E_STAR, indentation_depth=d)
        u = random.uniform(-1.1, 1.1, steps) * FULL_SLIP
        return {"normal_force": force.normal_force, "tangential_displacement": u}
    least = normal.solve(profile_from(PROFILES[name]), E_STAR, indentation_depth=0.35 * DEPTH)
    f = random.uniform(-1, 1, steps) * MU * float(least.normal_force)
    f[0] = 0.0
    return {"indentation_depth": d, "tangential_force": f}


def with_points(path: dict[str, Any], shares: Any) -> dict[str, Any]:
    """The path with additional points on every load step."""
    return {
        name: (
            np.append(0.0, row[:-1])[:, None]
            + np.subtract(row, np.append(0.0, row[:-1]))[:, None] * np.append(shares, 1.0)
        ).ravel()
        for name, row in path.items()
    }


KINDS = [name for name in PROFILES if name != "flat-punch"]
controls = pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])


@pytest.mark.every(6)
@controls
@pytest.mark.parametrize("name", KINDS)
def test_work_is_stored_or_dissipated(name: str, control: str) -> None:
    """int F_x du up to the end of each load step, by Gauss quadrature on 25 panels per step."""
    path = random_path(name, control, 4, 3)
    nodes, weights = leggauss(8)
    panels = 25
    # Panels cluster at both ends of a load step, where F_x behaves like a root.
    edges = np.sin(np.linspace(0, np.pi / 2, panels + 1)) ** 2
    width = np.diff(edges)
    shares = (edges[:-1, None] + width[:, None] * (1 + nodes) / 2).ravel()
    measure = (width[:, None] * weights / 2).ravel()
    result = solve(name, **with_points(path, shares))
    steps = len(result.step) // (shares.size + 1)
    force, moved = (
        getattr(result, column).reshape(steps, -1)
        for column in ("tangential_force", "tangential_displacement")
    )
    if control == "normal_force":
        done = force[:, :-1] @ measure * np.diff(path["tangential_displacement"], prepend=0.0)
    else:
        ends = force[:, -1] * moved[:, -1]
        done = np.diff(ends, prepend=0.0)
        done -= moved[:, :-1] @ measure * np.diff(path["tangential_force"], prepend=0.0)
    ends = slice(shares.size, None, shares.size + 1)
    balance = (result.tangential_energy + result.dissipated_energy)[ends]
    size = np.max(np.abs(balance))
    assert balance == pytest.approx(np.cumsum(done), rel=0, abs=2e-7 * size)
    plain = solve(name, **path)
    bound = result.error_estimate + plain.error_estimate
    assert plain.error_estimate < _LARGEST_ERROR
    for column in (
        "tangential_force",
        "tangential_displacement",
        "tangential_energy",
        "dissipated_energy",
    ):
        values = getattr(result, column)[ends]
        largest = np.max(np.abs(values))
        assert getattr(plain, column) == pytest.approx(values, rel=0, abs=bound * largest), column


def solve(name: str, **options: Any) -> history.LoadHistory:
    return history.solve(profile_from(PROFILES[name]), E_STAR, G_STAR, MU, **options)
