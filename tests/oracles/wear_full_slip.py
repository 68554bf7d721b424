"""Wear in full slip by linear elements on radii that move with the contact's edge.

Independent of the product: worn depth h and load q = d - g are linear between the radii
r_j = a sin(pi j/(2 n)), so that each integral of the method is elementary; nothing is factored out,
and no polynomial is longer than two intervals. In rho = r/a the integrals do not depend on a:

    dh/dN at fixed rho = K mu p S + (a'/a) rho dh/drho,    a' from g(a) = d at all times.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.integrate import solve_ivp

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class FullSlip:
    """A profile f with its equivalent profile g, pressed to a radius a, under an amplitude u."""

    f: Callable[[Array], Array]
    g: Callable[[Array], Array]
    e_star: float
    g_star: float
    friction: float
    wear: float
    displacement: float
    radius: float
    depth: float | None = None
    normal_force: float | None = None

    def extrapolated(self, cycles: Sequence[float], intervals: int) -> tuple[Array, Array]:
        """V, d, F_N and a at ascending numbers of cycles, (4, k), and their errors.

        From once, twice and four times the intervals, extrapolated to the orders 3/2, of the
        pressure next to the singularity of its kernel, and 2. The error is the last correction.
        """
        values = [self.run(cycles, n * intervals) for n in (1, 2, 4)]
        for order in (1.5, 2.0):
            before = values[-1]
            values = [fine + (fine - rough) / (2**order - 1) for rough, fine in pairwise(values)]
        return values[0], np.abs(values[0] - before)

    def run(self, cycles: Sequence[float], intervals: int) -> Array:
        """V, d, F_N and a at ascending numbers of cycles on one grid, (4, k)."""
        angle = np.linspace(0.0, np.pi / 2, intervals + 1)
        rho = np.sin(angle)
        low, high, x = rho[:-1], rho[1:], rho[1:, None]
        # g(x) = f(0) + x int f'/sqrt(x^2 - r^2) dr.
        lengths = np.arcsin(np.minimum(high / x, 1.0)) - np.arcsin(np.minimum(low / x, 1.0))
        to_springs = np.eye(1, intervals + 1) + np.zeros((intervals + 1, 1))
        to_springs[1:] += (x * lengths / np.diff(rho)) @ np.diff(np.eye(intervals + 1), axis=0)
        # p(r) = (E*/pi) int g'/sqrt(x^2 - r^2) dx; half an interval off the axis of a tip.
        at = np.maximum(rho, rho[1] / 2)[:, None]
        stress = np.diff(np.arccosh(np.maximum(rho / at, 1.0)), axis=1) / np.diff(rho) / np.pi

        def mean(values: Array) -> float:
            return float(np.trapezoid(values, rho))

        def pressed(h: Array, a: float) -> tuple[Array, float]:
            """g at the radii, and d."""
            springs = self.g(a * rho) + to_springs @ h
            if self.depth is not None:
                return springs, self.depth
            assert self.normal_force is not None
            return springs, self.normal_force / (2 * self.e_star * a) + mean(springs)

        def gap(h: Array, a: float) -> float:
            springs, depth = pressed(h, a)
            return float(springs[-1] - depth)

        def rates(_count: float, state: Array) -> Array:
            h, a = np.append(state[:-1], 0.0), float(state[-1])
            springs, depth = pressed(h, a)
            p = self.e_star / a * (stress @ np.diff(springs))
            rise = depth - self.f(a * rho) - h
            slip = self.displacement - self.friction * self.e_star / self.g_star * rise
            worn = self.wear * self.friction * p * 4 * slip
            along = np.append(np.tan(angle[:-1]) * np.gradient(h, angle, edge_order=2)[:-1], 0.0)
            # `gap` is linear in h.
            unworn, step = gap(h, a), 1e-5 * a
            per_radius = (gap(h + step / a * along, a + step) - unworn) / step
            growth = -(gap(h + worn, a) - unworn) / per_radius
            return np.append((worn + growth / a * along)[:-1], growth)

        run = solve_ivp(
            rates, (0.0, cycles[-1]), np.append(np.zeros(intervals), self.radius),
            method="LSODA", t_eval=cycles, rtol=1e-8, atol=1e-12,
        )  # fmt: skip
        assert run.success
        found = []
        for state in run.y.T:
            h, a = np.append(state[:-1], 0.0), float(state[-1])
            springs, depth = pressed(h, a)
            force = 2 * self.e_star * a * (depth - mean(springs))
            found.append((2 * np.pi * a * a * mean(h * rho), depth, force, a))
        return np.array(found).T
