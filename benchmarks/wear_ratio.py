"""Wear over 1e4 cycles: the explicit scheme, cycle by cycle, against the stiff integrator.

Both are held to one accuracy, the largest error of the worn profile over the depth, against a run
of MDR at resolution 96. The explicit scheme is the plain one of the tests' oracle with its
matrices made beforehand, which is more than the literature's does; it is timed at the grid whose
error is printed, and the product at the coarsest setting that is no worse.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

# Before NumPy is loaded: threads of its BLAS would wait for each other.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.insert(0, str(Path(__file__).parents[1]))

from dataclasses import dataclass
from time import perf_counter

import measure
import numpy as np
from tests.oracles.wear_explicit import Controls, Scene, State

from mdr_core.normal import solve
from mdr_core.profiles import Paraboloid
from mdr_core.wear import evolution

CYCLES = 1e4
WEAR, MOVED = 2e-4, 0.75
GRID, REACH = 360, 1.5
SETTINGS = ((8, 1e-3), (12, 1e-4), (16, 1e-5), (24, 1e-6), (48, 1e-7))

Array = np.ndarray


@dataclass(frozen=True)
class Ours:
    resolution: int
    rtol: float
    last: float = CYCLES

    def __call__(self) -> evolution.WearEvolution:
        contact = solve(Paraboloid(1.0), 1.0, indentation_depth=1.0)
        return evolution.solve(
            contact,
            1.0,
            1.0,
            wear_coefficient=WEAR,
            cycles=[self.last],
            tangential_displacement=MOVED,
            resolution=self.resolution,
            rtol=self.rtol,
        )


class CycleByCycle:
    """The explicit scheme; its grid and matrices are made once, outside the clock."""

    def __init__(self, grid: int = GRID) -> None:
        self.r = np.arange(grid) * (REACH / grid)
        self.scene = Scene(self.r, self.r**2 / 2, 1.0, 1.0, 1.0, WEAR)

    def __call__(self) -> State:
        held = Controls(depth=1.0, displacement=MOVED)
        return self.scene.run(held, [CYCLES], longest=1.0)[0]


def rows() -> list[measure.Row]:
    explicit = CycleByCycle()
    r = explicit.r
    truth = Ours(96, 1e-8)().worn_depth(r)[0]

    def error(depth: Array) -> float:
        return float(np.abs(depth - truth).max())

    start = perf_counter()
    theirs = error(explicit().profile - r**2 / 2)
    once = perf_counter() - start
    ours, own = next(
        (one, found)
        for one in (Ours(*setting) for setting in SETTINGS)
        if (found := error(one().worn_depth(r)[0])) <= theirs
    )
    rounds = []
    for _ in range(3):
        seconds = [once]
        for run in (ours, ours, ours):
            start = perf_counter()
            run()
            seconds.append(perf_counter() - start)
        rounds.append((once, min(seconds[1:])))
        start = perf_counter()
        explicit()
        once = perf_counter() - start
    detail = (
        f"errors {theirs:.1e} d on {GRID} radii and {own:.1e} d at resolution {ours.resolution} "
        f"and rtol {ours.rtol:.0e}"
    )
    default = measure.interleaved(Ours(24, 1e-6, 1e9), Ours(24, 1e-6), 3.0)
    return [
        measure.row(
            "wear over 1e4 cycles: explicit / implicit", "one run", rounds, ">= 50", detail
        ),
        measure.row("wear over 1e9 cycles / over 1e4", "one run", default, "<= 5"),
    ]


if __name__ == "__main__":
    for one in rows():
        print(
            f"{one.name}: {one.ratio:.3g} ({one.low:.3g} .. {one.high:.3g}), target {one.target}; "
            f"{one.detail}"
        )
