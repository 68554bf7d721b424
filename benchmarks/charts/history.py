"""Random load history, error against time: the polyline, and discrete foundations.

`make chart-history`. Load path and foundations are those of `history_ratio`. The reference is a run
with very many springs. The difference to a run with a quarter of them is drawn as a line, below
which errors are not resolved.
"""

from __future__ import annotations

import history_ratio as paths
import numpy as np
from drawing import BLUE, GREEN, GREY, MDR_COLOR, panels, save, sufficient, table
from machine import footer
from measure import medians

STEPS = 300
SPRINGS = (10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000)
FINEST = 1_600_000
SECONDS = 20.0
PLAIN, IN_PLACE, MDR = "springs, plain NumPy", "springs, in-place NumPy", "MDR, polyline"
HEADER = ("method", "springs", "seconds", "largest error / largest force")


def main() -> None:
    d, u = (part[:STEPS] for part in paths.random_path())
    coarse, fine = (paths.springs(d, u, count) for count in (FINEST // 4, FINEST))
    size = np.abs(fine).max()
    uncertainty = float(np.abs(fine - coarse).max() / size)

    def error(force: np.ndarray) -> float:
        return float(np.abs(force - fine).max() / size)

    forms = {PLAIN: paths.springs_plain, IN_PLACE: paths.springs}
    runs = {
        (name, count): lambda form=form, count=count: form(d, u, count)
        for name, form in forms.items()
        for count in SPRINGS
        if count <= 10_000 or form is paths.springs
    }
    runs[MDR, 0] = lambda: paths.mdr(d, u).tangential_force
    seconds = medians(runs, SECONDS)
    rows = [
        (name, count or "", seconds[name, count], error(run()))
        for (name, count), run in runs.items()
    ]
    table(HEADER, rows, "history")
    print(f"uncertainty of the reference: {uncertainty:.1e}")
    draw(rows, uncertainty)


def draw(rows: list[tuple[str, object, float, float]], uncertainty: float) -> None:
    figure, (ax,) = panels(1, 1, 3.0)
    for name, color in ((PLAIN, BLUE), (IN_PLACE, GREEN), (MDR, MDR_COLOR)):
        points = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(*points, "o-", color=color, label=name)
    times = [row[2] for row in rows]
    ends = min(times), max(times)
    ax.loglog(ends, [uncertainty] * 2, ":", color=GREY, label="uncertainty of the reference")
    ax.set(xlabel="CPU time [s]", ylabel="largest error / largest force")
    ax.set(xlim=(1e-4, 1.0), ylim=(1e-15, 1))
    sufficient(ax)
    save(figure, "history", footer(), [ax])


if __name__ == "__main__":
    main()
