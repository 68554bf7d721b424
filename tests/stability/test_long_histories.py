"""Errors of histories of up to 100,000 steps do not accumulate."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import history
from mdr_core.profiles import Cone, Paraboloid
from tests.stability.curves import CLOSED, Array, Curve, curve

MU, DEPTH, SLOPE, BIG = 0.4, 1.0, 0.3, 1.3
#: Numbers of steps or cycles.
COUNTS = np.unique(np.round(np.geomspace(1, 1e5, 36)).astype(int))
SPRINGS = 200
#: Number of steps of the discrete foundation.
SHORT = 1000


def cone_force(u: mpf) -> mpf:
    """Tangential force of a cone at depth d: mu [F(a) - F(c)], c = a (1 - u/u_max), E* = G* = 1."""
    a, reach = mpf(DEPTH) / (mp.pi / 2 * mpf(SLOPE)), mpf(MU) * mpf(DEPTH)
    c = a * (1 - u / reach)
    return mpf(MU) * mp.pi / 2 * mpf(SLOPE) * (a - c) * (a + c)


def springs(path: Array, dtype: type = np.float64) -> Array:
    """F_x at every step of a discrete foundation under a cone, clipping each spring separately."""
    a = 2 * DEPTH / (np.pi * SLOPE)
    x = a * (np.arange(SPRINGS) + 0.5) / SPRINGS
    limit = (MU * (DEPTH - np.pi / 2 * SLOPE * x)).astype(dtype)
    shear, forces, last = np.zeros(SPRINGS, dtype), np.empty(path.size), 0.0
    for index, u in enumerate(path):
        shear = np.clip(shear + dtype(u - last), -limit, limit)
        forces[index], last = 2 * shear.mean() * a, u
    return forces


def after_random_steps() -> Curve:
    """Random steps, then a reversal from the largest displacement so far.

    A displacement beyond all earlier ones at constant depth lies on the virgin curve, which erases
    the slip memory. The same holds for its mirror image after an equal reverse displacement.
    """
    rng, most = np.random.default_rng(11), int(COUNTS[-1])
    walk = 0.4 * MU * DEPTH * rng.uniform(-1, 1, most)
    walk[0] = 0.0
    turn, back = 0.7 * MU * DEPTH, 0.3 * MU * DEPTH
    ours, naive = [], []
    for count in COUNTS:
        path = np.concatenate([walk[:count], [turn, back]])
        result = history.solve(
            Cone(SLOPE),
            1.0,
            1.0,
            MU,
            indentation_depth=np.full(path.size, DEPTH),
            tangential_displacement=path,
        )
        ours.append(float(result.tangential_force[-1]))
        naive.append(float(springs(path[-SHORT:], np.float32)[-1]))
    with mp.workdps(40):
        exact = cone_force(mpf(turn)) - 2 * cone_force((mpf(turn) - mpf(back)) / 2)
    return curve(
        "long-histories-random",
        "tangential force after random steps and a larger amplitude",
        "1/steps",
        f"{SPRINGS} springs in single precision, last {SHORT} steps",
        1 / COUNTS,
        (ours, naive, [exact] * COUNTS.size),
        CLOSED,
    )


def energy_of_cycles() -> Curve:
    """N cycles under constant normal force dissipate N times Mindlin and Deresiewicz's energy."""
    force, part = 1.25, 0.6
    given = part * MU * force
    result = history.cycles(
        Paraboloid(BIG),
        1.0,
        1.0,
        MU,
        normal_force=force,
        tangential_force=given,
        count=int(COUNTS[-1]),
    )
    dissipated = np.cumsum(result.energy_per_cycle)[COUNTS - 1]

    def loop(rest: float, a: float) -> float:
        braces = 1 - rest ** (5 / 3) - 5 / 6 * (1 - rest) * (1 + rest ** (2 / 3))
        return 18 * (MU * force) ** 2 / (5 * a) * braces

    radius = np.cbrt(3 * force * BIG / 4)
    one = np.float32(loop(1 - given / (MU * force), radius))
    total, naive = np.float32(0), []
    for count in range(1, int(COUNTS[-1]) + 1):
        total += one
        if count in set_of_counts:
            naive.append(float(total))
    with mp.workdps(40):
        a = mp.cbrt(3 * mpf(force) * mpf(BIG) / 4)
        c = a * mp.cbrt(1 - mpf(given) / (mpf(MU) * mpf(force)))
        each = 16 * mpf(MU) ** 2 / (15 * mpf(BIG) ** 2) * (a - c) ** 3
        each *= a * a + 3 * a * c + c * c
        exact = [each * int(count) for count in COUNTS]
    return curve(
        "long-histories-energy",
        "dissipated energy of N cycles",
        "1/N",
        "Mindlin–Deresiewicz, summed in single precision",
        1 / COUNTS,
        (dissipated, naive, exact),
        1e-12,
    )


set_of_counts = set(COUNTS.tolist())


def small_amplitude() -> Curve:
    """A small amplitude on top of a large one: every turning point is part of the slip memory."""
    ratios = np.geomspace(0.9, 1e-12, 36)
    ours, naive, truth = [], [], []
    for ratio in ratios:
        first = 0.5 * MU * DEPTH
        path = np.array([0.0, first, -first, first * ratio, 0.0])
        result = history.solve(
            Cone(SLOPE),
            1.0,
            1.0,
            MU,
            indentation_depth=np.full(path.size, DEPTH),
            tangential_displacement=path,
        )
        ours.append(float(result.tangential_force[3] - result.tangential_force[4]))
        forces = springs(path)
        naive.append(float(forces[3] - forces[4]))
        with mp.workdps(60):
            truth.append(2 * cone_force(mpf(float(path[3])) / 2))
    return curve(
        "long-histories-small-swing",
        "tangential force of a small amplitude on top of a large one",
        "small over large",
        f"{SPRINGS} springs",
        ratios,
        (ours, naive, truth),
        # The difference of two forces of the large amplitude.
        CLOSED + 8 * 2.0**-52 / ratios,
    )


CURVES = {
    "random": after_random_steps,
    "energy": energy_of_cycles,
    "small amplitude": small_amplitude,
}


@pytest.mark.parametrize("name", CURVES)
def test_errors_do_not_accumulate(name: str) -> None:
    sweep = CURVES[name]()
    sweep.holds()
    sweep.naive_fails(1e-7)
