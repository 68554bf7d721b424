"""Random loading, error against time: the polyline, and springs by their number.

`make chart-history`. The path, the springs and their two forms are those of `history_ratio`. The
reference is a run with very many springs; how far one with a quarter of them is from it is drawn
as a line: below it nothing is told apart.
"""

from __future__ import annotations

import history_ratio as paths
import numpy as np
from drawing import OURS, panels, save, table
from machine import footer
from measure import medians

STEPS = 300
SPRINGS = (10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000)
FINEST = 1_600_000
SECONDS = 20.0
HEADER = ("method", "springs", "seconds", "largest error / largest force")


def main() -> None:
    d, u = (part[:STEPS] for part in paths.random_path())
    coarse, fine = (paths.springs(d, u, count) for count in (FINEST // 4, FINEST))
    size = np.abs(fine).max()
    doubt = float(np.abs(fine - coarse).max() / size)

    def error(force: np.ndarray) -> float:
        return float(np.abs(force - fine).max() / size)

    forms = {"springs, as written": paths.springs_as_written, "springs, in place": paths.springs}
    runs = {
        (name, count): lambda form=form, count=count: form(d, u, count)
        for name, form in forms.items()
        for count in SPRINGS
        if count <= 10_000 or form is paths.springs
    }
    runs["MDR, polyline", 0] = lambda: paths.ours(d, u)
    seconds = medians(runs, SECONDS)
    rows = [
        (name, count or "", seconds[name, count], error(run()))
        for (name, count), run in runs.items()
    ]
    table(HEADER, rows, "history")
    print(f"the reference is known to {doubt:.1e}")
    figure, (ax,) = panels(1, 1, 6.0, 3.6)
    for name, color in zip((*forms, "MDR, polyline"), ("#1f5fa8", "#2b8a3e", OURS), strict=True):
        points = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(*points, "o-", color=color, label=name)
    ax.axhline(doubt, color="0.4", linestyle=":", label="the reference is known to this")
    ax.set(xlabel="processor seconds", ylabel="largest error / largest force")
    ax.set_title(f"F_x over {STEPS} random steps, springs from {SPRINGS[0]} to {SPRINGS[-1]}")
    ax.legend()
    save(figure, "history", footer())


if __name__ == "__main__":
    main()
