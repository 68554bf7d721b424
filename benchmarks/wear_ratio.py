"""Wear over 1e4 cycles: the explicit scheme, cycle by cycle, against the stiff integrator.

Both meet the same accuracy: the largest error of the worn profile over the depth, relative to a run
of MDR at resolution 96. The explicit scheme is that of the tests with precomputed matrices, which
are more efficient than those in the literature. It is timed on the grid whose error is printed, and
MDR at the coarsest setting of at least equal accuracy.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

# Set before NumPy is loaded: BLAS threads would compete for the cores.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.insert(0, str(Path(__file__).parents[1]))

from dataclasses import dataclass

import measure
import numpy as np
from tests.oracles.wear_explicit import Controls, Scene, State

from mdr_core.normal import solve
from mdr_core.profiles import Paraboloid
from mdr_core.wear import evolution

CYCLES = 1e4
WEAR, AMPLITUDE = 2e-4, 0.75
GRID, REACH = 360, 1.5
SETTINGS = ((8, 1e-3), (12, 1e-4), (16, 1e-5), (24, 1e-6), (48, 1e-7))

Array = np.ndarray


@dataclass(frozen=True)
class Mdr:
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
            tangential_displacement=AMPLITUDE,
            resolution=self.resolution,
            rtol=self.rtol,
        )


class Explicit:
    """The explicit scheme; its grid and matrices are set up once and not timed."""

    def __init__(self, grid: int = GRID) -> None:
        self.r = np.arange(grid) * (REACH / grid)
        self.scene = Scene(self.r, self.r**2 / 2, 1.0, 1.0, 1.0, WEAR)

    def __call__(self) -> State:
        held = Controls(depth=1.0, displacement=AMPLITUDE)
        return self.scene.run(held, [CYCLES], longest=1.0)[0]


def rows() -> list[measure.Row]:
    explicit = Explicit()
    r = explicit.r
    truth = Mdr(96, 1e-8)().worn_depth(r)[0]

    def error(depth: Array) -> float:
        return float(np.abs(depth - truth).max())

    explicit_error = error(explicit().profile - r**2 / 2)
    mdr, mdr_error = next(
        (one, deviation)
        for one in (Mdr(*setting) for setting in SETTINGS)
        if (deviation := error(one().worn_depth(r)[0])) <= explicit_error
    )
    rounds = measure.interleaved(explicit, mdr, 0.0)
    detail = (
        f"errors {explicit_error:.1e} d on {GRID} radii and {mdr_error:.1e} d at resolution "
        f"{mdr.resolution} and rtol {mdr.rtol:.0e}"
    )
    default = measure.interleaved(Mdr(24, 1e-6, 1e9), Mdr(24, 1e-6), 3.0)
    return [
        measure.row(
            "wear over 1e4 cycles: explicit / implicit", "one run", rounds, ">= 10", detail
        ),
        measure.row("wear over 1e9 cycles / over 1e4", "one run", default, "<= 5"),
    ]


if __name__ == "__main__":
    for one in rows():
        print(
            f"{one.name}: {one.ratio:.3g} ({one.low:.3g} .. {one.high:.3g}), target {one.target}; "
            f"{one.detail}"
        )
