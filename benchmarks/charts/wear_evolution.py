"""Fretting wear over 1e4 cycles, error against time: `make chart-wear_evolution`.

The case and the explicit scheme are those of `wear_ratio`: cycle by cycle on a uniform grid with
precomputed matrices. On the same grid wear is an ordinary differential equation of the profile as
well (Willert, Symmetry 13 (2021) 1582), which LSODA integrates here. The reference is MDR at
resolution 96; its difference from resolution 64 is drawn as its error.
"""

from __future__ import annotations

from time import thread_time

import numpy as np
import wear_ratio
from drawing import BLUE, GREEN, GREY, MDR_COLOR, panels, save, sufficient, table
from machine import footer
from scipy.integrate import solve_ivp
from tests.oracles.wear_explicit import Controls

GRIDS = (45, 90, 180, 360)
RUNS = 3
EXPLICIT, ORDINARY, MDR = "explicit, cycle by cycle", "uniform grid, LSODA", "MDR, implicit"
HEADER = ("method", "resolution", "seconds", "largest error / depth")


class Ordinary(wear_ratio.Explicit):
    """The profile on the grid of the explicit scheme as the solution of df/dN = K mu p 4|s|."""

    def __call__(self) -> np.ndarray:
        held = Controls(depth=1.0, displacement=wear_ratio.AMPLITUDE)
        found = solve_ivp(
            lambda _, f: self.scene.rate(f, held),
            (0.0, wear_ratio.CYCLES),
            self.scene.f0,
            method="LSODA",
            rtol=1e-4,
            atol=1e-6,
        )
        return np.asarray(found.y[:, -1])


def main() -> None:
    ordinary = {grid: Ordinary(grid) for grid in GRIDS}
    explicit = {grid: wear_ratio.Explicit(grid) for grid in GRIDS}
    mdr = [wear_ratio.Mdr(*setting) for setting in wear_ratio.SETTINGS]
    best, next_best = wear_ratio.Mdr(96, 1e-8)(), wear_ratio.Mdr(64, 1e-8)()
    finest = explicit[GRIDS[-1]].r

    def error(r: np.ndarray, depth: np.ndarray) -> float:
        return float(np.abs(depth - best.worn_depth(r)[0]).max())

    doubt = error(finest, next_best.worn_depth(finest)[0])
    times: dict[object, list[float]] = {}
    answers = {}
    for number in range(RUNS):
        for one in (*mdr, *explicit.values(), *ordinary.values()):
            # The finest grid takes longer than all other runs together.
            if number and one in (explicit[GRIDS[-1]], ordinary[GRIDS[-1]]):
                continue
            start = thread_time()
            answers[one] = one()
            times.setdefault(one, []).append(thread_time() - start)
    rows = [
        (
            EXPLICIT,
            f"{grid} radii",
            float(np.median(times[one])),
            error(one.r, answers[one].profile - one.r**2 / 2),
        )
        for grid, one in explicit.items()
    ]
    rows += [
        (
            ORDINARY,
            f"{grid} radii",
            float(np.median(times[one])),
            error(one.r, answers[one] - one.r**2 / 2),
        )
        for grid, one in ordinary.items()
    ]
    rows += [
        (
            MDR,
            f"resolution {one.resolution}, rtol {one.rtol:.0e}",
            float(np.median(times[one])),
            error(finest, answers[one].worn_depth(finest)[0]),
        )
        for one in mdr
    ]
    table(HEADER, rows, "wear_evolution")
    print(f"resolutions 96 and 64 differ by {doubt:.1e}")
    draw(rows, doubt)


def draw(rows: list[tuple[str, str, float, float]], doubt: float) -> None:
    figure, (ax,) = panels(1, 1, 3.0)
    for name, color in ((EXPLICIT, BLUE), (ORDINARY, GREEN), (MDR, MDR_COLOR)):
        points = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(*points, "o-", color=color, label=name)
    ends = min(row[2] for row in rows), max(row[2] for row in rows)
    ax.loglog(ends, [doubt] * 2, ":", color=GREY, label="uncertainty of the reference")
    ax.set(xlabel="CPU time [s]", ylabel="largest error of the worn depth / d")
    ax.set(xlim=(1e-2, 100), ylim=(1e-10, 1))
    sufficient(ax)
    save(figure, "wear_evolution", footer(), [ax])


if __name__ == "__main__":
    main()
