"""Fretting wear over 1e4 cycles, error against time: `make chart-wear_evolution`.

The case and the explicit scheme are those of `wear_ratio`: cycle by cycle on a uniform grid with
precomputed matrices. The reference is MDR at resolution 96; its difference from resolution 64 is
drawn as its error.
"""

from __future__ import annotations

from time import thread_time

import numpy as np
import wear_ratio
from drawing import BLUE, GREY, MDR_COLOR, panels, save, table
from machine import footer

GRIDS = (45, 90, 180, 360)
RUNS = 3
HEADER = ("method", "resolution", "seconds", "largest error / depth")


def main() -> None:
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
        for one in (*mdr, *explicit.values()):
            # The finest grid takes longer than all other runs together.
            if number and one is explicit[GRIDS[-1]]:
                continue
            start = thread_time()
            answers[one] = one()
            times.setdefault(one, []).append(thread_time() - start)
    rows = [
        (
            "explicit, cycle by cycle",
            f"{grid} radii",
            float(np.median(times[one])),
            error(one.r, answers[one].profile - one.r**2 / 2),
        )
        for grid, one in explicit.items()
    ]
    rows += [
        (
            "MDR, implicit",
            f"resolution {one.resolution}, rtol {one.rtol:.0e}",
            float(np.median(times[one])),
            error(finest, answers[one].worn_depth(finest)[0]),
        )
        for one in mdr
    ]
    table(HEADER, rows, "wear_evolution")
    print(f"resolutions 96 and 64 differ by {doubt:.1e}")
    figure, (ax,) = panels(1, 1, 3.0)
    for name, color in (("explicit, cycle by cycle", BLUE), ("MDR, implicit", MDR_COLOR)):
        points = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(*points, "o-", color=color, label=name)
    ends = min(row[2] for row in rows), max(row[2] for row in rows)
    ax.loglog(ends, [doubt] * 2, ":", color=GREY, label="uncertainty of the reference")
    ax.set(xlabel="CPU time [s]", ylabel="largest error of the worn depth / d")
    save(figure, "wear_evolution", footer(), [ax])


if __name__ == "__main__":
    main()
