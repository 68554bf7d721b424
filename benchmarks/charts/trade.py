"""Error against time for one field of every case, shared by `pressure` and `traction`."""

from __future__ import annotations

import numpy as np
from cases import Case, cases, errors
from drawing import BLUE, BROWN, GREEN, MDR_COLOR, VIOLET, panels, rows_of, save, sufficient, table
from machine import footer
from measure import medians
from methods import BARE, MethodRun, method_runs

HEADER = ("case", "method", "resolution", "code", "seconds", "largest error", "median error")
#: Errors below rounding error are drawn here.
FLOOR = 1e-17
SECONDS = 12.0
Measured = list[tuple[MethodRun, float, float, float]]


def measured(case: Case, quantity: str) -> Measured:
    """Every method with its time, its largest and its median error."""
    results = list(method_runs(case, quantity))
    seconds = medians({entry.name: entry.run for entry in results}, SECONDS)
    truth = case.reference_values(quantity)
    return [
        (
            entry,
            seconds[entry.name],
            *((0.0, 0.0) if entry.method == BARE else errors(entry.run(), truth, case.checked)),
        )
        for entry in results
    ]


#: Cases that are drawn; the others are in the file.
DRAWN = ("paraboloid", "power law n = 1.5", "rounded punch b/a = 0.95", "table of 200 points")
#: Lines: name, start of the names of their methods, and colour. Tables are new to every code.
LINES = (
    ("MDR", "MDR, ", MDR_COLOR),
    ("SciPy quad", "scipy", BLUE),
    ("tanh-sinh", "tanh-sinh", GREEN),
    ("PyAbel", "PyAbel", BROWN),
    ("openAbel", "openAbel, ", VIOLET),
)
FOR_A_TABLE = (
    ("MDR, known table", "MDR, piecewise", MDR_COLOR),
    ("MDR, from the points", "MDR, incl.", "#e07a5f"),
    *LINES[1:4],
    ("openAbel", "openAbel incl.", VIOLET),
)


def chart(quantity: str) -> None:
    """Measure, print and draw the cases."""
    rows = []
    for case in cases():
        with np.errstate(all="ignore"):
            rows += [
                (case.name, entry.method, entry.resolution, "MDR" if entry.is_mdr else "", *numbers)
                for entry, *numbers in measured(case, quantity)
            ]
    table(HEADER, rows, quantity)
    draw(quantity)


def draw(quantity: str) -> None:
    """Draw the smallest error that each code reaches within a time."""
    figure, axes = panels(2, 2, 2.6)
    for ax, case in zip(axes, DRAWN, strict=True):
        found = [row for row in rows_of(quantity) if row["case"] == case]
        for name, start, color in FOR_A_TABLE if "table" in case else LINES:
            points = sorted(
                (float(row["seconds"]), max(float(row["largest error"]), FLOOR))
                for row in found
                if row["method"].startswith(start)
            )
            best = np.minimum.accumulate([error for _, error in points])
            kept = [0, *(np.flatnonzero(np.diff(best)) + 1)]
            x, y = np.array(points)[kept].T
            ax.loglog(x, y, "o-", color=color, label=name, zorder=3 if "MDR" in name else 2)
        ax.set(ylim=(FLOOR / 2000, 30), title=case, xlim=(1e-5, 2.0))
        sufficient(ax)
    for ax in axes:
        subplot = ax.get_subplotspec()
        if subplot.is_first_col():
            ax.set_ylabel("largest error / largest value")
        if subplot.is_last_row():
            ax.set_xlabel("CPU time [s]")
    save(figure, quantity, footer("PyAbel", "openabel"), axes)
